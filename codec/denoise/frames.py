"""The whole of denoising, of a mesh or a sequence (section 7.3 of the paper): choice and dictionaries once."""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import chain, count, islice
from typing import Any

import numpy as np

from bsm.bitstream.errors import HarmError, MeshError, OptionError
from bsm.codec.arrays import Faces, Positions
from bsm.codec.choices import checked, named
from bsm.codec.denoise.automatic import STAGES, AutomaticChoice, choose, judge, treat
from bsm.codec.denoise.coarse import FEWEST_FRAMES, RULES, CoarseFilter, TemporalFilter, by_lengths
from bsm.codec.denoise.filters import HAND_OVERS, WITHOUT_COARSE, DenoiseOptions, Filters
from bsm.codec.denoise.learnt import learnt
from bsm.codec.denoise.noise.causes import weld_seams
from bsm.codec.denoise.noise.finding import Finding
from bsm.codec.denoise.noise.outliers import calm
from bsm.codec.denoise.noise.search import FAINTEST, find_noise
from bsm.codec.denoise.paper import oi_rules
from bsm.codec.denoise.rehearsal import GOALS, Progress
from bsm.codec.denoise.surface import FINE_STEPS, GuidedFilter
from bsm.codec.denoise.variation import varied_little
from bsm.codec.geometry.mesh import TriangleMesh, require_sizes
from bsm.codec.geometry.metrics import mean_edge_length
from bsm.codec.threads import ordered_map

Pair = tuple[Positions, Positions]

# Frames that the temporal filter sees at once, if they fit: few have few frequencies over time.
WINDOW = 64
WINDOW_BYTES = 2**28
CHANGING = "noise that changes with the frames"


class FrameDenoiser:
    """Denoises frames that share their faces; everything that depends only on the faces is computed once."""

    def __init__(
        self,
        first: Positions,
        faces: Faces,
        options: DenoiseOptions | None = None,
        *,
        goal: str = "shading",
        strength: float = 1.0,
        force: bool = False,
        progress: Progress = lambda stage, share: None,
    ) -> None:
        named("goal", GOALS, goal)
        if not 0.0 <= checked("strength", strength, float) <= 1.0:
            raise OptionError(f"the strength must be from 0 to 1, not {strength}")
        first = np.ascontiguousarray(first, dtype=np.float64)
        if first.ndim != 2 or first.shape[1] != 3:
            raise MeshError(f"a frame must have shape (n, 3), not {first.shape}")
        self._shape = first.shape
        first = self._checked(first)
        # Copies of a vertex must move together, or the surface tears along its seams.
        welded, faces, self._index = weld_seams(first, faces)
        self._members = np.unique(self._index, return_index=True)[1]
        self._surface = Filters(faces, len(welded))
        self._options, self._goal, self._strength, self._force = options, goal, strength, force
        self._progress = progress
        self.choice: AutomaticChoice | None = None

    def __call__(self, frames: Iterable[Positions]) -> Iterator[Positions]:
        """Denoise frame after frame, with a few of them in memory at any time."""
        checked = map(self._checked, frames)
        results = (
            self._automatic(checked)
            if self._options is None
            else self._by_options(checked, self._options)
        )
        for measured, result in results:
            originals = measured[self._members]
            moved = (result != originals).any(axis=1)[self._index]
            # In this order, copies at one place stay together to the last bit.
            displaced = result[self._index] + (measured - originals[self._index])
            if self._strength < 1.0:
                displaced = measured + self._strength * (displaced - measured)
            yield np.where(moved[:, None], displaced, measured)

    def _automatic(self, frames: Iterator[Positions]) -> Iterator[Pair]:
        finding: Finding | None = None
        choice: AutomaticChoice | None = None
        begun: Positions | None = None

        def finish(pair: Pair) -> tuple[Pair, AutomaticChoice]:
            measured, welded = pair
            assert choice is not None and finding is not None
            # The first frame was calmed when the choice was made.
            if choice.outliers and welded is not begun:
                welded = calm(welded, self._surface.probe)[1]
            result, outcome = treat(choice, welded, finding, self._surface, self._strength)
            return (measured, result), outcome

        for group, remaining in self._steadied(frames):
            if finding is None:
                begun = group[0][1]
                self._progress("finding noise", 0.0)
                if remaining is None:
                    outliers, begun, finding = calm(begun, self._surface.probe)
                    group[0] = group[0][0], begun
                    choice = choose(
                        begun, finding, self._surface, self._goal, self._progress
                    ).after(outliers)
                else:
                    finding = find_noise(begun, self._surface.probe)
                    # What the temporal filter leaves is known in strength, even where the mesh does not show it.
                    if remaining >= FAINTEST * finding.edge:
                        finding = Finding(
                            "unsteady",
                            remaining,
                            np.full(len(begun), remaining),
                            finding.edge,
                            CHANGING,
                        )
                    goal = "both" if self._goal == "shading" else self._goal
                    choice = choose(begun, finding, self._surface, goal, self._progress)
                    choice = (
                        choice
                        if choice.steps
                        else replace(choice, kind="unsteady", reason=CHANGING)
                    )
                self._progress("filtering", (STAGES - 1) / STAGES)
            for pair, outcome in ordered_map(finish, group, None):
                self.choice = self.choice or outcome  # of the first frame
                yield pair

    def _steadied(self, frames: Iterator[Positions]) -> Iterator[tuple[list[Pair], float | None]]:
        """Pairs of given frames and welded ones after the temporal filter, and the level of noise that is left."""
        n = len(self._members)
        # Large meshes get shorter windows, so that memory stays the same.
        size = int(np.clip(WINDOW_BYTES // (24 * max(1, n)), 2 * FEWEST_FRAMES, WINDOW))
        filter_: TemporalFilter | None = None
        window: list[Positions] = []
        tail: Positions | None = None
        fresh = 0
        while True:
            new = list(islice(frames, size - fresh))
            window, fresh = [*window, *new][-size:], fresh + len(new)
            if fresh == 0 or (not new and tail is None):
                return
            last = len(new) == 0 or fresh < size
            welded = np.stack([frame[self._members] for frame in window])
            level: float | None = None
            if len(window) >= FEWEST_FRAMES:
                filter_ = filter_ or TemporalFilter(self._surface.topology.faces, n)
                steadied, deviation, remaining = filter_(welded)
                edge = mean_edge_length(welded[0], self._surface.topology.faces)
                # Below this, frames are steady already, and a filter could only blur fast motion.
                if np.sqrt(3.0) * deviation > FAINTEST * edge:
                    welded, level = steadied, np.sqrt(3.0) * deviation * remaining
            results = welded[-fresh:]
            if tail is not None:
                # Without fading, the change from one window to the next would be seen as a jump.
                fading = min(len(tail), len(results))
                share = ((np.arange(fading) + 1.0) / (fading + 1.0))[:, None, None]
                results = np.concatenate(
                    [(1.0 - share) * tail[:fading] + share * results[:fading], results[fading:]]
                )
            # The last frames of a window wait, since the next window sees what follows them.
            ready = len(results) if last else len(results) - FEWEST_FRAMES
            if ready:
                yield list(zip(window[-fresh:][:ready], results[:ready], strict=True)), level
            if last:
                return
            tail, fresh = results[ready:], FEWEST_FRAMES

    def _by_options(self, frames: Iterator[Positions], options: DenoiseOptions) -> Iterator[Pair]:
        """Given frames, and welded results that pass the gates."""
        topology = self._surface.topology
        start, step = HAND_OVERS[options.hand_over], FINE_STEPS[options.fine]
        iterations = {} if options.iterations is None else {"iterations": options.iterations}
        coarse, first = None, list(islice(frames, 2))
        if options.hand_over != "none" and options.method not in WITHOUT_COARSE:
            if options.method == "oi":
                rules = oi_rules(options.power, options.rounds)
            elif len(first) == 1:
                rules = by_lengths(first[0][self._members])
            else:
                # Weights by lengths differ from frame to frame, and would need dictionaries of their own for each.
                rules = RULES
            coarse = CoarseFilter(
                topology.faces, topology.n, options.keep, options.block_size, rules
            )

        def finish(task: tuple[int | None, Positions]) -> Pair:
            number, measured = task
            noisy = measured[self._members]
            if options.method == "tgv":
                result = varied_little(noisy, self._surface.probe.average @ noisy, topology)
            elif options.method == "learnt":
                result = learnt(noisy, topology).positions
            elif coarse is None:
                result = step(noisy, topology.faces, **iterations)
            else:
                begun = start(noisy, coarse(noisy, options.keep), GuidedFilter(noisy, topology))
                result = step(begun, topology.faces, **iterations)
            if self._force:
                return measured, result
            # The user chose the options, and they may be wrong for this mesh, so measure first what they destroy.
            good, reason = judge(
                noisy, result, find_noise(noisy, self._surface.probe), self._surface.probe
            )
            if reason:
                place = "" if number is None else f"frame {number}: "
                raise HarmError(f"{place}{reason}; nothing is written unless it is forced")
            return measured, np.where(good[:, None], result, noisy)

        # A mesh has no frames.
        numbers: Iterable[int | None] = count() if len(first) == 2 else [None]
        yield from ordered_map(finish, zip(numbers, chain(first, frames)), None)

    def _checked(self, frame: Positions) -> Positions:
        if frame.shape != self._shape:
            raise MeshError(f"a frame has shape {frame.shape}, the first one {self._shape}")
        if not np.isfinite(frame).all():
            raise MeshError("a frame has a coordinate that is not finite; remove or repair it")
        require_sizes(frame, done="denoised")
        return np.ascontiguousarray(frame, dtype=np.float64)


def denoise(mesh: TriangleMesh, options: DenoiseOptions | None = None, **ways: Any) -> TriangleMesh:
    """Remove noise from a mesh; `ways` are keywords of `FrameDenoiser`."""
    (positions,) = FrameDenoiser(mesh.positions, mesh.faces, options, **ways)([mesh.positions])
    return mesh if np.array_equal(positions, mesh.positions) else mesh.moved(positions)[0]
