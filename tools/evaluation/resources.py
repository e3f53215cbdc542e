"""Memory and time of encoding and decoding one mesh, each in a process of its own.

Run as a program it does one of the two and prints a line of JSON:
``python -m tools.evaluation.resources encode MESH STREAM REPEATS`` or ``... decode STREAM REPEATS``.
"""

from __future__ import annotations

import json
import math
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from codec import decode, encode
from tools.meshfiles import read_mesh
from tools.sample import knot


def measure_resources(mesh_path: Path, repeats: int = 1) -> dict[str, dict[str, float]]:
    """What ``encode`` and ``decode`` of a mesh file take.

    Returns
    -------
    dict
        For both: ``seconds`` (the least of `repeats`, files not counted), ``vertices``, ``microseconds_per_vertex``
        and ``peak_mib`` (the whole process, reading the file included).
    """
    with tempfile.TemporaryDirectory() as folder:
        stream = str(Path(folder, "mesh.bsm"))
        return {
            "encode": _in_subprocess("encode", str(mesh_path), stream, str(repeats)),
            "decode": _in_subprocess("decode", stream, str(repeats)),
        }


def _in_subprocess(*words: str) -> dict[str, float]:
    command = [sys.executable, "-m", "tools.evaluation.resources", *words]
    root = Path(__file__).parents[2]
    finished = subprocess.run(command, capture_output=True, text=True, check=True, cwd=root)
    result: dict[str, float] = json.loads(finished.stdout)
    return result


def _encode(mesh_path: str, stream_path: str, repeats: int) -> dict[str, Any]:
    mesh = read_mesh(mesh_path).mesh
    seconds = math.inf
    for _ in range(repeats):
        start = time.perf_counter()
        data = encode(mesh)
        seconds = min(seconds, time.perf_counter() - start)
    Path(stream_path).write_bytes(data)
    return _summary(seconds, len(mesh.positions))


def _decode(stream_path: str, repeats: int) -> dict[str, Any]:
    data = Path(stream_path).read_bytes()
    seconds = math.inf
    for _ in range(repeats):
        start = time.perf_counter()
        mesh = decode(data)
        seconds = min(seconds, time.perf_counter() - start)
    return _summary(seconds, len(mesh.positions))


def _summary(seconds: float, vertices: int) -> dict[str, Any]:
    return {
        "seconds": seconds,
        "vertices": vertices,
        "microseconds_per_vertex": 1e6 * seconds / vertices,
        "peak_mib": peak_memory() / 2**20,
    }


def peak_memory() -> int:
    """Largest resident memory of this process so far, in bytes.

    On Linux `getrusage` also counts what the parent process held when it started this one; /proc does not.
    """
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
