"""Encoded meshes by decoders that share no code with the encoder: that of release 1.0, and the reference decoder.

python -m tools.attack judges FILE... [--presets grid14,lossless] [--vertices N]: meshes are encoded with each preset,
with and without their order; streams are taken as they are. The reference decoder sees those of at most N vertices.
"""

from __future__ import annotations

import argparse
import importlib
import sys
from collections import Counter
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from bsm import BsmError, encode, load
from bsm.console import Console
from tests.library.decoding import decode, released
from tools.amalgamate import ROOT
from tools.attack.decoding import is_sequence, whole
from tools.attack.library import unlike
from tools.command import run_command

VERSION = 4  # the byte of the version, and that of release 1.0
OLD = 0x10


@cache
def reference() -> Any:
    """The reference decoder, as a module."""
    sys.path.insert(0, str(ROOT / "spec"))
    return importlib.import_module("reference_decoder")


def difference(stream: bytes, vertices: int = 0) -> str | None:
    """How a judge decodes a stream otherwise than the product; None: all alike."""
    outcome = whole(stream)
    found = decode(released(), stream)
    other = unlike(found, outcome, in_sequence=is_sequence(stream), exact=True)
    if other is not None:
        return f"release 1.0: {other}"
    if isinstance(outcome, BsmError) or is_sequence(stream) or not 0 < len(outcome[0]) <= vertices:
        return None
    try:
        positions, faces, skipped = reference().decode(stream)
    except reference().UnsupportedError:  # an extension
        return None
    if "order" in skipped:  # the same triangles, in another order
        alike = np.array_equal(_triangles(*outcome[:2]), _triangles(positions, faces))
    else:
        alike = np.array_equal(positions, outcome[0]) and np.array_equal(faces, outcome[1])
    return None if alike else "the reference decoder has other positions or faces"


def _triangles(positions: Any, faces: Any) -> Any:
    """The triangles of a mesh, sorted, with their corners sorted."""
    corners = positions[faces]
    for axis in (2, 1, 0):
        order = np.argsort(corners[:, :, axis], axis=1, kind="stable")
        corners = np.take_along_axis(corners, order[:, :, None], axis=1)
    rows = corners.reshape(len(faces), 9)
    return rows[np.lexsort(rows.T[::-1])]


def streams(path: Path, presets: list[str]) -> Iterator[tuple[str, bytes]]:
    """A stream, or those that a mesh is encoded to."""
    if path.suffix == ".bsm":
        yield path.name, path.read_bytes()
        return
    mesh = load(path)
    for preset in presets:
        for keep_order in (False, True):
            yield f"{path.name} {preset}{' in order' * keep_order}", encode(mesh, preset=preset, keep_order=keep_order)


def main() -> None:
    """Judge every file; exit code 1 if any stream is decoded otherwise."""
    parser = argparse.ArgumentParser(prog="python -m tools.attack judges", description=__doc__)
    parser.add_argument("paths", nargs="+", type=Path, metavar="FILE")
    parser.add_argument("--presets", default="grid14,lossless")
    parser.add_argument("--vertices", type=int, default=0)
    run_command(parser, _work)


def _work(args: argparse.Namespace, console: Console) -> None:
    tally = Counter[str]()
    for path in args.paths:
        try:
            for name, stream in streams(path, args.presets.split(",")):
                later = stream[VERSION : VERSION + 1] > bytes([OLD]) and len(stream) > VERSION
                other = None if later else difference(stream, args.vertices)
                tally["of a later version" if later else "alike" if other is None else "different"] += 1
                if other is not None:
                    print(f"{name}: {other}", flush=True)
        except BsmError as error:
            tally["not encoded"] += 1
            print(f"{path.name}: {error}", flush=True)
    print(", ".join(f"{count} {kind}" for kind, count in sorted(tally.items())))
    sys.exit(tally["different"] > 0)
