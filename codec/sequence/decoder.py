"""A stream to the frames of a sequence, while it arrives."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from bsm.bitstream.container.header import Header
from bsm.bitstream.container.reader import END_OF_STREAM
from bsm.bitstream.errors import BsmError, FormatError, MeshError, UnsupportedError
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits
from bsm.bitstream.public import public
from bsm.codec.arrays import Faces, Positions
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.sequence.course import Course, DecoderRequest
from bsm.codec.sequence.events import Event, FrameEvent, Item
from bsm.codec.sequence.first_frame_decoding import FirstFrame
from bsm.codec.sequence.runs_decoding import Runs
from bsm.codec.signal.chain import AS_SPECIFIED, Trial
from bsm.codec.static.events import ConnectivityEvent
from bsm.codec.static.preamble_decoding import DecoderSetup
from bsm.codec.static.rules import chain_rules
from bsm.codec.static.stages import StreamDecoder
from bsm.codec.static.work import Allowance
from bsm.codec.threads import threads_of


@public
class SequenceDecoder(StreamDecoder[Item]):
    """Takes the bytes of a sequence's stream as they come, and gives events as soon as they can be known.

    Memory is bounded by one GOP. An error is raised by `next_event` after the events before it, and by every later
    call.

    Parameters
    ----------
    limits : Limits
        What the stream may ask for.
    threads : int, optional
        None: one per core.
    tolerant : bool
        Report a GOP that is lost or broken as `LossEvent`, and go on behind it, or behind a run where what comes before
        its GOPs is not whole; the stream may begin with any run.
    start : int
        Give no frame before this one; GOPs that it does not need are not decoded.
    trial : Trial, optional
        What is tried in place of what the specification says; see `codec.signal.chain`.

    Examples
    --------
    >>> import bsm
    >>> with bsm.SequenceDecoder() as decoder, open("dance.bsm", "rb") as file:
    ...     decoder.receive_data(file.read())
    ...     decoder.receive_eof()
    ...     frames = 0
    ...     while (event := decoder.next_event()) is not bsm.END_OF_STREAM:
    ...         frames += isinstance(event, bsm.FrameEvent)
    >>> frames
    6
    """

    def __init__(
        self,
        limits: Limits = DEFAULT_LIMITS,
        threads: int | None = None,
        *,
        tolerant: bool = False,
        start: int = 0,
        trial: Trial = AS_SPECIFIED,
    ) -> None:
        threads = threads_of(threads)
        self._attributes: list[Attribute] = []
        request = DecoderRequest(threads, tolerant, start, self._attributes)
        allowance, course = Allowance(limits), Course(tolerant=tolerant)
        setup = DecoderSetup(
            allowance,
            check=lambda header: check_header(header, limits),
            begin=lambda structure: FirstFrame(structure, request, course),
            trial=trial,
            threads=threads,
        )
        super().__init__(Runs(setup, request, course), allowance, tolerant=tolerant)

    @property
    def attributes(self) -> tuple[Attribute, ...]:
        """Attributes of all frames of the present run, that are whole; all of them when its first frame is."""
        return tuple(self._attributes)

    def close(self) -> None:
        """Give up what was not asked for."""
        self._queue.clear()

    def next_event(self) -> Event:
        """The next event, or `NEED_DATA`; `END_OF_STREAM` after `EndEvent` and `receive_eof`.

        Raises
        ------
        BsmError
            One of the stream's errors, with its place.
        """
        while self._queue or self._read():
            if not self._queue:
                continue
            item = self._queue[0]
            event = self._next_frame(item) if isinstance(item, Iterator) else item
            if not isinstance(event, FrameEvent):
                self._queue.popleft()
            if event is not None:
                return event
        return self._signal()

    def _next_frame(self, frames: Iterator[FrameEvent]) -> FrameEvent | None:
        try:
            return next(frames, None)
        except BsmError as error:
            raise self._fail(error) from None


def check_header(header: Header, limits: Limits) -> None:
    """Raise what is wrong with the header of a sequence, or beyond `limits`, before anything is done for it."""
    if not header.gop_frames:
        raise FormatError("this is a static mesh and no sequence; decode it with bsm.decode or bsm.Decoder")
    if header.smoothing:
        raise UnsupportedError("smoothing of sequences is unknown to this decoder")
    chain_rules(header)
    limits.check("sequence_bytes", 8.0 * header.vertices * header.coefficients)


def decode_sequence(
    data: bytes, limits: Limits = DEFAULT_LIMITS, threads: int | None = None
) -> tuple[Positions, Faces]:
    """Decode a complete sequence."""
    frames: list[Positions] = []
    faces = np.zeros((0, 3), np.int32)
    vertices = 0
    with SequenceDecoder(limits, threads) as decoder:
        decoder.receive_data(data)
        decoder.receive_eof()
        while (event := decoder.next_event()) is not END_OF_STREAM:
            match event:
                case ConnectivityEvent(received, vertices=count):
                    if frames and not np.array_equal(faces, received):
                        raise MeshError(
                            f"the faces change at frame {len(frames)}: this is no array of frames; "
                            "bsm.decode_frames gives them one by one"
                        )
                    faces, vertices = received, count
                case FrameEvent(_, positions):
                    frames.append(positions)
    return np.array(frames).reshape(-1, vertices, 3), faces
