"""Blocks and a first layer on the cells of a mesh, which smoothing spreads to all vertices."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from bsm.bitstream.container.header import Layer
from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Levels, Matrix
from bsm.codec.blocks.cells import CellMesh, Fit, cells_of, prolonged
from bsm.codec.geometry.mesh import TriangleMesh, squares_of
from bsm.codec.signal.transform import smallest_step
from bsm.codec.static.options import EncodeOptions
from bsm.codec.static.preamble_encoding import Draft, Parts, Prepared
from bsm.codec.static.ways.grid import encode_layer
from bsm.codec.static.ways.in_blocks import InBlocks, RefinementBase

BLOCK, OVERLAP = 450, 1.0
"""CellMesh of a block: fewer take more bytes, more take decoders longer; and how far blocks are grown."""
# Blocks that depend on each other: a lost one loses at most so many, or about 16,000 vertices.
CHAIN = 4
RATIO = 3.0  # of the steps of cells along tangents, over those along normals
# Steps that levels may be away, and bends of surfaces some more; and places may be.
FARTHEST, LEAST = 2.0**18, 1e-9
# Steps of cells that may be best, over the usual one, up and down: three powers of two.
APART = 2.83
MOST_STEPS = 3  # in this range


@dataclass(frozen=True)
class Spread:
    """How far vertices are from centers of cells, in edges, and rounds of smoothing from cells to vertices.

    The step of levels of cells is about so many times as wide as that of vertices, and so is that of coefficients."""

    reach: int = 2
    rounds: int = 8
    levels: float = 16.0
    coefficients: float = 160.0

    @property
    def smoothing(self) -> tuple[int, int]:
        """The reach and the rounds, on which the cells and their places depend."""
        return self.reach, self.rounds


SPREADS = Spread(), Spread(3, 14, 6.0, 48.0), Spread(3, 14, 4.0, 24.0)
"""From fine levels of vertices to coarse ones, most of which are 0."""


# A strip of triangles has cells without any face, which a mesh may not be. Nothing else of its checks is needed here.
class _Places(TriangleMesh):
    """Places of cells, which may have no faces."""

    def __post_init__(self) -> None:
        pass


# Angles of normals mean nothing for cells, which are centers and no surface.
class _Blocks(InBlocks):
    """Blocks of cells, of which nothing is seen: all that counts is how near levels begin."""

    def _badness(self, decoded: Matrix) -> float:
        return float(squares_of(decoded - self._prepared.positions).sum())


@dataclass(frozen=True, eq=False)
class LeveledCells:
    """Blocks of cells, and levels at a step that is halved so often."""

    blocks: RefinementBase
    halvings: int
    levels: Levels

    @property
    def layer(self) -> Layer:
        return Layer(0.5**self.halvings, RATIO)

    @property
    def steps(self) -> Matrix:
        return self.blocks.known_steps(self.layer, self.levels)


class InCells:
    """Codes the cells of a mesh in blocks and levels."""

    parts = Parts(BLOCK, OVERLAP)

    def __init__(
        self, prepared: Prepared, options: EncodeOptions, widest: float, reach: int, rounds: int
    ) -> None:
        self._prepared = prepared
        self._widest = widest
        self.smoothing = self._reach, self._rounds = reach, rounds
        self._options = replace(options, key_interval=min(options.key_interval, CHAIN))

    @cached_property
    def cells(self) -> CellMesh:
        return cells_of(self._prepared.graph, self._prepared.mesh.faces, self._reach)

    @cached_property
    def _coarse(self) -> Prepared:
        """The cells, as a mesh that blocks can be on."""
        prepared = self._prepared
        cells = self.cells
        mesh = _Places(prepared.units.back(self._fit.places), cells.faces)
        return replace(prepared, mesh=mesh, graph=cells.graph, parts=self.parts)

    @cached_property
    def _fit(self) -> Fit:
        return Fit(self.cells, self._prepared.graph, self._prepared.positions, self._rounds)

    def place(self) -> None:
        """Find the cells, and the places of these that are nearest to the mesh."""
        _ = self._coarse

    def leveled(self, spread: Spread, step: float) -> Iterator[LeveledCells]:
        """Levels of cells below levels of vertices at about a step: for all steps of cells, finest first.

        Levels along normals tell which step is best; `settled` fits those along tangents, for that step alone."""
        coarse = self._coarse
        cells = spread.levels * step
        rough = max(spread.coefficients * step, 1.01 * smallest_step(coarse.size))
        spectral = _Blocks(coarse, self._options, self._widest)
        blocks = spectral.base(min(rough, 0.5))
        farthest = float(np.abs(blocks.offsets).max(initial=0.0))
        most = min(40, int(math.log2(FARTHEST / max(farthest, LEAST))))
        finest = math.ceil(-math.log2(cells * (1.0 / APART)))
        coarsest = math.ceil(-math.log2(cells * APART))
        for halvings in reversed(range(coarsest, finest)):
            yield self._nearest(blocks, max(min(halvings, most), 1))

    def base(self, cells: LeveledCells) -> RefinementBase:
        """The places that levels bring cells to, prolonged."""
        prepared = self._prepared
        coarse = self._coarse
        blocks = cells.blocks
        places = blocks.moved(cells.layer, cells.levels, cells.steps)
        levels = encode_layer(blocks.prepared.mesh.faces, cells.levels)
        positions = prolonged(self.cells, prepared.graph, places, self._rounds)
        base = coarse.graph.size, self._reach, self._rounds, cells.halvings
        header = replace(
            blocks.draft.header,
            vertices=prepared.graph.size,
            faces=len(prepared.mesh.faces),
            base=base,
        )
        draft = Draft(header, (*blocks.draft.body, *levels), prepared.units.back(positions))
        coded = blocks.coded + sum(len(packet.data) for packet in levels)
        return RefinementBase(prepared, draft, positions, coded)

    def settled(self, cells: LeveledCells) -> LeveledCells:
        """Return levels along tangents that fit the steps, which follow from heights."""
        return self._fitted(cells, first=1)

    def _nearest(self, blocks: RefinementBase, halvings: int) -> LeveledCells:
        levels = np.zeros(blocks.positions.shape, np.int32)
        cells = LeveledCells(blocks, halvings, levels)
        heights, shifts = blocks.offsets[:, 0], blocks.offsets[:, 1:]
        levels[:, 0] = np.rint(heights / cells.layer.step)
        levels[:, 1:] = np.rint(shifts / cells.steps[:, 1:])
        return self._fitted(cells, first=0)

    def _fitted(self, cells: LeveledCells, first: int) -> LeveledCells:
        """Return levels, from the first axis on, that leave little to vertices."""
        levels = cells.levels.copy()
        steps = cells.steps
        places = cells.blocks.moved(cells.layer, levels, steps)
        self._fit.level(cells.blocks.frames, steps, places, levels, first)
        return replace(cells, levels=levels)
