"""What the decoder of sequences reports."""

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TypeAlias

from bsm.bitstream.container.reader import Signal
from bsm.bitstream.errors import BsmError, CorruptError, public
from bsm.codec.arrays import Faces, Positions
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.static.events import AttributeEvent, ConnectivityEvent, EndEvent, HeaderEvent, LossEvent
from bsm.codec.static.units import unlike_the_encoders


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
    ...     [event.index for event in decoder.events(file) if isinstance(event, bsm.FrameEvent)]
    [2, 3, 4, 5]
    """

    index: int
    positions: Positions
    faces: Faces
    attributes: tuple[Attribute, ...] = ()

    def __repr__(self) -> str:
        return f"FrameEvent(frame {self.index}, {len(self.positions)} vertices)"


Event: TypeAlias = HeaderEvent | ConnectivityEvent | AttributeEvent | FrameEvent | LossEvent | EndEvent | Signal
Item: TypeAlias = Event | Iterator[FrameEvent]


@dataclass(frozen=True)
class DecoderRequest:
    """What the user of a `SequenceDecoder` asks for; see its parameters."""

    threads: int | None
    tolerant: bool
    start: int
    attributes: list[Attribute]  # those that have come, for the user


class Course:
    """How far a sequence has come, over all of its runs."""

    def __init__(self, *, tolerant: bool) -> None:
        self.next = 0
        self.positions = 0  # the checksum of those of all frames so far
        self.expected: int | None = None  # what the stream has at its end
        self.announced = 0
        self.lossy = False
        self._tolerant = tolerant
        self._lost = 0
        self._damage: BsmError | None = None  # the first since frames were lost

    @property
    def given(self) -> bool:
        return self.next > self._lost

    def lose(self, error: BsmError) -> None:
        """Take note that frames are lost; how many is known when the next ones come."""
        self._damage = self._damage or error.with_traceback(None)  # with which memory would stay

    def report_loss(self, frames: int, queue: deque[Item]) -> None:
        """Say that so many frames are lost, or raise that."""
        if not self._tolerant:
            raise CorruptError(f"{frames} frames from number {self.next} on are missing")
        error = self._damage or CorruptError("a GOP is missing")
        queue.append(LossEvent(None, error, range(self.next, self.next + frames)))
        self._damage = None
        self.next += frames
        self._lost += frames
        self.lossy = True

    def end(self, announced: int, queue: deque[Item]) -> None:
        """Say that nothing follows."""
        missing = announced - self.next if announced else 0
        if missing or (self._damage and not announced):
            self.report_loss(missing, queue)
        if not self.lossy and self.expected not in (None, self.positions):
            if not self._tolerant:
                raise unlike_the_encoders()
            queue.append(LossEvent(None, unlike_the_encoders()))
        queue.append(EndEvent())
