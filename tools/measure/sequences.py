"""Sequences against Draco frame by frame and against principal components: `python -m tools.measure sequences`.

Rates are those of whole files, connectivity and first frame included. Draco is asked for every `every`-th frame, which
is exact for codecs that know of one frame only; its files are compared with ours at its own KG error. `--made` adds
sequences that no choice was made on, `--brief` leaves all but ours and Draco's out, `--default` says what comes of no
option at all: bytes, processor seconds, and 1 - SSIM and flicker of all frames.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Iterator
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np

from bsm.bitstream.connectivity.faces import encode_connectivity
from bsm.bitstream.container.reader import END_OF_STREAM
from bsm.codec.arrays import Faces, Positions
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.look.measure import LookMetric
from bsm.codec.sequence.decoder import SequenceDecoder, decode_sequence
from bsm.codec.sequence.encoder import SequenceEncoder
from bsm.codec.sequence.options import SequenceOptions
from bsm.codec.sequence.targets import SequenceTarget, compare_sequences
from bsm.evaluation.curve import Point, draco_point, point_of
from bsm.files.formats.npz import read_arrays
from bsm.files.output import open_output
from bsm.options import sequence_options
from tools.measure.made_motion import MADE

DRACO_BITS = (8, 10)
PCA_BITS = (6, 8, 10, 12, 14)
KG_GOAL = 0.15
TOGETHER = (1, 4, 8)
"""Frames that are sent at a time with low delay."""


def our_point(positions: Positions, faces: Faces, options: SequenceOptions, kg: float) -> Point:
    """Ours, at most at the KG error `kg`."""
    encoder = SequenceEncoder(faces, replace(options, target=SequenceTarget("kg", kg)), len(positions))
    attempt = encoder.search(list(positions))
    name = f"ours, {options.low_delay} at a time" if options.low_delay else "ours"
    size = sum(map(len, attempt.chunks))
    return {"codec": name, "bytes": size, "bpvf": attempt.bpvf, **asdict(attempt.comparison)}


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


def speed(positions: Positions, faces: Faces, options: SequenceOptions) -> dict[str, float]:
    """Seconds for what is done once, and frames per second for the rest, on one thread (BLAS is up to the caller)."""
    options = replace(options, threads=1)
    list(SequenceEncoder(faces, options, 2).chunks(positions[:2]))  # compiles
    once, _ = _timed(lambda: list(SequenceEncoder(faces, options, 1).chunks(positions[:1])))
    whole, chunks = _timed(lambda: list(SequenceEncoder(faces, options, len(positions)).chunks(positions)))
    data = b"".join(chunks)
    opening, _ = _timed(lambda: _decode(data, start=len(positions)))
    decoding, _ = _timed(lambda: _decode(data, start=0))
    count = len(positions)
    return {
        "encode_once_s": once,
        "encode_fps": (count - 1) / (whole - once),
        "decode_once_s": opening,
        "decode_fps": count / (decoding - opening),
    }


def default(positions: Positions, faces: Faces) -> dict[str, float]:
    """What is made of frames without any option, and how all of them look."""
    encoder = SequenceEncoder(faces, sequence_options(threads=1), len(positions))
    begin = time.process_time()
    data = b"".join(encoder.chunks(positions))
    seconds = time.process_time() - begin
    decoded, faces = decode_sequence(data, threads=1)
    original = positions[:, encoder.vertex_order]
    pairs = zip(original, decoded, strict=True)
    unlike = [LookMetric(TriangleMesh(own, faces), threads=1).look(other).dissimilarity for own, other in pairs]
    found = compare_sequences(original, decoded, faces)
    return {
        "bytes": len(data),
        "encode_cpu_s": seconds,
        "dissimilarity_worst": max(unlike),
        "dissimilarity_mean": float(np.mean(unlike)),
        "kg": found.kg,
        "flicker": found.flicker,
        "max_error_relative": found.max_error_relative,
    }


def measure(name: str, frames: Positions, faces: Faces, every: int, *, brief: bool) -> dict[str, Any]:
    """All points of one sequence, or without principal components and speed."""
    faces = TriangleMesh(frames[0], faces).faces
    options = SequenceOptions(gop=max(len(frames), 1))
    result: dict[str, Any] = {"frames": len(frames), "vertices": frames.shape[1], "at_draco": []}
    for bits in DRACO_BITS:
        draco = draco_point(frames, faces, bits, every)
        ours = our_point(frames, faces, options, draco["kg"])
        points = {"draco": draco, "ours": ours}
        for together in TOGETHER:
            as_they_come = replace(options, low_delay=together, gop=max(len(frames), together))
            points[f"low_delay_{together}"] = our_point(frames, faces, as_they_come, draco["kg"])
        if not brief:
            points["pca"] = pca_point(frames, faces, draco["kg"])
        result["at_draco"].append(points)
        _say(name, *points.values())
    if brief:
        return result
    result["goal"] = our_point(frames, faces, options, KG_GOAL)
    result["speed"] = speed(frames, faces, options)
    _say(name, result["goal"])
    print(f"{name}: {result['speed']}", flush=True)
    return result


def _say(name: str, *points: Point) -> None:
    for point in points:
        if point["bpvf"] is not None:
            print(
                f"{name:14} {point['codec']:18} {point['bpvf']:8.4f} bits per vertex and frame, "
                f"KG {point['kg']:.4f} %, theta {point['theta_deg']:.2f}, 1/{points[0]['bpvf'] / point['bpvf']:.1f}",
                flush=True,
            )


def _decode(data: bytes, start: int) -> None:
    decoder = SequenceDecoder(threads=1, start=start)
    decoder.receive_data(data)
    decoder.receive_eof()
    while decoder.next_event() is not END_OF_STREAM:
        pass


def _timed(work: Any) -> tuple[float, Any]:
    begin = time.perf_counter()
    result = work()
    return time.perf_counter() - begin, result


def _sequences(folder: Path, names: list[str], *, made: bool) -> Iterator[tuple[str, Positions, Faces]]:
    for path in sorted(folder.glob("*.npz")):
        if not names or path.stem in names:
            positions, faces = read_arrays(path, "positions", "faces")
            yield path.stem, positions.astype(np.float64), faces
    for name, make in MADE.items() if made else ():
        yield name, *make()


def main() -> None:
    """Measure every npz of a folder and write one JSON file."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path, help="of npz sequences")
    parser.add_argument("names", nargs="*", help="of files without suffix (default: all)")
    parser.add_argument("-o", "--output", metavar="FILE.json", required=True)
    parser.add_argument("--every", type=int, default=8, help="frames of Draco: one in so many (default 8)")
    parser.add_argument("--made", action="store_true", help="also sequences made by formulas")
    parser.add_argument("--brief", action="store_true", help="only Draco and ours, at its KG errors")
    parser.add_argument("--default", action="store_true", help="only what is made without any option")
    args = parser.parse_args()
    results: dict[str, Any] = {}
    for name, frames, faces in _sequences(args.folder, args.names, made=args.made):
        if args.default:
            results[name] = default(frames, faces)
            print(name, {key: round(value, 4) for key, value in results[name].items()}, flush=True)
        else:
            results[name] = measure(name, frames, faces, args.every, brief=args.brief)
    with open_output(args.output, overwrite=True) as file:
        file.write(json.dumps(results, indent=1).encode() + b"\n")
