"""The order of vertices, faces and first corners before connectivity was coded, as permutations."""

import numpy as np
import numpy.typing as npt

from bsm.bitstream import _kernels
from bsm.bitstream.connectivity.faces import EncodedConnectivity
from bsm.bitstream.entropy import range_coder as entropy
from bsm.bitstream.errors import OptionError

Ints = npt.NDArray[np.int32]
_STEP_BYTES = 128  # more than one entry can take


def write_permutation(coder: entropy.Coder, values: Ints) -> entropy.Coder:
    """Write the permutation `values`, shape (n,); return the coder to go on with."""
    size = len(values)
    if values.ndim != 1 or size >> 24 or (np.sort(values) != np.arange(size)).any():
        raise OptionError("not a permutation of fewer than 2**24 entries, counted from 0")
    coder = entropy.make_room(coder, _STEP_BYTES * size)
    _kernels.code_steps(coder, entropy.bank_of("code_steps"), values, np.empty(size + 1, np.int32))
    return coder


def write_rotations(coder: entropy.Coder, values: Ints) -> entropy.Coder:
    """Write integers 0, 1 and 2, shape (m,); return the coder to go on with."""
    if values.ndim != 1 or (len(values) and (values.min() < 0 or values.max() > 2)):
        raise OptionError("rotations of a triangle's corners are 0, 1 or 2")
    coder = entropy.make_room(coder, 4 * len(values))
    _kernels.code_turns(coder, entropy.bank_of("code_turns"), values)
    return coder


def write_arrangement(faces: npt.ArrayLike, encoded: EncodedConnectivity) -> entropy.Coder:
    """Begin a payload with the order of `faces`, shape (m, 3), whose connectivity was encoded as `encoded`."""
    given = np.asarray(faces, np.int32)
    suggested, turned = _suggest(encoded.vertex_order[encoded.faces])
    face_order = encoded.face_order[suggested].astype(np.int32)
    original = np.empty_like(turned)
    original[face_order] = turned
    rotations = np.argmax([(np.roll(original, -k, axis=1) == given).all(axis=1) for k in range(3)], axis=0)
    coder = write_permutation(entropy.start_writing(0), encoded.vertex_order)
    coder = write_permutation(coder, face_order)
    return write_rotations(coder, rotations.astype(np.int32))


def _suggest(faces: Ints) -> tuple[npt.NDArray[np.intp], Ints]:
    suggested = np.lexsort(np.sort(faces, axis=1).T)
    ordered = faces[suggested]
    return suggested, _turn(ordered, np.argmin(ordered, axis=1))


def _turn(faces: Ints, rotations: npt.NDArray[np.integer]) -> Ints:
    return np.take_along_axis(faces, (rotations[:, None] + np.arange(3)) % 3, axis=1)
