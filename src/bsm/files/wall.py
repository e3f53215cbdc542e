"""A wall around readers of mesh files: a process of its own for each file, with limits that the kernel enforces.

A server with all readers loaded is started once, and forks for each file. The child writes nothing, and ends where it
exceeds its memory or processor time. If the kernel has Landlock and landlockpy is installed, it may only read the
folder of the file and those of Python and its packages, and connect to nothing (TCP). Arrays, notes and errors come
back as data in shared memory.
"""

import fcntl
import gc
import importlib
import io
import math
import mmap
import os
import resource
import signal
import socket
import subprocess
import sys
import sysconfig
from collections.abc import Iterator
from contextlib import closing, contextmanager, suppress
from dataclasses import asdict
from functools import cache
from pathlib import Path
from typing import Any

import msgpack
import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import BsmError, FormatError, LimitError, UnsupportedError
from bsm.bitstream.limits import Limits
from bsm.codec.geometry.attributes import KINDS, Attribute
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.files.formats.polygons import MeshFile
from bsm.files.pipes import Input

AVAILABLE = sys.platform == "linux"
_COMMAND = "from bsm.files.wall import serve; serve({number})"
_KIND = 16  # bytes of the name of a format, as it is sent
_HEAD = 8  # bytes of the length of what follows, in shared memory
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
_QUIET = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "PXR_WORK_THREAD_LIMIT": "1", "MALLOC_ARENA_MAX": "1"}


def read_behind_wall(given: Input, file_format: str | None, limits: Limits) -> MeshFile:
    """Read a mesh file in a process of its own; errors as of `read_mesh`."""
    path = os.path.abspath(given.name) if given.is_file else None
    data = b"" if path else given.read_all()
    size = os.path.getsize(path) if path else len(data)
    asked: dict[str, Any] = {
        "path": path,
        "name": given.name,
        "format": file_format,
        "limits": asdict(limits),
        "data": data,
    }
    asked["memory"] = int(min(limits.memory_for(limits.vertices, size), 1 << 40))
    asked["seconds"] = math.ceil(min(limits.work_for(limits.vertices, size) / 1e9, 1e6))
    request = msgpack.packb(asked)
    with _shared(_ROOM + len(request) + asked["memory"]) as memory:
        os.pwrite(memory, len(request).to_bytes(_HEAD, "little") + request, 0)
        status = _status_of(memory, _library(file_format or Path(given.name).suffix[1:].lower()))
        if os.WIFSIGNALED(status):
            raise _end_of(os.WTERMSIG(status), asked)
        return _mesh_in(memory, limits)


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
        return LimitError(
            f"reading this file takes more than {asked['seconds']} s of processor time (Limits.work, most_work)"
        )
    if number == signal.SIGKILL:
        return LimitError("the process that read this file was ended: the system has too little memory")
    return FormatError(f"reading this file crashed the library that reads it ({signal.Signals(number).name})")


@contextmanager
def _shared(size: int) -> Iterator[int]:
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

    def read(self, memory: int, library: str) -> int:
        """Let a child read the file that shared memory names; return its status."""
        here, there = socket.socketpair()
        with here:
            with there:
                socket.send_fds(self._socket, [library.encode().ljust(_KIND)], [there.fileno(), memory])
            status = b""
            while len(status) < 4:
                piece = here.recv(4)
                if not piece:
                    raise ConnectionError("the process that reads files has died")
                status += piece
            return int.from_bytes(status, "little")


@cache
def _server() -> _Server:
    return _Server()


def _status_of(memory: int, library: str) -> int:
    try:
        return _server().read(memory, library)
    except ConnectionError:  # somebody has ended it
        _server.cache_clear()
    try:
        return _server().read(memory, library)
    except ConnectionError as error:
        raise UnsupportedError(
            f"a file from strangers is read in a process of its own, and that does not start: {error}"
        ) from error


def serve(number: int) -> None:
    """Fork for each file that is asked for, until the last process that can ask has ended."""
    _load("own")
    _libraries()
    with suppress(ImportError, OSError):  # it looks for the C library when it is first used
        importlib.import_module("landlockpy").supported()
    importlib.import_module("bsm.files.mesh").read_mesh(_SMALLEST, isolated=False)
    gc.freeze()
    with socket.socket(fileno=number) as asked:
        while True:
            signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # watchers end alone
            library, files, _, _ = socket.recv_fds(asked, _KIND, 2)
            if not library:
                return
            _load(library.decode().strip())
            if not os.fork():
                asked.close()
                _watch(*files)
            for file in files:
                os.close(file)


@cache
def _load(library: str) -> None:
    for name in _LIBRARIES[library]:
        with suppress(ImportError):
            importlib.import_module(name)


def _watch(answer: int, memory: int) -> None:
    """Let a child read, and tell how it ended."""
    try:
        signal.signal(signal.SIGCHLD, signal.SIG_DFL)
        child = os.fork()
        if not child:
            os.close(answer)
            _read(memory)
        status = os.waitpid(child, 0)[1]
        os.write(answer, status.to_bytes(4, "little"))
    finally:
        os._exit(0)


# ------------------------------------------------------------------------------------------------ the child


def _read(memory: int) -> None:
    """Read the file that shared memory names, and leave the mesh or the error there."""
    try:
        asked = _message(memory, 1 << 62)
        found: dict[str, Any]
        arrays: list[npt.NDArray[Any]] = []
        try:
            _confine(asked)
            source: Any = asked["path"]
            if source is None:
                source = io.BytesIO(asked["data"])
                source.name = asked["name"]
            # Not at the top: it imports this module.
            read_mesh = importlib.import_module("bsm.files.mesh").read_mesh
            found = _described(read_mesh(source, asked["format"], Limits(**asked["limits"]), isolated=False), arrays)
            _leave(memory, found, arrays)
        except MemoryError:
            taken = f"{asked['memory']:,} bytes of memory (Limits.memory, most_memory)"
            _leave(memory, {"error": ["LimitError", f"reading this file takes more than {taken}"]})
        except BsmError as error:
            _leave(memory, {"error": [type(error).__name__, error.message, error.offset, error.frame, error.block]})
        except OSError as error:
            name = asked["name"] if error.filename == asked["path"] else error.filename
            _leave(memory, {"system": [error.errno, error.strerror, name and str(name)]})
        except Exception as error:
            words = f"reading this file failed: {type(error).__name__}: {str(error)[:200]}"
            _leave(memory, {"error": ["FormatError", words]})
    finally:
        os._exit(0)


def _confine(asked: dict[str, Any]) -> None:
    """Take from this process what reading needs not: files of others, network, writing, memory and time beyond."""
    held = int(Path("/proc/self/statm").read_text().split()[0]) * mmap.PAGESIZE
    with suppress(ImportError, OSError):
        landlock: Any = importlib.import_module("landlockpy")
        known = landlock.AccessFS.READ_FILE | landlock.AccessFS.READ_DIR
        with landlock.Ruleset() as rules:
            path = asked["path"]
            beside = () if path is None else {os.path.dirname(path), os.path.dirname(os.path.realpath(path))}
            for folder in (*_libraries(), *filter(os.path.exists, beside)):
                rules.allow_path(folder, known if os.path.isdir(folder) else landlock.AccessFS.READ_FILE)
            rules.restrict()
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    for limit, most in (
        (resource.RLIMIT_CORE, 0),
        (resource.RLIMIT_FSIZE, 0),
        (resource.RLIMIT_AS, held + asked["memory"]),
        (resource.RLIMIT_CPU, asked["seconds"]),
    ):
        resource.setrlimit(limit, (most, most + (limit == resource.RLIMIT_CPU)))


@cache
def _libraries() -> tuple[str, ...]:
    """Folders of Python, of installed and loaded packages and of libraries of the system.

    Not all of `sys.path`: an editable installation puts the folder there that holds the checkout.
    """
    installed = {path for path in sys.path if Path(path).name in ("site-packages", "dist-packages")}
    python = {sysconfig.get_path(name) for name in ("stdlib", "platstdlib", "purelib", "platlib")}
    loaded = {path for module in list(sys.modules.values()) for path in list(getattr(module, "__path__", ()))}
    system = {"/usr", "/lib", "/lib64", "/etc/ld.so.cache", "/dev/null", "/dev/urandom"}
    return tuple(filter(os.path.exists, installed | python | loaded | system))


def _described(found: MeshFile, arrays: list[npt.NDArray[Any]]) -> dict[str, Any]:
    """A mesh as data, but for its arrays, which are appended."""

    def number(array: npt.NDArray[Any] | None) -> int | None:
        if array is None:
            return None
        arrays.append(array)
        return len(arrays) - 1

    mesh = found.mesh
    return {
        "positions": number(mesh.positions),
        "faces": number(mesh.faces),
        "attributes": [[a.name, number(a.values), a.domain, a.semantic, number(a.indices)] for a in mesh.attributes],
        "metadata": dict(mesh.metadata),
        "notes": found.notes,
        "dropped": found.dropped,
    }


def _leave(memory: int, found: dict[str, Any], arrays: list[npt.NDArray[Any]] | tuple[()] = ()) -> None:
    message = msgpack.packb({**found, "arrays": [[str(array.dtype), array.shape] for array in arrays]})
    total = _HEAD + len(message) + sum(array.nbytes for array in arrays)
    with closing(mmap.mmap(memory, total)) as view:
        view[:_HEAD] = len(message).to_bytes(_HEAD, "little")
        view[_HEAD : _HEAD + len(message)] = message
        place = _HEAD + len(message)
        for array in arrays:
            view[place : place + array.nbytes] = np.ascontiguousarray(array).tobytes()
            place += array.nbytes


# ------------------------------------------------------------------------------------------------ what came back


def _message(memory: int, most: int) -> Any:
    size = int.from_bytes(os.pread(memory, _HEAD, 0), "little")
    if size > min(most, os.fstat(memory).st_size - _HEAD):
        raise FormatError("the process that read this file left no mesh")
    return msgpack.unpackb(os.pread(memory, size, _HEAD), strict_map_key=False)


@cache
def _kinds() -> dict[str, type[BsmError]]:
    """All errors of ours, by their names."""
    found, waiting = dict[str, type[BsmError]](), [BsmError]
    while waiting:
        kind = waiting.pop()
        found[kind.__name__] = kind
        waiting += kind.__subclasses__()
    return found


def _mesh_in(memory: int, limits: Limits) -> MeshFile:
    """The mesh or the error that a child has left, which a hostile file may have taken over."""
    try:
        found = _message(memory, 2 * limits.metadata_bytes + 5 * limits.frame_bytes + _ROOM)
        if "system" in found:
            raise OSError(*found["system"])
        if "error" in found:
            kind, message, *places = found["error"]
            raise _kinds()[kind](message, **dict(zip(("offset", "frame", "block"), places)))
        place = _HEAD + int.from_bytes(os.pread(memory, _HEAD, 0), "little")
        arrays: list[Any] = []
        for kind, shape in found["arrays"]:
            if kind not in KINDS or min(shape, default=0) < 0:
                raise ValueError("an array of another kind")
            size = math.prod(shape) * np.dtype(kind).itemsize
            if place + size > os.fstat(memory).st_size:
                raise ValueError("an array that is not there")
            arrays.append(np.frombuffer(os.pread(memory, size, place), kind).reshape(shape))
            place += size
        attributes = [
            Attribute(name, arrays[values], domain, semantic, None if indices is None else arrays[indices])
            for name, values, domain, semantic, indices in found["attributes"]
        ]
        mesh = TriangleMesh(arrays[found["positions"]], arrays[found["faces"]], tuple(attributes), found["metadata"])
        return MeshFile(mesh, tuple(map(str, found["notes"])), tuple(map(str, found["dropped"])))
    except (BsmError, OSError):
        raise
    except Exception as error:
        raise FormatError("the process that read this file left no mesh") from error
