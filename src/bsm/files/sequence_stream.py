"""Sequences from streams: told from meshes, and decoded as they come."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import chain

import numpy as np
import numpy.typing as npt

from bsm.bitstream.container.packets import Header
from bsm.bitstream.container.reader import NEED_DATA, Reader
from bsm.bitstream.errors import BsmError, MeshError, TruncatedError
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits
from bsm.codec.arrays import Faces, Positions
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.mesh import Metadata, TriangleMesh
from bsm.files.stream import events

Note = Callable[[str], None]
MOST_SAID = 12


def peek_header(chunks: Iterator[bytes]) -> tuple[Header | None, Iterator[bytes]]:
    """The header of a stream, and all of its bytes again; None where the stream is too short or no stream at all."""
    taken: list[bytes] = []
    reader = Reader()
    for chunk in chunks:
        taken.append(chunk)
        reader.receive_data(chunk)
        try:
            packet = reader.next_packet()
        except BsmError:  # whoever decodes it will say so
            break
        if packet is not NEED_DATA:
            assert isinstance(packet, Header)
            return packet, chain(taken, chunks)
    return None, chain(taken, chunks)


class SequenceStream:
    """A stream that is decoded while its frames are asked for."""

    def __init__(
        self, chunks: Iterator[bytes], note: Note | None = None, start: int = 0, limits: Limits = DEFAULT_LIMITS
    ) -> None:
        from bsm.codec.sequence.decoder import SequenceDecoder
        from bsm.codec.static.events import ConnectivityEvent, HeaderEvent

        self.header: Header
        self.faces: Faces
        self.run_starts: list[int] = []
        self._note = note
        self._present: tuple[Attribute, ...] | None = None
        decoder = SequenceDecoder(limits, tolerant=note is not None, start=start)
        self._decoder = decoder
        self._events = events(decoder, chunks)
        for event in self._events:
            if isinstance(event, HeaderEvent):
                self.header = event.header
            elif isinstance(event, ConnectivityEvent):
                self.faces = event.faces
                return
        raise TruncatedError("the stream ends before its faces")

    @property
    def attributes(self) -> tuple[Attribute, ...]:
        """What the frame that was given last carries; before the first one, as far as they have come."""
        return self._decoder.attributes if self._present is None else self._present

    @property
    def metadata(self) -> Metadata:
        """What belongs to the whole sequence."""
        return self._decoder.metadata

    def frames(self) -> Iterator[tuple[int, Positions]]:
        """Number and positions, shape (n, 3), of one frame after the other."""
        for index, positions in self.changing_frames():
            if self.run_starts:
                raise MeshError(
                    f"the faces change at frame {index}; only bsm decode and bsm compare take such sequences"
                )
            yield index, positions

    def changing_frames(self) -> Iterator[tuple[int, Positions]]:
        """Frames and their indices, where `faces` may change from frame to frame."""
        from bsm.codec.sequence.events import FrameEvent
        from bsm.codec.static.events import LossEvent

        given = False
        for event in self._events:
            match event:
                case FrameEvent(index, positions, faces, attributes):
                    self._present = attributes
                    if faces is not self.faces and not np.array_equal(faces, self.faces):
                        if given:
                            self.run_starts.append(index)
                        self.faces = faces
                    given = True
                    yield index, positions
                case LossEvent(_, error, frames):
                    assert self._note is not None
                    first, last = frames.start, frames.stop - 1
                    if not frames:
                        what = f"what follows frame {first} is"
                    else:
                        what = f"frame {first} is" if first == last else f"frames {first} to {last} are"
                    self._note(f"{what} lost: {error}")


def said_of_runs(starts: Sequence[int]) -> str:
    """In words, the frames before which faces change."""
    some = ", ".join(map(str, starts[:MOST_SAID]))
    rest = f" and {len(starts) - MOST_SAID} more" if len(starts) > MOST_SAID else ""
    return f"connectivity changes at frame{'s' if len(starts) > 1 else ''} {some}{rest}"


def numbered(faces: Faces, vertices: int) -> TriangleMesh:
    """A mesh whose positions are the numbers of its vertices: what reorders meshes then tells their order."""
    return TriangleMesh(np.repeat(np.arange(vertices, dtype=np.float64)[:, None], 3, axis=1), faces)


def numbers_of(positions: Positions) -> npt.NDArray[np.int64]:
    """The order that has come upon the positions of `numbered`."""
    return positions[:, 0].astype(np.int64)


def decode_through(chunks: Iterator[bytes], limits: Limits = DEFAULT_LIMITS) -> int:
    """Decode a sequence to its end and keep nothing; the number of frames."""
    return sum(1 for _ in SequenceStream(chunks, limits=limits).changing_frames())


Pieces = list[tuple[Positions, Faces]]
"""Frames, shape (T, n, 3), and their faces, shape (m, 3), of one run after the other."""


def all_frames(stream: SequenceStream) -> Pieces:
    """All frames."""
    return pieces_of((frame, stream.faces) for _, frame in stream.changing_frames())


def pieces_of(frames: Iterable[tuple[Positions, Faces]]) -> Pieces:
    """Frames with their faces, those together that share them."""
    found: list[tuple[list[Positions], Faces]] = []
    for positions, faces in frames:
        same = found and len(found[-1][0][0]) == len(positions) and np.array_equal(found[-1][1], faces)
        if not same:
            found.append(([], faces))
        found[-1][0].append(positions)
    return [(np.array(positions), faces) for positions, faces in found]
