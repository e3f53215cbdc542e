"""What every GOP builds upon: the dictionaries, and of each of its fields what is known before its first frame."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from bsm.codec.arrays import Faces, Levels, Matrix
from bsm.codec.sequence.bending import BENDING_COLUMNS, Bending
from bsm.codec.sequence.dictionaries import Dictionaries, Part, Site, find_sites
from bsm.codec.static.rules import Scheme
from bsm.codec.static.work import Allowance

KEPT, MOST_KEPT, LEAST_KEPT = 1 << 19, 64, 2
"""Positions that low-delay frames may refer to, about, and frames at most and at least, of attributes always."""
LAGS = (1, 2, 3, 5, 8, 13, 21, 34)
"""How far before the latest frame those lie that help to predict the next ones, of those that are kept."""
TRACK_MEMORY = 40.0
"""Bytes of a number of a vertex in the first frame of an attribute that moves."""


def frames_kept(vertices: int) -> int:
    """How many decoded frames of so many vertices those of low delay may refer to."""
    return min(MOST_KEPT, max(LEAST_KEPT, KEPT // vertices))


def lags(kept: int) -> tuple[int, ...]:
    """`LAGS`, where so many frames are kept."""
    return tuple(lag for lag in LAGS if lag < kept)


@dataclass(frozen=True, eq=False)
class Track:
    """What every GOP knows of one field before its first frame."""

    width: int
    kept: int
    first: list[Matrix]
    known: list[Matrix]
    around: list[Matrix]
    start: list[Matrix]


@dataclass(frozen=True, eq=False)
class Setting:
    """What every GOP of a sequence is coded with."""

    vertices: int
    given: int
    dictionaries: Dictionaries
    tracks: tuple[Track, ...]

    @property
    def sites(self) -> tuple[Site, ...]:
        """The parts of the mesh."""
        return self.dictionaries.sites

    def empty_levels(self, columns: int) -> list[Levels]:
        """Levels of all parts, each of shape (c_i, columns), to be read."""
        return [np.zeros((site.width, columns), np.int32) for site in self.sites]

    def field(self, columns: int, decoded: Callable[[int, Matrix], Matrix]) -> Matrix:
        """The field, shape (n, m), of differences of each part, shape (c_i, m)."""
        field = np.zeros((self.vertices, columns))
        for index, part in enumerate(self.dictionaries.in_order()):
            part.place(field, decoded(index, field[part.site.around]))
        return field


def make_setting(
    scheme: Scheme,
    faces: Faces,
    first_frame: Matrix,
    *,
    given: int,
    width: int,
    threads: int | None,
    allowance: Allowance,
    moving: Sequence[Matrix] = (),
) -> Setting:
    """Make the dictionaries from the decoded first frame, shape (n, 3); see `find_sites` and `Setting`."""
    sites = find_sites(scheme.blocks, faces, first_frame, width=width, threads=threads, allowance=allowance)
    dictionaries = Dictionaries(sites, scheme.rules, allowance, threads)
    dictionaries.reserve()
    widths = [values.shape[1] for values in moving]
    allowance.keep(TRACK_MEMORY * len(first_frame) * sum(widths))
    columns = [BENDING_COLUMNS, *widths]
    allowance.keep(8.0 * sum(columns) * sum(len(site.around) for site in sites))

    def known(_: int, part: Part) -> tuple[list[Matrix], list[Matrix]]:
        bending = Bending.of(first_frame[part.vertices])
        here, around = (
            np.hstack([bending.columns(first_frame[vertices]), *(values[vertices] for values in moving)])
            for vertices in (part.vertices, part.site.around)
        )
        return split_columns(part.coefficients(here, around), columns), split_columns(around, columns)

    pairs = list(dictionaries.each(known))
    tracks = []
    for track, width in enumerate((3, *widths)):
        known_of, around_of = ([np.ascontiguousarray(one[track]) for one in each] for each in zip(*pairs, strict=True))
        first = [np.vstack((ends, part))[:, :width] for ends, part in zip(around_of, known_of, strict=True)]
        start = [np.zeros_like(part) for part in first] if track else first
        kept = LEAST_KEPT if track else frames_kept(len(first_frame))
        tracks.append(Track(width, kept, first, known_of, around_of, start))
    return Setting(len(first_frame), given, dictionaries, tuple(tracks))


def split_columns(matrix: Matrix, widths: Sequence[int]) -> list[Matrix]:
    """A matrix of all fields' columns, shape (m, sum of widths), as those of each."""
    return np.split(matrix, np.cumsum(widths)[:-1], axis=1)
