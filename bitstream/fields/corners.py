"""The corners of a mesh: what both sides know before integers on vertices or faces."""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from bsm.bitstream import _kernels
from bsm.bitstream.errors import MeshError

Ints = npt.NDArray[np.int32]
MOST_FACES = (1 << 30) // 3


class Corners(NamedTuple):
    """The corners of a mesh; corner k is corner k % 3 of face k // 3."""

    faces: Ints
    starts: Ints
    corners: Ints
    opposite: Ints
    rank: Ints


def corners_of(faces: npt.ArrayLike, vertices: int) -> Corners:
    """The corners of a mesh whose vertices are coded as they are numbered."""
    given = np.asarray(faces)
    if given.ndim != 2 or given.shape[1] != 3 or given.dtype.kind not in "iu" or len(given) > MOST_FACES:
        raise MeshError(f"faces must be integers of shape (m, 3), not {given.dtype} of {given.shape}")
    if not 0 <= vertices < 1 << 30 or (given.size and (given.min() < 0 or given.max() >= vertices)):
        raise MeshError(f"faces must be made of the vertices 0 to {vertices - 1}")
    own = np.array(given, np.int32, order="C")
    size = 3 * len(own)
    corners = Corners(
        own,
        np.empty(vertices + 1, np.int32),
        np.empty(size, np.int32),
        np.empty(size, np.int32),
        np.arange(vertices, dtype=np.int32),
    )
    _kernels.link_corners(corners, np.empty(vertices + size, np.int32))
    return corners


MOST_LARGEST = (1 << 20) - 1  # values from 0 on are at most this
