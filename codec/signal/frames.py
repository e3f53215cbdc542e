"""The local frame of each vertex of a decoded mesh, and displacements in it; the same for encoder and decoder.

Frames are smooth functions of the positions, and so they are of the surface: what is coded in the frames of neighbours
can be predicted from one to the other, and rounding of positions only rounds frames.
"""

import numpy as np

from bsm.codec import _kernels
from bsm.codec.arrays import Faces, Levels, Matrix, Positions


def local_frames(positions: Positions, faces: Faces) -> Matrix:
    """Normal and two tangents of each vertex, orthonormal, shape (n, 9)."""
    frames = np.empty((len(positions), 9))
    _kernels.local_frames(np.ascontiguousarray(positions, np.float64), np.ascontiguousarray(faces, np.int32), frames)
    return frames


def raised(positions: Positions, frames: Matrix, levels: Levels, step: float) -> Positions:
    """Positions moved along the normals of frames, shape (n, 3)."""
    moved = np.array(positions, np.float64, order="C")
    lift(moved, frames, levels, step)
    return moved


def lift(positions: Positions, frames: Matrix, levels: Levels, step: float) -> None:
    """`raised` in place: `positions`, shape (n, 3), `frames`, (n, 9), and `levels`, (n, 1) or (n, 3), as there."""
    _kernels.add_heights(positions, frames, np.ascontiguousarray(levels, np.int32), step)


def slide(positions: Positions, frames: Matrix, levels: Levels, steps: Matrix) -> None:
    """Move positions along the tangents of frames, in place."""
    given = np.ascontiguousarray(levels, np.int32), np.ascontiguousarray(steps, np.float64)
    _kernels.add_slides(positions, frames, *given)


def tangent_steps(positions: Positions, faces: Faces, step: float, ratio: float) -> Matrix:
    """What a level along a tangent moves each vertex, shape (n,); the same for encoder and decoder."""
    steps = np.empty(len(positions))
    given = np.ascontiguousarray(positions, np.float64), np.ascontiguousarray(faces, np.int32)
    _kernels.tangent_steps(*given, step, ratio, np.empty((len(positions), 8)), steps)
    return steps


def in_frames(offsets: Positions, frames: Matrix) -> Matrix:
    """Offsets, shape (n, 3), in the axes of frames, shape (n, 9): along the normal and the tangents, shape (n, 3)."""
    return np.asarray(np.einsum("nij,nj->ni", frames.reshape(-1, 3, 3), offsets))
