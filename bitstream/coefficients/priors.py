"""What the coefficient coder knows before it has seen anything: weights and first probabilities, learnt from meshes.

A block has few coefficients, so a coder that starts from nothing spends much of the stream on learning. The numbers
here were learnt once, by `tools/train_coefficients.py`; they are part of the format, and stand in `spec/priors.bin`,
which the build makes a part of the kernels.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
import numpy.typing as npt

from bsm.bitstream._kernels import priors
from bsm.bitstream.coefficients.contexts import BINS, NEIGHBOURS, SITUATIONS
from bsm.bitstream.once import cached_property

EXPECTATIONS = 3
"""From everything, from the same block alone, from earlier blocks alone; each is a context of its own."""
NODES = 38
"""Binary decisions that have a probability of their own, see `bitstream.coefficients.adaptive`."""
SELECTORS = 2
"""Sets of mixing weights for each node: first block of a chain, later blocks."""

_SHAPES = {
    "expectations": (EXPECTATIONS, SITUATIONS, NEIGHBOURS),
    "mixing": (SELECTORS * NODES, EXPECTATIONS),
    "slots": (EXPECTATIONS * BINS * NODES,),
}


@dataclass(frozen=True, eq=False)
class Experience:
    """Learnt numbers; in a file, the three arrays one behind the other, little-endian, 16 bits a number."""

    expectations: npt.NDArray[np.uint16]
    mixing: npt.NDArray[np.int16]
    slots: npt.NDArray[np.uint16]

    def to_bytes(self) -> bytes:
        """As in the file."""
        return b"".join(
            array.astype(kind).tobytes()
            for array, kind in ((self.expectations, "<u2"), (self.mixing, "<i2"), (self.slots, "<u2"))
        )

    @classmethod
    def from_bytes(cls, data: bytes) -> Experience:
        """Twin of `to_bytes`."""
        first = 2 * int(np.prod(_SHAPES["expectations"]))
        second = first + 2 * int(np.prod(_SHAPES["mixing"]))
        return cls(
            np.frombuffer(data[:first], "<u2").reshape(_SHAPES["expectations"]),
            np.frombuffer(data[first:second], "<i2").reshape(_SHAPES["mixing"]),
            np.frombuffer(data[second:], "<u2").reshape(_SHAPES["slots"]),
        )

    @cached_property
    def first_slots(self) -> npt.NDArray[np.uint32]:
        """Slots of a fresh bank, shape (EXPECTATIONS * BINS * NODES,)."""
        stored = self.slots.astype(np.int64)
        return (((stored >> 4) << 20) | (1 << 19) | ((stored & 15) << 2)).astype(np.uint32)

    @cached_property
    def first_weights(self) -> npt.NDArray[np.int32]:
        """Mixing weights of a fresh bank, shape (SELECTORS * NODES, EXPECTATIONS), 1.0 = 65536."""
        return self.mixing.astype(np.int32) << 4


@cache
def shipped_experience() -> Experience:
    """What is known of coefficients before any has come; part of the format."""
    return Experience.from_bytes(priors())
