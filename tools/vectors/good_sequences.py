"""Sequences that every decoder must decode."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from bsm.api import encode_sequence
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.sequence.encoder import SequenceEncoder
from bsm.codec.sequence.options import SequenceOptions
from tools.surgery import with_header
from tools.vectors.good import Good
from tools.vectors.meshes import torus

BASE = SequenceOptions(step=1 / 256, gop=6, block_size=36, threads=1)


def _sequence(probes: str, frames: int, **options: object) -> Good:
    def make() -> bytes:
        meshes = [torus(10, 8, phase=0.2 * t) for t in range(frames)]
        positions = np.array([mesh.positions * (1 + 0.02 * t) for t, mesh in enumerate(meshes)])
        return encode_sequence(positions, meshes[0].faces, SequenceOptions(**{**vars(BASE), **options}))

    return Good(probes, make)


def _by_the_paper() -> bytes:
    return with_header(_sequence("", 4).make(), power=2, iterations=3, shift=2.0**-7)


def _swaying(probes: str, frames: int, period: int, **options: object) -> Good:
    """A small torus that comes back to where it was, again and again."""

    def make() -> bytes:
        meshes = [torus(6, 4, phase=0.2 * (t % period)) for t in range(frames)]
        chosen = SequenceOptions(**{**vars(BASE), "gop": frames, **options})
        return encode_sequence(np.array([mesh.positions for mesh in meshes]), meshes[0].faces, chosen)

    return Good(probes, make)


def _parting(probes: str) -> Good:
    """Triangles with vertices of their own, which are together; from the fourth frame on two of them drift away."""

    def make() -> bytes:
        mesh = torus(6, 5)
        frames = [torus(6, 5, phase=0.2 * t).positions[mesh.faces].reshape(-1, 3) for t in range(6)]
        for t in range(3, 6):
            frames[t][30:36] += 0.1 * (t - 2)
        faces = np.arange(len(frames[0])).reshape(-1, 3)
        return encode_sequence(frames, faces, replace(BASE, step=1 / 64, gop=3, keep_order=True))

    return Good(probes, make)


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


def _returning(probes: str, *times: int) -> Good:
    """Frames of a torus, with a color, at times that come again."""

    def make() -> bytes:
        frames = []
        for t in times:
            mesh = torus(8, 5, phase=0.2 * t)
            color = (128 + 120 * np.sin(mesh.positions + 0.3 * t)).astype(np.uint8)
            attributes = (Attribute("color", color, "vertex", "color"),)
            frames.append(replace(mesh, positions=mesh.positions * (1 + 0.02 * t), attributes=attributes))
        options = replace(BASE, gop=len(times))
        return b"".join(SequenceEncoder(frames[0].faces, options, len(times)).chunks(frames))

    return Good(probes, make)


_PAUSING = (0, 3, 1, 4, 0, 0, 0, 0, 2, 5, 1, 3)
SEQUENCES: dict[str, Good] = {
    "good-sequence-one": _sequence("a sequence of one frame", 1),
    "good-sequence-learnt": _sequence("GOPs with learnt bases, the last one shorter", 8),
    "good-sequence-returning": _returning(
        "frames that come again, stand still, turn back and jump", 0, 1, 2, 3, 0, 1, 2, 3, 3, 3, 2, 1, 3, 5, 0, 4
    ),
    "good-sequence-longer": _sequence("a learnt basis of more frames than decoders show at a time", 19, gop=19),
    "good-sequence-long": _sequence("more GOPs than refer to those before them", 11, gop=2),
    "good-sequence-low-delay": _sequence("frames as they come, with key frames", 7, low_delay=1, gop=3),
    "good-sequence-together": _sequence("three frames at a time, and two at the end", 11, low_delay=3, gop=6),
    "good-sequence-low-delay-returning": _swaying("frames that start from earlier ones", 9, 4, low_delay=1),
    "good-sequence-together-returning": _swaying("the same, two at a time", 12, 4, low_delay=2),
    "good-sequence-low-delay-long": _swaying("more frames than are kept", 72, 69, low_delay=1, step=1 / 64),
    "good-sequence-runs": _runs("faces that change and return", (8, 3), (6, 2), (8, 4), (5, 1), gop=3),
    "good-sequence-runs-low-delay": _runs("the same, frame by frame", (6, 2), (5, 3), (6, 2), low_delay=1, gop=4),
    "good-sequence-runs-many": _runs("more meshes than are kept", *((kind, 1) for kind in (*range(3, 13), 5, 12))),
    "good-sequence-runs-again": _runs(
        "a mesh that comes again counts as of that run", *((kind, 1) for kind in (*range(3, 11), 3, 11, 3))
    ),
    "good-sequence-moving-pause": _moving(
        "an attribute that pauses for a GOP, and inherits nothing after it", *[10] * 12, heats=_PAUSING, gop=4
    ),
    "good-sequence-splits": _parting("ORDER with copies, until some part"),
    "good-sequence-moving": _moving("attributes that move, one of them in the first GOP only", *[10] * 8, gop=4),
    "good-sequence-moving-ordered": _moving("the same, with an order of vertices", *[8] * 3, keep_order=True),
    "good-sequence-moving-low-delay": _moving("the same, frame by frame", *[8] * 7, low_delay=1, gop=5),
    "good-sequence-moving-runs": _moving("the same, and a mesh that returns", 6, 6, 5, 5, 6, 6, 6, gop=2),
    "good-sequence-moving-far": Good("values of the first frame, rounded to their kind (S 10.1)", _far),
    "good-sequence-moving-together": _moving("the same, a few frames at a time", *[8] * 7, low_delay=3),
    "good-sequence-paper": Good("other constants than those of sequences", _by_the_paper),
    "good-sequence-overlap": _sequence("overlapping blocks of the first frame", 3, overlap=1.3, keep=0.5),
}
