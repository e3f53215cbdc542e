"""Memory and time of large meshes, as `SERVICE.md` states them; `pytest -m slow -s tests/bsm/test_costs.py` prints."""

import json
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from tests.shapes import torus

SERVICE = Path(__file__).parents[2] / "src/bsm/SERVICE.md"
MEASURE = """
import json, re, sys, time
import bsm

def memory(name):  # not by `resource`, whose largest number counts what the parent had at the fork
    return 1024 * int(re.search(name + r":\\s+(\\d+)", open("/proc/self/status").read())[1])

what, path, options = sys.argv[1], sys.argv[2], json.loads(sys.argv[3])
given = {"load": path, "decode": open(path, "rb").read()}.get(what) or bsm.load(path)
work = {"load": bsm.load, "decode": bsm.decode, "encode": bsm.encode}[what]
resident = memory("VmRSS")
begin = time.process_time()
result = work(given, **options)
seconds = time.process_time() - begin
peak = memory("VmHWM")
if what == "encode":
    open(path + ".bsm", "wb").write(result)
print(json.dumps([peak - resident, seconds]))
"""
WIDE = 20.0  # times the stated time that a busy machine may take


def stated(what: str) -> tuple[float, float, float]:
    """Return the fixed bytes, the bytes a triangle and the seconds a triangle that `SERVICE.md` states."""
    row = re.search(
        rf"^\| {what} \| (\d+) MiB \+ (\d+) bytes a triangle \| ([\d.]+) us a triangle",
        text(),
        re.M,
    )
    assert row is not None, f"no costs of {what}"
    return float(row[1]) * 2**20, float(row[2]), float(row[3]) * 1e-6


def text() -> str:
    return SERVICE.read_text("utf-8")


def costs(what: str, path: Path, **options: object) -> tuple[float, float]:
    """Return the bytes above those before, and the seconds, that a call takes in a process of its own."""
    command = [sys.executable, "-W", "ignore", "-c", MEASURE, what, str(path), json.dumps(options)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    memory, seconds = json.loads(done.stdout)
    return memory, seconds


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="the resident memory is read from /proc")
@pytest.mark.parametrize("rows", [316, 708])  # 200,000 triangles, and a million
def test_large_meshes_take_what_is_stated(rows: int, tmp_path: Path) -> None:
    smooth = torus(rows, rows)
    bumps = (
        1.0
        + 0.03 * np.sin(9.0 * smooth.positions[:, [1, 2, 0]])
        + 0.02 * np.cos(17.0 * smooth.positions)
    )
    positions = smooth.positions * bumps
    edge = float(np.linalg.norm(positions[0] - positions[1]))
    # As of a scan.
    positions += np.random.default_rng(1).normal(scale=0.03 * edge, size=positions.shape)
    faces = len(smooth.faces)
    write_ply(tmp_path / "scan.ply", positions, smooth.faces)
    write_obj(tmp_path / "scan.obj", positions, smooth.faces)
    calls = (
        ("load PLY", "load", "scan.ply", {}),
        ("load OBJ", "load", "scan.obj", {}),
        ("encode quick", "encode", "scan.obj", {"effort": "quick", "threads": 1}),
        ("encode", "encode", "scan.ply", {"threads": 1}),
        ("decode", "decode", "scan.ply.bsm", {"threads": 1}),
    )
    for name, what, file, options in calls:
        memory, seconds = costs(what, tmp_path / file, **options)
        print(
            f"{faces} triangles, {name}: {memory / faces:.0f} bytes and {1e6 * seconds / faces:.1f} us a triangle"
        )
        fixed, each, time = stated(name)
        assert memory <= fixed + each * faces, f"{name}: {memory / faces:.0f} bytes a triangle"
        assert seconds <= WIDE * (1.0 + time * faces), (
            f"{name}: {1e6 * seconds / faces:.1f} us a triangle"
        )


def write_ply(path: Path, positions: np.ndarray, faces: np.ndarray) -> None:
    corners = np.zeros(len(faces), [("count", "u1"), ("faces", "<i4", 3)])
    corners["count"], corners["faces"] = 3, faces
    head = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(positions)}\n"
    head += "property float x\nproperty float y\nproperty float z\n"
    head += f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    path.write_bytes(head.encode() + positions.astype("<f4").tobytes() + corners.tobytes())


def write_obj(path: Path, positions: np.ndarray, faces: np.ndarray) -> None:
    points = "".join(f"v {x:.7g} {y:.7g} {z:.7g}\n" for x, y, z in positions.tolist())
    path.write_text(
        points + "".join(f"f {a} {b} {c}\n" for a, b, c in (faces + 1).tolist()), "ascii"
    )
