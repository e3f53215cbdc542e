"""`python -m tools.attack bombs`: decode every bomb in a process of its own, and hold what it took against the bounds.

Exit code 1 if one takes more than it may: by default 64 MiB and 1 s, 1 KiB and 40 microseconds for each vertex and 64
bytes and 20 microseconds for each byte; with `--limits service` 1 GiB and 10 s. The bounds of the
decoder for browsers are those of tools/web/README.md.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from dataclasses import replace
from pathlib import Path

from tools.attack.measure import HOWS, Taken, bounds, browser_bounds, taken_by
from tools.attack.streams import BOMBS

COLUMNS = "{:16} {:8} {:>9} {:>9} {:>8} of {:>8} MiB {:>7} of {:>7} s  {:7} {}"


def main() -> int:
    """Run the command."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"bombs, or streams (.bsm); all: {', '.join(BOMBS)}")
    parser.add_argument("--limits", choices=("default", "service"), default="default")
    parser.add_argument(
        "--how",
        choices=HOWS,
        nargs="+",
        default=HOWS[:2],
        help="default: events whole; browser: by the decoder for browsers, in Node",
    )
    parser.add_argument("--write", type=Path, metavar="FOLDER", help="only write the streams there")
    args = parser.parse_args()
    names = args.names or list(BOMBS)
    if args.write:
        for name in names:
            (args.write / f"{name}.bsm").write_bytes(BOMBS[name]())
        return 0
    print(COLUMNS.format("bomb", "decoded", "bytes", "vertices", "memory", "", "CPU", "", "verdict", "outcome"))
    with tempfile.TemporaryDirectory() as folder:
        failed = [name for name in names if not _holds(name, Path(folder), args)]
    print(f"{len(names)} bombs, {len(failed)} take more than they may: {' '.join(failed) or 'none'}")
    return 1 if failed else 0


def _holds(name: str, folder: Path, args: argparse.Namespace) -> bool:
    """Measure one stream, print what it took, and say whether that is within the bounds."""
    path = Path(name)
    if path.suffix != ".bsm":
        path = folder / f"{name}.bsm"
        path.write_bytes(BOMBS[name]())
    stream = path.read_bytes()
    results = {how: taken_by(path, how, args.limits) for how in args.how}
    vertices = max(result.vertices for result in results.values())  # one that is refused as a whole tells none
    good = True
    for how, result in results.items():
        known = replace(result, vertices=vertices)
        browser = how == "browser"
        memory, seconds = browser_bounds(known, stream) if browser else bounds(args.limits, known, len(stream))
        holds = result.memory <= memory and result.seconds <= seconds
        good &= holds
        print(_row(path.stem, how, len(stream), vertices, result, memory, seconds, holds), flush=True)
    return good


def _row(
    name: str, how: str, size: int, vertices: int, result: Taken, memory: float, seconds: float, holds: bool
) -> str:
    megabytes = [f"{value / 2**20:.1f}" for value in (result.memory, memory)]
    times = [f"{value:.2f}" for value in (result.seconds, seconds)]
    return COLUMNS.format(
        name, how, size, vertices, *megabytes, *times, "holds" if holds else "FAILED", result.outcome[:90]
    )


if __name__ == "__main__":
    sys.exit(main())
