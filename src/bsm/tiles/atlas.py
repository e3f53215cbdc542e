"""The texture of a tile: its charts, cut out of images or of the atlases of finer tiles, side by side in one image."""

import io
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import FormatError, LimitError, imported
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.graph import components, graph_of_faces
from bsm.codec.geometry.mesh import Metadata, TriangleMesh
from bsm.codec.geometry.metrics import face_geometry
from bsm.codec.geometry.welding import row_numbers
from bsm.files.images import ImageRule
from bsm.files.pipes import about

Skin: TypeAlias = npt.NDArray[np.float32]
"""Of each corner of each face: texels from the upper left of a picture, the picture, and its chart; or nothing."""
# Texture filters and the blocks of JPEG and WebP mix neighboring texels. Three of them keep other charts out.
_PAD = 3  # texels around a chart that have its colors
# WebP ends at 16,383 pixels, and so do the textures of many graphics cards.
_MOST_SIDE = 1 << 14
_NEED = "textures are cut with Pillow and SciPy", "formats"


def opened(picture: Path | io.BytesIO) -> Any:
    """A picture, closed after use, of which only the size is read."""
    pillow = imported("PIL.Image", *_NEED)
    try:
        return pillow.open(picture)
    except pillow.DecompressionBombError as error:
        raise LimitError(f"a texture is too large: {error}") from error


def checked(picture: bytes, name: str) -> bytes:
    """An image that Pillow can read, or an error with its name."""
    with about(f"the image {name}"):
        try:
            with opened(io.BytesIO(picture)) as image:
                # Pillow reads only the header until then, and a file that is cut short would fail much later, in
                # another process.
                image.load()
        except (OSError, ValueError, SyntaxError) as error:
            raise FormatError(
                "it cannot be read; repair it, or take it away from the mesh"
            ) from error
    return picture


def skin_of(
    texcoords: npt.NDArray[np.float32], materials: npt.NDArray[Any], pictures: Sequence[Path]
) -> Skin:
    """The skin of faces by their texture coordinates, shape (faces, 3, 2), and the pictures of their materials."""
    corner_materials = np.repeat(materials, 3).reshape(-1, 3, 1)
    keys = np.dstack([texcoords, corner_materials]).astype(np.float32)
    ids = row_numbers(keys.reshape(-1, 3))
    # Corners with equal texture coordinates and material are one node. What is connected there is a chart.
    graph = graph_of_faces(ids.reshape(-1, 3), int(ids.max()) + 1)
    charts = components(graph)[ids].reshape(-1, 3, 1)
    sizes = np.zeros((len(pictures), 2))
    for number, path in enumerate(pictures):
        with opened(path) as picture:
            sizes[number] = picture.size
    # Texture coordinates count from below, pictures from above.
    shares = texcoords * [1, -1] + [0, 1]
    corners = shares * sizes[materials][:, None]
    return np.dstack([corners, corner_materials, charts]).astype(np.float32)


def joined_skins(skins: Sequence[Skin]) -> Skin:
    """The skins of finer tiles as one, whose pictures are their atlases."""
    for number, skin in enumerate(skins):
        skin[..., 2:3] = number
    return np.concatenate(skins)


def wedges_of(skin: Skin, faces: npt.NDArray[np.int32]) -> npt.NDArray[np.int32]:
    """A number for each corner, equal for those that meet at a vertex and in a chart."""
    return row_numbers(np.column_stack([faces.ravel(), skin.reshape(-1, 4)])).reshape(-1, 3)


def cut_out(skin: Skin, pictures: Sequence[Path], factor: int) -> tuple[Skin, Any]:
    """The skin on an atlas of its charts, and the atlas, which has one texel for `factor` along each side."""
    used, charts = np.unique(skin[:, 0, 2:], axis=0, return_inverse=True)
    charts = charts.reshape(-1)
    texels = skin[..., :2] / factor
    lowest = np.full((len(used), 2), np.inf)
    highest = -lowest
    np.minimum.at(lowest, charts, texels.min(axis=1))
    np.maximum.at(highest, charts, texels.max(axis=1))
    if not (highest - lowest).max() < _MOST_SIDE:
        raise LimitError("a texture repeats too often over one part; tiles cut out each repetition")
    # Bilinear filters read half a texel beyond the edge of a triangle, so texels that edges touch belong to it.
    low = np.floor(lowest).astype(np.int64) - 1
    sizes = np.floor(highest).astype(np.int64) + 2 - low
    places, wide, tall = _packed(sizes + 2 * _PAD)
    places += _PAD
    corners = texels + (places - low)[charts][:, None]
    atlas = np.zeros((tall, wide, 3), np.uint8)
    picture_numbers = used[:, 0]
    for number in np.unique(picture_numbers).tolist():
        with opened(pictures[int(number)]) as image:
            picture = np.asarray(image.convert("RGB"))
        for chart in np.flatnonzero(picture_numbers == number).tolist():
            column, top = places[chart].tolist()
            across, down = sizes[chart].tolist()
            atlas[top : top + down, column : column + across] = _cut_chart(
                picture, low[chart], sizes[chart], factor
            )
    chart_of_corner = np.repeat(charts, 3).reshape(-1, 3)
    skin = np.dstack([corners, np.zeros_like(chart_of_corner), chart_of_corner])
    image = imported("PIL.Image", *_NEED).fromarray(_spread(atlas, corners))
    return skin.astype(np.float32), image


def _cut_chart(
    picture: npt.NDArray[np.uint8], low: Any, size: Any, factor: int
) -> npt.NDArray[Any]:
    """Return the texels of a chart from the place `low` on, each the mean of `factor` along each side."""
    x, y = (low * factor).tolist()
    across, down = size.tolist()
    # Charts may reach beyond the picture, which then repeats. An atlas cannot repeat, so the repetitions are cut out.
    rows = picture.take(range(y, y + down * factor), 0, mode="wrap")
    pixels = rows.take(range(x, x + across * factor), 1, mode="wrap")
    # A mean of squares is the exact filter where the factor is a whole number. It needs no library, and does not blur.
    squares = pixels.reshape(down, factor, across, factor, 3)
    return np.asarray(np.rint(squares.mean(axis=(1, 3))))


def _packed(sizes: npt.NDArray[np.int64]) -> tuple[npt.NDArray[np.int64], int, int]:
    """Where rectangles are on shelves of about a square, the tallest first, and how large it is."""
    # Shelves waste a tenth of the area or so. Better packing costs far more time, and the waste has one color, which
    # image codecs send for almost nothing.
    area = sizes.prod(axis=1).sum()
    wide = max(int(sizes[:, 0].max()), int(np.sqrt(area) * 1.1))
    places = np.zeros_like(sizes)
    x = y = shelf = 0
    for number in np.argsort(-sizes[:, 1], kind="stable").tolist():
        across, down = sizes[number].tolist()
        if x + across > wide:
            x = 0
            y += shelf
            shelf = down
        shelf = max(shelf, down)
        places[number] = x, y
        x += across
    tall = y + shelf
    if max(wide, tall) >= _MOST_SIDE:
        raise LimitError(
            f"the texture of a tile has {wide} x {tall} texels; choose fewer --triangles"
        )
    return places, wide, tall


def _spread(atlas: npt.NDArray[np.uint8], corners: npt.NDArray[Any]) -> npt.NDArray[np.uint8]:
    """An atlas whose texels outside of all triangles have the color of the nearest texel inside of one."""
    outside = imported("PIL.Image", *_NEED).new("1", atlas.shape[1::-1], 1)
    draw = imported("PIL.ImageDraw", *_NEED).Draw(outside)
    triangles = corners.reshape(-1, 6) - 0.5  # Pillow counts from the middles of texels
    # Not numpy: filling polygons is a loop over pixels in C, and Pillow has it.
    for triangle in triangles.tolist():
        draw.polygon(triangle, fill=0)
    # Texels between charts get the color of the nearest one, since mipmaps of viewers mix them into the charts.
    find_nearest = imported("scipy.ndimage", *_NEED).distance_transform_edt
    rows, columns = find_nearest(np.asarray(outside), return_distances=False, return_indices=True)
    return np.asarray(atlas[rows, columns])


def textured(mesh: TriangleMesh, skin: Skin, atlas: Any, rule: ImageRule) -> TriangleMesh:
    """A mesh with texture coordinates, and with the atlas as the image of its material."""
    texels = skin[..., :2].reshape(-1, 2).astype(np.float64)
    shares = texels / atlas.size * [1, -1] + [0, 1]
    different, rows = np.unique(shares.astype(np.float32), axis=0, return_inverse=True)
    indices = rows.reshape(-1, 3).astype(np.int32)
    texcoord = Attribute("texcoord", different, "corner", "texcoord", indices)
    side = rule.side or _MOST_SIDE
    atlas.thumbnail((side, side))
    file = io.BytesIO()
    atlas.save(file, rule.kind, quality=rule.quality)
    image: Metadata = {
        "material.0.map_Kd": 0,
        "image.0.name": f"atlas.{rule.kind}",
        "image.0.data": file.getvalue(),
    }
    return replace(mesh, attributes=(*mesh.attributes, texcoord), metadata=image)


def side_of_texel(mesh: TriangleMesh, skin: Skin) -> float:
    """The side of a texel on the surface, in the mean."""
    corners = skin[..., :2].reshape(-1, 2)
    flat = np.pad(corners, ((0, 0), (0, 1))).astype(np.float64)
    flat_faces = np.arange(len(flat), dtype=np.int32).reshape(-1, 3)
    # Areas and not lengths: triangles of a texture are often stretched along one direction.
    texels = face_geometry(flat, flat_faces).areas.sum()
    area = face_geometry(mesh.positions, mesh.faces).areas.sum()
    return float(np.sqrt(area / max(texels, 1.0)))
