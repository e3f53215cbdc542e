"""`bsm.show`: meshes and streams in a notebook."""

import os
from pathlib import Path
from typing import Any

import numpy as np

from bsm.api import encode, encode_sequence
from bsm.bitstream.errors import OptionError, imported
from bsm.files.libraries import as_file, as_mesh
from bsm.files.stream import is_stream
from bsm.viewer.contents import Content, alone, compared
from bsm.viewer.page import check_crease_angle, embedded, listed, script


def show(
    source: Any,
    *,
    original: Any = None,
    height: int = 480,
    crease_angle: float | None = None,
    **keywords: Any,
) -> Any:
    """Show a mesh, a sequence or a stream in a notebook, block by block as it is decoded.

    Parameters
    ----------
    source : stream, mesh, or pair of arrays
        Bytes, a file or the path of a stream; a mesh as `encode` takes it; or (positions, faces) of a sequence, with
        positions of shape (T, n, 3). Meshes and sequences are encoded first.
    original : mesh, optional
        The original to compare a stream with. A mesh that `show` encodes is its own original.
    height : int
        Height of the widget, in pixels.
    crease_angle : float, optional
        Edges at which faces turn by more degrees than this look sharp: 0 is flat, 180 smooth. By default, only meshes
        with clearly sharp edges have some, from 40 degrees on. Normals of the mesh come first.
    **keywords
        Options for encoding, as in `encode` or `encode_sequence`.

    Returns
    -------
    anywidget.AnyWidget
        A notebook draws it if it is the last value of a cell.

    Raises
    ------
    BsmError
        As in `encode` and `compare`; `DependencyError` if anywidget is missing.

    Examples
    --------
    >>> import bsm
    >>> widget = bsm.show("bunny.ply", preset="fine")
    """
    imported("anywidget", "a notebook needs the package anywidget", "notebook")
    import anywidget
    import traitlets

    check_crease_angle(crease_angle)

    class StreamWidget(anywidget.AnyWidget):
        _esm = script(embedded, crease_angle=crease_angle)
        content = traitlets.Dict().tag(sync=True)
        height = traitlets.Int().tag(sync=True)

    return StreamWidget(
        content=listed(_content(source, original, keywords), "", embedded), height=height
    )


def _content(source: Any, original: Any, keywords: dict[str, Any]) -> Content:
    name = "mesh"
    if isinstance(source, (str, os.PathLike)):
        name = Path(source).name
    given = as_file(source)
    mesh = None
    if original is not None:
        mesh = as_mesh(original)
    preset = None
    if given and is_stream(given):
        if keywords:
            raise OptionError(
                f"this is encoded already: {', '.join(keywords)} cannot be chosen any more"
            )
        data = given.read_all()
    elif isinstance(source, tuple) and len(source) == 2 and np.ndim(source[0]) == 3:
        data = encode_sequence(*source, **keywords)
    else:
        data = encode(encoded := as_mesh(given or source), **keywords)
        # A promise is shown where the preset alone was chosen, and the mesh is compared with itself.
        if not mesh and not set(keywords) - {"preset"}:
            preset = keywords.get("preset", "balanced")
        mesh = mesh or encoded
    if mesh is None:
        return alone(name, data)
    return compared(name, data, mesh, preset=preset)
