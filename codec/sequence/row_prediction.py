"""The mathematics of sequences: the temporal transform, and the closed loop that predicts and quantizes rows."""

from __future__ import annotations

import numpy as np

from bsm._core import codec as _kernels
from bsm.bitstream.coefficients.adaptive import STATES
from bsm.bitstream.coefficients.matrices import Lead, write_levels
from bsm.bitstream.entropy.range_coder import Bank, finish_writing, start_writing
from bsm.bitstream.errors import OptionError
from bsm.codec.arrays import Levels, Matrix
from bsm.codec.signal.transform import LARGEST_LEVEL

LEADING = 24  # columns of a row that help to predict the following ones
WEIGHT = 0.1  # squared steps that a bit is worth: 0.06 and 0.15 cost 1 % at the same error, coarse steps and fine ones


class Loop:
    """Predicts the rows of a block in closed loop."""

    def __init__(self, known: int, targets: int, leading: int = LEADING) -> None:
        self._known = known
        self._moments = np.zeros((known + min(targets, leading), known + targets))

    def begin(self, known: Matrix, field: Matrix, step: float) -> Loop:
        """Learn, before the first row, from vertices around: known values there, shape (m, k), and a field, (m, r)."""
        self._check(known, field)
        given, width = (np.ascontiguousarray(known), np.ascontiguousarray(field)), self._moments.shape[1]
        _kernels.learn_around(*given, self._moments, step, np.empty(width), np.empty(width))
        return self

    def search(
        self, known: Matrix, targets: Matrix, step: float, reference: Levels, lead: Lead | None
    ) -> tuple[Levels, Matrix]:
        """Choose levels for `targets`, shape (c, r), given `known`, shape (c, k)."""
        levels, decoded = np.zeros(targets.shape, np.int32), np.empty(targets.shape)
        coded, width = targets.shape[1], self._moments.shape[1]
        self._check(known, targets)
        given = np.ascontiguousarray(known), np.ascontiguousarray(targets), reference
        ways = *(lead or (coded, 0)), WEIGHT
        scratch = np.zeros(self._moments.shape), np.empty(width), np.empty((2 * STATES + 1, width))
        tables = np.empty((coded, STATES)), np.empty((coded, STATES), np.int32), np.zeros((coded, STATES), np.uint8)
        slow = np.empty(coded, np.int64)
        _kernels.search_rows(*given, *ways, levels, decoded, self._moments, step, *scratch, *tables, slow)
        if levels.size and max(levels.max(), -levels.min()) >= LARGEST_LEVEL:
            raise OptionError(f"a step of {step:g} is too fine for motion that far; choose a coarser one")
        return levels, decoded

    def _check(self, known: Matrix, others: Matrix) -> None:
        if known.shape != (len(others), self._known) or others.shape[1] != self._moments.shape[1] - self._known:
            raise ValueError(f"{known.shape} known and {others.shape} other columns, of {self._moments.shape[1]}")


class LevelWriter:
    """Writes one matrix of levels after the other."""

    def __init__(self, bank: Bank, columns: int) -> None:
        self.levels: list[Levels] = []
        self._columns = columns
        self._bank, self._coder = bank, start_writing(0)
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
        levels, decoded = loop.search(known, targets, step, reference, lead)
        self._coder = write_levels(self._coder, self._bank, levels, reference, lead)
        self.levels.append(levels)
        return decoded

    def finish(self) -> bytes:
        """Return the payload."""
        return finish_writing(self._coder)
