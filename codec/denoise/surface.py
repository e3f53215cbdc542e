"""Who is near whom on a surface, filters of face normals, and vertices that follow them.

The filters are guided by patches (Zhang, Deng, Zhang, Bouaziz, Liu 2015), the fine step of the paper; bilateral (Zheng,
Fu, Au, Tai 2011, their local scheme); and relatives.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import islice
from typing import NamedTuple

import numpy as np
from scipy import sparse

from bsm._core import codec as _kernels
from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Faces, Floats, Indices, Mask, Order, Positions
from bsm.codec.geometry.graph import Lists, edges_of, vertex_faces, vertex_neighbors
from bsm.codec.geometry.metrics import FaceGeometry, face_geometry, face_normals

CROWD = 64  # faces around a vertex from which on they are not near each other because of it
# Faces within a distance, over its square: about twice as many as there are of even triangles.
CROWDED = 16.0


@dataclass(frozen=True, eq=False)
class Topology:
    """Neighborhoods of faces; what not every filter needs is found when it is first asked for."""

    faces: Faces
    n: int

    def __post_init__(self) -> None:
        object.__setattr__(self, "faces", np.ascontiguousarray(self.faces, dtype=np.int32))

    @cached_property
    def around(self) -> Lists:
        return vertex_faces(self.faces, self.n)

    @cached_property
    def incidence(self) -> sparse.csr_matrix:
        """Ones where a face, the column, is around a vertex, the row."""
        starts, members = self.around
        return sparse.csr_matrix(
            (np.ones(len(members)), members, starts), (self.n, len(self.faces))
        )

    @cached_property
    def neighbors(self) -> Lists:
        return vertex_neighbors(self.faces, self.n)

    @cached_property
    def patches(self) -> Lists:
        """Faces that share a vertex that is not crowded with each face, and itself."""
        calm = self.incidence[np.diff(self.around.starts) <= CROWD]
        patches = (calm.T @ calm + sparse.identity(len(self.faces))).tocsr()
        return Lists(patches.indptr.astype(np.int64), patches.indices.astype(np.int32))

    @cached_property
    def pairs(self) -> Indices:
        """Two faces that share an edge, shape (p, 2); where more than two meet, each with the next in order."""
        ends, edge, _ = self._edges
        order = np.argsort(edge, kind="stable")
        order = order[ends[order, 0] != ends[order, 1]]
        key, owner = edge[order], (order // 3).astype(np.int32)
        same = (key[1:] == key[:-1]) & (owner[1:] != owner[:-1])
        return np.stack([owner[:-1][same], owner[1:][same]], axis=1)

    @cached_property
    def inner(self) -> Lists:
        """For each patch, the rows of `pairs` of which both faces lie in it."""
        m, pairs, (starts, members) = len(self.faces), self.pairs, self.patches
        sides = sparse.csc_matrix(
            (np.ones(pairs.size, np.int8), pairs.ravel(), 2 * np.arange(len(pairs) + 1)),
            (m, len(pairs)),
        )
        held = (
            sparse.csr_matrix((np.ones(len(members), np.int8), members, starts), (m, m))
            @ sides.tocsr()
        )
        inner = (held == 2).tocsr()
        return Lists(inner.indptr.astype(np.int64), inner.indices)

    @cached_property
    def boundary(self) -> Mask:
        ends, _, uses = self._edges
        return np.isin(np.arange(self.n), ends[(uses == 1) & (ends[:, 0] != ends[:, 1])])

    @cached_property
    def _edges(self) -> tuple[Order, Order, Order]:
        return edges_of(self.faces)


def surroundings(positions: Positions, topology: Topology, radius: float) -> Lists:
    """Faces within a radius, in mean distances of adjacent centroids, of each face; of crowds only every n-th face."""
    most = int(CROWDED * radius**2)
    points = face_geometry(positions, topology.faces).centroids
    radius, count = radius * mean_centroid_distance(points, topology.pairs), len(points)
    starts, seen, reached = (
        np.zeros(count + 1, np.int64),
        np.full(count, -1, np.int32),
        np.empty(33 * count, np.int32),
    )
    done = 0
    while (
        done := _kernels.reach(points, topology.patches, radius, most, done, seen, starts, reached)
    ) < count:
        # A row has at most as many members as there are faces; with room for one, the kernel goes on.
        reached = np.concatenate([reached, np.empty(len(reached) + count, np.int32)])
    return Lists(starts, reached[: starts[count]].copy())


class Hinges(NamedTuple):
    """Edges between two faces: both, and their corners off the edge; its ends, beginning, direction and length."""

    pairs: Indices
    tips: Indices
    ends: Indices
    begin: Positions
    along: Floats
    lengths: Floats


def shared_edges(places: Floats, topology: Topology) -> Hinges:
    """Return the edges between two faces of a mesh, whose vertices are at the places, shape (n, d)."""
    first, second = (topology.faces[topology.pairs[:, side]] for side in range(2))
    equal = first[:, :, None] == second[:, None, :]
    # Faces that share three vertices are one face twice, and bend nowhere.
    hinge = equal.any(axis=2).sum(axis=1) == 2
    first, second, equal = first[hinge], second[hinge], equal[hinge]
    lone = equal.any(axis=2).argmin(axis=1)
    rows = np.arange(len(first))
    ends = np.stack([first[rows, (lone + turn) % 3] for turn in (1, 2)], axis=1)
    tips = np.stack([first[rows, lone], second[rows, equal.any(axis=1).argmin(axis=1)]], axis=1)
    begin, along = places[ends[:, 0]], places[ends[:, 1]] - places[ends[:, 0]]
    lengths = np.maximum(np.linalg.norm(along, axis=1), 1e-9)
    return Hinges(topology.pairs[hinge], tips, ends, begin, along / lengths[:, None], lengths)


# Share of the faces that are turned over, from which on the shape itself is folded.
MOST_FOLDED = 0.03
MENDING_ROUNDS, MENDING_STEPS = 10, 5


def folds(positions: Positions, topology: Topology) -> Mask:
    """Return which faces, shape (m,), look the other way than those around them."""
    normals = face_normals(positions, topology.faces)
    starts, members = topology.patches
    around = sparse.csr_matrix(
        (np.ones(len(members)), members, starts), (len(normals), len(normals))
    )
    mean = unit(around @ normals - normals)
    # Folds come in groups. They must not tell how the surface lies.
    sound = np.einsum("ij,ij->i", normals, mean) > 0.0
    mean = unit(around @ (sound[:, None] * normals), mean)
    return np.asarray(np.einsum("ij,ij->i", normals, mean) < 0.0)


def mend_folds(positions: Positions, topology: Topology, average: sparse.csr_matrix) -> Positions:
    """Draw vertices of folds, shape (n, 3), to their neighbors along the surface, until no face is turned over.

    Noise along the surface turns small triangles over, and filters of normals believe them.
    """
    normals, unknown = (
        face_normals(positions, topology.faces),
        np.zeros(len(topology.faces), np.bool_),
    )
    for _ in range(MENDING_ROUNDS):
        turned = folds(positions, topology)
        if not 0.0 < turned.mean() < MOST_FOLDED:
            break
        unknown |= turned
        free = np.zeros(topology.n, np.bool_)
        free[topology.faces[turned]] = True
        drawn = np.where(free[:, None], 0.5 * (positions + average @ positions), positions)
        # A face without a normal pulls nowhere.
        targets = np.where(unknown[:, None], 0.0, normals)
        positions = follow_normals(drawn, topology, targets, MENDING_STEPS, free)
    return positions


def unit(vectors: Floats, otherwise: Floats | float = 0.0) -> Floats:
    """Rows of length one in the directions of those of `vectors`, shape (..., d); `otherwise` where they are zero."""
    lengths = np.sqrt(np.einsum("...i,...i->...", vectors, vectors))[..., None]
    return np.asarray(
        np.where(lengths > 0.0, vectors / np.where(lengths > 0.0, lengths, 1.0), otherwise)
    )


def surface_normals(positions: Positions, topology: Topology) -> Floats:
    """Unit vertex normals, shape (n, 3): the plain mean of those of the faces around."""
    return unit(topology.incidence @ face_normals(positions, topology.faces))


def pair_distances(values: Floats, pairs: Indices) -> Floats:
    """How far the rows of `values`, shape (m, 3), that each of `pairs`, shape (e, 2), names are from each other."""
    apart = np.take(values, pairs[:, 0], axis=0) - np.take(values, pairs[:, 1], axis=0)
    return np.asarray(np.sqrt(np.einsum("ij,ij->i", apart, apart)))


def mean_centroid_distance(centroids: Floats, pairs: Indices) -> float:
    """Mean distance between the centroids, shape (m, 3), of faces that share an edge, `pairs`, shape (e, 2)."""
    return (float(pair_distances(centroids, pairs).mean()) if len(pairs) else 0.0) or 1.0


def follow_normals(
    positions: Positions,
    topology: Topology,
    normals: Floats,
    iterations: int,
    free: Mask | None = None,
) -> Positions:
    """Move the vertices until the faces agree with given normals (Sun et al. 2007; equations 12 and 13 of the paper)"""
    moved = np.array(positions, dtype=np.float64)
    movable = np.ones(len(positions), np.uint8) if free is None else free.astype(np.uint8)
    heights = np.empty(len(topology.faces))
    _kernels.follow_normals(
        moved, topology.faces, topology.around, normals, iterations, movable, heights
    )
    return moved


def filter_normals(
    geometry: FaceGeometry, guide: Floats, near: Lists, sigma_s: float, sigma_r: float
) -> Floats:
    """Average each face's normal with its neighbors', by area, distance and likeness of guides (paper, 9 to 11)."""
    return unit(weighed_normals(geometry, guide, near, sigma_s, sigma_r)[:, :3], geometry.normals)


def weighed_normals(
    geometry: FaceGeometry, guide: Floats, near: Lists, sigma_s: float, sigma_r: float
) -> Floats:
    """The sums of those normals, and of their weights, shape (m, 4)."""
    packed, sums = np.empty((len(guide), 8)), np.empty((len(guide), 4))
    _kernels.weighed_normals(geometry, guide, near, sigma_s, sigma_r, packed, sums)
    return sums


def patch_guidance(geometry: FaceGeometry, topology: Topology) -> Floats:
    """Guidance normal of each face: the mean normal of the flattest patch, a face with its neighbors, that holds it."""
    _, areas, normals = geometry
    steps = pair_distances(normals, topology.pairs)
    scores, means, guide = np.empty_like(areas), np.empty_like(normals), np.empty_like(normals)
    _kernels.patch_guidance(
        normals, areas, topology.patches, steps, topology.inner, scores, means, guide
    )
    return guide


SIGMA_R, RADIUS, VERTEX_ITERATIONS = 0.35, 2.0, 10
"""The authors' defaults; with half or twice as many vertex iterations, 1.4 and 0.9 % more of the angle is left."""

# To the unit normals, shape (m, 3), that the range kernel compares.
Guide = Callable[[FaceGeometry, Topology], Floats]


class GuidedFilter:
    """The filter with its neighborhoods, which are found once."""

    def __init__(
        self,
        positions: Positions,
        topology: Topology,
        within: Callable[[Positions], Positions] = np.asarray,
    ) -> None:
        self.topology, self._within = topology, within
        self._near = surroundings(positions, topology, RADIUS)

    def step(
        self, positions: Positions, guide: Guide = patch_guidance, sigma_r: float = SIGMA_R
    ) -> Positions:
        """Positions after one iteration: filter the normals once, then let the vertices follow."""
        geometry = face_geometry(positions, self.topology.faces)
        sigma_s = mean_centroid_distance(geometry.centroids, self.topology.pairs)
        normals = filter_normals(
            geometry, guide(geometry, self.topology), self._near, sigma_s, sigma_r
        )
        return self._within(follow_normals(positions, self.topology, normals, VERTEX_ITERATIONS))

    def iterates(
        self, positions: Positions, guide: Guide = patch_guidance, sigma_r: float = SIGMA_R
    ) -> Iterator[Positions]:
        """Yield the positions, shape (n, 3), after 0, 1, 2, ... iterations of the filter, without end."""
        while True:
            yield positions
            positions = self.step(positions, guide, sigma_r)


def guided_normal_filtering(positions: Positions, faces: Faces, iterations: int = 20) -> Positions:
    guided = GuidedFilter(positions, Topology(faces, len(positions)))
    return next(islice(guided.iterates(np.array(positions, np.float64)), iterations, None))


def bilateral_normal_filtering(
    positions: Positions, faces: Faces, iterations: int = 20
) -> Positions:
    """Denoise by bilateral filtering of the normals over faces that share a vertex; the boundary stays."""
    positions = np.ascontiguousarray(positions, dtype=np.float64)
    topology = Topology(faces, len(positions))
    normals = next(islice(bilateral_normals(positions, topology, SIGMA_R), iterations, None))
    return follow_normals(positions, topology, normals, VERTEX_ITERATIONS, ~topology.boundary)


def bilateral_normals(positions: Positions, topology: Topology, sigma_r: float) -> Iterator[Floats]:
    """Yield the normals, shape (m, 3), after 0, 1, 2, ... iterations, without end."""
    geometry = face_geometry(positions, topology.faces)
    starts, members = topology.patches
    others = members != np.repeat(np.arange(len(starts) - 1), np.diff(starts))
    # Each patch without its own face.
    near = Lists(starts - np.arange(len(starts)), members[others])
    sigma_s = mean_centroid_distance(geometry.centroids, topology.pairs)
    while True:
        yield geometry.normals
        geometry = geometry._replace(
            normals=filter_normals(geometry, geometry.normals, near, sigma_s, sigma_r)
        )


# From positions (n, 3), faces (m, 3) and iterations, by default the method's own.
FineStep = Callable[..., Positions]
FINE_STEPS: dict[str, FineStep] = {
    "guided": guided_normal_filtering,
    "bilateral-normal": bilateral_normal_filtering,
}
