"""Values of attributes on vertices to bytes and back, given the mesh: integers; exact."""

from collections.abc import Callable
from functools import partial
from typing import Literal, NamedTuple, get_args

import numpy as np
import numpy.typing as npt

from bsm.bitstream import _kernels
from bsm.bitstream.errors import MeshError, OptionError
from bsm.bitstream.fields import corners as shared

Ints = npt.NDArray[np.int32]
Longs = npt.NDArray[np.int64]


def octahedral_normals(levels: npt.ArrayLike, size: int) -> npt.NDArray[np.float64]:
    """The unit vectors, shape (n, 3), of levels, shape (n, 2): points on an octahedron (Meyer et al., EGSR 2010)."""
    points = _unfolded(np.asarray(levels, np.int64), size).astype(np.float64)
    unit: npt.NDArray[np.float64] = points / np.sqrt((points * points).sum(axis=1, keepdims=True))
    return unit


def canonical_levels(levels: npt.ArrayLike, size: int) -> Ints:
    """The pairs, shape (n, 2), that a decoder gives for the directions of `levels`, shape (n, 2)."""
    return _folded(_unfolded(np.asarray(levels, np.int64), size), size)


def _folded(points: Longs, size: int) -> Ints:
    flat = points[:, :2]
    outside = np.where(flat < 0, -1, 1) * (size - np.abs(flat[:, ::-1]))
    return (np.where(points[:, 2:] < 0, outside, flat) + size).astype(np.int32)


def _unfolded(levels: Longs, size: int) -> Longs:
    flat = levels - size
    height = size - np.abs(flat).sum(axis=1, keepdims=True)
    inside = np.where(flat < 0, -1, 1) * (size - np.abs(flat[:, ::-1]))
    return np.hstack([np.where(height < 0, inside, flat), height])


MOST_COMPONENTS = 4
COLUMNS = range(1, MOST_COMPONENTS + 1)

Kind = Literal["plain", "texcoord", "normal", "color"]
_BASES = 4
_VALENCES = 6


class _Values(NamedTuple):
    """State of values on vertices; the struct `Values` of `attributes.h`."""

    largest: Ints
    order: Ints
    twin: Ints
    geometry: Ints
    values: Ints
    gaps: Ints
    sums: Longs
    seen: Longs
    learners: Longs
    directions: Ints
    chart: Longs


def values_field(
    faces: npt.ArrayLike,
    vertices: int,
    largest: npt.ArrayLike,
    kind: Kind = "plain",
    geometry: npt.ArrayLike | None = None,
    places: npt.ArrayLike | None = None,
) -> shared.Field:
    """Values of vertices; `geometry`, shape (n, 3), foretells some kinds, and so do vertices of the same `places`."""
    top = shared.checked_largest(largest, COLUMNS)
    kernel, weights = _coder_of(kind, top)
    components = len(top)

    def start() -> shared.State:
        corners = shared.corners_of(faces, vertices)
        model = shared.make_model()
        given, gaps = np.zeros((2, vertices, components), np.int32)
        values = _Values(
            top,
            shared.traverse(corners),
            ring_of_twins(places, vertices),
            _checked_geometry(geometry, vertices),
            given,
            gaps,
            np.zeros((vertices, components + 1), np.int64),
            np.zeros((components, int(top.max()) // 64 + 1), np.int64),
            shared.make_learners(weights),
            np.zeros((vertices if kind == "normal" else 0, 12), np.int32),
            np.array([0, 16 * int(top[0])], np.int64),
        )
        if kind == "normal":
            _kernels.expect_normals(corners, values)
        return shared.State(
            lambda coder, *rows: kernel(coder, model, corners, values, *rows), values.order, values.values
        )

    canonical = partial(canonical_levels, size=int(top[0]) // 2) if kind == "normal" else None
    return shared.Field(np.zeros_like(top), top, start, canonical)


def ring_of_twins(places: npt.ArrayLike | None, vertices: int) -> Ints:
    """For each vertex the next one with the same number, in a ring; itself where there is no other."""
    if places is None:
        return np.arange(vertices, dtype=np.int32)
    given = np.asarray(places)
    if given.shape != (vertices,) or given.dtype.kind not in "iu":
        raise MeshError(f"places must be {vertices} integers, not {given.dtype} of {given.shape}")
    order = np.argsort(given, kind="stable")
    starts = np.flatnonzero(np.diff(given[order], prepend=-1 if vertices == 0 else given[order[0]] - 1))
    after = np.arange(1, vertices + 1)
    after[np.append(starts[1:], vertices)[: len(starts)] - 1] = starts
    twin = np.empty(vertices, np.int32)
    twin[order] = order[after] if vertices else order
    return twin


def _checked_geometry(geometry: npt.ArrayLike | None, vertices: int) -> Ints:
    if geometry is None:
        return np.zeros((0, 3), np.int32)
    given = np.asarray(geometry)
    if given.shape != (vertices, 3) or given.dtype.kind not in "iu":
        raise MeshError(f"the geometry must be integers of shape ({vertices}, 3), not {given.dtype} of {given.shape}")
    if given.size and not -(1 << 31) <= int(given.min()) <= int(given.max()) < 1 << 31:
        raise MeshError("the geometry must be of 32 bits; choose a larger step")
    return np.array(given, np.int32, order="C")


def _coder_of(kind: Kind, largest: Ints) -> tuple[Callable[..., int], Longs]:
    """The kernel of a kind, and the weights from which its learners start (A 4 to A 6)."""
    plain = kind in ("plain", "color")
    components = MOST_COMPONENTS if plain else 2
    if kind not in get_args(Kind) or (not plain and len(largest) != components):
        raise OptionError(f"{len(largest)} components are none of a {kind}")
    if kind == "normal" and (largest[0] != largest[1] or largest[0] < 2 or largest[0] % 2):
        raise OptionError(f"the largest levels of normals must be equal, even, and at least 2: {largest.tolist()}")
    guesses = components * _BASES * _VALENCES
    start = np.zeros((guesses + components * _BASES, shared.TERMS), np.int64)
    start[guesses:, :2] = 40000, 8192
    if plain:
        start[:guesses, :2] = 16384
        return _kernels.code_scalars, start
    if kind == "texcoord":
        start[:guesses, 0] = 8192
        return _kernels.code_texcoords, start
    return _kernels.code_normals, start


class _FaceValues(NamedTuple):
    """State of values on faces; the struct `FaceValues` of `attributes.h`."""

    largest: Ints
    values: Ints
    gaps: Ints
    memory: Ints


def face_values_field(faces: npt.ArrayLike, largest: npt.ArrayLike) -> shared.Field:
    """Values of faces, in the order of the faces: materials, groups, colours."""
    table, top = np.asarray(faces), shared.checked_largest(largest, COLUMNS)
    components = len(top)

    def start() -> shared.State:
        corners = shared.corners_of(table, int(table.max()) + 1 if table.size and table.dtype.kind in "iu" else 0)
        count = len(corners.faces)
        model = shared.make_model()
        given, gaps = np.zeros((2, count, components), np.int32)
        values = _FaceValues(top, given, gaps, np.zeros((components, 257), np.int32))
        order, code = np.arange(count, dtype=np.int32), _kernels.code_faces
        return shared.State(lambda coder, *rows: code(coder, model, corners, values, *rows), order, given)

    return shared.Field(np.zeros_like(top), top, start)
