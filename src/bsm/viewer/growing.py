"""Streams that are still being written: what has come of them, and where a page enters."""

from __future__ import annotations

import os
import time
from collections.abc import Iterable, Iterator
from threading import Condition
from typing import BinaryIO

from bsm.bitstream.container.gop import method_of
from bsm.bitstream.container.header import HEADER_FIELDS
from bsm.bitstream.container.wire import MAGIC, FrameType, Tag, parse_map, parse_tag, parse_varint, write_preamble
from bsm.bitstream.errors import BsmError, CorruptError

_CHUNK = 1 << 18
_PAUSE = 0.05
"""Seconds between looks at a file that has not grown."""
_PATIENCE = 1.0
"""Seconds between looks whether a page is still there."""


class Growing:
    """A stream that one thread receives and others send on."""

    def __init__(self, name: str) -> None:
        self.name = name
        self._data = bytearray()
        self._over = False
        self._change = Condition()
        self._scanned = len(write_preamble())
        self._head: list[slice] = []  # of the present mesh: its header, all metadata so far, what is before its GOPs
        self._metadata: list[slice] = []
        self._entry: int | None = None

    def receive(self, chunks: Iterable[bytes]) -> None:
        """Take all bytes that come, until there are no more, or the stream says that it ends."""
        try:
            for chunk in chunks:
                self.take(chunk)
                if self._over:
                    return
        finally:
            self.end()

    def take(self, chunk: bytes) -> None:
        """Take bytes that have come."""
        with self._change:
            self._data += chunk
            self._scan()
            self._change.notify_all()

    def end(self) -> None:
        """Take note that no more bytes come."""
        with self._change:
            self._over = True
            self._change.notify_all()

    def begins(self) -> bool:
        """Whether this is a stream, or the beginning of one, once that is clear."""
        with self._change:
            self._change.wait_for(lambda: self._over or len(self._data) >= len(MAGIC))
            return self._data.startswith(MAGIC[: len(self._data)])

    def chunks(self) -> Iterator[bytes]:
        """What a page is sent: of what has come as much as it needs, then what comes, to the end; nothing now and
        then while nothing comes, so that whoever sends it on can look whether the page is still there."""
        with self._change:
            at = 0
            if self._entry is not None and not self._over:
                at = self._entry
                first = write_preamble() + b"".join(self._data[place] for place in self._head)
        if at > 0:
            yield first
        while True:
            with self._change:
                if not self._over and len(self._data) == at:
                    self._change.wait(_PATIENCE)
                piece = bytes(self._data[at : at + _CHUNK])
                if self._over and not piece:
                    return
            at += len(piece)
            yield piece

    def _scan(self) -> None:
        """Look at the frames that are there as a whole; nobody enters a stream behind damage."""
        try:
            while (tag := parse_tag(self._data, self._scanned)) and tag.end <= len(self._data):
                self._note(tag, slice(self._scanned, tag.end))
                self._scanned = tag.end
        except BsmError:
            self._entry = None
            self._scanned = len(self._data)

    def _note(self, tag: Tag, place: slice) -> None:
        self._over = tag.type == FrameType.END
        if tag.type == FrameType.METADATA:
            self._metadata.append(place)
        if tag.type == FrameType.HEADER:
            run = dict(parse_map(bytes(self._data[tag.payload : tag.checksum]))).get(HEADER_FIELDS["run"].key)
            again = isinstance(run, (list, tuple)) and len(run) > 1  # it has the mesh of an earlier run
            self._entry = None
            self._head = [] if again else [place, *self._metadata]
        elif tag.type == FrameType.GOP:
            first = parse_varint(self._data, tag.payload)
            if first is None or first[1] >= tag.checksum:
                raise CorruptError("a GOP has no method")
            if self._head and method_of(self._data[first[1]]).begins:
                self._entry = place.start
        elif self._head and self._entry is None:
            self._head.append(place)


def written_to(file: BinaryIO) -> Iterator[bytes]:
    """The bytes of a file that is still being written, until it is deleted or begun again; it is closed then."""
    size = 0
    with file:
        while (now := os.fstat(file.fileno())).st_nlink > 0 and now.st_size >= size:
            if chunk := file.read(_CHUNK):
                size += len(chunk)
                yield chunk
            else:
                time.sleep(_PAUSE)
