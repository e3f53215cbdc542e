"""The inputs of a small network for a face: the surface around it, in the frame of the face."""

from collections.abc import Iterator
from itertools import product

import numpy as np
import numpy.typing as npt

from bsm._core import codec as _kernels
from bsm.codec.arrays import Floats, Mask, Order, Positions
from bsm.codec.denoise.normals import filter_normals, patch_guidance
from bsm.codec.denoise.surface import Topology, mean_centroid_distance
from bsm.codec.geometry.graph import Lists
from bsm.codec.geometry.metrics import FaceGeometry, face_geometry

Singles = npt.NDArray[np.float32]

RADIUS = 4.0  # of the surroundings, in mean distances of adjacent centroids
RANGES, SCALES, SECTORS, RINGS = 4, 2, 8, 2
FILTERED = SCALES * (2 * RANGES + 1)
OWN = 3 * (1 + FILTERED) + 4 * SECTORS * RINGS + SCALES * (2 * RANGES + 1) + 1  # numbers that the kernel gives
WIDTHS, TIMES = (0.3, 0.5), (3, 10)  # sigma_r of the repeated filters, and after how many iterations they are seen
REPEATED = len(WIDTHS) * len(TIMES)
NUMBERS = OWN + 3 * REPEATED + 1
"""The last one is the same for the whole mesh: how much normals of noisy faces differ from the smoothed ones."""
BASE = slice(45, 48)  # the filtered normal to which a network adds: guided by patches, both kernels wide
BATCH = 1024  # faces whose numbers pass the layers together: the output of a layer for a batch stays in the cache


def descriptions(
    positions: Positions, topology: Topology, near: Lists, noisy: Mask | None = None
) -> Iterator[tuple[Singles, Floats]]:
    """Yield numbers and frames of the faces in batches; `noisy`, shape (n,), marks noisy vertices (default: all)."""
    if len(topology.faces) == 0:
        return
    geometry = face_geometry(positions, topology.faces)
    distance = mean_centroid_distance(geometry.centroids, topology.pairs)
    guide = patch_guidance(geometry, topology)
    smooth, axes = (filter_normals(geometry, geometry.normals, near, scale * distance, np.inf) for scale in (1.0, 2.0))
    repeated = list(_repeated(geometry, topology.patches, distance))
    counted = np.ones(len(smooth), bool) if noisy is None else noisy[topology.faces].any(axis=1)
    rough = np.linalg.norm(geometry.normals - smooth, axis=1)[counted].sum() / max(np.count_nonzero(counted), 1)
    # Turned by half about the normal, a face looks the same. Of both ways the one that the base normal tells is taken.
    order, signs = mirrored(True, True)
    for begin in range(0, len(geometry.areas), BATCH):
        count = min(BATCH, len(geometry.areas) - begin)
        described, frames = np.empty((count, OWN)), np.empty((count, 9))
        _kernels.describe_faces(geometry, (guide, smooth, axes), near, distance, begin, described, frames)
        axis = frames.reshape(count, 3, 3)
        local = [np.einsum("kij,kj->ki", axis, normals[begin : begin + count]) for normals in repeated]
        row = np.concatenate([described, *local, np.full((count, 1), rough)], axis=1).astype(np.float32)
        # Nothing tells the two ends of an axis apart but the normal that the network starts from.
        back = row[:, BASE.start] < 0.0
        row[back] = row[back][:, order] * signs
        axis[back] *= signs[:3, None]
        yield row, axis


def _repeated(geometry: FaceGeometry, near: Lists, distance: float) -> Iterator[Floats]:
    """Filter the normals, shape (m, 3), again and again."""
    for sigma_r in WIDTHS:
        normals = geometry.normals
        for time in range(1, TIMES[-1] + 1):
            normals = filter_normals(geometry._replace(normals=normals), normals, near, distance, sigma_r)
            if time in TIMES:
                yield normals


def mirrored(x: bool, y: bool) -> tuple[Order, Singles]:
    """The numbers of a face as seen in a frame with x, y or both the other way round."""
    order = np.arange(NUMBERS)
    signs = np.ones(NUMBERS, dtype=np.float32)
    flip = np.array([-1.0 if x else 1.0, -1.0 if y else 1.0, 1.0], dtype=np.float32)
    vectors = [3 * k for k in range(1 + FILTERED)] + [OWN + 3 * k for k in range(REPEATED)]
    circles = 3 * (1 + FILTERED)
    for ring, sector in product(range(RINGS), range(SECTORS)):
        turned = SECTORS // 2 - sector if x else sector
        place = circles + 4 * (ring * SECTORS + sector)
        order[place : place + 4] = circles + 4 * (ring * SECTORS + (-turned if y else turned) % SECTORS) + np.arange(4)
        vectors.append(place)
    for place in vectors:
        signs[place : place + 3] = flip
    return order, signs
