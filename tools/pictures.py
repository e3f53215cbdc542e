"""Make all pictures of the documents: README, gallery and guides.

    python -m tools.pictures FOLDER

FOLDER has static/, noisy/, dynamic/ and assets/. Most pictures are views of the page of `bsm view`, which need Node,
the packages of web/ and Chromium.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import KDTree

import bsm
from bsm.codec.arrays import Faces, Positions
from bsm.codec.blocks.cells import cells_of
from bsm.codec.blocks.overlap import derive_partition
from bsm.codec.denoise import FrameDenoiser
from bsm.codec.geometry.graph import graph_of_faces
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.static.choice.congruence import motions_between
from bsm.evaluation.curve import decode_draco, encode_draco
from bsm.ground.console import Console
from bsm.ground.pictures import Image, bounds_of, png, render, view_matrix, with_titles
from bsm.viewer.contents import Content, made
from bsm.viewer.page import page_with
from tools.command import run_command
from tools.noise import gaussian_along_normals

ROOT = Path(__file__).parents[1]
FRONT, MOTION, STREAMING = (
    "tools/front.png",
    "docs/gallery/motion.webp",
    "docs/guides/streaming.png",
)
SCANS, ASSETS = "docs/gallery/scans.jpg", "docs/guides/assets.jpg"
TWINS, TRIALS, STEADY = (
    "docs/gallery/twins.png",
    "docs/gallery/trials.png",
    "docs/guides/steady.png",
)
CELLED = "docs/gallery/cells.webp"
PAGES = ("docs/guides/page-scan.jpg", "docs/guides/page-errors.jpg", "docs/guides/page-phone.jpg")
PICTURES = (FRONT, MOTION, STREAMING, SCANS, ASSETS, TWINS, TRIALS, STEADY, CELLED, *PAGES)
"""All pictures of the documents."""
SCANNED = {
    "static/armadillo_20002_derived.ply": 20,
    "static/dragon_22998.ply": 0,
    "static/c3d_spot.ply": 15,
    "assets/ADIS16480.STL": 0,
}
"""Meshes of the gallery, and how often the right arrow turns each to its front."""
DRESSED = {"assets/Duck.glb": 0, "assets/BoxTextured.glb": 0, "assets/monkey.glb": 0}
VIEW = view_matrix(-90.0, 15.0)
UPRIGHT = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]], float)
PIXELS = 480
SIDE = 320  # of a mesh in a table of pictures
LINE = 26  # of a title there
FRAMES, MILLISECONDS = 35, 90  # of the motion, each
CELLS = 4000  # to the diagonal, when twins are sought
KEY_BITS = 9  # of Draco's frames


def main(args: argparse.Namespace, console: Console) -> None:
    """Write all pictures."""
    from PIL import Image as Pictures

    folder = Path(args.folder)
    pictures, figures = scan(folder / "static" / "bunny_34834.ply")
    titles, images = zip(*pictures, *part(folder), strict=True)
    (ROOT / FRONT).write_bytes(with_titles(images, titles, figures=figures))
    (ROOT / TWINS).write_bytes(png(twins(bsm.load(folder / "assets" / "featuretype.STL"))))
    titles, images = zip(*celled(bsm.load(folder / "static" / "bunny_34834.ply")), strict=True)
    Pictures.open(BytesIO(with_titles(images, titles))).convert("RGB").save(
        ROOT / CELLED, quality=80
    )
    (ROOT / STEADY).write_bytes(png(steady(folder / "dynamic" / "horse_gallop.npz")))
    trials(bsm.load(folder / "static" / "bunny_34834.ply"), ROOT / TRIALS)
    console.note(motion(folder / "dynamic" / "samba.npz", ROOT / MOTION))
    with tempfile.TemporaryDirectory() as work:
        pages(folder, ROOT / "docs" / "guides", Path(work))
        tables(folder, Path(work))
        stream = Path(work) / "bunny.bsm"
        stream.write_bytes(bsm.encode(folder / "static" / "bunny_34834.ply"))
        picture = ["npm", "run", "picture", "--", str(stream), str(ROOT / STREAMING)]
        subprocess.run(
            picture, cwd=ROOT / "web", env=os.environ | {"PYTHON": sys.executable}, check=True
        )


def twins(mesh: TriangleMesh) -> Image:
    """A part on which vertices that transforms take to each other have one color, and those without twins are gray."""
    cell, count = mesh.diagonal / CELLS, len(mesh.positions)
    turns, shifts = np.split(motions_between(mesh.positions / cell, mesh.faces), [9], axis=1)
    images = (
        np.einsum("kij,nj->kni", turns.reshape(-1, 3, 3), mesh.positions) + cell * shifts[:, None]
    )
    apart, nearest = KDTree(mesh.positions).query(images)
    links = np.nonzero(apart < 2 * cell)
    graph = coo_array((np.ones(len(links[0])), (links[1], nearest[links])), shape=(count, count))
    _, first, of, alike = np.unique(
        connected_components(graph, directed=False)[1],
        return_index=True,
        return_inverse=True,
        return_counts=True,
    )
    low, high = mesh.positions.min(axis=0), mesh.positions.max(axis=0)
    colors = 0.45 + 0.55 * ((mesh.positions[first] - low) / (high - low))[of][mesh.faces].mean(
        axis=1
    )
    colors[(alike[of] == 1)[mesh.faces].any(axis=1)] = 0.75
    return render(mesh.positions, mesh.faces, PIXELS, view=view_matrix(-60.0, 50.0), colors=colors)


def celled(mesh: TriangleMesh) -> list[tuple[str, Image]]:
    """The cells of a scan, their blocks, and the shape that these give, with titles."""
    data = bsm.encode(mesh, threads=1)
    with bsm.Decoder(threads=1, layers=1) as decoder:
        events = [*decoder.events([data])]
    header = next(event.header for event in events if isinstance(event, bsm.HeaderEvent))
    shape = next(event for event in reversed(events) if isinstance(event, bsm.BlockEvent))
    base, whole = np.empty((header.vertices, 3)), bsm.decode(data, threads=1)
    base[shape.vertices] = shape.positions
    cells = cells_of(graph_of_faces(whole.faces, header.vertices), whole.faces, header.base[1])
    parts = derive_partition(cells.graph, header.blocks).labels
    own = cells.own[whole.faces[:, 0]]
    shades = np.random.default_rng(1).uniform(0.35, 1.0, (len(parts), 3))
    hues = np.random.default_rng(3).uniform(0.35, 1.0, (header.blocks, 3))[parts]
    titles = (
        f"{len(parts)} cells",
        f"{header.blocks} blocks of cells",
        "prolonged to all vertices",
        "with levels",
    )
    drawn = (
        (whole.positions, shades[own]),
        (whole.positions, hues[own]),
        (base, None),
        (whole.positions, None),
    )
    images = [
        render(at @ UPRIGHT.T, whole.faces, SIDE, view=VIEW, colors=colors) for at, colors in drawn
    ]
    return list(zip(titles, images, strict=True))


def trials(mesh: TriangleMesh, target: Path) -> None:
    """Draw the trials of the default on a mesh, each by its bytes and its look, numbered as they were made."""
    from matplotlib.figure import Figure

    encoder = bsm.Encoder(mesh, bsm.EncodeOptions(threads=1))
    encoder.encode()
    drawn = [event for event in encoder.trials if event.action == "draw"]
    figure = Figure(figsize=(6.0, 3.2), layout="constrained")
    axes = figure.add_subplot(
        xlabel="bytes of a trial", ylabel="share of its bound (1: looks the same)"
    )
    axes.axhline(1.0, color="0.6", linestyle="--")
    for number, event in enumerate(drawn, 1):
        color = "tab:green" if event.error <= 1.0 else "tab:red"
        axes.plot(event.size, event.error, "o", color=color)
        axes.annotate(str(number), (event.size, event.error), (6, 4), textcoords="offset points")
    figure.savefig(target, dpi=120)


def pages(folder: Path, target: Path, work: Path) -> list[Path]:
    """Take pictures of the page of `bsm view` with a scan, its errors, and a textured asset on a phone."""
    scan, asset = (
        _saved(folder / mesh, work)[0] for mesh in ("static/bunny_34834.ply", "assets/Duck.glb")
    )
    scan_names = [target / Path(name).name for name in PAGES]
    _shoot(
        _shot(scan, scan_names[0], 3, size=(1280, 800)),
        _shot(scan, scan_names[1], 3, "e3", size=(1280, 800), dark=True),
        _shot(asset, scan_names[2], 2, size=(390, 780)),
    )
    return scan_names


def tables(folder: Path, work: Path) -> None:
    """Draw tables of originals and decoded meshes, each as the page draws it, under their sizes."""
    from PIL import Image as Pictures
    from PIL import ImageDraw, ImageFont

    for target, names in ((SCANS, SCANNED), (ASSETS, DRESSED)):
        saved = [_saved(folder / name, work) for name in names]
        rows = [
            [work / f"{row}-{column}.jpg" for column in range(len(c.layers))]
            for row, (_, c) in enumerate(saved)
        ]
        shots = [
            _shot(page, picture, len(row), str(number + 1), size=(SIDE, SIDE), turns=turns)
            for (page, _), row, turns in zip(saved, rows, names.values(), strict=True)
            for number, picture in enumerate(row)
        ]
        _shoot(*shots)
        wide, high = max(map(len, rows)), len(rows)
        # Scans are rows, with Draco at the end; assets are columns.
        across = target == SCANS
        sheet = Pictures.new(
            "RGB",
            tuple(np.multiply((SIDE, SIDE + LINE), (wide, high) if across else (high, wide))),
            "white",
        )
        pen, font = ImageDraw.Draw(sheet), ImageFont.load_default(15)
        for i, (row, (_, content)) in enumerate(zip(rows, saved, strict=True)):
            for j, (picture, layer) in enumerate(zip(row, content.layers, strict=True)):
                x, y = np.multiply((j, i) if across else (i, j), (SIDE, SIDE + LINE))
                title = f"{content.name if j == 0 else layer.title}: {layer.size / 1000:,.{int(layer.size < 1e5)}f} kB"
                sheet.paste(Pictures.open(picture), (int(x), int(y) + LINE))
                pen.text((x + SIDE / 2, y + LINE / 2), title, fill="black", font=font, anchor="mm")
        sheet.save(ROOT / target, quality=85, optimize=True)


def _saved(mesh: Path, work: Path) -> tuple[Path, Content]:
    """Save the page of a mesh; return it with what it shows."""
    content = made(
        mesh.name, mesh.stat().st_size, bsm.read_mesh(mesh), "balanced", lambda stage, share: None
    )
    page = work / f"{mesh.stem}.html"
    page.write_text(page_with([content]), encoding="utf-8")
    return page, content


def _shot(page: Path, picture: Path, layers: int, keys: str = "", **more: Any) -> dict[str, Any]:
    return {"page": str(page), "picture": str(picture), "layers": layers, "keys": keys, **more}


def _shoot(*shots: dict[str, Any]) -> None:
    environment = os.environ | {"BSM_PAGES": json.dumps(shots)}
    subprocess.run(
        ["node", "scripts/test.mjs", "pages"], cwd=ROOT / "web", env=environment, check=True
    )


def scan(path: Path) -> tuple[list[tuple[str, Image]], dict[str, str]]:
    """A scan, what the default makes of it, and the finest Draco file that is no larger; the sizes of the first two, as
    they stand in the table of the README, for the text of the picture."""
    mesh = bsm.load(path)
    data = bsm.encode(mesh)
    theirs = _draco_within(mesh, len(data))
    bounds = bounds_of(mesh.positions @ UPRIGHT.T, VIEW)
    figures = {
        "file": f"{path.stat().st_size / 1000:,.0f} kB",
        "balanced": f"{len(data) / 1000:.1f} kB",
    }
    rows = (
        (f"scan: {figures['file']}", mesh),
        (f"BSM, default: {figures['balanced']}", bsm.decode(data)),
    )
    last = (f"Draco at that size: {len(theirs) / 1000:.1f} kB", decode_draco(theirs))
    return [(name, _drawn(f.positions, f.faces, bounds)) for name, f in (*rows, last)], figures


def _draco_within(mesh: TriangleMesh, size: int) -> bytes:
    """Draco's largest file of at most so many bytes: a wider range of positions makes steps between those of bits."""
    extent = float(np.ptp(mesh.positions, axis=0).max())
    bits = next(bits for bits in range(4, 31) if len(encode_draco(mesh, bits, 10)) > size)
    wider = (
        encode_draco(mesh, bits, 10, quantization_range=extent * by)
        for by in np.geomspace(1, 2, 25)
    )
    return max((file for file in wider if len(file) <= size), key=len)


def part(folder: Path) -> list[tuple[str, Image]]:
    """A noisy part, and what denoising makes of it."""
    noisy = bsm.load(folder / "noisy" / "fandisk_0.3_noisy.ply")
    clean = bsm.denoise(noisy)
    bounds = bounds_of(noisy.positions)
    pairs: tuple[tuple[str, TriangleMesh], ...] = (("noisy", noisy), ("denoised", clean))
    return [
        (name, render(mesh.positions, mesh.faces, PIXELS, bounds=bounds)) for name, mesh in pairs
    ]


def steady(path: Path) -> Image:
    """Three frames of a noisy sequence, and under them what denoising makes of them."""
    with np.load(path) as arrays:
        # From the side.
        frames, faces = arrays["positions"][:16, :, [2, 1, 0]] * [1.0, 1.0, -1.0], arrays["faces"]
    noisy = np.stack(
        [gaussian_along_normals(frame, faces, 0.2, seed) for seed, frame in enumerate(frames)]
    )
    rows = (noisy[::7], list(FrameDenoiser(noisy[0], faces)(noisy))[::7])
    bounds = bounds_of(noisy[::7].reshape(-1, 3))
    drawn = [[render(frame, faces, SIDE, bounds=bounds) for frame in row] for row in rows]
    return np.concatenate([np.concatenate(row, axis=1) for row in drawn])


def _drawn(
    positions: Positions, faces: Faces, bounds: tuple[Image, float], pixels: int = PIXELS
) -> Image:
    return render(positions @ UPRIGHT.T, faces, pixels, view=VIEW, bounds=bounds)


def motion(path: Path, target: Path) -> str:
    """Film a decoded sequence next to the frames that Draco keeps in as many bytes, each shown until the next one."""
    from PIL import Image as Pictures
    from PIL import ImageDraw, ImageFont

    with np.load(path) as arrays:
        frames, given = arrays["positions"], arrays["faces"]
    data = bsm.encode_sequence(frames, given)
    positions, faces = bsm.decode_sequence(data)
    size = len(encode_draco(TriangleMesh(frames[0], given), KEY_BITS, 10))
    keys = np.linspace(0, len(frames), max(1, len(data) // size), endpoint=False).astype(int)
    theirs = [encode_draco(TriangleMesh(frames[key], given), KEY_BITS, 10) for key in keys]
    shown = [decode_draco(file) for file in theirs]
    chosen = range(0, len(frames), max(1, len(frames) // FRAMES))
    bounds = bounds_of(frames[list(chosen)].reshape(-1, 3) @ UPRIGHT.T, VIEW)
    titles = (
        f"BSM, {len(frames)} frames: {len(data) / 1000:.1f} kB",
        f"Draco, {len(keys)} frames: {sum(map(len, theirs)) / 1000:.1f} kB",
    )
    font, images = ImageFont.load_default(15), []
    for index in chosen:
        key = shown[int(np.searchsorted(keys, index, side="right")) - 1]
        sides = [
            _drawn(positions[index], faces, bounds, SIDE),
            _drawn(key.positions, key.faces, bounds, SIDE),
        ]
        sheet = Pictures.new("RGB", (2 * SIDE, SIDE + LINE), "white")
        for number, (side, title) in enumerate(zip(sides, titles, strict=True)):
            sheet.paste(Pictures.fromarray(np.uint8(255 * side)), (number * SIDE, LINE))
            ImageDraw.Draw(sheet).text(
                ((number + 0.5) * SIDE, LINE / 2), title, fill="black", font=font, anchor="mm"
            )
        images.append(sheet)
    images[0].save(
        target,
        save_all=True,
        append_images=images[1:],
        duration=MILLISECONDS,
        loop=0,
        quality=60,
        method=6,
    )
    return f"{path.stem}: {frames.nbytes} bytes as float32, {len(data)} as a stream"


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m tools.pictures", description=__doc__)
    parser.add_argument("folder", metavar="FOLDER", help="folder of meshes")
    return parser


if __name__ == "__main__":
    run_command(_parser(), main)
