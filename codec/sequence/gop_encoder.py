"""Frames to GOPs; the twin of `codec.sequence.gop_decoder`."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from bitstream.coefficients.matrices import encode_levels, make_level_bank
from bitstream.container.gop import MAX_EXPONENT, GopBody, GopMethod
from codec.sequence.gop_decoder import FrameHistory, Setting, decode_basis, level_references
from codec.sequence.options import SequenceOptions
from codec.sequence.row_prediction import Loop, cosine_basis, quantize_basis, trajectories
from codec.sequence.temporal import WORTH, bits_estimate, learn_basis, projection

Matrix = npt.NDArray[np.float64]
Progress = Callable[[int, int], None]


class GopEncoder:
    """Encodes one GOP after the other."""

    def __init__(self, setting: Setting, options: SequenceOptions) -> None:
        self._setting = setting
        self._options = options
        self._step = float(np.float32(options.step))
        self._history: FrameHistory | None = None

    def encode(self, frames: Matrix, number: int, progress: Progress) -> GopBody:
        """Encode frames, shape (T, n, 3), in BSM units, from frame `number` of the sequence on."""
        if self._options.mode == "low-delay":
            return self._single(frames[0], number % self._options.gop == 0, progress)
        return self._transformed(trajectories(frames), progress)

    def _single(self, wanted: Matrix, key: bool, progress: Progress) -> GopBody:
        history = self._history
        if key or history is None:
            history = self._history = FrameHistory(self._setting.first)
        frame = np.zeros_like(wanted)
        levels, coefficients = [], []
        for k, part in enumerate(self._setting.parts):
            base = history.base(k)
            target = part.basis.T @ wanted[part.vertices] - part.extend(frame) - base
            coded, change = history.loops[k].encode(history.known(k), target, self._step, self._options.rounding)
            levels.append(coded)
            coefficients.append(base + change)
            part.place(frame, coefficients[k])
            progress(len(levels), len(self._setting.parts))
        payload = encode_levels(history.bank, levels, history.levels)
        history.commit(levels, coefficients)
        method = GopMethod.KEY_FRAME if key else GopMethod.NEXT_FRAME
        return GopBody(method, 1, self._step, 3, np.empty(0, np.int32), b"", payload)

    def _transformed(self, motion: Matrix, progress: Progress) -> GopBody:
        """Encode trajectories, shape (n, 3T)."""
        candidates = []
        if self._options.transform != "cosine":
            candidates.append(self._learnt(motion))
        if self._options.transform != "learnt":
            candidates.append(self._cosines(motion))
        body = min(candidates, key=lambda candidate: self._cost(motion, candidate)) if candidates[1:] else candidates[0]
        return self._coded(motion, body, progress)

    def _learnt(self, motion: Matrix) -> GopBody:
        basis = learn_basis(motion, self._step, MAX_EXPONENT)
        levels = quantize_basis(basis.columns, basis.exponents, self._options.rounding)
        columns = basis.columns.shape[1]
        coded = encode_levels(make_level_bank(), list(levels), level_references(list(levels), columns))
        return GopBody(GopMethod.LEARNT, levels.shape[1], self._step, columns, basis.exponents, coded, b"")

    def _cosines(self, motion: Matrix) -> GopBody:
        frames = motion.shape[1] // 3
        energies = np.square(motion @ cosine_basis(frames)).sum(axis=0)
        worth = np.flatnonzero(energies > WORTH * self._step**2)
        columns = int(np.max(worth, initial=0)) + 1
        return GopBody(GopMethod.COSINES, frames, self._step, columns, np.empty(0, np.int32), b"", b"")

    def _cost(self, motion: Matrix, body: GopBody) -> float:
        components = motion @ projection(decode_basis(body))
        return bits_estimate(components, self._step) + 8.0 * len(body.basis)

    def _coded(self, motion: Matrix, body: GopBody, progress: Progress) -> GopBody:
        """The GOP with the levels of its blocks."""
        wanted = motion @ projection(decode_basis(body))
        field = np.zeros_like(wanted)
        levels = []
        for part, first in zip(self._setting.parts, self._setting.first):
            target = part.basis.T @ wanted[part.vertices] - part.extend(field)
            coded, decoded = Loop(3, body.components).encode(first, target, self._step, self._options.rounding)
            part.place(field, decoded)
            levels.append(coded)
            progress(len(levels), len(self._setting.parts))
        payload = encode_levels(make_level_bank(), levels, level_references(levels, body.components))
        return replace(body, levels=payload)
