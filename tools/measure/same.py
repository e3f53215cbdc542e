"""Whether two checkouts write the same bytes; the exit code is 1 if they do not.

    python -m tools.measure same OTHER [--only TEXT]

OTHER is a checkout with kernels, or a file that `--write` wrote there. The streams are the vectors that can be made
again, and made meshes and sequences with many options.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import warnings
import zlib
from collections.abc import Callable, Iterator
from functools import partial
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

import bsm
from tools.made_shapes import made_shape
from tools.vectors.good_attributes import charts, colors, creases, groups, with_attributes
from tools.vectors.made import GOODS
from tools.vectors.meshes import hub, patch, shuffled, tangled, together, torus

Case = tuple[str, Callable[[], bytes]]
WAYS: dict[str, dict[str, Any]] = {
    "blocks": {"step": 1 / 256, "block_size": 60, "keep": 0.4},
    "large blocks": {"step": 1 / 512},
    "grid": {"grid": 10},
    "exact": {"exact": True},
    "quick": {"effort": "quick"},
    "default": {},
}
SEQUENCES: dict[str, dict[str, Any]] = {
    "frames": {"step": 1 / 256, "gop": 3},
    "frames, order": {"step": 1 / 64, "keep_order": True},
    "low delay": {"step": 1 / 256, "gop": 5, "low_delay": 2},
}
ATTRIBUTES = {"dressed": "exact", "coarser": "9bits"}
"""Meshes with attributes, and the quality of these."""


def shape(seed: int) -> bsm.TriangleMesh:
    """A closed mesh of some thousand vertices."""
    return bsm.TriangleMesh(*made_shape(seed, 24))


def heat(mesh: bsm.TriangleMesh) -> bsm.Attribute:
    """Doubles that change along the vertices."""
    return bsm.Attribute("heat", np.sin(9 * np.linspace(0, 1, len(mesh.positions))))


DRESS = (charts, creases, colors, groups, heat)


def cases() -> Iterator[Case]:
    """Name all streams, and say how each is made."""
    yield from ((f"vector {name}", good.make) for name, good in GOODS.items())
    meshes = {"torus": torus(30, 20), "hub": hub(), "tangled": tangled(), "patches": together(patch(9, 8), torus(8, 7))}
    meshes |= {"shuffled": shuffled(torus(25, 18)), **{f"shape {seed}": shape(seed) for seed in range(3)}}
    for (name, mesh), (way, options) in product(meshes.items(), WAYS.items()):
        yield f"{way} {name}", partial(bsm.encode, mesh, **options)
        yield f"{way} {name}, order", partial(bsm.encode, mesh, keep_order=True, **options)
        for what, quality in ATTRIBUTES.items():
            dressed = with_attributes(mesh, *DRESS)
            yield f"{way} {name}, {what}", partial(bsm.encode, dressed, attributes={"*": quality}, **options)
    for (name, mesh), (way, options) in product(meshes.items(), SEQUENCES.items()):
        frames = [mesh.positions * (1 + 0.02 * t) + 0.01 * np.sin(3 * mesh.positions + 0.3 * t) for t in range(7)]
        given = with_attributes(mesh, *DRESS).attributes if options.get("keep_order") else ()
        yield f"{way} {name}", partial(bsm.encode_sequence, frames, mesh.faces, mesh_attributes=given, **options)


def sums(only: str) -> dict[str, str]:
    """Checksum and size of each stream, or the error in its place."""
    found = {}
    warnings.simplefilter("ignore", bsm.BsmWarning)
    for name, make in cases():
        if only in name:
            try:
                data = make()
                found[name] = f"{zlib.crc32(data):08x} of {len(data)} bytes"
            except bsm.BsmError as error:
                found[name] = f"{type(error).__name__}: {error}"
    return found


def main() -> int:
    """Compare this checkout with another."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("other", type=Path, help="the other checkout, or its figures from --write")
    parser.add_argument("--only", default="", metavar="TEXT", help="only streams whose names hold this")
    parser.add_argument("--write", action="store_true", help="write the figures of this checkout to OTHER")
    args = parser.parse_args()
    if args.write:
        args.other.write_text(json.dumps(sums(args.only), indent=1))
        return 0
    if args.other.is_dir():
        paths = os.pathsep.join(map(str, (args.other / "src", args.other)))
        command = [sys.executable, __file__, "/dev/stdout", "--write", "--only", args.only]
        environment = os.environ | {"PYTHONPATH": paths}
        there = json.loads(subprocess.check_output(command, cwd=args.other, env=environment, text=True))
    else:
        there = json.loads(args.other.read_text())
    here = sums(args.only)
    missing = {name for name in there if args.only in name} - set(here)
    differing = [name for name in here if here[name] != there.get(name)]
    for name in differing:
        print(f"{name}: {here[name]}, there {there.get(name)}")
    print(f"{len(here) - len(differing)} of {len(here)} streams are the same, {len(missing)} are missing here")
    return int(bool(differing or missing))


if __name__ == "__main__":
    sys.exit(main())
