"""ORDER: the order that a mesh had, and which given vertices, loose ones included, are one of what was coded."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from bsm.bitstream.coefficients.matrices import code_column
from bsm.bitstream.connectivity.faces import EncodedConnectivity
from bsm.bitstream.connectivity.order import Arrangement, code_rotations, read_arrangement, write_arrangement
from bsm.bitstream.container.wire import Cursor, write_varint
from bsm.bitstream.entropy.range_coder import finish_reading, finish_writing, start_reading
from bsm.bitstream.errors import CorruptError, OptionError
from bsm.bitstream.limits import Limits

Ints = npt.NDArray[np.int32]

FIRST, COPY, LOOSE = 0, 1, 2  # a given vertex is the first at its place, at the place of one before it, or in no face
MOST_GIVEN = 1 << 24  # given vertices, so that every number of one can be coded


@dataclass(frozen=True, eq=False)
class Splits:
    """The given vertices."""

    source: Ints
    faces: Ints
    loose: npt.NDArray[np.float64]


def encode_order(faces: npt.ArrayLike, encoded: EncodedConnectivity, splits: Splits | None = None) -> bytes:
    """Encode the order of `faces`, shape (m, 3), whose connectivity was encoded as `encoded`, and given vertices."""
    coder = write_arrangement(faces, encoded)
    copied, loose = 0, np.zeros((0, 3))
    if splits is not None:
        source, loose = splits.source, splits.loose
        if len(source) >= MOST_GIVEN:
            raise OptionError(f"{len(source)} vertices are too many for an order that is kept")
        kinds = np.full(len(source), COPY, np.int32)
        kinds[source < 0] = LOOSE
        used, first = np.unique(source[source >= 0], return_index=True)
        kinds[np.flatnonzero(source >= 0)[first]] = FIRST
        copies = source[kinds == COPY]
        copied = len(copies)
        if copied or len(loose):
            back = (np.cumsum(kinds == FIRST) - 1)[kinds == COPY] - copies
            coder = code_column(code_rotations(coder, kinds), back.astype(np.int32))
        if copied:
            visits, counts, _ = _corners(source[splits.faces].ravel(), len(used), source)
            # Which of the given vertices at its place each is, in their order.
            order = np.argsort(source, kind="stable")
            ordered = source[order]
            ranks = np.empty(len(source), np.int32)
            ranks[order] = np.arange(len(source)) - np.searchsorted(ordered, ordered)
            ranks = ranks[splits.faces].ravel()
            coder = code_column(coder, ((ranks - visits) % counts).astype(np.int32))
    numbers = write_varint(copied) + write_varint(len(loose))
    return numbers + np.ascontiguousarray(loose, "<f8").tobytes() + finish_writing(coder)


def decode_order(data: bytes, faces: Ints, vertices: int, limits: Limits) -> tuple[Arrangement, Splits | None]:
    """Twin of `encode_order`, for decoded `faces`, shape (m, 3), of `vertices` vertices; no splits if there are none"""
    cursor = Cursor(data)
    copies, count = cursor.varint(), cursor.varint()
    limits.check("vertices", vertices + copies + count)
    if vertices + copies > 3 * len(faces) or vertices + copies + count >= MOST_GIVEN:
        raise CorruptError(f"{copies} copies of {vertices} vertices, and {count} in no face")
    loose = np.frombuffer(cursor.take(24 * count), "<f8").reshape(count, 3).astype(np.float64)
    if not np.isfinite(loose).all():
        raise CorruptError("a vertex that no face uses has a coordinate that is not finite")
    coder = start_reading(cursor.rest())
    arrangement = read_arrangement(coder, faces, vertices)
    splits = None
    if copies or count:
        kinds, back = np.zeros(vertices + copies + count, np.int32), np.zeros(copies, np.int32)
        code_rotations(coder, kinds)
        code_column(coder, back)
        # The vertex that each given one is, numbered as they are met; -1 for loose ones.
        if (np.bincount(kinds, minlength=3)[[FIRST, COPY]] != (vertices, len(back))).any():
            raise CorruptError("the kinds of given vertices are not as many as announced")
        source = np.full(len(kinds), -1, np.int32)
        source[kinds == FIRST] = np.arange(vertices)
        known = np.cumsum(kinds == FIRST)[kinds == COPY]
        source[kinds == COPY] = known - 1 - back
        if ((source[kinds == COPY] < 0) | (back < 0)).any():
            raise CorruptError("a given vertex is a copy of one that does not come before it")
        steps = np.zeros(3 * len(faces), np.int32)
        if copies:
            code_column(coder, steps)
        # The given vertex of each corner, shape (m, 3).
        order = np.argsort(np.where(source < 0, vertices, source), kind="stable")
        visits, counts, starts = _corners(arrangement.faces.ravel(), vertices, source)
        if ((steps < 0) | (steps >= counts)).any():
            raise CorruptError("a corner names a copy that there is not")
        splits = Splits(source, order[starts + (steps + visits) % counts].reshape(-1, 3).astype(np.int32), loose)
    finish_reading(coder)
    return arrangement, splits


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
