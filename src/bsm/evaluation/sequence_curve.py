"""Rate against error of sequences: measured into one JSON per sequence, and drawn from it."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from bsm.codec.arrays import Faces, Positions
from bsm.codec.sequence.encoder import SequenceEncoder
from bsm.codec.sequence.options import SequenceOptions
from bsm.evaluation.plots import draw_sequence_rates
from bsm.evaluation.sequences import draco_point, pca_point
from bsm.evaluation.tables import number, table
from bsm.files.output import open_output

Progress = Callable[[int, int], None]
Point = dict[str, Any]

SCHEMA = 1
STEPS = (0.016, 0.008, 0.004, 0.002, 0.001, 0.0005)
DRACO_BITS = (7, 8, 9, 10, 11, 12)
PCA_ERRORS = (2.0, 1.0, 0.5, 0.25, 0.12)
LINES = {
    "ours": "ours",
    "ours-low-delay": "ours, low delay",
    "draco": "Draco, frame by frame",
    "pca": "principal components (entropy only)",
}
MEASURES = {"kg": "KG error, percent", "theta_deg": "θ, degrees"}
FRAMES_OF_DRACO = 16
"""Frames that Draco is asked for, spread over the sequence: it treats all alike."""


def measure_lines(frames: Positions, faces: Faces, name: str, progress: Progress) -> dict[str, Any]:
    """All lines of one sequence, `frames` of shape (T, n, 3)."""
    every = max(1, len(frames) // FRAMES_OF_DRACO)
    work: list[tuple[str, Callable[[], Point]]] = []
    for step in STEPS:
        for line, low_delay in (("ours", 0), ("ours-low-delay", 1)):
            work.append((line, partial(our_point_at, frames, faces, low_delay, step)))
    work += [("draco", partial(draco_point, frames, faces, bits, every)) for bits in DRACO_BITS]
    work += [("pca", partial(pca_point, frames, faces, kg)) for kg in PCA_ERRORS]
    lines: dict[str, list[Point]] = {line: [] for line in LINES}
    for done, (line, run) in enumerate(work, 1):
        point = run()
        if point["bpvf"] is not None:
            lines[line].append(point)
        progress(done, len(work))
    sizes = {"frames": len(frames), "vertices": frames.shape[1], "faces": len(faces)}
    return {"schema": SCHEMA, "sequence": {"name": name, **sizes}, "lines": lines}


def our_point_at(frames: Positions, faces: Faces, low_delay: int, step: float) -> Point:
    """Ours at one step."""
    attempt = SequenceEncoder(faces, SequenceOptions(low_delay=low_delay), len(frames)).attempt(list(frames), step)
    return {
        "codec": f"low delay of {low_delay}, step {step:g}" if low_delay else f"groups, step {step:g}",
        "bytes": sum(map(len, attempt.chunks)),
        "bpvf": attempt.bpvf,
        **asdict(attempt.comparison),
    }


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
    lines = {LINES[line]: points for line, points in result["lines"].items() if points}
    written: list[Path] = []
    for measure, label in MEASURES.items():
        stem = path.parent / f"{facts['name']}-{measure.split('_')[0]}"
        written += draw_sequence_rates(lines, measure, label, title, stem)
    return written


def table_of(result: dict[str, Any]) -> str:
    """The points as text."""
    return table(
        ("sequence", "codec", "bits per vertex and frame, file", "KG, %", "theta", "rms"),
        [
            (
                result["sequence"]["name"],
                point["codec"],
                number(point["bpvf"], 4),
                number(point["kg"], 4),
                number(point["theta_deg"], 2),
                number(point["rms_relative"], 6),
            )
            for points in result["lines"].values()
            for point in points
        ],
    )


def _finite(value: Any) -> Any:
    """JSON has no infinity; what is lossless has no decibels."""
    if isinstance(value, dict):
        return {name: _finite(item) for name, item in value.items()}
    if isinstance(value, list):
        return [_finite(item) for item in value]
    return None if isinstance(value, float) and not np.isfinite(value) else value
