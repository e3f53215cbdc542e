"""Meshes of OpenMesh (the extra `openmesh`): `to_openmesh`; every function that takes a mesh takes one of these.

>>> import bsm
>>> import bsm.openmesh
>>> mesh = bsm.openmesh.to_openmesh("bunny.bsm")
>>> mesh.n_vertices() > 1000 and len(bsm.encode(mesh)) > 1000
True
"""

from typing import Any

from bsm.codec.geometry.mesh import TriangleMesh
from bsm.files.formats.om import made_of
from bsm.libraries import as_mesh, warn

__all__ = ["from_openmesh", "to_openmesh"]


def to_openmesh(mesh: Any) -> Any:
    """Convert a mesh to an `openmesh.TriMesh`, with normals, colors and texture coordinates.

    Vertices are split where corners differ; a `BsmWarning` names what OpenMesh cannot hold.
    """
    made, lost = made_of(as_mesh(mesh))
    warn([f"left out: {', '.join(lost)}"] if lost else [])
    return made


def from_openmesh(mesh: Any) -> TriangleMesh:
    """Convert an `openmesh.TriMesh` or `PolyMesh` to a mesh."""
    return as_mesh(mesh)
