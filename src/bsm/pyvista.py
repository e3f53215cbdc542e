"""pyvista opens and writes .bsm: ``pyvista.read("a.bsm")``, ``mesh.save("b.bsm", preset="fine")``.

Nothing need be imported for that (pyvista 0.48 or later); `to_pyvista` and `from_pyvista` convert meshes. Attributes
are point data and cell data, metadata field data.
"""

from __future__ import annotations

import os
from typing import Any

import numpy as np

from bsm.api import decode, save
from bsm.bitstream.errors import DependencyError
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.splitting import split_by_attributes
from bsm.meshes import as_mesh


def to_pyvista(mesh: Any) -> Any:
    """A mesh as a `pyvista.PolyData`.

    Vertices are split where corners differ, in texture coordinates for instance. Normals and texture coordinates are
    the active ones.

    Parameters
    ----------
    mesh : mesh, pair of arrays, or path
        As `bsm.encode` takes it.

    Raises
    ------
    DependencyError
        If pyvista is missing.
    """
    try:
        import pyvista
    except ImportError as error:
        raise DependencyError("pyvista is not installed; run: pip install 'bsm-codec[pyvista]'") from error
    mesh = split_by_attributes(as_mesh(mesh))
    found = pyvista.PolyData.from_regular_faces(np.array(mesh.positions), mesh.faces)
    for attribute in mesh.attributes:
        data = found.cell_data if attribute.domain == "face" else found.point_data
        values = attribute.values
        data.set_array(np.array(values[:, 0] if attribute.components == 1 else values), attribute.name)
        if attribute.domain == "vertex" and attribute.semantic == "texcoord" and attribute.components == 2:
            data.active_texture_coordinates_name = attribute.name
        if attribute.domain == "vertex" and attribute.semantic == "normal" and attribute.components == 3:
            data.active_normals_name = attribute.name
    for name, value in mesh.metadata.items():
        found.field_data[name] = np.frombuffer(value, np.uint8) if isinstance(value, bytes) else [value]
    return found


def from_pyvista(mesh: Any) -> TriangleMesh:
    """A `pyvista.PolyData`, its polygons cut into triangles, with point data, cell data and field data."""
    return as_mesh(mesh)


def read(path: str, **keywords: Any) -> Any:
    """What `pyvista.read` calls for a stream; keywords are those of `bsm.decode`."""
    return to_pyvista(decode(path, **keywords))


def write(mesh: Any, path: str | os.PathLike[str], **keywords: Any) -> None:
    """What `save` of a `pyvista.PolyData` calls for a stream; keywords are those of `bsm.encode`."""
    save(from_pyvista(mesh), path, **keywords)
