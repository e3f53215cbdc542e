"""Positions on a grid instead of blocks: the encoder's packets, and the stage of the decoder that takes them."""

from collections import deque
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from bsm.bitstream.container import packets
from bsm.bitstream.container.header import EXACT, Header
from bsm.bitstream.container.wire import Cursor, write_varint
from bsm.bitstream.errors import BsmError, CorruptError, NumericError
from bsm.bitstream.fields.corners import FieldDecoder, FieldEncoder
from bsm.bitstream.fields.grid import Cells, Floats, Numbers, cells_of, floats_of, grid_field, light_field, spread
from bsm.codec.arrays import Indices, Levels, Positions
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.static.attributes.decoding import BodyStage
from bsm.codec.static.attributes.surface import Solid
from bsm.codec.static.events import BlockEvent, Changes, Losses, LossEvent
from bsm.codec.static.preamble_decoding import Structure
from bsm.codec.static.stages import Arrival, Stage
from bsm.codec.static.work import floats_cost, grid_chunk_cost, grid_cost, grid_memory, light_chunk_cost, light_cost

FIRST, CHUNK = 1 << 12, 1 << 13
"""Vertices of the first frame, and of each that follows: large meshes are seen while they arrive, from early on."""


@dataclass(frozen=True, eq=False)
class Grid:
    """A grid in the mesh's unit, and where each axis of it ends."""

    origin: tuple[float, ...]
    step: float
    largest: tuple[int, ...]
    lattice: tuple[int, ...] = ()
    corner: tuple[int, ...] = ()
    light: bool = False
    exact: bool = False

    def positions(self, coded: Levels) -> Positions:
        """Positions of coded values, shape (n, 3), in the mesh's unit."""
        places = spread(coded, self.lattice) + np.array(self.corner or (0, 0, 0), np.int64)
        return np.asarray(places * self.step + np.array(self.origin))

    def cells(self, coded: Levels) -> Cells:
        """The cells of coded values, shape (n, 3)."""
        return cells_of(coded, np.array(self.origin), self.step)

    @property
    def fields(self) -> dict[str, Any]:
        """Twin of `grid_of`: what the header has to say."""
        return {"center": self.origin, "scale": self.step, "grid": self.largest, "lattice": self.lattice} | {
            "corner": self.corner,
            "light": EXACT if self.exact else int(self.light),
        }


def grid_of(header: Header) -> Grid:
    exact = header.light == EXACT
    light = bool(header.light) and not exact
    return Grid(header.center, header.scale, header.grid, header.lattice, header.corner, light, exact)


def encode_grid(faces: Indices, grid: Grid, coded: Levels) -> list[packets.Grid]:
    """The packets of coded values, shape (n, 3), between 0 and the grid's largest."""
    field, size = light_field if grid.light else grid_field, len(coded)
    encoder = FieldEncoder(field(faces, size, grid.largest), coded)
    starts = [*range(0, min(size, 1)), *range(FIRST, size, CHUNK)]
    counts = [end - start for start, end in pairwise([*starts, size])]
    return [packets.Grid(start, count, encoder.chunk(count)) for start, count in zip(starts, counts, strict=True)]


def encode_exact(faces: Indices, grid: Grid, coded: Levels, floats: Numbers) -> list[packets.Grid]:
    """The packets of coded values, shape (n, 3), and of the numbers of floats in their cells."""
    model, order = Floats(grid.largest), grid_field(faces, len(coded), grid.largest).start().order
    result = []
    for packet in encode_grid(faces, grid, coded):
        rows = order[packet.first : packet.first + packet.count]
        behind = model.encode(coded[rows], grid.cells(coded[rows]), floats[rows])
        result.append(packets.Grid(packet.first, packet.count, write_varint(len(packet.data)) + packet.data + behind))
    return result


FULL = grid_field, grid_cost, grid_chunk_cost
LIGHT = light_field, light_cost, light_chunk_cost  # how values are decoded, and what that and each frame cost


class GridStage(BodyStage):
    """The faces are known; chunks of positions come."""

    def __init__(self, structure: Structure, tolerant: bool) -> None:
        size, faces, allowance = structure.header.vertices, len(structure.faces), structure.allowance
        allowance.keep(grid_memory(size, faces))
        self._grid = grid_of(structure.header)
        field, cost, self._chunk_cost = LIGHT if self._grid.light else FULL
        allowance.spend(cost(size, faces))
        self._structure = structure
        self._decoder = FieldDecoder(field(structure.faces, size, self._grid.largest), allowance.limits)
        self._floats: Floats | None = None
        if self._grid.exact:
            allowance.keep(float(Floats.charge(self._grid.largest)))
            allowance.spend(floats_cost(size, max(self._grid.largest)))
            self._floats = Floats(self._grid.largest)
        self._chunks = 0
        self._broken = False
        self._result = OnGrid(structure, np.zeros((size, 3)), np.zeros((size, 3), np.int32), np.zeros(size, np.bool_))
        super().__init__(self._result, structure, tolerant)

    def accept(self, arrival: Arrival, queue: deque[Any]) -> Stage[Any]:
        if not isinstance(arrival, packets.Grid):
            return super().accept(arrival, queue)
        self._decode(arrival, queue)
        return self

    def _decode(self, packet: packets.Grid, queue: deque[Any]) -> None:
        if self._broken:
            return
        self._structure.allowance.spend(self._chunk_cost(len(packet.data)), len(packet.data))
        try:
            if packet.first != self._decoder.coded:
                raise CorruptError(f"positions from number {self._decoder.coded} on are missing; others depend on them")
            vertices, coded, positions = self._chunk(packet)
        except BsmError as error:
            if not self._tolerant:
                raise
            self._broken = True
            queue.append(LossEvent(None, error))
            return
        self._result.positions[vertices] = positions
        self._result.places[vertices] = coded
        self._result.known[vertices] = True
        numbers, rows = self._structure.numbering.spread(vertices)
        queue.append(BlockEvent(self._chunks, Changes(numbers, positions[rows], np.ones(len(numbers), np.bool_))))
        self._chunks += 1

    def _chunk(self, packet: packets.Grid) -> tuple[Indices, Levels, Positions]:
        """Vertices of a frame, their values, and their positions."""
        if self._floats is None:
            vertices, coded = self._decoder.chunk(packet.data, packet.count)
            return vertices, coded, self._grid.positions(coded)
        cursor = Cursor(packet.data)
        vertices, coded = self._decoder.chunk(cursor.take(cursor.varint()), packet.count)
        floats = self._floats.decode(cursor.rest(), coded, self._grid.cells(coded))
        positions = floats_of(floats).astype(np.float64)
        if not np.isfinite(positions).all():
            raise NumericError("positions are not finite in the unit of the mesh")
        return vertices, coded, positions

    def _lose(self, damaged: packets.Damaged, queue: deque[Any]) -> None:
        self._broken = True
        super()._lose(damaged, queue)


@dataclass(frozen=True, eq=False)
class OnGrid:
    """What has been decoded: positions in the mesh's unit and places on the grid, shape (n, 3), and which are known."""

    structure: Structure
    positions: Positions
    places: Levels
    known: np.ndarray[Any, np.dtype[np.bool_]]

    def mesh(self, checksum: int | None = None) -> TriangleMesh:
        return self.structure.numbering.mesh(self.positions, checksum if self.known.all() else None)

    def solid(self) -> Solid | None:
        """Decoded positions; None if some are missing."""
        return Solid(self.positions, self.places) if self.known.all() else None

    def losses(self) -> Losses:
        return Losses(np.sort(self.structure.numbering.of(np.flatnonzero(~self.known).astype(np.int32))))
