"""Sequences that every decoder must decode."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from bsm.codec.geometry.attributes import Attribute
from bsm.codec.sequence.encoder import SequenceEncoder
from bsm.codec.sequence.options import SequenceOptions
from tools.vectors.good import Good
from tools.vectors.meshes import torus

BASE = SequenceOptions(step=1 / 256, gop=6, block_size=36, threads=1)


def _runs(probes: str, *pieces: tuple[int, int], **options: object) -> Good:
    """Return a sequence in runs; each is (n, frames): a torus of 4 n vertices, and its number of frames."""

    def make() -> bytes:
        kinds = [kind for kind, count in pieces for _ in range(count)]
        meshes = [torus(kind, 4, phase=0.2 * t) for t, kind in enumerate(kinds)]
        frames = [replace(mesh, positions=mesh.positions * (1 + 0.02 * t)) for t, mesh in enumerate(meshes)]
        chosen = SequenceOptions(**{**vars(BASE), "runs": True, **options})
        return b"".join(SequenceEncoder(meshes[0].faces, chosen, len(frames)).chunks(frames))

    return Good(probes, make)


def _moving(probes: str, *kinds: int, heats: Sequence[int] = (0, 1, 2, 3), **options: object) -> Good:
    """Return frames of tori of 4 n vertices, with a color, a velocity, and an attribute that pauses."""

    def make() -> bytes:
        frames = []
        for t, kind in enumerate(kinds):
            mesh = torus(kind, 4, phase=0.2 * t)
            x, y, z = mesh.positions.T
            attributes = (
                Attribute("color", (128 + 120 * np.sin(mesh.positions + 0.3 * t)).astype(np.uint8), "vertex", "color"),
                Attribute("part", np.arange(len(mesh.positions)) // 10),
                Attribute("velocity", np.stack([np.cos(0.2 * t) * x, y * z], axis=1).astype(np.float32)),
                Attribute("heat", np.round(300.0 + x * (heats[t] if t < len(heats) else 0), 3)),
            )
            frames.append(replace(mesh, positions=mesh.positions * (1 + 0.02 * t), attributes=attributes))
        chosen = SequenceOptions(**{**vars(BASE), "runs": True, **options})
        return b"".join(SequenceEncoder(frames[0].faces, chosen, len(frames)).chunks(frames))

    return Good(probes, make)


def _far() -> bytes:
    """Return values that come from so far that rounding those of the first frame shows in the others."""
    frames = []
    for t in range(3):
        mesh = torus(6, 4, phase=0.2 * t)
        depth = (np.round(3 * mesh.positions[:, 0], 3) + (1.2345678e7 if t == 0 else 0)).astype(np.float32)
        frames.append(replace(mesh, attributes=(Attribute("depth", depth[:, None]),)))
    return b"".join(SequenceEncoder(frames[0].faces, BASE, len(frames)).chunks(frames))


_PAUSING = (0, 3, 1, 4, 0, 0, 0, 0, 2, 5, 1, 3)
SEQUENCES: dict[str, Good] = {
    "good-sequence-runs-again": _runs(
        "a mesh that comes again counts as of that run", *((kind, 1) for kind in (*range(3, 11), 3, 11, 3))
    ),
    "good-sequence-moving-pause": _moving(
        "an attribute that pauses for a GOP, and inherits nothing after it", *[10] * 12, heats=_PAUSING, gop=4
    ),
    "good-sequence-moving-far": Good("values of the first frame, rounded to their kind (S 10.1)", _far),
}
