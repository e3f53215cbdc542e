"""A part of a large mesh that stands for all of it."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from bsm.codec.arrays import Faces
from bsm.codec.blocks.partition import metis_partition
from bsm.codec.denoise.filters.vertex_update import Floats
from bsm.codec.geometry.graph import graph_of_faces

LARGEST = 8000
PIECE = 2000
PIECES = 3


def sample(faces: Faces, levels: Floats) -> tuple[npt.NDArray[np.int64], Faces]:
    """Vertices of the sample, ascending, and its faces in their numbers; all of a mesh that is not large."""
    n = len(levels)
    if n <= LARGEST:
        return np.arange(n), faces
    labels = metis_partition(graph_of_faces(faces, n), round(n / PIECE)).labels
    means = np.bincount(labels, levels) / np.bincount(labels)
    # Equal means keep the order of the parts, which lie all over the surface.
    order = np.argsort(means, kind="stable")
    order = order[means[order] > 0.5 * means.max()]
    chosen = order[np.linspace(0, len(order) - 1, min(PIECES, len(order)) + 2).astype(np.int64)[1:-1]]
    inside = np.isin(labels, chosen)
    members = np.flatnonzero(inside)
    number = np.cumsum(inside) - 1
    return members, number[faces[inside[faces].all(axis=1)]].astype(np.int32)
