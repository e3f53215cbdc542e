"""Streams from files and pipes, decoded whole or frame by frame."""

import shlex
from collections.abc import Callable, Iterator
from itertools import chain
from pathlib import Path

import numpy as np

from bsm.bitstream.container.header import Header
from bsm.bitstream.container.wire import MAGIC
from bsm.bitstream.errors import BsmError, FormatError, MeshError, TruncatedError
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits
from bsm.codec.arrays import Faces, Positions
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.mesh import Metadata, TriangleMesh
from bsm.codec.progress import Progress
from bsm.files.pipes import Input, Source, as_input, is_pipe, is_url
from bsm.files.table import FORMATS, GLTF, MESH_FORMATS, format_of_bytes, format_of_name


def is_stream(source: Source) -> bool:
    """Whether something begins like a stream; nothing is taken from an `Input`, and the path of a pipe is not asked."""
    return not is_pipe(source) and as_input(source).peek(len(MAGIC)) == MAGIC


MANIFEST = "manifest.json"  # of a folder of tiles


def is_tiles(path: str) -> bool:
    """Whether a folder, or a URL that ends with a slash, holds a manifest."""
    if is_url(path):
        return path.endswith("/")
    return Path(path, MANIFEST).is_file()


def is_scene(path: str) -> bool:
    """Whether a path is that of a glTF scene; a stream may have any name."""
    return Path(path).suffix[1:].lower() in GLTF and not is_stream(path)


def refuse_mesh(path: str) -> None:
    """Raise an error that names the right command if a file is a mesh, and not a stream."""
    if Path(path).is_file() and not is_stream(path):
        with open(path, "rb") as file:
            kind = format_of_bytes(file.read(1 << 12))
        if kind is not None or format_of_name(path) in MESH_FORMATS:
            raise FormatError(
                f"this is a mesh file, not a stream; to make one, run: bsm encode {shlex.quote(path)}"
            )


def refuse_mesh_file(source: Input) -> None:
    """Raise an error that names the right function if an input begins like a mesh file, and not like a stream."""
    if is_stream(source):
        return
    kind = format_of_bytes(source.peek(1 << 12))
    if kind is not None:
        raise FormatError(
            f"this is {FORMATS[kind].called or kind}, not a BSM stream; bsm.load reads it", offset=0
        )


def decode_whole(
    chunks: Iterator[bytes],
    limits: Limits = DEFAULT_LIMITS,
    threads: int | None = None,
    *,
    layers: int | None = None,
    progress: Progress | None = None,
) -> TriangleMesh:
    # Here and not above: most commands only ask whether a file is a stream, and loading the decoder takes them longer
    # than that.
    from bsm.codec.decoding import Decoder

    with Decoder(limits, threads, layers=layers) as decoder:
        is_empty = True
        for chunk in chunks:
            is_empty = False
            decoder.receive_data(chunk)
        if is_empty:
            raise TruncatedError("there are no bytes: the input is empty", offset=0)
        return decoder.decode_rest(progress)


Note = Callable[[str], None]


def peek_header(chunks: Iterator[bytes]) -> tuple[Header | None, Iterator[bytes]]:
    """The header of a stream, and all of its bytes again; None where the stream is too short or no stream at all."""
    from bsm.files.inspection import Skimmer

    chunks_taken: list[bytes] = []
    # Wide limits, as only the header is wanted here; those of the caller hold when the bytes are decoded.
    skimmer = Skimmer(Limits.wide())
    for chunk in chunks:
        chunks_taken.append(chunk)
        try:
            if next(skimmer.receive(chunk), None) is not None:  # the first packet of a sound stream
                return skimmer.header, chain(chunks_taken, chunks)
        except BsmError:  # the decoder will report it
            break
    return None, chain(chunks_taken, chunks)


class SequenceStream:
    """A stream that is decoded while its frames are asked for."""

    def __init__(
        self,
        chunks: Iterator[bytes],
        note: Note | None = None,
        start: int = 0,
        limits: Limits = DEFAULT_LIMITS,
        threads: int | None = None,
    ) -> None:
        from bsm.codec.decoding import SequenceDecoder
        from bsm.codec.events import ConnectivityEvent, HeaderEvent

        self.header: Header
        self.faces: Faces
        self.run_starts: list[int] = []
        self._note = note
        self._present: tuple[Attribute, ...] | None = None
        decoder = SequenceDecoder(limits, threads, tolerant=note is not None, start=start)
        self._decoder = decoder
        self._events = decoder.events(chunks)
        for event in self._events:
            if isinstance(event, HeaderEvent):
                self.header = event.header
            elif isinstance(event, ConnectivityEvent):
                self.faces = event.faces
                return
        raise TruncatedError("the stream ends before its faces")

    @property
    def attributes(self) -> tuple[Attribute, ...]:
        """Attributes of the last frame; before the first frame, those that have arrived."""
        return self._decoder.attributes if self._present is None else self._present

    @property
    def metadata(self) -> Metadata:
        return self._decoder.metadata

    def frames(self) -> Iterator[tuple[int, Positions]]:
        """Number and positions, shape (n, 3), of one frame after the other."""
        for index, positions in self.changing_frames():
            if self.run_starts:
                raise MeshError(
                    f"the faces change at frame {index}: use bsm.decode_frames, bsm decode or bsm compare"
                )
            yield index, positions

    def changing_frames(self) -> Iterator[tuple[int, Positions]]:
        """Frames and their indices, where `faces` may change from frame to frame."""
        from bsm.codec.events import FrameEvent, LossEvent

        yielded = False
        for event in self._events:
            match event:
                case FrameEvent(index, positions, faces, attributes):
                    self._present = attributes
                    # Identity first: faces of one run are one array, and comparing millions of them for each frame
                    # would take as long as decoding.
                    if faces is not self.faces and not np.array_equal(faces, self.faces):
                        if yielded:
                            self.run_starts.append(index)
                        self.faces = faces
                    yielded = True
                    yield index, positions
                case LossEvent(_, error, frames):
                    assert self._note is not None
                    first, last = frames.start, frames.stop - 1
                    what = f"frames {first} to {last} are"
                    if first == last:
                        what = f"frame {first} is"
                    if not frames:
                        what = f"what follows frame {first} is"
                    self._note(f"{what} lost: {error}")


def decode_through(chunks: Iterator[bytes], limits: Limits = DEFAULT_LIMITS) -> int:
    """Decode a sequence to its end and keep nothing; the number of frames."""
    return sum(1 for _ in SequenceStream(chunks, limits=limits).changing_frames())
