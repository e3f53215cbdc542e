"""Bytes of meshes by target, easiest first, and how much of each is used: `python -m tools.measure targets`.

Without files: two made meshes, beside the bytes in targets.json. The exit code is 1 if a file is larger than there by
more than 1 %, if an easier target takes more bytes than a stricter one, or if less than 92 % of one is used. `--write`
makes that file. With files: their table only.
"""

import argparse
import json
import sys
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path

from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.static.encoder import Encoder
from bsm.codec.static.options import PRESETS, EncodeOptions
from bsm.codec.static.targets import Contract, Target
from bsm.evaluation.sample import knot
from bsm.files.mesh import read_mesh
from bsm.ground.console import Console
from tools.command import run_command
from tools.made_shapes import made_shape

LARGER, USED, SCAN = 1.01, 0.9, 5
FIGURES = Path(__file__).with_suffix(".json")
TARGETS: dict[str, tuple[float, ...]] = {
    "look": (3.0, 1.0, 0.5),
    "theta_deg": (10.0, 7.0, 3.0),
    "nmsve_db": (-40.0, -48.0, -56.0),
    "max_error": (0.005, 0.002, 0.0005),
    "bpv": (4.0, 8.0, 16.0),
}
"""Targets, easiest first: `max_error` is a share of the diagonal."""


@dataclass(frozen=True)
class Row:
    """What a target came to."""

    what: str
    value: float
    size: int
    used: float
    seconds: float

    def __str__(self) -> str:
        return f"  {self.what:10} {self.value:<8g} {self.size:8} bytes, {self.used:.3f} used, {self.seconds:.2f} s"


def options_of(what: str, value: float) -> EncodeOptions:
    """The options that ask for a target and nothing else."""
    none = replace(PRESETS["none"], threads=1)
    if what == "look":
        return replace(none, contract=Contract(0.01, look=value, by_part=0.01))
    return (
        replace(none, contract=Contract(value))
        if what == "max_error"
        else replace(none, target=Target(what, value))
    )


def measured(
    mesh: TriangleMesh, targets: Mapping[str, tuple[float, ...]] = TARGETS
) -> Iterator[Row]:
    """The table of a mesh."""
    for what, values in targets.items():
        for value in values:
            begin, encoder = time.thread_time(), Encoder(mesh, options_of(what, value))
            found = encoder.result()
            seconds, compared = time.thread_time() - begin, found.comparison
            reached = {
                "look": encoder.look,
                "bpv": found.bpv,
                "max_error": compared.max_error_relative,
            }
            used = reached.get(what, getattr(compared, what, 0.0)) or 0.0
            share = 10.0 ** ((used - value) / 10.0) if what == "nmsve_db" else used / value
            yield Row(what, value, found.size, round(share, 3), seconds)


def faults(rows: list[Row], known: list[int]) -> Iterator[str]:
    """What is wrong with a table, beside the bytes of an earlier one."""
    for row, before in zip(rows, known or [row.size for row in rows], strict=True):
        if row.what != "bpv" and row.size > LARGER * before:
            yield f"{row} in place of {before}"
        if row.used < USED:
            yield f"{row}: not used up"
    for easier, stricter in pairwise(rows):
        if easier.what == stricter.what != "bpv" and easier.size > stricter.size:
            yield f"{easier}: more than {stricter}"


def work(args: argparse.Namespace, _: Console) -> None:
    """Print tables; without files, compare them with the file."""
    known = (
        json.loads(FIGURES.read_text())
        if FIGURES.exists() and not args.meshes and not args.write
        else {}
    )
    meshes = [(Path(path).stem, read_mesh(path).mesh.bare) for path in args.meshes]
    found, wrong = dict[str, list[int]](), list[str]()
    for name, mesh in meshes or [
        ("made rope", knot(2000)),
        ("made scan", TriangleMesh(*made_shape(SCAN, 32))),
    ]:
        print(f"{name}, {len(mesh.positions)} vertices", flush=True)
        rows = []
        for row in measured(mesh):
            rows.append(row)
            print(row, flush=True)
        found[name] = [row.size for row in rows]
        wrong += [f"{name}: {fault}" for fault in faults(rows, known.get(name, []))]
    if args.write:
        FIGURES.write_text(json.dumps(found) + "\n")
    if wrong and not args.meshes and not args.write:
        print("\n".join(wrong))
        sys.exit(1)


def main() -> None:
    """Run the command."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("meshes", metavar="MESH", nargs="*", help="mesh file, for its table")
    parser.add_argument(
        "--write",
        action="store_true",
        help="write targets.json, which later runs are compared with",
    )
    run_command(parser, work)
