"""The first minutes of a newcomer: install a wheel where there is no compiler, encode a mesh, draw what came of it.

    python -m tools.newcomer MESH                 with a wheel made of the last commit for this Python
    python -m tools.newcomer MESH --wheel FILE    with that one

Prints minutes by the clock and by the processor, with pip's downloads, without its cache. The making of the wheel is
not counted.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from tools.release.__main__ import exported
from tools.release.trial import without_compilers
from tools.release.wheels import INTEL, make_sdist, make_wheel

PIP = ".venv/bin/pip install -q --disable-pip-version-check --no-cache-dir --only-binary :all:"


def main() -> None:
    """Install, encode, draw, and say how long each took."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh", type=Path, help="a mesh file")
    parser.add_argument("--wheel", type=Path, help="what to install (default: make it, Linux on x86-64)")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        wheel = args.wheel or make_wheel(make_sdist(exported(folder), folder), Path(sys.executable), INTEL, folder)
        first_minutes(args.mesh.resolve(), wheel.resolve(), folder)


def first_minutes(mesh: Path, wheel: Path, folder: Path) -> None:
    """Do what a newcomer does, in a folder of no other use."""
    steps = {
        "install": f"{sys.executable} -m venv .venv && {PIP} {wheel}",
        "encode": f".venv/bin/bsm encode {mesh} -o first.bsm",
        "picture": f".venv/bin/bsm compare {mesh} first.bsm --picture first.png",
    }
    environment = without_compilers(folder)
    start, before = time.monotonic(), os.times()
    for name, command in steps.items():
        done = time.monotonic()
        subprocess.run(["bash", "-ec", command], cwd=folder, env=environment, check=True)
        print(f"{name}: {time.monotonic() - done:.1f} s")
    after = os.times()
    busy = after.children_user + after.children_system - before.children_user - before.children_system
    print(f"in all: {(time.monotonic() - start) / 60:.2f} minutes, {busy / 60:.2f} of a processor's")


if __name__ == "__main__":
    main()
