"""Larger streams, of 8 to 30 kB: several panels and chains, wide sums, long histories, where small ones say little."""

from dataclasses import replace

import numpy as np

from bsm.api import encode_sequence
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.sequence.options import SequenceOptions
from bsm.codec.static.encoder import encode
from bsm.codec.static.options import EncodeOptions
from bsm.codec.static.targets import Contract
from tools.vectors.good import Good
from tools.vectors.meshes import torus


def _rough(rows: int, columns: int) -> TriangleMesh:
    """A torus with relief of all sizes; noise that needs no file."""
    mesh = torus(rows, columns)
    number = np.arange(len(mesh.positions), dtype=np.uint64) * np.uint64(0x9E3779B97F4A7C15)
    noise = (number >> np.uint64(40)).astype(float) / 2.0**24 - 0.5
    wave = np.sin(23 * mesh.positions[:, 0]) * np.cos(19 * mesh.positions[:, 1])
    return TriangleMesh(mesh.positions * (1 + 0.02 * noise + 0.01 * wave)[:, None], mesh.faces)


def _blocks() -> bytes:
    options = EncodeOptions(block_size=500, key_interval=2, keep=0.3, step=1 / 65536, smoothing=2.0, threads=1)
    return encode(_rough(60, 50), options)


def _refined() -> bytes:
    return encode(_rough(64, 48), EncodeOptions(contract=Contract(0.0002, look=0.1), threads=1))


def _grid() -> bytes:
    return encode(_rough(70, 60), EncodeOptions(grid=13, threads=1))


def _frames(**options: object) -> bytes:
    positions = np.array([torus(12, 10, phase=0.11 * t).positions * (1 + 0.002 * t) for t in range(75)])
    chosen = replace(SequenceOptions(step=1 / 8192, gop=12, block_size=60, threads=1), **options)  # type: ignore[arg-type]
    return encode_sequence(positions, torus(12, 10).faces, chosen)


LARGE = {
    "good-large-blocks": Good("blocks of 500 with dictionaries of several panels, chains of two, smoothed", _blocks),
    "good-large-refined": Good("blocks and levels of a rough mesh of 3,072 vertices", _refined),
    "good-large-grid": Good("a grid of 13 bits of a rough mesh of 4,200 vertices: wide weights", _grid),
    "good-sequence-large": Good("75 frames in learnt GOPs, several of which refer to the one before", _frames),
    "good-sequence-large-low-delay": Good("75 frames of low delay, of which 64 are kept", lambda: _frames(low_delay=3)),
}
