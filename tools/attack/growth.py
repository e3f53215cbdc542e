"""`python -m tools.attack growth`: files that are large in one place, read at four times the size.

Of the files of `readers` that grow; they must not take longer by more than `MOST_GROWTH`.
"""

import tempfile
from collections.abc import Callable
from functools import partial
from pathlib import Path

from bsm.bitstream.limits import Limits
from tools.attack.readers import Sample, grown, is_ours, reading, warm_up
from tools.attack.taken import report, taken_by_each
from tools.command import parser_of

SIZE = 1 << 16
"""Bytes of files before they grow."""
MOST_GROWTH, LEAST_SECONDS = 4.5, 0.1
"""How much longer four times the bytes may take, and how long that is before it is asked."""


def growth(make: Callable[[int], Sample], most: float = MOST_GROWTH, times: int = 4) -> str | None:
    """How much longer a file takes at four times its size, if that is too much every time."""
    least = [float("inf")] * 2
    for _ in range(times):
        with tempfile.TemporaryDirectory() as folder:
            works = [
                partial(reading, partial(make, size), Path(folder), Limits())
                for size in (SIZE, 4 * SIZE)
            ]
            for number, cost in enumerate(taken_by_each(works, seconds=30)):
                least[number] = min(least[number], float("inf") if cost.escaped else cost.seconds)
        if least[1] < max(LEAST_SECONDS, most * least[0]):
            return None
    return f"{least[0]:.3f} s at {SIZE} bytes, {least[1]:.3f} s at {4 * SIZE}: {least[1] / least[0]:.1f} times as long"


def main() -> int:
    """Run the command."""
    parser = parser_of(__doc__)
    parser.add_argument(
        "--most",
        type=float,
        default=MOST_GROWTH,
        help="growth at four times (default: %(default)s)",
    )
    most = parser.parse_args().most
    warm_up()
    growths = {
        name: growth(lambda size, name=name: grown(size)[name](), most)  # type: ignore[misc]
        for name in filter(is_ours, grown(1))
    }
    return report(
        (f"{name}: {problem}" for name, problem in growths.items() if problem),
        f"{len(growths)} files",
    )
