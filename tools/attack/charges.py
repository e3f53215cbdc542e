"""How true the decoder's estimates of work are here, in seconds counted for a second of CPU.

Every kind of stream is decoded in a process of its own, with limits that let it through: those that users make, and
bombs. Exit code 1 if the estimates of two kinds differ by more than a factor of two.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from bsm.codec.geometry.attributes import Attribute
from bsm.codec.sequence.encoder import encode_sequence
from bsm.codec.sequence.options import SequenceOptions
from bsm.codec.static.encoder import encode
from bsm.codec.static.options import PRESETS, EncodeOptions
from tools.attack.measure import taken_by
from tools.attack.streams import BOMBS
from tools.vectors.meshes import torus

SPREAD = 2.0
TIMES = 3
"""How often each is decoded; the least of the times counts, since others are slowed down by what else runs."""
LEAST_SECONDS = 0.02
"""Of less CPU than that, nothing can be said."""


def _preset(name: str) -> bytes:
    return encode(torus(200, 150), PRESETS[name])


def _in_order() -> bytes:
    return encode(torus(200, 150), replace(PRESETS["near-lossless"], keep_order=True))


def _with_attributes() -> bytes:
    mesh = torus(150, 100)
    values = np.sin(mesh.positions @ np.arange(1.0, 10.0).reshape(3, 3))
    attributes = [Attribute("a", values.astype(np.float32)), Attribute("b", values, "vertex", "normal")]
    return encode(replace(mesh, attributes=tuple(attributes)), PRESETS["near-lossless"])


def _options(**options: object) -> bytes:
    return encode(torus(150, 100), EncodeOptions(limits="wide", **options))  # type: ignore[arg-type]


def _sequence(**options: Any) -> bytes:
    frames = [torus(60, 50, 0.1 * k) for k in range(24)]
    return encode_sequence([frame.positions for frame in frames], frames[0].faces, SequenceOptions(**options))


# fmt: off
COUNTED = (
    "careful", "copies", "gop-300", "gop-components", "gop-keys", "gop-next", "gop-part", "gop-still", "grid",
    "grid-chunks", "hubs-small", "layers", "layers-chunks", "light", "light-chunks", "light-hubs", "members-all",
    "mesh", "mesh-blocks", "moving", "moving-frames", "moving-keys", "moving-most", "moving-still", "narrow-small",
    "pieces", "rings", "rings-torus", "scattered", "sequence", "sequence-again", "sequence-small", "svd-keys",
    "tiny", "values", "wide-1024",
)
# fmt: on
"""Bombs that are decoded to some end."""

KINDS: dict[str, Callable[[], bytes]] = {
    **{name: lambda name=name: _preset(name) for name in PRESETS if name != "none"},  # type: ignore[misc]
    "paper": lambda: _options(bits=12, key_interval=0),
    "paper-wide": lambda: _options(bits=12, keep=0.4, block_size=500, key_interval=0),
    "paper-exact": lambda: _options(bits=12, keep=0.2, block_size=500, key_interval=1, key_seed="svd"),
    "large-blocks": lambda: _options(step=0.002, block_size=5000),
    "small-blocks": lambda: _options(step=0.002, block_size=30),
    "quick": lambda: encode(torus(400, 300), EncodeOptions(grid=14, quick=True)),
    "order": _in_order,
    "attributes": _with_attributes,
    "animation": lambda: _sequence(gop=12),
    "low-delay": lambda: _sequence(low_delay=1),
    **{name: BOMBS[name] for name in COUNTED if name in BOMBS},
}


def main() -> int:
    """Run the command."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("kinds", metavar="KIND", nargs="*", help=f"{', '.join(KINDS)}; all, if none is named")
    names = parser.parse_args().kinds or list(KINDS)
    if unknown := set(names) - set(KINDS):
        parser.error(f"no such kind: {', '.join(sorted(unknown))}")
    found = {}
    os.environ["OPENBLAS_NUM_THREADS"] = "1"  # its threads wait for each other by spinning
    with tempfile.TemporaryDirectory() as folder:
        for name in names:
            path = Path(folder) / f"{name}.bsm"
            path.write_bytes(KINDS[name]())
            taken = min((taken_by(path, "events", "wide") for _ in range(TIMES)), key=lambda taken: taken.seconds)
            rate = taken.work / (1e9 * taken.seconds)
            if taken.seconds > LEAST_SECONDS:
                found[name] = rate
            print(f"{name:16} {taken.work / 1e9:8.3f} s counted {taken.seconds:8.3f} s of CPU {rate:6.2f}", flush=True)
    spread = max(found.values()) / min(found.values())
    print(f"from {min(found.values()):.2f} to {max(found.values()):.2f}: a factor of {spread:.1f}")
    return 0 if spread <= SPREAD else 1


if __name__ == "__main__":
    sys.exit(main())
