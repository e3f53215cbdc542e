"""Dictionaries against exact eigensolvers: `python -m tools.measure bench MESH...`.

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
from bsm.codec.geometry.graph import graph_of_faces
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.metrics import Reference
from bsm.evaluation.curve import number, table, timed
from bsm.files.mesh import read_mesh

KEEPS = (0.10, 0.15, 0.20, 0.25)
POWERS = (1, 2, 4)
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


def run_bench(meshes: Sequence[str], *, sample: int = 16, repeats: int = 3, note: Callable[[str], None]) -> Result:
    """Measure everything; `sample`: blocks that exact solvers solve."""
    rows = []
    for path in meshes:
        mesh = read_mesh(path).mesh.bare.without_isolated_vertices()[0]
        note(f"{Path(path).name}, eigensolvers")
        with threadpool_limits(1):
            timings = time_solvers(mesh, sample, repeats)
        rows.append({"mesh": Path(path).stem, "vertices": len(mesh.positions), "dictionaries": timings})
    return {"meshes": rows}


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
    args = parser.parse_args()
    print(bench_tables(run_bench(args.meshes, sample=args.sample, repeats=args.repeat, note=print)))
