"""Nanoseconds of a processor core and bytes of memory that a stream asks for, estimated before they are spent."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from threading import Condition, RLock

from bsm.bitstream.attributes.values import values_charge
from bsm.bitstream.fields.grid import AXES, grid_charge, levels_charge
from bsm.bitstream.limits import Limits, as_limits
from bsm.codec.basis.laplacian import Laplacian, factor_cost, iteration_memory, solve_cost
from bsm.codec.geometry.graph import Graph

BLOCK = 1.45e5  # of a block, whatever its size
ROW, LOOK, LEVEL = 600.0, 25.0, 90.0  # of a row of a block, of an edge that one has in the mesh, and of a coded level
COPY_MEMORY = 4  # bytes for each row of all blocks
ATTRIBUTE = 4e5  # of an attribute, however few values it has
RUN, MESH = 5e5, 2e6  # of a run of a sequence, and of one that brings a mesh, however small
DECLARED = 6e5  # of a map, which has few entries
CODED = 800.0  # of a byte of coded values
FRESH, MOST_FRESH = 2.0, 4e6
"""Of a vertex of the mesh for each chain, in memory that is fresh; beyond some size that costs nothing."""


FRAME_COST, BYTE_COST = 8e3, 8.0  # of reading a frame of the stream, whatever it is, and each of its bytes


def reading_cost(size: int) -> float:
    return FRAME_COST + BYTE_COST * size


def mesh_cost(vertices: int, faces: int, received: int) -> float:
    """Work of faces and graph; what meets at more vertices than a closed surface has was cut and is sewn again."""
    sewn = max(0.0, faces / 2.0 - vertices)
    return 140.0 * vertices + 85.0 * faces + 700.0 * sewn + 400.0 * received


def order_cost(vertices: int, faces: int, received: int) -> float:
    return 500.0 * vertices + 750.0 * faces + 100.0 * received


def partition_cost(graph: Graph, blocks: int, copies: int) -> float:
    """Work of cutting vertices into so many parts, and of growing these to so many copies together."""
    cut = graph.size + len(graph.neighbours)
    return cut * (4.0 * blocks.bit_length() + 20.0) + 2.0 * graph.size + 100.0 * blocks + 30.0 * copies


def run_cost(*, mesh: bool) -> float:
    return RUN + MESH * mesh


def labels_cost(graph: Graph, received: int) -> float:
    return 300.0 * graph.size + 30.0 * len(graph.neighbours) + 100.0 * received


def block_cost(rows: int, edges: int, levels: int) -> float:
    """Work of a block, except its dictionary."""
    return BLOCK + ROW * rows + LOOK * edges + LEVEL * levels


def ground_cost(laplacian: Laplacian, columns: int) -> float:
    """Work of extending what is known around a block, and of putting its coefficients on that."""
    return factor_cost(laplacian.fronts) + solve_cost(laplacian.fronts, 3) + 1.5 * len(laplacian.diagonal) * columns


def chain_cost(vertices: int) -> float:
    return min(FRESH * vertices, MOST_FRESH)


def mesh_memory(vertices: int, faces: int) -> float:
    return 200.0 * vertices + 60.0 * faces


def order_memory(vertices: int, faces: int) -> float:
    """Bytes for restoring the order that a mesh had, with copies of its vertices at up to every corner."""
    return 32.0 * vertices + 60.0 * faces


def block_memory(laplacian: Laplacian, columns: int) -> int:
    return iteration_memory(laplacian.fronts, columns)


def grid_cost(vertices: int, faces: int) -> float:
    return 1650.0 * vertices + 150.0 * faces


def light_cost(vertices: int, faces: int) -> float:
    return 200.0 * vertices + 40.0 * faces


def layer_cost(vertices: int, faces: int, axes: int) -> float:
    """Work of a layer of refinement or an attribute, before its bytes are counted."""
    return vertices * (400.0 + 230.0 * axes) + 130.0 * faces


def grid_chunk_cost(received: int) -> float:
    return 3.5e4 + CODED * received


def light_chunk_cost(received: int) -> float:
    return 5e4 + 120.0 * received


def chunk_cost(received: int, values: int = 0) -> float:
    """Work of a frame of a layer, or of an attribute of so many values, among which those that come are found."""
    return 8e4 + CODED * received + 2.0 * values


def floats_cost(vertices: int, largest: int) -> float:
    """Work of the floats behind a grid, before their bytes are counted."""
    return 400.0 * vertices + 4.0 * largest


def grid_memory(vertices: int, faces: int) -> float:
    return 80.0 * vertices + grid_charge(vertices, faces)


def layer_memory(vertices: int, faces: int) -> float:
    return (28.0 + 48.0 * AXES) * vertices + levels_charge(vertices, faces)


def seams_kept(vertices: int, faces: int, *, first: bool) -> float:
    """Bytes that stay of the seams of one more attribute; the first brings the corners of all."""
    return 3.0 * faces + (8.0 * vertices + 36.0 * faces if first else 0.0)


def seams_memory(vertices: int, faces: int) -> float:
    """Bytes for decoding the seams of an attribute, besides those that stay."""
    return 16.0 * vertices + 36.0 * faces


def seams_cost(vertices: int, faces: int, received: int) -> float:
    """Work of the seams of an attribute, and of joining corners between them, which is done twice."""
    return 5e4 + 10.0 * vertices + 120.0 * faces + CODED * received


def values_memory(values: int, faces: int, components: int) -> float:
    """Bytes that an attribute is kept in: its values as they come and as the user has them, and where they belong."""
    return 16.0 * components * values + 12.0 * values + 12.0 * faces


def recomputing_memory(values: int, faces: int) -> float:
    return 200.0 * faces + 100.0 * values


def values_cost(values: int, faces: int) -> float:
    """Work of arranging the values of an attribute, or of making normals again."""
    return ATTRIBUTE + 150.0 * values + 60.0 * faces


def coding_memory(values: int, faces: int, components: int) -> float:
    """Bytes for decoding an attribute, while its values come; large numbers are coded in two pieces."""
    return values_charge(values, faces, 2 * components, "normal")


class Allowance:
    """How much a decoder may still do; blocks of several chains draw on it at the same time."""

    def __init__(self, limits: Limits) -> None:
        self._limits = as_limits(limits)
        self._vertices = self._shown = self._gone = 0
        self._spent = self._owed = 0.0
        self._held = self._kept = 0.0
        self._received = 0
        self._lock = RLock()
        self._change = Condition(self._lock)

    @property
    def limits(self) -> Limits:
        return self._limits

    @property
    def vertices(self) -> int:
        return self._vertices

    @property
    def spent(self) -> float:
        return self._spent

    @property
    def kept(self) -> float:
        return self._kept

    def follow(self, other: Allowance) -> None:
        """Go on from what another has counted."""
        with self._lock:
            self._vertices, self._shown, self._gone = other._vertices, other._shown, other._gone
            self._spent, self._owed, self._received = other._spent, other._owed, other._received
            self._kept = other._kept

    def room(self, received: int = 0) -> float:
        """Bytes for which there is room besides those that are kept, with so many more received."""
        with self._lock:
            return self._limits.memory_for(self._present, self._received + received) - self._kept

    def grant(self, vertices: int) -> None:
        """Take note of vertices that the stream really has, which count for work and memory."""
        with self._lock:
            self._vertices += vertices

    def give_back(self, memory: float, vertices: int) -> None:
        """Take note of memory that was kept, and of vertices that are not there any more: they count for work alone."""
        with self._lock:
            self._kept -= memory
            self._gone += vertices

    def show(self, vertices: int) -> None:
        """Take note of vertices of frames that are shown, which count for work."""
        with self._lock:
            self._shown += vertices

    def spend(self, work: float, received: int = 0) -> None:
        """Take note of work to come, and of the bytes that ask for it."""
        limits = self._limits
        with self._lock:
            self._spent += work
            self._owed += max(0.0, work - limits.work_per_byte * received)
            limits.check("most_work", self._spent)
            limits.check_work(self._owed, self._vertices + self._shown)

    def keep(self, memory: float, received: int = 0) -> None:
        """Take note of memory that is kept to the end, and of bytes that stand for it."""
        with self._lock:
            self._kept += memory
            self._received += received
            self._limits.check_memory(self._kept, self._present, self._received)

    @contextmanager
    def hold(self, memory: float) -> Iterator[None]:
        """Wait until others have given back what leaves room for some memory, and have it meanwhile."""
        with self._lock:
            self._limits.check_memory(self._kept + memory, self._present, self._received)
            if self._held > 0.0:
                self._change.wait_for(lambda: self._held == 0.0 or self._has_room(memory))
            self._held += memory
        try:
            yield
        finally:
            with self._lock:
                self._held -= memory
                self._change.notify_all()

    def afford(self, memory: float) -> None:
        """Raise `LimitError` if there is no room for some memory besides what is kept."""
        with self._lock:
            self._limits.check_memory(self._kept + memory, self._present, self._received)

    @property
    def _present(self) -> int:
        return self._vertices - self._gone

    def _has_room(self, memory: float) -> bool:
        most = self._limits.memory_for(self._present, self._received)
        return self._kept + self._held + memory <= most
