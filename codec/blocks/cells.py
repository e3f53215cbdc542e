"""Cells of a mesh, the graph that blocks lie on one level up, and places of cells spread to vertices by smoothing.

A cell is a center and the vertices that are nearest to it by edges; centers are more than some edges apart. Both sides
find the same cells, since they see nothing but faces. Two cells are neighbors if vertices of them are; faces of cells
are those of the mesh whose corners are in three cells, and only give the local frames of cells.
"""

from dataclasses import dataclass

import numpy as np

from bsm._core import codec as _kernels
from bsm.codec.arrays import Faces, Indices, Matrix
from bsm.codec.geometry.graph import Graph


@dataclass(frozen=True, eq=False)
class CellMesh:
    """The cell of each vertex, the graph of the cells, and their faces."""

    own: Indices
    graph: Graph
    faces: Faces


def cells_of(graph: Graph, faces: Faces, reach: int) -> CellMesh:
    """Cells of the vertices at most `reach` edges from their centers."""
    own, waiting = np.empty(graph.size, np.int32), np.empty(graph.size, np.int32)
    # Distances are below 256, since the reach is a few edges. One byte each keeps them in the cache of the processor.
    far, ends = np.empty(graph.size, np.uint8), len(graph.neighbors) + 1
    count = _kernels.find_cells(graph.offsets, graph.neighbors, reach, far, waiting, own)
    # A graph of cells has at most the edges of the mesh, so this memory is enough for it before its size is known.
    bounds, links, filled = (np.empty(size, np.int32) for size in (count + 1, count + 1, count))
    found, linked = np.empty(ends, np.int32), np.empty(ends, np.int32)
    given = graph.offsets, graph.neighbors, own, bounds, waiting, filled, found, links, linked
    kept = _kernels.link_cells(*given)
    triples, rows = np.empty((len(faces), 3), np.int32), np.empty((len(faces), 3), np.int32)
    order, room = np.empty(len(faces), np.int32), np.empty(len(faces), np.int32)
    last = _kernels.cell_faces(np.ascontiguousarray(faces, np.int32), own, bounds, triples, order, room, rows)
    # Copies, so that the buffers of the size of the mesh go.
    return CellMesh(own, Graph(links, linked[:kept].copy()), rows[:last].copy())


def prolonged(cells: CellMesh, graph: Graph, places: Matrix, rounds: int) -> Matrix:
    """Positions of the vertices, shape (n, 3), from those of their cells; the same for encoder and decoder."""
    # Single precision in between: a decoder does this for every scan, and the final levels are measured from its
    # result.
    positions, room = np.empty((graph.size, 3)), np.empty(8 * graph.size, np.float32)
    _kernels.prolong(graph.offsets, graph.neighbors, cells.own, np.ascontiguousarray(places), rounds, room, positions)
    return positions


STEPS = 10  # of conjugate gradients; forty come to the same bytes


def fitted(cells: CellMesh, graph: Graph, positions: Matrix, rounds: int) -> Matrix:
    """Places of cells, shape (m, 3), that are prolonged to about the positions of the vertices, shape (n, 3)."""
    places, coarse = np.empty((cells.graph.size, 3)), cells.graph
    # The matrix is never made: each step of conjugate gradients applies the smoothing, and its transpose, to vectors.
    room = np.empty(12 * graph.size + 28 * coarse.size, np.float32)
    given = graph.offsets, graph.neighbors, cells.own, coarse.offsets, coarse.neighbors
    _kernels.fit_cells(*given, np.ascontiguousarray(positions), rounds, STEPS, room, places)
    return places
