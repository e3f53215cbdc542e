"""What qualities cost: whole files against Draco's, on chosen meshes.

    python -m tools.measure theta MESH [MESH ...] [--theta 3 7 10] [--draco-bits 11]
    python -m tools.measure contract MESH [MESH ...] [--preset balanced]

`theta`: bytes at a mean angle between corresponding normals, over those of Draco (level 10, its bits interpolated) at
the angle that was reached; Draco's own angle at `--draco-bits` is one more. `contract`: what a preset gives, checked
by itself and by surfaces, over the bytes of Draco with the fewest bits whose surfaces are as close (Hausdorff
distance, mean angle of normals). Vertices at one position are made one for both. Needs DracoPy.
"""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from statistics import fmean
from typing import TypeVar

import numpy as np

from bsm.bitstream.errors import BsmError, MeshError
from bsm.codec.arrays import Positions
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.metrics import Original, Reference, decibel, surface_distance, theta
from bsm.codec.static.encoder import Encoder
from bsm.codec.static.options import PRESETS
from bsm.codec.static.preamble_encoding import join
from bsm.codec.static.targets import Target
from bsm.decoding import decode
from bsm.evaluation.curve import encode_draco
from bsm.files.mesh import read_mesh

Result = TypeVar("Result")

DRACO_BITS = range(2, 21)
SAMPLES = 20_000


@dataclass(frozen=True)
class Row:
    """One line of a table: a mesh, what was measured, and our bytes over Draco's."""

    name: str
    text: str
    ratio: float


def joined(path: Path) -> TriangleMesh:
    """The shape in a file, vertices at one position made one."""
    return join(read_mesh(str(path)).mesh.bare, keep=False).mesh


def draco_bytes(mesh: TriangleMesh, bits: int) -> bytes:
    """Draco's smallest file."""
    return encode_draco(mesh, bits, 10)


def draco_positions(mesh: TriangleMesh, bits: int) -> Positions:
    """Where Draco's quantiser puts the vertices."""
    values = mesh.positions.astype(np.float32)
    low = values.min(axis=0)
    most = np.float32((1 << bits) - 1)
    extent = (values - low).max() or np.float32(1)
    places = np.floor((values - low) * (most / extent) + np.float32(0.5))
    positions: Positions = places * np.float64(np.float32(extent / most)) + low.astype(np.float64)
    return positions


def draco_curve(mesh: TriangleMesh) -> list[tuple[float, int]]:
    """(theta, bytes) of Draco from 6 to 16 bits."""
    return [
        (theta(mesh.positions, draco_positions(mesh, bits), mesh.faces), len(draco_bytes(mesh, bits)))
        for bits in range(6, 17)
    ]


def at_theta(curve: list[tuple[float, int]], angle: float) -> float:
    """Draco's bytes at an angle, interpolated in its logarithm."""
    angles, sizes = zip(*sorted(curve), strict=True)
    return float(np.interp(math.log(angle), np.log(np.maximum(angles, 1e-9)), sizes))


def thetas(path: Path, args: argparse.Namespace) -> Iterator[Row]:
    """Rows of `theta`."""
    mesh = joined(path)
    curve = draco_curve(mesh)
    wanted = list(args.theta)
    if args.draco_bits:
        wanted.append(curve[args.draco_bits - 6][0])
    for angle in wanted:
        attempt = Encoder(mesh, replace(PRESETS["none"], target=Target("theta_deg", angle), threads=1)).search()
        begin = time.process_time()
        decode(b"".join(attempt.frames), threads=1)
        seconds = time.process_time() - begin
        ratio = attempt.size / at_theta(curve, attempt.comparison.theta_deg)
        text = (
            f"theta {attempt.comparison.theta_deg:5.2f} of {angle:5.2f}  {attempt.size:7d} bytes  farthest "
            f"{attempt.comparison.max_error_relative:.4f}  decode {1e6 * seconds / len(mesh.positions):.1f} us"
        )
        label = f"Draco {args.draco_bits} bits" if angle not in args.theta else f"{angle:g} degrees"
        yield Row(label, text, ratio)


def visuals(path: Path, args: argparse.Namespace) -> Iterator[Row]:
    """Rows of `nmsve`."""
    mesh = joined(path)
    reference = Reference(mesh.positions, mesh.faces)
    curve = sorted(
        (decibel(reference.nmsve(draco_positions(mesh, bits))), len(draco_bytes(mesh, bits))) for bits in range(5, 18)
    )
    for wanted in args.db:
        attempt = Encoder(mesh, replace(PRESETS["none"], target=Target("nmsve_db", wanted), threads=1)).search()
        reached = attempt.comparison.nmsve_db
        levels, sizes = np.array(curve).T
        size = float(np.interp(reached, levels, sizes))
        yield Row(
            f"{wanted:g} dB", f"{reached:7.2f} dB  {attempt.size:7d} bytes, Draco {size:7.0f}", attempt.size / size
        )


def contracts(path: Path, args: argparse.Namespace) -> Iterator[Row]:
    """Rows of `contract`."""
    for preset in args.preset:
        encoder = Encoder(read_mesh(str(path)).mesh.bare, replace(PRESETS[preset], threads=1))
        data = encoder.encode()
        mesh, decoded = encoder.mesh, decode(data, threads=1).positions
        original = Original(mesh.positions, mesh.faces)
        farthest, angle = original.farthest(decoded) / (mesh.diagonal or 1.0), original.angle(decoded)
        ours = surfaces(mesh, decoded)
        size = smallest_draco(mesh, ours)
        text = (
            f"{len(mesh.positions):7d} vertices {len(data):7d} bytes, Draco {size:7d}; farthest "
            f"{farthest:.4f}  angle {angle:5.2f}; Hausdorff {ours[0]:.4f}"
        )
        yield Row(preset, text, len(data) / size if size else math.nan)


def smallest_draco(mesh: TriangleMesh, ours: tuple[float, float]) -> int:
    """Bytes of the first of Draco's files that is as good; 0 if none is, or Draco does not take the mesh."""
    try:
        for bits in DRACO_BITS:
            theirs = surfaces(mesh, draco_positions(mesh, bits))
            if all(a <= b for a, b in zip(theirs, ours, strict=True)):
                return len(draco_bytes(mesh, bits))
    except MeshError:
        pass
    return 0


def surfaces(mesh: TriangleMesh, decoded: Positions) -> tuple[float, float]:
    """Hausdorff distance over the diagonal, and the mean angle of normals, degrees."""
    distance = surface_distance(mesh.positions, mesh.faces, decoded, mesh.faces, SAMPLES).hausdorff
    return distance / (mesh.diagonal or 1.0), Original(mesh.positions, mesh.faces).angle(decoded)


def theta_command() -> None:
    """Print the table of `theta`."""
    parser = _parser()
    parser.add_argument("--theta", nargs="*", type=float, default=[3.0])
    parser.add_argument("--draco-bits", type=int, default=11, choices=range(6, 17))
    _print_table(thetas, parser.parse_args())


def nmsve_command() -> None:
    """Print the table of `nmsve`."""
    parser = _parser()
    parser.add_argument("--db", nargs="*", type=float, default=[-45.0, -50.0, -55.0, -60.0])
    _print_table(visuals, parser.parse_args())


def contract_command() -> None:
    """Print the table of `contract`."""
    parser = _parser()
    parser.add_argument("--preset", nargs="+", choices=PRESETS, default=["balanced"])
    _print_table(contracts, parser.parse_args())


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("meshes", nargs="+", type=Path)
    return parser


def _print_table(rows: Callable[[Path, argparse.Namespace], Iterator[Row]], args: argparse.Namespace) -> None:
    ratios: dict[str, list[float]] = {}
    for path in args.meshes:
        try:
            for row in rows(path, args):
                ratios.setdefault(row.name, []).append(row.ratio)
                print(f"{path.name[:28]:28s} {row.name:15s} {row.text}  ratio {row.ratio:.3f}", flush=True)
        except BsmError as error:
            print(f"{path.name[:28]:28s} {type(error).__name__}: {error}", flush=True)
    for name, values in ratios.items():
        counted = [value for value in values if not math.isnan(value)]
        print(f"{name}: mean ratio {fmean(counted):.3f}, largest {max(counted):.3f}, of {len(counted)}")
