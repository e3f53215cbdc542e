"""Putting decoded blocks together: which vertices have moved, which are final, which are missing."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from bitstream.errors import NumericError
from codec.blocks.blend import Blend
from codec.blocks.overlap import Blocks
from codec.geometry.graph import Graph
from codec.geometry.mesh import Positions
from codec.signal.smooth import DEGREE, LocalFilter, smooth

Matrix = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int32]


@dataclass(frozen=True, eq=False)
class DecodedBlock:
    """A block's own reconstruction, before it is blended with others; positions in BSM units."""

    index: int
    vertices: Indices
    positions: Matrix
    weights: Matrix


@dataclass(frozen=True, eq=False)
class Frame:
    """Where positions in BSM units lie in the mesh's: position * scale + center."""

    center: tuple[float, ...]
    scale: float


@dataclass(frozen=True, eq=False)
class Changes:
    """What a block changed: vertices, their positions in the mesh's unit, and which of them are final."""

    vertices: Indices
    positions: Positions
    final: npt.NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Losses:
    """Vertices without any copy, and vertices that lack a copy or lie in the filter's reach of one that is missing."""

    missing: Indices = field(default_factory=lambda: np.empty(0, np.int32))
    degraded: Indices = field(default_factory=lambda: np.empty(0, np.int32))


def in_mesh_units(positions: Matrix, center: tuple[float, ...], scale: float) -> Positions:
    """Positions in BSM units as the mesh has them.

    Raises
    ------
    NumericError
        If one is beyond the range of numbers.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        moved = positions * scale + np.array(center)
    if not np.isfinite(moved).all():
        raise NumericError("positions are not finite in the unit of the mesh")
    return moved


class Assembly:
    """Blends the blocks of one mesh.

    Parameters
    ----------
    graph : Graph
    blocks : Blocks
    smoothing : float
        Amount of the decoder's filter.
    frame : Frame
    order : int32 array, shape (n,), optional
        Number that the user knows each vertex by; None: its own.
    """

    def __init__(self, graph: Graph, blocks: Blocks, smoothing: float, frame: Frame, order: Indices | None) -> None:
        self._graph = graph
        self._blocks = blocks
        self._smoothing = smoothing
        self._frame = frame
        self._order = order
        self._blend = Blend(graph.size)
        self._missing = np.bincount(blocks.members, minlength=graph.size)
        self._blended = np.zeros((graph.size, 3))
        self._final = np.zeros(graph.size, np.bool_)
        self._filter = LocalFilter(graph, smoothing)
        self._lost: list[int] = []

    def add(self, block: DecodedBlock) -> None:
        """Blend one block in."""
        self._blend.add(block.vertices, block.positions, block.weights)

    def lose(self, index: int) -> None:
        """Take note that a block will not come."""
        self._lost.append(index)

    def positions(self) -> Positions:
        """All positions, in the mesh's unit, once every block is in."""
        everything = np.arange(self._graph.size, dtype=np.int32)
        decoded = self._in_mesh_units(smooth(self._graph, self._blend.positions(everything), self._smoothing))
        if self._order is None:
            return decoded
        arranged = np.empty_like(decoded)
        arranged[self._order] = decoded
        return arranged

    def changes(self, block: DecodedBlock) -> Changes:
        """Blend one block in and say what it changed."""
        self.add(block)
        seen = block.vertices[self._blend.known(block.vertices)]
        self._blended[seen] = self._blend.positions(seen)
        self._missing[block.vertices] -= 1
        finished = self._finished(block.vertices[self._missing[block.vertices] == 0])
        self._final[finished] = True
        moved = seen[~self._final[seen]]
        done = self._filter.smoothed(self._blended, finished)
        changed = np.concatenate([moved, finished])
        positions = self._in_mesh_units(np.concatenate([self._blended[moved], done]))
        return Changes(self._numbered(changed), positions, np.arange(len(changed)) >= len(moved))

    def losses(self) -> Losses:
        """What the blocks that were lost leave missing or less good."""
        if not self._lost:
            return Losses()
        touched = np.unique(np.concatenate([self._blocks.members_of(index) for index in self._lost]))
        known = self._blend.known(touched)
        reach = DEGREE if self._smoothing else 0
        around = self._filter.around(touched, reach)
        degraded = around[self._blend.known(around)]
        return Losses(self._numbered(touched[~known]), self._numbered(np.sort(degraded)))

    def _finished(self, complete: Indices) -> Indices:
        """Vertices that become final when all copies of `complete` have come: none that the filter sees is missing."""
        if self._smoothing == 0.0:
            return complete
        around = self._filter.around(complete, 2 * DEGREE)
        waiting = self._filter.around(around[self._missing[around] > 0], DEGREE)
        candidates = self._filter.around(complete, DEGREE)
        return np.setdiff1d(candidates[~self._final[candidates]], waiting)

    def _numbered(self, vertices: Indices) -> Indices:
        return vertices if self._order is None else self._order[vertices]

    def _in_mesh_units(self, positions: Matrix) -> Positions:
        return in_mesh_units(positions, self._frame.center, self._frame.scale)
