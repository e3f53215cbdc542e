"""An adaptive binary arithmetic coder with logistic mixing of several context models, in integers only."""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from bsm._core import bitstream as _kernels
from bsm.bitstream.errors import OptionError

ONE = 1 << 16  # probabilities that are coded are integers in 1 .. ONE - 1


class Coder(NamedTuple):
    """A range coder over a buffer; made by `start_writing`."""

    state: npt.NDArray[np.int64]
    data: npt.NDArray[np.uint8]


class Bank(NamedTuple):
    """The adaptive state of a model; made by `make_bank`."""

    slots: npt.NDArray[np.uint32]
    weights: npt.NDArray[np.int32]
    settings: npt.NDArray[np.int64]


def bank_of(kernel: str) -> Bank:
    """Make the bank that a kernel of this name starts from."""
    slots, selectors, inputs, limit, rate = _kernels.bank_plan(kernel)
    return make_bank(slots, selectors, inputs, limit or 255, rate or 14)


def make_bank(slots: int, selectors: int, inputs: int, limit: int = 255, rate: int = 14) -> Bank:
    """Make a neutral bank; kernels refuse one that they cannot use."""
    initial = ONE // inputs if inputs < 3 else ONE * 5 // (4 * inputs)
    settings = np.array([limit, rate], np.int64)
    return Bank(np.full(slots, 1 << 31, np.uint32), np.full((selectors, inputs), initial, np.int32), settings)


def start_writing(capacity: int) -> Coder:
    """Make a coder that writes at most `capacity` bytes; one coded bit takes two bytes at the very most."""
    return Coder(np.array([0, (1 << 32) - 1, 0, 0, 0], np.int64), np.empty(capacity + 8, np.uint8))


def finish_writing(coder: Coder) -> bytes:
    """Return the payload: everything written, and the fewest bytes that still tell the last decision; call it once."""
    size = _kernels.finish_coder(coder)
    if size < 0:
        raise OptionError(f"the payload needs more than the {len(coder.data) - 8} bytes of capacity given")
    return coder.data[:size].tobytes()
