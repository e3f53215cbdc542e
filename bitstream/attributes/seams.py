"""Seams: edges across which an attribute of corners changes; the corners of a vertex between them share a value."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from bsm.bitstream import _kernels
from bsm.bitstream._kernels import constant
from bsm.bitstream.entropy.range_coder import bank_of, finish_writing, start_writing
from bsm.bitstream.fields.corners import Corners
from bsm.bitstream.once import cached_property

Ints = npt.NDArray[np.int32]
Flags = npt.NDArray[np.uint8]

SEAM, OPEN = constant("SEAM"), constant("OPEN")


@dataclass(frozen=True, eq=False)
class Joins:
    corners: Corners
    seams: Flags

    @cached_property
    def _joined(self) -> tuple[Ints, Ints]:
        return _join(self.corners, self.seams)

    @cached_property
    def count(self) -> int:
        """How many values there are; what tells it is not kept, since there may be many such objects."""
        return len(_join(self.corners, self.seams)[1])

    @property
    def faces(self) -> Ints:
        """Number of the value of each corner, shape (m, 3); values are numbered by their first corners."""
        return self._joined[0]

    @property
    def first(self) -> Ints:
        """First corner of each value, shape (k,), ascending."""
        return self._joined[1]

    @property
    def vertices(self) -> Ints:
        return self.corners.faces.ravel()[self.first]


def _join(corners: Corners, seams: Flags) -> tuple[Ints, Ints]:
    joined, first = (np.empty(len(seams), np.int32) for _ in range(2))
    count = _kernels.join_corners(corners, seams, joined, first)
    return joined.reshape(-1, 3), first[:count].copy()


def find_seams(corners: Corners, values: npt.ArrayLike) -> Flags:
    """The seams of `values`, integers, shape (m, 3): where they differ on the two sides of an edge, at either end."""
    given, size = np.asarray(values).ravel(), len(corners.opposite)
    vertex, beyond = corners.faces.ravel(), corners.opposite
    here = np.flatnonzero(beyond >= 0)
    there = beyond[here]
    a, b, c, d = _next(here), _previous(here), _next(there), _previous(there)
    turned = vertex[a] != vertex[d]
    differ = (given[a] != given[np.where(turned, c, d)]) | (given[b] != given[np.where(turned, d, c)])
    seams = np.full(size, OPEN, np.uint8)
    seams[here] = differ
    return seams


def encode_seams(corners: Corners, seams: Flags, earlier: tuple[Flags, ...] = ()) -> bytes:
    coder = start_writing(len(seams) + 64)
    ends = np.empty((len(corners.rank), 3), np.int32)
    _kernels.code_edges(coder, bank_of("code_edges"), corners, seams.copy(), _others(earlier, len(seams)), ends)
    return finish_writing(coder)


def _others(earlier: tuple[Flags, ...], size: int) -> Flags:
    """Seams of the last two attributes at each edge, 3 times the last: 0 unknown, 1 no seam, 2 seam."""
    others = np.zeros(size, np.uint8)
    for factor, seams in zip((3, 1), earlier[::-1], strict=False):
        others += (factor * (1 + (seams == SEAM))).astype(np.uint8)
    return others


def _next(corners: npt.NDArray[np.integer]) -> npt.NDArray[np.integer]:
    return np.where(corners % 3 == 2, corners - 2, corners + 1)


def _previous(corners: npt.NDArray[np.integer]) -> npt.NDArray[np.integer]:
    return np.where(corners % 3 == 0, corners + 2, corners - 1)
