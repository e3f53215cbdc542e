"""The order that a mesh had before its connectivity was coded: vertices, faces, and each face's first corner.

A separate payload, because it often costs more than the connectivity itself. Faces are coded as a permutation of the
order that their sorted corners suggest, largest vertex first, which is how most programs write them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from bsm.bitstream.connectivity.faces import EncodedConnectivity
from bsm.bitstream.connectivity.permutation import code_permutation, code_rotations
from bsm.bitstream.entropy.range_coder import Coder, start_writing
from bsm.bitstream.errors import CorruptError

Ints = npt.NDArray[np.int32]


@dataclass(frozen=True, eq=False)
class Arrangement:
    """What `read_arrangement` returns."""

    vertex_order: Ints
    face_order: Ints
    faces: Ints
    turns: Ints


def write_arrangement(faces: npt.ArrayLike, encoded: EncodedConnectivity) -> Coder:
    """Begin a payload with the order of `faces`, shape (m, 3), whose connectivity was encoded as `encoded`."""
    given = np.asarray(faces, np.int32)
    suggested, turned = _suggest(encoded.vertex_order[encoded.faces])
    face_order = encoded.face_order[suggested].astype(np.int32)
    original = np.empty_like(turned)
    original[face_order] = turned
    rotations = np.argmax([(np.roll(original, -k, axis=1) == given).all(axis=1) for k in range(3)], axis=0)
    coder = code_permutation(start_writing(0), encoded.vertex_order)
    coder = code_permutation(coder, face_order)
    return code_rotations(coder, rotations.astype(np.int32))


def read_arrangement(coder: Coder, faces: Ints, vertex_count: int) -> Arrangement:
    """Read the original order of decoded `faces`, shape (m, 3), of `vertex_count` vertices, where a payload begins."""
    if faces.size == 0 or faces.max() >= vertex_count:
        raise CorruptError(f"the arrangement is of {vertex_count} vertices, which the faces are not")
    vertex_order, suggested_order = np.zeros(vertex_count, np.int32), np.zeros(len(faces), np.int32)
    rotations = np.zeros(len(faces), np.int32)
    code_permutation(coder, vertex_order)
    code_permutation(coder, suggested_order)
    code_rotations(coder, rotations)

    suggested, turned = _suggest(vertex_order[faces])
    face_order = np.empty_like(suggested_order)
    face_order[suggested] = suggested_order
    original = np.empty_like(turned)
    original[suggested_order] = turned
    turns = np.empty_like(suggested_order)
    turns[suggested_order] = np.argmin(vertex_order[faces][suggested], axis=1)
    return Arrangement(vertex_order, face_order, _turn(original, rotations), (turns + rotations) % 3)


def _suggest(faces: Ints) -> tuple[npt.NDArray[np.intp], Ints]:
    suggested = np.lexsort(np.sort(faces, axis=1).T)
    ordered = faces[suggested]
    return suggested, _turn(ordered, np.argmin(ordered, axis=1))


def _turn(faces: Ints, rotations: npt.NDArray[np.integer]) -> Ints:
    return np.take_along_axis(faces, (rotations[:, None] + np.arange(3)) % 3, axis=1)
