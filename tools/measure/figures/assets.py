"""A picture of whole assets before and after: textures, colours and values drawn on original and decoded meshes.

python -m tools.measure assets FOLDER [-o docs/guides/assets.png]
"""

from __future__ import annotations

import argparse
import io
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

import bsm
from bsm.bitstream.errors import OptionError
from bsm.codec.geometry.attribute_errors import at_corners
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.console import Console
from bsm.files.formats.materials import as_gltf, images_in, materials_in
from tools.command import run_command

Pixels = npt.NDArray[np.float64]
SIDE = 260
"""Pixels of a mesh."""
FINER = 2
"""A picture is drawn so many times larger, and made small."""
SAMPLES = 3_000_000
CHECKS = 24
"""Squares of the pattern on meshes whose image is not there, along the whole texture."""
LIGHT = np.array([0.35, 0.45, 0.82])


@dataclass(frozen=True)
class Asset:
    """A file, and from where it is seen: turned by degrees around the upright axis, which is `up`, and tilted."""

    name: str
    turn: float
    tilt: float = 15.0
    up: int = 1


ASSETS = (
    Asset("Duck.glb", 35),
    Asset("duck_uv.obj", 35),
    Asset("spot_uv.obj", 215),
    Asset("nicolo_uv.obj", 180, 0),
    Asset("fuze_colours.ply", 60, 25, 2),
    Asset("cortex_sulc.ply", 270, 10),
)


def draw(mesh: TriangleMesh, asset: Asset) -> Pixels:
    """The mesh as a picture, shape (SIDE, SIDE, 3): points of its surface, of which the nearest of each pixel shows."""
    side = FINER * SIDE
    corners = mesh.positions[mesh.faces] @ _view(asset).T
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = np.linalg.norm(normals, axis=1)
    random = np.random.default_rng(0)
    face = random.choice(len(area), SAMPLES, p=area / area.sum())
    weights = random.random((SAMPLES, 2))
    weights[weights.sum(axis=1) > 1] = 1 - weights[weights.sum(axis=1) > 1]
    weights = np.column_stack([1 - weights.sum(axis=1), weights])
    points = np.einsum("ij,ijk->ik", weights, corners[face])
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    places = ((points - (low + high) / 2) / (high - low)[:2].max() * 0.94 + 0.5)[:, :2] * side
    x, y = np.clip(places.astype(np.int64), 0, side - 1).T
    order = np.argsort(points[:, 2], kind="stable")  # the nearest comes last, and stays
    nearest = np.full((side, side), -1)
    nearest[side - 1 - y[order], x[order]] = order
    seen = nearest[nearest >= 0]
    shade = np.abs(normals[face[seen]] @ LIGHT / np.maximum(area[face[seen]], 1e-300))
    picture = np.ones((side, side, 3))
    picture[nearest >= 0] = _colors(mesh, face[seen], weights[seen]) * (0.35 + 0.65 * shade)[:, None]
    return np.asarray(picture.reshape(SIDE, FINER, SIDE, FINER, 3).mean(axis=(1, 3)))


def _view(asset: Asset) -> Pixels:
    """Right, up and towards the viewer, as rows."""
    turn, tilt = np.radians([asset.turn, asset.tilt])
    upright = np.roll(np.eye(3), asset.up - 1, axis=1)
    around = np.array([[np.cos(turn), 0, -np.sin(turn)], [0, 1, 0], [np.sin(turn), 0, np.cos(turn)]])
    over = np.array([[1, 0, 0], [0, np.cos(tilt), -np.sin(tilt)], [0, np.sin(tilt), np.cos(tilt)]])
    rows: Pixels = over @ around @ upright
    return rows


def _colors(mesh: TriangleMesh, face: npt.NDArray[np.int64], weights: Pixels) -> Pixels:
    """What the mesh shows at points of faces, shape (k, 3), from 0 to 1: its image, or squares; colours; or a value."""

    def between(attribute: bsm.Attribute) -> Pixels:
        values = at_corners(attribute, mesh.faces)[face].astype(np.float64)
        return np.asarray(np.einsum("ij,ijk->ik", weights, values), np.float64)

    shown = {one.semantic: between(one) for one in reversed(mesh.attributes) if one.domain != "face"}
    image = _image(mesh)
    if "texcoord" in shown and image is not None:
        height, width, _ = image.shape
        across, down = shown["texcoord"][:, 0] * width, (1 - shown["texcoord"][:, 1]) * height
        texels: Pixels = image[down.astype(np.int64) % height, across.astype(np.int64) % width]
        return texels
    if "texcoord" in shown:
        light = (np.floor(CHECKS * shown["texcoord"]).sum(axis=1) % 2)[:, None]
        return np.asarray(light * np.array([0.95, 0.9, 0.8]) + (1 - light) * np.array([0.25, 0.45, 0.6]))
    if "color" in shown:
        return shown["color"][:, :3] / 255
    import matplotlib

    values = shown["generic"][:, 0]
    low, high = np.percentile(values, [2, 98])
    return np.asarray(matplotlib.colormaps["coolwarm"](np.clip((values - low) / (high - low), 0, 1))[:, :3])


def _image(mesh: TriangleMesh) -> Pixels | None:
    import PIL.Image

    images = images_in(mesh.metadata)
    for material in materials_in(mesh.metadata).values():
        number = as_gltf(material).get("baseColorTexture")
        if isinstance(number, int) and images.get(number, ("", b""))[1]:
            return np.asarray(PIL.Image.open(io.BytesIO(images[number][1])).convert("RGB")) / 255.0
    return None


def work(args: argparse.Namespace, console: Console) -> None:
    """Draw all assets, originals above what comes back."""
    import matplotlib
    import PIL.Image

    matplotlib.use("Agg")
    from matplotlib import pyplot

    found = [asset for asset in ASSETS if (Path(args.assets) / asset.name).exists()]
    if not found:
        raise OptionError(f"{args.assets} holds none of {', '.join(asset.name for asset in ASSETS)}")
    figure, axes = pyplot.subplots(2, len(found), figsize=(1.35 * len(found), 3.0), dpi=SIDE / 1.35, squeeze=False)
    for column, asset in enumerate(found):
        path = Path(args.assets) / asset.name
        original = bsm.load(path)
        data = bsm.encode(original)
        decoded = bsm.decode(data)
        titles = (f"{asset.name}\n{_size(path.stat().st_size)}", _size(len(data)))
        for axis, mesh, title in zip(axes[:, column], (original, decoded), titles, strict=True):
            axis.imshow(draw(mesh, asset))
            axis.set_title(title, fontsize=5, pad=2)
            axis.axis("off")
        console.note(f"{asset.name}: {', '.join(a.name for a in decoded.attributes)}, {len(data)} bytes")
    figure.subplots_adjust(0, 0, 1, 0.9, 0.02, 0.1)
    buffer: Any = io.BytesIO()
    figure.savefig(buffer)
    PIL.Image.open(buffer).convert("RGB").quantize(128).save(args.output, optimize=True)


def _size(count: int) -> str:
    return f"{count / 1000:.0f} kB" if count >= 10_000 else f"{count / 1000:.1f} kB"


def main() -> None:
    """Run the command."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("assets", metavar="FOLDER", help=f"folder of {', '.join(asset.name for asset in ASSETS)}")
    parser.add_argument("-o", "--output", metavar="FILE", default="docs/guides/assets.png", help="the picture")
    run_command(parser, work)
