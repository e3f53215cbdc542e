"""The order of vertices, faces and first corners before connectivity was coded, as permutations."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from bsm.bitstream import _kernels
from bsm.bitstream.connectivity.faces import EncodedConnectivity
from bsm.bitstream.entropy import range_coder as entropy
from bsm.bitstream.errors import CorruptError, OptionError, TruncatedError

Ints = npt.NDArray[np.int32]
_UNARY = 6
_SAME = entropy.signed_span(_UNARY)
_SPAN = _SAME + 1
_INPUTS = 4
_CLASSES = 32
_STEP_BYTES = 128  # more than one entry can take


def code_permutation(coder: entropy.Coder, values: Ints) -> entropy.Coder:
    """Write the permutation `values`, shape (n,), or read it into `values`; return the coder to go on with."""
    size = len(values)
    if not entropy.is_reading(coder):
        if values.ndim != 1 or size >> 24 or (np.sort(values) != np.arange(size)).any():
            raise OptionError("not a permutation of fewer than 2**24 entries, counted from 0")
        coder = entropy.make_room(coder, _STEP_BYTES * size)
    bank = entropy.make_bank((1 + _CLASSES + 2 * _CLASSES * _CLASSES) * _SPAN, _SPAN, _INPUTS)
    legal = _kernels.code_steps(coder, bank, values, np.empty(size + 1, np.int32))
    return _checked(coder, legal, f"a permutation of {size} entries")


def code_rotations(coder: entropy.Coder, values: Ints) -> entropy.Coder:
    """Write integers 0, 1 and 2, shape (m,), or read them into `values`; as `code_permutation`."""
    if not entropy.is_reading(coder):
        if values.ndim != 1 or (len(values) and (values.min() < 0 or values.max() > 2)):
            raise OptionError("rotations of a triangle's corners are 0, 1 or 2")
        coder = entropy.make_room(coder, 4 * len(values))
    bank = entropy.make_bank(3 * (9 + 27), 2, 2)
    legal = _kernels.code_turns(coder, bank, values)
    return _checked(coder, legal, f"{len(values)} rotations")


def _checked(coder: entropy.Coder, legal: int, what: str) -> entropy.Coder:
    if entropy.overran(coder):
        raise TruncatedError(f"the payload of {what} ends too early")
    if not legal:
        raise CorruptError(f"the payload is not {what}")
    return coder


@dataclass(frozen=True, eq=False)
class Arrangement:
    vertex_order: Ints
    face_order: Ints
    faces: Ints
    turns: Ints


def write_arrangement(faces: npt.ArrayLike, encoded: EncodedConnectivity) -> entropy.Coder:
    """Begin a payload with the order of `faces`, shape (m, 3), whose connectivity was encoded as `encoded`."""
    given = np.asarray(faces, np.int32)
    suggested, turned = _suggest(encoded.vertex_order[encoded.faces])
    face_order = encoded.face_order[suggested].astype(np.int32)
    original = np.empty_like(turned)
    original[face_order] = turned
    rotations = np.argmax([(np.roll(original, -k, axis=1) == given).all(axis=1) for k in range(3)], axis=0)
    coder = code_permutation(entropy.start_writing(0), encoded.vertex_order)
    coder = code_permutation(coder, face_order)
    return code_rotations(coder, rotations.astype(np.int32))


def read_arrangement(coder: entropy.Coder, faces: Ints, vertex_count: int) -> Arrangement:
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
