"""Readers of files in isolation: a process of its own for each file, with limits that the kernel enforces.

A server with all readers loaded is started once, and forks for each file. The child opens no socket, starts no program
or thread, writes nothing, and ends where it exceeds its memory or time. With Landlock (landlockpy) it may only read the
folder of the file and those of Python and its packages; without, only what our own readers read comes here. Arrays,
notes and errors come back as data in shared memory.
"""

import csv
import ctypes
import gc
import importlib
import io
import itertools
import json
import math
import mmap
import os
import platform
import re
import resource
import signal
import socket
import struct
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import asdict
from functools import cache, partial
from pathlib import Path
from typing import Any, TypeAlias

from bsm.bitstream.errors import BsmError, FormatError, LimitError, UnsupportedError
from bsm.bitstream.limits import Limits
from bsm.files import landlock, mesh, sequence
from bsm.files.answer import FRAMES, MESH, found_in, leave
from bsm.files.formats.polygons import MeshFile
from bsm.files.motion.frames import Frames, Wanted
from bsm.files.pipes import Input
from bsm.files.table import FORMATS, MESH_FORMATS, load_modules

_COMMAND = "from bsm.files.isolation import serve; serve({number})"
End: TypeAlias = tuple[int, int, float, bytes]
_MEMORY, _WRITTEN = resource.RLIMIT_AS, resource.RLIMIT_FSIZE
# A status, the most memory, processor seconds, and last words, that come back.
_END = struct.Struct("<iQd4096s")
_ROOM = 1 << 20  # bytes of an answer that a child need not ask for, in addition to its memory
_OF_THIS_PROCESS = re.compile("/dev/(fd/|std)|/proc/")
# A file that has been read, so that the next is read sooner.
_SMALLEST = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
_PATIENCE = 10  # times its processor time that a child may take, since the machine may be busy
_WRITING = 0o1103  # flags of open: O_WRONLY, O_RDWR, O_CREAT, O_TRUNC
# TCGETS, FIOCLEX; F_GETFD to _GETFL, _DUPFD_CLOEXEC.
_QUESTIONS = {"ioctl": (0x5401, 0x5451), "fcntl": (1, 2, 3, 1030)}
_REFUSED = 3000  # and the number of a call: the error of one that is refused
_QUIET = dict.fromkeys(
    ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "PXR_WORK_THREAD_LIMIT", "MALLOC_ARENA_MAX"), "1"
)
_QUIET |= {"HDF5_USE_FILE_LOCKING": "FALSE"}


def read_isolated(source: Input, file_format: str | None, limits: Limits, kind: str) -> Any:
    """The `MeshFile` that a process of its own reads; errors as of `read_mesh`."""
    return _read_there(source, file_format, limits, kind, MESH)


def frames_isolated(
    source: Input | Sequence[str],
    file_format: str | None,
    limits: Limits,
    kind: str,
    request: Wanted | None,
) -> Any:
    """The `Frames` that a process of its own reads, or None; errors as of `open_sequence`."""
    beside: str | None = None
    if request and request.mesh:
        beside = os.path.abspath(request.mesh)
    extra_fields = {
        "sequence": True,
        "wanted": request and {**asdict(request), "mesh": beside},
        "beside": beside,
    }
    return _read_there(source, file_format, limits, kind, FRAMES, **extra_fields)


def _read_there(
    source: Input | Sequence[str],
    file_format: str | None,
    limits: Limits,
    kind: str,
    accepted: Any,
    **extra_fields: Any,
) -> Any:
    data, names = b"", list[str]()
    if not isinstance(source, Input):
        names = list(source)
    else:
        extra_fields["name"] = source.name
        # A path of this process (/dev/fd/3, ...) means another file in the child, so its bytes are sent instead.
        if source.is_file and not _OF_THIS_PROCESS.match(source.name):
            names = [os.path.abspath(source.name)]
        else:
            data = source.read_all()
        # Others never come here.
        if landlock.lack() is not None:
            file_format = file_format or kind or None
    if kind not in FORMATS:
        kind = ""
    size = len(data) + sum(map(os.path.getsize, names))
    seconds = math.ceil(min(limits.work_for(limits.vertices, size) / 1e9, 1e6))
    soft_limit, _ = resource.getrlimit(resource.RLIMIT_CPU)
    extra_fields |= {
        "format": file_format,
        "kind": kind,
        "names": names,
        "limits": asdict(limits),
        "memory": int(min(limits.memory_for(limits.vertices, size), 1 << 40)),
        "seconds": max(1, _least(seconds, max(soft_limit - 1, -1))),
    }
    extra_fields["patience"] = _PATIENCE * extra_fields["seconds"]
    with shared(json.dumps(extra_fields).encode() + b"\n" + data) as memory:
        status, _, _, words = end_of_child(memory)
        if os.WIFSIGNALED(status):
            raise _end_of(os.WTERMSIG(status), words, extra_fields)
        return found_in(memory, extra_fields["memory"] + _ROOM, limits, accepted)


def _too_little(request: dict[str, Any]) -> LimitError:
    return LimitError(
        f"reading takes more than {request['memory']:,} bytes of memory (Limits.memory, ulimit -v)"
    )


def _end_of(number: int, words: bytes, request: dict[str, Any]) -> BsmError:
    """The error of a child that a signal has ended, by its last words."""
    # C++ libraries end so where memory is refused; their last words are all that tells this from a fault of theirs.
    if number == signal.SIGABRT and b"bad_alloc" in words:
        return _too_little(request)
    if number == signal.SIGXCPU:
        return LimitError(
            f"reading takes more than {request['seconds']} s of processor time (Limits.work, ulimit -t)"
        )
    if number == signal.SIGALRM:
        return LimitError(f"reading this file takes more than {_PATIENCE * request['seconds']} s")
    if number == signal.SIGKILL:
        return LimitError(
            "the process that read this file was ended: the system has too little memory"
        )
    return FormatError(
        f"reading this file crashed the library that reads it ({signal.strsignal(number)})"
    )


@contextmanager
def shared(data: bytes) -> Iterator[int]:
    """Memory that other processes can read and write."""
    # Memory without a name in any folder: no other process can open it, and the kernel frees it with the last user.
    memory = os.memfd_create("bsm")
    try:
        os.pwrite(memory, data, 0)
        yield memory
    finally:
        os.close(memory)


# ------------------------------------------------------------------------------------------------ the server


class _Server:
    """The process that forks for each file; it ends with the last process that has its socket."""

    def __init__(self) -> None:
        self._socket, there = socket.socketpair()
        paths = (
            str(Path(importlib.import_module("bsm").__file__ or "").parents[1]),
            os.environ.get("PYTHONPATH", ""),
        )
        known = {name: os.environ[name] for name in ("PATH", "LANG", "HOME") if name in os.environ}
        # Not the whole environment: it holds keys of clouds and other secrets, which a reader that has been taken over
        # could put into the answer.
        environment = known | _QUIET | {"PYTHONPATH": os.pathsep.join(filter(None, paths))}
        if not re.match("python|pypy", os.path.basename(sys.executable or "")):
            # But a program that has Python in it.
            raise FileNotFoundError("sys.executable is not Python")
        # -P keeps the current folder out of sys.path: a file there called like a module would be run otherwise.
        command = [sys.executable, "-P", "-c", _COMMAND.format(number=there.fileno())]
        nothing: Any = dict.fromkeys(("stdin", "stdout", "stderr"), subprocess.DEVNULL)
        with there:
            self.process = subprocess.Popen(
                command, pass_fds=[there.fileno()], env=environment, **nothing
            )

    def __del__(self) -> None:
        self._socket.close()
        if hasattr(self, "process") and self.process.poll() is None:
            self.process.returncode = 0  # not waited for: it ends with its socket

    def read(self, memory: int) -> End:
        """Let a child read the file that shared memory names; return its status, memory and time."""
        here, there = socket.socketpair()
        with here:
            with there:
                socket.send_fds(self._socket, [b"?"], [there.fileno(), memory])
            end = here.recv(_END.size, socket.MSG_WAITALL)
            if len(end) < _END.size:
                raise ConnectionError("the process that reads files has died")
            return _END.unpack(end)


@cache
def _server() -> _Server:
    return _Server()


def end_of_child(memory: int) -> End:
    try:
        # Tried twice: the server may have been ended by somebody between two files, and a new one then reads this file.
        # A second failure is of the file or of the system.
        with suppress(ConnectionError):
            return _server().read(memory)
        with suppress(subprocess.TimeoutExpired):  # somebody has ended it
            _server().process.wait(1)
        _server.cache_clear()
        return _server().read(memory)
    except OSError as error:
        raise UnsupportedError(
            f"the process that reads files from strangers does not start: {error}"
        ) from error


def serve(number: int) -> None:
    """Fork for each file that is asked for, until the last process that can ask has ended."""
    for kind in MESH_FORMATS:
        load_modules(kind)
    landlock.libraries()
    _calls()
    landlock.lack()  # landlockpy looks for the C library when it is first used
    mesh.read_mesh(_SMALLEST, isolated=False)
    gc.freeze()
    with socket.socket(fileno=number) as connection:
        while True:
            signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # watchers end alone
            request, files, _, _ = socket.recv_fds(connection, 1, 2)
            if not request:
                return
            answer, memory = files
            with open(memory, "rb", closefd=False) as shared_memory:
                shared_memory.seek(0)
                question, begin = (
                    json.loads(shared_memory.readline()),
                    shared_memory.tell(),
                )  # the bytes of a file follow
            load_modules(question["kind"])
            if not os.fork():
                connection.close()
                _watch(answer, memory, question, begin)
            os.close(answer)
            os.close(memory)


def _watch(answer: int, memory: int, request: dict[str, Any], begin: int) -> None:
    """Let a child read, and tell how it ended, with its last words."""
    try:
        signal.signal(signal.SIGCHLD, signal.SIG_DFL)
        words, written = os.pipe2(os.O_NONBLOCK | os.O_CLOEXEC)
        here, there = socket.socketpair()
        child = os.fork()
        if not child:
            os.setsid()
            os.dup2(written, 2)
            for file in (answer, words, written, here.detach()):
                os.close(file)
            _read(memory, there.detach(), request, begin)
        there.close()
        signal.signal(signal.SIGALRM, lambda *_: os.kill(child, signal.SIGKILL))
        signal.alarm(request["patience"])
        with here:
            _grant(child, here)
        _, status, used = os.wait4(child, 0)
        # For a child may stop itself, or ignore that signal.
        if not signal.alarm(0):
            status = signal.SIGALRM
        with suppress(ProcessLookupError):
            os.killpg(child, signal.SIGKILL)
        last = b""
        with suppress(BlockingIOError):
            last = os.read(words, 1 << 16)[-4096:]
        os.write(
            answer, _END.pack(status, used.ru_maxrss << 10, used.ru_utime + used.ru_stime, last)
        )
    finally:
        # Not sys.exit: this process is a copy of the server, whose exit handlers must not run here.
        os._exit(0)


def _grant(child: int, asks: socket.socket) -> None:
    """Let a child write an answer of the size that it asks for, once, if it can do with so much less memory."""
    size = int.from_bytes(asks.recv(8, socket.MSG_WAITALL), "little")
    with suppress(OSError):  # the child may have ended
        (most, hard), (_, largest) = (
            resource.prlimit(child, limit) for limit in (_MEMORY, _WRITTEN)
        )
        if granted := size <= largest:
            resource.prlimit(child, _MEMORY, (most - size, hard))
            granted = _held(child) <= most - size
        if granted:
            resource.prlimit(child, _WRITTEN, (size, largest))
        asks.send(bytes([granted]))


def _held(process: int | str) -> int:
    return int(Path(f"/proc/{process}/statm").read_text().split()[0]) * mmap.PAGESIZE


# ------------------------------------------------------------------------------------------------ the child


def _read(memory: int, room: int, request: dict[str, Any], begin: int) -> None:
    """Read the file that is asked for, and leave the mesh or the error in shared memory."""
    try:
        request["data"] = os.pread(memory, os.fstat(memory).st_size - begin, begin)
        try:
            _confine(request)
            leave(memory, _called(request), partial(_ask, room))
        except MemoryError:
            leave(memory, _too_little(request))
        except BsmError as error:
            error.message = _named(error.message)
            leave(memory, error)
        except Exception as error:
            words = _named(f"{type(error).__name__}: {str(error)[:200]}")
            leave(memory, FormatError(f"reading this file failed: {words}"))
    finally:
        os._exit(0)


def _ask(room: int, size: int) -> None:
    """Ask for the bytes of an answer; `MemoryError` if there are not so many."""
    if size > _ROOM:
        os.write(room, size.to_bytes(8, "little"))
        if os.read(room, 1) != b"\1":
            raise MemoryError


def _called(request: dict[str, Any]) -> MeshFile | Frames | None:
    """Read as without isolation, in here."""
    arguments, names = (request["format"], Limits(**request["limits"])), request["names"]
    sequence_request: Wanted | None = None
    if request.get("wanted"):
        sequence_request = Wanted(**request["wanted"])
    if "name" not in request:
        return sequence.open_frames(names, *arguments, sequence_request or Wanted(), isolated=False)
    source: Any
    if names:
        source = names[0]
    else:
        source = io.BytesIO(request["data"])
        source.name = request["name"]
    if request.get("sequence"):
        return sequence.open_sequence(
            source, arguments[0], sequence_request, arguments[1], isolated=False
        )
    return mesh.read_mesh(source, *arguments, isolated=False)


def _confine(request: dict[str, Any]) -> None:
    """Take from this process what reading needs not: files of others, network, writing, memory and time beyond."""
    try:
        open_numbers = _held("self")
    except OSError as error:
        raise UnsupportedError(f"files from strangers are read where /proc is: {error}") from error
    for limit, most, longest in (
        (resource.RLIMIT_CORE, 0, 0),
        (_WRITTEN, _ROOM, _ROOM + request["memory"] // 2),
        (_MEMORY, open_numbers + request["memory"], open_numbers + request["memory"]),
        (resource.RLIMIT_CPU, request["seconds"], request["seconds"] + 1),
    ):
        soft, hard = resource.getrlimit(limit)  # of where this runs, which may be less
        resource.setrlimit(limit, (_least(most, soft), _least(longest, hard)))
    if landlock.lack() is None:
        files = filter(None, [*request["names"], request.get("beside")])
        landlock.close_files(landlock.folders_of(files))
    _close_calls()


def _least(most: int, current: int) -> int:
    if current == resource.RLIM_INFINITY:
        return most
    return min(most, current)


# First the parent's death ends this process (1), then no program gets new rights (38), without which the kernel takes
# no filter (22) of an ordinary user.
def _close_calls() -> None:
    """Let the kernel refuse all calls but those of reading, by a filter."""
    if platform.machine() not in landlock.PROCESSORS:
        return  # `lack` says so
    code = ctypes.create_string_buffer(
        b"".join(struct.pack("<HBBI", *step) for step in _filter(os.getpid()))
    )
    program = ctypes.create_string_buffer(
        struct.pack("@HP", len(code) // 8, ctypes.addressof(code))
    )
    control = ctypes.CDLL(None, use_errno=True).prctl
    control.argtypes = (ctypes.c_int, *4 * (ctypes.c_ulong,))
    for call in (
        (1, signal.SIGKILL, 0, 0, 0),
        (38, 1, 0, 0, 0),
        (22, 2, ctypes.addressof(program), 0, 0),
    ):
        if control(*call):
            raise UnsupportedError(
                f"the kernel does not filter calls: {os.strerror(ctypes.get_errno())}"
            )


def _filter(process: int) -> Iterator[tuple[int, int, int, int]]:
    """The steps of a filter: an operation, how many steps to skip if true and if false, and a number."""
    load, equal, any_bit, at_least, add, end, end_so = 0x20, 0x15, 0x45, 0x35, 0x04, 0x06, 0x16
    allowed, killed, failed = (end, 0, 0, 0x7FFF0000), (end, 0, 0, 0x80000000), 0x50000 + _REFUSED
    call, processor, arguments = (
        (load, 0, 0, 0),
        (load, 0, 0, 4),
        [(load, 0, 0, 16 + 8 * place) for place in range(3)],
    )
    # The processor is compared first: the numbers of calls differ between the two that one kernel serves, and those of
    # 32 bits would pass a filter for 64.
    yield from (
        processor,
        (equal, 1, 0, landlock.PROCESSORS[platform.machine()]),
        killed,
        call,
        (at_least, 0, 1, 1000),
        killed,
    )
    for number, (name, is_allowed) in _calls().items():
        if not is_allowed:
            continue
        steps = [allowed]
        if name in ("open", "openat"):
            steps = [arguments[1 + (name == "openat")], (any_bit, 1, 0, _WRITING), allowed, call]
        elif name in ("kill", "tgkill"):
            steps = [arguments[0], (equal, 0, 1, process), allowed, call]
        elif name in _QUESTIONS:
            conditions = ((equal, 0, 1, one) for one in _QUESTIONS[name])
            steps = [
                arguments[1],
                *itertools.chain.from_iterable((one, allowed) for one in conditions),
                call,
            ]
        yield from ((equal, 0, len(steps), number), *steps)
    # A refused call returns an error that names its number, above all errors of the kernel, and does not kill:
    # libraries try calls that they can do without.
    yield from ((add, 0, 0, failed), (end_so, 0, 0, 0))


@cache
def _calls() -> dict[int, tuple[str, bool]]:
    """Calls of the kernel by their numbers, and whether reading may make them; for a server, before it reads files."""
    rows = csv.DictReader(Path(__file__).with_name("calls.csv").read_text().splitlines())
    machine = platform.machine()
    return {
        int(row[machine]): (row["call"], row["allowed"] == "yes")
        for row in rows
        if row.get(machine)
    }


def _named(words: str) -> str:
    """A message with the names of refused calls in place of the numbers of their errors."""

    def named(match: re.Match[str]) -> str:
        name, _ = _calls().get(
            int(match[1]) - _REFUSED, (f"number {int(match[1]) - _REFUSED}", False)
        )
        return f"reading may not call {name} of the kernel"

    return re.sub(r"Unknown error (3\d\d\d)", named, words)
