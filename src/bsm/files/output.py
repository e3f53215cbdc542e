"""Files that appear as a whole or not at all, and the names of those that the user did not name."""

import errno
import glob
import os
import posixpath
import re
import signal
import stat
import tempfile
import threading
from collections.abc import Iterable, Iterator
from contextlib import AbstractContextManager, contextmanager, suppress
from functools import cache
from pathlib import Path
from types import FrameType
from typing import Any, BinaryIO

from bsm.bitstream.errors import OptionError
from bsm.files import pipes
from bsm.ground.exits import Terminated

try:
    import fcntl
except ImportError:  # not a POSIX system
    fcntl = None  # type: ignore[assignment]

_TEMPORARY = ".part"
# Windows has no SIGHUP.
_ENDING = tuple(filter(None, (signal.SIGTERM, getattr(signal, "SIGHUP", None))))
_HELD = "/proc/self/fd"  # Linux names folders that are open there
_UMASK = threading.Lock()  # the process has one mask, which can only be read by setting it
_FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
# What the shell has opened: `>(...)`, or `> file`.
_DESCRIPTOR = re.compile(r"/dev/fd/(\d+)|/proc/(?:self|thread-self)/fd/(\d+)")
_STANDARD = {"/dev/stdout": "/dev/fd/1", "/dev/stderr": "/dev/fd/2"}
_PIPES = {"/dev/stdin": "-", "/dev/fd/0": "-", "/dev/stdout": "-", "/dev/fd/1": "-"}


@contextmanager
def open_output(
    path: str | os.PathLike[str], *, overwrite: bool = False, follow: bool | str = True
) -> Iterator[BinaryIO]:
    """Open a file whose name appears when the `with` block has ended well; `follow`: links and devices are meant."""
    if os.fspath(path) == "-":
        piped = pipes.standard_output()
        yield piped
        piped.flush()
        return
    if isinstance(path, str) and pipes.is_url(path):
        with pipes.open_remote_output(path, overwrite=overwrite) as remote:
            yield remote
        return
    if os.path.isdir(path):
        raise IsADirectoryError(errno.EISDIR, "the output is a folder", os.fspath(path))
    if follow is True and not can_be_replaced(path):
        with by_its_own_name(path), _open_device(path) as device:
            yield device
        return
    refuse_to_overwrite(path, overwrite)
    place = Path(path)
    if follow is True:
        place = Path(os.path.realpath(path))
    with (
        termination_as_exception(),
        by_its_own_name(path),
        _in_its_folder(place, follow) as target,
        _replacing(target, overwrite) as file,
    ):
        yield file


@contextmanager
def _replacing(target: Path, overwrite: bool) -> Iterator[BinaryIO]:
    """A temporary file that takes the place of another one at the end."""
    name = lock = None
    try:
        with _signals_wait():
            handle, name, lock = _temporary(target)
        with os.fdopen(handle, "wb") as file:
            yield file
            file.flush()
            # Before the rename: after a loss of power, the name could otherwise stand for an empty file.
            os.fsync(file.fileno())
            chmod_target: int | str = name
            # Another program may have put a link in its place, which only a name would follow.
            if os.chmod in os.supports_fd:
                chmod_target = file.fileno()
            os.chmod(chmod_target, _permissions(target))
        if overwrite:
            os.replace(name, target)
        else:
            _rename_unless_present(name, target)
    except BaseException:
        if name is not None:
            with suppress(FileNotFoundError):
                os.unlink(name)
        raise
    finally:
        if lock is not None:
            os.close(lock)


# In batches over a folder of others, somebody could swap a folder for a link between the check and the writing. Names
# that the user did not give are therefore opened one folder at a time, each from the one before.
@contextmanager
def _in_its_folder(target: Path, follow: bool | str) -> Iterator[Path]:
    """A name for a place in its folder, which is held open if its folders may be swapped for links."""
    if not isinstance(follow, str) or not os.path.isdir(_HELD):
        yield target
        return
    way = os.path.relpath(target.parent, follow).split("/")
    folder_number = os.open(follow, os.O_RDONLY | os.O_DIRECTORY)
    try:
        for name in way:
            outer, folder_number = (
                folder_number,
                os.open(name, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW, dir_fd=folder_number),
            )
            os.close(outer)
        yield Path(_HELD, str(folder_number), target.name)
    finally:
        os.close(folder_number)


def write_output(
    path: str | os.PathLike[str], data: bytes, *, overwrite: bool, follow: bool | str = True
) -> None:
    with open_output(path, overwrite=overwrite, follow=follow) as file:
        file.write(data)


@contextmanager
def handled(signals: Iterable[signal.Signals], handler: Any) -> Iterator[None]:
    """Handle signals in another way for a while; they reach the main thread only."""
    before = {}
    if threading.current_thread() is threading.main_thread():
        before = {each: signal.signal(each, handler) for each in signals}
    try:
        yield
    finally:
        for each, usual in before.items():
            signal.signal(each, usual)


# A signal between making the file and noting its name would leave it there for ever.
@contextmanager
def _signals_wait() -> Iterator[None]:
    """Hold signals until a new file has an owner that removes it."""
    came: list[int] = []
    try:
        with handled((signal.SIGINT, *_ENDING), lambda number, _: came.append(number)):
            yield
    finally:
        for number in came:
            signal.raise_signal(number)


def refuse_to_overwrite(path: str | os.PathLike[str], overwrite: bool) -> None:
    """Raise `FileExistsError` if `path` is a file and `overwrite` is false; ask before long work."""
    if isinstance(path, str) and pipes.is_url(path):
        pipes.refuse_to_replace(path, overwrite)
    elif (
        not overwrite and os.fspath(path) != "-" and os.path.isfile(path) and can_be_replaced(path)
    ):
        raise FileExistsError(
            errno.EEXIST, "the output exists already; -f overwrites it", os.fspath(path)
        )


def own_name(path: str) -> str:
    """Return the name that we use: - for standard input and output, and the path of a `file://` URL."""
    return pipes.without_scheme_of_files(_PIPES.get(path, path))


def refuse_collisions(inputs: Iterable[str], outputs: Iterable[str]) -> None:
    """Raise `OptionError` if an output would replace an input or another output, under whatever name or link."""
    names = [own_name(output) for output in outputs if output]
    input_identities: set[object] = set()
    for name in map(own_name, inputs):
        input_identities |= set(map(_identity, pipes.files_behind(name)))
    input_identities.discard(None)
    output_identities: set[object] = set()
    for output in names:
        identity = _identity(output)
        if identity in input_identities:
            raise OptionError(f"the output would replace the input {output}; name another with -o")
        for key in {identity, _place(output)} - {None}:
            if key in output_identities:
                raise OptionError(
                    f"two outputs would have the name {output}; give each a name of its own"
                )
            output_identities.add(key)


def _identity(path: str) -> tuple[int, int] | str | None:
    """Return a key that is equal for all names of a file; None if it does not exist or is a device."""
    if pipes.is_url(path):
        return path
    with suppress(OSError):
        status = os.stat(path)
        if stat.S_ISREG(status.st_mode):
            return status.st_dev, status.st_ino
    return None


def _place(path: str) -> str | None:
    """The place of an output that may not be there yet; None: a device, which may be written to twice."""
    if path == "-" or pipes.is_url(path):
        return path
    if os.path.exists(path) and not os.path.isfile(path):
        return None
    place = os.path.realpath(path)
    # Two outputs, A.bsm and a.bsm, are one file on macOS and Windows.
    if _ignores_case(os.path.dirname(place)):
        place = place.lower()
    return place


@cache
def _ignores_case(folder: str) -> bool:
    """Whether names in a folder differ by more than their case."""
    with suppress(OSError):
        return folder != folder.swapcase() and os.path.samefile(folder, folder.swapcase())
    return False


def _temporary(target: Path) -> tuple[int, str, int | None]:
    """Make a temporary file beside `target`, with a handle that locks it; remove files of writers that died."""
    pattern = f".{target.name[:50]}."  # of at most 200 bytes
    while True:
        handle, name = tempfile.mkstemp(prefix=pattern, suffix=_TEMPORARY, dir=target.parent)
        if fcntl is None:
            return handle, name, None
        # A copy of the handle: locks of flock belong to the opened file, so that this one holds on when `file` is
        # closed before the rename.
        lock = os.dup(handle)
        with suppress(OSError):  # a file system without locks
            fcntl.flock(lock, fcntl.LOCK_EX)
        if os.fstat(lock).st_nlink:
            break
        # Before it was locked another writer took it for a dead one's.
        os.close(handle)
        os.close(lock)
    # Those of writers that were killed have no lock any more. Those of others at work refuse ours, and stay.
    for part in target.parent.glob(f"{glob.escape(pattern)}????????{_TEMPORARY}"):
        with suppress(OSError), os.fdopen(open_own(part, os.O_RDONLY)) as file:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            part.unlink()
    return handle, name, lock


def open_own(path: Path, flags: int) -> int:
    """Open a file of a name that the user did not give: through no link, and neither a pipe nor a device."""
    if path.is_symlink() or (path.exists() and not path.is_file()):
        raise FileExistsError(
            errno.EEXIST, "this is not a regular file; remove it", os.fspath(path)
        )
    return os.open(path, flags | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0), 0o666)


def _descriptor(path: str | os.PathLike[str]) -> int | None:
    name = os.fspath(path)
    match = _DESCRIPTOR.fullmatch(_STANDARD.get(name, name))
    if match is None:
        return None
    return int(match[1] or match[2])


def _open_device(path: str | os.PathLike[str]) -> BinaryIO:
    descriptor = _descriptor(path)
    if descriptor is None:
        return open(path, "wb")
    return open(os.dup(descriptor), "wb")


def can_be_replaced(path: str | os.PathLike[str]) -> bool:
    """Whether a file can be put in this place; links are not followed, as /dev/fd/63 may have no name."""
    return _descriptor(path) is None and (os.path.isfile(path) or not os.path.exists(path))


@contextmanager
def by_its_own_name(path: str | os.PathLike[str]) -> Iterator[None]:
    """Make errors about a temporary file name the target; errors of a full disk name no file."""
    try:
        yield
    except OSError as error:
        if (
            str(error.filename).startswith(_HELD)
            or str(error.filename).endswith(_TEMPORARY)
            or (error.filename is None and error.errno in _FULL)
        ):
            error.filename = os.fspath(path)
            del error.filename2  # None would be printed as a name
            folder = os.path.dirname(os.fspath(path))
            if isinstance(error, FileNotFoundError) and not os.path.isdir(folder):
                error.strerror = (
                    f"the folder {folder} of the output does not exist; create it first"
                )
        raise


def _permissions(target: Path) -> int:
    """Permissions of the file that is replaced, or those that any new file gets (a temporary file is private)."""
    if target.is_file() and not target.is_symlink():
        return target.stat().st_mode & 0o777
    with _UMASK:
        mask = os.umask(0)
        os.umask(mask)
    return 0o666 & ~mask


def _rename_unless_present(name: str, target: Path) -> None:
    """Rename, but never over a file that has appeared meanwhile (a link, unlike a rename, refuses)."""
    try:
        # Python has no rename that refuses to replace: renameat2 is Linux only, and not in os.
        os.link(name, target)
    except FileExistsError:
        refuse_to_overwrite(target, False)
        raise
    except OSError:  # a file system without links
        refuse_to_overwrite(target, False)
        os.replace(name, target)
    else:
        os.unlink(name)


def termination_as_exception() -> AbstractContextManager[None]:
    """Let SIGTERM, and the end of the terminal, unwind the stack, as Ctrl-C does."""

    def stop(number: int, frame: FrameType | None) -> None:
        raise Terminated(128 + number)

    # nohup has such a program ignore the end of the terminal, and it stays so.
    return handled(
        (number for number in _ENDING if signal.getsignal(number) is not signal.SIG_IGN), stop
    )


def default_output(path: str, suffix: str) -> str:
    if path == "-":
        return "-"
    output = _with_suffix(path, suffix)
    output_path = str(output)
    if pipes.is_url(path):
        output_path = pipes.beside(path, output.name)
    if output_path == path or (not pipes.is_url(path) and output == Path(path)):
        raise OptionError(f"the output would replace the input {path}; name another with -o")
    return no_link(output_path)


def output_inside(folder: str, path: str, suffix: str) -> str:
    name = _with_suffix(path, suffix).name
    if pipes.is_url(folder):
        return posixpath.join(folder, name)
    return no_link(str(Path(folder, name)))


def no_link(path: str) -> str:
    """Return a name that the user did not give; `OptionError` for a symbolic link."""
    if not pipes.is_url(path) and os.path.islink(path):
        raise OptionError(f"{path} is a symbolic link; remove it, or name the output with -o")
    return path


def _with_suffix(path: str, suffix: str) -> Path:
    far = pipes.is_url(path)
    if not far and glob.has_magic(path) and not Path(path).exists():
        raise OptionError(
            f"{path} stands for many files, which make one; name that with -o, with its suffix"
        )
    place = Path(path)
    if far:
        place = Path(pipes.name_in(path))
    if place.name in ("", "-", "..") or path.startswith("/dev/"):
        raise OptionError(f"{path} gives the output no name; name it with -o")
    return place.with_suffix(suffix)


def refuse_terminal(path: str) -> None:
    if path == "-" and pipes.standard_output().isatty():
        raise OptionError(
            "binary data is not written to a terminal; redirect it, or name a file with -o"
        )
