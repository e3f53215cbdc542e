"""The detail layer: what the coefficients of x, y and z leave out, kept along the normal alone.

Not in the paper. How a surface looks is decided by how far it stands out, hardly by where on it the vertices sit. So
beyond the lowest frequencies only one number per frequency is coded, not three: with b the block decoded so far, m its
vertex normals and v the original, the displacement h = m . (v - b) has the coefficients U^T h, and the block becomes
b + m (U U^T h). Their step is finer than that of x, y and z, and they reach to higher frequencies.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from bsm.codec import _kernels
from bsm.codec.arrays import Faces, Indices, Levels, Matrix, Order
from bsm.codec.blocks.overlap import Block
from bsm.codec.geometry.graph import vertex_faces

Number = TypeVar("Number", bound=np.generic)

SOFTNESS = 2.0**-10
"""Below this share of the usual length of a sum of face normals, as where they cancel, a normal is shorter than 1."""

LEAST = 2.0**-33
"""The same in BSM units: sums of normals that are no longer are rounding, on which decoders need not agree."""


@dataclass(frozen=True, eq=False)
class Surface:
    """Faces, and which of them are around each vertex."""

    faces: Faces
    starts: Order
    members: Indices


def make_surface(faces: Faces, size: int) -> Surface:
    """Surface of `faces`, shape (m, 3), on `size` vertices."""
    return Surface(faces, *vertex_faces(faces, size))


class Normals:
    """Vertex normals of one block after another."""

    def __init__(self, surface: Surface) -> None:
        self._surface = surface
        # One more than the row of each vertex; zeros cost memory only where they are touched.
        self._place = np.zeros(len(surface.starts) - 1, np.int32)

    def of(self, block: Block, positions: Matrix) -> Matrix:
        """Normals at a block's rows, shape (n_i, 3), from its own positions and the faces that lie inside it."""
        surface = self._surface
        if positions.shape != (block.size, 3):
            raise ValueError(f"positions of shape {positions.shape} for a block of {block.size} vertices")
        normals, places = np.empty((block.size, 3)), self._place
        _kernels.block_normals(
            surface.faces,
            surface.starts,
            surface.members,
            block.vertices,
            places,
            np.ascontiguousarray(positions),
            SOFTNESS,
            LEAST,
            normals,
        )
        return normals

    def raise_block(
        self, block: Block, subspace: Matrix, levels: Levels, count: int, step: float, positions: Matrix
    ) -> None:
        """Make positions b, shape (n_i, 3), C-contiguous, b + m (U e)."""
        surface, size = self._surface, block.size
        _kernels.raise_block(
            surface.faces,
            surface.starts,
            surface.members,
            block.vertices,
            self._place,
            SOFTNESS,
            LEAST,
            subspace,
            levels,
            count,
            step / 2,
            np.empty(4 * size + count),
            positions,
        )


def fold_details(levels: npt.NDArray[Number]) -> npt.NDArray[Number]:
    """Levels of successive frequencies, shape (d,), as rows of three, the last one filled up with zeros."""
    folded = np.zeros((-(-len(levels) // 3), 3), levels.dtype)
    folded.reshape(-1)[: len(levels)] = levels
    return folded
