"""Readers that may crash: a process of its own runs them, so that a crash is an error, also of a file that is trusted.

The process stays for the next file, since it takes a while to load VTK. With Landlock it forks for each file, and the
child may only read its folder, since these libraries open files by themselves. Answers are pickled, which only files
that are trusted may cause: those from strangers are read in the stricter processes of `isolation.py`, which set `here`.
"""

import atexit
import os
import pickle
import subprocess
import sys
from contextlib import suppress
from functools import cache
from pathlib import Path
from threading import Lock
from typing import Any, TypeAlias

from bsm.bitstream.errors import BsmError, FormatError, UnsupportedError, imported
from bsm.bitstream.limits import Limits
from bsm.files import landlock
from bsm.files.formats.outside import refuse_outside
from bsm.files.formats.polygons import Polygons
from bsm.files.motion.folder import read_steps
from bsm.files.motion.frames import Frames, Wanted
from bsm.files.table import load_modules

_COMMAND = "from bsm.files.apart import serve; serve()"
_TURN = Lock()
Surface: TypeAlias = tuple[Polygons, tuple[float, ...]]


def surface_of(
    path: str,
    kind: str,
    limits: Limits,
    step: int | None = None,
    with_sets: bool = True,
    *,
    here: bool = False,
) -> Surface:
    """The surfaces in a file of VTK as a frame, or at rest without a step, and its times; `here`: in this process."""
    request = os.path.abspath(path), kind, limits, step
    if here:
        module = imported(
            "bsm.files.formats.with_vtk", f".{kind} files are read with VTK", "simulation"
        )
        refuse_outside(path, kind, limits, closed=landlock.lack() is None)
        surface: Surface = module.read_vtk(*request, with_sets=with_sets)
        return surface
    with _TURN:
        answer = _answer(*request)
        # In a fresh process, and without the sets of Exodus, at which VTK may crash.
        if answer is None:
            answer = _answer(*request, False)
    if answer is None:
        raise FormatError("reading this file crashed VTK")
    if isinstance(answer, BsmError):
        raise answer
    return answer


def _answer(*request: Any) -> Surface | BsmError | None:
    """Ask the process for a file; None if that crashes it."""
    process = _process()
    try:
        pickle.dump(request, process.stdin)
        process.stdin.flush()
        answer: Surface | BsmError = pickle.load(process.stdout)
    # A crash shows as the end of the pipe. The next file gets a new process.
    except (OSError, EOFError, pickle.UnpicklingError):
        _process.cache_clear()
        _end(process)
        return None
    return answer


def frames_of(
    path: str, kind: str, request: Wanted, limits: Limits, *, here: bool = False
) -> Frames | None:
    """The steps in a file of VTK as frames; None if it has fewer than two."""
    _, times = surface_of(path, kind, limits, here=here)
    size = os.path.getsize(path)
    return read_steps(
        lambda step: surface_of(path, kind, limits, step, here=here)[0],
        times,
        size,
        request,
        limits,
    )


@cache
def _process() -> Any:
    if not Path(sys.executable or "").name.lower().startswith(("python", "pypy")):
        raise UnsupportedError(
            "files of VTK are read in a process of their own, and sys.executable is not Python"
        )
    package_folder = str(Path(sys.modules["bsm"].__file__ or "").parents[1])
    paths = os.pathsep.join(filter(None, (package_folder, os.environ.get("PYTHONPATH", ""))))
    pipes: Any = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.DEVNULL}
    # A program and not multiprocessing: its spawn would run the user's main module again, and fork copies held locks.
    begun = subprocess.Popen(
        [sys.executable, "-P", "-c", _COMMAND], env={**os.environ, "PYTHONPATH": paths}, **pipes
    )
    # Otherwise Popen warns at exit of a process that still runs.
    atexit.register(_end, begun)
    return begun


def _end(process: Any) -> int:
    """Let the process end, and return its exit code."""
    with suppress(OSError):
        process.stdin.close()
    process.stdout.close()
    code: int = process.wait()
    return code


def serve() -> None:
    """Read the files that are asked for at standard input, until it ends."""
    answers = os.fdopen(os.dup(1), "wb")
    # Answers keep the pipe under another number: one line that VTK prints would break the pickle.
    os.dup2(2, 1)  # libraries print
    while True:
        try:
            request = pickle.load(sys.stdin.buffer)
        except EOFError:
            return
        if landlock.lack() is not None:
            _write_answer(request, answers)
            continue
        load_modules(request[1])
        child = os.fork()
        if not child:
            landlock.close_files(landlock.folders_of([request[0]]))
            _write_answer(request, answers)
            os._exit(0)
        # A crash of the child is told as one of this process.
        _, status = os.waitpid(child, 0)
        if code := os.waitstatus_to_exitcode(status):
            os._exit(abs(code))


def _write_answer(request: Any, answers: Any) -> None:
    """Read the file that is asked for, and write its surfaces or the error."""
    try:
        answer: Surface | BsmError = surface_of(*request, here=True)
    except BsmError as error:
        answer = error
    except MemoryError:
        answer = FormatError("reading this file takes more memory than there is")
    pickle.dump(answer, answers)
    answers.flush()
