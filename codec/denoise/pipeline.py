"""The whole of denoising: coarse step, hand-over, fine step, for one mesh or for all frames of a sequence."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from bitstream.errors import MeshError, OptionError
from codec.denoise.automatic import LARGEST_KEEP, apply, choose, denoise_automatically
from codec.denoise.coarse import BLOCK_SIZE, KEEP, CoarseFilter
from codec.denoise.fine import fine_step
from codec.denoise.handover import hand_over
from codec.denoise.topology import Topology
from codec.mesh import Faces, Positions, TriangleMesh
from codec.parallel import ordered_map

Frames = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class DenoiseOptions:
    """How to denoise; the defaults are the paper's coarse-to-fine scheme.

    Parameters
    ----------
    hand_over : str
        "positions" (the paper's: the fine step sees the coarse mesh), "normals" (the noisy mesh, after a pass guided
        by the coarse mesh's normals) or "none" (no coarse step).
    fine : str
        Name of the fine step, see `codec.denoise.fine.FINE_STEPS`.
    iterations : int, optional
        Of the fine step; None: the method's own number, 0: only the coarse step.
    keep : float
        Fraction of each block's frequencies that the coarse step keeps.
    block_size : int
        Vertices of a block before overlap, about.

    Raises
    ------
    OptionError
        If a name is unknown or a number outside its range.
    """

    hand_over: str = "positions"
    fine: str = "guided"
    iterations: int | None = None
    keep: float = KEEP
    block_size: int = BLOCK_SIZE

    def __post_init__(self) -> None:
        hand_over(self.hand_over)
        fine_step(self.fine)
        if self.iterations is not None and self.iterations < 0:
            raise OptionError(f"iterations must not be negative, not {self.iterations}")
        if not 0.0 < self.keep <= 1.0 or self.block_size < 1:
            raise OptionError(
                f"keep must be above 0 and at most 1, block_size positive; not {self.keep}, {self.block_size}"
            )


def denoise(mesh: TriangleMesh, options: DenoiseOptions | None = None) -> TriangleMesh:
    """Remove noise from the positions of a mesh; the faces stay.

    Parameters
    ----------
    mesh : TriangleMesh
    options : DenoiseOptions, optional
        None: everything is chosen from the noisy mesh itself, see `codec.denoise.automatic`.
    """
    if options is None:
        positions, _ = denoise_automatically(mesh.positions, mesh.faces)
    else:
        positions = denoise_frames(mesh.positions[None], mesh.faces, options)[0]
    return TriangleMesh(positions, mesh.faces)


def denoise_frames(frames: Frames, faces: Faces, options: DenoiseOptions | None = None) -> Frames:
    """Remove noise from every frame of a sequence that shares its faces (section 7.3 of the paper).

    All frames pass the coarse step in one product per block, with one dictionary; the fine step runs on several
    frames at a time.

    Parameters
    ----------
    frames : ndarray of float64, shape (T, n, 3)
    faces : ndarray of int32, shape (m, 3)
    options : DenoiseOptions, optional
        None: settings are chosen on the first frame, and used for all of them.

    Returns
    -------
    ndarray of float64, shape (T, n, 3)

    Raises
    ------
    MeshError
        If there is no frame, or the shape is wrong.
    """
    frames = np.ascontiguousarray(frames, dtype=np.float64)
    if frames.ndim != 3 or frames.shape[2] != 3 or len(frames) == 0:
        raise MeshError(f"frames must have shape (T, n, 3) with at least one frame, not {frames.shape}")
    n = frames.shape[1]
    topology = Topology(faces, n)
    if options is None:
        shared = CoarseFilter(faces, n, LARGEST_KEEP)
        choice = choose(frames[0], shared, topology)
        return np.stack(list(ordered_map(lambda frame: apply(choice, frame, shared, topology), frames, None)))

    start, step = hand_over(options.hand_over), fine_step(options.fine)
    smooth = frames if options.hand_over == "none" else coarse_frames(frames, faces, options.keep, options.block_size)

    def finish(pair: tuple[Positions, Positions]) -> Positions:
        begun = start(pair[0], pair[1], topology)
        return step(begun, faces) if options.iterations is None else step(begun, faces, options.iterations)

    return np.stack(list(ordered_map(finish, zip(frames, smooth), None)))


def coarse_frames(frames: Frames, faces: Faces, keep: float = KEEP, block_size: int = BLOCK_SIZE) -> Frames:
    """The coarse step alone, for frames of shape (T, n, 3): one dictionary, one matrix product per block."""
    count, n, _ = frames.shape
    columns = np.ascontiguousarray(frames.transpose(1, 0, 2)).reshape(n, 3 * count)
    smooth = CoarseFilter(faces, n, keep, block_size)(columns, keep)
    return np.ascontiguousarray(smooth.reshape(n, count, 3).transpose(1, 0, 2))
