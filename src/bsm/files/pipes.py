"""Where bytes come from: files, pipes, memory, open files, URLs; opened once, and looked at before they are read."""

from __future__ import annotations

import errno
import glob
import io
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import BinaryIO, TypeAlias, Union, cast

from bsm.bitstream.errors import ArgumentError, BsmError, FormatError, LimitError
from bsm.files.remote import is_url, open_remote, state_of_remote, without_scheme_of_files

Source: TypeAlias = Union[str, "os.PathLike[str]", bytes, bytearray, memoryview, BinaryIO, "Input"]
"""A path ("-" is standard input) or URL, any buffer, or a binary file, which need not be seekable."""

_CHUNK = 1 << 18
_MAX_BYTES = 1 << 32


def named(path: str | os.PathLike[str]) -> str:
    """A path as a text; `ArgumentError` for what no file can be called."""
    name = without_scheme_of_files(os.fsdecode(path))
    if "\0" in name:
        raise ArgumentError(f"no file can be called {name!r}: there is a NUL in it")
    return name


class Input:
    """Bytes to be read once, from the beginning to the end."""

    def __init__(self, source: Source) -> None:
        self.name = ""
        self._file: BinaryIO | None = None
        self._opened = False
        self._held = b""
        if isinstance(source, (str, os.PathLike)):
            self.name = named(source)
        elif hasattr(source, "read"):
            self._file = cast(BinaryIO, source)
            self.name = str(getattr(source, "name", ""))
        else:
            try:
                self._file = io.BytesIO(source if isinstance(source, bytes) else memoryview(source).tobytes())
            except TypeError:
                raise ArgumentError(
                    f"bytes, a path or a binary file are expected, not {type(source).__name__}"
                ) from None

    @property
    def is_file(self) -> bool:
        """Whether this is the path of a regular file, which can be opened as often as one likes."""
        return self._file is None and self.name != "-" and os.path.isfile(self.name)

    def peek(self, size: int) -> bytes:
        """The first bytes that are still to be read, up to `size` of them; fewer only at the end."""
        if self.is_file:
            with open(self.name, "rb") as file:
                return file.read(size)
        self._hold(size)
        return self._held[:size]

    def chunks(self) -> Iterator[bytes]:
        """All bytes, as they come."""
        try:
            while piece := self._held or self._receive():
                self._held = b""
                yield piece
        finally:
            self.close()

    def read(self, size: int = _MAX_BYTES) -> bytes:
        """The next `size` bytes; fewer at the end."""
        self._hold(size)
        taken, self._held = self._held[:size], self._held[size:]
        return taken

    def read_all(self) -> bytes:
        """All bytes; `LimitError` beyond 4 GiB."""
        pieces: list[bytes] = []
        size = 0
        for piece in self.chunks():
            pieces.append(piece)
            size += len(piece)
            if size > _MAX_BYTES:
                raise LimitError(f"the file is larger than {_MAX_BYTES} bytes")
        return b"".join(pieces)

    def _hold(self, size: int) -> None:
        """Wait for `size` bytes, or the end."""
        pieces, held = [self._held], len(self._held)
        while held < size and (piece := self._receive()):
            pieces.append(piece)
            held += len(piece)
        self._held = b"".join(pieces)

    def _receive(self) -> bytes:
        """What comes next, waiting for it if need be; nothing at the end."""
        if self._file is None:
            if os.path.isdir(self.name):
                raise FormatError("this is a folder, not a file")
            self._opened = self.name != "-"
            # Closed at its end, or where `chunks` ends.
            self._file = _opened(self.name) if self._opened else standard_input()
        read = getattr(self._file, "read1", self._file.read)
        piece = read(_CHUNK)
        if isinstance(piece, str):
            raise ArgumentError("a binary file is expected, not one of text; open it with mode 'rb'")
        if not piece:
            self.close()
            return b""
        if not isinstance(piece, (bytes, bytearray, memoryview)):
            raise ArgumentError(f"a binary file is expected, whose read() gives bytes, not {type(piece).__name__}")
        return bytes(piece)

    def close(self) -> None:
        """Close what was opened here; nothing more is read."""
        if self._opened and self._file is not None:
            self._file.close()
            self._file, self._opened = io.BytesIO(), False


def _opened(name: str) -> BinaryIO:
    return open_remote(name) if is_url(name) else open(name, "rb")


def as_input(source: Source) -> Input:
    """`source` as an `Input`; one that is already being read goes on."""
    return source if isinstance(source, Input) else Input(source)


def is_pipe(source: Source) -> bool:
    """Whether a path names what can be read once only: standard input ("-"), a named pipe, a socket or a terminal."""
    if not isinstance(source, (str, os.PathLike)):
        return False
    again = os.path.isfile(source) or os.path.isdir(source)
    return os.fspath(source) == "-" or (os.path.exists(source) and not again)


def read_bytes(source: Source) -> bytes:
    """All bytes of a source; `LimitError` beyond 4 GiB."""
    return as_input(source).read_all()


def read_chunks(source: Source) -> Iterator[bytes]:
    """The bytes of a source, as they come."""
    return as_input(source).chunks()


def standard_input() -> BinaryIO:
    """Raises `OSError` if it is closed."""
    if sys.stdin is None:
        raise OSError(errno.EBADF, "standard input is closed")
    return sys.stdin.buffer


def standard_output() -> BinaryIO:
    """Raises `OSError` if it is closed."""
    if sys.stdout is None:
        raise OSError(errno.EBADF, "standard output is closed")
    return sys.stdout.buffer


@contextmanager
def about(path: str) -> Iterator[None]:
    """Put the name of the file that it is about before the message of whatever is raised inside."""
    try:
        yield
    except BsmError as error:
        error.message = f"{path}: {error.message}"
        raise


State = list[object]
"""Name, size and version of each file, as JSON gives it back."""


def files_behind(path: str) -> Iterator[str]:
    """The files behind an input or output: itself, or what a folder or a pattern names, in order."""
    if is_url(path):
        yield path
    elif os.path.isdir(path):
        yield from sorted(entry.path for entry in os.scandir(path))
    elif glob.has_magic(path) and not os.path.exists(path):
        yield from sorted(glob.iglob(path))
    else:
        yield path


def state_of(path: str) -> State | None:
    """Sizes and times of the files behind an input or output; None where that cannot be told."""
    found: State = []
    for file in files_behind(path):
        if is_url(file):
            state = state_of_remote(file)
            if state is None or not state.version:
                return None
            found.append([file, state.size, state.version])
        elif os.path.isfile(file):
            about = os.stat(file)
            found.append([file, about.st_size, str(about.st_mtime_ns)])
    return found or None


def size_of(path: str) -> int | None:
    """Bytes of the files behind an input or output; None for a pipe, and where a server does not say."""
    if is_url(path):
        state = state_of_remote(path)
        return state.size if state else None
    sizes = [os.path.getsize(file) for file in files_behind(path) if os.path.isfile(file)]
    return sum(sizes) if sizes else None
