"""Packets of positions on a grid instead of blocks, and of the layer of refinement on blocks."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from bsm._core import Field
from bsm.bitstream.container import packets
from bsm.bitstream.container.header import EXACT, Header
from bsm.bitstream.container.wire import with_lengths
from bsm.codec.arrays import Indices, Levels, Matrix, Positions
from bsm.codec.geometry.turns import UNTURNED, Turn, turned_by

# A page can show the first frame while the rest arrives; each costs some bytes.
FIRST, CHUNK, SAMPLE = 1 << 12, 1 << 13, 1 << 11
"""Vertices of the first frame, and of each that follows: large meshes are seen while they arrive, from early on.
Vertices that tell that a mesh is on no grid, and about how large a grid is, before all are looked at."""


@dataclass(frozen=True, eq=False)
class Raster:
    """A grid in the mesh's unit, and where each axis of it ends."""

    origin: tuple[float, ...]
    step: float
    largest: tuple[int, ...]
    light: bool = False
    exact: bool = False
    transforms: Levels | None = None  # of congruent parts, shape (k, 8); None: coded without
    turn: Turn = UNTURNED  # of its axes to those of the mesh
    whole: bool = True  # whether vertices that are where images are take one decision

    def positions(self, coded: Levels) -> Positions:
        """Positions of coded values, shape (n, 3), in the mesh's unit."""
        # Written as the law has it, operation by operation, since decoded positions must agree to the bit.
        return turned_by(coded * self.step + np.array(self.origin), self.turn)

    @property
    def congruence(self) -> int:
        """The field of the header."""
        if self.transforms is None:
            return 0
        return 35 + len(self.transforms) + 17 * self.whole

    @property
    def fields(self) -> dict[str, Any]:
        """The fields of the header."""
        light = int(self.light)
        if self.exact:
            light = EXACT
        return {
            "center": self.origin,
            "scale": self.step,
            "grid": self.largest,
            "light": light,
            "congruence": self.congruence,
            "turn": self.turn,
        }


UNIT = Raster((0.0, 0.0, 0.0), 1.0, ())


def grid_of(header: Header) -> Raster:
    """The grid of a header, without transforms."""
    return Raster(header.center, header.scale, header.grid, turn=header.turn)


def grid_field(
    faces: Any,
    largest: Sequence[int],
    coded: Levels,
    light: int = 0,
    grid: Raster | None = None,
    exact: Any = None,
) -> Field:
    """The field of coded values, shape (n, 3), from 0 to `largest`, and of `exact` floats; a field can give faces."""
    # One kernel codes all three axes of a vertex: each is predicted from the two before it as well.
    field = Field(faces, np.ascontiguousarray(coded, np.int32))
    ends = np.array(largest, np.int32)
    grid = grid or UNIT
    origin = np.array(grid.origin, np.float64)
    field.grid(ends, light, origin, grid.step, exact, grid.transforms, grid.congruence)
    return field


def encode_grid(
    faces: Indices | Field, grid: Raster, coded: Levels, exact: Any = None
) -> Iterator[packets.Grid]:
    """Make the packets of coded values, shape (n, 3), 0 to the grid's largest; of `exact` floats in their cells."""
    field = grid_field(faces, grid.largest, coded, grid.fields["light"], grid, exact)
    return _packets(field, len(coded))


def encode_going(
    faces: Indices | Field, grid: Raster, coded: Levels, targets: Matrix
) -> tuple[tuple[packets.Grid, ...], Levels]:
    """The packets and the values, where vertices have gone to images: `wanted`, shape (n, 4), says where each would be,
    in cells, and the square of how far from there it may come."""
    field = grid_field(faces, grid.largest, coded, grid.fields["light"], grid)
    # The coder itself moves vertices, because which images a vertex could go to is known only while it codes.
    field.go(targets)
    return tuple(_packets(field, len(coded))), field.coded


def _packets(field: Field, size: int) -> Iterator[packets.Grid]:
    # The first vertex is in a frame of its own, so that a decoder has somewhere to start from.
    for start, end in pairwise([*range(0, min(size, 1)), *range(FIRST, size, CHUNK), size]):
        yield packets.Grid(start, end - start, with_lengths(field.write(end - start)))


def sampled_size(faces: Indices | Field, grid: Raster, coded: Levels, light: int = 0) -> int:
    """The bytes of the first coded values."""
    # A part of the mesh is enough to tell which of two grids is better, in a fraction of the time.
    field = grid_field(faces, grid.largest, coded, light, grid)
    return sum(map(len, field.write(SAMPLE)))


LAYER_CHUNK = 1 << 15  # vertices of a frame of refinement


def levels_field(faces: Indices, levels: Levels) -> Field:
    """The field of levels, shape (n, 3)."""
    field = Field(faces, np.ascontiguousarray(levels, np.int32))
    field.levels()
    return field


def encode_layer(faces: Indices, levels: Levels, after: int = 0) -> list[packets.Refinement]:
    """The packets of the layer of refinement, of levels, shape (n, 3), numbered on from `after`."""
    field = levels_field(faces, levels)
    size = len(levels)
    chunks = [(start, min(LAYER_CHUNK, size - start)) for start in range(0, size, LAYER_CHUNK)]
    return [
        packets.Refinement(after + start, count, *field.write(count)) for start, count in chunks
    ]
