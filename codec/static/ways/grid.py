"""Packets of positions on a grid instead of blocks, and of the layer of refinement on blocks."""

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from bsm.bitstream.container import packets
from bsm.bitstream.container.header import EXACT
from bsm.bitstream.container.wire import write_varint
from bsm.bitstream.fields.corners import FieldEncoder
from bsm.bitstream.fields.grid import Cells, Floats, Numbers, cells_of, grid_field, levels_field, light_field, spread
from bsm.codec.arrays import Indices, Levels, Positions

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
        """What the header has to say."""
        return {"center": self.origin, "scale": self.step, "grid": self.largest, "lattice": self.lattice} | {
            "corner": self.corner,
            "light": EXACT if self.exact else int(self.light),
        }


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


LAYER_CHUNK = 1 << 15  # vertices of a frame of refinement


def encode_layer(faces: Indices, levels: Levels) -> list[packets.Refinement]:
    """The packets of the layer of refinement, of levels, shape (n, 3)."""
    encoder, size = FieldEncoder(levels_field(faces, len(levels)), levels), len(levels)
    chunks = [(start, min(LAYER_CHUNK, size - start)) for start in range(0, size, LAYER_CHUNK)]
    return [packets.Refinement(start, count, encoder.chunk(count)) for start, count in chunks]
