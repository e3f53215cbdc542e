"""Vertices at one position made one, and vertices whose corners differ made several, as most files have them."""

import os
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from bsm._core import codec as _kernels
from bsm.codec.arrays import Faces, Indices, Mask, Order, Positions
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.mesh import TriangleMesh


def weld(positions: Positions, faces: Faces) -> tuple[Positions, Faces, Indices]:
    """Give the vertices of exactly equal positions one number."""
    # Exactly equal ones only: a tolerance would join vertices that an author has kept apart.
    index = group_rows(np.asarray(positions, np.float64))
    first = first_of(index)
    return (positions if len(first) == len(index) else positions[first]), index[faces], index


def degenerate(faces: npt.NDArray[Any]) -> Mask:
    """Which faces have fewer than three different corners, shape (m,)."""
    a, b, c = faces.T
    return np.asarray((a == b) | (b == c) | (a == c))


def group_rows(values: npt.NDArray[Any]) -> Indices:
    """The number, shape (n,), of what each row of `values`, shape (n, k), is equal to, in order of first appearance."""
    if values.dtype == np.float64:
        # Both zeros are one place, but their bits differ.
        values = values + 0.0  # -0.0 + 0.0 is 0.0
    rows = np.ascontiguousarray(values).view(np.int64)
    numbers = np.empty(len(rows), np.int32)
    places = np.empty(1 << (2 * len(rows)).bit_length(), np.int32)
    _kernels.equal_rows(rows, int.from_bytes(os.urandom(7), "little"), places, numbers)
    return numbers


def first_of(index: Indices) -> Order:
    """The first place of each number, shape (k,), in `index`, shape (n,), whose numbers appear in ascending order."""
    return np.flatnonzero(np.diff(np.maximum.accumulate(index), prepend=-1)).astype(np.int64)


def row_numbers(rows: npt.NDArray[Any]) -> Indices:
    """Equal rows of an array, shape (k, c), have equal numbers, from 0 without gaps; -0.0 equals 0.0; int32."""
    values = rows + 0 if rows.dtype.kind == "f" else rows
    if not len(values):
        return np.zeros(0, np.int32)
    # np.unique(axis=0) sorts rows as one opaque type, which takes several times as long.
    order = np.lexsort(values.T[::-1])
    ordered = values[order]
    numbers = np.empty(len(values), np.int32)
    numbers[order] = np.concatenate([[0], np.cumsum((ordered[1:] != ordered[:-1]).any(axis=1))])
    return numbers


def split_by_attributes(mesh: TriangleMesh) -> TriangleMesh:
    """Split vertices where their corners differ in an attribute, so that every attribute is of vertices or of faces."""
    return split_with_origin(mesh)[0]


def split_with_origin(mesh: TriangleMesh) -> tuple[TriangleMesh, Indices]:
    """Split vertices as `split_by_attributes`; return also which vertex each was."""
    of_corners = [attribute for attribute in mesh.attributes if attribute.indices is not None]
    size = len(mesh.positions)
    if not of_corners:
        return mesh, np.arange(size, dtype=np.int32)
    rows = [np.concatenate([mesh.faces.ravel(), np.arange(size, dtype=np.int32)])]
    for attribute in of_corners:
        assert attribute.indices is not None
        # By value and not by index: files often repeat equal values under several indices, and splitting there would
        # tear the surface.
        numbers = row_numbers(attribute.values)[attribute.indices.ravel()]
        rows.append(np.concatenate([numbers, np.full(size, -1, np.int32)]))
    is_loose = np.bincount(mesh.faces.ravel(), minlength=size) == 0
    # A vertex of no face stays one.
    kept = np.concatenate([np.ones(mesh.faces.size, np.bool_), is_loose])
    numbers = row_numbers(np.stack(rows, axis=1)[kept])
    corners = numbers[: mesh.faces.size]
    some = np.empty(numbers.max() + 1, np.int64)
    some[numbers[::-1]] = np.flatnonzero(kept)[::-1]
    vertices = rows[0][some]
    # A vertex of no face gets the value of some corner: it shows nowhere.
    some = np.minimum(some, mesh.faces.size - 1)

    def split(attribute: Attribute) -> Attribute:
        if attribute.indices is not None:
            values = attribute.values[attribute.indices.ravel()[some]]
            return replace(attribute, values=values, domain="vertex", indices=None)
        return (
            replace(attribute, values=attribute.values[vertices])
            if attribute.domain == "vertex"
            else attribute
        )

    attributes = tuple(map(split, mesh.attributes))
    faces = corners.reshape(-1, 3)
    return replace(
        mesh, positions=mesh.positions[vertices], faces=faces, attributes=attributes
    ), vertices
