"""OpenMesh: its meshes in memory (the extra `openmesh`)."""

from typing import Any

import numpy as np

from bsm.bitstream.errors import MeshError, imported
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.welding import split_by_attributes
from bsm.files.formats.metadata import first, left_out, rgba, shown_at_vertices
from bsm.files.formats.polygons import Column, Polygons, color_column, compact


def of_openmesh(mesh: Any) -> Polygons:
    """A `TriMesh` or `PolyMesh` of openmesh with its normals, colors and texture coordinates."""
    try:
        table = np.asarray(mesh.fv_indices(), np.int64)
    except RuntimeError as error:  # deleted elements leave gaps
        raise MeshError(f"{str(error).rstrip('.')}: mesh.garbage_collection()") from error
    if not table.size:
        table = np.empty((0, 3), np.int64)
    used, columns = table >= 0, list[Column]()
    if mesh.has_vertex_normals():
        columns.append(Column("normal", np.array(mesh.vertex_normals()), semantic="normal"))
    if mesh.has_vertex_colors():
        columns.append(color_column(np.array(mesh.vertex_colors()), "vertex"))
    if mesh.has_face_colors():
        columns.append(color_column(np.array(mesh.face_colors()), "face"))
    if mesh.has_halfedge_texcoords2D():
        halfedges, ends = np.asarray(mesh.fh_indices())[used], np.asarray(mesh.halfedge_to_vertex_indices())
        if not np.array_equal(ends[halfedges], table[used]):
            raise MeshError("the halfedges of this mesh are not in the order of its faces")
        values = compact(np.array(mesh.halfedge_texcoords2D())[halfedges])
        columns.append(Column("texcoord", values, "corner", "texcoord"))
    elif mesh.has_vertex_texcoords2D():
        columns.append(Column("texcoord", compact(np.array(mesh.vertex_texcoords2D())), semantic="texcoord"))
    points = np.array(mesh.points(), np.float64).reshape(-1, 3)
    return Polygons(points, used.sum(axis=1), table[used], columns=tuple(columns))


def made_of(mesh: TriangleMesh) -> tuple[Any, tuple[str, ...]]:
    """An `openmesh.TriMesh`, with vertices split where corners differ, and the names of its losses."""
    openmesh = imported("openmesh", "such meshes are made with openmesh", "openmesh")
    mesh = split_by_attributes(mesh)
    made = openmesh.TriMesh(mesh.positions, mesh.faces)
    if made.n_faces() != len(mesh.faces):
        lost = len(mesh.faces) - made.n_faces()
        raise MeshError(
            f"openmesh cannot hold {lost} of {len(mesh.faces)} faces: more than two meet at an edge, or neighbors are "
            "turned against each other; write another format"
        )
    normal, color, texcoord = shown_at_vertices(mesh)
    of_faces = first(mesh, "color", (3, 4), "face")
    if normal is not None:
        made.request_vertex_normals()
        made.vertex_normals()[:] = normal.values
    if color is not None:
        made.request_vertex_colors()
        made.vertex_colors()[:] = rgba(color) / 255.0
    if of_faces is not None:
        made.request_face_colors()
        made.face_colors()[:] = rgba(of_faces) / 255.0
    if texcoord is not None:
        made.request_vertex_texcoords2D()
        made.vertex_texcoords2D()[:] = texcoord.values[:, :2]
    return made, left_out(mesh, (normal, color, texcoord, of_faces), mesh.metadata)
