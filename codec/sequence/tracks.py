"""The base of every GOP: the dictionaries, and the known state of each field before its first frame."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from bsm._core import codec as _kernels
from bsm.bitstream.container.gop import GopBody, GopMethod
from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Faces, Matrix
from bsm.codec.sequence.dictionaries import Part, make_parts
from bsm.codec.sequence.temporal import BATCH
from bsm.codec.static.coding import Scheme
from bsm.codec.threads import ordered_map

KEPT, MOST_KEPT, LEAST_KEPT = 1 << 19, 64, 2
"""Positions that low-delay frames may refer to, about, and frames at most and at least, of attributes always."""
LAGS = (1, 2, 3, 5, 8, 13, 21, 34)
"""How far before the latest frame those lie that help to predict the next ones, of those that are kept."""
INHERITED = 24
"""Components of a GOP that those of the next one are predicted from: motion is repeated in other mixtures."""
SPARE = 4.0 * 2**20  # bytes that decoders keep no dictionary in, though they are granted
TRACK_MEMORY = 40.0  # bytes of a number of a vertex in the first frame of an attribute that moves


def frames_kept(vertices: int) -> int:
    """Return how many decoded frames low-delay frames may refer to, by the number of vertices."""
    return min(MOST_KEPT, max(LEAST_KEPT, KEPT // vertices))


BENDING_COLUMNS = 19  # positions, their squares and their cubes about a part


def bending(part: Matrix, positions: Matrix) -> Matrix:
    """Positions in the first frame, followed by their squares and cubes about those of a part."""
    columns = np.empty((len(positions), BENDING_COLUMNS))
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
        tracks = TRACK_MEMORY * self.vertices * sum(widths) + 8.0 * (BENDING_COLUMNS + sum(widths)) * self.around
        return sum(part.memory for part in self.parts) + tracks

    def memory_for(self, body: GopBody) -> float:
        """Bytes for decoding a GOP: levels, components, a few frames, and one part after the other."""
        vertices, around, width = self.vertices, self.around, sum(field.width for field in body.fields)
        frames = (16.0 * min(body.frames, BATCH) + 32.0) * width
        if body.method.has_basis:
            columns = sum(field.components for field in body.fields)
            needed = INHERITED if body.method is GopMethod.LEARNT_NEXT else 0
            kept = sum(min(field.components, INHERITED) + needed for field in body.fields)
            left = 8.0 * kept * (vertices + around)
        else:
            columns = width * body.frames
            left = 24.0 * frames_kept(vertices) * (vertices + around)
            left += width * (4.0 * body.frames * vertices + 8.0 * (body.frames + 4.0) * around)
        sizes = ((field.components, 40.0 * field.width * body.frames) for field in body.fields)
        bases = sum(components * (frame + 24.0 * components) for components, frame in sizes)
        largest = max(len(part.vertices) for part in self.parts)
        making = max(part.making for part in self.parts) + SPARE
        return vertices * (12.0 * columns + frames) + bases + left + 48.0 * largest * columns + making


def make_setting(
    scheme: Scheme, faces: Faces, first_frame: Matrix, *, threads: int | None, moving: Sequence[Matrix] = ()
) -> Setting:
    """Make the dictionaries from the decoded first frame, shape (n, 3); see `make_parts` and `Setting`."""
    parts = make_parts(scheme, faces, first_frame, threads)
    widths = [values.shape[1] for values in moving]
    ends = np.cumsum([BENDING_COLUMNS, *widths])[:-1]

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
        kept = LEAST_KEPT if track else frames_kept(len(first_frame))
        tracks.append(Track(width, kept, first, known_of, around_of, start))
    return Setting(len(first_frame), parts, tuple(tracks))
