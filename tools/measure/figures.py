"""The figures that docs/measured.md shows: each a table, what it should come to, and the command that makes it.

python -m tools.measure figures MESHES [--only NAME]"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from bsm.bitstream.connectivity.faces import encode_connectivity
from bsm.bitstream.errors import CorruptError, OptionError
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.metrics import Reference
from bsm.console import Console, print_json
from bsm.evaluation.curve import (
    COLD_STARTS,
    EXACT_BASES,
    Spectral,
    decode_draco,
    encode_draco,
    measure,
    number,
    our_curve,
    paper_options,
    rate_curve_of,
    run_curve,
    scaled,
    table,
)
from bsm.files.mesh import read_mesh
from tools.command import run_command
from tools.payloads import decode_connectivity

Result = TypeVar("Result")

REPEATS = 3


def connectivity_row(name: str, mesh: TriangleMesh) -> tuple[str, ...]:
    """One line of the table; the decoded faces are checked before a time is given.

    Draco does not code connectivity alone. Its file with one bit for a coordinate holds little else, so that it is an
    upper bound of its connectivity.
    """
    mesh = mesh.without_isolated_vertices()[0]
    vertices, faces = len(mesh.positions), len(mesh.faces)
    encode_seconds, coded = _fastest(lambda: encode_connectivity(mesh.faces, vertices))
    decode_seconds, decoded = _fastest(lambda: decode_connectivity(coded.payload, vertices, faces))
    if not np.array_equal(decoded, coded.faces):
        raise CorruptError(f"{name}: the connectivity does not come back")
    draco_encode, draco = _fastest(lambda: encode_draco(mesh, 11, 10))
    draco_decode, _ = _fastest(lambda: decode_draco(draco))
    return (
        name,
        f"{8 * len(coded.payload) / vertices:.3f}",
        f"{8 * len(encode_draco(mesh, 1, 10)) / vertices:.3f}",
        *(f"{faces / seconds / 1e6:.1f}" for seconds in (encode_seconds, decode_seconds, draco_encode, draco_decode)),
    )


HEADINGS = ("mesh", "bpv", "Draco, at most", "encode, Mtri/s", "decode", "Draco's whole encode", "decode")


def _fastest(work: Callable[[], Result]) -> tuple[float, Result]:
    """CPU seconds of the fastest of some runs behind one that does not count, and the result."""
    result = work()
    seconds = []
    for _ in range(REPEATS):
        begin = time.process_time()
        result = work()
        seconds.append(time.process_time() - begin)
    return min(seconds), result


BLOCKS = {"bunny_34834": 70, "julius_36201": 70, "horse_48485": 100, "armadillo_20002_derived": 40, "fandisk_6475": 15}
"""Meshes of the paper's mode, and into how many blocks each is cut."""
CAD = ("fandisk_6475", "block", "twelve_dodecahedron")
COEFFICIENT_LIMITS = (
    ("bunny_34834", 6.9, 1.1),
    ("bunny_34834", 5.6, 1.85),
    ("horse_48485", 6.1, 0.82),
    ("julius_36201", 7.0, 1.35),
    ("nicolo", 7.1, 1.55),
)
"""Mesh, theta in degrees, and the bits per vertex of coefficients that should do."""
PAPER_RATE_MESHES = (
    "bunny_34834",
    "julius_36201",
    "horse_48485",
    "armadillo_20002_derived",
    "nicolo",
    "fr_chinese_lion",
)
KEEPS = (0.10, 0.20)


@dataclass(frozen=True)
class Source:
    """Where figures find meshes."""

    meshes: Path
    note: Callable[[str], None]

    def path(self, name: str) -> Path:
        """The file of one mesh."""
        found = sorted(self.meshes.glob(f"{name}.*"))
        if not found:
            raise OptionError(f"{self.meshes} holds no {name}.ply or the like")
        return found[0]

    def mesh(self, name: str) -> TriangleMesh:
        """One mesh, without isolated vertices."""
        self.note(name)
        return read_mesh(self.path(name)).mesh.without_isolated_vertices()[0]


@dataclass(frozen=True)
class Figure:
    """One table of the README."""

    title: str
    expectation: str
    text: str


def basis_figure(source: Source) -> Figure:
    """NMSVE of the exact basis and of orthogonal iterations, 12 bits for every coefficient."""
    methods: dict[str, dict[str, Any]] = {
        "svd": EXACT_BASES,
        "z=1": {"power": 1},
        "z=2": {"power": 2},
        "z=1, independent": COLD_STARTS | {"power": 1},
        "z=2, independent": COLD_STARTS | {"power": 2},
    }
    rows = []
    for name, blocks in BLOCKS.items():
        mesh = source.mesh(name)
        reference = Reference(mesh.positions, mesh.faces)
        for keep in KEEPS:
            points = {
                method: measure(
                    Spectral(paper_options(keep=keep, block_size=round(len(mesh.positions) / blocks), **changes)),
                    mesh,
                    reference,
                )
                for method, changes in methods.items()
            }
            exact = points["svd"]
            gaps = [points[m]["nmsve_db"] - exact["nmsve_db"] for m in methods if m != "svd"]
            times = [exact["decode_seconds"], points["z=2"]["decode_seconds"]]
            rows.append(
                (
                    f"{name}, {blocks} blocks",
                    f"{100 * keep:g} %",
                    number(exact["bpv_paper"], 2),
                    number(exact["nmsve_db"], 2),
                    *(f"{gap:+.2f}" for gap in gaps),
                    *(number(seconds, 2) for seconds in times),
                )
            )
    columns = ("mesh", "c/n_d", "bpv", "SVD, dB", *(m for m in methods if m != "svd"), "SVD, s", "z=2, s")
    return Figure(
        "Orthogonal iterations against the exact basis (12 bits, METIS, one iteration; decoding times)",
        "bunny -52.6 and -53.6 dB within 0.2; z=2 within 0.5 dB of SVD, z=1 within 1.3",
        table(columns, rows),
    )


def connectivity_figure(source: Source) -> Figure:
    """Connectivity alone, beside Draco."""
    names = ("bunny_34834", "julius_36201", "armadillo_12502", "dragon_437645", "nicolo", *CAD)
    return Figure(
        "Connectivity: bits per vertex, and million triangles per second of CPU time",
        "at most Draco's; 1 million triangles per second or better",
        table(HEADINGS, [connectivity_row(name, source.mesh(name)) for name in names]),
    )


def coefficients_figure(source: Source) -> Figure:
    """Bits of the coefficients alone: at given angles, and at the error of the paper's mode."""
    rows = []
    for name in PAPER_RATE_MESHES:
        mesh = source.mesh(name)
        paper = measure(Spectral(paper_options(keep=KEEPS[-1], power=2)), mesh, Reference(mesh.positions, mesh.faces))
        points = run_curve(our_curve(), mesh, name)["points"]
        found = rate_curve_of(points, "nmsve_db", "bpv_geometry").rate(paper["nmsve_db"])
        rows.append((f"{name}, {paper['nmsve_db']:.2f} dB", number(found, 2), number(paper["bpv_paper"] / 3, 2)))
    curves = {name: run_curve(our_curve(), source.mesh(name), name)["points"] for name, _, _ in COEFFICIENT_LIMITS}
    for name, angle, limit in COEFFICIENT_LIMITS:
        found = rate_curve_of(curves[name], "theta_deg", "bpv_geometry").rate(scaled(angle, "theta_deg") or 0.0)
        rows.append((f"{name}, {angle:g}°", number(found, 2), number(limit, 2)))
    return Figure(
        "Coefficients alone, bits per vertex",
        "at the error of the paper's mode (OI z=2, c = 20 %, 12 bits) a third of its bits, and the limits given",
        table(("at", "bpv", "limit"), rows),
    )


FIGURES: dict[str, Callable[[Source], Figure]] = {
    "basis": basis_figure,
    "coefficients": coefficients_figure,
    "connectivity": connectivity_figure,
}


def make_figures(source: Source, names: Sequence[str]) -> list[Figure]:
    """Some of `FIGURES`."""
    unknown = [name for name in names if name not in FIGURES]
    if unknown:
        raise OptionError(f"no figure is called {', '.join(unknown)}; there are {', '.join(FIGURES)}")
    return [FIGURES[name](source) for name in names]


def work(args: argparse.Namespace, console: Console) -> None:
    """Print each figure as it is ready."""
    names = args.only.split(",") if args.only else list(FIGURES)
    source = Source(Path(args.meshes), console.note)
    if args.json:
        figures = make_figures(source, names)
        print_json({"figures": [{"name": name, **asdict(figure)} for name, figure in zip(names, figures)]})
        return
    for name in names:
        (figure,) = make_figures(source, [name])
        command = f"python -m tools.measure figures FOLDER --only {name}"
        print(f"### {figure.title}\n\n`{command}`; expected: {figure.expectation}.\n")
        print(f"{figure.text}\n", flush=True)


def main() -> None:
    """Run the command."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("meshes", metavar="FOLDER", help="folder of bunny_34834.ply, fandisk_6475.ply, ...")
    parser.add_argument("--only", metavar="LIST", help=f"{','.join(FIGURES)} (default: all)")
    parser.add_argument("--json", action="store_true", help="print it as JSON")
    run_command(parser, work)
