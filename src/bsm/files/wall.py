"""A wall around readers of files: a process of its own for each file, with limits that the kernel enforces.

A server with all readers loaded is started once, and forks for each file. The child opens no socket, starts no program,
writes nothing, and ends where it exceeds its memory or time. With Landlock (landlockpy) it may only read the folder of
the file and those of Python and its packages; without, only what our own readers read comes here. Arrays, notes and
errors come back as data in shared memory.
"""

import ctypes
import fcntl
import gc
import importlib
import io
import itertools
import json
import math
import mmap
import os
import platform
import resource
import signal
import socket
import struct
import subprocess
import sys
import sysconfig
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import asdict
from functools import cache
from pathlib import Path
from typing import Any

from bsm.bitstream.errors import BsmError, FormatError, LimitError, UnsupportedError
from bsm.bitstream.limits import Limits
from bsm.files.answer import found_in, leave
from bsm.files.formats.polygons import MeshFile
from bsm.files.motion.frames import Frames, Wanted
from bsm.files.pipes import Input

_COMMAND = "from bsm.files.wall import serve; serve({number})"
_KIND = struct.Struct("<16sI")  # the name of a format and seconds, as they are sent
_END = struct.Struct("<iQd")  # a status, the most memory in bytes and seconds of processor time, as they come back
_HEAD = struct.Struct("<QQ")  # the bytes of a question in shared memory, and those of a file after it
_ROOM = 1 << 24  # bytes of shared memory besides the bytes that are given and those that come back
_LIBRARIES = {
    "gltf": ("bsm.gltf.scene", "bsm.gltf.coding", "DracoPy", "PIL.Image"),
    "own": ("bsm.files.mesh", *(f"bsm.files.formats.{kind}" for kind in ("npz", "obj", "off", "ply", "stl", "vtp"))),
    "dae": ("bsm.files.formats.dae", "collada", "lxml.etree"),
    "usd": ("bsm.files.motion.usd", "pxr.Usd", "pxr.UsdGeom", "pxr.UsdShade", "pxr.UsdSkel"),
    "om": ("bsm.files.formats.om", "openmesh"),
    "3mf": ("bsm.files.formats.three_mf", "lib3mf"),
    "other": ("bsm.files.formats.with_trimesh", "trimesh"),
}
_SMALLEST = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"  # a file that has been read, so that the next is read sooner
_PATIENCE = 10  # times its processor time that a child may take, since the machine may be busy
_CALLS = {  # of the kernel, by processor: its number in seccomp, and socket, execve, execveat, ptrace, io_uring_setup
    "x86_64": (0xC000003E, (41, 59, 322, 101, 425)),
    "aarch64": (0xC00000B7, (198, 221, 281, 117, 425)),
}
_QUIET = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "PXR_WORK_THREAD_LIMIT": "1", "MALLOC_ARENA_MAX": "1"}


@cache
def lack() -> str | None:
    """What this system lacks to keep files of others from readers."""
    try:
        landlock: Any = importlib.import_module("landlockpy")
    except ImportError:
        return "landlockpy: pip install landlockpy"
    if platform.machine() not in _CALLS:
        return "a processor of x86-64 or ARM"
    return None if landlock.supported() else "a kernel with Landlock"


def read_behind_wall(given: Input, file_format: str | None, limits: Limits, kind: str) -> MeshFile:
    """Read a mesh file in a process of its own; errors as of `read_mesh`."""
    found: MeshFile = _read_there(_asked(given, file_format, kind), limits, kind)
    return found


def frames_behind_wall(
    given: Input | Sequence[str], file_format: str | None, limits: Limits, kind: str, wanted: Wanted | None
) -> Frames | None:
    """Read all frames of a sequence in a process of its own; errors as of `open_sequence`."""
    asked = _asked(given, file_format, kind) if isinstance(given, Input) else {"names": list(given)}
    mesh = os.path.abspath(wanted.mesh) if wanted and wanted.mesh else None
    more = {"sequence": True, "wanted": {**asdict(wanted), "mesh": mesh} if wanted else None, "beside": mesh}
    asked = {"format": file_format, **asked, **more}
    found: Frames | None = _read_there(asked, limits, kind)
    return found


def _asked(given: Input, file_format: str | None, kind: str) -> dict[str, Any]:
    path = os.path.abspath(given.name) if given.is_file else None
    chosen = file_format if lack() is None else file_format or kind or None  # one that others read never comes here
    return {"path": path, "name": given.name, "format": chosen, "data": b"" if path else given.read_all()}


def _read_there(asked: dict[str, Any], limits: Limits, kind: str) -> Any:
    names = asked.get("names") or [asked["path"]]
    size = sum(map(os.path.getsize, names)) if names[0] else len(asked["data"])
    asked["limits"] = asdict(limits)
    asked["memory"] = int(min(limits.memory_for(limits.vertices, size), 1 << 40))
    asked["seconds"] = math.ceil(min(limits.work_for(limits.vertices, size) / 1e9, 1e6))
    asked["closed"] = lack() is None
    data = asked.pop("data", b"")
    question = json.dumps(asked).encode()
    with shared(_ROOM + len(question) + len(data) + asked["memory"]) as memory:
        os.pwrite(memory, _HEAD.pack(len(question), len(data)) + question + data, 0)
        status = end_of_child(memory, _library(kind), _PATIENCE * asked["seconds"])[0]
        if os.WIFSIGNALED(status):
            raise _end_of(os.WTERMSIG(status), asked)
        return found_in(memory, limits)


def _library(kind: str) -> str:
    if kind in ("glb", "gltf"):
        return "gltf"
    if kind.startswith("usd"):
        return "usd"
    own = ("npz", "obj", "off", "ply", "stl", "vtp", "")
    return "own" if kind in own else kind if kind in _LIBRARIES else "other"


def _end_of(number: int, asked: dict[str, Any]) -> BsmError:
    """The error of a child that a signal has ended."""
    if number == signal.SIGXCPU:
        return LimitError(f"reading takes more than {asked['seconds']} s of processor time (Limits.work, most_work)")
    if number == signal.SIGALRM:
        return LimitError(f"reading this file takes more than {_PATIENCE * asked['seconds']} s")
    if number == signal.SIGKILL:
        return LimitError("the process that read this file was ended: the system has too little memory")
    return FormatError(f"reading this file crashed the library that reads it ({signal.Signals(number).name})")


@contextmanager
def shared(size: int) -> Iterator[int]:
    """Memory that other processes can map; pages count once they are written."""
    memory = os.memfd_create("bsm", os.MFD_CLOEXEC | os.MFD_ALLOW_SEALING)
    try:
        os.ftruncate(memory, size)
        fcntl.fcntl(memory, fcntl.F_ADD_SEALS, fcntl.F_SEAL_SHRINK | fcntl.F_SEAL_GROW | fcntl.F_SEAL_SEAL)
        yield memory
    finally:
        os.close(memory)


# ------------------------------------------------------------------------------------------------ the server


class _Server:
    """The process that forks for each file; it ends with the last process that has its socket."""

    def __init__(self) -> None:
        self._socket, there = socket.socketpair()
        paths = (str(Path(importlib.import_module("bsm").__file__ or "").parents[1]), os.environ.get("PYTHONPATH", ""))
        environment = os.environ | _QUIET | {"PYTHONPATH": os.pathsep.join(filter(None, paths))}
        command = [sys.executable, "-P", "-c", _COMMAND.format(number=there.fileno())]
        nothing: Any = dict.fromkeys(("stdin", "stdout", "stderr"), subprocess.DEVNULL)
        with there:
            started = subprocess.Popen(command, pass_fds=[there.fileno()], env=environment, **nothing)
            self.number, started.returncode = started.pid, 0  # never waited for: it ends with its socket

    def __del__(self) -> None:
        self._socket.close()

    def read(self, memory: int, library: str, seconds: int) -> tuple[int, int, float]:
        """Let a child read the file that shared memory names; return its status, memory and time."""
        here, there = socket.socketpair()
        with here:
            with there:
                socket.send_fds(self._socket, [_KIND.pack(library.encode(), seconds)], [there.fileno(), memory])
            end = here.recv(_END.size, socket.MSG_WAITALL)
            if len(end) < _END.size:
                raise ConnectionError("the process that reads files has died")
            status, most, taken = _END.unpack(end)
            return status, most, taken


@cache
def _server() -> _Server:
    return _Server()


def end_of_child(memory: int, library: str, seconds: int) -> tuple[int, int, float]:
    try:
        return _server().read(memory, library, seconds)
    except ConnectionError:  # somebody has ended it
        _server.cache_clear()
    try:
        return _server().read(memory, library, seconds)
    except ConnectionError as error:
        raise UnsupportedError(f"the process that reads files from strangers does not start: {error}") from error


def serve(number: int) -> None:
    """Fork for each file that is asked for, until the last process that can ask has ended."""
    _load("own")
    _libraries()
    lack()  # landlockpy looks for the C library when it is first used
    importlib.import_module("bsm.files.mesh").read_mesh(_SMALLEST, isolated=False)
    gc.freeze()
    with socket.socket(fileno=number) as asked:
        while True:
            signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # watchers end alone
            request, files, _, _ = socket.recv_fds(asked, _KIND.size, 2)
            if not request:
                return
            library, seconds = _KIND.unpack(request)
            _load(library.rstrip(b"\0").decode())
            if not os.fork():
                asked.close()
                _watch(files[0], files[1], seconds)
            for file in files:
                os.close(file)


@cache
def _load(library: str) -> None:
    for name in _LIBRARIES[library]:
        with suppress(ImportError):
            importlib.import_module(name)


def _watch(answer: int, memory: int, seconds: int) -> None:
    """Let a child read for so long, and tell how it ended."""
    try:
        signal.signal(signal.SIGCHLD, signal.SIG_DFL)
        child = os.fork()
        if not child:
            os.close(answer)
            _read(memory)
        signal.signal(signal.SIGALRM, lambda *_: os.kill(child, signal.SIGALRM))
        signal.alarm(seconds)
        _, status, used = os.wait4(child, 0)
        os.write(answer, _END.pack(status, used.ru_maxrss << 10, used.ru_utime + used.ru_stime))
    finally:
        os._exit(0)


# ------------------------------------------------------------------------------------------------ the child


def _read(memory: int) -> None:
    """Read the file that shared memory names, and leave the mesh or the error there."""
    try:
        question, size = _HEAD.unpack(os.pread(memory, _HEAD.size, 0))
        asked = json.loads(os.pread(memory, question, _HEAD.size))
        asked["data"] = os.pread(memory, size, _HEAD.size + question)
        try:
            _confine(asked)
            leave(memory, _called(asked))
        except MemoryError:
            taken = f"{asked['memory']:,} bytes of memory (Limits.memory, most_memory)"
            leave(memory, LimitError(f"reading this file takes more than {taken}"))
        except BsmError as error:
            leave(memory, error)
        except OSError as error:
            name = asked["name"] if error.filename == asked.get("path", "") else error.filename
            leave(memory, FormatError(f"reading this file failed: {error.strerror}{f': {name}' if name else ''}"))
        except Exception as error:
            leave(memory, FormatError(f"reading this file failed: {type(error).__name__}: {str(error)[:200]}"))
    finally:
        os._exit(0)


def _called(asked: dict[str, Any]) -> MeshFile | Frames | None:
    """Read as without a wall, in here."""
    given = (asked["format"], Limits(**asked["limits"]))
    wanted = Wanted(**asked["wanted"]) if asked.get("wanted") else None
    # Not at the top: they import this module.
    mesh, sequence = (importlib.import_module(f"bsm.files.{name}") for name in ("mesh", "sequence"))
    if names := asked.get("names"):
        frames: Frames = sequence.open_frames(names, *given, wanted, isolated=False)
        return frames
    source: Any = asked["path"]
    if source is None:
        source = io.BytesIO(asked["data"])
        source.name = asked["name"]
    found: MeshFile | Frames | None
    if asked.get("sequence"):
        found = sequence.open_sequence(source, given[0], wanted, given[1], isolated=False)
    else:
        found = mesh.read_mesh(source, *given, isolated=False)
    return found


def _confine(asked: dict[str, Any]) -> None:
    """Take from this process what reading needs not: files of others, network, writing, memory and time beyond."""
    held = int(Path("/proc/self/statm").read_text().split()[0]) * mmap.PAGESIZE
    if asked["closed"]:
        paths = filter(None, [*(asked.get("names") or [asked["path"]]), asked.get("beside")])
        _close_files({os.path.dirname(way(path)) for path in paths for way in (os.path.abspath, os.path.realpath)})
    _close_calls()
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    for limit, most in (
        (resource.RLIMIT_CORE, 0),
        (resource.RLIMIT_FSIZE, 0),
        (resource.RLIMIT_AS, held + asked["memory"]),
        (resource.RLIMIT_CPU, asked["seconds"]),
    ):
        resource.setrlimit(limit, (most, most + (limit == resource.RLIMIT_CPU)))


def _close_files(beside: set[str]) -> None:
    landlock: Any = importlib.import_module("landlockpy")
    known = landlock.AccessFS.READ_FILE | landlock.AccessFS.READ_DIR
    scope = landlock.Scope.SIGNAL | landlock.Scope.ABSTRACT_UNIX_SOCKET
    with landlock.Ruleset(scoped=scope) as rules:
        for path in itertools.chain(_libraries(), beside):
            with suppress(OSError):  # the folder may have been removed meanwhile
                rules.allow_path(path, known if os.path.isdir(path) else landlock.AccessFS.READ_FILE)
        rules.restrict()


def _close_calls() -> None:
    """Let the kernel refuse sockets, programs and the memory of other processes, by a filter of its calls."""
    architecture, refused = _CALLS.get(platform.machine(), (0, ()))
    if not refused:
        return  # `lack` says so
    load, equal, at_least, end = 0x20, 0x15, 0x35, 0x06  # the processor is at 4 of what it looks at, the call at 0
    program = [(load, 0, 0, 4), (equal, 1, 0, architecture), (end, 0, 0, 0x80000000), (load, 0, 0, 0)]
    program += [(at_least, len(refused) + 1, 0, 0x40000000)]
    program += [(equal, len(refused) - place, 0, number) for place, number in enumerate(refused)]
    program += [(end, 0, 0, 0x7FFF0000), (end, 0, 0, 0x50001)]  # allowed; not permitted
    code = ctypes.create_string_buffer(b"".join(struct.pack("<HBBI", *step) for step in program))
    known = ctypes.create_string_buffer(struct.pack("@HP", len(program), ctypes.addressof(code)))
    control = ctypes.CDLL(None, use_errno=True).prctl
    control.argtypes = (ctypes.c_int, *4 * (ctypes.c_ulong,))
    for call in ((38, 1, 0, 0, 0), (22, 2, ctypes.addressof(known), 0, 0)):  # no new privileges; the filter
        if control(*call):
            raise UnsupportedError(f"the kernel does not filter calls: {os.strerror(ctypes.get_errno())}")


@cache
def _libraries() -> tuple[str, ...]:
    """Folders of Python, of packages and of libraries; not all of `sys.path`, where a checkout may be."""
    installed = {path for path in sys.path if Path(path).name in ("site-packages", "dist-packages")}
    python = {sysconfig.get_path(name) for name in ("stdlib", "platstdlib", "purelib", "platlib")}
    loaded = {path for module in list(sys.modules.values()) for path in list(getattr(module, "__path__", ()))}
    system = {"/usr", "/lib", "/lib64", "/etc/ld.so.cache", "/dev/null", "/dev/urandom"}
    return tuple(filter(os.path.exists, installed | python | loaded | system))
