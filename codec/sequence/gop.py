"""GOPs: what every one of them builds upon, and the coders of their frames, one for each direction.

Positions are in BSM units throughout.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from copy import copy
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from bsm.bitstream.coefficients.matrices import decode_levels, make_level_bank
from bsm.bitstream.container.gop import MAX_EXPONENT, GopBody, GopMethod
from bsm.bitstream.entropy.range_coder import Bank, copy_bank
from bsm.bitstream.errors import CorruptError
from bsm.codec.arrays import Faces, Levels, Matrix
from bsm.codec.sequence.dictionaries import Dictionaries, Part, Site, find_sites
from bsm.codec.sequence.level_writer import ROUNDS, WEIGHT, LevelWriter
from bsm.codec.sequence.row_prediction import (
    BASIS_LEADS,
    Loop,
    basis_of,
    frames_of,
    spectrum_of,
    trajectories,
)
from bsm.codec.sequence.temporal import learn_basis, projection
from bsm.codec.static.rules import Scheme
from bsm.codec.static.ways.block_coder import Progress
from bsm.codec.static.work import Allowance

if TYPE_CHECKING:
    from bsm.codec.sequence.options import SequenceOptions

BATCH = 8
"""Frames that are reconstructed at a time."""
SINGLE = 14
"""Bytes of the GOP of a single frame besides its levels, about."""
TRIED = 8
"""Frames that are coded one by one before that is given up as dearer than a basis."""


@dataclass(frozen=True, eq=False)
class Setting:
    """What every GOP of a sequence is coded with.

    Parameters
    ----------
    vertices : int
    dictionaries : Dictionaries
    first : list of float64 arrays, shapes (c_i, 3)
        The decoded first frame, each part as its difference from what the parts before let expect.
    """

    vertices: int
    dictionaries: Dictionaries
    first: list[Matrix]

    @property
    def sites(self) -> tuple[Site, ...]:
        """The parts of the mesh."""
        return self.dictionaries.sites

    def empty_levels(self, columns: int) -> list[Levels]:
        """Levels of all parts, each of shape (c_i, columns), to be read."""
        return [np.zeros((site.width, columns), np.int32) for site in self.sites]

    def field(self, columns: int, decoded: Callable[[int], Matrix]) -> Matrix:
        """The field, shape (n, m), of the differences that `decoded` gives of each part, shape (c_i, m)."""
        field = np.zeros((self.vertices, columns))
        laid = self.dictionaries.each(lambda index, part: part.lay(field, decoded(index)))
        for site, _ in zip(self.sites, laid, strict=True):
            site.settle(field)
        return field


def make_setting(
    scheme: Scheme,
    faces: Faces,
    first_frame: Matrix,
    *,
    width: int,
    threads: int | None,
    allowance: Allowance,
) -> Setting:
    """Make the dictionaries from the decoded first frame, shape (n, 3); see `find_sites`."""
    sites = find_sites(scheme.blocks, faces, first_frame, width=width, threads=threads, allowance=allowance)
    dictionaries = Dictionaries(sites, scheme.rules, allowance, threads)
    dictionaries.reserve()
    first = list(dictionaries.each(lambda _, part: part.difference(first_frame, first_frame)))
    return Setting(len(first_frame), dictionaries, first)


def level_references(matrices: list[Levels], columns: int) -> list[Levels]:
    """What the levels of each block, shape (c_i, columns), are expected to resemble within a GOP.

    That is those of the block before.
    """
    return [np.zeros((0, columns), np.int32), *matrices[:-1]]


def decode_basis(body: GopBody) -> Matrix:
    """Temporal basis of a GOP, shape (3T, r)."""
    levels = np.zeros((3, body.frames, body.components), np.int32)
    references = level_references(list(levels), body.components)
    decode_levels(make_level_bank(), body.basis, list(levels), references, BASIS_LEADS)
    return basis_of(levels, body.exponents)


class FrameHistory:
    """What low-delay frames of one block after another refer to; starts anew with every key frame.

    Attributes
    ----------
    bank : Bank
        Adaptive state of the entropy coder.
    levels : list of int32 arrays
        Of the latest frame.
    """

    def __init__(self, first: list[Matrix]) -> None:
        self.bank: Bank = make_level_bank()
        self.levels = [np.zeros((len(matrix), 3), np.int32) for matrix in first]
        self.loops = [Loop(9, 3) for _ in first]
        self._first = first
        self._latest = first
        self._before = first

    def known(self, block: int) -> Matrix:
        """What predicts a block's next change, shape (c_i, 9)."""
        latest = self._latest[block]
        return np.concatenate([self._first[block], latest, latest - self._before[block]], axis=1)

    def base(self, block: int) -> Matrix:
        """Coefficients that the change of a block is added to, shape (c_i, 3)."""
        return self._latest[block]

    def copy(self) -> FrameHistory:
        """An independent copy of the present state."""
        twin = FrameHistory(self._first)
        twin.bank, twin.loops = copy_bank(self.bank), [loop.copy() for loop in self.loops]
        twin.levels, twin._latest, twin._before = self.levels, self._latest, self._before
        return twin

    def commit(self, levels: list[Levels], coefficients: list[Matrix]) -> None:
        """Make a frame the latest: its levels and coefficients, each of shape (c_i, 3)."""
        self.levels = levels
        self._latest, self._before = coefficients, self._latest


def silent(done: int, blocks: int) -> None:
    """Nobody is told."""


class GopEncoder:
    """Encodes one GOP after the other; the twin of `GopDecoder`.

    Attributes
    ----------
    rounds : int
        As of `LevelWriter`.
    latest : float64 array, shape (n, 3), optional
        What decoders make of the latest frame that was sent by itself.
    """

    def __init__(self, setting: Setting, options: SequenceOptions) -> None:
        self._setting = setting
        self._parts: tuple[Part, ...] = tuple(setting.dictionaries.each(lambda _, part: part))
        self._options = options
        self.step = options.step
        self.rounds = ROUNDS
        self.latest: Matrix | None = None
        self._history = FrameHistory(setting.first)

    @property
    def step(self) -> float:
        """With which the next GOP is quantized; what is set becomes a single-precision number."""
        return self._step

    @step.setter
    def step(self, step: float) -> None:
        self._step = float(np.float32(step))

    def copy(self) -> GopEncoder:
        """One that goes on from the same state."""
        twin = copy(self)
        twin._history = self._history.copy()
        return twin

    @property
    def low_delay(self) -> bool:
        """Whether every frame is sent as it comes."""
        return self._options.mode == "low-delay"

    def encode_single(self, frame: Matrix, number: int, progress: Progress) -> GopBody:
        """Encode frame `number`, shape (n, 3), of a sequence of low delay."""
        return self._single(frame, self._step, number % self._options.longest(len(frame)) == 0, progress)

    def encode_learnt(self, frames: Matrix, weights: Matrix, progress: Progress) -> tuple[GopBody, float]:
        """Encode frames, shape (T, n, 3), whose errors count by `weights`, shape (T,), by a basis learnt from them.

        Returns
        -------
        body : GopBody
        cost : float
            Squared steps of all weighed errors, and what the bits are worth.
        """
        body, error = self._transformed(trajectories(frames), np.tile(weights, 3), progress)
        return body, error + WEIGHT * 8.0 * (len(body.levels) + len(body.basis) + SINGLE)

    def encode_singles(self, frames: Matrix, weights: Matrix, most: float = math.inf) -> tuple[GopBody, ...]:
        """Encode frames, shape (T, n, 3), whose errors count by `weights`, shape (T,), one by one.

        Steps are finer for what weighs more, as they are with a basis. Gives up, mostly soon, with
        nothing, if the cost is not likely to stay below `most`.
        """
        bodies: list[GopBody] = []
        cost = 0.0
        for frame, weight in zip(frames, weights, strict=True):
            bodies.append(self._single(frame, float(np.float32(self._step / weight)), not bodies, silent))
            assert self.latest is not None
            error = float(np.square(weight * (self.latest - frame)).sum()) / self._step**2
            cost += error + WEIGHT * 8.0 * (len(bodies[-1].levels) + SINGLE)
            if cost > most * (len(bodies) / len(frames) if len(bodies) >= TRIED else 1.0):
                return ()
        return tuple(bodies)

    def _single(self, wanted: Matrix, step: float, key: bool, progress: Progress) -> GopBody:
        if key:
            self._history = FrameHistory(self._setting.first)
        history = self._history
        frame = np.zeros_like(wanted)
        writer, coefficients = LevelWriter(history.bank, 3, self.rounds), []
        for k, part in enumerate(self._parts):
            target = part.difference(wanted, frame) - history.base(k)
            change = writer.write(history.loops[k], history.known(k), target, step, history.levels[k])
            coefficients.append(history.base(k) + change)
            part.place(frame, coefficients[k])
            progress(k + 1, len(self._parts))
        payload = writer.finish()
        history.commit(writer.levels, coefficients)
        self.latest = frame
        method = GopMethod.KEY_FRAME if key else GopMethod.NEXT_FRAME
        return GopBody(method, 1, step, 3, np.empty(0, np.int32), b"", payload)

    def _transformed(self, motion: Matrix, weights: Matrix, progress: Progress) -> tuple[GopBody, float]:
        """Encode trajectories, shape (n, 3T), whose columns count by `weights`, shape (3T,), and are weighed here."""
        motion *= weights
        body = self._learnt(motion, weights)
        basis = decode_basis(body) * weights[:, None]
        wanted = motion @ projection(basis)
        field = np.zeros_like(wanted)
        writer = LevelWriter(make_level_bank(), body.components, self.rounds)
        for part, first in zip(self._parts, self._setting.first, strict=True):
            target = part.difference(wanted, field)
            part.place(field, writer.write(Loop(3, body.components), first, target, self._step))
            progress(len(writer.levels), len(self._parts))
        left = np.vdot(motion, motion) - _energy(wanted, basis)  # of the fit, which `wanted - field` is orthogonal to
        error = float(left + _energy(wanted - field, basis)) / self._step**2
        return replace(body, levels=writer.finish()), error

    def _learnt(self, motion: Matrix, weights: Matrix) -> GopBody:
        """The temporal basis of weighted trajectories, shape (n, 3T), without the levels of parts."""
        basis = learn_basis(motion, self._step, MAX_EXPONENT)
        spectrum = spectrum_of(basis.columns / weights[:, None], basis.exponents)
        _, frames, columns = spectrum.shape
        writer = LevelWriter(make_level_bank(), columns, self.rounds)
        for matrix, lead in zip(spectrum, BASIS_LEADS, strict=True):
            writer.write(Loop(0, columns, 0), np.empty((frames, 0)), matrix, 1.0, lead=lead)
        return GopBody(GopMethod.LEARNT, frames, self._step, columns, basis.exponents, writer.finish(), b"")


class GopDecoder:
    """Decodes one GOP after the other."""

    def __init__(self, setting: Setting) -> None:
        self.setting = setting
        self._history: FrameHistory | None = None

    def forget(self) -> None:
        """Take note that frames are missing here."""
        self._history = None

    def decode(self, body: GopBody) -> Iterator[Matrix]:
        """The frames of a GOP, shape (n, 3); all that its levels can have wrong is raised before the first of them."""
        if body.method is GopMethod.LEARNT:
            self.forget()
            return self._transformed(body)
        return iter([self._single(body)])

    def _single(self, body: GopBody) -> Matrix:
        if body.method is GopMethod.KEY_FRAME:
            self._history = FrameHistory(self.setting.first)
        history, self._history = self._history, None  # until all has gone well
        if history is None:
            raise CorruptError("a frame refers to one that is not there")
        levels = self.setting.empty_levels(3)
        decode_levels(history.bank, body.levels, levels, history.levels)
        coefficients = [np.empty(0)] * len(levels)

        def decoded(k: int) -> Matrix:
            change = history.loops[k].decode(history.known(k), levels[k], body.step)
            coefficients[k] = history.base(k) + change
            return coefficients[k]

        frame = self.setting.field(3, decoded)
        history.commit(levels, coefficients)
        self._history = history
        return frame

    def _transformed(self, body: GopBody) -> Iterator[Matrix]:
        setting, columns = self.setting, body.components
        basis = decode_basis(body)
        levels = setting.empty_levels(columns)
        decode_levels(make_level_bank(), body.levels, levels, level_references(levels, columns))
        field = setting.field(columns, lambda k: Loop(3, columns).decode(setting.first[k], levels[k], body.step))
        return _batches(field, basis.reshape(3, body.frames, columns))


def _energy(field: Matrix, basis: Matrix) -> float:
    """Sum of the squares of `field @ basis.T`, of shapes (n, r) and (3T, r)."""
    return float(np.vdot(field, field @ (basis.T @ basis)))


def _batches(field: Matrix, basis: Matrix) -> Iterator[Matrix]:
    """The frames of components, shape (n, r), over a basis, shape (3, T, r), a few at a time."""
    for start in range(0, basis.shape[1], BATCH):
        part = basis[:, start : start + BATCH]
        yield from frames_of(field @ part.reshape(3 * part.shape[1], -1 if part.size else 0).T)
