"""Values of attributes to bytes and back, given the mesh: integers on vertices or on faces; exact."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal, NamedTuple, get_args

import numpy as np
import numpy.typing as npt

from bitstream import _kernels
from bitstream.entropy.range_coder import Coder
from bitstream.errors import MeshError, OptionError
from bitstream.fields.chunks import Progress
from bitstream.fields.corners import BYTES_PER_FACE, BYTES_PER_VERTEX, Corners, corners_of, traverse
from bitstream.fields.model import MODEL_BYTES, TERMS, ValueModel, make_learners, make_model
from bitstream.limits import DEFAULT_LIMITS, Limits

Ints = npt.NDArray[np.int32]
Longs = npt.NDArray[np.int64]
Kind = Literal["plain", "texcoord", "normal", "color"]

MOST_COMPONENTS = 4
MOST_LARGEST = (1 << 20) - 1
"""Values are 0 to at most this."""

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


class _FaceValues(NamedTuple):
    """State of values on faces; the struct `FaceValues` of `faces.h`."""

    largest: Ints
    values: Ints
    gaps: Ints
    memory: Ints


_Kernel = Callable[[Coder, ValueModel, Corners, _Values, int, int], int]


def values_charge(vertices: int, faces: int, components: int, kind: Kind) -> int:
    """Bytes of memory that coding values of vertices takes at most; its work is linear in `vertices` + `faces`."""
    per_vertex = BYTES_PER_VERTEX + 60 + 16 * components + (48 if kind == "normal" else 0)
    return per_vertex * vertices + BYTES_PER_FACE * faces + MODEL_BYTES + (components << 17) + (1 << 17)


def face_values_charge(faces: int, components: int) -> int:
    """The same for values of faces."""
    return (3 * BYTES_PER_VERTEX + BYTES_PER_FACE + 8 * components) * faces + MODEL_BYTES + (1 << 17)


class _ValueCoder:
    """What encoder and decoder share."""

    def __init__(
        self,
        faces: npt.ArrayLike,
        vertices: int,
        largest: npt.ArrayLike,
        kind: Kind,
        geometry: npt.ArrayLike | None,
        places: npt.ArrayLike | None,
    ) -> None:
        top = checked_largest(largest)
        kernel, start = _coder_of(kind, top)
        corners = corners_of(faces, vertices)
        components = len(top)
        self._values = _Values(
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
            _kernels.expect_normals(corners, self._values)
        model = make_model()

        def code(coder: Coder, first: int, count: int) -> int:
            return kernel(coder, model, corners, self._values, first, count)

        self._progress = Progress(code, vertices)

    @property
    def order(self) -> Ints:
        """Vertices in the order in which they are coded; it follows from the faces."""
        return self._values.order

    @property
    def coded(self) -> int:
        """How many of them are coded."""
        return self._progress.next


class ValueEncoder(_ValueCoder):
    """Codes values of vertices.

    Parameters
    ----------
    faces : integers, shape (m, 3)
        Any triangles; where values differ between corners of a vertex, of the mesh cut open there.
    values : integers, shape (n, c), 1 <= c <= 4
        From 0 to `largest`; for normals, levels as `octahedral_levels` makes them.
    largest : integers, shape (c,)
        At most `MOST_LARGEST`. For normals, both twice the size of the octahedron.
    kind : {"plain", "texcoord", "normal", "color"}
        How they are predicted. Texture coordinates and normals have c = 2; colours are coded as plain numbers are.
    geometry : integers of 32 bits, shape (n, 3), optional
        Where the vertices are, as the decoder knows it: in steps well below the mean edge, for normals the finer the
        better.
    places : integers, shape (n,), optional
        Equal numbers for vertices at the same place, which the cuts have parted.

    Raises
    ------
    MeshError
        If faces, values, geometry or places are out of range or of another shape.
    OptionError
        If `largest` or `kind` is.
    """

    def __init__(
        self,
        faces: npt.ArrayLike,
        values: npt.ArrayLike,
        largest: npt.ArrayLike,
        kind: Kind = "plain",
        geometry: npt.ArrayLike | None = None,
        places: npt.ArrayLike | None = None,
    ) -> None:
        given = checked_values(values, checked_largest(largest))
        super().__init__(faces, len(given), largest, kind, geometry, places)
        if kind == "normal" and (canonical_levels(given, int(self._values.largest[0]) // 2) != given).any():
            raise MeshError("levels of normals must be those that octahedral_levels makes, one pair for each direction")
        self._values.values[:] = given

    def chunk(self, count: int) -> bytes:
        """Code the next `count` vertices of `order`; raises `OptionError` if there are fewer."""
        return self._progress.write(count)


class ValueDecoder(_ValueCoder):
    """Twin of `ValueEncoder`.

    Parameters
    ----------
    faces : integers, shape (m, 3)
    vertices : int
        Their number n.
    largest, kind, geometry, places
        As for `ValueEncoder`.
    limits : Limits
        `field_bytes` bounds `values_charge`.

    Raises
    ------
    MeshError, OptionError
        As `ValueEncoder`.
    LimitError
        Before anything is allocated.
    """

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
        super().__init__(faces, vertices, largest, kind, geometry, places)

    def chunk(self, payload: bytes, count: int) -> tuple[Ints, Ints]:
        """Decode the next `count` vertices of `order`.

        Returns
        -------
        vertices : int32 array, shape (count,)
        values : int32 array, shape (count, c)
            Of these.

        Raises
        ------
        OptionError
            If there are fewer; after an error below there is none.
        CorruptError, TruncatedError
            If `payload` is not of so many vertices.
        """
        numbers = self._progress.read(payload, count)
        vertices = self._values.order[numbers.start : numbers.stop].copy()
        return vertices, self._values.values[vertices]


class _FaceValueCoder:
    """What encoder and decoder share."""

    def __init__(self, faces: npt.ArrayLike, largest: npt.ArrayLike) -> None:
        top = checked_largest(largest)
        given = np.asarray(faces)
        corners = corners_of(given, int(given.max()) + 1 if given.size and given.dtype.kind in "iu" else 0)
        count, components = len(corners.faces), len(top)
        self._values = _FaceValues(
            top,
            np.zeros((count, components), np.int32),
            np.zeros((count, components), np.int32),
            np.zeros((components, 257), np.int32),
        )
        model = make_model()

        def code(coder: Coder, first: int, count: int) -> int:
            return _kernels.code_faces(coder, model, corners, self._values, first, count)

        self._progress = Progress(code, count)

    @property
    def coded(self) -> int:
        """How many faces are coded."""
        return self._progress.next


class FaceValueEncoder(_FaceValueCoder):
    """Codes values of faces, in the order of the faces: materials, groups, colours.

    Parameters
    ----------
    faces : integers, shape (m, 3)
        Any triangles.
    values : integers, shape (m, c), 1 <= c <= 4
        From 0 to `largest`.
    largest : integers, shape (c,)
        At most `MOST_LARGEST`.

    Raises
    ------
    MeshError
        If faces or values are out of range or of another shape.
    OptionError
        If `largest` is.
    """

    def __init__(self, faces: npt.ArrayLike, values: npt.ArrayLike, largest: npt.ArrayLike) -> None:
        given = checked_values(values, checked_largest(largest))
        super().__init__(faces, largest)
        if len(given) != len(self._values.values):
            raise MeshError(f"{len(given)} values for {len(self._values.values)} faces")
        self._values.values[:] = given

    def chunk(self, count: int) -> bytes:
        """Code the next `count` faces; raises `OptionError` if there are fewer."""
        return self._progress.write(count)


class FaceValueDecoder(_FaceValueCoder):
    """Twin of `FaceValueEncoder`.

    Parameters
    ----------
    faces, largest
        As for `FaceValueEncoder`.
    limits : Limits
        `field_bytes` bounds `face_values_charge`.

    Raises
    ------
    MeshError, OptionError
        As `FaceValueEncoder`.
    LimitError
        Before anything is allocated.
    """

    def __init__(self, faces: npt.ArrayLike, largest: npt.ArrayLike, limits: Limits = DEFAULT_LIMITS) -> None:
        limits.check("field_bytes", face_values_charge(len(np.asarray(faces)), len(checked_largest(largest))))
        super().__init__(faces, largest)

    def chunk(self, payload: bytes, count: int) -> Ints:
        """Decode the next `count` faces: int32 array, shape (count, c).

        Raises
        ------
        OptionError
            If there are fewer; after an error below there is none.
        CorruptError, TruncatedError
            If `payload` is not of so many faces.
        """
        numbers = self._progress.read(payload, count)
        return self._values.values[numbers.start : numbers.stop].copy()


def octahedral_levels(normals: npt.ArrayLike, size: int) -> Ints:
    """Directions as pairs of integers: points on an octahedron, its lower half folded outwards.

    Parameters
    ----------
    normals : array_like, shape (n, 3)
        Of any length but 0.
    size : int
        From the middle of the octahedron to its tips, K; levels are 0 to 2 K. N bits are K = 2^(N - 1) - 1.

    Returns
    -------
    int32 array, shape (n, 2)
        Of points whose absolute coordinates add up to K, shifted by K; each direction has one pair only. Within
        1 / K or so of the direction.

    Raises
    ------
    MeshError
        If a normal has no direction.
    OptionError
        If `size` is out of range.

    References
    ----------
    Q. Meyer et al., "On floating-point normal vectors", EGSR 2010.
    """
    if not 1 <= size <= MOST_LARGEST // 2:
        raise OptionError(f"the size of an octahedron must be from 1 to {MOST_LARGEST // 2}, not {size}")
    given = np.asarray(normals, np.float64)
    if given.ndim != 2 or given.shape[1] != 3:
        raise MeshError(f"normals must have shape (n, 3), not {given.shape}")
    largest = np.abs(given).max(axis=1, keepdims=True)
    if not (np.isfinite(largest).all() and (largest > 0).all()):
        raise MeshError("a normal without a direction has no place on an octahedron")
    scaled = given / largest
    scaled *= size / np.abs(scaled).sum(axis=1, keepdims=True)
    points = np.rint(scaled).astype(np.int64)
    rows = np.arange(len(points))
    for _ in range(3):  # what rounding has added or taken, where that changes least
        missing = size - np.abs(points).sum(axis=1)
        change = np.sign(missing)
        slack = (np.abs(scaled) - np.abs(points)) * change[:, None]
        slack[(points == 0) & (change < 0)[:, None]] = -2
        axis = slack.argmax(axis=1)
        points[rows, axis] += np.where(scaled[rows, axis] < 0, -change, change)
    return _folded(points, size)


def octahedral_normals(levels: npt.ArrayLike, size: int) -> npt.NDArray[np.float64]:
    """The unit vectors of levels: twin of `octahedral_levels`."""
    points = _unfolded(np.asarray(levels, np.int64), size).astype(np.float64)
    unit: npt.NDArray[np.float64] = points / np.sqrt((points * points).sum(axis=1, keepdims=True))
    return unit


def canonical_levels(levels: npt.ArrayLike, size: int) -> Ints:
    """The pairs that a decoder gives for the directions of these: a point on a folded edge has several."""
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


def checked_largest(largest: npt.ArrayLike) -> Ints:
    """`largest` as int32; raises `OptionError`."""
    top = np.array(largest, np.int64)
    if top.ndim != 1 or not 1 <= len(top) <= MOST_COMPONENTS or top.min() < 0 or top.max() > MOST_LARGEST:
        raise OptionError(
            f"{top.tolist()}: the largest values must be 1 to {MOST_COMPONENTS}, from 0 to {MOST_LARGEST}"
        )
    return top.astype(np.int32)


def checked_values(values: npt.ArrayLike, largest: Ints) -> npt.NDArray[np.integer]:
    """`values` as an array; raises `MeshError`."""
    given = np.asarray(values)
    if given.ndim != 2 or given.shape[1] != len(largest) or given.dtype.kind not in "iu":
        raise MeshError(f"values must be integers of shape (n, {len(largest)}), not {given.dtype} of {given.shape}")
    if ((given < 0) | (given > largest)).any():
        raise MeshError(f"values are outside their range, 0 to {largest}")
    return given


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
