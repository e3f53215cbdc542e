"""Which vertices of a given mesh are one vertex of what was coded, and which are in no face: an order, method 2.

The order of method 1 (`bitstream.connectivity.order`) gives the faces as they were, of vertices made one, numbered as
the first of each was met. What is said here makes them the given vertices again.
"""

from __future__ import annotations

import zlib
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from bsm.bitstream.container.wire import Cursor, write_varint
from bsm.bitstream.errors import CorruptError
from bsm.bitstream.limits import Limits

Ints = npt.NDArray[np.int32]

FIRST, COPY, LOOSE = 0, 1, 2
"""A given vertex is the first at its place, at the place of one before it, or in no face."""


@dataclass(frozen=True, eq=False)
class Splits:
    """The given vertices.

    Parameters
    ----------
    source : int32 array, shape (n,)
        The vertex that each given one is, numbered as the first of each is met; -1 where no face uses it.
    faces : int32 array, shape (m, 3)
        Of given vertices.
    loose : float64 array, shape (k, 3)
        Positions of those that no face uses, in their order.
    """

    source: Ints
    faces: Ints
    loose: npt.NDArray[np.float64]


def encode_splits(splits: Splits) -> bytes:
    """Varints of n, of the copies, and of k; then the kinds of vertices, what the copies are copies of, which of the
    vertices at its place each corner names (if there are copies), each a varint length and zlib; then the positions of
    loose vertices, as doubles, least byte first.
    """
    source = splits.source
    kinds = np.full(len(source), COPY, np.uint8)
    kinds[source < 0] = LOOSE
    used, first = np.unique(source[source >= 0], return_index=True)
    kinds[np.flatnonzero(source >= 0)[first]] = FIRST
    copies = source[kinds == COPY]
    back = (np.cumsum(kinds == FIRST) - 1)[kinds == COPY] - copies
    parts = [kinds.tobytes(), _planes(back)]
    if len(copies):
        visits, counts, _ = _corners(source[splits.faces].ravel(), len(used), source)
        ranks = _ranks(source)[splits.faces].ravel()
        parts.append(_planes((ranks - visits) % counts))
    packed = [zlib.compress(part, 9) for part in parts]
    numbers = b"".join(map(write_varint, (len(source), len(copies), len(splits.loose))))
    pieces = b"".join(write_varint(len(part)) + part for part in packed)
    return numbers + pieces + np.ascontiguousarray(splits.loose, "<f8").tobytes()


def decode_splits(data: bytes, faces: Ints, vertices: int, limits: Limits) -> Splits:
    """Twin of `encode_splits`, for `faces`, shape (m, 3), of `vertices` vertices in the order of method 1.

    Raises
    ------
    CorruptError, LimitError, TruncatedError
    """
    cursor = Cursor(data)
    size, copies, loose = cursor.varint(), cursor.varint(), cursor.varint()
    limits.check("vertices", size)
    if size != vertices + copies + loose or vertices + copies > 3 * len(faces) or 24 * loose > len(data):
        raise CorruptError(f"{size} given vertices cannot be {vertices}, {copies} copies and {loose} in no face")
    kinds = np.frombuffer(_unpack(cursor, size), np.uint8)
    if (np.bincount(kinds, minlength=3) != (vertices, copies, loose)).any():
        raise CorruptError("the kinds of given vertices are not as many as was said")
    source = np.full(size, -1, np.int64)
    source[kinds == FIRST] = np.arange(vertices)
    source[kinds == COPY] = (np.cumsum(kinds == FIRST) - 1)[kinds == COPY] - _values(_unpack(cursor, 4 * copies))
    known = (np.cumsum(kinds == FIRST))[kinds == COPY]
    if (source[kinds == COPY] < 0).any() or (source[kinds == COPY] >= known).any():
        raise CorruptError("a given vertex is a copy of one that does not come before it")
    given = np.ascontiguousarray(source, np.int32)
    order = np.argsort(np.where(given < 0, vertices, given), kind="stable")
    if copies:
        visits, counts, starts = _corners(faces.ravel(), vertices, given)
        steps = _values(_unpack(cursor, 12 * len(faces)))
        if (steps < 0).any() or (steps >= counts).any():
            raise CorruptError("a corner names a copy that there is not")
        corners = order[starts + (steps + visits) % counts]
    else:
        corners = order[faces.ravel()]
    rest = cursor.rest()
    if len(rest) != 24 * loose:
        raise CorruptError(f"{len(rest)} bytes for the positions of {loose} vertices")
    positions = np.frombuffer(rest, "<f8").reshape(loose, 3).astype(np.float64)
    if not np.isfinite(positions).all():
        raise CorruptError("a vertex that no face uses has a coordinate that is not finite")
    return Splits(given, corners.reshape(-1, 3).astype(np.int32), positions)


def _corners(vertices: Ints, count: int, source: Ints) -> tuple[Ints, Ints, Ints]:
    """For each corner at a vertex: corners before it there, given vertices there, and where these begin in order."""
    order = np.argsort(vertices, kind="stable")
    ordered = vertices[order]
    starts = np.searchsorted(ordered, np.arange(count + 1))
    visits = np.empty(len(vertices), np.int64)
    visits[order] = np.arange(len(vertices)) - starts[ordered]
    counts = np.bincount(source[source >= 0], minlength=count)
    begins = np.cumsum(counts) - counts
    at = counts[vertices]
    return (visits % at).astype(np.int32), at.astype(np.int32), begins[vertices].astype(np.int32)


def _ranks(source: Ints) -> Ints:
    """Which of the given vertices at its place each is, in their order."""
    order = np.argsort(source, kind="stable")
    ordered = source[order]
    ranks = np.empty(len(source), np.int32)
    ranks[order] = np.arange(len(source)) - np.searchsorted(ordered, ordered)
    return ranks


def _planes(values: npt.NDArray[np.integer]) -> bytes:
    """Four bytes of each value, all the least first: zlib finds more in them."""
    return np.ascontiguousarray(values.astype("<u4").view(np.uint8).reshape(-1, 4).T).tobytes()


def _values(data: bytes) -> npt.NDArray[np.int64]:
    planes = np.frombuffer(data, np.uint8).reshape(4, -1)
    return np.ascontiguousarray(planes.T).view("<u4").ravel().astype(np.int64)


def _unpack(cursor: Cursor, size: int) -> bytes:
    """A piece; never allocates for more than `size` bytes."""
    decompressor = zlib.decompressobj()
    try:
        content = decompressor.decompress(cursor.take(cursor.varint()), size + 1)
    except zlib.error as error:
        raise CorruptError(f"a piece of the order is damaged: {error}") from error
    if len(content) != size or not decompressor.eof or decompressor.unused_data:
        raise CorruptError(f"a piece of the order does not hold exactly {size} bytes")
    return content
