"""The dictionaries of a sequence, and the way between vertices and coefficients."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Basis, Faces, Indices, Matrix, Positions
from bsm.codec.basis.laplacian import Factor, Held, cotangent_weights, hold
from bsm.codec.blocks.overlap import Blocks
from bsm.codec.signal.chain import ChainRules, Suspended, continued, key_dictionary
from bsm.codec.signal.transform import project, reconstruct
from bsm.codec.static.work import Budget, block_memory
from bsm.codec.threads import ordered_map

TETHER = 2.0**-16  # stiffness with which every row hangs on the mean of the pulls; it places what no spring reaches
SITE_MEMORY, ROW_MEMORY = 6000.0, 352.0
"""Bytes of what is known of a part besides its factor, whatever its size and for each row."""
SPARE = 4.0 * 2**20  # bytes that no dictionary is kept in, though they are granted

Result = TypeVar("Result")


@dataclass(frozen=True, eq=False)
class Site:
    """A part of the mesh before it has its dictionary."""

    held: Held
    factor: Factor
    width: int

    @property
    def vertices(self) -> Indices:
        """Vertex of the mesh behind each row, shape (n_i,)."""
        return self.held.laplacian.block.vertices

    @property
    def memory(self) -> float:
        return 8.0 * len(self.vertices) * self.width

    @property
    def making(self) -> float:
        """Bytes for making its dictionary, that itself included."""
        return block_memory(self.held.laplacian, self.width)

    @property
    def around(self) -> Indices:
        """Vertices of the mesh, shape (k_i,), of parts before, with edges to this one."""
        return self.held.around

    def extend(self, ends: Matrix) -> Matrix:
        """Rows, shape (n_i, m), that continue a field, of which `ends`, shape (k_i, m), is what it is around."""
        return continued(self.factor, self.held.springs, self.held.pulls(ends))

    def dictionary(self, rules: ChainRules) -> Basis:
        return key_dictionary(rules, Suspended(self.held.laplacian, self.held.springs, rules.shift), self.width)


@dataclass(frozen=True, eq=False)
class Part:
    """A part of the mesh and its dictionary."""

    site: Site
    basis: Basis

    @property
    def vertices(self) -> Indices:
        """Vertex of the mesh behind each row, shape (n_i,)."""
        return self.site.vertices

    def coefficients(self, values: Matrix, ends: Matrix) -> Matrix:
        """Coefficients, shape (c_i, m), of values here, shape (n_i, m), less what those around, (k_i, m), tell."""
        return project(self.basis, values - self.site.extend(ends), self.basis.shape[1])

    def difference(self, wanted: Matrix, field: Matrix) -> Matrix:
        """Coefficients, shape (c_i, m), of what a field is wanted to be here less what the parts before let expect."""
        return self.coefficients(wanted[self.vertices], field[self.site.around])

    def place(self, field: Matrix, difference: Matrix) -> None:
        """Fill this part of a field from its difference to the extension, shape (c_i, m)."""
        field[self.vertices] = reconstruct(self.basis, difference) + self.site.extend(field[self.site.around])


class Dictionaries:
    """Dictionaries of all parts: kept of the first ones, as many as there is room for, and made again of the others."""

    def __init__(self, sites: tuple[Site, ...], rules: ChainRules, budget: Budget, threads: int | None = None) -> None:
        self.sites = sites
        self._rules = rules
        self._budget = budget
        self._threads = threads
        self._parts: list[Part | None] = [None] * len(sites)
        self._kept = 0
        self._reserved = self._use = 0.0

    @property
    def largest(self) -> int:
        return max(len(site.vertices) for site in self.sites)

    @cached_property
    def _sizes(self) -> Matrix:
        return np.cumsum([0.0, *(site.memory for site in self.sites)])

    @cached_property
    def _making(self) -> float:
        return max(site.making for site in self.sites)

    def release(self) -> None:
        """Keep none until room is reserved again."""
        self._budget.reserve(-self._reserved)
        self._reserved = self._use = 0.0
        self._parts = [None] * len(self.sites)
        self._kept = 0

    def fits(self, memory: float, use: float, received: int = 0) -> bool:
        """Return whether `reserve` fits when this many more bytes have arrived."""
        room = self._room(memory, use, received)
        return self._making_beside(room) <= room

    def reserve(self, memory: float = 0.0, use: float = 0.0) -> None:
        """Have room for what comes next, and keep as many dictionaries as there is room for besides."""
        room = self._room(memory, use)
        making = self._making_beside(room)
        self._budget.check_fits(self._budget.room() - room + making)
        count = int(np.searchsorted(self._sizes, room - making, side="right")) - 1
        held = memory + float(self._sizes[count])
        self._budget.reserve(held - self._reserved)
        self._reserved, self._use = held, use
        self._parts[count:] = [None] * (len(self.sites) - count)
        self._kept = count

    def _room(self, memory: float, use: float, received: int = 0) -> float:
        return self._budget.room(received) + self._reserved - memory - use - SPARE

    def _making_beside(self, room: float) -> float:
        return 0.0 if all(self._parts) and self._sizes[-1] <= room else self._making

    def each(self, use: Callable[[int, Part], Result]) -> Iterator[Result]:
        """What `use` gives for the number of each part and the part, in their order."""
        threads = 1 if all(self._parts) else self._threads
        return ordered_map(lambda index: self._used(index, use), range(len(self.sites)), threads)

    def in_order(self) -> Iterator[Part]:
        """One part after the other, each there until the next is asked for."""
        if self._kept == len(self.sites):  # others would pile up, and nobody count them
            yield from self.each(lambda _, part: part)
            return
        for index in range(len(self.sites)):
            with self._lent(index) as part:
                yield part

    def _used(self, index: int, use: Callable[[int, Part], Result]) -> Result:
        with self._lent(index) as part:
            return use(index, part)

    @contextmanager
    def _lent(self, index: int) -> Iterator[Part]:
        part = self._parts[index]
        if part is not None:
            yield part
            return
        with self._budget.hold(self.sites[index].making + self._use):
            part = Part(self.sites[index], self.sites[index].dictionary(self._rules))
            if index < self._kept:
                self._parts[index] = part
            yield part


def find_sites(
    blocks: Blocks, faces: Faces, first_frame: Positions, *, width: int, threads: int | None, budget: Budget
) -> tuple[Site, ...]:
    """What the dictionary of every part follows from, with weights from the decoded first frame."""
    graph = blocks.graph
    weights = cotangent_weights(graph, faces, first_frame)
    rank = np.empty(graph.size, np.int32)
    for index in range(blocks.count):
        rank[blocks.core(index)] = index

    def find(index: int) -> Site:
        size = len(blocks.core(index))
        held = hold(graph, weights, rank, blocks.part(index))
        fronts = held.laplacian.fronts
        budget.reserve(SITE_MEMORY + ROW_MEMORY * size + 8.0 * int(fronts.places[-1]))
        return Site(held, Suspended(held.laplacian, held.springs, TETHER).factor, min(width, size))

    return tuple(ordered_map(find, range(blocks.count), threads))
