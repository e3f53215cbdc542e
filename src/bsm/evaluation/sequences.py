"""Rate against error of sequences: measured into one JSON per sequence, and drawn from it.

Rates are those of whole files, connectivity and first frame included.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from bsm.codec.arrays import Faces, Positions
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.sequence.encoder import SequenceEncoder
from bsm.codec.sequence.options import SequenceOptions
from bsm.codec.sequence.targets import compare_sequences
from bsm.evaluation.curve import number, table
from bsm.evaluation.draco import decode_draco, encode_draco, positions_in_order
from bsm.evaluation.plots import draw_rates
from bsm.files.output import open_output

Point = dict[str, Any]

SCHEMA = 1
STEPS = (0.016, 0.008, 0.004, 0.002, 0.001, 0.0005)
DRACO_BITS = (7, 8, 9, 10, 11, 12)
LINES = {"ours": "ours", "ours-low-delay": "ours, low delay", "draco": "Draco, frame by frame"}
MEASURES = {"kg": "KG error, percent", "theta_deg": "θ, degrees"}
FRAMES_OF_DRACO = 16
"""Frames that Draco is asked for, spread over the sequence: it treats all alike."""


def measure_lines(frames: Positions, faces: Faces, name: str, progress: Callable[[int, int], None]) -> dict[str, Any]:
    """All lines of one sequence, `frames` of shape (T, n, 3)."""
    every = max(1, len(frames) // FRAMES_OF_DRACO)
    work: list[tuple[str, Callable[[], Point]]] = [
        (line, partial(our_point, frames, faces, low_delay, step))
        for step in STEPS
        for line, low_delay in (("ours", 0), ("ours-low-delay", 1))
    ]
    work += [("draco", partial(draco_point, frames, faces, bits, every)) for bits in DRACO_BITS]
    lines: dict[str, list[Point]] = {line: [] for line in LINES}
    for done, (line, run) in enumerate(work, 1):
        lines[line].append(run())
        progress(done, len(work))
    sizes = {"frames": len(frames), "vertices": frames.shape[1], "faces": len(faces)}
    return {"schema": SCHEMA, "sequence": {"name": name, **sizes}, "lines": lines}


def our_point(frames: Positions, faces: Faces, low_delay: int, step: float) -> Point:
    """Ours at one step."""
    attempt = SequenceEncoder(faces, SequenceOptions(low_delay=low_delay), len(frames)).attempt(list(frames), step)
    name = f"low delay of {low_delay}, step {step:g}" if low_delay else f"groups, step {step:g}"
    size = sum(map(len, attempt.chunks))
    return {"codec": name, "bytes": size, "bpvf": attempt.bpvf, **asdict(attempt.comparison)}


def draco_point(frames: Positions, faces: Faces, bits: int, every: int) -> Point:
    """Draco, level 10, at `bits` of position quantization, over every `every`-th frame: it knows of one frame only."""
    chosen = frames[::every]
    size, decoded = 0, []
    for frame in chosen:
        mesh = TriangleMesh(frame, faces)
        data = encode_draco(mesh, bits, 10)
        size += len(data)
        decoded.append(positions_in_order(mesh, decode_draco(data), bits))
    return point_of(f"Draco qp {bits}", size, chosen, np.array(decoded), faces)


def point_of(name: str, size: int, original: Positions, decoded: Positions, faces: Faces) -> Point:
    """A point of a line: bytes, and how far `decoded` is off, both of shape (T, n, 3)."""
    comparison = compare_sequences(original, decoded, faces)
    return {"codec": name, "bytes": size, "bpvf": 8 * size / original[..., 0].size, **asdict(comparison)}


def write_lines(result: dict[str, Any], folder: Path) -> Path:
    """Write ``<name>-sequence.json``."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{result['sequence']['name']}-sequence.json"
    with open_output(path, overwrite=True) as file:
        file.write(json.dumps(_finite(result), indent=1, allow_nan=False).encode() + b"\n")
    return path


def draw_lines(path: Path) -> list[Path]:
    """Draw what a file of `write_lines` holds."""
    result = json.loads(path.read_text())
    facts = result["sequence"]
    title = f"{facts['name']}: {facts['frames']} frames of {facts['vertices']} vertices"
    written: list[Path] = []
    for measure, label in MEASURES.items():
        lines = {LINES[line]: [(p["bpvf"], p[measure]) for p in points] for line, points in result["lines"].items()}
        stem = path.parent / f"{facts['name']}-{measure.split('_')[0]}"
        written += draw_rates(lines, "bits per vertex and frame, whole file", label, title, stem)
    return written


def table_of(result: dict[str, Any]) -> str:
    """The points as text."""
    digits = {"bpvf": 4, "kg": 4, "theta_deg": 2, "rms_relative": 6}
    rows = [
        (result["sequence"]["name"], point["codec"], *(number(point[name], places) for name, places in digits.items()))
        for points in result["lines"].values()
        for point in points
    ]
    return table(("sequence", "codec", "bits per vertex and frame, file", "KG, %", "theta", "rms"), rows)


def _finite(value: Any) -> Any:
    """JSON has no infinity; what is lossless has no decibels."""
    if isinstance(value, dict):
        return {name: _finite(item) for name, item in value.items()}
    if isinstance(value, list):
        return [_finite(item) for item in value]
    return None if isinstance(value, float) and not np.isfinite(value) else value
