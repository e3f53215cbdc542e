"""A mesh whose corners differ, as one whose vertices do: what most files and libraries ask for."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from bsm.codec.arrays import Indices
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.mesh import TriangleMesh


def row_numbers(rows: npt.NDArray[Any]) -> Indices:
    """Equal rows of an array, shape (k, c), have equal numbers, from 0 without gaps; -0.0 equals 0.0; int32."""
    values = rows + 0 if rows.dtype.kind == "f" else rows
    if not len(values):
        return np.zeros(0, np.int32)
    order = np.lexsort(values.T[::-1])
    ordered = values[order]
    numbers = np.empty(len(values), np.int32)
    numbers[order] = np.concatenate([[0], np.cumsum((ordered[1:] != ordered[:-1]).any(axis=1))])
    return numbers


def split_by_attributes(mesh: TriangleMesh) -> TriangleMesh:
    """Split vertices where their corners differ in an attribute, so that every attribute is of vertices or of faces."""
    of_corners = [attribute for attribute in mesh.attributes if attribute.indices is not None]
    if not of_corners:
        return mesh
    size = len(mesh.positions)
    rows = [np.concatenate([mesh.faces.ravel(), np.arange(size, dtype=np.int32)])]
    for attribute in of_corners:
        assert attribute.indices is not None
        numbers = row_numbers(attribute.values)[attribute.indices.ravel()]
        rows.append(np.concatenate([numbers, np.full(size, -1, np.int32)]))
    used = np.zeros(size, np.bool_)
    used[mesh.faces] = True
    kept = np.concatenate([np.ones(mesh.faces.size, np.bool_), ~used])  # a vertex of no face stays one
    numbers = row_numbers(np.stack(rows, axis=1)[kept])
    corners = numbers[: mesh.faces.size]
    some = np.empty(numbers.max() + 1, np.int64)
    some[numbers[::-1]] = np.flatnonzero(kept)[::-1]
    vertices = rows[0][some]
    some = np.minimum(some, mesh.faces.size - 1)  # a vertex of no face gets the value of some corner: it shows nowhere

    def split(attribute: Attribute) -> Attribute:
        if attribute.indices is not None:
            values = attribute.values[attribute.indices.ravel()[some]]
            return replace(attribute, values=values, domain="vertex", indices=None)
        return replace(attribute, values=attribute.values[vertices]) if attribute.domain == "vertex" else attribute

    return replace(
        mesh,
        positions=mesh.positions[vertices],
        faces=corners.reshape(-1, 3),
        attributes=tuple(map(split, mesh.attributes)),
    )
