"""ORDER: the original order of a mesh, and the given vertices, loose ones included, that share a coded vertex."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from bsm.bitstream._kernels import constant
from bsm.bitstream.coefficients.matrices import write_column
from bsm.bitstream.connectivity.faces import EncodedConnectivity
from bsm.bitstream.connectivity.order import write_arrangement, write_rotations
from bsm.bitstream.container.wire import write_varint
from bsm.bitstream.entropy.range_coder import finish_writing
from bsm.bitstream.errors import OptionError

Ints = npt.NDArray[np.int32]

FIRST, COPY, LOOSE = 0, 1, 2  # a given vertex is the first at its place, at the place of one before it, or in no face


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
        if len(source) >= constant("MOST_GIVEN"):
            raise OptionError(f"{len(source)} vertices are too many for an order that is kept")
        kinds = np.full(len(source), COPY, np.int32)
        kinds[source < 0] = LOOSE
        used, first = np.unique(source[source >= 0], return_index=True)
        kinds[np.flatnonzero(source >= 0)[first]] = FIRST
        copies = source[kinds == COPY]
        copied = len(copies)
        if copied or len(loose):
            back = (np.cumsum(kinds == FIRST) - 1)[kinds == COPY] - copies
            coder = write_column(write_rotations(coder, kinds), back.astype(np.int32))
        if copied:
            visits, counts = _corners(source[splits.faces].ravel(), len(used), source)
            # Which of the given vertices at its place each is, in their order.
            order = np.argsort(source, kind="stable")
            ordered = source[order]
            ranks = np.empty(len(source), np.int32)
            ranks[order] = np.arange(len(source)) - np.searchsorted(ordered, ordered)
            ranks = ranks[splits.faces].ravel()
            coder = write_column(coder, ((ranks - visits) % counts).astype(np.int32))
    numbers = write_varint(copied) + write_varint(len(loose))
    return numbers + np.ascontiguousarray(loose, "<f8").tobytes() + finish_writing(coder)


def _corners(vertices: Ints, count: int, source: Ints) -> tuple[Ints, Ints]:
    """For each corner at a vertex: the corners before it there, and the given vertices there."""
    order = np.argsort(vertices, kind="stable")
    ordered = vertices[order]
    starts = np.searchsorted(ordered, np.arange(count + 1))
    visits = np.empty(len(vertices), np.int64)
    visits[order] = np.arange(len(vertices)) - starts[ordered]
    at = np.bincount(source[source >= 0], minlength=count)[vertices]
    return (visits % at).astype(np.int32), at.astype(np.int32)
