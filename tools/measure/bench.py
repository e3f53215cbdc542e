"""Whole files against Draco, and dictionaries against exact eigensolvers: `python -m tools.measure bench MESH...`.

Solvers' times are CPU seconds of one thread, the least of several runs.
"""

import argparse
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import scipy.linalg
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import eigsh
from threadpoolctl import threadpool_limits

from bsm.codec.arrays import Matrix
from bsm.codec.basis.laplacian import dense_laplacian, solver_of
from bsm.codec.basis.orthogonal_iteration import cosine_columns
from bsm.codec.blocks.overlap import Blend, Block, block_size, derive_partition, grow_blocks
from bsm.codec.decoding import decode
from bsm.codec.geometry.graph import graph_of_faces
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.metrics import Reference
from bsm.codec.static.encoder import encode
from bsm.codec.static.options import EncodeOptions
from bsm.evaluation.curve import decode_draco, encode_draco, number, table, timed
from bsm.files.mesh import read_mesh

KEEPS = (0.10, 0.15, 0.20, 0.25)
POWERS = (1, 2, 4)
DRACO_BITS, DRACO_LEVEL = 9, 10
SHIFT = 0.125
_BLOCK_VERTICES, _OVERLAP = 500, 1.15
Result = dict[str, Any]


@dataclass(frozen=True)
class Solver:
    """An eigensolver for the `width` lowest eigenvectors of a dense Laplacian, shape (n, width)."""

    name: str
    solve: Callable[[Matrix, int], Matrix]
    whole: bool = False  # it finds all of them, however many are asked for


EXACT = (
    Solver("numpy svd, full", lambda a, c: np.linalg.svd(a)[0][:, ::-1][:, :c], whole=True),
    Solver("numpy eigh", lambda a, c: np.linalg.eigh(a)[1][:, :c], whole=True),
    Solver("scipy eigh, evr, subset", lambda a, c: scipy.linalg.eigh(a, subset_by_index=[0, c - 1])[1]),
    Solver(
        "ARPACK, shift-invert",
        lambda a, c: eigsh(
            csc_matrix(a), c, sigma=-SHIFT, which="LM", v0=np.random.default_rng(0).uniform(-1.0, 1.0, len(a))
        )[1],
    ),
)


def run_bench(
    meshes: Sequence[str], *, sample: int = 16, repeats: int = 3, solvers: bool = True, note: Callable[[str], None]
) -> Result:
    """Measure everything; `sample`: blocks that exact solvers solve."""
    rows = []
    for path in meshes:
        mesh = read_mesh(path).mesh.bare.without_isolated_vertices()[0]
        note(f"{Path(path).name}, whole files")
        row = {"mesh": Path(path).stem, "vertices": len(mesh.positions), "files": compare_with_draco(mesh, repeats)}
        if solvers:
            note(f"{Path(path).name}, eigensolvers")
            with threadpool_limits(1):
                row["dictionaries"] = time_solvers(mesh, sample, repeats)
        rows.append(row)
    return {"meshes": rows}


def compare_with_draco(mesh: TriangleMesh, repeats: int) -> dict[str, dict[str, float]]:
    """Encode and decode at c = 10 %, and Draco (level 10, 9 bits)."""
    options = EncodeOptions(keep=0.10)
    ours, theirs = encode(mesh, options), encode_draco(mesh, DRACO_BITS, DRACO_LEVEL)
    works: dict[str, Callable[[], object]] = {
        "ours encode": lambda: encode(mesh, options),
        "draco encode": lambda: encode_draco(mesh, DRACO_BITS, DRACO_LEVEL),
        "ours decode": lambda: decode(ours),
        "draco decode": lambda: decode_draco(theirs),
    }
    found = {}
    for name, work in works.items():
        seconds, cpu = (timed(work, repeats + 1, clock)[0] for clock in (time.perf_counter, time.process_time))
        found[name] = {"seconds": seconds, "cpu_seconds": cpu, "vertices_per_second": len(mesh.positions) / seconds}
    return found


def time_solvers(mesh: TriangleMesh, sample: int, repeats: int) -> list[Result]:
    """Time of the dictionaries of all blocks, for each fraction of columns: exact, and by iterations."""
    graph = graph_of_faces(mesh.faces, len(mesh.positions))
    partition = derive_partition(graph, max(1, round(graph.size / _BLOCK_VERTICES)))
    size = block_size(partition, _OVERLAP)
    blocks = grow_blocks(graph, partition, size)
    ordered = [blocks.block(index) for index in range(blocks.count)]
    chosen = [dense_laplacian(block) for block in ordered[:: max(1, len(ordered) // sample)][:sample]]
    reference = Reference(mesh.positions, mesh.faces)
    wholes: dict[str, float] = {}

    def exact_seconds(solver: Solver, width: int) -> float:
        seconds = timed(lambda: [solver.solve(a, min(width, len(a) - 1)) for a in chosen], repeats, time.thread_time)[0]
        return seconds * len(ordered) / len(chosen)

    def nmsve_db(bases: list[Matrix]) -> float:
        blend = Blend(len(mesh.positions))
        for block, basis in zip(ordered, bases, strict=True):
            projected = basis @ (basis.T @ mesh.positions[block.vertices])
            blend.add(block.vertices, projected, np.maximum(block.degrees, 1.0))
        return reference.compare(blend.all_positions()).nmsve_db

    rows: list[Result] = []
    for keep in KEEPS:
        width = max(1, round(keep * size))
        exact_db = nmsve_db([np.linalg.eigh(dense_laplacian(block))[1][:, :width] for block in ordered])
        facts = {"keep": keep, "columns": width}
        times = {}
        for solver in EXACT:
            seconds = wholes.get(solver.name) or exact_seconds(solver, width)
            if solver.whole:
                wholes[solver.name] = seconds
            times[solver.name] = seconds
            rows.append({"solver": solver.name, **facts, "seconds": seconds, "nmsve_db": exact_db, "exact": True})
        for power in POWERS:
            work = partial(lambda width, power: [iterated(block, width, power) for block in ordered], width, power)
            seconds, bases = timed(work, repeats, time.thread_time)
            speedups = {"against_svd": times[EXACT[0].name] / seconds, "against_fastest": min(times.values()) / seconds}
            row = {"solver": f"OI, R^{power}", **facts, "seconds": seconds, "nmsve_db": nmsve_db(bases)}
            rows.append({**row, "exact": False, **speedups})
    return rows


def iterated(block: Block, width: int, power: int) -> Matrix:
    start = cosine_columns(block.size, min(width, block.size)).astype(np.float32)
    return solver_of(block, SHIFT).iterate(start, power, 1).astype(np.float64)


def bench_tables(result: Result) -> str:
    parts = []
    for row in result["meshes"]:
        parts.append(f"{row['mesh']}, {row['vertices']} vertices:\n")
        names = {"seconds": 1e3, "cpu_seconds": 1e3, "vertices_per_second": 1}
        files = [
            (name, *(number(unit * times[key], 1 if unit > 1 else 0) for key, unit in names.items()))
            for name, times in row["files"].items()
        ]
        parts.append(table(("whole file", "ms", "CPU ms", "vertices/s"), files))
        if "dictionaries" not in row:
            continue
        rows = [
            (
                f"{timing['solver']}, c = {timing['keep']:.0%}",
                number(1e3 * timing["seconds"], 1),
                number(timing["nmsve_db"], 2),
                *(number(timing.get(f"against_{rival}"), 1) for rival in ("svd", "fastest")),
            )
            for timing in row["dictionaries"]
        ]
        columns = ("dictionaries of all blocks, one thread", "CPU ms", "NMSVE, dB", "times SVD", "times fastest exact")
        parts.append(f"\n{table(columns, rows)}")
    return "\n".join(parts)


def main() -> None:
    """Measure meshes, and print tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("meshes", nargs="+")
    parser.add_argument("--sample", type=int, default=16, help="number of blocks for exact solvers")
    parser.add_argument("--repeat", type=int, default=3, help="repeat every measurement; the fastest counts")
    parser.add_argument("--no-solvers", action="store_true", help="leave out exact solvers, which take minutes")
    args = parser.parse_args()
    given = {"sample": args.sample, "repeats": args.repeat, "solvers": not args.no_solvers}
    print(bench_tables(run_bench(args.meshes, **given, note=print)))
