"""What the decoder of sequences reports."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TypeAlias

from bsm.bitstream.container.reader import Signal
from bsm.bitstream.public import public
from bsm.codec.arrays import Faces, Positions
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.static.events import AttributeEvent, ConnectivityEvent, EndEvent, HeaderEvent, LossEvent


@public
@dataclass(frozen=True, eq=False)
class FrameEvent:
    """A frame has been decoded.

    Parameters
    ----------
    index : int
        Its number, from 0.
    positions : float64 array, shape (n, 3)
        In the mesh's unit.
    faces : int32 array, shape (m, 3)
        Its faces; another array only where they may have changed.
    attributes : tuple of Attribute
        Its attributes, as far as they have come: those that move with the values of this frame.

    Examples
    --------
    >>> import bsm
    >>> with bsm.SequenceDecoder(start=2) as decoder, open("dance.bsm", "rb") as file:
    ...     decoder.receive_data(file.read())
    ...     decoder.receive_eof()
    ...     while (event := decoder.next_event()) is not bsm.END_OF_STREAM:
    ...         if isinstance(event, bsm.FrameEvent):
    ...             print(event.index, end=" ")
    2 3 4 5
    """

    index: int
    positions: Positions
    faces: Faces
    attributes: tuple[Attribute, ...] = ()

    def __repr__(self) -> str:
        return f"FrameEvent(frame {self.index}, {len(self.positions)} vertices)"


Event: TypeAlias = HeaderEvent | ConnectivityEvent | AttributeEvent | FrameEvent | LossEvent | EndEvent | Signal
Item: TypeAlias = Event | Iterator[FrameEvent]
