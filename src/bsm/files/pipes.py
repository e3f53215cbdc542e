"""Where bytes come from: files, pipes, memory, open files, URLs; opened once, and looked at before they are read."""

import errno
import glob
import io
import os
import posixpath
import re
import shutil
import sys
import tempfile
import urllib.parse
from collections.abc import Iterator
from contextlib import AbstractContextManager, closing, contextmanager, nullcontext, suppress
from pathlib import Path
from typing import Any, BinaryIO, TypeAlias, Union, cast

from bsm.bitstream import errors
from bsm.files.table import OF_OTHERS

# At least two letters, as "C:" is a drive of Windows and not a scheme; "::" chains file systems of fsspec
# ("simplecache::s3://...").
_URL = re.compile(r"([a-zA-Z][a-zA-Z0-9+.-]+)(?:::|://)")
_PIECE, _IN_MEMORY = 1 << 20, 1 << 26
"""Bytes that are sent at a time, and those that wait in memory and not on the disk."""
_LONGEST_NAME = 1024  # of a file beside another: resolving takes the square of it
_WEB = ("http", "https")
_STAMPS = (
    "ETag",
    "etag",
    "Last-Modified",
    "LastModified",
    "last_modified",
    "mtime",
    "updated",
    "created",
    "checksum",
)
"""What file systems call what changes with a file."""


def is_url(path: str | os.PathLike[str]) -> bool:
    return isinstance(path, str) and _URL.match(path) is not None


def without_scheme_of_files(path: str) -> str:
    """Return the path of a `file://` URL; other names unchanged."""
    if not path.startswith("file://"):
        return path
    from urllib.request import url2pathname  # which takes with it all that speaks HTTP

    return url2pathname(urllib.parse.urlsplit(path).path)


# posixpath and not os.path: slashes part a URL on Windows, too.
def name_in(url: str) -> str:
    return posixpath.basename(_path(url).rstrip("/"))


def beside(url: str, name: str) -> str:
    return f"{_path(url).rpartition('/')[0]}/{name}"


# A mesh from a stranger names these files. Without the check of the folder, "../../.ssh/id_rsa" as the name of a
# texture would be copied into the stream.
def file_beside(folder: Path, name: str) -> Path:
    """The regular file in a folder, or below, that a file there names; why there is none as a `FormatError`."""
    if len(name) > _LONGEST_NAME:
        raise errors.FormatError(f"its name has {len(name)} characters")
    try:
        path = Path(folder, name).resolve()
        inside, is_file = path.is_relative_to(folder.resolve()), path.is_file()
    except (OSError, RuntimeError, ValueError) as error:  # of a loop of links, or a NUL
        raise errors.FormatError(f"it cannot be opened: {error}") from error
    if not inside:
        raise errors.FormatError("it is not in the folder of the mesh")
    if not is_file:
        raise errors.FormatError("no such file beside the mesh")
    return path


def refuse_link_out(folder: str, path: str) -> None:
    """Refuse a file that was found in a folder, and is a link to another one."""
    if not Path(path).resolve().is_relative_to(Path(folder).resolve()):
        raise errors.FormatError(
            "this is a link to another folder; name the file itself, or copy it here"
        )


def place_of(folder: str, name: str) -> str:
    """Return where a file of a folder or URL is; `FormatError` for a link out of the folder, or if it is not a file."""
    path = posixpath.join(folder, name)
    if is_url(folder):
        return path
    os.lstat(path)
    with about(path):
        return str(file_beside(Path(folder), name))


def expanded(url: str) -> list[str]:
    """Return the names that match a URL with ``*``, sorted; other URLs unchanged."""
    if "*" not in url:
        return [url]
    with _errors_of(url):
        files, path = _system(url)
        names = sorted(files.unstrip_protocol(name) for name in files.glob(path))
    if not names:
        raise FileNotFoundError(errno.ENOENT, "no such file", url)
    return names


@contextmanager
def _errors_of(url: str) -> Iterator[None]:
    """Whatever goes wrong in a library behind fsspec, as an `OSError` that names the file."""
    try:
        yield
    # fsspec says that a file is not found whatever the cause: only the error behind tells a missing file from a server
    # that cannot be reached, which is no reason to write a new output.
    except FileNotFoundError as error:
        behind = error.__cause__
        # No server, as aiohttp has it.
        if isinstance(behind, OSError) and behind.errno not in (None, errno.ENOENT):
            message = f"the server does not answer: {os.strerror(behind.errno or errno.EIO)}"
            raise OSError(behind.errno, message, url) from error
        raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), url) from error
    except (errors.BsmError, MemoryError):
        raise
    # What fsspec raises of a file system that can only be read.
    except NotImplementedError as error:
        raise errors.OptionError(
            f"{_scheme(url)}:// cannot be written to; name another place with -o"
        ) from error
    except OSError as error:
        # It has been through here already, in a call inside another.
        if error.filename == url:
            raise
        raise OSError(
            error.errno or errno.EIO, error.strerror or str(error) or type(error).__name__, url
        ) from error
    except Exception as error:
        raise OSError(errno.EIO, f"{type(error).__name__}: {error}", url) from error


def open_remote(url: str) -> BinaryIO:
    """Open a file for reading, piece by piece; not every server lets one go back."""
    with _errors_of(url):
        files, path = _system(url)
        options: dict[str, int] = {}
        # What the web gives is read as it comes: many a server answers no questions about parts.
        if _scheme(url) in _WEB:
            options["block_size"] = 0
        return cast(BinaryIO, files.open(path, "rb", **options))


@contextmanager
def open_remote_output(url: str, *, overwrite: bool) -> Iterator[BinaryIO]:
    """Open a file for writing that appears only when the `with` block has ended well."""
    refuse_to_replace(url, overwrite)
    # Not straight to the server: encoding may still fail, and few servers can take back what has come.
    with tempfile.SpooledTemporaryFile(_IN_MEMORY) as spool:
        yield cast(BinaryIO, spool)
        spool.seek(0)
        with _errors_of(url):
            _send(cast(BinaryIO, spool), url)


def _send(contents: BinaryIO, url: str) -> None:
    """Write a file; where file systems can, nothing of it is seen before all of it is there."""
    files, path = _system(url)
    there = files.exists(path)
    file = files.open(path, "wb", autocommit=False)
    # Some file systems show a file as soon as it is opened: then it is ours, and none before.
    is_new = not there and files.exists(path)
    try:
        shutil.copyfileobj(contents, file, _PIECE)
        file.close()
        file.commit()
    except BaseException:
        with suppress(Exception):
            file.discard()
        if is_new:
            with suppress(Exception):
                files.rm_file(path)
        raise


def refuse_to_replace(url: str, overwrite: bool) -> None:
    if _scheme(url) in _WEB:
        raise errors.OptionError(
            f"{_scheme(url)}:// cannot be written to; name another place with -o"
        )
    if not overwrite and state_of_remote(url) is not None:
        raise FileExistsError(errno.EEXIST, "the output exists already; -f overwrites it", url)


def state_of_remote(url: str) -> tuple[int | None, str] | None:
    """The size and version of a file, as far as its server tells them; None without such a file."""
    try:
        with _errors_of(url):
            files, path = _system(url)
            # fsspec keeps listings of folders: a file that another program has just written would not be there.
            files.invalidate_cache()
            about = files.info(path)
    except FileNotFoundError:
        return None
    return about.get("size"), next((str(about[name]) for name in _STAMPS if about.get(name)), "")


def remove(name: str) -> None:
    """Remove a local file or the file of a URL."""
    if not is_url(name):
        os.unlink(name)
        return
    with _errors_of(name):
        files, path = _system(name)
        files.rm_file(path)


def _scheme(url: str) -> str:
    match = _URL.match(url)
    if match is None:
        return ""
    return match[1].lower()


def _path(url: str) -> str:
    if _scheme(url) not in _WEB:
        return url
    path, *_ = re.split(r"[?#]", url, maxsplit=1)
    return path


def _system(url: str) -> tuple[Any, str]:
    """Return the fsspec file system of a URL, and the path there."""
    scheme = _scheme(url)
    fsspec = errors.imported("fsspec", f"{scheme}:// needs fsspec", "remote")
    try:
        return cast("tuple[Any, str]", fsspec.url_to_fs(url))
    # The message of fsspec names a module, and pip may know its package under another name.
    except ImportError as error:
        registry = errors.imported("fsspec.registry", "", "remote")
        class_name = registry.known_implementations.get(scheme, {}).get("class", "fsspec.")
        package, _, _ = class_name.partition(".")
        if package == "fsspec" and scheme in _WEB:
            package = "fsspec[http]"
        elif package == "fsspec":
            package = f"fsspec[{scheme}]"
        raise errors.DependencyError(
            f"{scheme}:// needs a package that is missing: pip install '{package}'"
        ) from error
    except ValueError as error:
        raise errors.OptionError(f"{url}: {error}") from error


Source: TypeAlias = Union[str, "os.PathLike[str]", bytes, bytearray, memoryview, BinaryIO, "Input"]
"""A path ("-" is standard input) or URL, any buffer, or a binary file, which need not be seekable."""

_CHUNK = 1 << 18
_MAX_BYTES = 1 << 32


def named(path: str | os.PathLike[str]) -> str:
    """A path as a text; `ArgumentError` for what no file can be called."""
    if not isinstance(path, (str, os.PathLike)):
        raise errors.ArgumentError(f"a path is expected, not {type(path).__name__}")
    name = without_scheme_of_files(os.fsdecode(path))
    if "\0" in name:
        raise errors.ArgumentError(f"no file can be called {name!r}: there is a NUL in it")
    return name


_TEXTS_OF_STREAMS = {"8942534d": "bytes.fromhex(text)", "iUJTT": "base64.b64decode(text)"}
"""How streams begin that were made a text, and the call that gives their bytes."""


def _refuse_text_of_stream(text: str) -> None:
    """Refuse a text that has the bytes of a stream instead of a path."""
    for beginning, call in _TEXTS_OF_STREAMS.items():
        is_text = text[: len(beginning)].lower() == beginning.lower()
        if is_text and not os.path.exists(text):
            raise errors.ArgumentError(
                f"a text with the bytes of a stream is not a path; give its bytes: {call}"
            )


class Input:
    """Bytes to be read once, from the beginning to the end."""

    def __init__(self, source: Source) -> None:
        self.name = ""
        self._file: BinaryIO | None = None
        self._opened = False
        self._held = b""
        if isinstance(source, (str, os.PathLike)):
            self.name = named(source)
            _refuse_text_of_stream(self.name)
        elif hasattr(source, "read"):
            self._file = cast(BinaryIO, source)
            self.name = str(getattr(source, "name", ""))
        else:
            try:
                if not isinstance(source, bytes):
                    source = memoryview(source).tobytes()
                self._file = io.BytesIO(source)
            except TypeError:
                kind = type(source).__name__
                raise errors.ArgumentError(
                    f"bytes, a path or a binary file are expected, not {kind}"
                ) from None

    @property
    def is_file(self) -> bool:
        return self._file is None and self.name != "-" and os.path.isfile(self.name)

    # A file is opened a second time for its head, so that its reader finds it at its beginning, without a
    # seek that pipes would not have.
    def peek(self, size: int) -> bytes:
        """The first bytes that are still to be read, up to `size` of them; fewer only at the end."""
        if self.is_file:
            with open(self.name, "rb") as file:
                return file.read(size)
        self._hold(size)
        return self._held[:size]

    def chunks(self) -> Iterator[bytes]:
        try:
            while piece := self._held or self._receive():
                self._held = b""
                yield piece
        finally:
            self.close()

    def read(self, size: int = _MAX_BYTES) -> bytes:
        self._hold(size)
        data, self._held = self._held[:size], self._held[size:]
        return data

    def read_all(self) -> bytes:
        with closing(self):
            data = self.read(_MAX_BYTES + 1)
        if len(data) > _MAX_BYTES:
            raise errors.LimitError(f"the file is larger than {_MAX_BYTES} bytes")
        return data

    def _hold(self, size: int) -> None:
        pieces, size_held = [self._held], len(self._held)
        most = min(size, _MAX_BYTES + 1)  # `read_all` refuses more
        while size_held < most and (piece := self._receive()):
            pieces.append(piece)
            size_held += len(piece)
        self._held = b"".join(pieces)

    def _receive(self) -> bytes:
        """Return the next bytes, waiting for them; empty at the end."""
        if self._file is None:
            if os.path.isdir(self.name):
                raise errors.FormatError("this is a folder, not a file")
            self._opened = self.name != "-"  # closed at its end, or where `chunks` ends
            if is_url(self.name):
                self._file = open_remote(self.name)
            elif self._opened:
                self._file = open(self.name, "rb")  # noqa: SIM115
            elif sys.stdin is None:
                raise OSError(errno.EBADF, "standard input is closed")
            else:
                self._file = sys.stdin.buffer
        # read1 returns what has arrived: read would wait for all of a chunk, and a stream from a pipe would not be
        # decoded while it comes.
        read = getattr(self._file, "read1", self._file.read)
        translation: AbstractContextManager[None] = nullcontext()
        if self._opened and is_url(self.name):
            translation = _errors_of(self.name)
        with translation:
            piece = read(_CHUNK)
        # A descriptor that does not block has nothing yet: taking it for the end would cut the file short without a
        # word.
        if piece is None:
            raise BlockingIOError(
                errno.EAGAIN, "the file has no bytes yet, and does not wait for them", self.name
            )
        if isinstance(piece, str):
            raise errors.ArgumentError(
                "a binary file is expected, not one of text; open it with mode 'rb'"
            )
        if not piece:
            self.close()
            return b""
        if not isinstance(piece, (bytes, bytearray, memoryview)):
            raise errors.ArgumentError(
                f"a binary file is expected: read() must give bytes, not {type(piece).__name__}"
            )
        return bytes(piece)

    def close(self) -> None:
        if self._opened and self._file is not None:
            self._file.close()
            self._file, self._opened = io.BytesIO(), False


def as_input(source: Source) -> Input:
    """`source` as an `Input`; one that is already being read goes on."""
    if isinstance(source, Input):
        return source
    return Input(source)


# A name that does not exist is not a pipe: opening it reports that, as for any file.
def is_pipe(source: Source) -> bool:
    """Whether a path names what can be read once only: standard input ("-"), a named pipe, a socket or a terminal."""
    if not isinstance(source, (str, os.PathLike)):
        return False
    reopens = os.path.isfile(source) or os.path.isdir(source)
    return os.fspath(source) == "-" or (os.path.exists(source) and not reopens)


def read_chunks(source: Source) -> Iterator[bytes]:
    return as_input(source).chunks()


def read_range(name: str, first: int, size: int) -> bytes:
    """Some bytes out of the middle of a file or URL; `TruncatedError` where they are not there."""
    if is_url(name):
        with _errors_of(name):
            files, path = _system(name)
            data = bytes(files.cat_file(path, start=first, end=first + size))
            # Of a server that knows no ranges.
            if len(data) > size:
                data = data[first : first + size]
    else:
        with open(name, "rb") as file:
            file.seek(first)
            left = os.fstat(file.fileno()).st_size - first
            data = file.read(max(0, min(size, left)))
    if len(data) != size:
        raise errors.TruncatedError(
            f"{name}: there are {len(data)} bytes of {size} from byte {first} on"
        )
    return data


def standard_output() -> BinaryIO:
    if sys.stdout is None:
        raise OSError(errno.EBADF, "standard output is closed")
    return sys.stdout.buffer


@contextmanager
def about(path: str) -> Iterator[None]:
    """Put the name of the file that it is about before the message of whatever is raised inside."""
    try:
        yield
    except errors.BsmError as error:
        error.message = f"{path}: {error.message}"
        raise


State = list[object]  # name, size and version of each file, as JSON gives it back


def files_behind(path: str) -> Iterator[str]:
    """Return the files of an input or output: itself, or the files of a folder or pattern, in order."""
    if is_url(path):
        yield path
    elif os.path.isdir(path):
        yield from sorted(entry.path for entry in os.scandir(path))
    elif glob.has_magic(path) and not os.path.exists(path):
        yield from sorted(glob.iglob(path))
    else:
        yield path


def state_of(path: str) -> State | None:
    """Return sizes and times of the files of an input or output; None if unknown."""
    state: State = []
    for file in files_behind(path):
        if is_url(file):
            size, version = state_of_remote(file) or (None, "")
            if not version:
                return None
            state.append([file, size, version])
        elif os.path.isfile(file):
            about = os.stat(file)
            # As a text, like the versions of URLs: readers of JSON that hold numbers as doubles lose the last digits of
            # nanoseconds.
            state.append([file, about.st_size, str(about.st_mtime_ns)])
    return state or None


def digest_of(path: str) -> str | None:
    from hashlib import sha256

    digest = sha256()
    try:
        for file in files_behind(path):
            for chunk in read_chunks(file):
                digest.update(chunk)
    except OSError:
        return None
    return digest.hexdigest()


def size_of(path: str) -> int | None:
    """Return the bytes of the files of an input or output; None for a pipe, or if a file or server does not tell."""
    if Path(path).suffix[1:].lower() in OF_OTHERS:
        return None
    if is_url(path):
        return (state_of_remote(path) or (None,))[0]
    sizes = [os.path.getsize(file) for file in files_behind(path) if os.path.isfile(file)]
    if not sizes:
        return None
    return sum(sizes)
