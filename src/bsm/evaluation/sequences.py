"""What Draco, frame by frame, and principal components make of sequences.

Rates are those of whole files, connectivity and first frame included. Draco is asked for every `every`-th frame, which
is exact for codecs that know of one frame only; its files are compared with ours at its own KG error.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict
from typing import Any

import numpy as np

from bsm.bitstream.connectivity.faces import encode_connectivity
from bsm.bitstream.container.gop import MAX_EXPONENT
from bsm.codec.arrays import Faces, Matrix, Positions
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.sequence.row_prediction import spectrum_of, time_cosines, trajectories
from bsm.codec.sequence.targets import compare_sequences
from bsm.codec.sequence.temporal import learn_basis
from bsm.evaluation.draco import decode_draco, encode_draco, positions_in_order

Point = dict[str, Any]

PCA_BITS = (6, 8, 10, 12, 14)


def draco_point(positions: Positions, faces: Faces, bits: int, every: int) -> Point:
    """Draco, level 10, at `bits` of position quantization, over every `every`-th frame."""
    chosen = positions[::every]
    size, decoded = 0, []
    for frame in chosen:
        mesh = TriangleMesh(frame, faces)
        data = encode_draco(mesh, bits, 10)
        size += len(data)
        decoded.append(positions_in_order(mesh, decode_draco(data), bits))
    return point_of(f"Draco qp {bits}", size, chosen, np.array(decoded), faces)


def pca_point(positions: Positions, faces: Faces, kg: float) -> Point:
    """Principal components of the frames as vectors of length 3n, the fewest that reach `kg`, best of `PCA_BITS`."""
    frames, vertices, _ = positions.shape
    matrix = positions.reshape(frames, -1)
    mean = matrix.mean(axis=0)
    u, s, vt = np.linalg.svd(matrix - mean, full_matrices=False)
    connectivity = len(encode_connectivity(faces, vertices).payload)
    extent = float(np.linalg.norm(positions - positions.mean(axis=1, keepdims=True)))
    points = []
    for bits in PCA_BITS:
        step = float(np.ptp(mean)) / 2**bits
        for count in _counts(frames):
            # Each component is quantized as finely as it weighs on average over the frames.
            weight = s[:count] / np.sqrt(frames)
            levels = np.round(vt[:count] * weight[:, None] / step)
            base = np.round(mean / step)
            decoded = (u[:, :count] * np.sqrt(frames)) @ (levels * step) + base * step
            error = 100 * float(np.linalg.norm(decoded - matrix)) / extent
            if error <= kg:
                size = connectivity + 4 * u[:, :count].size + (_entropy(levels) + _entropy(base)) / 8
                points.append(point_of(f"PCA {count}", int(size), positions, decoded.reshape(positions.shape), faces))
                break
    return min(points, key=lambda point: float(point["bpvf"]), default={"codec": "PCA", "bpvf": None})


def temporal_bits(positions: Positions, step: float) -> dict[str, float]:
    """About the bits a vertex and frame that components take over a learnt basis, itself included, and over cosines."""
    motion = trajectories((positions - positions[0].mean(axis=0)) / np.linalg.norm(np.ptp(positions[0], axis=0)))
    learnt = learn_basis(motion, step, MAX_EXPONENT)
    spectrum = spectrum_of(learnt.columns, learnt.exponents, 3)
    cosines = time_cosines(len(positions))
    components: dict[str, tuple[Matrix, ...]] = {
        "learnt": (motion @ learnt.columns / step, spectrum),
        "cosines": (motion.reshape(len(motion), 3, -1) @ cosines / step,),
    }
    return {
        name: sum(float(np.log2(1.0 + np.abs(part)).sum()) for part in parts) / positions[..., 0].size
        for name, parts in components.items()
    }


def point_of(name: str, size: int, original: Positions, decoded: Positions, faces: Faces) -> Point:
    comparison = compare_sequences(original, decoded, faces)
    return {"codec": name, "bytes": size, "bpvf": 8 * size / original[..., 0].size, **asdict(comparison)}


def _counts(frames: int) -> Iterator[int]:
    """1, 2, 3, ... in steps of a tenth."""
    count = 1
    while count <= frames:
        yield count
        count += max(1, count // 10)


def _entropy(levels: Positions) -> float:
    """Bits of all levels at their zero-order entropy, row by row."""
    total = 0.0
    for row in np.atleast_2d(levels):
        _, counts = np.unique(row, return_counts=True)
        total -= float((counts * np.log2(counts / counts.sum())).sum())
    return total
