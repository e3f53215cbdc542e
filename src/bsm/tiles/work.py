"""The folders of a run of `bsm tile`: which process holds them, and which files of them the run has made."""

import errno
import os
import re
import socket
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from bsm.bitstream.errors import OptionError
from bsm.files.output import open_own

try:
    # Windows has other locks. There, two runs in one folder are the user's own care.
    import fcntl
except ImportError:  # not a POSIX system
    fcntl = None  # type: ignore[assignment]
LOCK, NOTE = ".tile.lock", "asked"
_BEGIN = "({'triangles'"  # of the note of a run
# Only files with these names are ever removed: the folder is named by the user, and may hold anything.
_MADE = re.compile(
    rf"({LOCK}|{NOTE}|plan\.json|tiles\.json|positions|faces|color|normal|cut|codes|outside|texcoord|texture\.\d+"
    r"|r[0-7]*\.(mesh|bsm|atlas))"
    r"|\.(plan|tiles|r[0-7]*)\.(json|mesh|bsm|atlas)\.\w{8}\.part"
)


@contextmanager
def there(folder: Path) -> Iterator[None]:
    """Make a folder, and remove it again where it is new and stays empty."""
    new = not folder.exists()
    folder.mkdir(parents=True, exist_ok=True)
    try:
        yield
    finally:
        if new:
            with suppress(OSError):
                folder.rmdir()


@contextmanager
def held(folder: Path, take_over: bool) -> Iterator[bool]:
    """Hold a folder; yield whether a dead process held it. `OSError` names a live one, or a dead unless `take_over`."""
    path = folder / LOCK
    while True:
        file = os.fdopen(open_own(path, os.O_RDWR | os.O_CREAT | os.O_APPEND), "a+")
        try:
            if fcntl is not None:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            # Between opening and locking, the owner may have removed the file. The lock would then be on a file without
            # a name, and another process could lock a new one.
            if path.exists() and os.path.samestat(os.fstat(file.fileno()), path.stat()):
                break
            file.close()  # its owner has just removed it
        except OSError as error:
            with file:
                raise _held_by(
                    path, "works in this folder; wait until it has ended, or name another one"
                ) from error
    with file:
        # A process removes its file at the end. One with contents and without a lock was left by a process that died.
        if (has_work := file.seek(0, os.SEEK_END) > 0) and not take_over:
            raise _held_by(path, "left this folder unfinished; --resume continues, -f starts again")
        file.truncate(0)
        file.write(f"{os.getpid()} {socket.gethostname()}\n")
        file.flush()
        try:
            yield has_work
        finally:
            with suppress(OSError):
                path.unlink()


def _held_by(path: Path, message: str) -> OSError:
    with suppress(OSError):
        words = path.read_text(errors="replace").split()[:2]
        if len(words) == 2 and words[0].isdigit():
            return OSError(
                errno.EBUSY, f"process {words[0]} on {words[1]!r:.80} {message}", str(path.parent)
            )
    return OSError(errno.EBUSY, f"another process {message}", str(path.parent))


def is_own(work: Path) -> bool:
    """Return whether a run has left its note in a folder; a run that was killed at once has left an empty one."""
    with suppress(OSError):
        if not (work / NOTE).is_file():
            return False
        note = (work / NOTE).read_text(errors="replace")
        # A note with nothing in it comes from a run that was killed between opening and writing it.
        return note.startswith(_BEGIN) or (not note and {*os.listdir(work)} <= {LOCK, NOTE})
    return False


def refuse_others(work: Path) -> None:
    """Raise `OptionError` for a folder with files, but without the note of a run, and for links in it."""
    # A link could lead the run, which writes and removes files by fixed names, to files elsewhere.
    if work.is_dir() and any(path.is_symlink() for path in work.iterdir()):
        raise OptionError(
            f"{work} holds symbolic links; name an empty folder, or a new one, with --work"
        )
    if work.is_dir() and {*os.listdir(work)} - {LOCK} and not is_own(work):
        raise OptionError(
            f"{work} holds other files; name an empty folder, or a new one, with --work"
        )


def remove_made(work: Path) -> None:
    """Remove the files of a run from a folder, and the folder if it is then empty."""
    if not work.is_dir():
        return
    # The note goes last: without it, the remaining files would look like those of another program.
    for name in sorted(os.listdir(work), key=NOTE.__eq__):
        if name != LOCK and _MADE.fullmatch(name):
            (work / name).unlink(missing_ok=True)
    if not {*os.listdir(work)} - {LOCK}:
        with suppress(OSError):
            (work / LOCK).unlink(missing_ok=True)
            work.rmdir()
