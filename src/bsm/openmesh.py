"""Meshes of OpenMesh (the extra `openmesh`): `to_openmesh`; every function that takes a mesh takes one of these.

>>> import bsm
>>> import bsm.openmesh
>>> mesh = bsm.openmesh.to_openmesh("bunny.bsm")
>>> mesh.n_vertices() > 1000 and len(bsm.encode(mesh)) > 1000
True
"""

from typing import Any

from bsm.bitstream.errors import MeshError, imported
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.welding import split_by_attributes
from bsm.files.formats.metadata import first, left_out, rgba, shown_at_vertices
from bsm.files.libraries import as_mesh, warn

__all__ = ["from_openmesh", "to_openmesh"]


def to_openmesh(mesh: Any) -> Any:
    """Convert a mesh to an `openmesh.TriMesh`, with normals, colors and texture coordinates.

    Vertices are split where corners differ; a `BsmWarning` names what OpenMesh cannot hold.
    """
    openmesh = imported("openmesh", "such meshes are made with openmesh", "openmesh")
    mesh = split_by_attributes(as_mesh(mesh))
    made = openmesh.TriMesh(mesh.positions, mesh.faces)
    # OpenMesh leaves such faces out without a word, as its halfedges only hold manifold surfaces.
    if lost := len(mesh.faces) - made.n_faces():
        raise MeshError(
            f"openmesh cannot hold {lost} of {len(mesh.faces)} faces: more than two meet at an edge, or neighbors are "
            "turned against each other; write another format"
        )
    shown = (*shown_at_vertices(mesh), first(mesh, "color", (3, 4), "face"))
    places = (made.vertex_normals, made.vertex_colors, made.vertex_texcoords2D, made.face_colors)
    for attribute, place in zip(shown, places, strict=True):
        if attribute is not None:
            values = rgba(attribute) / 255 if attribute.semantic == "color" else attribute.values
            table = place()  # a view of the memory that this call takes
            table[:] = values[:, : table.shape[1]]
    if left := left_out(mesh, shown, mesh.metadata):
        warn([f"left out: {', '.join(left)}"])
    return made


def from_openmesh(mesh: Any) -> TriangleMesh:
    """Convert an `openmesh.TriMesh` or `PolyMesh` to a mesh."""
    return as_mesh(mesh)
