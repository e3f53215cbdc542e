"""Moving meshes: ours beside Draco frame by frame and zstd of half floats, by KG error and STED.

No package that is fetched carries a long animation of one mesh under a free licence, so the sequences are made: cloth
and violent motion by simulation, and fetched meshes that bend and twist. Real ones join from BSM_MESHES/dynamic.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import bsm
from bsm.codec.arrays import Faces, Positions
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.sequence.encoder import SequenceEncoder
from bsm.codec.sequence.targets import compare_sequences
from bsm.encoding.options import sequence_options
from bsm.evaluation.curve import decode_draco, encode_draco, positions_in_order, rate_curve
from tools.replicate.ablation import ablate_motion
from tools.replicate.fetch import Source
from tools.replicate.made_motion import MADE
from tools.replicate.measures import sted
from tools.replicate.rates import Row

FRAMES = 32
BENT = ("cow", "mushroom", "pig")
DRACO_BITS = (8, 9, 10, 11, 12, 13)
OURS: dict[str, dict[str, Any]] = {
    "default": {},
    "fine": {"preset": "fine"},
    "low delay, 8 frames": {"low_delay": 8},
}
ERRORS = {"kg": "KG error", "sted": "STED"}


def bent(mesh: TriangleMesh, frames: int = FRAMES) -> Positions:
    """A mesh that bends to and fro and twists along its longest axis, shape (T, n, 3)."""
    axis = int(np.argmax(np.ptp(mesh.positions, axis=0)))
    placed = np.roll(mesh.positions - mesh.positions.mean(axis=0), -axis, axis=1)
    along = placed[:, 0] / np.abs(placed[:, 0]).max()
    found = []
    for time in 2.0 * np.pi * np.arange(frames) / frames:
        twist, bend = 0.6 * math.sin(time) * along, 0.5 * math.sin(2.0 * time + 1.0) * along**2
        x, y, z = placed.T
        y, z = y * np.cos(twist) - z * np.sin(twist), y * np.sin(twist) + z * np.cos(twist)
        x, y = x * np.cos(bend) - y * np.sin(bend), x * np.sin(bend) + y * np.cos(bend)
        found.append(np.column_stack([x, y, z]))
    return np.array(found)


@dataclass(frozen=True)
class Moving:
    """A sequence, by what makes it: a fetched mesh that bends, a formula's name, or a file."""

    name: str
    origin: Source | str | Path

    def frames(self, most: int = FRAMES) -> tuple[Positions, Faces]:
        """Frames of shape (T, n, 3), and faces."""
        if isinstance(self.origin, Source):
            mesh = self.origin.mesh()
            return bent(mesh, min(most, FRAMES)), mesh.faces
        if isinstance(self.origin, Path):
            arrays = np.load(self.origin)
            positions, faces = arrays["positions"], arrays["faces"]
        else:
            positions, faces = MADE[self.origin]()
        return positions[:most].astype(np.float64), TriangleMesh(positions[0], faces).faces


def sequences(sources: Sequence[Source], own: Path | None, quick: bool) -> list[Moving]:
    """What is measured; for `quick` a small one."""
    found = [Moving(f"{s.name}, bent", s) for s in sources if s.name in BENT]
    if quick:
        return found[:1]
    files = sorted(own.glob("dynamic/*.npz")) if own else []
    return [
        *found,
        *(Moving(name, name) for name in MADE),
        *(Moving(path.stem, path) for path in files),
    ]


def measure_motion(moving: Moving) -> Row:
    """Points of all codecs on one sequence, and what tools for motion are worth there."""
    frames, faces = moving.frames()
    points = {}
    for label, words in OURS.items():
        encoder = SequenceEncoder(faces, sequence_options(threads=1, **words), len(frames))
        data = b"".join(encoder.chunks(frames))
        decoded, coded = bsm.decode_sequence(data, threads=1)
        points[label] = {
            "bytes": len(data),
            **errors(frames[:, encoder.vertex_order], decoded, coded),
        }
    for bits in DRACO_BITS:
        meshes = [TriangleMesh(frame, faces) for frame in frames]
        files = [encode_draco(mesh, bits, 10) for mesh in meshes]
        decoded = np.array(
            [
                positions_in_order(mesh, decode_draco(file), bits)
                for mesh, file in zip(meshes, files, strict=True)
            ]
        )
        points[f"Draco {bits}"] = {"bytes": sum(map(len, files)), **errors(frames, decoded, faces)}
    size, decoded = half_floats(frames, faces)
    points["zstd of float16"] = {"bytes": size, **errors(frames, decoded, faces)}
    facts = {"sequence": moving.name, "frames": len(frames), "vertices": frames.shape[1]}
    return {**facts, "points": points, "tools": ablate_motion(frames, faces)}


def errors(original: Positions, decoded: Positions, faces: Faces) -> dict[str, float]:
    return {
        "kg": compare_sequences(original, decoded, faces).kg,
        "sted": sted(original, decoded, faces),
    }


def half_floats(frames: Positions, faces: Faces) -> tuple[int, Positions]:
    """Bytes by zstd, level 19, of half floats with their bytes apart, frame after frame, and what they decode to."""
    import zstandard

    middle, extent = frames.mean(axis=(0, 1)), np.ptp(frames, axis=(0, 1)).max()
    halves = ((frames - middle) / extent).astype(np.float16)
    steps = np.diff(
        halves.view(np.uint16), axis=0, prepend=np.zeros((1, *halves.shape[1:]), np.uint16)
    )
    apart = steps.transpose(2, 0, 1).copy().view(np.uint8).reshape(-1, 2).T.tobytes()
    packed = zstandard.ZstdCompressor(level=19).compress(apart + faces.astype(np.int32).T.tobytes())
    return len(packed), halves.astype(np.float64) * extent + middle


COLUMNS = (
    "sequence",
    "codec",
    "bytes",
    "bits per vertex and frame",
    "KG, %",
    "STED",
    "at Draco's KG",
    "at its STED",
)


def motion_table(rows: Sequence[Row]) -> list[tuple[str, ...]]:
    """A line a codec and sequence; the last columns are bytes over Draco's at equal error, a dash outside its range."""
    found = []
    for row in rows:
        for name, point in row["points"].items():
            if name.startswith("Draco") and not name.endswith(("8", "10", "12")):
                continue
            ratios = []
            for error in ERRORS:
                draco = [row["points"][f"Draco {bits}"] for bits in DRACO_BITS]
                line = rate_curve(
                    [p["bytes"] for p in draco], [10 * math.log10(p[error]) for p in draco]
                )
                rival = line.rate(10 * math.log10(max(point[error], 1e-12)))
                ratios.append("-" if rival is None else f"{point['bytes'] / rival:.3f}")
            rate = 8 * point["bytes"] / row["frames"] / row["vertices"]
            cells = (
                f"{point['bytes']:,}",
                f"{rate:.3f}",
                f"{point['kg']:.4f}",
                f"{point['sted']:.5f}",
            )
            found.append((row["sequence"], name, *cells, *ratios))
    return found
