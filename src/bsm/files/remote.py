"""Files behind URLs (`s3://`, `https://`, `memory://`, ...), through fsspec; `file://` is a file like any other."""

from __future__ import annotations

import errno
import os
import posixpath
import re
import shutil
import tempfile
import urllib.parse
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from typing import Any, BinaryIO, cast

from bsm.bitstream.errors import BsmError, DependencyError, OptionError
from bsm.bitstream.extras import how_to_install

_URL = re.compile(r"([a-zA-Z][a-zA-Z0-9+.-]+)(?:::|://)")
_PIECE, _IN_MEMORY = 1 << 20, 1 << 26
"""Bytes that are sent at a time, and those that wait in memory and not on the disk."""
_WEB = ("http", "https")
_VERSIONS = (
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


@dataclass(frozen=True)
class RemoteState:
    """What tells whether a file is still the same."""

    size: int | None
    version: str


def is_url(path: str | os.PathLike[str]) -> bool:
    """Whether a name is a URL and not a path. (Drives of Windows have one letter.)"""
    return isinstance(path, str) and _URL.match(path) is not None


def without_scheme_of_files(path: str) -> str:
    """The path behind a `file://` URL; anything else as it is."""
    if not path.startswith("file://"):
        return path
    from urllib.request import url2pathname  # which takes with it all that speaks HTTP

    return url2pathname(urllib.parse.urlsplit(path).path)


def name_in(url: str) -> str:
    """The last part of a URL's path, without what is asked of a server (`?...`)."""
    return posixpath.basename(_path(url).rstrip("/"))


def beside(url: str, name: str) -> str:
    """The URL of another name in the same folder."""
    return f"{_path(url).rpartition('/')[0]}/{name}"


def inside(folder: str, name: str) -> str:
    """The URL of a name in a folder."""
    return f"{folder.rstrip('/')}/{name}"


def expanded(url: str) -> list[str]:
    """What a URL with ``*`` in it names, sorted; any other as it is."""
    if "*" not in url:
        return [url]
    with _errors_of(url):
        files, path = _system(url)
        found = sorted(files.unstrip_protocol(name) for name in files.glob(path))
    if not found:
        raise FileNotFoundError(errno.ENOENT, "nothing has such a name", url)
    return found


@contextmanager
def _errors_of(url: str) -> Iterator[None]:
    """Whatever goes wrong in a library behind fsspec, as an `OSError` that names the file."""
    try:
        yield
    except FileNotFoundError as error:
        raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), url) from error
    except (BsmError, MemoryError):
        raise
    except NotImplementedError as error:
        raise OptionError(f"{_scheme(url)}:// cannot be written to; name another place with -o") from error
    except OSError as error:
        if error.filename == url:
            raise
        raise OSError(error.errno or errno.EIO, error.strerror or str(error) or type(error).__name__, url) from error
    except Exception as error:
        raise OSError(errno.EIO, f"{type(error).__name__}: {error}", url) from error


def open_remote(url: str) -> BinaryIO:
    """Open a file for reading, piece by piece; not every server lets one go back."""
    with _errors_of(url):
        files, path = _system(url)
        # What the web gives is read as it comes: many a server answers no questions about parts.
        block = {"block_size": 0} if _scheme(url) in _WEB else {}
        return cast(BinaryIO, _Reader(files.open(path, "rb", **block), url))


@contextmanager
def open_remote_output(url: str, *, overwrite: bool) -> Iterator[BinaryIO]:
    """Open a file for writing that appears only when the `with` block has ended well."""
    refuse_to_replace(url, overwrite)
    with tempfile.SpooledTemporaryFile(_IN_MEMORY) as whole:
        yield cast(BinaryIO, whole)
        whole.seek(0)
        with _errors_of(url):
            _send(cast(BinaryIO, whole), url)


def _send(whole: BinaryIO, url: str) -> None:
    """Write a file; where file systems can, nothing of it is seen before all of it is there."""
    files, path = _system(url)
    there = files.exists(path)
    file = files.open(path, "wb", autocommit=False)
    # Some file systems show a file as soon as it is opened: then it is ours, and none before.
    shown = not there and files.exists(path)
    try:
        shutil.copyfileobj(whole, file, _PIECE)
        file.close()
        file.commit()
    except BaseException:
        with suppress(Exception):
            file.discard()
        if shown:
            with suppress(Exception):
                files.rm_file(path)
        raise


def refuse_to_replace(url: str, overwrite: bool) -> None:
    """Raise `FileExistsError` if there is such a file and `overwrite` is false."""
    if _scheme(url) in _WEB:
        raise OptionError(f"{_scheme(url)}:// cannot be written to; name another place with -o")
    if not overwrite and state_of_remote(url) is not None:
        raise FileExistsError(errno.EEXIST, "the output exists already; -f overwrites it", url)


def state_of_remote(url: str) -> RemoteState | None:
    """Size and version of a file; None: there is none."""
    try:
        with _errors_of(url):
            files, path = _system(url)
            files.invalidate_cache()
            about = files.info(path)
    except FileNotFoundError:
        return None
    version = next((str(about[name]) for name in _VERSIONS if about.get(name)), "")
    return RemoteState(about.get("size"), version)


class _Reader:
    """A file whose errors while reading name it."""

    def __init__(self, file: BinaryIO, url: str) -> None:
        self._file = file
        self.name = url

    def read(self, size: int = -1) -> bytes:
        with _errors_of(self.name):
            return self._file.read(size)

    def close(self) -> None:
        self._file.close()


def _scheme(url: str) -> str:
    match = _URL.match(url)
    return match[1].lower() if match else ""


def _path(url: str) -> str:
    return re.split(r"[?#]", url, maxsplit=1)[0] if _scheme(url) in _WEB else url


def _system(url: str) -> tuple[Any, str]:
    """The file system of fsspec behind a URL, and the path there."""
    scheme = _scheme(url)
    try:
        import fsspec
        from fsspec.registry import known_implementations
    except ImportError as error:
        raise DependencyError(f"{scheme}:// needs fsspec: {how_to_install('remote')}") from error
    try:
        return cast("tuple[Any, str]", fsspec.url_to_fs(url))
    except ImportError as error:
        known = known_implementations.get(scheme, {})
        package = known.get("class", "fsspec.").partition(".")[0]
        if package == "fsspec":
            package = f"fsspec[{'http' if scheme in _WEB else scheme}]"
        raise DependencyError(f"{scheme}:// needs a package that is missing: pip install '{package}'") from error
    except ValueError as error:
        raise OptionError(f"{url}: {error}") from error
