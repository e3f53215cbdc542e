"""Faces to bytes, exact up to numbering; and the order that a mesh had, and its vertices that became one."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from bsm._core import write_faces, write_order
from bsm.bitstream.errors import MeshError

Ints = npt.NDArray[np.int32]


@dataclass(frozen=True, eq=False)
class EncodedConnectivity:
    payload: bytes
    vertex_order: Ints
    face_order: Ints
    faces: Ints
    turns: npt.NDArray[np.uint8]  # the corner of its given face that is the first of each


def encode_connectivity(faces: npt.ArrayLike, vertex_count: int) -> EncodedConnectivity:
    given = np.asarray(faces)
    if given.ndim != 2 or given.shape[1] != 3 or len(given) == 0 or given.dtype.kind not in "iu":
        raise MeshError(f"faces must be integers of shape (m, 3), m > 0, not {given.dtype} of shape {given.shape}")
    if given.min() < 0 or given.max() >= vertex_count:
        raise MeshError(f"faces refer to vertices {given.min()} to {given.max()}, outside 0..{vertex_count - 1}")
    missing = np.bincount(given.ravel(), minlength=vertex_count) == 0
    if missing.any():
        raise MeshError(f"vertex {int(np.argmax(missing))} is in no face; remove isolated vertices first")
    return EncodedConnectivity(*write_faces(np.ascontiguousarray(given, np.int32), vertex_count))


@dataclass(frozen=True, eq=False)
class Splits:
    """The given vertices: the joined vertex of each, -1 in no face; faces of them; positions of those in no face."""

    source: Ints
    faces: Ints
    loose: npt.NDArray[np.float64]


def encode_order(faces: npt.ArrayLike, encoded: EncodedConnectivity, splits: Splits | None = None) -> bytes:
    """Encode the order of `faces`, shape (m, 3), whose connectivity was encoded as `encoded`, and given vertices."""
    joined, given = np.ascontiguousarray(faces, np.int32), () if splits is None else tuple(vars(splits).values())
    return write_order(joined, encoded.faces, encoded.vertex_order, encoded.face_order, *given)
