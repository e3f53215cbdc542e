"""Levels of sequences: rows are frequencies, columns components, contexts are neighbors and a reference (S 4)."""

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from bsm._core import bitstream as _kernels
from bsm._core.bitstream import constant
from bsm.bitstream.coefficients.adaptive import COSTS
from bsm.bitstream.entropy import range_coder as entropy

Levels = npt.NDArray[np.int32]
Prices = npt.NDArray[np.int16]
Lead: TypeAlias = tuple[int, int]
"""Columns coded of the first row, and more of each next one; without a lead all, after a third those with any."""

_Extent: TypeAlias = tuple[int, int, int, int]  # a lead, the row from which on few columns are coded, and how many

_NEVER = np.iinfo(np.int16).max
PRICED = constant("PRICED")  # magnitudes, from 0 on, that `price_levels` tells the prices of


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


def first_prices(rows: int, columns: int, lead: Lead | None = None) -> Prices:
    """Prices before any are known, as of `price_levels`, of a matrix of shape (rows, columns)."""
    prices = np.zeros((rows, columns, 2, PRICED), np.int16)
    if lead is not None:
        first, more = lead
        prices[np.arange(columns) >= first + more * np.arange(rows)[:, None], :, 1:] = _NEVER
    return prices


def price_levels(bank: entropy.Bank, matrix: Levels, reference: Levels, lead: Lead | None = None) -> Prices:
    """What each place of a matrix would cost if it were coded next, and its neighbors as they are."""
    rows, columns = matrix.shape
    prices = first_prices(rows, columns, lead)
    coder, slow = entropy.start_writing(16 * matrix.size + 64), np.empty(columns, np.int64)
    twin, occupied, extent = entropy.copy_bank(bank), _occupied(matrix), extent_of(matrix, lead)
    _kernels.price_matrix(coder, twin, matrix, reference, occupied, *extent, slow, COSTS, prices.reshape(-1))
    return prices


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
