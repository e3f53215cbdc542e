"""Sequences (section 7.3 of the paper): settings and dictionaries once, then any number of frames, a few at a time."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import islice

import numpy as np
import numpy.typing as npt

from bitstream.errors import MeshError
from codec.denoise.automatic import LARGEST_KEEP, AutomaticChoice, apply, choose
from codec.denoise.coarse import BLOCK_SIZE, KEEP, CoarseFilter
from codec.denoise.filters.fine import fine_step
from codec.denoise.filters.topology import Topology
from codec.denoise.handover import hand_over
from codec.denoise.options import DenoiseOptions
from codec.geometry.mesh import Faces, Positions
from codec.threads import ordered_map

Frames = npt.NDArray[np.float64]

GROUP = 8
"""Frames that pass the coarse step together: enough for a matrix product, few enough for any memory."""


@dataclass(frozen=True, eq=False)
class _Chosen:
    """What the automatic mode settled on."""

    choice: AutomaticChoice
    topology: Topology

    @property
    def keep(self) -> float | None:
        return None if self.choice.recipe is None else self.choice.recipe.keep

    def finish(self, noisy: Positions, smooth: Positions) -> Positions:
        return apply(self.choice, noisy, smooth, self.topology)


@dataclass(frozen=True, eq=False)
class _Given:
    """What the caller asked for."""

    options: DenoiseOptions
    topology: Topology

    @property
    def keep(self) -> float | None:
        return None if self.options.hand_over == "none" else self.options.keep

    def finish(self, noisy: Positions, smooth: Positions) -> Positions:
        start, step = hand_over(self.options.hand_over), fine_step(self.options.fine)
        begun = start(noisy, smooth, self.topology)
        count = self.options.iterations
        return step(begun, self.topology.faces) if count is None else step(begun, self.topology.faces, count)


class FrameDenoiser:
    """Denoises frames that share their faces; what depends on the faces alone is computed once.

    Parameters
    ----------
    first : ndarray of float64, shape (n, 3)
        The frame on which settings are chosen where there are no options.
    faces : ndarray of int32, shape (m, 3)
    options : DenoiseOptions, optional
        None: chosen from the noise of the first frame, see `codec.denoise.automatic`.

    Attributes
    ----------
    choice : AutomaticChoice, optional
        What was chosen; None where options were given.

    Raises
    ------
    MeshError
        If `first` is not of shape (n, 3), or has a coordinate that is not finite.
    """

    def __init__(self, first: Positions, faces: Faces, options: DenoiseOptions | None = None) -> None:
        first = np.ascontiguousarray(first, dtype=np.float64)
        if first.ndim != 2 or first.shape[1] != 3:
            raise MeshError(f"a frame must have shape (n, 3), not {first.shape}")
        self._shape = first.shape
        first = self._checked(first)
        topology = Topology(faces, len(first))
        self.choice: AutomaticChoice | None = None
        self._coarse: CoarseFilter | None = None
        self._way: _Chosen | _Given
        if options is None:
            self._coarse = CoarseFilter(faces, len(first), LARGEST_KEEP)
            self.choice = choose(first, self._coarse, topology)
            self._way = _Chosen(self.choice, topology)
        else:
            self._way = _Given(options, topology)
            if self._way.keep is not None:
                self._coarse = CoarseFilter(faces, len(first), options.keep, options.block_size)

    def __call__(self, frames: Iterable[Positions]) -> Iterator[Positions]:
        """Denoise frame after frame, holding only a few of them at any time.

        Raises
        ------
        MeshError
            If a frame has another shape than the first one, or a coordinate that is not finite.
        """
        yield from ordered_map(lambda pair: self._way.finish(*pair), self._pairs(frames), None)

    def _pairs(self, frames: Iterable[Positions]) -> Iterator[tuple[Positions, Positions]]:
        """Noisy and coarse positions of every frame; the coarse step takes `GROUP` frames at once."""
        source = iter(frames)
        while group := [self._checked(frame) for frame in islice(source, GROUP)]:
            keep = self._way.keep
            if keep is None or self._coarse is None:
                yield from zip(group, group)
            else:
                noisy = np.stack(group)
                yield from zip(noisy, filter_frames(self._coarse, noisy, keep))

    def _checked(self, frame: Positions) -> Positions:
        if frame.shape != self._shape:
            raise MeshError(f"a frame has shape {frame.shape}, the first one {self._shape}")
        if not np.isfinite(frame).all():
            raise MeshError("a frame has a coordinate that is not finite; remove or repair it")
        return np.ascontiguousarray(frame, dtype=np.float64)


def filter_frames(coarse: CoarseFilter, frames: Frames, keep: float) -> Frames:
    """The coarse step for frames of shape (T, n, 3): one matrix product per block for all of them."""
    count, n, _ = frames.shape
    columns = np.ascontiguousarray(frames.transpose(1, 0, 2)).reshape(n, 3 * count)
    return np.ascontiguousarray(coarse(columns, keep).reshape(n, count, 3).transpose(1, 0, 2))


def coarse_frames(frames: Frames, faces: Faces, keep: float = KEEP, block_size: int = BLOCK_SIZE) -> Frames:
    """The coarse step alone, for frames of shape (T, n, 3)."""
    return filter_frames(CoarseFilter(faces, frames.shape[1], keep, block_size), frames, keep)
