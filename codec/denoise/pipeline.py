"""The whole of denoising: coarse step, hand-over, fine step, for one mesh or for all frames of a sequence."""

from __future__ import annotations

import numpy as np

from bsm.bitstream.errors import MeshError
from bsm.codec.arrays import Faces
from bsm.codec.denoise.frames import FrameDenoiser, Frames
from bsm.codec.denoise.options import DenoiseOptions
from bsm.codec.denoise.rehearsal import Told, silent
from bsm.codec.geometry.mesh import TriangleMesh


def denoise(
    mesh: TriangleMesh,
    options: DenoiseOptions | None = None,
    *,
    goal: str = "shading",
    strength: float = 1.0,
    force: bool = False,
    told: Told = silent,
) -> TriangleMesh:
    """Remove noise from the positions of a mesh; the faces stay.

    Parameters
    ----------
    mesh : TriangleMesh
    options : DenoiseOptions, optional
        None: everything is chosen from the noisy mesh itself, see `codec.denoise.automatic`; a mesh in which no noise
        is found comes back bit for bit.
    goal : str
        What the automatic mode strives for: "shading" (normals near the clean ones) or "shape" (vertices).
    strength : float
        How much of every movement is made, from 0 to 1.
    force : bool
        Let the options have their way even where they do harm.
    told : callable
        Called with the name of each stage.

    Raises
    ------
    HarmError
        If the options would make the mesh worse.
    """
    denoiser = FrameDenoiser(mesh.positions, mesh.faces, options, goal=goal, strength=strength, force=force, told=told)
    (positions,) = denoiser([mesh.positions])
    return mesh.moved(positions)[0]


def denoise_frames(
    frames: Frames,
    faces: Faces,
    options: DenoiseOptions | None = None,
    *,
    goal: str = "shading",
    strength: float = 1.0,
    force: bool = False,
) -> Frames:
    """Remove noise from every frame of a sequence that shares its faces (section 7.3 of the paper).

    `FrameDenoiser` does the same for sequences too long for the memory.

    Parameters
    ----------
    frames : ndarray of float64, shape (T, n, 3)
    faces : ndarray of int32, shape (m, 3)
    options : DenoiseOptions, optional
        None: noise that changes from frame to frame is removed in time first, then settings are chosen on the first
        frame, and used for all of them.
    goal, strength, force
        As in `denoise`.

    Returns
    -------
    ndarray of float64, shape (T, n, 3)

    Raises
    ------
    MeshError
        If there is no frame, or the shape is wrong.
    HarmError
        If the options would make a frame worse.
    """
    frames = np.ascontiguousarray(frames, dtype=np.float64)
    if frames.ndim != 3 or frames.shape[2] != 3 or len(frames) == 0:
        raise MeshError(f"frames must have shape (T, n, 3) with at least one frame, not {frames.shape}")
    denoiser = FrameDenoiser(frames[0], faces, options, goal=goal, strength=strength, force=force)
    return np.stack(list(denoiser(frames)))
