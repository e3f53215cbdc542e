"""Speed: dictionaries against exact eigensolvers, whole files against Draco, and time per vertex as meshes grow."""

from __future__ import annotations

import math
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.static.decoder import decode
from bsm.codec.static.encoder import encode
from bsm.codec.static.options import EncodeOptions
from bsm.evaluation.draco import decode_draco, encode_draco
from bsm.evaluation.link import break_even, deliveries
from bsm.evaluation.resources import measure_resources
from bsm.evaluation.solvers import Timing, time_solvers
from bsm.evaluation.tables import number, table
from bsm.files.mesh import format_mesh, read_mesh

KEEPS = (0.10, 0.15, 0.20, 0.25)
DRACO_BITS, DRACO_LEVEL = 9, 10
Note = Callable[[str], None]


def run_bench(
    meshes: Sequence[str],
    *,
    sample: int = 16,
    repeats: int = 3,
    largest: int = 2_500_000,
    solvers: bool = True,
    note: Note = lambda text: None,
) -> dict[str, Any]:
    """Measure everything."""
    rows = []
    for path in meshes:
        mesh = read_mesh(path).mesh.bare.without_isolated_vertices()[0]
        note(f"{Path(path).name}, whole files")
        files = compare_with_draco(mesh, repeats)
        row = {"mesh": Path(path).stem, "vertices": len(mesh.positions), "files": files}
        row |= {"link": compare_links(mesh, repeats), "dictionaries": [], "speedups": []}
        if solvers:
            note(f"{Path(path).name}, eigensolvers")
            row |= summarise(time_solvers(mesh, KEEPS, sample, repeats))
        rows.append(row)
    return {"meshes": rows, "growth": measure_growth(meshes[0], largest, repeats, note) if largest else []}


def summarise(timings: Sequence[Timing]) -> dict[str, Any]:
    """`dictionaries`: all timings; `speedups`: for each fraction and power, against full SVD and the fastest solver."""
    speedups = []
    for timing in timings:
        if timing.exact:
            continue
        rivals = [other for other in timings if other.exact and other.keep == timing.keep]
        fastest = min(rivals, key=lambda rival: rival.seconds)
        svd = next(rival for rival in rivals if rival.solver.startswith("numpy svd"))
        speedups.append(
            {
                "solver": timing.solver,
                "keep": timing.keep,
                "against_svd": svd.seconds / timing.seconds,
                "against_fastest": fastest.seconds / timing.seconds,
                "fastest": fastest.solver,
                "nmsve_above_exact_db": timing.nmsve_db - fastest.nmsve_db,
            }
        )
    return {"dictionaries": [asdict(timing) for timing in timings], "speedups": speedups}


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
    clock = dict.fromkeys(works, math.inf)
    cpu = dict.fromkeys(works, math.inf)
    for name, work in works.items():
        for _ in range(repeats + 1):
            begin, cpu_begin = time.perf_counter(), time.process_time()
            work()
            clock[name] = min(clock[name], time.perf_counter() - begin)
            cpu[name] = min(cpu[name], time.process_time() - cpu_begin)
    return {
        name: {
            "seconds": clock[name],
            "cpu_seconds": cpu[name],
            "vertices_per_second": len(mesh.positions) / clock[name],
        }
        for name in works
    }


def compare_links(mesh: TriangleMesh, repeats: int) -> dict[str, Any]:
    """`ours` and `draco`: files that keep 7 degrees; `break_even_mbit`: below, ours is there and decoded first."""
    ours, theirs = deliveries(mesh, repeats)
    return {"ours": asdict(ours), "draco": asdict(theirs), "break_even_mbit": break_even(ours, theirs)}


def measure_growth(path: str, largest: int, repeats: int, note: Note) -> list[dict[str, Any]]:
    """Time and memory per vertex of a mesh subdivided again and again, while it has at most `largest` vertices."""
    mesh = read_mesh(path).mesh.bare.without_isolated_vertices()[0]
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "mesh.ply")
        while len(mesh.positions) <= largest:
            note(f"{Path(path).name} of {len(mesh.positions)} vertices")
            file.write_bytes(format_mesh(mesh, "ply"))
            rows.append({"vertices": len(mesh.positions), **measure_resources(file, repeats)})
            mesh = subdivide(mesh)
    return rows


def subdivide(mesh: TriangleMesh) -> TriangleMesh:
    """Cut every face into four at the middles of its edges."""
    count, faces = len(mesh.positions), mesh.faces
    ends = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    keys, edge_of = np.unique(ends[:, 0].astype(np.int64) * count + ends[:, 1], return_inverse=True)
    middles = (mesh.positions[keys // count] + mesh.positions[keys % count]) / 2
    ab, bc, ca = (count + edge_of).reshape(3, -1)
    a, b, c = faces.T
    parts = [np.stack(corners, axis=1) for corners in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))]
    return TriangleMesh(np.concatenate([mesh.positions, middles]), np.concatenate(parts).astype(np.int32))


def bench_tables(result: dict[str, Any]) -> str:
    """The result of `run_bench` for people."""
    parts = []
    for row in result["meshes"]:
        parts.append(f"{row['mesh']}, {row['vertices']} vertices; dictionaries of all blocks, one thread, CPU time:\n")
        parts.append(
            table(
                ("solver", "c", "columns", "ms", "NMSVE, dB"),
                [
                    (
                        timing["solver"],
                        f"{timing['keep']:.0%}",
                        str(timing["columns"]),
                        number(1e3 * timing["seconds"], 1),
                        number(timing["nmsve_db"], 2),
                    )
                    for timing in row["dictionaries"]
                ],
            )
        )
        parts.append("")
        parts.append(
            table(
                ("iteration", "c", "times SVD", "times fastest", "fastest exact", "dB above exact"),
                [
                    (
                        speedup["solver"],
                        f"{speedup['keep']:.0%}",
                        number(speedup["against_svd"], 1),
                        number(speedup["against_fastest"], 1),
                        speedup["fastest"],
                        number(speedup["nmsve_above_exact_db"], 2),
                    )
                    for speedup in row["speedups"]
                ],
            )
        )
        parts.append("")
        parts.append(
            table(
                ("whole file", "ms", "CPU ms", "vertices/s"),
                [
                    (
                        name,
                        number(1e3 * times["seconds"], 1),
                        number(1e3 * times["cpu_seconds"], 1),
                        number(times["vertices_per_second"], 0),
                    )
                    for name, times in row["files"].items()
                ],
            )
        )
        link = row["link"]
        files = " and ".join(
            f"{link[who]['size']} bytes ({link[who]['theta_deg']:.2f} degrees)" for who in ("ours", "draco")
        )
        parts.append(f"\n{files}: below {link['break_even_mbit']:.1f} Mbit/s ours is there and decoded first\n")
    if result["growth"]:
        parts.append("growth, CPU microseconds of all threads and peak memory of the process per vertex:\n")
        parts.append(
            table(
                ("vertices", "encode, us", "decode, us", "encode, B", "decode, B"),
                [
                    (
                        str(row["vertices"]),
                        number(row["encode"]["cpu_microseconds_per_vertex"], 2),
                        number(row["decode"]["cpu_microseconds_per_vertex"], 2),
                        number(2**20 * row["encode"]["peak_mib"] / row["vertices"], 0),
                        number(2**20 * row["decode"]["peak_mib"] / row["vertices"], 0),
                    )
                    for row in result["growth"]
                ],
            )
        )
    return "\n".join(parts)
