"""Dictionaries of all blocks of a model, exact or by orthogonal iterations, and the error that they leave."""

from __future__ import annotations

import time
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from bsm.codec.arrays import Basis, Indices, Positions
from bsm.codec.basis.orthogonal_iteration import cosine_columns
from bsm.codec.blocks.overlap import Blend, Block
from bsm.codec.geometry.metrics import decibel
from bsm.codec.static.options import Paper
from bsm.codec.static.ways.in_blocks import MOST_APART
from tools.laplacians import dense_laplacian
from tools.replicate.paper.models import Model

Floats = npt.NDArray[np.float64]
SHIFT = Paper().shift
BITS = 12


def in_file_order(block: Block) -> Block:
    """The block with its rows in the order that the vertices have in the file."""
    order = np.argsort(block.vertices)
    place = np.argsort(order)
    rows = [block.neighbors[block.offsets[row] : block.offsets[row + 1]] for row in order]
    neighbors = np.concatenate([np.sort(place[row]) for row in rows]).astype(np.int32)
    offsets = np.append(0, np.cumsum([len(row) for row in rows])).astype(np.int32)
    return Block(block.vertices[order], offsets, neighbors)


def eigenvectors(block: Block, width: int) -> Floats:
    """The lowest eigenvectors, by LAPACK."""
    return np.ascontiguousarray(np.linalg.eigh(dense_laplacian(block))[1][:, :width])


def iterated(
    block: Block, start: Floats | Basis, power: int, iterations: int = 1, shift: float = SHIFT
) -> Floats:
    """U after orthogonal iterations from `start`, by the kernel of the codec."""
    apart = min(power, MOST_APART) if power > 1 else 0
    return block.iterated(start, shift, power, iterations, apart).astype(np.float64)


@dataclass(frozen=True, eq=False)
class Cut:
    """A model in overlapping blocks, in the order of the chain, and the largest width that is asked for."""

    model: Model
    blocks: Sequence[Block]
    width: int

    @classmethod
    def of(cls, model: Model, segments: int, keep: float, *, file_order: bool = False) -> Cut:
        blocks = model.blocks(segments)
        ordered = [blocks.block(index) for index in range(blocks.count)]
        size = max(block.size for block in ordered)
        return cls(
            model, [in_file_order(b) if file_order else b for b in ordered], round(keep * size)
        )

    @property
    def size(self) -> int:
        """n_d."""
        return max(block.size for block in self.blocks)

    @cached_property
    def exact(self) -> list[Floats]:
        """The lowest eigenvectors of each block."""
        return [eigenvectors(block, self.width) for block in self.blocks]

    def chain(
        self,
        width: int,
        power: int,
        iterations: int = 1,
        order: Iterable[int] | None = None,
        shift: float = SHIFT,
    ) -> tuple[list[Floats], float]:
        """Dictionaries along a chain, each from the one before, the first exact; and seconds of a thread for them."""
        bases: list[Floats] = [np.empty(0)] * len(self.blocks)
        previous, seconds = None, 0.0
        for index in range(len(self.blocks)) if order is None else order:
            block = self.blocks[index]
            if previous is None or len(previous) != block.size:
                previous = self.exact[index][:, :width]
            else:
                begin = time.thread_time()
                previous = iterated(block, previous, power, iterations, shift)
                seconds += time.thread_time() - begin
            bases[index] = previous
        return bases, seconds

    def cold(self, width: int, power: int) -> list[Floats]:
        """Dictionaries each from cosines."""
        return [iterated(b, cosine_columns(b.size, min(width, b.size)), power) for b in self.blocks]

    def blended(self, bases: Sequence[Floats], values: Positions, bits: int = 0) -> Positions:
        """What the blocks keep of values, shape (n, 3); coefficients are rounded if there are `bits`."""
        found = [
            center_and_coefficients(b, u, values) for b, u in zip(self.blocks, bases, strict=True)
        ]
        if bits:
            # The first row is that of the mean: it has a range of its own, as in the codec.
            largest = [
                max(np.abs(kept[rows]).max(initial=0.0) for _, kept in found)
                for rows in FIRST_AND_OTHERS
            ]
            for _, kept in found:
                for rows, most in zip(FIRST_AND_OTHERS, largest, strict=True):
                    step = most / (2 ** (bits - 1) - 1) or 1.0
                    kept[rows] = np.rint(kept[rows] / step) * step
        blend = Blend(len(values))
        for block, basis, (center, kept) in zip(self.blocks, bases, found, strict=True):
            blend.add(block.vertices, basis @ kept + center, degree_weights(block.degrees))
        return blend.all_positions()

    def decibels(
        self, bases: Sequence[Floats], values: Positions | None = None, bits: int = 0
    ) -> float:
        """NMSVE as the paper prints it, of what the blocks keep of the clean mesh, or of `values`."""
        reference = self.model.reference
        kept = self.blended(bases, self.model.clean if values is None else values, bits)
        return decibel(reference.nmsve(kept) * reference.scale)

    def rate(self, coefficients: int) -> float:
        """Bits per vertex by the paper's formula, 3 q c k / n, of the sum of c over all blocks."""
        return 3 * BITS * coefficients / len(self.model.clean)


def degree_weights(degrees: Indices) -> Floats:
    """Weight of each row: its neighbors inside the block; a row without any counts as one."""
    return np.maximum(degrees, 1).astype(np.float64)


FIRST_AND_OTHERS = (slice(0, 1), slice(1, None))


def center_and_coefficients(
    block: Block, basis: Floats, values: Positions
) -> tuple[Floats, Floats]:
    """The middle of the mesh, which far from the origin would drown all else, and the coefficients of a block."""
    center = 0.5 * (values.min(axis=0) + values.max(axis=0))
    return center, basis.T @ (values[block.vertices] - center)
