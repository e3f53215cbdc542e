"""What constants serve: for a file, points of an error and what it costs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

from bsm.codec.denoise import denoise_automatically
from bsm.codec.geometry.metrics import theta
from bsm.codec.sequence.encoder import SequenceEncoder
from bsm.codec.sequence.options import SequenceOptions
from bsm.codec.static.encoder import Encoder, encode
from bsm.codec.static.options import PRESETS, EncodeOptions
from bsm.files.formats.npz import read_arrays
from tools.measure.presets import joined
from tools.noise import gaussian_along_normals

Point = tuple[float, float]
STEPS = (0.0028, 0.004, 0.0057)
SEQUENCE_STEPS = (0.0007, 0.001, 0.0014)
FRAMES = 32
NOISE, SEED = 0.25, 5


def blocks(path: Path) -> list[Point]:
    """Mean angle between normals, and bytes of blocks, at three steps."""
    encoder = Encoder(joined(path), EncodeOptions(limits="wide"))
    attempts = [encoder.attempt(step) for step in STEPS]
    return [(attempt.comparison.theta_deg, float(attempt.size)) for attempt in attempts]


def promise(path: Path) -> list[Point]:
    """Bytes of the preset `fine`, which keeps what it promises."""
    return [(1.0, float(len(encode(joined(path), PRESETS["fine"]))))]


def sequence(path: Path) -> list[Point]:
    """KG error and bytes of the first frames of a sequence, at three steps."""
    positions, faces = read_arrays(path, "positions", "faces")
    frames = [frame.astype(np.float64) for frame in positions[:FRAMES]]
    encoder = SequenceEncoder(faces, replace(SequenceOptions(), gop=len(frames)), len(frames))
    attempts = [encoder.attempt(frames, step) for step in SEQUENCE_STEPS]
    return [(attempt.comparison.kg, float(sum(map(len, attempt.chunks)))) for attempt in attempts]


def denoising(path: Path) -> list[Point]:
    """Mean angle to a mesh without noise that is left of white noise along its normals, of a quarter of an edge."""
    mesh = joined(path)
    noisy = gaussian_along_normals(mesh.positions, mesh.faces, NOISE, SEED)
    result, _ = denoise_automatically(noisy, mesh.faces)
    return [(1.0, theta(mesh.positions, result, mesh.faces))]


FIGURES: dict[str, Callable[[Path], list[Point]]] = {
    "blocks": blocks,
    "promise": promise,
    "sequence": sequence,
    "denoising": denoising,
}
