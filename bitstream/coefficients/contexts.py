"""What surrounds a coefficient: the magnitudes already coded that tell how large it will be.

Magnitudes fall with frequency and resemble each other between neighbouring frequencies, between coordinates, and from
block to block. An *expectation* is a sum of such neighbours with fixed integer weights. The weights were fitted so that
a geometric distribution with the expectation as its mean gives real coefficients the greatest likelihood.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from bitstream.entropy.range_coder import leaf

Magnitudes = npt.NDArray[np.int64]

NEIGHBOURS = 20
"""Inputs of an expectation."""
SITUATIONS = 6
"""Each has its own weights: first block of a chain or a later one, times coordinate."""
UNIT = 16
"""An input of a level of 1; expectations are in 1 / UNIT, too."""
WEIGHT_BITS = 10
"""A weight of 1.0 is 1 << WEIGHT_BITS."""
BINS = 48
"""Three to the octave."""

_CEILING = 1 << 15
_ABOVE = 8  # rows of zeros in front of the first frequency, as far as any neighbour reaches
_BEYOND = 3  # and behind the last
_MEMORY = 8  # blocks over which the usual magnitudes are averaged


class Past(NamedTuple):
    """Magnitudes of a chain's coefficients so far; row _ABOVE is the lowest frequency, each column a coordinate.

    Attributes
    ----------
    current, before : int64 arrays, shape (_ABOVE + width + _BEYOND, 3)
        In the block being coded and in the block before it, zero where there is none.
    usual : int64 array, same shape
        Running mean over the blocks, in 1 / UNIT.
    blocks : int64 array, shape (1,)
        Number of blocks before the current one.
    """

    current: Magnitudes
    before: Magnitudes
    usual: Magnitudes
    blocks: Magnitudes


def make_past(width: int) -> Past:
    """The past of a chain that has none, for blocks of at most `width` rows."""
    shape = (_ABOVE + width + _BEYOND, 3)
    return Past(np.zeros(shape, np.int64), np.zeros(shape, np.int64), np.zeros(shape, np.int64), np.zeros(1, np.int64))


@leaf
def situation(past: Past, coordinate: int) -> int:
    """Number of the weights for a coefficient."""
    return coordinate + (3 if past.blocks[0] == 0 else 0)


@leaf
def note_level(past: Past, row: int, coordinate: int, level: int) -> None:
    """Add a level to the current block."""
    past.current[_ABOVE + row, coordinate] = min(abs(level), _CEILING)


@leaf
def take_over(past: Past, other: Past, row: int) -> None:
    """Copy from `other` what the current block's coefficients from `row` on have as neighbours."""
    for j in range(row, row + _ABOVE + 1):
        for d in range(3):
            past.current[j, d] = other.current[j, d]


@leaf
def look_around(past: Past, row: int, coordinate: int, out: Magnitudes) -> None:
    """Write the NEIGHBOURS inputs of the expectations of a coefficient to `out`.

    Known are all rows above it, and the coordinates before its own in its row.
    """
    now, before, usual, _ = past
    j, d = _ABOVE + row, coordinate
    e, f = (d + 1) % 3, (d + 2) % 3
    out[0] = 16 * now[j - 1, d]
    out[1] = 16 * now[j - 2, d]
    out[2] = 16 * now[j - 3, d]
    out[3] = 8 * (now[j - 4, d] + now[j - 5, d])
    out[4] = 4 * (now[j - 6, d] + now[j - 7, d] + 2 * now[j - 8, d])
    out[5] = 16 * now[j, d - 1] if d > 0 else 0
    out[6] = 16 * now[j, d - 2] if d > 1 else 0
    out[7] = 8 * (now[j - 1, e] + now[j - 1, f])
    out[8] = 4 * (now[j - 2, e] + now[j - 2, f] + now[j - 3, e] + now[j - 3, f])
    out[9] = 16 * before[j, d]
    out[10] = 8 * (before[j - 1, d] + before[j + 1, d])
    out[11] = 4 * (before[j - 2, d] + before[j + 2, d] + before[j - 3, d] + before[j + 3, d])
    out[12] = 8 * (before[j, e] + before[j, f])
    out[13] = 4 * (before[j - 1, e] + before[j - 1, f] + before[j + 1, e] + before[j + 1, f])
    out[14] = usual[j, d]
    out[15] = (usual[j - 1, d] + usual[j + 1, d]) >> 1
    out[16] = (usual[j, e] + usual[j, f]) >> 1
    out[17] = UNIT
    out[18] = 16 * UNIT // (row + 1)
    out[19] = 64 * UNIT // ((row + 1) * (row + 1))


@leaf
def expectation_bin(weights: npt.NDArray[np.int64], inputs: Magnitudes) -> Any:
    """Logarithm of an expectation, in thirds of an octave (each of them linear inside), 0 .. BINS - 1."""
    total = np.int64(0)
    for i in range(NEIGHBOURS):
        total += weights[i] * inputs[i]
    total >>= WEIGHT_BITS
    if total < 1:
        return 0
    octave, top = 0, total
    while top > 1:
        top >>= 1
        octave += 1
    fraction = (3 * (total - (1 << octave))) >> octave
    return min(3 * octave + fraction, BINS - 1)


@leaf
def close_block(past: Past) -> None:
    """Make the current block the one before, and start the next."""
    now, before, usual, blocks = past
    share = min(blocks[0] + 1, _MEMORY)
    for j in range(_ABOVE, now.shape[0] - _BEYOND):
        for d in range(3):
            before[j, d] = now[j, d]
            usual[j, d] += (UNIT * now[j, d] - usual[j, d]) // share
            now[j, d] = 0
    blocks[0] += 1
