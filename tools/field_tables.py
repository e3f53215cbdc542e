"""Write the tables of integer fields (`bitstream/fields/tables.c`) by exact integers: the same everywhere.

    python -m tools.field_tables [--check]

Specification, V 4.1 and V 4.2. With --check, nothing is written, and what is there must be the same.
"""

from __future__ import annotations

import sys
from pathlib import Path

from tools.c_tables import rows, write_or_check

PATH = Path(__file__).parents[1] / "bitstream" / "fields" / "tables.c"
ONE = 1 << 128
"""1.0 in fixed point."""

SHAPE = ((1, 16, 1), (2, 4, 1), (4, 3, 2), (1, 1, 1), (1, 1, 3))
"""Weight and 1 / scale (as a fraction) of the logistic distributions that errors follow: from a peak to the tails."""

_HEAD = """\
/* Written by `python -m tools.field_tables`, which says how; do not edit. */
#include "bitstream/fields/fields.h"
"""


def exponential(numerator: int, denominator: int) -> int:
    """exp(numerator / denominator) in fixed point."""
    whole, rest = divmod(abs(numerator), denominator)
    result = _series(rest * ONE // denominator)
    for _ in range(whole):
        result = result * _series(ONE) // ONE
    return result if numerator >= 0 else ONE * ONE // result


def _series(x: int) -> int:
    """exp(x) for x in 0 .. 1, in fixed point."""
    total = term = ONE
    k = 0
    while term:
        k += 1
        term = term * x // (k * ONE)
        total += term
    return total


def logarithm(x: int) -> int:
    """Natural logarithm of a positive number in fixed point."""
    exponent = x.bit_length() - ONE.bit_length()
    return _log(x >> exponent if exponent >= 0 else x << -exponent) + exponent * _log(2 * ONE)


def _log(x: int) -> int:
    """Natural logarithm for x in 1 .. 2, by that of (1 + t) / (1 - t)."""
    t = (x - ONE) * ONE // (x + ONE)
    square, term, total, k = t * t // ONE, t, 0, 1
    while term:
        total += term // k
        term = term * square // ONE
        k += 2
    return 2 * total


def survival_table() -> list[int]:
    """-ln of the probability that an error exceeds i / 32 of its scale, i = -512 .. 512, in 2**-16 nat."""
    total = sum(weight for weight, _, _ in SHAPE)
    table = []
    for i in range(-512, 513):
        tail = sum(w * (ONE * ONE // (ONE + exponential(i * num, 32 * den))) for w, num, den in SHAPE) // total
        table.append(_rounded(-logarithm(tail), 1 << 16))
    return table


def odds_tables() -> tuple[list[int], list[int]]:
    """ln(exp(d) - 1) and ln(1 - exp(-d)), in 1/256 nat within -4000 .. 4000, for d that five bits and an exponent tell.

    Entry i is for d = i below 32 (0 counting as 1/2), then for the middle of the d >> e = 32 + i % 32 with
    e = i // 32 - 1; d in 2**-16 nat.
    """
    odds, less = [], []
    for i in range(544):
        twice = max(2 * i, 1) if i < 32 else (2 * (32 + i % 32) + 1) << (i // 32 - 1)
        growth = logarithm(exponential(twice, 2 << 16) - ONE)
        odds.append(_rounded(growth, 256))
        less.append(_rounded(growth - twice * ONE // (2 << 16), 256))
    return [max(-4000, min(4000, x)) for x in odds], [max(-4000, min(4000, x)) for x in less]


def _rounded(x: int, unit: int) -> int:
    return (x * unit + ONE // 2) // ONE


def source() -> str:
    """The C file that holds the tables."""
    odds, less = odds_tables()
    return _HEAD + "".join(
        f"\nconst {kind} {name}[{len(table)}] = {{\n{rows(table)}}};\n"
        for kind, name, table in (
            ("int32_t", "SURVIVAL", survival_table()),
            ("int16_t", "ODDS", odds),
            ("int16_t", "LESS", less),
        )
    )


def main() -> int:
    """Run the command."""
    return write_or_check(PATH, source(), "tools.field_tables", __doc__.split("\n")[0])


if __name__ == "__main__":
    sys.exit(main())
