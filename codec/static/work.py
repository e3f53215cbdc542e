"""Nanoseconds of a processor core and bytes of memory that decoders estimate a stream to take, for encoders."""

from dataclasses import dataclass

from bsm.codec.basis.laplacian import Laplacian, factor_cost, iteration_memory, solve_cost

BLOCK = 1.45e5  # of a block, whatever its size
ROW, LOOK, LEVEL = 600.0, 25.0, 90.0  # of a row of a block, of an edge that one has in the mesh, and of a coded level


def block_cost(rows: int, edges: int, levels: int) -> float:
    """Work of a block, except its dictionary."""
    return BLOCK + ROW * rows + LOOK * edges + LEVEL * levels


def ground_cost(laplacian: Laplacian, columns: int) -> float:
    """Work of extending known vertices into a block, and of adding its coefficients."""
    return factor_cost(laplacian.fronts) + solve_cost(laplacian.fronts, 3) + 1.5 * len(laplacian.diagonal) * columns


def mesh_memory(vertices: int, faces: int) -> float:
    return 200.0 * vertices + 60.0 * faces


def block_memory(laplacian: Laplacian, columns: int) -> int:
    return iteration_memory(laplacian.fronts, columns)


@dataclass
class Kept:
    """What decoders have of a stream: vertices, the memory that their meshes take, and the bytes that have arrived."""

    vertices: int = 0
    memory: float = 0.0
    received: int = 0
