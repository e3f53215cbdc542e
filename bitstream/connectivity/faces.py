"""Faces to bytes, exact up to numbering."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from bsm._core import GivenMesh
from bsm.bitstream.errors import MeshError

Ints = npt.NDArray[np.int32]


@dataclass(frozen=True, eq=False)
class EncodedConnectivity:
    payload: bytes
    vertex_order: Ints
    face_order: Ints
    faces: Ints
    first_corners: npt.NDArray[np.uint8]  # the corner of its given face that is the first of each
    repeats: int  # as in the header


AS_CORNERS, ON_EDGES, WHERE_SMALLER = range(3)
"""How faces that repeat a corner are coded, as in the header (C 8, C 13), or whichever way takes fewer bytes."""


def encode_connectivity(
    faces: npt.ArrayLike, vertex_count: int, repeats: int = AS_CORNERS
) -> EncodedConnectivity:
    given = np.asarray(faces)
    if given.ndim != 2 or given.shape[1] != 3 or len(given) == 0 or given.dtype.kind not in "iu":
        raise MeshError(
            f"faces must be integers of shape (m, 3), m > 0, not {given.dtype} of shape {given.shape}"
        )
    # The kernel follows these numbers as indices. It has a check of its own; this one has words for users.
    if given.min() < 0 or given.max() >= vertex_count:
        raise MeshError(
            f"faces refer to vertices {given.min()} to {given.max()}, outside 0..{vertex_count - 1}"
        )
    # A vertex that no face reaches is never visited by the traversal, and would have no number.
    missing = np.bincount(given.ravel(), minlength=vertex_count) == 0
    if missing.any():
        raise MeshError(
            f"vertex {int(np.argmax(missing))} is in no face; remove isolated vertices first"
        )
    mesh = GivenMesh(np.ascontiguousarray(given, np.int32), np.arange(vertex_count, dtype=np.int32))
    mesh.join(True, True)
    return EncodedConnectivity(*mesh.code(repeats=repeats))
