"""What surrounds a coefficient: the magnitudes already coded that tell how large it will be.

Magnitudes fall with frequency and resemble each other between neighbouring frequencies, between coordinates, and from
block to block. An *expectation* is a sum of such neighbours with fixed integer weights. The weights were fitted so that
a geometric distribution with the expectation as its mean gives real coefficients the greatest likelihood.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from bsm.bitstream import _kernels

Magnitudes = npt.NDArray[np.int32]

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

_ABOVE = 8  # rows of zeros in front of the first frequency, as far as any neighbour reaches
_BEYOND = 3  # and behind the last


class Past(NamedTuple):
    """Magnitudes of a chain's coefficients so far; row _ABOVE is the lowest frequency, each column a coordinate."""

    current: Magnitudes
    before: Magnitudes
    usual: Magnitudes
    blocks: npt.NDArray[np.int64]


def make_past(width: int) -> Past:
    """The past of a chain that has none, for blocks of at most `width` rows."""
    shape = (_ABOVE + width + _BEYOND, 3)
    return Past(np.zeros(shape, np.int32), np.zeros(shape, np.int32), np.zeros(shape, np.int32), np.zeros(1, np.int64))


def copy_past(past: Past) -> Past:
    """An independent copy."""
    return Past(past.current.copy(), past.before.copy(), past.usual.copy(), past.blocks.copy())


def look_at_block(past: Past, levels: Magnitudes) -> Magnitudes:
    """The inputs of the expectations of a block's coefficients, shape (c, 3); the block becomes a part of `past`."""
    inputs = np.empty((levels.size, NEIGHBOURS), np.int32)
    _kernels.look_at_block(past, levels, inputs)
    return inputs


def expectation_bin(weights: Magnitudes, inputs: Magnitudes) -> int:
    """Logarithm of an expectation, in thirds of an octave (each of them linear inside), 0 .. BINS - 1."""
    return _kernels.bin_of_expectation(weights, inputs)
