"""Streams to meshes and frames: the decoders of `import bsm`, over the decoder in C (`library/`)."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import wraps
from threading import RLock
from typing import Any, ClassVar, Concatenate, ParamSpec, TypeAlias, TypeVar

import numpy as np
import numpy.typing as npt

from bsm._core import Decoder as Engine
from bsm._core import DecoderState
from bsm.bitstream.container.header import Header, MetadataValue, values_of
from bsm.bitstream.container.wire import PREAMBLE_BYTES
from bsm.bitstream.errors import (
    ArgumentError,
    BsmError,
    FormatError,
    OptionError,
    UnsupportedError,
    public,
)
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits, as_limits
from bsm.codec import events
from bsm.codec.arrays import Faces, sealed
from bsm.codec.choices import checked_whole
from bsm.codec.geometry.attributes import DOMAINS, SEMANTICS, Attribute
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.progress import Progress
from bsm.codec.threads import threads_of

Buffer: TypeAlias = bytes | bytearray | memoryview | npt.NDArray[Any]
Event: TypeAlias = (
    events.HeaderEvent
    | events.ConnectivityEvent
    | events.BlockEvent
    | events.RefinementEvent
    | events.AttributeEvent
    | events.FrameEvent
    | events.LossEvent
    | events.EndEvent
    | events.Signal
)
Self = TypeVar("Self", bound="StreamDecoder")
Given = ParamSpec("Given")
Result = TypeVar("Result")

# Types of events, in the order of bsmdec.h.
(
    NEED,
    HEADER,
    METADATA,
    CONNECTIVITY,
    BLOCK,
    REFINEMENT,
    ATTRIBUTE,
    FRAME,
    LOSS,
    END,
    OVER,
    _ERROR,
    VALUES,
) = range(13)


def mask_of(*types: int) -> int:
    return sum(1 << kind for kind in types)


ALWAYS_TAKEN = mask_of(HEADER, METADATA)
RESULT_ONLY = mask_of(END)


def _in_turn(
    method: Callable[Concatenate[Self, Given], Result],
) -> Callable[Concatenate[Self, Given], Result]:
    """Let threads that share a decoder take turns, so that an event and its arrays go to one of them."""

    @wraps(method)
    def guarded(self: Self, /, *args: Given.args, **kwargs: Given.kwargs) -> Result:
        # Event and arrays are two calls into C. Another thread between them would take the arrays of this one.
        with self._turn:
            return method(self, *args, **kwargs)

    return guarded


class StreamDecoder:
    """Base of the decoders of meshes and sequences."""

    _wanted: ClassVar[int]
    _of_sequences: ClassVar[bool]
    _misfit: ClassVar[tuple[type[FormatError | UnsupportedError], str]]

    def __init__(
        self,
        limits: Limits | str,
        threads: int | None,
        *,
        tolerant: bool = False,
        start: int = 0,
        layers: int = 0,
    ) -> None:
        self._engine: Engine | None = Engine(
            as_limits(limits), threads_of(threads), bool(tolerant), start, layers
        )
        self._turn = RLock()
        self._tolerant = tolerant
        self._finished = False
        self._error: BsmError | None = None
        self._entries = self._received = 0
        # Figures such as the work stay known after `close`, which gives the memory back.
        self._last = self._engine.state()
        self.metadata: Mapping[str, MetadataValue] = {}
        """Metadata of the mesh, as far as it has arrived."""

    def __enter__(self: Self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @_in_turn
    def close(self) -> None:
        """Release the decoder's memory; no more events can be asked for."""
        if self._engine is not None:
            self._last, self._engine = self._state, None

    @property
    def _state(self) -> DecoderState:
        return self._last if self._engine is None else self._engine.state()

    @property
    def work(self) -> float:
        """Nanoseconds of a processor core that the stream has cost so far, by the estimates that limits bound."""
        return self._state.work

    @property
    def vertices(self) -> int:
        """How many have come with faces; by them memory and work are bounded."""
        return self._state.vertices

    @_in_turn
    def receive_data(self, data: Buffer) -> None:
        """Take more bytes of the stream, in any buffer and of any number."""
        given: Any = data
        try:
            view = memoryview(given)
        except (TypeError, ValueError):
            raise ArgumentError(
                f"bytes of a stream are expected, not {type(data).__name__}"
            ) from None
        if self._finished:
            raise OptionError("bytes were given to a decoder after receive_eof")
        with view:
            if view.nbytes:
                self._received += view.nbytes
                # Without a copy where the bytes lie in order already, as they nearly always do.
                plain = view if view.c_contiguous and view.nbytes == len(view) else view.tobytes()
                self._open.push(np.frombuffer(plain, np.uint8))

    @_in_turn
    def receive_eof(self) -> None:
        """Signal the end of input."""
        self._finished = True
        self._open.finish()

    def events(self, chunks: Iterable[Buffer]) -> Iterator[Any]:
        """Decode a stream that arrives in chunks; yield each event as soon as its bytes are available."""
        given = iter(chunks)
        while (event := self.next_event()) is not events.END_OF_STREAM:
            if event is not events.NEED_DATA:
                yield event
            elif (chunk := next(given, None)) is not None:
                self.receive_data(chunk)
            else:
                self.receive_eof()

    @_in_turn
    def next_event(self) -> Event:
        """The next event, or `NEED_DATA`; `END_OF_STREAM` after `EndEvent` and `receive_eof`; raises a `BsmError`."""
        try:
            while (event := self._event(*self._next(self._wanted))) is None:
                pass
        except BsmError as error:
            # An error ends the stream. Asked again, the decoder gives the same answer and not another one.
            self._error = error
            raise
        return event

    def _event(self, kind: int, index: int, count: int, vertices: int, faces: int) -> Event | None:
        engine = self._open
        match kind:
            case 0:
                return events.NEED_DATA
            case 1:
                return events.HeaderEvent(self._header)
            case 3:
                loose = events.Changes(*engine.loose())
                return events.ConnectivityEvent(engine.faces(faces), vertices, loose)
            case 4:
                return events.BlockEvent(*engine.changes(), index)
            case 5:
                moved, positions, _ = engine.changes()
                return events.RefinementEvent(moved, positions)
            case 6 | 12:
                name, domain, semantic, indices, rows, values = engine.values(index)
                if not len(rows):  # computed from positions
                    return None
                return events.AttributeEvent(
                    name, DOMAINS[domain], SEMANTICS[semantic], indices, rows, values
                )
            case 9:
                return events.EndEvent()
            case 10:
                return events.END_OF_STREAM
        raise AssertionError(f"event {kind} was not asked for")

    @property
    def _open(self) -> Engine:
        if self._engine is None:
            raise OptionError("this decoder was closed")
        return self._engine

    def _next(self, wanted: int) -> tuple[int, int, int, int, int]:
        """The next event of some types; metadata that come before it are taken in."""
        if self._error is not None:
            raise self._error
        while True:
            event = self._open.next(wanted | ALWAYS_TAKEN)
            # Python has no event for metadata: they are set by the time of the next event.
            if event[0] == METADATA:
                entries = [self._open.metadata(index) for index in range(self._entries, event[1])]
                self.metadata, self._entries = {**self.metadata, **dict(entries)}, event[1]
                continue
            if event[0] == HEADER:
                self._header = Header(**values_of(Header, self._open.header()))
                # Said at the header, before anything is decoded, and with the name of the function that takes such
                # streams.
                if bool(self._header.gop_frames) != self._of_sequences:
                    kind, text = self._misfit
                    self._error = kind(text, offset=PREAMBLE_BYTES, frame=0)
                    raise self._error
            return event

    def _attribute(self, index: int) -> tuple[Attribute, bool] | None:
        """An attribute and whether it moves; None where it is not whole."""
        found = self._open.attribute(index)
        if found is None:
            return None
        name, domain, semantic, values, indices, moves = found
        return Attribute(name, values, DOMAINS[domain], SEMANTICS[semantic], indices), moves

    def _loss(self) -> BsmError:
        error: BsmError = self._open.loss()
        return error


@public
class Decoder(StreamDecoder):
    """Decode a stream while its bytes arrive: push bytes, and take events.

    The events do not depend on how you split the bytes. `next_event` raises an error after the events before it, and
    again at every later call.

    Parameters
    ----------
    limits : Limits
        Limits on the memory and work of the stream.
    threads : int, optional
        Threads for chains whose bytes are available at the same time; None: one per core.
    tolerant : bool
        Report damage to blocks as `LossEvent` and continue with every block that does not depend on the lost data.
        Damage before the first block is still raised.
    layers : int, optional
        Number of layers to decode: 1 is the base, 2 or None also the layer of refinement. The decoder does not wait
        for later data.

    Examples
    --------
    >>> import bsm
    >>> with bsm.Decoder() as decoder, open("bunny.bsm", "rb") as file:
    ...     for event in decoder.events(iter(lambda: file.read(1000), b"")):
    ...         if isinstance(event, bsm.BlockEvent):
    ...             moved = event.vertices, event.positions
    """

    _wanted = mask_of(CONNECTIVITY, BLOCK, REFINEMENT, ATTRIBUTE, VALUES, LOSS, END)
    _of_sequences = False
    _misfit = (
        UnsupportedError,
        "this is a sequence, and not a mesh (in Python, bsm.decode_sequence)",
    )

    def __init__(
        self,
        limits: Limits | str = DEFAULT_LIMITS,
        threads: int | None = None,
        *,
        tolerant: bool = False,
        layers: int | None = None,
    ) -> None:
        most = 0 if layers is None else min(checked_whole("layers", layers, 1), 2)
        super().__init__(limits, threads, tolerant=tolerant, layers=most)
        self._sizes: tuple[int, int] | None = None

    @_in_turn
    def decode_rest(self, progress: Progress | None = None) -> TriangleMesh:
        """Decode the rest of a complete stream and return the mesh. This is faster than taking events.

        Parameters
        ----------
        progress : callable, optional
            Called with the number of decoded bytes, and of all bytes.

        Raises
        ------
        BsmError
            Also `TruncatedError`, if bytes are missing.
        """
        self.receive_eof()
        # Fewer events are fewer calls from C to Python, and that is the time of small meshes.
        wanted = RESULT_ONLY
        if progress is not None:
            wanted = mask_of(END, BLOCK, REFINEMENT, ATTRIBUTE, VALUES)
        while (event := self._next(wanted))[0] != OVER:
            if event[0] == END:
                self._sizes = event[3:]
            elif progress is not None:
                progress(self._open.state().offset, self._received)
        assert self._sizes is not None
        vertices, faces = self._sizes
        # Sealed, so that the mesh has these arrays and no copies.
        positions, triangles = (
            sealed(self._open.positions(vertices)),
            sealed(self._open.faces(faces)),
        )
        return TriangleMesh(positions, triangles, self.attributes, self.metadata)

    finish = decode_rest  # its name in earlier releases

    @property
    @_in_turn
    def attributes(self) -> tuple[Attribute, ...]:
        """Attributes that are complete; computed attributes are complete when the positions are."""
        found = (self._attribute(index) for index in range(self._open.attribute_count()))
        return tuple(attribute for attribute, _ in filter(None, found))

    def _event(self, kind: int, index: int, count: int, vertices: int, faces: int) -> Event | None:
        if kind == LOSS:
            return events.LossEvent(None if index < 0 else index, self._loss())
        if kind == END:
            self._sizes = vertices, faces
            return (
                events.EndEvent(events.Losses(*self._open.losses()))
                if self._tolerant
                else events.EndEvent()
            )
        return super()._event(kind, index, count, vertices, faces)


@public
class SequenceDecoder(StreamDecoder):
    """Decode a sequence while its bytes arrive: push bytes, and take events.

    Memory is bounded by one GOP. `next_event` raises an error after the events before it, and again at every later
    call.

    Parameters
    ----------
    limits : Limits
        Limits on the memory and work of the stream.
    threads : int, optional
        None: one per core.
    tolerant : bool
        Report a lost or damaged GOP as `LossEvent`, and continue after it, or after the run if the data before its GOPs
        is incomplete. The stream may begin with any run.
    start : int
        Index of the first frame to return; GOPs that it does not need are skipped.

    Examples
    --------
    >>> import bsm
    >>> with bsm.SequenceDecoder() as decoder, open("dance.bsm", "rb") as file:
    ...     sum(isinstance(event, bsm.FrameEvent) for event in decoder.events(file))
    6
    """

    _wanted = mask_of(CONNECTIVITY, ATTRIBUTE, VALUES, FRAME, LOSS, END)
    _of_sequences = True
    _misfit = FormatError, "this is a mesh, and not a sequence (in Python, bsm.decode)"

    def __init__(
        self,
        limits: Limits | str = DEFAULT_LIMITS,
        threads: int | None = None,
        *,
        tolerant: bool = False,
        start: int = 0,
    ) -> None:
        super().__init__(limits, threads, tolerant=tolerant, start=checked_whole("start", start, 0))
        self._faces: Faces = np.zeros((0, 3), np.int32)
        self._known: dict[int, tuple[Attribute, bool]] = {}

    @property
    @_in_turn
    def attributes(self) -> tuple[Attribute, ...]:
        """Complete attributes of the current run; all of them once its first frame is complete."""
        return tuple(attribute for attribute, _ in self._known.values())

    def _event(self, kind: int, index: int, count: int, vertices: int, faces: int) -> Event | None:
        if kind == LOSS:
            return events.LossEvent(
                None, self._loss(), range(index, index + count) if index >= 0 else range(0)
            )
        if kind == FRAME:
            return events.FrameEvent(
                index, self._open.positions(vertices), self._faces, tuple(self._in_frame())
            )
        if kind == HEADER:
            self._known.clear()
        if kind == ATTRIBUTE:
            self._know(index)
        event = super()._event(kind, index, count, vertices, faces)
        if isinstance(event, events.ConnectivityEvent):
            self._faces = event.faces
            # A run may have the mesh of an earlier one, and then no attribute arrives again.
            # Those of an earlier run of this mesh.
            for number in range(self._open.attribute_count()):
                self._know(number)
        return event

    def _know(self, index: int) -> None:
        found = self._attribute(index)
        if found is not None:
            self._known[index] = found

    def _in_frame(self) -> Iterator[Attribute]:
        """The attributes of the present frame."""
        for index, (attribute, moves) in self._known.items():
            # Attributes that stand still are handed out as the same arrays, which callers may compare by identity.
            found = self._attribute(index) if moves else None
            yield attribute if found is None else found[0]


def decode(
    data: bytes, limits: Limits | str = DEFAULT_LIMITS, threads: int | None = None
) -> TriangleMesh:
    """Decode a complete stream."""
    with Decoder(limits, threads) as decoder:
        decoder.receive_data(data)
        return decoder.decode_rest()
