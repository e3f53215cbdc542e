"""GOPs to frames: what every GOP builds upon, and the decoder of their data."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from bitstream.coefficients.matrices import Levels, decode_levels, make_level_bank
from bitstream.container.gop import GopBody, GopMethod
from bitstream.container.header import Header
from bitstream.entropy.range_coder import Bank
from bitstream.errors import CorruptError
from codec.blocks.overlap import Blocks
from codec.geometry.mesh import Faces, Positions
from codec.sequence.dictionaries import Part, build_dictionaries, differences
from codec.sequence.row_prediction import Loop, cosine_basis, dequantize_basis, frames_of
from codec.static.assembly import in_mesh_units

Matrix = npt.NDArray[np.float64]

BATCH = 16
"""Frames that are reconstructed at a time."""


@dataclass(frozen=True, eq=False)
class Setting:
    """What every GOP of a sequence is decoded with.

    Parameters
    ----------
    header : Header
    parts : tuple of Part
    first : list of float64 arrays, shapes (c_i, 3)
        The decoded first frame, each part as its difference from what the parts before let expect.
    """

    header: Header
    parts: tuple[Part, ...]
    first: list[Matrix]

    def in_mesh_units(self, positions: Matrix) -> Positions:
        """Positions in BSM units as the mesh has them."""
        return in_mesh_units(positions, self.header.center, self.header.scale)


def make_setting(header: Header, faces: Faces, blocks: Blocks, first_frame: Matrix, threads: int | None) -> Setting:
    """Build the dictionaries from the decoded first frame, shape (n, 3), in BSM units."""
    parts = build_dictionaries(blocks, faces, first_frame, header.coefficients, header.weights == 1, threads)
    return Setting(header, parts, differences(parts, first_frame))


def level_references(matrices: list[Levels], columns: int) -> list[Levels]:
    """What the levels of each block are expected to resemble within a GOP: those of the block before."""
    return [np.zeros((0, columns), np.int32), *matrices[:-1]]


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
        """Coefficients that the change is added to."""
        return self._latest[block]

    def commit(self, levels: list[Levels], coefficients: list[Matrix]) -> None:
        """Make a frame the latest."""
        self.levels = levels
        self._latest, self._before = coefficients, self._latest


class GopDecoder:
    """Decodes one GOP after the other."""

    def __init__(self, setting: Setting) -> None:
        self._setting = setting
        self._history: FrameHistory | None = None

    def forget(self) -> None:
        """Take note that frames are missing here."""
        self._history = None

    def decode(self, body: GopBody) -> Iterator[Positions]:
        """The frames of a GOP; all that can be wrong with it is raised before the first of them."""
        if body.method <= GopMethod.COSINES:
            self._history = None
            return self._transformed(body)
        return iter([self._single(body)])

    def _single(self, body: GopBody) -> Positions:
        if body.method is GopMethod.KEY_FRAME:
            self._history = FrameHistory(self._setting.first)
        history = self._history
        if history is None:
            raise CorruptError("a frame refers to one that is not there")
        self._history = None  # unless all goes well
        levels = self._empty_levels(3)
        decode_levels(history.bank, body.levels, levels, history.levels)
        frame = np.zeros((self._setting.header.vertices, 3))
        coefficients = []
        for k, part in enumerate(self._setting.parts):
            change = history.loops[k].decode(history.known(k), levels[k], body.step)
            coefficients.append(history.base(k) + change)
            part.place(frame, coefficients[k])
        history.commit(levels, coefficients)
        self._history = history
        return self._setting.in_mesh_units(frame)

    def _empty_levels(self, columns: int) -> list[Levels]:
        return [np.zeros((part.basis.shape[1], columns), np.int32) for part in self._setting.parts]

    def _transformed(self, body: GopBody) -> Iterator[Positions]:
        setting, columns = self._setting, body.components
        basis = decode_basis(body)
        levels = self._empty_levels(columns)
        decode_levels(make_level_bank(), body.levels, levels, level_references(levels, columns))
        field = np.zeros((setting.header.vertices, columns))
        for part, matrix, first in zip(setting.parts, levels, setting.first):
            part.place(field, Loop(3, columns).decode(first, matrix, body.step))
        return self._frames(field, basis.reshape(3, body.frames, columns))

    def _frames(self, field: Matrix, basis: Matrix) -> Iterator[Positions]:
        for start in range(0, basis.shape[1], BATCH):
            part = basis[:, start : start + BATCH]
            for frame in frames_of(field @ part.reshape(3 * part.shape[1], -1 if part.size else 0).T):
                yield self._setting.in_mesh_units(frame)


def decode_basis(body: GopBody) -> Matrix:
    """Temporal basis of a GOP, shape (3T, r)."""
    if body.method is GopMethod.COSINES:
        return np.ascontiguousarray(cosine_basis(body.frames)[:, : body.components])
    levels = np.zeros((3, body.frames, body.components), np.int32)
    decode_levels(make_level_bank(), body.basis, list(levels), level_references(list(levels), body.components))
    return dequantize_basis(levels, body.exponents)
