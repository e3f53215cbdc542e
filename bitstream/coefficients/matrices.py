"""Levels of sequences: rows are frequencies, columns components, contexts are neighbors and a reference (S 4)."""

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from bsm._core import bitstream as _kernels
from bsm.bitstream.entropy import range_coder as entropy

Levels = npt.NDArray[np.int32]
Lead: TypeAlias = tuple[int, int]
"""Columns coded of the first row, and more of each next one; without a lead all, after a third those with any."""

_Extent: TypeAlias = tuple[int, int, int, int]  # a lead, the row from which on few columns are coded, and how many


def make_level_bank() -> entropy.Bank:
    """The adaptive state of a level coder, neutral; one for each sequence of payloads that learn from each other."""
    return entropy.bank_of("code_matrix")


def write_levels(
    coder: entropy.Coder, bank: entropy.Bank, matrix: Levels, reference: Levels, lead: Lead | None = None
) -> entropy.Coder:
    """Code a matrix behind what `coder` has; returns the coder that goes on."""
    coder = entropy.make_room(coder, 16 * matrix.size + 64)
    code_matrix(coder, bank, matrix, reference, _occupied(matrix), extent_of(matrix, lead))
    return coder


def _occupied(matrix: Levels) -> int:
    occupied = np.flatnonzero(matrix.any(axis=1))
    return int(occupied[-1]) + 1 if len(occupied) else 0


def extent_of(matrix: Levels, lead: Lead | None) -> _Extent:
    """The coded part of a matrix, shape (rows, columns), with known levels, or with zeros to be read."""
    rows, columns = matrix.shape
    if lead is not None:
        first, more = lead
        return min(first, columns), min(more, columns), rows, columns
    turn = -(-rows // 2)
    used = np.flatnonzero(matrix[turn:].any(axis=0))
    return columns, 0, turn, int(used[-1]) + 1 if len(used) else 0


def code_matrix(
    coder: entropy.Coder, bank: entropy.Bank, levels: Levels, reference: Levels, rows: int, extent: _Extent
) -> None:
    _kernels.code_matrix(coder, bank, levels, reference, rows, *extent, np.empty(levels.shape[1], np.int64))
