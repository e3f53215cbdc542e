"""Pictures without a graphics card, and without a library but for titles: meshes, colors of numbers, PNG files."""

import io
import struct
import zlib
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import imported
from bsm.codec.arrays import Faces, Positions
from bsm.codec.geometry.metrics import face_normals
from bsm.codec.look.pictures import SAMPLES, Canvas

# Blue to red by way of a light yellow: people with red-green blindness tell its ends apart.
SCALE = np.array(
    [(49, 54, 149), (116, 173, 209), (255, 255, 191), (244, 109, 67), (165, 0, 38)], np.float64
)
"""Colors from 0 to 1, evenly: after ColorBrewer's RdYlBu."""
Image = npt.NDArray[np.float64]


def png(picture: npt.NDArray[Any]) -> bytes:
    """A file of a picture from 0 to 1, of shades, shape (height, width), or of colors, (height, width, 3)."""
    height, width = picture.shape[:2]
    shades = np.rint(255 * picture.clip(0.0, 1.0)).astype(np.uint8).reshape(height, -1)
    # Filters of PNG help photographs. Flat shading has long equal runs, which zlib finds anyway.
    rows = np.pad(shades, ((0, 0), (1, 0)))  # zero before each row: it is predicted from nothing
    kind = 0  # of shades
    if picture.ndim == 3:
        kind = 2  # of colors
    head = struct.pack(">IIBBBBB", width, height, 8, kind, 0, 0, 0)
    chunks = ((b"IHDR", head), (b"IDAT", zlib.compress(rows.tobytes(), 9)), (b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
        for name, data in chunks
    )


class Bar(NamedTuple):
    """A bar of `colors_of` up to a number; larger ones, up to `largest`, have the last color."""

    top: float
    largest: float
    label: str


def with_titles(
    pictures: Sequence[Image],
    titles: Sequence[str],
    bar: Bar | None = None,
    figures: Mapping[str, str] | None = None,
) -> bytes:
    """A PNG file of pictures under titles, with a bar under the last one, and text; by matplotlib."""
    # Asked for before anything is drawn, so that a missing one is an error about packages and not one of matplotlib.
    # By the last of which matplotlib writes.
    for name in ("matplotlib", "matplotlib.figure", "PIL.Image"):
        imported(name, "titles need matplotlib", "eval")
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import ListedColormap, Normalize
    from matplotlib.figure import Figure

    figure = Figure(figsize=(3.2 * len(pictures), 3.6), dpi=120, layout="constrained")
    places = figure.subplots(1, len(pictures), squeeze=False)[0]
    for axes, title, picture in zip(places, titles, pictures, strict=True):
        axes.imshow(picture.clip(0.0, 1.0))
        axes.set_title(title, fontsize=11)
        axes.axis("off")
    if bar is not None:
        colors = ListedColormap(colors_of(np.linspace(0.0, 1.0, 256)) / 255.0)
        scale, ends = ScalarMappable(Normalize(0.0, bar.top), colors), "neither"
        if bar.largest > bar.top:
            ends = "max"
        figure.colorbar(
            scale, ax=places[-1], location="bottom", shrink=0.8, label=bar.label, extend=ends
        )
    with io.BytesIO() as file:
        # Without the version of matplotlib in it, the same picture has the same bytes.
        figure.savefig(file, format="png", metadata={"Software": None, **(figures or {})})
        return file.getvalue()


def colors_of(shares: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Colors of numbers from 0 to 1, shape (n,), from 0 to 255, shape (n, 3); larger ones have the last."""
    places = np.linspace(0.0, 1.0, len(SCALE))
    return np.stack([np.interp(shares, places, channel) for channel in SCALE.T], axis=1)


_LIGHT = np.array([0.35, 0.5, 0.79])
_BASE = np.array([0.72, 0.76, 0.82])
_SUPERSAMPLING = 2
_DEPTHS = 2.0**23  # as many whole numbers, exact in single precision, are depths


def view_matrix(azimuth: float, elevation: float) -> npt.NDArray[np.float64]:
    """Rotation to the camera's axes (right, up, towards the camera); angles in degrees, z is up."""
    a, e = np.radians(azimuth), np.radians(elevation)
    right = [-np.sin(a), np.cos(a), 0.0]
    up = [-np.sin(e) * np.cos(a), -np.sin(e) * np.sin(a), np.cos(e)]
    towards = [np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)]
    return np.array([right, up, towards])


DEFAULT_VIEW = view_matrix(-90.0, 60.0)


def render(
    positions: Positions,
    faces: Faces,
    size: int = 720,
    *,
    view: npt.NDArray[np.float64] | None = None,
    bounds: tuple[npt.NDArray[np.float64], float] | None = None,
    colors: npt.NDArray[np.float64] | None = None,
) -> Image:
    view = DEFAULT_VIEW if view is None else view
    if bounds is None:
        bounds = bounds_of(positions, view)
    center, radius = bounds
    fine = size * _SUPERSAMPLING
    placed = (positions - center) @ view.T / radius
    pixels = (placed * (1.0, -1.0, 1.0) + (1.0, 1.0, 0.0)) * (fine / 2, fine / 2, 1.0)
    # Absolute, since faces of a broken mesh may be turned over, and should not be black.
    shade = 0.25 + 0.75 * np.abs(face_normals(placed, faces) @ _LIGHT)
    # One face for each pixel and then a look-up of its color: the rasterizer need not know about colors.
    owner = nearest_faces(pixels, faces, fine)
    colors = _BASE if colors is None else colors
    table = np.vstack([shade[:, None] * colors, np.ones(3)])
    image = table[owner]
    # Four samples for each pixel smooth the edges, without a filter.
    blocks = image.reshape(size, _SUPERSAMPLING, size, _SUPERSAMPLING, 3)
    return np.asarray(blocks.mean(axis=(1, 3)).clip(0.0, 1.0))


def nearest_faces(pixels: Positions, faces: Faces, size: int) -> npt.NDArray[np.int32]:
    """The face nearest to the camera at each pixel, or -1; vertices have a column, a row and a nearness."""
    low, high = pixels[:, 2].min(), pixels[:, 2].max()
    # The rasterizer compares depths in single precision, which has 24 bits. Spread over all of them, near faces stay
    # apart.
    depths = (pixels[:, 2] - (low + high) / 2) * (_DEPTHS / ((high - low) or 1.0))
    canvas, plain = Canvas(size + -size % SAMPLES), np.zeros((len(faces), 9), np.float32)
    # Which leaves columns, rows and depths as they are.
    camera = np.append(np.eye(3, 4), (0.0, 0.0, 1.0))
    placed = np.ascontiguousarray(np.column_stack([pixels[:, :2], depths]))
    canvas.draw(placed, np.ascontiguousarray(faces, np.int32), plain, camera)
    return canvas.owner[:size, :size]


def bounds_of(
    positions: Positions, view: npt.NDArray[np.float64] = DEFAULT_VIEW
) -> tuple[npt.NDArray[np.float64], float]:
    """The middle of a mesh as the camera sees it, and half the side of a square that holds it with a little air."""
    seen = positions @ view.T
    low, high = seen.min(axis=0), seen.max(axis=0)
    return (low + high) / 2 @ view, 0.515 * float((high - low)[:2].max()) or 1.0
