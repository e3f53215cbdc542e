"""Choosing the levels of a sequence by what they cost: the encoder's own business."""

from __future__ import annotations

import numpy as np

from bsm.bitstream.coefficients.matrices import Lead, encode_levels, first_prices, price_levels
from bsm.bitstream.entropy.range_coder import Bank, copy_bank
from bsm.codec.arrays import Levels, Matrix
from bsm.codec.sequence.row_prediction import Loop

WEIGHT = 0.1
"""Squared steps that a bit is worth: 0.06 and 0.15 cost 1 % at the same error, coarse steps and fine ones."""
ROUNDS = 3
"""How often levels are chosen before those that stay: prices depend on the neighbours, which depend on prices."""


class LevelWriter:
    """Writes one matrix of levels after the other; the twin of `decode_levels`."""

    def __init__(self, bank: Bank, columns: int, rounds: int = ROUNDS) -> None:
        self.levels: list[Levels] = []
        self._references: list[Levels] = []
        self._leads: list[Lead | None] = []
        self._columns = columns
        self._bank = bank
        self._rounds = rounds
        self._ahead = copy_bank(bank)
        self._none = np.zeros((0, columns), np.int32)

    def write(
        self,
        loop: Loop,
        known: Matrix,
        targets: Matrix,
        step: float,
        reference: Levels | None = None,
        lead: Lead | None = None,
    ) -> Matrix:
        """Choose and note the levels of a matrix."""
        if reference is None:
            reference = self.levels[-1] if self.levels else self._none
        prices = first_prices(len(targets), self._columns, lead)
        for _ in range(self._rounds):
            levels, _ = loop.copy().search(known, targets, step, prices, WEIGHT)
            prices = price_levels(self._ahead, levels, reference, lead)
        levels, decoded = loop.search(known, targets, step, prices, WEIGHT)
        self._leads.append(lead)
        encode_levels(self._ahead, [levels], [reference], self._leads[-1:])
        self.levels.append(levels)
        self._references.append(reference)
        return decoded

    def finish(self) -> bytes:
        """All levels, coded."""
        return encode_levels(self._bank, self.levels, self._references, self._leads)
