"""What meshes of other libraries have beside points and faces."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from bsm.codec.geometry.attributes import Domain, Semantic
from bsm.codec.geometry.mesh import Metadata
from bsm.files.formats.columns import Array, Column, color_column, compact, named_column


def columns_of(mesh: Any, surfaces: tuple[str, ...]) -> list[Column]:
    """The values of vertices, corners and polygons; `surfaces` are the kinds of meshio's cells that are polygons."""
    if hasattr(mesh, "cells_dict") and hasattr(mesh, "cell_data_dict"):
        return [*_of_points(mesh.point_data, ""), *_of_meshio_cells(mesh.cell_data_dict, surfaces)]
    if hasattr(mesh, "point_data") and hasattr(mesh, "cell_data") and hasattr(mesh, "n_lines"):
        first, last = mesh.n_verts + mesh.n_lines, mesh.n_cells - mesh.n_strips  # cells are points and lines, too
        cells = {name: values[first:last] for name, values in mesh.cell_data.items()}
        names = (mesh.point_data.active_normals_name, mesh.point_data.active_texture_coordinates_name)
        return [*_of_points(mesh.point_data, *names), *_columns(cells, "face")]
    if hasattr(mesh, "triangle_uvs") and hasattr(mesh, "vertex_colors"):
        return list(_of_open3d(mesh))
    return []


def metadata_of(mesh: Any) -> Metadata:
    """The field data of pyvista: one text, one number, or bytes each."""
    found: dict[str, str | int | float | bytes] = {}
    for name, given in getattr(mesh, "field_data", {}).items() if hasattr(mesh, "n_lines") else ():
        values = np.asarray(given)
        if values.dtype == np.uint8:
            found[name] = values.tobytes()
        elif values.size == 1 and isinstance(value := values.reshape(-1)[0].item(), str | int | float):
            found[name] = value
    return found


def _of_points(data: Mapping[str, Any], normals: str | None, texcoords: str | None = None) -> Iterator[Column]:
    active: dict[str | None, Semantic] = {normals: "normal", texcoords: "texcoord"}
    for column in _columns(data, "vertex"):
        yield Column(column.name, column.values, "vertex", active.get(column.name, column.semantic))


def _columns(data: Mapping[str, Any], domain: Domain) -> Iterator[Column]:
    """Arrays by name, those of more than four columns left aside."""
    for name, given in data.items():
        values = np.array(given)
        values = values[:, None] if values.ndim == 1 else values
        if values.ndim != 2 or values.dtype.kind not in "biuf":
            continue
        yield named_column(name, values, domain)


def _of_meshio_cells(data: Mapping[str, Mapping[str, Any]], surfaces: tuple[str, ...]) -> Iterator[Column]:
    for name, by_kind in data.items():
        tables = [np.asarray(by_kind[kind]) for kind in surfaces if kind in by_kind]
        if tables and all(table.shape[1:] == tables[0].shape[1:] for table in tables):
            yield from _columns({name: np.concatenate(tables)}, "face")


def _of_open3d(mesh: Any) -> Iterator[Column]:
    normals, colors, uvs = (_table(mesh, name) for name in ("vertex_normals", "vertex_colors", "triangle_uvs"))
    materials = _table(mesh, "triangle_material_ids")
    if normals is not None:
        yield Column("normal", compact(normals), semantic="normal")
    if colors is not None:
        yield color_column(colors, "vertex")
    if uvs is not None:
        yield Column("texcoord", compact(uvs), "corner", "texcoord")
    if materials is not None:
        yield Column("material", materials.reshape(-1, 1), "face")


def _table(mesh: Any, name: str) -> Array | None:
    values = np.asarray(getattr(mesh, name))
    return values if values.size else None
