"""Nanoseconds of a processor core and bytes of memory that decoders estimate a stream to take, for encoders."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from threading import Condition

from bsm.bitstream.limits import Limits
from bsm.codec.basis.laplacian import Laplacian, factor_cost, iteration_memory, solve_cost

BLOCK = 1.45e5  # of a block, whatever its size
ROW, LOOK, LEVEL = 600.0, 25.0, 90.0  # of a row of a block, of an edge that one has in the mesh, and of a coded level


def block_cost(rows: int, edges: int, levels: int) -> float:
    """Work of a block, except its dictionary."""
    return BLOCK + ROW * rows + LOOK * edges + LEVEL * levels


def ground_cost(laplacian: Laplacian, columns: int) -> float:
    """Work of extending what is known around a block, and of putting its coefficients on that."""
    return factor_cost(laplacian.fronts) + solve_cost(laplacian.fronts, 3) + 1.5 * len(laplacian.diagonal) * columns


def mesh_memory(vertices: int, faces: int) -> float:
    return 200.0 * vertices + 60.0 * faces


def block_memory(laplacian: Laplacian, columns: int) -> int:
    return iteration_memory(laplacian.fronts, columns)


class Budget:
    """The memory of a decoder, on which threads draw at the same time."""

    def __init__(self, limits: Limits) -> None:
        self.limits = limits
        self.vertices = 0
        self.reserved = 0.0
        self._received = 0
        self._held = 0.0
        self._change = Condition()

    def follow(self, other: Budget) -> None:
        """Go on from what another has counted."""
        with self._change:
            self.vertices, self._received, self.reserved = other.vertices, other._received, other.reserved

    def room(self, received: int = 0) -> float:
        """Return the bytes that are free besides the kept ones, after this many more are received."""
        with self._change:
            return self.limits.memory_for(self.vertices, self._received + received) - self.reserved

    def grant(self, vertices: int) -> None:
        """Take note of vertices that the stream really has."""
        with self._change:
            self.vertices += vertices

    def give_back(self, memory: float, vertices: int) -> None:
        """Take note of memory that was kept, and of vertices that are not there any more."""
        with self._change:
            self.reserved -= memory
            self.vertices -= vertices

    def reserve(self, memory: float, received: int = 0) -> None:
        """Reserve memory to the end, and the bytes that pay for it."""
        with self._change:
            self.reserved += memory
            self._received += received
            self.limits.check_memory(self.reserved, self.vertices, self._received)

    @contextmanager
    def hold(self, memory: float) -> Iterator[None]:
        """Wait until others have given back what leaves room for some memory, and have it meanwhile."""
        self.check_fits(memory)
        with self._change:
            self._change.wait_for(lambda: self._held == 0.0 or self._has_room(memory))
            self._held += memory
        try:
            yield
        finally:
            with self._change:
                self._held -= memory
                self._change.notify_all()

    def check_fits(self, memory: float) -> None:
        """Raise `LimitError` if there is no room for some memory besides what is kept."""
        with self._change:
            self.limits.check_memory(self.reserved + memory, self.vertices, self._received)

    def _has_room(self, memory: float) -> bool:
        return self.reserved + self._held + memory <= self.limits.memory_for(self.vertices, self._received)
