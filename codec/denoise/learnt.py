"""Normals by small networks that were trained on made shapes, one after the other: each sees the last result.

A network sees a face in a frame of its own: its normal; those around it, averaged by distance and likeness, or filtered
again and again; normals and heights on two circles about it; and how like its neighbors are.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cache
from itertools import product
from pathlib import Path
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from scipy import sparse
from scipy.special import expit

from bsm.codec.arrays import Floats, Mask, Positions
from bsm.codec.denoise.surface import (
    Topology,
    filter_normals,
    follow_normals,
    mean_centroid_distance,
    patch_guidance,
    surroundings,
    unit,
    weighed_normals,
)
from bsm.codec.geometry.graph import Lists
from bsm.codec.geometry.metrics import FaceGeometry, face_geometry, face_normals

Singles = npt.NDArray[np.float32]

RADIUS = 4.0  # of the surroundings, in mean distances of adjacent centroids, as all lengths here
# sigma_r and sigma_s of the averages.
RANGES, SCALES = (0.6, 0.6 / np.sqrt(2.0), 0.3, 0.15), (1.0, 2.0)
FILTERED = len(SCALES) * (2 * len(RANGES) + 1)
SECTORS, RINGS, BETWEEN = 8, 2, 2.0  # of the circles, and the distance that parts them
# sigma_r of the repeated filters, and after how many iterations they are seen.
WIDTHS, TIMES = (0.3, 0.5), (3, 10)
REPEATED = len(WIDTHS) * len(TIMES)
OWN = 3 * (1 + FILTERED) + 4 * SECTORS * RINGS + FILTERED + 1
NUMBERS = OWN + 3 * REPEATED + 1
"""The last one is the same for the whole mesh: how much normals of noisy faces differ from the smoothed ones."""
# The filtered normal to which a network adds: guided by patches, both kernels wide.
BASE = slice(45, 48)
# Faces whose numbers pass the layers together: the output of a layer for a batch stays in the cache.
BATCH = 1024
# Bound of standardised numbers: no mesh leads a network to those that it has never seen.
FARTHEST = np.float32(6.0)
# Faces of a product of matrices: larger ones wake threads that wait longer than they work.
TOGETHER = 16
VERTEX_ITERATIONS = 15  # as the networks were trained
WEIGHTS = Path(__file__).with_suffix(".npz")


def descriptions(
    positions: Positions, topology: Topology, nearby_faces: Lists, noisy: Mask | None = None
) -> Iterator[tuple[Singles, Floats]]:
    """Yield numbers and frames of the faces in batches; `noisy`, shape (n,), marks noisy vertices (default: all)."""
    if len(topology.faces) == 0:
        return
    geometry = face_geometry(positions, topology.faces)
    areas, normals = geometry.areas, geometry.normals
    distance = mean_centroid_distance(geometry.centroids, topology.pairs)
    guide = patch_guidance(geometry, topology)
    averages = []
    for scale in SCALES:
        for compared, sigma_r in [*product((normals, guide), RANGES), (normals, np.inf)]:
            averages.append(
                weighed_normals(geometry, compared, nearby_faces, scale * distance, sigma_r)
            )
    sums = np.stack(averages, axis=1)
    filtered = unit(sums[:, :, :3], normals[:, None])
    # The last average of each scale compares nothing.
    last = FILTERED // len(SCALES) - 1
    alike = sums[:, :, 3].reshape(len(areas), len(SCALES), -1)
    total = np.where(alike[:, :, -1:] > 0.0, alike[:, :, -1:], 1.0)
    alike[:, :, -1] = np.linalg.norm(sums[:, last :: last + 1, :3], axis=2)
    smooth = filtered[:, last]
    base = filtered[:, BASE.start // 3 - 1]
    frames = _frames(geometry, nearby_faces, smooth, filtered[:, -1], base)
    repeated_normals = _repeated(geometry, topology.patches, distance)
    vectors = np.concatenate([normals[:, None], filtered, *repeated_normals], axis=1)
    local = (vectors @ frames.transpose(0, 2, 1)).reshape(len(areas), -1)
    counted = np.ones(len(smooth), bool)
    if noisy is not None:
        counted &= noisy[topology.faces].any(axis=1)
    roughness = np.linalg.norm(normals - smooth, axis=1)[counted].sum() / max(
        np.count_nonzero(counted), 1
    )
    covered = areas / (areas + distance * distance)
    for begin in range(0, len(areas), BATCH):
        batch = slice(begin, min(begin + BATCH, len(areas)))
        averaged, repeated = np.split(local[batch], [3 * (1 + FILTERED)], axis=1)
        circles = _circles(geometry, nearby_faces, frames, distance, batch)
        likeness = (alike[batch] / total[batch]).reshape(len(averaged), -1)
        same = np.full((len(averaged), 1), roughness)
        numbers = [averaged, circles, likeness, covered[batch, None], repeated, same]
        yield np.concatenate(numbers, axis=1).astype(np.float32), frames[batch]


def _frames(
    geometry: FaceGeometry, nearby_faces: Lists, smooth: Floats, axes: Floats, base: Floats
) -> Floats:
    """Frames of the faces, shape (m, 3, 3): z is where the surface looks at large, x where normals about vary most."""
    members = nearby_faces.members
    around = sparse.csr_matrix((np.ones(len(members)), members, nearby_faces.starts))
    outer = geometry.areas[:, None, None] * smooth[:, :, None] * smooth[:, None, :]
    z = np.where(axes.any(axis=1, keepdims=True), axes, [0.0, 0.0, 1.0])
    along = z[:, :, None] * z[:, None, :]
    across = np.eye(3) - along
    varied = across @ (around @ outer.reshape(-1, 9)).reshape(-1, 3, 3) @ across
    x = np.linalg.eigh(varied - along)[1][:, :, 2]
    # Nothing tells the two ends of an axis apart but the normal that the network starts from.
    backward = np.einsum("ij,ij->i", x, base) < 0.0
    x *= np.where(backward, -1.0, 1.0)[:, None]
    return np.stack([x, np.cross(z, x), z], axis=1)


def _circles(
    geometry: FaceGeometry, nearby_faces: Lists, frames: Floats, distance: float, batch: slice
) -> Floats:
    """Mean normals and heights, in frames, of the sectors of the circles about a batch, shape (k, 4 * sectors)."""
    centroids, areas, normals = geometry
    starts = nearby_faces.starts[batch.start : batch.stop + 1]
    neighbors = nearby_faces.members[starts[0] : starts[-1]]
    owners = np.repeat(np.arange(len(starts) - 1), np.diff(starts))
    axes = frames[batch]
    ways = (centroids[neighbors] - centroids[batch][owners]) / distance
    x, y, height = np.einsum("kij,kj->ik", axes[owners], ways)
    turn = np.arctan2(y, x) * (SECTORS / (2.0 * np.pi))
    sector = np.floor(turn).astype(np.int64)
    part = turn - sector
    # The direction of a face straight above the middle is not defined.
    aside = np.where((x != 0.0) | (y != 0.0), areas[neighbors], 0.0)
    outer = x * x + y * y + height * height >= BETWEEN**2
    ring = SECTORS * (RINGS * owners + outer)
    # A face between the middles of two sectors counts in both.
    weights = np.stack([aside * (1.0 - part), aside * part])
    cells = ring + np.stack([sector, sector + 1]) % SECTORS
    columns = np.broadcast_to(np.arange(len(neighbors)), cells.shape)
    shape = (SECTORS * RINGS * (len(starts) - 1), len(neighbors))
    spread = sparse.csr_matrix((weights.ravel(), (cells.ravel(), columns.ravel())), shape)
    sums = spread @ np.column_stack([np.ones(len(neighbors)), normals[neighbors], height])
    covered, facing, above = np.split(sums.reshape(len(axes), SECTORS * RINGS, 5), [1, 4], axis=2)
    local = np.concatenate([facing @ axes.transpose(0, 2, 1), above], axis=2)
    means = local / np.where(covered > 0.0, covered, 1.0)
    # A circle that leaves the mesh goes on as the surface does at large.
    return np.where(covered > 0.0, means, [0.0, 0.0, 1.0, 0.0]).reshape(len(axes), -1)


def _repeated(geometry: FaceGeometry, patches: Lists, distance: float) -> Iterator[Floats]:
    """Filter the normals again and again; yield shape (m, 1, 3)."""
    for sigma_r in WIDTHS:
        normals = geometry.normals
        for time in range(1, TIMES[-1] + 1):
            normals = filter_normals(
                geometry._replace(normals=normals), normals, patches, distance, sigma_r
            )
            if time in TIMES:
                yield normals[:, None]


@dataclass(frozen=True, eq=False)
class Network:
    mean: Singles
    scale: Singles
    layers: tuple[tuple[Singles, ...], ...]

    def __call__(self, numbers: Singles) -> Singles:
        # Always the same shape of product: BLAS sums in an order that depends on it, and results shall not.
        values = np.zeros((-(-len(numbers) // TOGETHER), TOGETHER, NUMBERS), np.float32)
        values.reshape(-1, NUMBERS)[: len(numbers)] = np.clip(
            (numbers - self.mean) * self.scale, -FARTHEST, FARTHEST
        )
        for matrix, shift in self.layers[:-1]:
            values = values @ matrix + shift
            values *= expit(values)  # x / (1 + exp(-x)), which has no kink
        matrix, shift = self.layers[-1]
        # A correction of the filtered normal: a network that knows nothing changes nothing.
        normals = numbers[:, BASE] + (values @ matrix + shift).reshape(-1, 3)[: len(numbers)]
        return np.asarray(
            normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), np.float32(1e-6))
        )


@cache
def read_networks(path: Path = WEIGHTS) -> tuple[Network, ...]:
    """The networks of a file, the one for the first pass first."""
    networks: list[Network] = []
    with np.load(path) as arrays:
        while f"mean{(stage := len(networks))}" in arrays:
            keys = [
                f"{stage}.{layer}"
                for layer in range(sum(key.startswith(f"matrix{stage}.") for key in arrays))
            ]
            layers = (
                tuple(arrays[part + key].astype(np.float32) for part in ("matrix", "shift"))
                for key in keys
            )
            networks.append(Network(arrays[f"mean{stage}"], arrays[f"scale{stage}"], tuple(layers)))
    if not networks or any(len(network.mean) != NUMBERS for network in networks):
        # Weights for other inputs would run, and give garbage.
        raise ValueError(
            f"{path}: made for other numbers of faces; train it again: python -m tools.train_denoiser"
        )
    return tuple(networks)


def regressed_normals(described: Iterable[tuple[Singles, Floats]], network: Network) -> Floats:
    """Normals by one network, shape (m, 3), whichever way the mesh is turned."""
    batches = [np.zeros((0, 3))]
    for numbers, frames in described:
        batches.append(np.einsum("kij,ki->kj", frames, network(numbers)))
    return unit(np.concatenate(batches))


class Learnt(NamedTuple):
    positions: Positions
    normals: Floats


def learnt(positions: Positions, topology: Topology, noisy: Mask | None = None) -> Learnt:
    """Denoise `positions`, shape (n, 3), by all networks in turn; `noisy`, shape (n,), marks those with noise."""
    normals = np.zeros((len(topology.faces), 3))
    nearby_faces = surroundings(positions, topology, RADIUS)
    for network in read_networks():
        described = descriptions(positions, topology, nearby_faces, noisy)
        normals = regressed_normals(described, network)
        # Each stage sees the mesh that the one before it left, as it did in training.
        positions = follow_normals(positions, topology, normals, VERTEX_ITERATIONS)
    return Learnt(positions, normals)


def joined(positions: Positions, result: Learnt, share: float, topology: Topology) -> Positions:
    """Positions, shape (n, 3), that follow the mean of their own normals and the learnt ones, whose part is `share`."""
    normals = unit((1.0 - share) * face_normals(positions, topology.faces) + share * result.normals)
    # Only along the normals: the networks leave vertices where noise has put them along the surface.
    up = unit(topology.incidence @ normals)
    heights = np.einsum("ij,ij->i", result.positions - positions, up)
    start = positions + share * heights[:, None] * up
    return follow_normals(start, topology, normals, VERTEX_ITERATIONS)
