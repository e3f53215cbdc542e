"""Memory and time of encoding and decoding one mesh, each in a process of its own.

Run as a program it does one of the two and prints a line of JSON:
``python -m bsm.evaluation.resources encode MESH STREAM REPEATS`` or ``... decode STREAM REPEATS``.
"""

from __future__ import annotations

import json
import math
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

from bsm.codec.static.decoder import decode
from bsm.codec.static.encoder import encode
from bsm.evaluation.sample import knot
from bsm.files.mesh import read_mesh
from bsm.files.stream import inspect_stream

Result = TypeVar("Result")


def measure_resources(mesh_path: Path, repeats: int = 1) -> dict[str, dict[str, float]]:
    """What ``encode`` and ``decode`` of a mesh file take."""
    with tempfile.TemporaryDirectory() as folder:
        stream = str(Path(folder, "mesh.bsm"))
        return {
            "encode": _in_subprocess("encode", str(mesh_path), stream, str(repeats)),
            "decode": _in_subprocess("decode", stream, str(repeats)),
        }


def _in_subprocess(*words: str) -> dict[str, float]:
    command = [sys.executable, "-m", "bsm.evaluation.resources", *words]
    finished = subprocess.run(command, capture_output=True, text=True, check=True)
    result: dict[str, float] = json.loads(finished.stdout)
    return result


def _encode(mesh_path: str, stream_path: str, repeats: int) -> dict[str, float]:
    mesh = read_mesh(mesh_path).mesh.bare
    data, summary = _repeated(lambda: encode(mesh), repeats, len(mesh.positions))
    Path(stream_path).write_bytes(data)
    return summary


def _decode(stream_path: str, repeats: int) -> dict[str, float]:
    data = Path(stream_path).read_bytes()
    vertices = inspect_stream(iter([data])).header.vertices
    return _repeated(lambda: decode(data), repeats, vertices)[1]


def _repeated(work: Callable[[], Result], repeats: int, vertices: int) -> tuple[Result, dict[str, float]]:
    seconds = cpu_seconds = math.inf
    for _ in range(max(1, repeats)):
        start, cpu_start = time.perf_counter(), time.process_time()
        result = work()
        seconds = min(seconds, time.perf_counter() - start)
        cpu_seconds = min(cpu_seconds, time.process_time() - cpu_start)
    return result, {
        "vertices": vertices,
        "seconds": seconds,
        "cpu_seconds": cpu_seconds,
        "cpu_microseconds_per_vertex": 1e6 * cpu_seconds / vertices,
        "peak_mib": peak_memory() / 2**20,
    }


def peak_memory() -> int:
    """Largest resident memory of this process so far, in bytes."""
    status = Path("/proc/self/status")
    if status.exists():
        line = next(line for line in status.read_text().splitlines() if line.startswith("VmHWM:"))
        return 1024 * int(line.split()[1])
    unit = 1 if sys.platform == "darwin" else 1024
    return unit * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


def main() -> None:
    """Do one of the two and print what it took."""
    # Loads the compiled kernels, so that the time is that of the work.
    decode(encode(knot(2_000)))
    match sys.argv[1:]:
        case ["encode", mesh, stream, repeats]:
            result = _encode(mesh, stream, int(repeats))
        case ["decode", stream, repeats]:
            result = _decode(stream, int(repeats))
        case _:
            sys.exit(__doc__)
    print(json.dumps(result))


if __name__ == "__main__":
    main()
