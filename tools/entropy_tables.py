"""Write the tables of the mixer (`bitstream/entropy/tables.c`) by exact integers: the same everywhere.

    python -m tools.entropy_tables [--check]

Specification, C 2.1, C 2.2 and C 2.6. With --check, nothing is written, and what is there must be the same.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import numpy.typing as npt

from tools.c_tables import rows, write_or_check

PATH = Path(__file__).parents[1] / "bitstream" / "entropy" / "tables.c"
ONE = 1 << 16
SQUASH_REACH = 2880
STRETCH_BITS = 12
COUNT_BITS = 10

_HEAD = """\
/* Written by `python -m tools.entropy_tables`, which says how; do not edit. */
#include "bitstream/entropy/entropy.h"
"""


def squash_table() -> npt.NDArray[np.int32]:
    """ONE / (1 + exp(-x / 256)) for x = -SQUASH_REACH .. SQUASH_REACH - 1, rounded, within 1 .. ONE - 1."""
    scale = 1 << 128
    step, term = scale, scale  # exp(1/256) by its series
    for k in range(1, 20):
        term //= 256 * k
        step += term
    powers = [scale]  # exp(x / 256)
    for _ in range(SQUASH_REACH):
        powers.append(powers[-1] * step // scale)
    upper = [(2 * ONE * power + power + scale) // (2 * (power + scale)) for power in powers]
    table = [ONE - upper[x] for x in range(SQUASH_REACH, 0, -1)] + upper[:SQUASH_REACH]
    return np.clip(np.array(table, dtype=np.int32), 1, ONE - 1)


def stretch_table() -> npt.NDArray[np.int32]:
    """The least log-odds whose probability reaches the middle of each of 2**STRETCH_BITS equal cells, made odd."""
    half = 1 << (STRETCH_BITS - 1)
    width = ONE >> STRETCH_BITS
    centers = (np.arange(half, 2 * half) * width) + width // 2
    upper = np.searchsorted(squash_table(), centers, side="left").astype(np.int32) - SQUASH_REACH
    return np.concatenate([-upper[::-1], upper])


def reciprocal_table() -> npt.NDArray[np.int32]:
    """ONE / (n + 1.5), rounded down, for every count n."""
    return np.array([2 * ONE // (2 * n + 3) for n in range(1 << COUNT_BITS)], dtype=np.int32)


def source() -> str:
    """The C file that holds the tables."""
    return _HEAD + "".join(
        f"\nconst {kind} {name}[{len(table)}] = {{\n{rows(table.tolist())}}};\n"
        for kind, name, table in (
            ("uint16_t", "SQUASH", squash_table()),
            ("int16_t", "STRETCH", stretch_table()),
            ("uint16_t", "RECIPROCAL", reciprocal_table()),
        )
    )


def main() -> int:
    """Run the command."""
    return write_or_check(PATH, source(), "tools.entropy_tables", __doc__.split("\n")[0])


if __name__ == "__main__":
    sys.exit(main())
