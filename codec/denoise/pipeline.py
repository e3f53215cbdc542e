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
    """Remove noise from the positions of a mesh; the faces stay."""
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
    """Remove noise from every frame of a sequence that shares its faces (section 7.3 of the paper)."""
    frames = np.ascontiguousarray(frames, dtype=np.float64)
    if frames.ndim != 3 or frames.shape[2] != 3 or len(frames) == 0:
        raise MeshError(f"frames must have shape (T, n, 3) with at least one frame, not {frames.shape}")
    denoiser = FrameDenoiser(frames[0], faces, options, goal=goal, strength=strength, force=force)
    return np.stack(list(denoiser(frames)))
