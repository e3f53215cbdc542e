"""The frames of each GOP, as a run gives them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice

import numpy as np

from bsm.bitstream.errors import OptionError
from bsm.codec.arrays import Matrix, Order, Positions
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.sequence.returning import same_frames
from bsm.codec.static.attributes.levels import Values
from bsm.codec.static.preamble_encoding import Prepared


@dataclass(frozen=True, eq=False)
class Group:
    """The frames of a GOP, in the order of coding."""

    positions: Positions
    moving: dict[str, Values]

    def __len__(self) -> int:
        return len(self.positions)

    def moves(self, name: str) -> bool:
        """Whether the frames differ in an attribute."""
        values = self.moving[name]
        return bool((values != values[:1]).any())

    def same(self, step: float) -> Order:
        """Which frame each is the same as, shape (T,); see `same_frames`."""
        return same_frames(self.positions, list(self.moving.values()), step)


def next_group(frames: Iterator[Matrix], longest: int, prepared: Prepared, moving: Sequence[Attribute]) -> Group:
    """The next frames, shapes (n, 3 + ...), as many as a GOP may have; none behind the last."""
    widths = [one.components for one in moving]
    ends = np.cumsum([3, *widths])[:-1]
    found: list[list[Values]] = [[] for _ in moving]

    def positions() -> Iterator[Matrix]:
        for frame in islice(frames, longest):
            first, *others = np.split(frame, ends, axis=1) if moving else [frame]
            for own, one, values in zip(found, moving, others, strict=True):
                own.append(values.astype(one.values.dtype))
            yield prepared.units.into(first)

    # Not a list first, which would hold them twice.
    kind = np.dtype((np.float64, (len(prepared.positions), 3)))
    group: Positions = np.fromiter(positions(), kind)
    return Group(group, {one.name: np.array(own) for one, own in zip(moving, found, strict=True)})


def require_same(still: Mapping[str, Values], group: Group) -> None:
    """Raise `OptionError` if an attribute, shape (n, d), that was sent as one that does not move moves now."""
    for name, values in still.items():
        if (group.moving[name] != values).any():
            raise OptionError(f"{name!r} moves, and floats that do cannot be exact; ask for a bound")
