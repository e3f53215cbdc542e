"""What attributes that move take: `python -m tools.measure fields SEQUENCES [NAME ...]`.

Of each npz two are baked of its frames: the colors that two lamps give it, and how far its edges are stretched against
the first frame. Each has its usual quality, a root mean square error of every frame, which is checked on the decoded
file; what it takes is the file with it less the file without. Beside it stand the same values in even steps of the same
root mean square error: as differences from frame to frame in zstd (level 19), and in Draco (level 10), every tenth
frame with them less without.
"""

import argparse
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import zstandard

from bsm.api import decode_frames
from bsm.codec.arrays import Faces, Positions
from bsm.codec.geometry.attributes import Attribute, Semantic
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.sequence.encoder import SequenceEncoder
from bsm.codec.sequence.options import SequenceOptions
from bsm.codec.static.attributes.quality import MOVING

LAMPS = (((0.5, 0.7, 0.5), (255.0, 230.0, 190.0)), ((-0.8, 0.1, -0.6), (60.0, 90.0, 140.0)))
"""Where light comes from, and its color."""
EVERY = 10
STEP = 0.002

Array = npt.NDArray[Any]


def lit(frames: Positions, faces: Faces) -> Array:
    """Colors of vertices, shape (T, n, 3), uint8."""
    found = np.empty(frames.shape, np.uint8)
    for number, frame in enumerate(frames):
        a, b, c = (frame[corner] for corner in faces.T)
        crosses = np.repeat(np.cross(b - a, c - a), 3, axis=0)
        sums = np.column_stack([np.bincount(faces.ravel(), own, len(frame)) for own in crosses.T])
        lengths = np.linalg.norm(sums, axis=1, keepdims=True)
        normals = np.divide(sums, lengths, out=sums, where=lengths > 0.0)
        light = np.full(frame.shape, 12.0)
        for direction, color in LAMPS:
            towards = np.array(direction) / np.linalg.norm(direction)
            light += np.maximum(normals @ towards, 0.0)[:, None] * color
        found[number] = np.clip(light, 0.0, 255.0)
    return found


def stretched(frames: Positions, faces: Faces) -> Array:
    """How much longer the edges around a vertex are than in the first frame, octaves, shape (T, n, 1), float32."""
    edges = np.unique(
        np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1),
        axis=0,
    )
    sums = np.empty((*frames.shape[:2], 1))
    for number, frame in enumerate(frames):
        lengths = np.linalg.norm(frame[edges[:, 0]] - frame[edges[:, 1]], axis=1)
        both = np.concatenate([lengths, lengths])
        sums[number, :, 0] = np.bincount(edges.T.reshape(-1), both, frames.shape[1])
    return np.log2((sums + 1e-12) / (sums[:1] + 1e-12)).astype(np.float32)


def ours(frames: Positions, faces: Faces, name: str, values: Array, bound: float) -> int:
    """Bytes that a field takes, once it is found to be within its bound on average."""
    semantic: Semantic = "color" if name == "color" else "generic"
    sizes = []
    for with_values in (True, False):
        meshes = [
            TriangleMesh(
                frame, faces, (Attribute(name, own, semantic=semantic),) if with_values else ()
            )
            for frame, own in zip(frames, values, strict=True)
        ]
        options = SequenceOptions(step=STEP, gop=len(frames))
        encoder = SequenceEncoder(faces, options, len(frames))
        data = b"".join(encoder.chunks(meshes))
        sizes.append(len(data))
        for given, decoded in zip(
            values, decode_frames(data) if with_values else (), strict=with_values
        ):
            off = decoded.attributes[0].values.astype(float) - given[encoder.vertex_order]
            assert np.square(off).mean() <= bound**2 * (1 + 1e-9), (name, bound)
    return sizes[0] - sizes[1]


def zstd_bytes(levels: Array) -> int:
    """Bytes of levels, shape (T, n, c), as differences from frame to frame."""
    differences = np.diff(levels, axis=0, prepend=0).astype(np.int8)
    return len(
        zstandard.ZstdCompressor(level=19).compress(differences.transpose(0, 2, 1).tobytes())
    )


def draco_bytes(frames: Positions, faces: Faces, levels: Array) -> int:
    """Bytes of levels, shape (T, n, c), by every tenth frame."""
    import DracoPy

    sizes = []
    for frame, own in zip(frames[::EVERY], levels[::EVERY], strict=True):
        colors = np.ascontiguousarray(
            np.repeat(own, 3, axis=1) if own.shape[1] == 1 else own, np.uint8
        )
        options = {"quantization_bits": 10, "compression_level": 10}
        bare, full = (
            DracoPy.encode(frame, faces, **options),
            DracoPy.encode(frame, faces, colors=colors, **options),
        )
        sizes.append((len(full) - len(bare)) / (3 if own.shape[1] == 1 else 1))
    return round(float(np.mean(sizes)) * len(frames))


def measure(name: str, frames: Positions, faces: Faces) -> list[str]:
    """A row of a table for each field."""
    faces = TriangleMesh(frames[0], faces).faces
    rows = []
    for what, values, share in (
        ("color", lit(frames, faces), MOVING["color"]),
        ("stretch", stretched(frames, faces), MOVING["generic"]),
    ):
        bound = share / 100.0 * float(np.ptp(values.astype(float), axis=(0, 1)).max())
        step = np.sqrt(12.0) * bound
        levels = np.rint((values.astype(float) - values.min()) / step).astype(np.int16)
        found = (
            ours(frames, faces, what, values, bound),
            zstd_bytes(levels),
            draco_bytes(frames, faces, levels),
        )
        per = ", ".join(f"{8.0 * size / values[..., 0].size:.3f}" for size in found)
        rows.append(
            f"| {name}, {what} within {bound:.3g} | {found[0]:,} | {found[1]:,} | {found[2]:,} | "
            f"1/{found[1] / found[0]:.1f}, 1/{found[2] / found[0]:.1f} | {per} |"
        )
        print(rows[-1], flush=True)
    return rows


def main() -> None:
    """Measure some npz of a folder, or all."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("folder", type=Path)
    parser.add_argument("names", nargs="*")
    args = parser.parse_args()
    print(
        "| field | ours | zstd | Draco | of theirs | bits per vertex and frame |\n|---|---|---|---|---|---|"
    )
    for path in sorted(args.folder.glob("*.npz")):
        if not args.names or path.stem in args.names:
            arrays = np.load(path)
            measure(path.stem, arrays["positions"].astype(np.float64), arrays["faces"])
