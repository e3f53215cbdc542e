"""What presets and options come to in pictures, against Draco at the same look: bytes, and how much can be seen.

    python -m tools.measure look MESH [MESH ...] [--presets small balanced fine] [--options theta=1.5 grid=12]

For each file: bytes; distance, 1 - SSIM and visible share by `bsm.look` (`spec/look.md`); and bytes over those of Draco
at the same 1 - SSIM, between two of its numbers of bits (both logarithms straight between them). Meshes go in as shapes
alone, with vertices at one position merged and degenerate faces left out; Draco's files are its smallest (level 10).
Needs DracoPy.
"""

from __future__ import annotations

import argparse
import itertools
import math
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import bsm
from bsm.bitstream.errors import BsmError
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.look.measure import Look, LookMetric
from bsm.console import Console, finite, print_json
from bsm.evaluation.curve import decode_draco, encode_draco
from tools.command import run_command
from tools.measure.grids import welded

BITS = range(6, 17)
PRESETS = ("small", "balanced", "fine", "near-lossless")


@dataclass(frozen=True)
class Draco:
    """Draco's file at a number of bits."""

    bits: int
    size: int
    look: Look


def draco_curve(mesh: TriangleMesh, looker: LookMetric) -> list[Draco]:
    """Draco at each of `BITS`."""
    found = []
    for bits in BITS:
        data = encode_draco(mesh, bits, 10)
        found.append(Draco(bits, len(data), looker.compare(decode_draco(data))))
    return found


def size_at(curve: list[Draco], dissimilarity: float) -> float:
    """Bytes that Draco would take for a look; nan outside its numbers of bits."""
    for coarse, fine in itertools.pairwise(curve):
        high, low = coarse.look.dissimilarity, fine.look.dissimilarity
        if high >= dissimilarity >= low > 0.0:
            share = math.log(high / dissimilarity) / math.log(high / low) if high > low else 0.0
            return math.exp((1.0 - share) * math.log(coarse.size) + share * math.log(fine.size))
    return math.nan


def measure(path: str, wishes: dict[str, dict[str, Any]]) -> list[dict[str, Any]]:
    """A row for Draco's default, and one for each wish."""
    positions, faces = welded(path)
    mesh = TriangleMesh(positions.astype(np.float64), faces)
    looker = LookMetric(mesh)
    curve = draco_curve(mesh, looker)
    default = next(point for point in curve if point.bits == 11)
    rows = [row(path, "Draco, 11 bits", default.size, default.look, 1.0)]
    for name, keywords in wishes.items():
        start = time.process_time()
        try:
            data = bsm.encode(mesh, **keywords)
        except BsmError as error:
            rows.append({"mesh": Path(path).stem, "what": name, "error": str(error)})
            continue
        spent = time.process_time() - start
        look = looker.compare(bsm.decode(data))
        rows.append(row(path, name, len(data), look, len(data) / size_at(curve, look.dissimilarity), spent))
    return rows


def row(path: str, what: str, size: int, look: Look, ratio: float, seconds: float = 0.0) -> dict[str, Any]:
    """Describe a file."""
    return {
        "mesh": Path(path).stem, "what": what, "bytes": size, "distance": look.distance,
        "dissimilarity": look.dissimilarity, "visible": look.visible, "over_draco": finite(ratio), "encode_s": seconds,
    }  # fmt: skip


def keyword(text: str) -> tuple[str, dict[str, Any]]:
    """`theta=1.5` as a wish."""
    name, _, value = text.partition("=")
    return text, {name: int(value) if value.lstrip("-").isdigit() else float(value)}


def line(found: dict[str, Any]) -> str:
    """A row of the table."""
    if "error" in found:
        return f"| {found['mesh']} | {found['what']} | {found['error']} | | | | |"
    seen = f"{found['distance']:.2f} | {found['dissimilarity']:.4f} | {100 * found['visible']:.2f} %"
    ratio = "-" if found["over_draco"] is None else f"{found['over_draco']:.3f}"
    return f"| {found['mesh']} | {found['what']} | {found['bytes']:,} | {seen} | {ratio} |"


def work(options: argparse.Namespace, _: Console) -> None:
    """Measure and print."""
    wishes = {name: {"preset": name} for name in options.presets} | dict(map(keyword, options.options))
    rows = []
    if not options.json:
        print("| mesh | what | bytes | distance | 1 - SSIM | visible | over Draco's |\n|---|---|---|---|---|---|---|")
    for path in options.meshes:
        for found in measure(path, wishes):
            rows.append(found)
            if not options.json:
                print(line(found), flush=True)
    if options.json:
        print_json({"rows": rows})
        return
    for name in wishes:
        ratios = [found.get("over_draco") for found in rows if found["what"] == name]
        known = [ratio for ratio in ratios if ratio is not None]
        if known:
            print(f"| mean of {len(known)} | {name} | | | | | {np.mean(known):.3f} |")


def main() -> None:
    """Run the command."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("meshes", nargs="+", metavar="MESH")
    parser.add_argument("--presets", nargs="*", default=PRESETS, metavar="NAME")
    parser.add_argument("--options", nargs="*", default=[], metavar="NAME=NUMBER", help="other ways to ask, one each")
    parser.add_argument("--json", action="store_true", help="print numbers as JSON")
    run_command(parser, work)
