"""Sequences against Draco frame by frame: `python -m tools.measure sequences`.

Rates are those of whole files, connectivity and first frame included. Draco is asked for every `every`-th frame, which
is exact for codecs that know of one frame only; its files are compared with ours at its own KG error. `--made` adds
sequences that no choice was made on, `--default` measures the encoder without options: bytes, processor seconds, and
1 - SSIM and flicker of all frames.
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

from bsm.codec.arrays import Faces, Positions
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.look.measure import LookMetric
from bsm.codec.sequence.encoder import SequenceEncoder
from bsm.codec.sequence.options import SequenceOptions
from bsm.codec.sequence.targets import SequenceTarget, compare_sequences
from bsm.decoding import decode_sequence
from bsm.evaluation.curve import Point, draco_point
from bsm.files.formats.npz import read_arrays
from bsm.files.output import open_output
from bsm.options import sequence_options
from tools.measure.made_motion import MADE

DRACO_BITS = (8, 10)
KG_GOAL = 0.15
TOGETHER = (1, 8)
"""Frames that are sent at a time with low delay."""


def our_point(positions: Positions, faces: Faces, options: SequenceOptions, kg: float) -> Point:
    """Ours, at most at the KG error `kg`."""
    encoder = SequenceEncoder(faces, replace(options, target=SequenceTarget("kg", kg)), len(positions))
    attempt = encoder.search(list(positions))
    name = f"ours, {options.low_delay} at a time" if options.low_delay else "ours"
    size = sum(map(len, attempt.chunks))
    return {"codec": name, "bytes": size, "bpvf": attempt.bpvf, **asdict(attempt.comparison)}


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


def measure(name: str, frames: Positions, faces: Faces, every: int) -> dict[str, Any]:
    """All points of one sequence."""
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
        result["at_draco"].append(points)
        _say(name, *points.values())
    result["goal"] = our_point(frames, faces, options, KG_GOAL)
    _say(name, result["goal"])
    return result


def _say(name: str, *points: Point) -> None:
    for point in points:
        print(
            f"{name:14} {point['codec']:18} {point['bpvf']:8.4f} bits per vertex and frame, "
            f"KG {point['kg']:.4f} %, theta {point['theta_deg']:.2f}, 1/{points[0]['bpvf'] / point['bpvf']:.1f}",
            flush=True,
        )


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
    parser.add_argument("--every", type=int, default=8, help="measure every N-th frame with Draco (default 8)")
    parser.add_argument("--made", action="store_true", help="also sequences made by formulas")
    parser.add_argument("--default", action="store_true", help="only what is made without any option")
    args = parser.parse_args()
    results: dict[str, Any] = {}
    for name, frames, faces in _sequences(args.folder, args.names, made=args.made):
        if args.default:
            results[name] = default(frames, faces)
            print(name, {key: round(value, 4) for key, value in results[name].items()}, flush=True)
        else:
            results[name] = measure(name, frames, faces, args.every)
    with open_output(args.output, overwrite=True) as file:
        file.write(json.dumps(results, indent=1).encode() + b"\n")
