"""The base of every GOP: the dictionaries, and the known state of each field before its first frame."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from bsm._core import codec as _kernels
from bsm._core import gop_memory
from bsm.bitstream.container.gop import GopBody
from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Faces, Matrix
from bsm.codec.sequence.dictionaries import Part, make_parts
from bsm.codec.static.coding import Scheme
from bsm.codec.threads import ordered_map

INHERITED, LAGS = _kernels.INHERITED, _kernels.lags()  # see codec/sequence/temporal.h


def bending(part: Matrix, positions: Matrix) -> Matrix:
    """Positions in the first frame, followed by their squares and cubes about those of a part."""
    columns = np.empty((len(positions), _kernels.BENDING))
    _kernels.bend_columns(part, positions, columns)
    return columns


@dataclass(frozen=True, eq=False)
class Track:
    """The known state of one field before the first frame of any GOP."""

    width: int
    kept: int
    first: list[Matrix]
    known: list[Matrix]
    around: list[Matrix]
    start: list[Matrix]


@dataclass(frozen=True, eq=False)
class Setting:
    """The dictionaries and tracks that all GOPs of a sequence share."""

    vertices: int
    parts: tuple[Part, ...]
    tracks: tuple[Track, ...]

    @cached_property
    def around(self) -> int:
        return sum(len(part.around) for part in self.parts)

    @cached_property
    def memory(self) -> float:
        """Bytes that decoders keep, besides the dictionaries that they have room for."""
        widths = [track.width for track in self.tracks[1:]]
        tracks = (
            _kernels.TRACK_MEMORY * self.vertices * sum(widths) + 8 * (_kernels.BENDING + sum(widths)) * self.around
        )
        return sum(part.memory for part in self.parts) + tracks

    def memory_for(self, body: GopBody) -> float:
        """Bytes for decoding a GOP: levels, components, a few frames, and one part after the other."""
        fields = np.array([(field.width, field.components) for field in body.fields], np.int64)
        columns = int(fields[:, 1].sum()) if body.method.has_basis else int(fields[:, 0].sum()) * body.frames
        most = 48 * max(len(part.vertices) for part in self.parts) * columns
        making = max(part.making for part in self.parts) + _kernels.SPARE_MEMORY
        return gop_memory(body.method, body.frames, fields, self.vertices, self.around) + most + making


def make_setting(
    scheme: Scheme, faces: Faces, first_frame: Matrix, *, threads: int | None, moving: Sequence[Matrix] = ()
) -> Setting:
    """Make the dictionaries from the decoded first frame, shape (n, 3); see `make_parts` and `Setting`."""
    parts = make_parts(scheme, faces, first_frame, threads)
    widths = [values.shape[1] for values in moving]
    ends = np.cumsum([_kernels.BENDING, *widths])[:-1]

    def known(part: Part) -> tuple[list[Matrix], list[Matrix]]:
        own = first_frame[part.vertices]
        here, around = (
            np.hstack([bending(own, first_frame[places]), *(values[places] for values in moving)])
            for places in (part.vertices, part.around)
        )
        return np.split(part.coefficients(here, around), ends, axis=1), np.split(around, ends, axis=1)

    pairs = list(ordered_map(known, parts, threads))
    tracks = []
    for track, width in enumerate((3, *widths)):
        known_of, around_of = ([np.ascontiguousarray(m[track]) for m in each] for each in zip(*pairs, strict=True))
        first = [np.vstack((ends, part))[:, :width] for ends, part in zip(around_of, known_of, strict=True)]
        start = [np.zeros_like(part) for part in first] if track else first
        most = min(max(_kernels.POSITIONS_KEPT // len(first_frame), _kernels.LEAST_KEPT), _kernels.MOST_KEPT)
        kept = _kernels.LEAST_KEPT if track else most
        tracks.append(Track(width, kept, first, known_of, around_of, start))
    return Setting(len(first_frame), parts, tuple(tracks))
