"""How far a decoded mesh is from the original: visual error, normals, distances, and the error of a sequence.

All lengths called *relative* are in units of the original's bounding-box diagonal. Where that diagonal is zero (all
vertices coincide) the scale is 1.

The Hausdorff distance of two surfaces is that of dense samples to triangles. Samples are the vertices and points spread
evenly over the area, so the result is a lower bound that rises towards the true distance with their number; the
distance of each sample is exact, found in a tree of bounding boxes.
"""

import math
from copy import copy
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from bsm._core import codec as _kernels
from bsm.bitstream.errors import MeshError, public
from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Faces, Floats, Indices, Mask, Order, Positions, distinct
from bsm.codec.geometry.graph import Lists, edges_of, mesh_edges, vertex_neighbors
from bsm.codec.geometry.mesh import extent_of, require_sizes, squares_of


@public
@dataclass(frozen=True)
class Comparison:
    """Errors of positions, for the encoder's closed loops and for evaluation.

    Attributes
    ----------
    nmsve : float
        Normalized mean square visual error over the original's bounding-box diagonal, so that no unit matters.
    nmsve_db : float
        ``10 * log10(nmsve)``; minus infinity if the meshes are equal.
    nmsve_paper_db : float
        The same as the paper prints it, not divided: ``10 * log10(nmsve * diagonal)``. It depends on the unit.
    theta_deg : float
        Mean angle between corresponding face normals, degrees, every face counted alike.
    angle_deg : float
        The same with faces weighted by area, as contracts use it.
    rms, max_error : float
        Root mean square and largest distance between corresponding vertices, in the mesh's own unit.
    rms_relative, max_error_relative : float
        The same over the original's bounding-box diagonal.

    Examples
    --------
    >>> import bsm
    >>> errors = bsm.compare("bunny.ply", "bunny.bsm")
    >>> isinstance(errors, bsm.Comparison), errors.rms_relative < 0.01
    (True, True)
    """

    nmsve: float
    nmsve_db: float
    nmsve_paper_db: float
    theta_deg: float
    angle_deg: float
    rms: float
    rms_relative: float
    max_error: float
    max_error_relative: float


# Areas are products of two lengths, and their squares of four: 1e70 to the fourth is still a double.
SIZES = 1e-70, 1e70
"""Smallest extent and largest coordinate of meshes that are compared: squares of areas are numbers."""
# Any smaller angle would let an encoder collapse faces to escape a large error.
# Angle of a face without area; no rounding of its vertices can give it a normal that is farther off.
LOST = math.pi


class Original:
    """An original, prepared so that one decoded version after another is measured in one pass over the faces."""

    def __init__(self, positions: Positions, faces: Faces) -> None:
        self.positions: Positions = np.ascontiguousarray(positions, np.float64)
        self.faces: Indices = np.ascontiguousarray(faces, np.int32)
        self._whole = np.empty(len(faces), np.bool_)
        _, areas, self.normals = face_geometry(self.positions, self.faces, self._whole)
        self.weights = _shares(areas * self._whole)

    def alike(self) -> "Original":
        """Return the same original, with weights that count all faces alike."""
        # The normals are the same arrays; only the weights differ.
        other = copy(self)
        other.weights = _shares(self._whole.astype(np.float64))
        return other

    def angle(self, decoded: Positions, lost: float = LOST) -> float:
        """Mean angle, degrees, between corresponding normals of this and of `decoded`, shape (n, 3)."""
        decoded = np.ascontiguousarray(decoded, np.float64)
        return math.degrees(
            _kernels.weighted_angle(self.normals, self.weights, decoded, self.faces, lost)
        )


class Reference:
    """An original mesh, prepared so that comparing one decoded version after another is cheap."""

    def __init__(self, positions: Positions, faces: Faces) -> None:
        self.positions: Positions = np.ascontiguousarray(positions, dtype=np.float64)
        # Errors of huge or tiny meshes would come out as infinity or zero, and a promise as kept.
        require_sizes(self.positions, *SIZES, "compared")
        self.faces = np.ascontiguousarray(faces, dtype=np.int32)
        # All relative errors are over the diagonal. A mesh of one point has none, and its errors stay as they are.
        self.scale = float(np.linalg.norm(extent_of(self.positions))) or 1.0
        self.by_area = Original(self.positions, self.faces)

    @cached_property
    def alike(self) -> Original:
        return self.by_area.alike()

    @cached_property
    def _neighbors(self) -> Lists:
        return vertex_neighbors(self.faces, len(self.positions))

    @cached_property
    def _laplacian(self) -> Floats:
        return geometric_laplacian(self.positions, self._neighbors)

    def nmsve(self, decoded: Positions) -> float:
        """The paper's error (section 8; norms not squared) over `scale`, the diagonal; times `scale`: its number."""
        decoded = self._checked(decoded)
        detail = _length(self._laplacian - geometric_laplacian(decoded, self._neighbors))
        # As the paper defines it, with the norm of the whole matrix and n outside of it: the number falls with more
        # vertices at the same error. Kept for comparison with the paper's figures only.
        return (_length(self.positions - decoded) + detail) / (2 * len(decoded) * self.scale)

    def theta(self, decoded: Positions) -> float:
        """Mean angle between corresponding face normals, in degrees, every face counted alike."""
        return self.alike.angle(self._checked(decoded), LOST / 2)

    def angle(self, decoded: Positions) -> float:
        """Mean angle, degrees, between corresponding normals of this and of `decoded`, shape (n, 3)."""
        return self.by_area.angle(self._checked(decoded), LOST / 2)

    def mnd(self, decoded: Positions) -> float:
        """Mean normal difference: the mean over faces of ``||n - n~||``, between 0 and 2."""
        own = self.alike.normals
        normals, counted = face_normals(self._checked(decoded), self.faces), own.any(axis=1)
        lengths = np.sqrt(squares_of(own - normals))
        # A face that lost its area has no direction. A right angle is what a random one has on average.
        lengths[~normals.any(axis=1)] = math.sqrt(2.0)
        return float(lengths[counted].mean()) if counted.any() else 0.0

    def compare(self, decoded: Positions) -> Comparison:
        require_sizes(decoded, 0.0, SIZES[1], "compared")
        visual = self.nmsve(decoded)
        squared = squares_of(self.positions - decoded)
        rms, largest = math.sqrt(squared.mean()), math.sqrt(squared.max())
        return Comparison(
            nmsve=visual,
            nmsve_db=decibel(visual),
            nmsve_paper_db=decibel(visual * self.scale),
            theta_deg=self.theta(decoded),
            angle_deg=self.angle(decoded),
            rms=rms,
            rms_relative=rms / self.scale,
            max_error=largest,
            max_error_relative=largest / self.scale,
        )

    def _checked(self, decoded: Positions) -> Positions:
        if decoded.shape != self.positions.shape:
            raise MeshError(
                f"decoded positions have shape {decoded.shape}, the original's {self.positions.shape}"
            )
        return np.ascontiguousarray(decoded, dtype=np.float64)


def compare(original: Positions, decoded: Positions, faces: Faces) -> Comparison:
    return Reference(original, faces).compare(decoded)


def rms_over_edge(original: Positions, decoded: Positions, faces: Faces) -> float:
    """Root mean square distance of corresponding vertices over the original's mean edge length."""
    return float(
        np.linalg.norm(original - decoded)
        / math.sqrt(len(original))
        / mean_edge_length(original, faces)
    )


def mean_edge_length(positions: Positions, faces: Faces) -> float:
    """Mean length of the edges of `faces`, shape (m, 3), each counted once; 1 where that is zero."""
    # Each edge once. Edges of two faces would count double, and those of borders not.
    a, b = mesh_edges(faces, len(positions)).T
    length = float(np.linalg.norm(positions[a] - positions[b], axis=1).mean()) if len(a) else 0.0
    return length or 1.0


def decibel(value: float) -> float:
    """``10 * log10(value)``, minus infinity for 0."""
    return 10.0 * math.log10(value) if value > 0.0 else -math.inf


class FaceGeometry(NamedTuple):
    """Centroids (m, 3), areas (m,) and unit normals (m, 3) of faces; a face without area has normal zero."""

    centroids: Floats
    areas: Floats
    normals: Floats


def face_geometry(positions: Positions, faces: Faces, whole: Mask | None = None) -> FaceGeometry:
    """`whole`, if it has room: which faces have a normal that is not rounding alone, as `weighted_angle` tells."""
    geometry = FaceGeometry(np.empty(faces.shape), np.empty(len(faces)), np.empty(faces.shape))
    positions, faces = (
        np.ascontiguousarray(positions, np.float64),
        np.ascontiguousarray(faces, np.int32),
    )
    _kernels.face_geometry(
        positions, faces, *geometry, (np.empty(0) if whole is None else whole).view(np.uint8)
    )
    return geometry


def _shares(counts: Floats) -> Floats:
    return np.asarray(counts / (counts.sum() or 1.0))


def face_normals(positions: Positions, faces: Faces) -> Floats:
    return face_geometry(positions, faces).normals


def folded_edges(positions: Positions, faces: Faces) -> int:
    """How many edges that two faces share are folded by more than 90 degrees; faces without area fold none."""
    normals = face_normals(positions, faces)
    _, edge, uses = edges_of(faces)
    paired = np.flatnonzero(uses == 2)
    # Sorted by their edge, corners of the same edge stand side by side.
    first, second = paired[np.argsort(edge[paired], kind="stable")].reshape(-1, 2).T
    turned = np.einsum("ed,ed->e", normals[first // 3], normals[second // 3])
    # Two faces run along a common edge in opposite directions, unless one of them is turned over. Its normal then
    # counts with the other sign.
    same_way = faces.ravel()[first] == faces.ravel()[second]  # faces of two orientations
    return int(np.count_nonzero(np.where(same_way, -turned, turned) < 0.0))


def geometric_laplacian(positions: Positions, neighbors: Lists) -> Floats:
    """Each vertex minus the mean of its neighbors, weighted by inverse distance; shape (n, 3)."""
    # In C, since the weights change with every candidate that a search measures.
    given, laplacian = np.ascontiguousarray(positions, np.float64), np.empty((len(positions), 3))
    _kernels.geometric_laplacian(given, neighbors, laplacian)
    return laplacian


def _length(values: Floats) -> float:
    return math.sqrt(np.square(values).sum())


SAMPLES = 100_000


@dataclass(frozen=True)
class SurfaceDistance:
    """Distances between two surfaces, in their unit."""

    hausdorff: float
    forward: float
    backward: float
    mean: float


def surface_distance(
    first: Positions,
    first_faces: Faces,
    second: Positions,
    second_faces: Faces,
    samples: int = SAMPLES,
    seed: int = 0,
) -> SurfaceDistance:
    """Distances between two surfaces, which need not share connectivity."""
    forward, forward_mean = _one_sided(first, first_faces, second, second_faces, samples, seed)
    backward, backward_mean = _one_sided(second, second_faces, first, first_faces, samples, seed)
    return SurfaceDistance(
        max(forward, backward), forward, backward, max(forward_mean, backward_mean)
    )


def sample_surface(positions: Positions, faces: Faces, samples: int, seed: int) -> Floats:
    """Points spread evenly over the area, shape (samples, 3); without points if the area is 0."""
    corners = positions[faces]
    # Not `face_geometry`, whose areas are zero below rounding: a thin face has a share of the samples, too.
    areas = np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    if not areas.sum() > 0.0:
        return np.empty((0, 3))
    random = np.random.default_rng(seed)
    chosen = corners[random.choice(len(faces), samples, p=areas / areas.sum())]
    # The square root makes the triangle's share of each height right.
    height, along = np.sqrt(random.random((samples, 1))), random.random((samples, 1))
    a, b, c = chosen.swapaxes(0, 1)
    return np.asarray((1.0 - height) * a + height * (1.0 - along) * b + height * along * c)


def distances_to_surface(
    points: Floats, positions: Positions, faces: Faces, enough: Floats | float = 0.0
) -> Floats:
    """Distance of each point to the nearest triangle, shape (k,): exact where it is above `enough`."""
    # The kernel leaves a search as soon as the point is known to be near enough, which is most of the time it takes.
    distances = np.zeros(len(points)) + enough
    _nearest(points, positions, faces, distances)
    return distances


def nearest_points(points: Floats, positions: Positions, faces: Faces) -> tuple[Indices, Floats]:
    """Corners of the triangles nearest to points, and the weights that make the nearest point of them, (k, 3) each."""
    _, which = _nearest(points, positions, faces, np.zeros(len(points)))
    corners = positions[faces[which]]
    sides, away = np.roll(corners, -1, axis=1) - corners, points[:, None] - corners
    along = (away * sides).sum(axis=2) / np.maximum(np.square(sides).sum(axis=2), 1e-300)
    inside = np.roll(
        (np.cross(sides, away) * np.cross(sides[:, :1], sides[:, 1:2])).sum(axis=2), -1, axis=1
    )
    inside /= np.maximum(inside.sum(axis=1, keepdims=True), 1e-300)
    # Four candidates: the nearest point of each side, and the foot in the plane. The nearest of those that are in the
    # triangle is the answer, and no case analysis is needed.
    to, axes = along.clip(0.0, 1.0)[:, :, None], np.eye(3)
    weights = np.append((1.0 - to) * axes + to * axes[[1, 2, 0]], inside[:, None], axis=1)
    far = np.square(weights @ corners - points[:, None]).sum(axis=2)
    far[(inside.min(axis=1) < 0.0) | ~inside.any(axis=1), 3] = np.inf
    return faces[which], weights[np.arange(len(points)), far.argmin(axis=1)]


def farthest_from_surface(points: Floats, positions: Positions, faces: Faces) -> float:
    """The largest of these distances, much sooner; consecutive points should be near each other."""
    return _nearest(points, positions, faces, np.empty(0))[0]


def _nearest(
    points: Floats, positions: Positions, faces: Faces, distances: Floats
) -> tuple[float, Order]:
    """The largest distance, all of them if there is room, and the nearest triangles, by a tree of boxes."""
    # A tree of boxes and not a k-d tree of points: the nearest vertex need not be of the nearest triangle.
    corners, m = np.ascontiguousarray(positions[faces], dtype=np.float64), len(faces)
    order, first, count = (np.empty(size, np.int64) for size in (m, 2 * m + 1, 2 * m + 1))
    low, high = np.empty((2 * m + 1, 3)), np.empty((2 * m + 1, 3))
    _kernels.build_tree(corners.min(axis=1), corners.max(axis=1), order, low, high, first, count)
    tree, which = (
        (corners[order].reshape(m, 9), low, high, first, count, order),
        np.empty(len(points), np.int64),
    )
    return _kernels.nearest_distances(np.ascontiguousarray(points), tree, distances, which), which


def _one_sided(
    source: Positions,
    source_faces: Faces,
    target: Positions,
    target_faces: Faces,
    samples: int,
    seed: int,
) -> tuple[float, float]:
    spread = distances_to_surface(
        sample_surface(source, source_faces, samples, seed), target, target_faces
    )
    corners = distances_to_surface(source[distinct(source_faces)], target, target_faces)
    mean = float(spread.mean()) if len(spread) else float(corners.mean())
    return float(max(corners.max(), spread.max(initial=0.0))), mean
