"""Entropy coding of a sequence's levels: matrices whose rows are frequencies and whose columns are components.

A row is one spatial frequency of a block, or one temporal frequency of a basis; a column is one component of the
temporal transform, or one coordinate. Each level is coded with the magnitudes of its neighbours in both directions
and of the same place in a reference matrix (the block before, or the same block one frame before) as contexts, which
the mixer of `bitstream.entropy.range_coder` weighs. All arithmetic is on integers.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
from numba import njit

from bitstream.entropy.range_coder import (
    Bank,
    code_signed,
    code_uniform,
    finish_reading,
    finish_writing,
    leaf,
    make_bank,
    overran,
    signed_span,
    start_reading,
    start_writing,
)
from bitstream.errors import CorruptError

Levels = npt.NDArray[np.int32]

_INPUTS = 6
_UNARY = 14
_SPAN = signed_span(_UNARY)
_CLASSES = 12
_ROWS = 40
_SQUARE = _CLASSES * _CLASSES
_CONTEXTS = (_SQUARE, _SQUARE, _SQUARE, _SQUARE, _SQUARE, _CLASSES * _ROWS)
_BASES = np.concatenate([[0], np.cumsum(_CONTEXTS)]).astype(np.int64) * _SPAN
_SELECTORS = 3 * _SPAN


def make_level_bank() -> Bank:
    """The adaptive state of a level coder, neutral; one for each sequence of payloads that learn from each other."""
    return make_bank(int(_BASES[-1]), _SELECTORS, _INPUTS, limit=400, rate=10)


def encode_levels(bank: Bank, matrices: Sequence[Levels], references: Sequence[Levels]) -> bytes:
    """Code matrices one behind the other.

    Parameters
    ----------
    bank : Bank
        Is updated.
    matrices : sequence of int32 arrays, shapes (rows_k, columns), C-contiguous
        All with the same number of columns.
    references : sequence of int32 arrays, shapes (any, columns), C-contiguous
        What each matrix is expected to resemble in magnitude; may be an earlier matrix of `matrices`.
    """
    coder = start_writing(16 * sum(m.size for m in matrices) + 8 * len(matrices) + 64)
    for matrix, reference in zip(matrices, references, strict=True):
        occupied = np.flatnonzero(matrix.any(axis=1))
        _code_matrix(coder, bank, matrix, reference, int(occupied[-1]) + 1 if len(occupied) else 0)
    return finish_writing(coder)


def decode_levels(bank: Bank, payload: bytes, matrices: Sequence[Levels], references: Sequence[Levels]) -> None:
    """Twin of `encode_levels`: fill `matrices`, which hold zeros.

    Raises
    ------
    TruncatedError, CorruptError
        If the payload does not hold exactly these matrices.
    """
    coder = start_reading(payload)
    for matrix, reference in zip(matrices, references, strict=True):
        rows = _code_matrix(coder, bank, matrix, reference, 0)
        if rows > len(matrix):
            raise CorruptError(f"{rows} rows of levels where there can be {len(matrix)}")
        if overran(coder):
            break
    finish_reading(coder)


@leaf
def _class(value):  # type: ignore[no-untyped-def]
    """Magnitude class 0 .. 11 of a sum of magnitudes."""
    if value < 5:
        return value
    if value < 7:
        return 5
    if value < 10:
        return 6
    if value < 15:
        return 7
    if value < 25:
        return 8
    if value < 50:
        return 9
    if value < 150:
        return 10
    return 11


@leaf
def _octave(value):  # type: ignore[no-untyped-def]
    """Bits of an index, 0 .. 11."""
    bits = 0
    while value > 0 and bits < 11:
        value >>= 1
        bits += 1
    return bits


@leaf
def _at(matrix, row, column):  # type: ignore[no-untyped-def]
    """Magnitude in a matrix, zero outside."""
    if row < 0 or column < 0 or row >= matrix.shape[0] or column >= matrix.shape[1]:
        return 0
    return abs(matrix[row, column])


@njit(cache=True, nogil=True)
def _code_matrix(coder, bank, levels, reference, rows):  # type: ignore[no-untyped-def]
    """Code the number of rows that are not zero behind, and these rows; returns that number."""
    rows = code_uniform(coder, rows, levels.shape[0] + 1)
    if rows > levels.shape[0]:
        return rows
    columns = levels.shape[1]
    contexts = np.empty(_INPUTS, np.int64)
    slow = np.zeros(columns, np.int64)
    for j in range(rows):
        if overran(coder):
            break
        band = _octave(j)
        selector = _SPAN * (0 if j == 0 else (1 if j < 12 else 2))
        place = min(_ROWS - 1, j if j < 20 else 20 + (j - 20) // 8)
        row_mean = 0
        for i in range(columns):
            above = 2 * _at(levels, j - 1, i) + _at(levels, j - 2, i) + _at(levels, j - 3, i)
            left = 2 * _at(levels, j, i - 1) + _at(levels, j, i - 2)
            around = _at(levels, j - 1, i + 1) + _at(levels, j - 1, i - 1)
            before = 2 * _at(reference, j, i) + _at(reference, j - 1, i) + _at(reference, j + 1, i)
            column_mean = _class(slow[i] >> 4)
            contexts[0] = _BASES[0] + _SPAN * (_CLASSES * band + column_mean)
            contexts[1] = _BASES[1] + _SPAN * (_CLASSES * _octave(i) + _class(above))
            contexts[2] = _BASES[2] + _SPAN * (_CLASSES * _class(before) + column_mean)
            contexts[3] = _BASES[3] + _SPAN * (_CLASSES * _class(above) + _class(left))
            contexts[4] = _BASES[4] + _SPAN * (
                _CLASSES * _class(row_mean >> 5) + _class((above + left + around + before) >> 1)
            )
            contexts[5] = _BASES[5] + _SPAN * (_ROWS * _class(left + around) + place)
            level = code_signed(coder, bank, contexts, selector, _UNARY, levels[j, i])
            levels[j, i] = level
            magnitude = min(abs(level), 4096)
            slow[i] += ((magnitude << 6) - slow[i]) >> 2
            row_mean += ((magnitude << 7) - row_mean) >> 2
    return rows
