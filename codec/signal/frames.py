"""The local frame of each vertex of a decoded mesh, and displacements in it; the same for encoder and decoder.

Frames are smooth functions of the positions, and so they are of the surface: what is coded in the frames of neighbours
can be predicted from one to the other, and rounding of positions only rounds frames.
"""

from __future__ import annotations

import numpy as np

from bsm.codec import _kernels
from bsm.codec.arrays import Faces, Levels, Matrix, Positions


def local_frames(positions: Positions, faces: Faces) -> Matrix:
    """Normal and two tangents of each vertex, orthonormal, shape (n, 9).

    Parameters
    ----------
    positions : float64 array, shape (n, 3)
        In BSM units.
    faces : int32 array, shape (m, 3)
    """
    frames = np.empty((len(positions), 9))
    _kernels.local_frames(np.ascontiguousarray(positions, np.float64), np.ascontiguousarray(faces, np.int32), frames)
    return frames


def displaced(positions: Positions, frames: Matrix, levels: Levels, step: float, ratio: float) -> Positions:
    """Positions moved by levels along the axes of frames, shape (n, 3).

    Parameters
    ----------
    positions : float64 array, shape (n, 3)
    frames : float64 array, shape (n, 9)
        Those of the base, whatever was added to it since.
    levels : int32 array, shape (n, 1) or (n, 3)
        Along the normal, and along the tangents.
    step, ratio : float
        A level along the normal, and how many times as much one along a tangent is.
    """
    moved = np.array(positions, np.float64, order="C")
    displace(moved, frames, levels, step, ratio)
    return moved


def displace(positions: Positions, frames: Matrix, levels: Levels, step: float, ratio: float) -> None:
    """`displaced` in place: `positions`, shape (n, 3), `frames`, (n, 9), and `levels`, (n, 1) or (n, 3), as there."""
    _kernels.add_levels(positions, frames, np.ascontiguousarray(levels, np.int32), step, ratio)


def in_frames(offsets: Positions, frames: Matrix) -> Matrix:
    """Offsets, shape (n, 3), in the axes of frames, shape (n, 9): along the normal and the tangents, shape (n, 3)."""
    return np.asarray(np.einsum("nij,nj->ni", frames.reshape(-1, 3, 3), offsets))
