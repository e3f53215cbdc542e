"""The pictures of README, gallery and guides, made by the present commit.

    python -m tools.pictures FOLDER

FOLDER has static/, noisy/, dynamic/ and assets/. The pictures of `bsm view` and of streaming need Node, the packages of
web/ and Chromium. Blender makes docs/guides/gallop.jpg.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

import bsm
from bsm.codec.arrays import Faces, Positions
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.console import Console
from bsm.evaluation.curve import decode_draco, encode_draco
from bsm.pictures import Image, bounds_of, render, view_matrix, with_titles
from tools.command import run_command

TOOLS = Path(__file__).parent
ROOT = TOOLS.parent
GUIDES = ROOT / "docs" / "guides"
FRONT = view_matrix(-90.0, 15.0)
PIXELS = 480
FRAMES = 24


def main(args: argparse.Namespace, console: Console) -> None:
    """Write all pictures."""
    folder = Path(args.folder)
    pictures, figures = scan(folder / "static" / "bunny_34834.ply")
    titles, images = zip(*pictures, *part(folder), strict=True)
    (TOOLS / "front.png").write_bytes(with_titles(images, titles, figures=figures))
    text = _save_motion(folder / "dynamic" / "samba.npz", TOOLS / "motion.gif")
    console.note(text)
    with tempfile.TemporaryDirectory() as work:
        pages(folder, GUIDES, Path(work))
        stream = Path(work) / "bunny.bsm"
        stream.write_bytes(bsm.encode(folder / "static" / "bunny_34834.ply"))
        picture = ["npm", "run", "picture", "--", str(stream), str(GUIDES / "streaming.png")]
        subprocess.run(picture, cwd=ROOT / "web", env=os.environ | {"PYTHON": sys.executable}, check=True)


def pages(folder: Path, target: Path, work: Path) -> list[Path]:
    """Take pictures of the page of `bsm view` with a scan, its errors, and a textured asset on a phone."""
    scan, asset = work / "scan.html", work / "asset.html"
    for mesh, page in (("static/bunny_34834.ply", scan), ("assets/Duck.glb", asset)):
        command = [sys.executable, "-m", "bsm", "view", str(folder / mesh), "--save", str(page), "-q", "-f"]
        subprocess.run(command, check=True)
    shots = [
        {"page": scan, "picture": "page-scan.jpg", "layers": 3, "keys": "", "dark": False, "size": [1280, 800]},
        {"page": scan, "picture": "page-errors.jpg", "layers": 3, "keys": "e3", "dark": True, "size": [1280, 800]},
        {"page": asset, "picture": "page-phone.jpg", "layers": 2, "keys": "", "dark": False, "size": [390, 780]},
    ]
    for shot in shots:
        shot |= {"page": str(shot["page"]), "picture": str(target / str(shot["picture"]))}
    environment = os.environ | {"BSM_PAGES": json.dumps(shots)}
    subprocess.run(["node", "scripts/test.mjs", "pages"], cwd=ROOT / "web", env=environment, check=True)
    return [Path(str(shot["picture"])) for shot in shots]


def scan(path: Path) -> tuple[list[tuple[str, Image]], dict[str, str]]:
    """A scan, what the default makes of it, and the finest Draco file that is no larger; the sizes of the first two, as
    they stand in the table of the README, for the text of the picture."""
    mesh = bsm.load(path)
    data = bsm.encode(mesh)
    theirs = max((encode_draco(mesh, bits, 10) for bits in range(4, 15)), key=lambda file: _fits(file, len(data)))
    upright = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]], float)
    bounds = bounds_of(mesh.positions @ upright.T, FRONT)
    figures = {"file": f"{path.stat().st_size / 1000:,.0f} kB", "balanced": f"{len(data) / 1000:.1f} kB"}
    rows = ((f"scan: {figures['file']}", mesh), (f"BSM, default: {figures['balanced']}", bsm.decode(data)))
    last = (f"Draco at that size: {len(theirs) / 1000:.1f} kB", decode_draco(theirs))
    return [(name, _drawn(f.positions @ upright.T, f.faces, bounds)) for name, f in (*rows, last)], figures


def _fits(file: bytes, size: int) -> int:
    return len(file) if len(file) <= size else -len(file)


def part(folder: Path) -> list[tuple[str, Image]]:
    """A noisy part, and what denoising makes of it."""
    noisy = bsm.load(folder / "noisy" / "fandisk_0.3_noisy.ply")
    clean = bsm.denoise(noisy)
    bounds = bounds_of(noisy.positions)
    pairs: tuple[tuple[str, TriangleMesh], ...] = (("noisy", noisy), ("denoised", clean))
    return [(name, render(mesh.positions, mesh.faces, PIXELS, bounds=bounds)) for name, mesh in pairs]


def _drawn(positions: Positions, faces: Faces, bounds: tuple[Image, float]) -> Image:
    return render(positions, faces, PIXELS, view=FRONT, bounds=bounds)


def _save_motion(path: Path, target: Path) -> str:
    from PIL import Image as Pictures

    frames = np.load(path)
    data = bsm.encode_sequence(frames["positions"], frames["faces"])
    positions, faces = bsm.decode_sequence(data)
    chosen = positions[:: max(1, len(positions) // FRAMES)][:FRAMES]
    upright = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]], float)
    bounds = bounds_of(chosen.reshape(-1, 3) @ upright.T, FRONT)
    drawn = [render(frame @ upright.T, faces, 280, view=FRONT, bounds=bounds) for frame in chosen]
    images = [Pictures.fromarray(np.uint8(255 * image)).quantize(32) for image in drawn]
    images[0].save(target, save_all=True, append_images=images[1:], duration=80, loop=0, optimize=True)
    return f"{path.stem}: {frames['positions'].nbytes} bytes as float32, {len(data)} as a stream"


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m tools.pictures", description=__doc__)
    parser.add_argument("folder", metavar="FOLDER", help="folder of meshes")
    return parser


if __name__ == "__main__":
    run_command(_parser(), main)
