"""Bilateral mesh denoising (Fleishman, Drori, Cohen-Or 2003): vertices move along their normals."""

from __future__ import annotations

import numpy as np

from bsm.codec import _kernels
from bsm.codec.arrays import Faces, Positions
from bsm.codec.denoise.filters.reach import reach, themselves
from bsm.codec.denoise.filters.topology import Topology
from bsm.codec.denoise.filters.vertex_update import Floats, face_geometry, vertex_normals
from bsm.codec.geometry.incidence import Rows


def bilateral_mesh_denoising(positions: Positions, faces: Faces, iterations: int = 5) -> Positions:
    """Denoise by a bilateral filter of heights over the tangent planes."""
    positions = np.ascontiguousarray(positions, dtype=np.float64)
    topology = Topology(faces, len(positions))
    own = themselves(len(positions))
    for _ in range(iterations):
        normals = vertex_normals(face_geometry(positions, faces).normals, topology.around)
        width = shortest_edges(positions, topology.neighbours)
        near = reach(positions, own, positions, topology.neighbours, 2.0 * width)
        moved = np.empty_like(positions)
        _kernels.filter_heights(positions, normals, width, *near, moved)
        positions = moved
    return positions


def shortest_edges(positions: Positions, neighbours: Rows) -> Floats:
    """Length of the shortest edge at each vertex, shape (n,); 0 where there is none."""
    lengths = np.empty(len(positions))
    _kernels.shortest_edges(positions, neighbours.starts, neighbours.members, lengths)
    return lengths
