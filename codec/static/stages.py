"""The frame of both decoders: bytes come, the stage where a decoder stands takes the packets in, events go."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from types import TracebackType
from typing import Any, Generic, Protocol, TypeAlias, TypeVar

from bsm.bitstream.container.packets import Damaged, Metadata, MetadataValue, Packet
from bsm.bitstream.container.reader import END_OF_STREAM, NEED_DATA, Buffer, Reader, Signal, TolerantReader
from bsm.bitstream.errors import BsmError, CorruptError
from bsm.codec.static.work import Allowance

Item = TypeVar("Item")
Self = TypeVar("Self", bound="StreamDecoder[Any]")
Arrival: TypeAlias = Packet | Damaged | Signal  # what a stage takes in; of the signals only `END_OF_STREAM`, once


class Stage(Protocol[Item]):
    """Where a decoder stands."""

    def accept(self, arrival: Arrival, queue: deque[Item]) -> Stage[Item]:
        """Take in what comes next, queue what follows from it, and say where the decoder stands then."""


class Ended:
    """Everything was there."""

    def accept(self, arrival: Arrival, queue: deque[Any]) -> Stage[Any]:
        raise misplaced(arrival)


@dataclass(frozen=True, eq=False)
class Failed:
    """The first error; it is raised when the events before it were taken, and then by every call."""

    error: BsmError

    def accept(self, arrival: Arrival, queue: deque[Any]) -> Stage[Any]:
        raise self.error


def misplaced(arrival: Arrival) -> CorruptError:
    """The error for what may not come where it does."""
    if arrival is END_OF_STREAM:
        return CorruptError("the stream ends before its first block")
    return CorruptError(f"{type(arrival).__name__} may not come here")


class StreamDecoder(ABC, Generic[Item]):
    """Takes the bytes of a stream as they come, and queues what follows from them."""

    def __init__(self, first: Stage[Item], allowance: Allowance, *, tolerant: bool = False) -> None:
        self._allowance = allowance
        self._tolerant = tolerant
        self._reader = (TolerantReader if tolerant else Reader)(allowance.limits, allowance.spend)
        self._queue: deque[Item] = deque()
        self._stage = first
        self.metadata: Mapping[str, MetadataValue] = {}
        """What the author has said of the mesh, as far as it has come."""

    def __enter__(self: Self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    @abstractmethod
    def close(self) -> None:
        """Stop the threads; what was not asked for is given up."""

    @property
    def work(self) -> float:
        """Nanoseconds of a processor core that the stream has cost so far, by the estimates that limits bound."""
        return self._allowance.spent

    @property
    def vertices(self) -> int:
        """How many have come with faces; by them memory and work are bounded."""
        return self._allowance.vertices

    def receive_data(self, data: Buffer) -> None:
        """Take more bytes of the stream, in any buffer; raises as `Reader.receive_data`."""
        self._reader.receive_data(data)

    def receive_eof(self) -> None:
        """Take note that no more bytes will come."""
        self._reader.receive_eof()

    def events(self, chunks: Iterable[Buffer]) -> Iterator[Any]:
        """What comes of a stream that comes in chunks: each event as soon as its bytes are there, to the end."""
        given = iter(chunks)
        while (event := self.next_event()) is not END_OF_STREAM:
            if event is not NEED_DATA:
                yield event
            elif (chunk := next(given, None)) is not None:
                self.receive_data(chunk)
            else:
                self.receive_eof()

    @abstractmethod
    def next_event(self) -> Any:
        """The next event, or `NEED_DATA`; `END_OF_STREAM` after `EndEvent` and `receive_eof`."""

    def _read(self) -> bool:
        """Take one packet in; False where there is none, or none can be any more."""
        if isinstance(self._stage, Ended | Failed):
            return False
        try:
            packet = self._reader.next_packet()
            if packet is NEED_DATA:
                return False
            if isinstance(packet, Metadata):
                self.metadata = {**self.metadata, **packet.entries}
            else:
                self._stage = self._stage.accept(packet, self._queue)
        except BsmError as error:
            span = self._reader.last_frame
            self._stage = Failed(error.located(offset=span.offset, frame=span.number) if span else error)
        return True

    def _signal(self) -> Signal:
        """Why there is no event, or the error in place of it."""
        match self._stage:
            case Failed(error):
                raise error
            case Ended():
                return END_OF_STREAM
            case _:
                return NEED_DATA

    def _fail(self, error: BsmError) -> BsmError:
        self._queue.clear()
        self._stage = Failed(error)
        return error
