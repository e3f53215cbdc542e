"""What encoding takes, in bytes and in time.

    python -m tools.measure encoding MESH... [--with NAME=VALUE ...] [--json FILE] [--over FILE]

`encoding`: bytes, CPU time of one thread over Draco's (level 10, 11 bits; frame by frame for npz sequences), measured
by turns, the share of it that decoding and comparing take, and the ratio of bytes to another run. To compare with
another checkout, run this file there, keep its JSON:

    PYTHONPATH=../old ../old/.venv/bin/python tools/measure/encoding.py MESH... --json old.json
"""

from __future__ import annotations

import argparse
import json
import math
import time
from collections.abc import Callable
from pathlib import Path
from statistics import fmean
from typing import Any
from unittest.mock import patch

import numpy as np

import bsm
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.sequence.verification import SequenceVerifier
from bsm.codec.static.verification import verify
from bsm.evaluation.curve import encode_draco
from bsm.files.mesh import read_mesh

BITS, LEVEL = 11, 10


def keyword(text: str) -> tuple[str, Any]:
    """NAME=VALUE as a keyword of `bsm.encode`."""
    name, _, value = text.partition("=")
    try:
        return name, json.loads(value)
    except ValueError:
        return name, value


def seconds(work: Callable[[], Any]) -> float:
    """CPU time of this thread."""
    begin = time.thread_time()
    work()
    return time.thread_time() - begin


def share_of_checks(encode: Callable[[], Any]) -> float:
    """The share of an encoding's CPU time that decoding and comparing what was written take."""
    checking = 0.0

    def timed(check: Callable[..., Any]) -> Callable[..., Any]:
        def call(*arguments: Any, **named: Any) -> Any:
            nonlocal checking
            begin = time.thread_time()
            try:
                return check(*arguments, **named)
            finally:
                checking += time.thread_time() - begin

        return call

    take = timed(SequenceVerifier.take)
    with patch("bsm.codec.static.encoder.verify", timed(verify)), patch.object(SequenceVerifier, "take", take):
        whole = seconds(encode)
    return checking / whole


def by_turns(ours: Callable[[], Any], theirs: Callable[[], Any], repeat: int) -> tuple[float, float]:
    """The least times of two works."""
    turns = [(seconds(ours), seconds(theirs)) for _ in range(repeat)]
    return min(work for work, _ in turns), min(other for _, other in turns)


def measured(path: Path, options: dict[str, Any], repeat: int) -> tuple[int, float, float, float]:
    """Our bytes and CPU time, Draco's time, and the share of checks in ours, of a mesh or a sequence."""
    data: list[bytes] = []
    if path.suffix == ".npz":
        arrays = np.load(path)
        frames, faces = arrays["positions"].astype(np.float64), arrays["faces"]
        meshes = [TriangleMesh(frame, faces) for frame in frames[:: max(1, len(frames) // 16)]]
        ours = lambda: data.append(bsm.encode_sequence(frames, faces, threads=1, **options))  # noqa: E731
        times = by_turns(ours, lambda: [encode_draco(mesh, BITS, LEVEL) for mesh in meshes], repeat)
        return len(data[-1]), times[0], times[1] * len(frames) / len(meshes), share_of_checks(ours)
    mesh = read_mesh(str(path)).mesh
    ours = lambda: data.append(bsm.encode(mesh, threads=1, **options))  # noqa: E731
    try:
        times = by_turns(ours, lambda: encode_draco(mesh.bare, BITS, LEVEL), repeat)
    except bsm.MeshError:  # Draco does not take it
        times = seconds(ours), math.nan
    return len(data[-1]), *times, share_of_checks(ours)


def encoding(args: argparse.Namespace) -> None:
    """Print a row for each file, and means."""
    before = json.loads(args.over.read_text()) if args.over else {}
    found: dict[str, tuple[int, float, float, float]] = {}
    for path in args.meshes:
        try:
            found[path.stem] = size, ours, theirs, checks = measured(path, dict(args.options), args.repeat)
        except bsm.BsmError as error:
            print(f"{path.stem[:28]:28} {type(error).__name__}: {error}", flush=True)
            continue
        text = f"{path.stem[:28]:28} {size:8d} bytes {1e3 * ours:8.0f} ms, over Draco {ours / theirs:6.1f}"
        text += f", checks {checks:.1%}"
        if path.stem in before:
            old = before[path.stem]
            text += f"; over before: bytes {size / old[0]:.3f}, time over Draco's {ours / theirs / old[1] * old[2]:.2f}"
        print(text, flush=True)
    shared = [(found[name], before[name]) for name in found if name in before]
    if shared:
        bytes_mean = fmean(new[0] / old[0] for new, old in shared)
        times = math.exp(fmean(math.log(new[1] / old[1]) for new, old in shared))
        print(f"over before, {len(shared)} files: bytes mean {bytes_mean:.4f}, time geometric mean {times:.3f}")
    if args.json:
        args.json.write_text(json.dumps(found))


def main() -> None:
    """Print the table of `encoding`."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("meshes", metavar="MESH", nargs="+", type=Path)
    parser.add_argument("--with", dest="options", nargs="*", type=keyword, default=[], metavar="NAME=VALUE")
    parser.add_argument("--repeat", type=int, default=3, metavar="N", help="turns, of which the fastest count (3)")
    parser.add_argument("--json", type=Path, help="write the figures here")
    parser.add_argument("--over", type=Path, help="figures of another run, to compare with")
    encoding(parser.parse_args())


if __name__ == "__main__":
    main()
