"""Bytes over Draco's at equal quality by measures and renderings that the codec is not made for.

    python -m tools.measure evidence MESH [MESH ...]

The default's file, and Draco's (level 10) with 8 to 14 bits, from four sides. By Butteraugli (3-norm), SSIMULACRA (both
libjxl's tools, Debian's libjxl-devtools) and FLIP (flip-evaluator) of the pictures that the look is measured by; and by
1 - SSIM of others: light from the side on one side of faces alone, gloss, stripes that are reflected, facets, four
times closer. The last column is `bsm.look`'s own 1 - SSIM from these sides. Bytes lie straight between Draco's, both as
logarithms.

    python -m tools.measure evidence HEAD.ply --head 250

--head measures a head of this many millimeters, with noise along its normals. The wavelengths and sizes are those at
which people saw a loss of 1 JOD in a study of heads. A measure that sees as people do gives the same value for each.
"""

from __future__ import annotations

import argparse
import itertools
import math
import subprocess
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import numpy.typing as npt

import bsm
from bsm.codec.arrays import Matrix
from bsm.codec.geometry.mesh import TriangleMesh, box_around
from bsm.codec.geometry.metrics import face_normals
from bsm.codec.look.measure import LookMetric
from bsm.codec.look.pictures import Canvas, Picture, Shape, cameras, difference
from bsm.console import Console
from bsm.evaluation.curve import decode_draco, encode_draco
from bsm.files.mesh import read_mesh
from bsm.pictures import png
from tools.command import run_command
from tools.measure.grids import welded

BITS = range(8, 15)
SIDES = (0, 3, 6, 9)
PIXELS = 512
CLOSER = 4
JOD = {0.01: 0.90, 0.06: 0.037, 0.34: 0.0103, 2.0: 0.0128}
"""Waves per mm of noise, and the root mean square in mm at which people see a loss of 1 JOD."""

Pixels = npt.NDArray[np.float64]
"""Normals of pixels, shape (p, 3): right, up, towards the camera."""


def across(one: Pixels, other: Pixels) -> Pixels:
    return one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0]


def plain(n: Pixels) -> Pixels:
    shades: Pixels = 0.12 + 0.78 * np.abs(n @ (0.35, 0.5, 0.79))
    return shades


def from_the_side(n: Pixels) -> Pixels:
    return 0.1 + 0.8 * np.maximum(n @ (0.95, 0.2, 0.24), 0.0)


def gloss(n: Pixels) -> Pixels:
    half = np.array([0.35, 0.5, 1.79])
    spot = np.abs(n @ (half / np.linalg.norm(half))) ** 40
    shades: Pixels = np.minimum(0.1 + 0.45 * np.abs(n @ (0.35, 0.5, 0.79)) + 0.6 * spot, 0.99)
    return shades


def stripes(n: Pixels) -> Pixels:
    up = 2.0 * n[:, 2] * n[:, 1]
    return 0.5 + 0.4 * np.clip(4.0 * np.sin(18.0 * up), -1.0, 1.0)


RENDERINGS: dict[str, tuple[Callable[[Pixels], Pixels], bool, int]] = {
    "side light": (from_the_side, False, 1),
    "gloss": (gloss, False, 1),
    "stripes": (stripes, False, 1),
    "facets": (plain, True, 1),
    "closer": (plain, False, CLOSER),
    "our own": (plain, False, 1),
}
"""Shades, whether of facets, and how many times closer."""


class Gallery:
    """Pictures of an original, and of what became of it."""

    def __init__(self, mesh: TriangleMesh) -> None:
        low, high = box_around(mesh.positions)
        self._middle, self._diagonal = (low + high) / 2, float(np.linalg.norm(high - low))
        self._cameras = cameras(self._placed(mesh), PIXELS)
        self._own = {name: self.drawn(mesh, name) for name in RENDERINGS}

    def _placed(self, mesh: TriangleMesh) -> Matrix:
        return np.ascontiguousarray((mesh.positions - self._middle) / self._diagonal)

    def drawn(self, mesh: TriangleMesh, name: str) -> list[Picture]:
        """From each side."""
        shade, flat, closer = RENDERINGS[name]
        placed, faces = self._placed(mesh), np.ascontiguousarray(mesh.faces, np.int32)
        smooth = Shape.of(placed, faces).normals(placed)
        normals = np.tile(face_normals(placed, faces), 3) if flat else smooth.astype(np.float64)
        found = []
        for side in SIDES:
            camera = self._cameras[side].copy()
            camera[:8] *= closer
            camera[[3, 7]] -= (closer - 1) * PIXELS / 2
            canvas = Canvas(PIXELS)
            canvas.draw(placed, faces, smooth, camera)
            owner = canvas.owner
            rows, columns = np.nonzero(owner >= 0)
            face = owner[rows, columns]
            ends = placed @ camera[:12].reshape(3, 4)[:2, :3].T + camera[[3, 7]]
            a, b, c = (ends[faces[face, k]] for k in range(3))
            at = np.column_stack([columns, rows]) + 0.5
            area = across(b - a, c - a)
            s, t = across(at - a, c - a) / area, across(b - a, at - a) / area
            weights = np.column_stack([1 - s - t, s, t])
            n = np.einsum("pk,pkd->pd", weights, normals[face].reshape(-1, 3, 3))
            axes = camera[:12].reshape(3, 4)[:, :3] * ((1,), (-1,), (1,))
            n = n @ (axes / np.linalg.norm(axes, axis=1, keepdims=True)).T
            n /= np.maximum(np.linalg.norm(n, axis=1, keepdims=True), 1e-12)
            picture = np.ones((PIXELS, PIXELS), np.float32)
            picture[rows, columns] = shade(n)
            found.append(picture)
        return found

    def judged(self, mesh: TriangleMesh) -> dict[str, float]:
        """How unlike the original, by each measure; more is worse."""
        found = {}
        for name, own in self._own.items():
            drawn = self.drawn(mesh, name)
            sums = np.sum([difference(one, other) for one, other in zip(own, drawn, strict=True)], axis=0)
            found[name] = float(sums[0] / sums[2])
            if name == "our own":
                found |= others(own, drawn)
        return found


def others(first: list[Picture], second: list[Picture]) -> dict[str, float]:
    """The mean over sides of what other people's measures say."""
    import flip_evaluator

    rows = []
    with tempfile.TemporaryDirectory() as folder:
        paths = [Path(folder, name) for name in ("a.png", "b.png")]
        for pair in zip(first, second, strict=True):
            for path, picture in zip(paths, pair, strict=True):
                path.write_bytes(png(picture))
            words = [
                subprocess.run([name, *paths], check=True, capture_output=True, text=True).stdout.split()
                for name in ("butteraugli_main", "ssimulacra_main")
            ]
            images = [np.repeat(picture[:, :, None], 3, axis=2) for picture in pair]
            flip = flip_evaluator.evaluate(*images, "LDR", applyMagma=False)[1]
            rows.append((float(words[0][-1]), float(words[1][0]), flip))
    return dict(zip(("Butteraugli", "SSIMULACRA", "FLIP"), np.mean(rows, axis=0).tolist(), strict=True))


def heads(path: str, size: float) -> None:
    """Print what `bsm.look` says of noises that people found alike."""
    mesh = read_mesh(path).mesh
    positions = mesh.positions * size / np.ptp(mesh.positions, axis=0).max()
    normals = np.zeros_like(positions)
    np.add.at(normals, mesh.faces, face_normals(positions, mesh.faces)[:, None])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    metric, random = LookMetric(TriangleMesh(positions, mesh.faces)), np.random.default_rng(0)
    for waves, rms in JOD.items():
        towards = random.normal(size=(3, 64))
        towards /= np.linalg.norm(towards, axis=0)
        noise = np.cos(2 * np.pi * (waves * positions @ towards + random.uniform(size=64))).sum(axis=1)
        seen = metric.look(positions + normals * (noise * rms / np.sqrt(np.mean(noise**2)))[:, None])
        print(f"{waves:g} per mm, {rms:g} mm: distance {seen.distance:.3f}, 1 - SSIM {seen.dissimilarity:.4f}")


def size_at(curve: list[tuple[int, float]], value: float) -> float:
    """Bytes for a value, between those of a curve of (bytes, value); nan outside."""
    for (small, coarse), (large, fine) in itertools.pairwise(curve):
        if coarse >= value >= fine > 0.0:
            share = math.log(coarse / value) / math.log(coarse / fine) if coarse > fine else 0.0
            return math.exp((1 - share) * math.log(small) + share * math.log(large))
    return math.nan


def work(options: argparse.Namespace, _: Console) -> None:
    """Measure and print."""
    if options.head:
        return heads(options.meshes[0], options.head)
    names = ("Butteraugli", "SSIMULACRA", "FLIP", *RENDERINGS)
    print(f"| mesh | {' | '.join(names)} |\n|---|{'---:|' * len(names)}")
    rows = []
    for path in options.meshes:
        positions, faces = welded(path)
        mesh = TriangleMesh(positions.astype(np.float64), faces)
        gallery, data = Gallery(mesh), bsm.encode(mesh)
        files = [encode_draco(mesh, bits, 10) for bits in BITS]
        curve = [(len(file), gallery.judged(decode_draco(file))) for file in files]
        ours = gallery.judged(bsm.decode(data))
        rows.append([len(data) / size_at([(size, seen[name]) for size, seen in curve], ours[name]) for name in names])
        print(f"| {Path(path).stem} | {' | '.join(f'{ratio:.2f}' for ratio in rows[-1])} |", flush=True)
    print(f"| mean | {' | '.join(f'{ratio:.2f}' for ratio in np.nanmean(rows, axis=0))} |")


def main() -> None:
    """Run the command."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("meshes", nargs="+", metavar="MESH")
    parser.add_argument("--head", type=float, metavar="MM", help="the first mesh is a head of this size: see above")
    run_command(parser, work)
