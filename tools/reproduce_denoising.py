"""The denoising tables of the paper beside our own figures, as Markdown.

    python -m tools.reproduce_denoising MESHES [overlap] [segments] [powers] [armadillo]

MESHES is the folder of real meshes, with `static/` and `noisy/`. The paper's noisy meshes are not published and the
labels of METIS differ between builds, so differences of a few percent are expected.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

from codec.blocks import block_size, grow_blocks
from codec.denoise.coarse import OVERLAP, RULES, CoarseFilter
from codec.denoise.guided import guided_normal_filtering
from codec.denoise.noise import gaussian_along_normals
from codec.graph import graph_of_faces
from codec.laplacian import dense_laplacian
from codec.mesh import TriangleMesh
from codec.metrics import Reference, decibel
from codec.partition import metis_partition
from tools.evaluation.tables import number, percent, table
from tools.meshfiles import read_mesh

# Section 6.3: mean normal difference of Julio, by segments and by n_d over the largest part; coarse and fine.
JULIO = {
    50: ([0.1229, 0.1207, 0.1188, 0.1172, 0.1160, 0.1159], [0.1167, 0.1166, 0.1163, 0.1160, 0.1159, 0.1158]),
    70: ([0.1248, 0.1228, 0.1203, 0.1188, 0.1174, 0.1164], [0.1176, 0.1173, 0.1172, 0.1169, 0.1169, 0.1164]),
    100: ([0.1276, 0.1248, 0.1228, 0.1208, 0.1184, 0.1175], [0.1189, 0.1187, 0.1185, 0.1183, 0.1174, 0.1168]),
}
OVERLAPS = (1.0, 1.05, 1.10, 1.15, 1.20, 1.25)
FINE_ITERATIONS = 2
CONVERGED = replace(RULES, iterations=4)
"""As good as the SVD, which the paper uses where it does not say otherwise."""
# Section 6.2: mean normal difference of the bunny after the coarse step, simple and weighted average.
BUNNY = {
    25: (0.0921, 0.0915),
    40: (0.0931, 0.0925),
    50: (0.0941, 0.0934),
    70: (0.0960, 0.0952),
    100: (0.0988, 0.0980),
    200: (0.1039, 0.1028),
    500: (0.1163, 0.1150),
}
# Section 8.2: theta of Twelve and Fandisk by the power z of R; the last is the SVD.
POWERS = {
    "twelve_dodecahedron": [11.57, 10.26, 13.97, 13.84, 13.7, 13.59, 13.57, 13.55, 13.53, 9.83],
    "fandisk_6475": [16.36, 14.75, 14.54, 14.54, 14.44, 14.5, 14.52, 14.84, 15.6, 14.56],
}
# Section 8.2: NMSVE (dB) by SVD and by orthogonal iterations, and the speed-up, by c in percent of n_d.
ARMADILLO = {
    10: (-47.5668, -47.4145, 22),
    15: (-47.6641, -47.5263, 16),
    20: (-47.7428, -47.6195, 14),
    25: (-47.8301, -47.7097, 12),
}
ARMADILLO_BLOCKS = 20


def read_partners(folder: Path, clean: str, noisy: str) -> tuple[Reference, TriangleMesh]:
    """The clean mesh, prepared for comparison, and the noisy one."""
    original = read_mesh(folder / "static" / f"{clean}.ply").mesh
    return Reference(original.positions, original.faces), read_mesh(folder / "noisy" / f"{noisy}.ply").mesh


def overlap_table(folder: Path) -> str:
    """Mean normal difference by number of segments and overlap."""
    reference, noisy = read_partners(folder, "julius_36201", "julius_36201_noisy")
    n = len(noisy.positions)
    rows, deviations = [], []
    for segments, (paper_coarse, paper_fine) in JULIO.items():
        for overlap, coarse_there, fine_there in zip(OVERLAPS, paper_coarse, paper_fine):
            filter_ = CoarseFilter(noisy.faces, n, block=round(n / segments), rules=CONVERGED, overlap=overlap)
            coarse = filter_(noisy.positions)
            fine = guided_normal_filtering(coarse, noisy.faces, FINE_ITERATIONS)
            values = [coarse_there, reference.mnd(coarse), fine_there, reference.mnd(fine)]
            deviations.append([values[1] / values[0] - 1.0, values[3] / values[2] - 1.0])
            rows.append([f"{segments}, {overlap:.2f} max", str(filter_.size), *(number(value, 4) for value in values)])
    coarse_off, fine_off = 100 * np.mean(deviations, axis=0)
    rows.append(["mean deviation", "", "", percent(coarse_off), "", percent(fine_off)])
    columns = ["Julio: segments, n_d", "n_d", "coarse, paper", "coarse", "fine, paper", "fine"]
    return table(columns, rows)


def segments_table(folder: Path) -> str:
    """Mean normal difference of the coarse bunny by number of segments; only the trend can be compared."""
    reference, noisy = read_partners(folder, "bunny_34834", "bunny_34834_noisy")
    n = len(noisy.positions)
    rows = []
    for segments, paper in BUNNY.items():
        block = round(n / segments)
        simple = CoarseFilter(noisy.faces, n, block=block, rules=CONVERGED, weights=np.ones_like)(noisy.positions)
        weighted = CoarseFilter(noisy.faces, n, block=block, rules=CONVERGED)(noisy.positions)
        values = [*paper, reference.mnd(simple), reference.mnd(weighted)]
        gains = [paper[0] - paper[1], values[2] - values[3]]
        rows.append([str(segments), *(number(value, 4) for value in (*values, *gains))])
    columns = ["bunny: segments", "simple, paper", "weighted, paper", "simple", "weighted", "gain, paper", "gain"]
    return table(columns, rows)


def powers_table(folder: Path) -> str:
    """Theta of the coarse step by power of R: one solve and QR per block, R^z never formed."""
    rows = []
    for clean, noisy_name in (
        ("twelve_dodecahedron", "twelve_dodecahedron_noisy"),
        ("fandisk_6475", "fandisk_0.7_noisy"),
    ):
        reference, noisy = read_partners(folder, clean, noisy_name)
        n = len(noisy.positions)
        for power, paper in enumerate(POWERS[clean], start=1):
            exact = power == len(POWERS[clean])
            # One orthogonal iteration per block for every z; only the first block starts without a predecessor.
            rules = replace(RULES, exact=exact, power=power, iterations=1, key_interval=0)
            start = time.perf_counter()
            coarse = CoarseFilter(noisy.faces, n, block=n // 10, rules=rules)(noisy.positions)
            seconds = time.perf_counter() - start
            name = "exact basis (paper: SVD)" if exact else f"R^{power}"
            rows.append([f"{clean}: {name}", number(paper, 2), number(reference.theta(coarse), 2), number(seconds, 3)])
    return table(["coarse step, 10 blocks, c = 10 %", "theta, paper", "theta", "s"], rows)


def armadillo_table(folder: Path) -> str:
    """Visual error and time of the coarse step against full dense SVDs, by c."""
    clean = read_mesh(folder / "static" / "armadillo_20002_derived.ply").mesh
    n = len(clean.positions)
    reference = Reference(clean.positions, clean.faces)
    noisy = gaussian_along_normals(clean.positions, clean.faces, 0.2, seed=1)
    rows = []
    svd_seconds = _svd_seconds(clean)
    for share, (paper_svd, paper_oi, paper_gain) in ARMADILLO.items():
        keep = share / 100
        start = time.perf_counter()
        tracked = CoarseFilter(clean.faces, n, keep, n // ARMADILLO_BLOCKS)
        oi_seconds = time.perf_counter() - start
        exact = CoarseFilter(clean.faces, n, keep, n // ARMADILLO_BLOCKS, replace(RULES, exact=True))
        errors = [
            paper_svd,
            paper_oi,
            *(decibel(reference.nmsve(filter_(noisy, keep))) for filter_ in (exact, tracked)),
        ]
        gains = [f"{gain:.0f}x" for gain in (paper_gain, svd_seconds / oi_seconds)]
        times = [number(seconds, 2) for seconds in (svd_seconds, oi_seconds)]
        rows.append([f"{share} %", *(number(error, 2) for error in errors), *gains, *times])
    columns = [
        "Armadillo: c",
        "SVD dB, paper",
        "OI dB, paper",
        "exact dB",
        "OI dB",
        "gain, paper",
        "gain",
        "SVD s",
        "OI s",
    ]
    return table(columns, rows)


def _svd_seconds(mesh: TriangleMesh) -> float:
    """Time of the full dense SVD of every block's Laplacian, as the paper has it."""
    graph = graph_of_faces(mesh.faces, len(mesh.positions))
    partition = metis_partition(graph, ARMADILLO_BLOCKS)
    blocks = grow_blocks(graph, partition, block_size(partition, OVERLAP))
    total = 0.0
    for index in range(blocks.count):
        laplacian = dense_laplacian(blocks.block(index))
        start = time.perf_counter()
        np.linalg.svd(laplacian)
        total += time.perf_counter() - start
    return total


TABLES: dict[str, Callable[[Path], str]] = {
    "overlap": overlap_table,
    "segments": segments_table,
    "powers": powers_table,
    "armadillo": armadillo_table,
}


def main(arguments: list[str] | None = None) -> int:
    """Print the tables that were asked for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("meshes", type=Path, help="folder with static/ and noisy/")
    parser.add_argument("tables", nargs="*", metavar="table", help=", ".join(TABLES))
    chosen = parser.parse_args(arguments)
    unknown = sorted(set(chosen.tables) - set(TABLES))
    if unknown:
        parser.error(f"there is no table {', '.join(unknown)}; choose among {', '.join(TABLES)}")
    for name in chosen.tables or TABLES:
        print(TABLES[name](chosen.meshes), end="\n\n", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
