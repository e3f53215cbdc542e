"""The filter of decoded positions, and the local frames of their refinement; the same for both sides.

Smoothing, by an amount that the stream carries, is not in the paper. Coefficients that were quantized or left out show
as roughness; a low-pass filter on the whole mesh takes most of it away. The filter is a polynomial of degree 5 in the
random-walk Laplacian K = I - D^-1 A, so a vertex depends on five rings around it only and can be finished while the
rest of the stream is still on its way.

Frames are smooth functions of the positions, and so of the surface: values coded in the frames of neighbors
can be predicted from each other, and rounding of positions only rounds frames.
"""

import numpy as np

from bsm._core import codec as _kernels
from bsm.codec.arrays import Faces, Levels, Matrix, Positions
from bsm.codec.geometry.graph import Graph


def smooth(graph: Graph, positions: Matrix, amount: float) -> Matrix:
    """Filter all positions, shape (n, 3); isolated vertices stay where they are."""
    # Without smoothing, no second copy of the positions is needed.
    if amount == 0.0:
        return positions
    positions = np.ascontiguousarray(positions)
    smoothed, scratch = np.empty(positions.shape), np.empty(2 * positions.size + 2)
    _kernels.smooth_all(graph.offsets, graph.neighbors, positions, amount, scratch, smoothed)
    return smoothed


def local_frames(positions: Positions, faces: Faces) -> Matrix:
    """Normal and two tangents of each vertex, orthonormal, shape (n, 9)."""
    frames = np.empty((len(positions), 9))
    _kernels.local_frames(
        np.ascontiguousarray(positions, np.float64), np.ascontiguousarray(faces, np.int32), frames
    )
    return frames


def raised(positions: Positions, frames: Matrix, levels: Levels, step: float) -> Positions:
    """Positions moved along the normals of frames, shape (n, 3)."""
    # A copy, since the kernel adds in place, and callers try several levels on the same positions.
    moved = np.array(positions, np.float64, order="C")
    _kernels.add_heights(moved, frames, np.ascontiguousarray(levels, np.int32), step)
    return moved


def slide(positions: Positions, frames: Matrix, levels: Levels, steps: Matrix) -> None:
    """Move positions along the tangents of frames, in place."""
    given = np.ascontiguousarray(levels, np.int32), np.ascontiguousarray(steps, np.float64)
    _kernels.add_slides(positions, frames, *given)


def tangent_steps(positions: Positions, faces: Faces, step: float, ratio: float) -> Matrix:
    """How far a level along a tangent moves each vertex, shape (n,); the same for encoder and decoder."""
    steps = np.empty(len(positions))
    given = np.ascontiguousarray(positions, np.float64), np.ascontiguousarray(faces, np.int32)
    _kernels.tangent_steps(*given, step, ratio, np.empty((len(positions), 8)), steps)
    return steps


def in_frames(offsets: Positions, frames: Matrix) -> Matrix:
    """Offsets, shape (n, 3), in the axes of frames, shape (n, 9): along the normal and the tangents, shape (n, 3)."""
    return np.asarray(np.einsum("nij,nj->ni", frames.reshape(-1, 3, 3), offsets))
