"""Values of attributes on vertices to bytes and back, given the mesh: integers; exact."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal, NamedTuple, get_args

import numpy as np
import numpy.typing as npt

from bsm.bitstream import _kernels
from bsm.bitstream.attributes.octahedron import canonical_levels
from bsm.bitstream.attributes.ranges import MOST_COMPONENTS, checked_largest, checked_values
from bsm.bitstream.entropy.range_coder import Coder
from bsm.bitstream.errors import MeshError, OptionError
from bsm.bitstream.fields.chunks import Field, FieldDecoder, FieldEncoder
from bsm.bitstream.fields.corners import BYTES_PER_FACE, BYTES_PER_VERTEX, Corners, corners_of, traverse
from bsm.bitstream.fields.model import MODEL_BYTES, TERMS, ValueModel, make_learners, make_model
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits

Ints = npt.NDArray[np.int32]
Longs = npt.NDArray[np.int64]
Kind = Literal["plain", "texcoord", "normal", "color"]

_BASES = 4
_VALENCES = 6


class _Values(NamedTuple):
    """State of values on vertices; the struct `Values` of `values.h`."""

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


_Kernel = Callable[[Coder, ValueModel, Corners, _Values, int, int], int]


def values_charge(vertices: int, faces: int, components: int, kind: Kind) -> int:
    """Bytes of memory that coding values of vertices takes at most; its work is linear in `vertices` + `faces`."""
    per_vertex = BYTES_PER_VERTEX + 60 + 16 * components + (48 if kind == "normal" else 0)
    return per_vertex * vertices + BYTES_PER_FACE * faces + MODEL_BYTES + (components << 17) + (1 << 17)


def _field_of(
    faces: npt.ArrayLike,
    vertices: int,
    largest: npt.ArrayLike,
    kind: Kind,
    geometry: npt.ArrayLike | None,
    places: npt.ArrayLike | None,
) -> Field:
    """What encoder and decoder share."""
    top = checked_largest(largest)
    kernel, start = _coder_of(kind, top)
    corners = corners_of(faces, vertices)
    components = len(top)
    model = make_model()
    values = _Values(
        top,
        traverse(corners),
        ring_of_twins(places, vertices),
        _checked_geometry(geometry, vertices),
        np.zeros((vertices, components), np.int32),
        np.zeros((vertices, components), np.int32),
        np.zeros((vertices, components + 1), np.int64),
        np.zeros((components, int(top.max()) // 64 + 1), np.int64),
        make_learners(start),
        np.zeros((vertices if kind == "normal" else 0, 12), np.int32),
        np.array([0, 16 * int(top[0])], np.int64),
    )
    if kind == "normal":
        _kernels.expect_normals(corners, values)

    def code(coder: Coder, first: int, count: int) -> int:
        return kernel(coder, model, corners, values, first, count)

    return Field(code, values.order, values.values)


class ValueEncoder(FieldEncoder):
    """Codes values of vertices."""

    def __init__(
        self,
        faces: npt.ArrayLike,
        values: npt.ArrayLike,
        largest: npt.ArrayLike,
        kind: Kind = "plain",
        geometry: npt.ArrayLike | None = None,
        places: npt.ArrayLike | None = None,
    ) -> None:
        top = checked_largest(largest)
        given = checked_values(values, top)
        field = _field_of(faces, len(given), largest, kind, geometry, places)
        if kind == "normal" and (canonical_levels(given, int(top[0]) // 2) != given).any():
            raise MeshError("levels of normals must be those that octahedral_levels makes, one pair for each direction")
        field.values[:] = given
        super().__init__(field)


class ValueDecoder(FieldDecoder):
    """Twin of `ValueEncoder`."""

    def __init__(
        self,
        faces: npt.ArrayLike,
        vertices: int,
        largest: npt.ArrayLike,
        kind: Kind = "plain",
        geometry: npt.ArrayLike | None = None,
        places: npt.ArrayLike | None = None,
        limits: Limits = DEFAULT_LIMITS,
    ) -> None:
        components = len(checked_largest(largest))
        limits.check("field_bytes", values_charge(vertices, len(np.asarray(faces)), components, kind))
        super().__init__(_field_of(faces, vertices, largest, kind, geometry, places))


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


def _coder_of(kind: Kind, largest: Ints) -> tuple[_Kernel, Longs]:
    """The kernel of a kind, and the weights from which its learners start (A 4 to A 6)."""
    plain = kind in ("plain", "color")
    components = MOST_COMPONENTS if plain else 2
    if kind not in get_args(Kind) or (not plain and len(largest) != components):
        raise OptionError(f"{len(largest)} components are none of a {kind}")
    if kind == "normal" and (largest[0] != largest[1] or largest[0] < 2 or largest[0] % 2):
        raise OptionError(f"the largest levels of normals must be equal, even, and at least 2: {largest.tolist()}")
    guesses = components * _BASES * _VALENCES
    start = np.zeros((guesses + components * _BASES, TERMS), np.int64)
    start[guesses:, :2] = 40000, 8192
    if plain:
        start[:guesses, :2] = 16384
        return _kernels.code_scalars, start
    if kind == "texcoord":
        start[:guesses, 0] = 8192
        return _kernels.code_texcoords, start
    return _kernels.code_normals, start
