"""Ways of coding the residual of a block's prediction: `choose`, `write` and `positions`, block by block."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np

from bsm.bitstream.coefficients import adaptive
from bsm.bitstream.coefficients.packed import pack_coefficients, unpack_coefficients
from bsm.bitstream.container.header import LAW, LAW_OF_SEQUENCES, Paper
from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Basis, Integers, Matrix
from bsm.codec.blocks.overlap import Blocks
from bsm.codec.signal import transform
from bsm.codec.signal.chain import ChainRules


@dataclass(frozen=True, eq=False)
class Ground:
    """What both sides know of a block before its levels: where its rows are expected, shape (n, 3), and U."""

    prediction: Matrix
    dictionary: Basis

    def add(self, coefficients: Matrix) -> Matrix:
        """The prediction, and U times coefficients, shape (c_i, 3)."""
        return self.prediction + transform.reconstruct(self.dictionary, coefficients)


@dataclass(frozen=True)
class Packed:
    """The paper's coding: every coefficient in a fixed number of bits, then zstd."""

    width: int
    bits: int
    step: float
    coarser: int

    def begin(self) -> Packed:
        return self

    def choose(self, coefficients: Matrix, sized: bool) -> Integers:
        return np.rint(coefficients / self._steps(len(coefficients))).astype(np.int64)

    def write(self, levels: Integers) -> bytes:
        half = 1 << (self.bits - 1)
        return pack_coefficients(np.clip(levels + half, 0, 2 * half - 1), self.bits)

    def read(self, data: bytes, count: int) -> Integers:
        return unpack_coefficients(data, self.bits, 3 * count).reshape(-1, 3) - (1 << (self.bits - 1))

    def positions(self, ground: Ground, levels: Integers) -> Matrix:
        return ground.add(levels * self._steps(len(levels)))

    def _steps(self, count: int) -> Matrix:
        steps = np.full((count, 1), self.step)
        steps[0] *= 2**self.coarser
        return steps


@dataclass(eq=False)
class Adaptive:
    """Levels on two grids, coded with the statistics of the chain."""

    bits: ClassVar[int] = 0
    coarser: ClassVar[int] = 0

    width: int
    step: float

    @cached_property
    def model(self) -> adaptive.CoefficientModel:
        return adaptive.CoefficientModel(self.width)

    def begin(self) -> Adaptive:
        return replace(self)

    def choose(self, coefficients: Matrix, sized: bool) -> Integers:
        targets = transform.targets(coefficients, self.step, adaptive.TARGET_UNIT, adaptive.MAX_LEVEL)
        levels = adaptive.nearest_levels(targets)
        return levels if sized else levels[: 1 + int(np.flatnonzero(levels.any(axis=1)).max(initial=0))]

    def write(self, levels: Integers) -> bytes:
        return adaptive.encode_coefficients(self.model, np.asarray(levels, np.int32))

    def positions(self, ground: Ground, levels: Integers) -> Matrix:
        return transform.placed(ground.prediction, ground.dictionary, np.asarray(levels, np.int32), self.step)


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
        rules, coding = self.rules, self.coding
        paper = Paper(bits=coding.bits, coarser=coding.coarser, **{name: getattr(rules, name) for name in ALIKE})
        return {
            "blocks": self.blocks.count,
            "step": coding.step,
            "key_interval": rules.key_interval,
            "paper": paper.entry(LAW_OF_SEQUENCES if rules.whole else LAW),
            "onorm": rules.apart,
        }


ALIKE = ("exact", "power", "iterations", "key_iterations", "shift", "springs")
"""Constants that chains and headers call by the same name."""


def rules_of(paper: Paper, key_interval: int = 0, whole: int = 0) -> ChainRules:
    """Chains and dictionaries by some constants."""
    given: dict[str, Any] = {name: getattr(paper, name) for name in ALIKE}
    given |= {name: bool(given[name]) for name in ("exact", "springs")}
    return ChainRules(**given, key_interval=key_interval, whole=whole)
