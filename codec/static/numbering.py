"""How the user of a mesh numbers what was coded."""

from dataclasses import dataclass, field

import numpy as np

from bsm.bitstream.connectivity.order import Arrangement
from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Faces, Indices, Order, Positions
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.static.events import Changes, ConnectivityEvent
from bsm.codec.static.units import checksum_of, unlike_the_encoders


@dataclass(frozen=True, eq=False)
class Numbering:
    """How the user of a mesh numbers what was coded."""

    faces: Faces
    source: Indices | None = None
    loose: Positions = field(default_factory=lambda: np.zeros((0, 3)))
    arrangement: Arrangement | None = None
    splits: bool = False

    def event(self, coded: int) -> ConnectivityEvent:
        """What a user has to know of it, where so many vertices are coded."""
        if self.source is None:
            loose = np.zeros(0, np.int32)
        else:
            loose = np.flatnonzero(self.source < 0).astype(np.int32)
        changes = Changes(loose, self.loose, np.ones(len(loose), np.bool_))
        return ConnectivityEvent(self.faces, self.size(coded), changes)

    def size(self, coded: int) -> int:
        """How many vertices the user has, where so many are coded."""
        return coded if self.source is None else len(self.source)

    def of(self, vertices: Indices) -> Indices:
        """The user's numbers, shape (c,), of coded vertices, shape (k,): of all copies of each."""
        return self.spread(vertices)[0]

    def spread(self, vertices: Indices) -> tuple[Indices, Order | slice]:
        """The user's numbers of coded vertices, shape (k,), and for each the row of `vertices` that it is a copy of."""
        if self._rows is None:
            return vertices, slice(None)
        starts, members = self._rows
        counts = starts[vertices + 1] - starts[vertices]
        rows = np.repeat(np.arange(len(vertices)), counts)
        within = np.arange(len(rows)) - np.repeat(np.cumsum(counts) - counts, counts)
        return members[starts[vertices][rows] + within], rows

    def mesh(self, positions: Positions, checksum: int | None) -> TriangleMesh:
        """The mesh of all coded vertices, shape (n, 3); with a checksum only if it is theirs."""
        if checksum is not None and checksum_of(positions) != checksum:
            raise unlike_the_encoders()
        return TriangleMesh(self.arranged(positions), self.faces)

    def arranged(self, positions: Positions) -> Positions:
        """Positions of all coded vertices, shape (n, 3), as the user numbers them, shape (k, 3)."""
        if self.source is None:
            return positions
        arranged = positions[self.source]
        arranged[self.source < 0] = self.loose
        return arranged

    @cached_property
    def corners(self) -> Indices | None:
        """The coded corner that each of the user's is, shape (m, 3); corner k of face f is 3 f + k. None: the same."""
        if self.arrangement is None:
            return None
        face = np.empty(len(self.faces), np.int32)
        face[self.arrangement.face_order] = np.arange(len(face), dtype=np.int32)
        turned = (self.arrangement.turns[:, None] + np.arange(3)) % 3
        return (3 * face[:, None] + turned).astype(np.int32)

    @cached_property
    def _rows(self) -> tuple[Order, Indices] | None:
        """Where each coded vertex's numbers begin, and all of these."""
        if self.source is None:
            return None
        order = np.argsort(self.source, kind="stable").astype(np.int32)[len(self.loose) :]
        coded = self.source[order]
        return np.searchsorted(coded, np.arange(coded.max(initial=-1) + 2)), order
