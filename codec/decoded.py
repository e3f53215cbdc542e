"""What the decoder makes of a stream that was just written, as arrays; `bsm.decoding` has the decoders of users."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from bsm._engine import Decoder
from bsm.bitstream.limits import Limits
from bsm.codec.arrays import Faces, Positions
from bsm.codec.geometry.attributes import Semantic
from bsm.codec.geometry.mesh import Metadata
from bsm.codec.threads import threads_of

NEED_DATA, METADATA, CONNECTIVITY, FRAME, END = 0, 2, 3, 7, 9  # types of events in engine/bsmdec.h
_OF_FRAMES = 1 << NEED_DATA | 1 << METADATA | 1 << CONNECTIVITY | 1 << FRAME | 1 << END
SEMANTICS: tuple[Semantic, ...] = ("generic", "color", "normal", "texcoord")


@dataclass(frozen=True, eq=False)
class DecodedAttribute:
    """Values, shape (k, c), and for corners which of them each has, shape (m, 3)."""

    name: str
    semantic: Semantic
    values: npt.NDArray[np.generic]
    indices: Faces | None
    moves: bool


@dataclass(frozen=True, eq=False)
class DecodedMesh:
    positions: Positions
    faces: Faces
    attributes: tuple[DecodedAttribute, ...]
    metadata: Metadata


def decoded_mesh(stream: bytes, limits: Limits, threads: int | None = 1) -> DecodedMesh:
    """Decode a mesh whole; raises what is wrong with the stream."""
    decoder = Decoder(limits, threads_of(threads))
    decoder.push(np.frombuffer(stream, np.uint8))
    decoder.finish()
    entries = 0
    while (event := decoder.next(1 << METADATA | 1 << END))[0] == METADATA:
        entries = event[1]
    *_, vertices, faces = event
    attributes, metadata = tuple(_attributes_of(decoder)), _metadata_of(decoder, entries)
    return DecodedMesh(decoder.positions(vertices), decoder.faces(faces), attributes, metadata)


def _attributes_of(decoder: Decoder) -> Iterator[DecodedAttribute]:
    for number in range(decoder.attribute_count()):
        found = decoder.attribute(number)
        if found is not None:
            name, _, semantic, values, indices, moves = found
            yield DecodedAttribute(name, SEMANTICS[semantic], values, indices, moves)


def _metadata_of(decoder: Decoder, entries: int) -> Metadata:
    return dict(decoder.metadata(number) for number in range(entries))


class FrameDecoder:
    """Decodes a sequence while it is written."""

    def __init__(self, limits: Limits, threads: int | None) -> None:
        self._decoder = Decoder(limits, threads_of(threads))
        self._entries = 0

    def take(self, chunk: bytes, *, last: bool) -> Iterator[tuple[int, int, int]]:
        """Yield the type of each event that a chunk of the stream leads to, with its vertices and faces."""
        self._decoder.push(np.frombuffer(chunk, np.uint8))
        if last:
            self._decoder.finish()
        while (event := self._decoder.next(_OF_FRAMES))[0] != NEED_DATA:
            kind, number, _, vertices, faces = event
            if kind == METADATA:
                self._entries = number
                continue
            yield kind, vertices, faces
            if kind == END:
                return

    def faces(self, count: int) -> Faces:
        return self._decoder.faces(count)

    def positions(self, count: int) -> Positions:
        return self._decoder.positions(count)

    def attributes(self) -> tuple[DecodedAttribute, ...]:
        """Return the attributes that are whole, as of the frame that came last."""
        return tuple(_attributes_of(self._decoder))

    @property
    def metadata(self) -> Metadata:
        return _metadata_of(self._decoder, self._entries)
