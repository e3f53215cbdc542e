"""Decoders agree to the last bit, whatever the library behind numpy."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np

from bsm import SequenceOptions
from bsm.api import encode_sequence
from tests.shapes import torus

ROOT = Path(__file__).parents[3]
PROCESSORS = ("SkylakeX", "Prescott")
DECODE = (
    "import sys, numpy; from bsm.codec.decoding import decode_sequence;"
    "numpy.savez(sys.argv[1], *(decode_sequence(open(name, 'rb').read())[0] for name in sys.argv[2:]))"
)


def waving(frames: int, crumpled: bool) -> tuple[np.ndarray, np.ndarray]:
    """A torus that waves; crumpled, a third of its vertices lie in few places, so that most triangles have no area."""
    mesh = torus(24, 14)
    still = mesh.positions.copy()
    if crumpled:
        still[::3] = np.round(still[::3], 0)
    angle = still[:, 0] * 2
    moves = [np.stack([0 * angle, np.sin(angle + t / 2), np.cos(angle - t)], axis=1) for t in range(frames)]
    return np.array([still + 0.1 * move for move in moves]), mesh.faces


def streams() -> list[bytes]:
    return [
        encode_sequence(
            *waving(6, crumpled), SequenceOptions(keep=keep, low_delay=low_delay, block_size=200, threads=1)
        )
        for keep in (1.0, 0.05, 0.005)
        for low_delay in (0, 1, 4)
        for crumpled in (False, True)
    ]


def test_processors_agree(tmp_path: Path) -> None:
    names = []
    for number, data in enumerate(streams()):
        names.append(str(tmp_path / f"{number}.bsm"))
        Path(names[-1]).write_bytes(data)
    found = []
    for processor in PROCESSORS:
        out = str(tmp_path / f"{processor}.npz")
        environment = {**os.environ, "OPENBLAS_CORETYPE": processor}
        subprocess.run([sys.executable, "-c", DECODE, out, *names], cwd=ROOT, env=environment, check=True, timeout=120)
        with np.load(out) as arrays:
            found.append([arrays[f"arr_{number}"] for number in range(len(names))])
    for other in found[1:]:
        for stream, two in zip(found[0], other, strict=True):
            assert np.array_equal(two, stream)
