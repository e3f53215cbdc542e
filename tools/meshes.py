"""Check a folder of real meshes: that those which tables are measured on are there, and are the right ones.

    python -m tools.meshes FOLDER

What is missing or another mesh of the same name is listed, and the exit status is 1. Where they come from is told in
docs/guides/research.md.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from bsm.bitstream.errors import BsmError
from bsm.files.mesh import read_mesh

STATIC = {
    "armadillo_12502": (12502, 25000),
    "armadillo_20002_derived": (20002, 40000),
    "block": (8771, 17550),
    "bunny_34834": (34834, 69451),
    "c3d_spot": (2930, 5856),
    "cgal_elephant_with_holes": (2798, 4463),
    "dragon_22998": (22998, 47794),
    "dragon_437645": (437645, 871414),
    "fandisk_6475": (6475, 12946),
    "fr_casting": (9197, 18426),
    "fr_chinese_lion": (10003, 20000),
    "gargoyle_10002": (10002, 20000),
    "horse_48485": (48485, 96966),
    "julius_36201": (36201, 71912),
    "nicolo": (14846, 29437),
    "scan_angel": (24566, 48090),
    "sharpsphere": (10443, 20882),
    "trim_star": (5192, 10384),
    "twelve_dodecahedron": (4610, 9216),
}
"""Vertices and faces of `static/NAME.ply`."""
DYNAMIC = {"dance": (201, 7061), "horse_gallop": (48, 8431), "samba": (175, 9971)}
"""Frames and vertices of `dynamic/NAME.npz`."""


def main() -> None:
    """Check, and list what is wrong."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", metavar="FOLDER", type=Path, help="with static/ and dynamic/")
    folder = parser.parse_args().folder
    found = list(faults(folder))
    for fault in found:
        print(fault)
    print(f"{len(STATIC) + len(DYNAMIC) - len(found)} of {len(STATIC) + len(DYNAMIC)} are there and right")
    raise SystemExit(1 if found else 0)


def faults(folder: Path) -> Iterator[str]:
    """A sentence for each mesh that is missing or another one."""
    for name, expected in STATIC.items():
        path = folder / "static" / f"{name}.ply"
        try:
            mesh = read_mesh(path).mesh
        except (OSError, BsmError) as error:
            yield f"{path}: {error}"
            continue
        if (counts := (len(mesh.positions), len(mesh.faces))) != expected:
            yield f"{path}: {counts[0]} vertices and {counts[1]} faces, not {expected[0]} and {expected[1]}"
    for name, expected in DYNAMIC.items():
        path = folder / "dynamic" / f"{name}.npz"
        try:
            with np.load(path) as arrays:
                shape = arrays["positions"].shape[:2]
        except (OSError, KeyError, ValueError) as error:
            yield f"{path}: {error}"
            continue
        if shape != expected:
            yield f"{path}: {shape[0]} frames of {shape[1]} vertices, not {expected[0]} of {expected[1]}"


if __name__ == "__main__":
    main()
