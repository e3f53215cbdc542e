"""Ripples: smooth waves that cross a whole mesh, as a scanner that trembles leaves them, found and taken away.

A plane wave crosses the whole mesh with one phase, however the surface faces: detail does not. The strongest peak
in the spectrum of the fine filter (its values on a grid in space, by FFT) begins a wave, Gauss and Newton's method fits
its vector, phase and height, and the next peak is looked for in the rest. Waves are believed only if most windows of
the mesh are calmer without them.
"""

from __future__ import annotations

from copy import copy
from typing import NamedTuple

import numpy as np
from scipy import fft

from bsm.codec.arrays import Floats, Positions
from bsm.codec.denoise.noise.probe import BOUND, SHARE, Probe
from bsm.codec.geometry.metrics import mean_edge_length

LENGTHS = (2.8, 10.0)
"""Of waves, in mean edges: shorter ones look like noise to a mesh, of longer ones the fine filter sees little."""
CELL, MOST_CELLS = 0.9, 1 << 24
"""Of the grid of space, in mean edges, and how many it may have; meshes that need more are searched in their middle."""
DISTINCT = 30.0
"""Power of a peak over the mean of the spectrum: the strongest of some million values of noise is 17, clean meshes
reach this here and there."""
MOST_WAVES = 3
WORTH = 0.97  # a wave has to lower the level of what the filter sees to this
SETTLING, POLISHING = 3, 14  # steps after each wave, and after the last
FAINTEST, STRONGEST = 0.04, 1.0  # standard deviation of all waves together, in mean edges, that is believed
CALMER, MANY_WINDOWS, CALMER_OF_FEW, PLAIN = 0.85, 20, 0.42, 0.15
"""Median over the windows of the level without the waves, over that with them, at most: of many windows, and of fewer;
and the one above which no wave may be left, as there is of the regular bumps of a shape, products of waves."""
ROUND = 0.05  # share of the normals in their least direction: a corrugated sheet has none, and keeps its waves
FEWEST = 1000  # vertices
OUTSIDE = 2.5  # standardised values from which on they are creases, not waves


class Ripples(NamedTuple):
    """Positions without waves, and the lengths and the strength of these, in mean edges."""

    positions: Positions
    lengths: tuple[float, ...] = ()
    level: float = 0.0


def find_ripples(positions: Positions, probe: Probe) -> Ripples:
    nothing = Ripples(positions)
    edge = mean_edge_length(positions, probe.topology.faces)
    normals = probe.smooth_normals(positions)[probe.counted]
    valid = probe.windows.valid
    if len(normals) < FEWEST or not valid.any() or not edge > 0.0:
        return nothing
    if np.linalg.eigvalsh(normals.T @ normals / len(normals))[0] < ROUND:
        return nothing
    fit = _Fit(positions / edge, probe)
    while len(fit.vectors) < MOST_WAVES and (begun := fit.peak()) is not None:
        wider = fit.with_wave(begun)
        for _ in range(SETTLING):
            wider.step()
        if wider.level > WORTH * fit.level:
            break
        fit = wider
    if not len(fit.vectors):
        return nothing
    for _ in range(POLISHING):
        # The surface as it is without the waves: its normals, and where the vertices were.
        fit.look(fit.given - fit.amounts[:, None] * fit.normals, passes=1)
        fit.step()
    lengths = 2.0 * np.pi / np.linalg.norm(fit.vectors, axis=1)
    level = float(fit.amounts.std())
    calmer = float(np.median(probe.levels(fit.rest)[valid] / np.maximum(probe.levels(fit.seen)[valid], 1e-12)))
    sound = bool(((lengths > LENGTHS[0]) & (lengths < LENGTHS[1])).all())
    most = CALMER if int(valid.sum()) >= MANY_WINDOWS else CALMER_OF_FEW
    if not sound or not FAINTEST < level < STRONGEST or calmer > most or (calmer > PLAIN and fit.peak() is not None):
        return nothing
    return Ripples(positions - edge * fit.amounts[:, None] * fit.normals, tuple(lengths.tolist()), level)


class _Fit:
    """Waves along the normals, and the output of the fine filter with and without them; in mean edges."""

    def __init__(self, places: Positions, probe: Probe) -> None:
        self._probe, self.given = probe, places - places.mean(axis=0)
        self.vectors = np.zeros((0, 3))
        self.amounts = np.zeros(len(places))
        self.look(self.given, passes=2)

    def with_wave(self, vector: Floats) -> _Fit:
        """A fit with one more wave, its vector of shape (3,), which the next step gives its height."""
        other = copy(self)
        other.vectors = np.vstack([self.vectors, vector])
        return other

    def look(self, places: Positions, passes: int) -> None:
        self.normals = self._probe.smooth_normals(places, passes)
        # Where a plane lies across a wave, the phases of noisy heights would be a picture of the noise.
        heights = np.einsum("ij,ij->i", places - self._probe.average @ places, self.normals)
        self._places = places - heights[:, None] * self.normals
        self.seen = np.einsum("ij,ij->i", self._probe.fine(self.given), self.normals)
        self._weigh(self._probe.fine(self.amounts[:, None])[:, 0])

    def _weigh(self, explained: Floats) -> None:
        """Know the rest, and trust calm windows and ordinary values."""
        probe = self._probe
        self.rest = np.where(probe.counted, self.seen - explained, 0.0)
        self.level = float(np.quantile(np.abs(self.rest[probe.counted]), SHARE)) / BOUND
        levels = np.where(probe.windows.valid, probe.levels(self.rest), np.inf)
        self._local = np.maximum(levels, 0.5 * self.level)[probe.windows.labels]
        calm = np.minimum(1.0, self.level / self._local)
        self._trust = probe.counted * calm / np.sqrt(1.0 + np.square(self.rest / (2.0 * self.level or 1.0)))

    def step(self) -> None:
        """Move heights, phases and wave vectors to where the filter sees less."""
        basis, filtered, heights = self._fitted()
        (even, odd), (a, b) = np.hsplit(basis, 2), heights.reshape(2, -1)
        slopes = ((b * even - a * odd)[:, :, None] * self._places[:, None, :]).reshape(len(basis), -1)
        change = self._solved(
            np.concatenate([filtered, self._probe.fine(slopes)], axis=1), self.seen - filtered @ heights
        )
        turned = change[len(heights) :].reshape(-1, 3)
        most = 2.0 * np.pi / float(np.ptp(self.given, axis=0).max())
        turned *= np.minimum(1.0, most / np.maximum(np.linalg.norm(turned, axis=1, keepdims=True), 1e-12))
        self.vectors = self.vectors + turned
        basis, filtered, heights = self._fitted()
        self.amounts = basis @ heights
        self._weigh(filtered @ heights)

    def _fitted(self) -> tuple[Floats, Floats, Floats]:
        """Even and odd waves, as they are and filtered, and their heights."""
        phases = self._places @ self.vectors.T
        basis = np.concatenate([np.cos(phases), np.sin(phases)], axis=1)
        filtered = self._probe.fine(basis)
        return basis, filtered, self._solved(filtered, self.seen)

    def _solved(self, columns: Floats, values: Floats) -> Floats:
        weighted = columns * self._trust[:, None]
        normal = weighted.T @ weighted
        normal[np.diag_indices_from(normal)] += 1e-9 * np.trace(normal) / len(normal) + 1e-30
        return np.asarray(np.linalg.solve(normal, weighted.T @ (values * self._trust)), dtype=np.float64)

    def peak(self) -> Floats | None:
        """The wave vector, shape (3,), of the strongest peak, if it is distinct."""
        if not self.level > 0.0:
            return None
        values = self.rest / self._local
        values = np.where(np.abs(values) < OUTSIDE, values, 0.0) * np.minimum(1.0, self.level / self._local)
        places = self._places
        half = 0.5 * CELL * MOST_CELLS ** (1.0 / 3.0)
        near = self._probe.counted & (np.abs(places) < half).all(axis=1)
        places, values = places[near], values[near]
        if len(places) < FEWEST:
            return None
        at = ((places - places.min(axis=0)) / CELL + 0.5).astype(np.int64)
        shape = tuple(fft.next_fast_len(int(size) + 1, real=True) for size in at.max(axis=0))
        grid = np.bincount(np.ravel_multi_index(tuple(at.T), shape), values, int(np.prod(shape))).reshape(shape)
        spectrum = fft.rfftn(grid.astype(np.float32))
        power = np.square(spectrum.real) + np.square(spectrum.imag)
        axes = [fft.fftfreq(shape[0]), fft.fftfreq(shape[1]), fft.rfftfreq(shape[2])]
        turns = np.add.outer(np.add.outer(*(np.square(axis) for axis in axes[:2])), np.square(axes[2])) / CELL**2
        power[(turns > LENGTHS[0] ** -2) | (turns < LENGTHS[1] ** -2)] = 0.0
        best = np.unravel_index(int(np.argmax(power)), power.shape)
        if power[best] < DISTINCT * float(values @ values):
            return None
        vector = [float(axis[place]) for axis, place in zip(axes, best, strict=True)]
        return np.asarray(vector, dtype=np.float64) * (2.0 * np.pi / CELL)
