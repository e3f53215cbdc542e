"""Attributes that move: values of vertices that change from frame to frame."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from bsm.bitstream.container.declaration import Declaration
from bsm.bitstream.errors import NumericError
from bsm.codec.arrays import Matrix, Order
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.static.attributes.levels import Values


@dataclass(frozen=True, eq=False)
class MovingAttribute:
    """An attribute that moves, as a decoder knows it before the first GOP."""

    number: int
    declaration: Declaration
    first: Values | None
    rows: Order

    @property
    def width(self) -> int:
        """Numbers d of a vertex."""
        return self.declaration.components

    @property
    def start(self) -> Matrix:
        """What GOPs build upon, shape (n, d)."""
        return np.zeros((self.declaration.rows, self.width)) if self.first is None else beyond_one(self.first)

    def shown(self, attribute: Attribute, change: Matrix) -> Attribute:
        """The attribute in a frame, given in another, that differs from the first one by `change`, shape (n, d)."""
        assert self.first is not None
        return replace(attribute, values=changed(self.first, change)[self.rows])


def beyond_one(first: Values) -> Matrix:
    """What the values of the first frame, shape (n, d), have beyond those of vertex 0, which may be large."""
    wide = first.astype(np.float64)
    return np.asarray(wide - wide[:1])


def changed(first: Values, change: Matrix) -> Values:
    """Values, shape (n, d), that differ from the first frame's by so much; integers are the nearest of their kind."""
    with np.errstate(over="ignore", invalid="ignore"):
        values = first.astype(np.float64) + change
        if not np.isfinite(values).all():
            raise NumericError("values of an attribute that moves are not finite")
        if first.dtype.kind == "f":
            values = values.astype(first.dtype)
            if not np.isfinite(values).all():
                raise NumericError("values of an attribute that moves are beyond the range of their kind")
            return values
    kind = np.iinfo(first.dtype)
    return np.rint(values).clip(kind.min, kind.max).astype(first.dtype)
