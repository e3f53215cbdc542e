"""Pictures as bytes, renderings as PNG and diagrams as SVG."""

from __future__ import annotations

import io
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from bsm.codec.arrays import Faces, Positions
from bsm.evaluation.plots import import_matplotlib
from bsm.pictures import bounds_of, render
from tools.measure.paper.report import Picture
from tools.measure.paper.study import Model

Colors = npt.NDArray[np.float64]
_GOLDEN = 0.618034


def portrait(
    caption: str,
    model: Model,
    positions: Positions,
    pixels: int,
    *,
    like: Positions | None = None,
    colors: Colors | None = None,
) -> Picture:
    """A model with other positions, as large as the clean one, or as `like`; `colors` gives each face's colour."""
    bounds = bounds_of(model.clean if like is None else like, model.view)
    return image(caption, render(positions, model.faces, pixels, view=model.view, bounds=bounds, colors=colors))


def image(caption: str, pixels: npt.NDArray[np.float64]) -> Picture:
    """An array of pixels, shape (h, w, 3), in 0..1, as a PNG."""
    import_matplotlib()
    from matplotlib.image import imsave

    buffer = io.BytesIO()
    imsave(buffer, np.clip(pixels, 0.0, 1.0), format="png")
    return Picture(caption, "image/png", buffer.getvalue())


def heat(caption: str, matrix: npt.NDArray[np.float64], scale: int = 2) -> Picture:
    """A matrix in colours, from its lowest value (blue) to its highest (yellow)."""
    import_matplotlib()
    from matplotlib import colormaps

    span = float(np.ptp(matrix)) or 1.0
    pixels = np.repeat(np.repeat((matrix - matrix.min()) / span, scale, axis=0), scale, axis=1)
    return image(caption, colormaps["viridis"](pixels)[..., :3])


def diagram(caption: str, draw: Callable[[Any], None]) -> Picture:
    """A diagram on one pair of axes."""
    import_matplotlib()
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.4, 4.2), layout="constrained")
    axes = figure.subplots()
    axes.grid(alpha=0.3)
    draw(axes)
    buffer = io.BytesIO()
    figure.savefig(buffer, format="svg")
    return Picture(caption, "image/svg+xml", buffer.getvalue())


def drawn(caption: str, draw: Callable[[Path], list[Path]]) -> Picture:
    """The SVG of a function of `bsm.evaluation.plots`, which takes a stem and writes files."""
    with tempfile.TemporaryDirectory() as folder:
        (path,) = [path for path in draw(Path(folder) / "picture") if path.suffix == ".svg"]
        return Picture(caption, "image/svg+xml", path.read_bytes())


def part_colors(labels: npt.NDArray[np.integer], faces: Faces) -> Colors:
    """A colour for each face by the part that most of its corners are in; neighbours look different."""
    import_matplotlib()
    from matplotlib.colors import hsv_to_rgb

    a, b, c = labels[faces].T
    part = np.where(b == c, b, a)
    hue = part * _GOLDEN % 1.0
    return np.asarray(hsv_to_rgb(np.stack([hue, np.full(len(hue), 0.5), 0.75 + 0.2 * (part % 2)], axis=1)))


def normal_colors(normals: npt.NDArray[np.float64]) -> Colors:
    """A colour for each direction."""
    return 0.5 + 0.5 * normals


def error_colors(distance: npt.NDArray[np.float64], faces: Faces, top: float) -> Colors:
    """A colour for each face by the mean of a quantity at its corners, yellow from `top` on."""
    import_matplotlib()
    from matplotlib import colormaps

    return np.asarray(colormaps["viridis"](np.clip(distance[faces].mean(axis=1) / (top or 1.0), 0.0, 1.0))[:, :3])
