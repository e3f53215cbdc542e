"""Sequences in C: frames from a start on, what pieces and losses change, and the example in C++."""

import ctypes
import subprocess
from pathlib import Path

import numpy as np
import pytest

import bsm
from tests.engine.decoding import compiled, decode
from tests.streams import frames_in, moving_events_of
from tools.surgery import frames_of, stream_of

ROOT = Path(__file__).parents[2]
VECTORS = ROOT / "spec/vectors/1.0"
GOP = 7
SEQUENCES = (
    "good-sequence-long",
    "good-sequence-low-delay-long",
    "good-sequence-runs",
    "good-sequence-moving-low-delay",
)


@pytest.mark.parametrize("name", SEQUENCES)
@pytest.mark.parametrize("start", [1, 5])
def test_frames_from_a_start_on_are_those_of_the_whole(library: ctypes.CDLL, name: str, start: int) -> None:
    stream = (VECTORS / f"{name}.bsm").read_bytes()
    whole = decode(library, stream)
    expected, shown = whole.frames[start:], whole.shown
    found = decode(library, stream, start=start, pieces=101)
    assert [index for index, _ in found.frames] == [index for index, _ in expected]
    for (_, frame), (_, other) in zip(found.frames, expected, strict=True):
        assert np.array_equal(frame, other)
    for frame, other in zip(found.shown[::-1], shown[::-1], strict=False):
        assert all(np.array_equal(frame[key], other[key]) for key in other)


@pytest.mark.parametrize("name", ["good-sequence-long", "good-sequence-low-delay-long", "good-sequence-runs-many"])
def test_a_lost_gop_costs_what_it_costs_in_python(library: ctypes.CDLL, name: str) -> None:
    parts = frames_of((VECTORS / f"{name}.bsm").read_bytes())
    gops = [place for place, (kind, _) in enumerate(parts) if kind == GOP]
    parts[gops[1]] = (GOP, parts[gops[1]][1][: len(parts[gops[1]][1]) // 2])
    broken = stream_of(parts)
    found = decode(library, broken, tolerant=True)
    events = moving_events_of(broken, tolerant=True)
    lost = [(event.frames.start, len(event.frames)) for event in events if isinstance(event, bsm.LossEvent)]
    kept = list(frames_in(events))
    assert found.status == 0
    assert found.lost == lost
    assert [index for index, _ in found.frames] == kept
    assert kept
    assert lost


def test_the_example_goes_through_all_frames(tmp_path: Path) -> None:
    made = compiled()
    example = ROOT / "engine/examples/frames.cpp"
    flags = ["-std=c++17", "-Wall", "-Wextra", "-Werror", f"-I{made}"]
    subprocess.run(
        ["c++", *flags, example, made / "bsmdec.so", f"-Wl,-rpath,{made}", "-o", "frames"], check=True, cwd=tmp_path
    )
    vector = VECTORS / "good-sequence-long.bsm"
    lines = subprocess.run(
        [tmp_path / "frames", vector, "2"], check=True, capture_output=True, text=True
    ).stdout.splitlines()
    positions, faces = bsm.decode_sequence(vector.read_bytes())
    expected = [
        f"frame {index} of {len(positions)}: {len(faces)} faces, x from {x.min():.6g} to {x.max():.6g}"
        for index, x in enumerate(positions[:, :, 0].astype(np.float32))
    ]
    assert lines == expected[2:]
    refused = subprocess.run(
        [tmp_path / "frames", VECTORS / "bad-sequence-beyond.bsm"], capture_output=True, text=True, check=False
    )
    assert refused.returncode == 1
    assert "frame" in refused.stderr
