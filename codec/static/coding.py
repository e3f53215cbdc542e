"""Ways of coding what the prediction of a block leaves, one socket for all of them.

A way knows the steps and widths of a stream. `Coding.begin` gives it the state that a chain starts from; after that
the encoder calls `choose`, `write` and `positions` for one block after the other, the decoder `read` and `positions`.
A way reads its numbers from the header (`coding_of`) and writes them there (`Coding.fields`), and nobody else does.

What has no dictionary and no blocks, or comes behind them all, is no way of coding a block: it is a stage of its own
(`codec.static.stages`), which follows the preamble or the blocks.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Protocol

import numpy as np

from bsm.bitstream.coefficients.adaptive import (
    MAX_LEVEL,
    CoefficientModel,
    decode_coefficients,
    decode_layers,
    encode_coefficients,
    encode_layers,
)
from bsm.bitstream.coefficients.packed import pack_coefficients, unpack_coefficients
from bsm.bitstream.coefficients.priors import detail_experience
from bsm.bitstream.coefficients.rate_distortion import TARGET_UNIT, choose_levels
from bsm.bitstream.container.header import Header
from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Faces, Integers, Levels, Matrix
from bsm.codec.basis.dynamic_size import DynamicSize
from bsm.codec.blocks.overlap import Block
from bsm.codec.signal.detail import Normals, Surface, fold_details, make_surface
from bsm.codec.signal.quantize import (
    BIT_WORTH,
    dequantize,
    levels_to_unsigned,
    quantize_packed,
    targets,
    unsigned_to_levels,
)
from bsm.codec.signal.transform import placed, project, reconstruct


@dataclass(frozen=True, eq=False)
class Ground:
    """What both sides know of a block before its levels: where its rows are expected, shape (n, 3), and U."""

    block: Block
    prediction: Matrix
    dictionary: Matrix

    def coefficients(self, values: Matrix, width: int) -> Matrix:
        """U^T of `values`, shape (n, ...), for at most `width` columns."""
        return project(self.dictionary, values, min(width, self.block.size))

    def add(self, coefficients: Matrix) -> Matrix:
        """The prediction, and U times coefficients, shape (c_i, 3)."""
        return self.prediction + reconstruct(self.dictionary, coefficients)


@dataclass(frozen=True, eq=False)
class BlockLevels:
    """The levels of one block."""

    coordinates: Integers
    details: Levels
    width: int


class Coding(Protocol):
    """A way of coding blocks."""

    @property
    def width(self) -> int:
        """Columns of the largest dictionary."""

    @property
    def detail_rows(self) -> int:
        """Rows of levels of the largest detail layer."""

    @property
    def fields(self) -> dict[str, Any]:
        """What the header has to say of it; the number of coefficients is said when all blocks are coded."""

    def begin(self) -> Coding:
        """This way of coding, in the state that a chain starts from."""

    def choose(self, ground: Ground, wanted: Matrix, sizes: DynamicSize | None) -> BlockLevels:
        """Levels that bring a block near to `wanted`, shape (n, 3), or as near as pays."""

    def write(self, levels: BlockLevels) -> bytes:
        """The payload of the chain's next block."""

    def read(self, payload: bytes, count: int, size: int) -> BlockLevels:
        """Twin of `write`, for a block of `size` rows and `count` coefficients a coordinate."""

    def positions(self, ground: Ground, levels: BlockLevels) -> Matrix:
        """What levels make of a block, shape (n, 3)."""


@dataclass(frozen=True)
class Packed:
    """Every coefficient in so many bits, zstd behind: the paper's."""

    width: int
    bits: int
    step: float
    coarser: int

    @property
    def detail_rows(self) -> int:
        return 0

    @property
    def fields(self) -> dict[str, Any]:
        return {"coding": 0, "step": self.step, "bits": self.bits, "coarser": self.coarser}

    def begin(self) -> Packed:
        return self

    def choose(self, ground: Ground, wanted: Matrix, sizes: DynamicSize | None) -> BlockLevels:
        return _plain(quantize_packed(_offered(ground, wanted, self.width, sizes), self.step, self.coarser))

    def write(self, levels: BlockLevels) -> bytes:
        return pack_coefficients(levels_to_unsigned(levels.coordinates, self.bits, self.coarser), self.bits)

    def read(self, payload: bytes, count: int, size: int) -> BlockLevels:
        return _plain(unsigned_to_levels(unpack_coefficients(payload, 3 * count, self.bits), self.bits, self.coarser))

    def positions(self, ground: Ground, levels: BlockLevels) -> Matrix:
        return ground.add(dequantize(levels.coordinates, self.step))


@dataclass(eq=False)
class Adaptive:
    """Levels on two grids, chosen by rate and distortion and coded by what the chain has taught."""

    width: int
    step: float

    @cached_property
    def model(self) -> CoefficientModel:
        """What the chain has taught."""
        return CoefficientModel(self.width)

    @property
    def detail_rows(self) -> int:
        return 0

    @property
    def fields(self) -> dict[str, Any]:
        return {"coding": 1, "step": self.step}

    def begin(self) -> Adaptive:
        return replace(self)

    def choose(self, ground: Ground, wanted: Matrix, sizes: DynamicSize | None) -> BlockLevels:
        offered = _offered(ground, wanted, self.width, sizes)
        choice = choose_levels(self.model, targets(offered, self.step, TARGET_UNIT, MAX_LEVEL), BIT_WORTH)
        return _plain(choice.levels if sizes is not None else choice.levels[: choice.width])

    def write(self, levels: BlockLevels) -> bytes:
        return encode_coefficients(self.model, np.asarray(levels.coordinates, np.int32))

    def read(self, payload: bytes, count: int, size: int) -> BlockLevels:
        return _plain(decode_coefficients(self.model, payload, count))

    def positions(self, ground: Ground, levels: BlockLevels) -> Matrix:
        return placed(ground.prediction, ground.dictionary, np.asarray(levels.coordinates, np.int32), self.step)


@dataclass(eq=False)
class Layered:
    """`Adaptive` for x, y and z, and a detail layer along the normals above it."""

    base: Adaptive
    details: int
    step: float
    surface: Surface

    @cached_property
    def model(self) -> CoefficientModel:
        """What the chain has taught of the detail layer."""
        return CoefficientModel(self.detail_rows, detail_experience())

    @cached_property
    def normals(self) -> Normals:
        """Where that layer points."""
        return Normals(self.surface)

    @property
    def width(self) -> int:
        return max(self.base.width, self.details)

    @property
    def detail_rows(self) -> int:
        return detail_rows(self.details)

    @property
    def fields(self) -> dict[str, Any]:
        return self.base.fields | {"details": self.details, "detail_step": self.step}

    def begin(self) -> Layered:
        return replace(self, base=self.base.begin())

    def choose(self, ground: Ground, wanted: Matrix, sizes: DynamicSize | None) -> BlockLevels:
        below = self.base.choose(ground, wanted, sizes)
        decoded = self.base.positions(ground, below)
        heights = (self.normals.of(ground.block, decoded) * (wanted - decoded)).sum(axis=1)
        offered = targets(ground.coefficients(heights, self.details), self.step, TARGET_UNIT, MAX_LEVEL)
        choice = choose_levels(self.model, fold_details(offered), BIT_WORTH)
        rows = choice.levels[: choice.width if choice.levels.any() else 0]
        return self._levels(below.coordinates, rows, ground.block.size)

    def write(self, levels: BlockLevels) -> bytes:
        return encode_layers(self.base.model, np.asarray(levels.coordinates, np.int32), self.model, levels.details)

    def read(self, payload: bytes, count: int, size: int) -> BlockLevels:
        return self._levels(*decode_layers(self.base.model, self.model, payload, count), size)

    def positions(self, ground: Ground, levels: BlockLevels) -> Matrix:
        decoded = self.base.positions(ground, levels)
        heights = self._heights(levels.details, ground.block.size)
        self.normals.raise_block(ground.block, ground.dictionary, levels.details, heights, self.step, decoded)
        return decoded

    def _levels(self, coordinates: Integers, details: Levels, size: int) -> BlockLevels:
        return BlockLevels(coordinates, details, max(len(coordinates), self._heights(details, size)))

    def _heights(self, details: Levels, size: int) -> int:
        return min(details.size, self.details, size)


def coding_of(header: Header, faces: Faces, size: int) -> Coding:
    """The way in which a stream's blocks are coded; `faces`, shape (m, 3), on `size` vertices, as they are coded."""
    if header.coding == 0:
        return Packed(header.coefficients, header.bits, header.step, header.coarser)
    base = Adaptive(header.coefficients, header.step)
    if not header.details:
        return base
    return Layered(base, header.details, header.detail_step, make_surface(faces, size))


def detail_rows(details: int) -> int:
    """Rows of three that the largest detail layer takes."""
    return -(-details // 3)


def _plain(levels: Integers) -> BlockLevels:
    return BlockLevels(levels, np.zeros((0, 3), np.int32), len(levels))


def _offered(ground: Ground, wanted: Matrix, width: int, sizes: DynamicSize | None) -> Matrix:
    residual = wanted - ground.prediction
    coefficients = ground.coefficients(residual, width)
    return coefficients if sizes is None else coefficients[: sizes.follow(residual, coefficients)]
