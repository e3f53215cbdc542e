"""Where one mesh is how far from another, in colours."""

from __future__ import annotations

import io
from dataclasses import replace
from pathlib import Path

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import OptionError
from bsm.codec.arrays import Positions
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.files.mesh import format_of_name, save_written, written_mesh
from bsm.files.output import open_output, refuse_to_overwrite

COLORED = ("ply", "obj", "glb")
"""Formats that hold colours of vertices."""
SCALE = np.array([(49, 54, 149), (116, 173, 209), (255, 255, 191), (244, 109, 67), (165, 0, 38)], np.float64)
"""Colours from no distance to the largest one that is shown, evenly: after ColorBrewer's RdYlBu."""
SHOWN = 99.0
"""Percentile of the distances that has the last colour: single vertices shall not make all others blue."""


def write_map(path: str, original: TriangleMesh, positions: Positions, *, overwrite: bool) -> None:
    """Write the original with the distance of each vertex from `positions`, shape (n, 3), as colours."""
    kind = "png" if Path(path).suffix.lower() == ".png" else format_of_name(path)
    if kind not in ("png", *COLORED):
        raise OptionError(f"{path}: a map of distances is a picture (.png) or a mesh (.{', .'.join(COLORED)})")
    refuse_to_overwrite(path, overwrite)
    distances = np.linalg.norm(positions - original.positions, axis=1)
    top = float(np.percentile(distances, SHOWN)) or float(distances.max(initial=0.0)) or 1.0
    if kind == "png":
        picture = _picture(original, distances / top)
        with open_output(path, overwrite=overwrite) as file:
            file.write(picture)
        return
    shown = (Attribute("color", colors(distances / top), "vertex", "color"), Attribute("distance", distances))
    mesh = replace(original.bare, attributes=shown)
    save_written(path, written_mesh(mesh, kind, path), overwrite=overwrite)


def colors(shares: npt.NDArray[np.float64]) -> npt.NDArray[np.uint8]:
    """Colours of numbers from 0 to 1, shape (n,), as uint8 of shape (n, 3); larger ones have the last."""
    places = np.linspace(0.0, 1.0, len(SCALE))
    channels = [np.interp(shares, places, SCALE[:, channel]) for channel in range(3)]
    return np.rint(np.stack(channels, axis=1)).astype(np.uint8)


def _picture(mesh: TriangleMesh, shares: npt.NDArray[np.float64]) -> bytes:
    """A PNG of the mesh from the front and the back."""
    from bsm.evaluation.plots import import_matplotlib
    from bsm.evaluation.render import DEFAULT_VIEW, render

    import_matplotlib()
    from matplotlib.image import imsave

    faces = colors(shares)[mesh.faces].mean(axis=1) / 255.0
    behind = DEFAULT_VIEW * np.array([[-1.0], [1.0], [-1.0]])
    sides = [render(mesh.positions, mesh.faces, view=view, colors=faces) for view in (DEFAULT_VIEW, behind)]
    file = io.BytesIO()
    imsave(file, np.hstack(sides), format="png")
    return file.getvalue()
