"""How far parts of a mesh gape that are encoded apart, and what it costs that they do not.

    python -m tools.measure borders MESH [MESH ...] [--gap 0.001 0.0001]

Each mesh is cut in two by a plane across its longest side, through faces: each goes to the side of its middle, and both
parts have the vertices of the cut. Gaps are distances between what the two streams make of these.
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

import bsm
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.welding import weld
from bsm.codec.static.encoder import Encoder
from bsm.console import Console, print_json
from bsm.files.mesh import read_mesh
from bsm.options import encode_options
from tools.command import run_command

GRID_CELL = 2.0**-12
"""Of the shared grid: so many diagonals, about."""


@dataclass(frozen=True)
class Row:
    """What came of one way to encode both parts: bytes of both, and gaps between them in diagonals of the whole."""

    way: str
    bytes: int
    largest: float
    mean: float


def halves(mesh: TriangleMesh) -> tuple[TriangleMesh, TriangleMesh]:
    """Both parts, each with all vertices of the whole."""
    axis = int(np.argmax(np.ptp(mesh.positions, axis=0)))
    middles = mesh.positions[mesh.faces].mean(axis=1)[:, axis]
    low, high = mesh.positions[:, axis].min(), mesh.positions[:, axis].max()
    upper = middles > (low + high) / 2.0
    return TriangleMesh(mesh.positions, mesh.faces[upper]), TriangleMesh(mesh.positions, mesh.faces[~upper])


def decoded(part: TriangleMesh, keywords: dict[str, Any]) -> tuple[int, npt.NDArray[np.float64]]:
    """Bytes of a part, and where each vertex of the whole comes out; not a number for those that it has not."""
    encoder = Encoder(part, encode_options(**keywords))
    data = encoder.encode()
    positions = np.vstack([bsm.decode(data).positions, np.full(3, np.nan)])
    return len(data), positions[encoder.vertex_index]


def row(way: str, mesh: TriangleMesh, keywords: dict[str, Any]) -> Row:
    """Encode both parts in one way."""
    (first, one), (second, other) = (decoded(part, keywords) for part in halves(mesh))
    gaps = np.linalg.norm(one - other, axis=1)
    gaps = gaps[np.isfinite(gaps)] / mesh.diagonal
    return Row(way, first + second, float(gaps.max(initial=0.0)), float(gaps.mean()) if len(gaps) else 0.0)


def measure(path: str, gaps: list[float], preset: str) -> dict[str, Any]:
    """All ways for one mesh."""
    given = read_mesh(path).mesh
    positions, faces, _ = weld(given.positions, given.faces)
    mesh = TriangleMesh(positions, faces)
    cell = 2.0 ** round(np.log2(mesh.diagonal * GRID_CELL))
    ways: dict[str, dict[str, Any]] = {preset: {}}
    ways |= {f"{preset}, gap {gap:g}": {"lock_borders": gap} for gap in gaps}
    rows = [row(way, mesh, {"preset": preset, **keywords}) for way, keywords in ways.items()]
    rows.append(row(f"one grid, cell {cell / mesh.diagonal:.2g}", mesh, {"grid_cell": cell}))
    one, other = (set(np.unique(part.faces).tolist()) for part in halves(mesh))
    edges = np.linalg.norm(positions[faces[:, 0]] - positions[faces[:, 1]], axis=1)
    shared = len(one & other)
    return {"mesh": Path(path).stem, "vertices": len(positions), "shared": shared, "rows": [vars(r) for r in rows],
            "edge": float(edges.mean()) / mesh.diagonal}  # fmt: skip


def worded(found: dict[str, Any]) -> str:
    """A table of one mesh."""
    edge, plain = found["edge"], found["rows"][0]["bytes"]
    lines = [f"{found['mesh']}: {found['vertices']} vertices, {found['shared']} of them in both parts"]
    lines.append(f"  {'':28} {'bytes':>8} {'':>8} {'largest gap':>12} {'mean gap':>10} {'of an edge':>11}")
    for r in found["rows"]:
        more = f"{100.0 * (r['bytes'] / plain - 1.0):+.1f} %"
        lines.append(
            f"  {r['way']:28} {r['bytes']:8} {more:>8} {r['largest']:12.2e} {r['mean']:10.2e} {r['mean'] / edge:11.4f}"
        )
    return "\n".join(lines)


def work(args: argparse.Namespace, console: Console) -> None:
    """Print a table for each mesh."""
    done = []
    for path in args.meshes:
        done.append(measure(path, args.gap, args.preset))
        if not args.json:
            print(worded(done[-1]), flush=True)
    if args.json:
        print_json({"meshes": done})


def main() -> None:
    """Run the command."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("meshes", metavar="MESH", nargs="+", help="mesh file")
    parser.add_argument("--gap", type=float, nargs="+", default=[1e-3, 1e-4], help="relative gaps that are asked for")
    parser.add_argument("--preset", default="balanced", help="of blocks and layers (balanced)")
    parser.add_argument("--json", action="store_true", help="print it as JSON")
    run_command(parser, work)
