"""The frames of a GOP, and repeated frames: loops, still and reversed motion are coded once."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import islice

import numpy as np

from bsm.codec.arrays import Matrix, Order, Positions
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.sequence.temporal import Decomposition, Motion
from bsm.codec.static.attributes.encoding import Values
from bsm.codec.static.preamble_encoding import Prepared

SAME = 1 / 64, 1 / 4
"""Largest difference of a repeated frame, in steps: the root mean square of coordinates, and each of them."""
LOOKED_AT = 32  # coordinates that most frames differ in


@dataclass(eq=False)
class Group:
    """The frames of a GOP, in the order of coding."""

    positions: Positions
    moving: dict[str, Values]
    _motion: Motion | None = field(default=None, init=False)
    _decomposition: Decomposition | None = field(default=None, init=False)

    def __len__(self) -> int:
        return len(self.positions)

    def motion(self, step: float) -> Motion:
        """Return the decomposed positions, as fine as steps that are not much finer than before need them."""
        if self._motion is None or step < self._motion.finest:
            self._decomposition = self._decomposition or Decomposition(self.positions)
            self._motion = self._decomposition.motion(step)
        return self._motion


def next_group(
    frames: Iterator[Matrix], longest: int, prepared: Prepared, moving: Sequence[Attribute]
) -> Group:
    """Return the next frames, shapes (n, 3 + ...), as many as a GOP may have; none after the last."""
    widths = [attribute.components for attribute in moving]
    ends = np.cumsum([3, *widths])[:-1]
    columns: list[list[Values]] = [[] for _ in moving]

    def positions() -> Iterator[Matrix]:
        for frame in islice(frames, longest):
            first, *others = np.split(frame, ends, axis=1) if moving else [frame]
            for column, attribute, values in zip(columns, moving, others, strict=True):
                column.append(values.astype(attribute.values.dtype))
            yield prepared.units.into(first)

    # Not a list first, which would hold them twice.
    kind = np.dtype((np.float64, (len(prepared.positions), 3)))
    group: Positions = np.fromiter(positions(), kind)
    return Group(
        group,
        {
            attribute.name: np.array(column_of)
            for attribute, column_of in zip(moving, columns, strict=True)
        },
    )


def same_frames(frames: Positions, moving: Sequence[Values], step: float) -> Order:
    """The first frame that each one is the same as, far below what `step` leaves, shape (T,)."""
    rows = frames.reshape(len(frames), -1)
    glimpses = np.ascontiguousarray(rows[:, :: max(1, rows.shape[1] // LOOKED_AT)])
    same = np.arange(len(frames))
    for number in range(1, len(frames)):
        alike = np.abs(glimpses[:number] - glimpses[number]).max(axis=1) <= SAME[1] * step
        for later in np.flatnonzero(alike & (same[:number] == np.arange(number))):
            if _same(rows[later] - rows[number], step) and all(
                (column[later] == column[number]).all() for column in moving
            ):
                same[number] = later
                break
    return same


def _same(difference: Matrix, step: float) -> bool:
    mean, most = (share * step for share in SAME)
    return bool(
        difference @ difference <= len(difference) * mean**2 and np.abs(difference).max() <= most
    )


def distinct_frames(same: Order) -> tuple[Order, Order]:
    """One of all that are the `same`, shape (T,): their numbers, shape (Q,), and which of them each is, shape (T,)."""
    _, distinct, places = np.unique(same, return_index=True, return_inverse=True)
    return distinct, places
