"""Ways of coding the residual of a block's prediction."""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from bsm.bitstream.coefficients.packed import pack_coefficients, unpack_coefficients
from bsm.bitstream.container.header import LAW, LAW_OF_SEQUENCES, Constants
from bsm.codec.arrays import Basis, Integers, Matrix
from bsm.codec.blocks.overlap import Blocks
from bsm.codec.signal import transform
from bsm.codec.signal.chain import Chain, ChainRules


@dataclass(frozen=True)
class Packed:
    """The paper's coding: every coefficient in a fixed number of bits, then zstd."""

    width: int
    bits: int
    step: float
    coarser: int

    def write(
        self, chain: Chain, prediction: Matrix, dictionary: Basis, coefficients: Matrix, sized: bool
    ) -> tuple[int, bytes, Matrix]:
        """c_i, the payload of coefficients, shape (c, 3), and the decoded positions of a chain's present block."""
        # Offset by half the range, as the law has it: the packed integers then need no sign.
        levels = np.rint(coefficients / self._steps(len(coefficients))).astype(np.int64)
        half = 1 << (self.bits - 1)
        shifted = np.clip(levels + half, 0, 2 * half - 1)
        data = pack_coefficients(shifted, self.bits)
        return len(levels), data, self.positions(prediction, dictionary, levels)

    def read(self, data: bytes, count: int) -> Integers:
        return unpack_coefficients(data, self.bits, 3 * count).reshape(-1, 3) - (
            1 << (self.bits - 1)
        )

    def positions(self, prediction: Matrix, dictionary: Basis, levels: Integers) -> Matrix:
        return prediction + transform.reconstruct(dictionary, levels * self._steps(len(levels)))

    def _steps(self, count: int) -> Matrix:
        steps = np.full((count, 1), self.step)
        # The first row is the mean of the block, far larger than all others. One step for all would waste bits of
        # these.
        steps[0] *= 2**self.coarser
        return steps


@dataclass(frozen=True)
class Adaptive:
    """Levels on two grids, coded with the statistics of the chain."""

    bits: ClassVar[int] = 0
    coarser: ClassVar[int] = 0

    width: int
    step: float

    def write(
        self, chain: Chain, prediction: Matrix, dictionary: Basis, coefficients: Matrix, sized: bool
    ) -> tuple[int, bytes, Matrix]:
        """As `Packed` does; but unless it has a size, a block ends with the last coefficient that is not 0."""
        # In C, since levels are chosen by a trellis while they are coded, and the models of the chain learn from them.
        return chain.write(prediction, coefficients, self.step, sized)


KEY_SEEDS = ("cosines", "svd")  # where a block without predecessor begins


@dataclass(frozen=True, eq=False)
class Scheme:
    """All that both sides know before the first block of a mesh."""

    blocks: Blocks
    rules: ChainRules
    coding: Packed | Adaptive

    @property
    def chains(self) -> list[range]:
        return self.rules.chains(self.blocks.count)

    def fields(self) -> dict[str, Any]:
        """The fields of the header."""
        rules = self.rules
        coding = self.coding
        paper = Constants(
            bits=coding.bits,
            coarser=coding.coarser,
            **{name: getattr(rules, name) for name in ALIKE},
        )
        return {
            "blocks": self.blocks.count,
            "step": coding.step,
            "key_interval": rules.key_interval,
            "paper": paper.entry(LAW_OF_SEQUENCES if rules.whole else LAW),
            "onorm": rules.apart,
        }


ALIKE = ("exact", "power", "iterations", "key_iterations", "shift", "springs")
"""Constants that chains and headers call by the same name."""


def rules_of(paper: Constants, key_interval: int = 0, tail: int = 0) -> ChainRules:
    """Chains and dictionaries by some constants."""
    values: dict[str, Any] = {name: getattr(paper, name) for name in ALIKE}
    values |= {name: bool(values[name]) for name in ("exact", "springs")}
    return ChainRules(**values, key_interval=key_interval, whole=tail)
