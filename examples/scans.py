"""A folder of scans: remove their noise, encode what comes out, and say what came of each.

    python examples/scans.py SCANS OUT

Needs the extra `denoise`. A file that fails stops no other; run it again and what is there stays.
"""

from __future__ import annotations

import argparse
import csv
from collections import Counter
from pathlib import Path

import bsm

FORMATS = (".ply", ".obj", ".stl", ".off")


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("scans", type=Path, help="folder of meshes; folders in it are mirrored")
    parser.add_argument("out", type=Path, help="folder for streams, and for report.csv")
    parser.add_argument("--preset", default="fine", help="how well meshes are kept (default: fine)")
    args = parser.parse_args()
    rows = []
    paths = sorted(path for path in args.scans.rglob("*") if path.suffix.lower() in FORMATS)
    often = Counter(path.with_suffix("") for path in paths)
    for path in paths:
        target = args.out / path.relative_to(args.scans).with_suffix(".bsm")
        if often[path.with_suffix("")] > 1:  # a.obj and a.ply, which would both become a.bsm
            target = target.with_name(f"{path.name}.bsm")
        target.parent.mkdir(parents=True, exist_ok=True)
        rows.append(row(path, target, args.preset))
        print(*rows[-1].values(), sep="  ")
    with (args.out / "report.csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, ("file", "bytes", "stream", "moved", "status"))
        writer.writeheader()
        writer.writerows(rows)


def row(path: Path, target: Path, preset: str) -> dict[str, object]:
    """What came of one scan."""
    made: dict[str, object] = {
        "file": path.name,
        "bytes": "",
        "stream": "",
        "moved": "",
        "status": "",
    }
    try:
        made["bytes"] = path.stat().st_size
        if target.exists():
            return made | {"stream": target.stat().st_size, "status": "was there"}
        scan = bsm.load(path)
        clean = bsm.denoise(scan)
        bsm.save(clean, target, preset=preset)
        moved = bsm.compare(scan, clean).max_error_relative
        return made | {"stream": target.stat().st_size, "moved": f"{100 * moved:.3f} %"}
    except (bsm.BsmError, OSError) as error:
        return made | {"status": str(error)}


if __name__ == "__main__":
    main()
