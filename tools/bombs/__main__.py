"""`python -m tools.bombs`: build the bombs, decode each in a process of its own, and hold what it took against the bounds.

Exit code 1 if a stream takes more.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

from tools.bombs.streams import BOMBS

KILLED = 40


def main() -> int:
    """Run the command."""
    parser = argparse.ArgumentParser(prog="python -m tools.bombs", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(BOMBS))
    parser.add_argument("--limits", choices=("default", "service"), default="default")
    args = parser.parse_args()
    failed = 0
    with tempfile.TemporaryDirectory() as folder:
        for name in args.names or BOMBS:
            given = Path(name)
            path = given if given.suffix == ".bsm" else Path(folder) / f"{name}.bsm"
            if path != given:
                path.write_bytes(BOMBS[name].make())
            data, n = path.stat().st_size, 0
            for how in ("events", "whole"):
                try:
                    done = subprocess.run(
                        [sys.executable, "-m", "tools.bombs.measure", str(path), how, args.limits],
                        capture_output=True,
                        text=True,
                        timeout=KILLED,
                    )
                    result = (
                        json.loads(done.stdout)
                        if done.returncode == 0
                        else {"outcome": done.stderr[-300:], "vertices": 0, "seconds": 999, "memory": 0}
                    )
                except subprocess.TimeoutExpired:
                    result = {"outcome": "killed", "vertices": 0, "seconds": KILLED, "memory": 0}
                n = max(n, result["vertices"])
                most_memory = (64 << 20) + 1024 * n + 64 * data
                most_seconds = 1 + 4e-5 * n + 2e-5 * data
                ok = result["memory"] <= most_memory and result["seconds"] <= most_seconds
                failed += not ok
                print(
                    f"{name:16} {how:6} {data:8} B {n:9} v {result['memory'] / 2**20:8.1f} of {most_memory / 2**20:8.1f} MiB {result['seconds']:7.2f} of {most_seconds:7.2f} s {'ok' if ok else 'FAILED'} {result['outcome'][:100]}",
                    flush=True,
                )
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
