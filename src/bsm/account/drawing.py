"""One drawing of losses, for all commands: meshes as they look, and errors as colors with a bar."""

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import DependencyError
from bsm.codec.arrays import Matrix
from bsm.codec.geometry.attributes import at_corners
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.files.conventions import shares_of
from bsm.files.formats.appearance import Appearance, appearance
from bsm.files.formats.metadata import images_in, materials_in
from bsm.files.images import opened
from bsm.ground.console import Console
from bsm.ground.lengths import unit_of
from bsm.ground.pictures import Bar, bounds_of, colors_of, png, render, with_titles

# Percentile of the errors that has the last color: single vertices shall not make all others blue.
SHOWN = 99.0


@dataclass(frozen=True, eq=False)
class Panel:
    """A mesh under a title; with the error of each vertex, in the unit of the mesh, that in colors."""

    mesh: TriangleMesh
    title: str
    far: npt.NDArray[np.float64] | None = None


def drawing(
    panels: Sequence[Panel], original: TriangleMesh, console: Console, *views: Matrix
) -> bytes:
    """Return a PNG file of meshes from each of the views; a note says so if matplotlib cannot write the titles."""
    every = np.concatenate(
        [panel.far for panel in panels if panel.far is not None] or [np.zeros(1)]
    )
    top, largest = last_color(every), float(every.max(initial=0.0))
    pictures, titles = [], []
    for view in views:
        # Those of the original for all panels: a decoded mesh with one stray vertex would be drawn smaller than its
        # pair.
        bounds = bounds_of(original.positions, view)
        for panel in panels:
            if panel.far is None:
                colors = surface_colors(panel.mesh)
            else:
                colors = heat(panel, top)
            drawn = render(
                panel.mesh.positions, panel.mesh.faces, view=view, bounds=bounds, colors=colors
            )
            pictures.append(drawn)
            titles.append(panel.title)
    scale, unit = 1.0, unit_of(original.metadata)
    if not unit:
        scale, unit = 100.0 / (original.diagonal or 1.0), "% of the diagonal"
    bar = Bar(scale * top, scale * largest, f"{unit}; largest {scale * largest:.3g}")
    try:
        return with_titles(pictures, titles, bar)
    except DependencyError as problem:
        console.note(f"no titles: {problem}")
        return png(np.hstack(pictures))


def last_color(far: npt.NDArray[np.float64]) -> float:
    """The error that has the last color."""
    return float(np.percentile(far, SHOWN)) or float(far.max(initial=0.0)) or 1.0


def heat(panel: Panel, top: float) -> npt.NDArray[np.float64]:
    assert panel.far is not None
    found: npt.NDArray[np.float64] = (
        colors_of(panel.far / top)[panel.mesh.faces].mean(axis=1) / 255.0
    )
    return found


def surface_colors(mesh: TriangleMesh) -> npt.NDArray[np.float64] | None:
    """The color of each face, shape (m, 3): by colors of the mesh, or by its textures; None without any."""
    painted = next(
        (a for a in mesh.attributes if a.semantic == "color" and a.components >= 3), None
    )
    if painted is not None:
        return np.asarray(
            shares_of(at_corners(painted, mesh.faces))[..., :3].mean(axis=1), np.float64
        )
    placed = next(
        (at_corners(a, mesh.faces) for a in mesh.attributes if a.semantic == "texcoord"), None
    )
    known = {number: appearance(words) for number, words in materials_in(mesh.metadata).items()}
    if placed is None or not any(look.color_texture for look in known.values()):
        return None
    own = next(
        (a.values[:, 0] for a in mesh.attributes if a.name == "material" and a.domain == "face"),
        None,
    )
    numbers = own
    if numbers is None:
        numbers = np.full(len(mesh.faces), min(known))
    colors = np.ones((len(mesh.faces), 3))
    for number, look in known.items():
        colors[numbers == number] = _sampled(look, mesh, placed[numbers == number].mean(axis=1))
    return colors


def _sampled(look: Appearance, mesh: TriangleMesh, places: Matrix) -> Matrix:
    """Colors of a material at texture coordinates, shape (k, 2), which count from the bottom."""
    data = b""
    if look.color_texture:
        _, data = images_in(mesh.metadata).get(look.color_texture.image, ("", b""))
    image = None
    # Without Pillow the plain color is better than no picture.
    with suppress(DependencyError):
        image = opened(data)
    if image is None:
        return np.broadcast_to(np.array(look.color), (len(places), 3))
    pixels = np.asarray(image.convert("RGB"), np.float64) / 255.0
    high, wide = pixels.shape[:2]
    # Textures repeat, the usual rule of formats, and a place of exactly 1 is that of 0.
    across, up = ((places % 1.0) * (wide, high)).astype(int).clip(0, (wide - 1, high - 1)).T
    found: Matrix = pixels[high - 1 - up, across]
    return found
