"""Streams at the edges of rules: numbers in other forms, many components, long chains."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from bsm.api import encode_sequence
from bsm.bitstream.container.wire import FrameType, write_map
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.sequence.options import SequenceOptions
from bsm.codec.static.encoder import encode
from bsm.codec.static.options import changed
from tools.surgery import frames_of, stream_of, with_header
from tools.vectors.good import BASE, Good
from tools.vectors.good_sequences import BASE as SEQUENCE
from tools.vectors.meshes import patch, shuffled, tangled, tetrahedron, together, torus

HEADER, METADATA, CONNECTIVITY, BLOCK = FrameType.HEADER, FrameType.METADATA, FrameType.CONNECTIVITY, FrameType.BLOCK


def _stream(**options: Any) -> bytes:
    return encode(patch(8, 7), changed(BASE, **{"coefficients": 6, **options}))


def _static(probes: str, mesh: Callable[[], TriangleMesh], **options: object) -> Good:
    return Good(probes, lambda: encode(mesh(), changed(BASE, **options)))


def _sequence(probes: str, frames: int, **options: object) -> Good:
    def make() -> bytes:
        meshes = [torus(10, 8, phase=0.3 * t) for t in range(frames)]
        positions = [shuffled(mesh).positions if options.get("keep_order") else mesh.positions for mesh in meshes]
        faces = shuffled(meshes[0]).faces if options.get("keep_order") else meshes[0].faces
        return encode_sequence(positions, faces, SequenceOptions(**{**vars(SEQUENCE), **options}))

    return Good(probes, make)


def _pieces() -> TriangleMesh:
    """A torus, and more components than a block of it has low frequencies."""
    return together(torus(12, 10), *(tetrahedron() for _ in range(30)))


def _strips() -> TriangleMesh:
    """Long components side by side: each block holds a piece of several."""
    return together(*(patch(24, 3) for _ in range(4)))


def _metadata(payload: bytes) -> Callable[[], bytes]:
    def make() -> bytes:
        frames = frames_of(_stream())
        return stream_of([frames[0], (METADATA, payload), *frames[1:]])

    return make


def _unused(**changes: Any) -> Callable[[], bytes]:
    return lambda: with_header(_stream(), **changes)


EDGES: dict[str, Good] = {
    "good-pieces": _static(
        "a block of 31 components, each with a lowest frequency of its own",
        _pieces,
        block_size=240,
        keep=1.0,
        step=1e-4,
    ),
    "good-pieces-follow": _static(
        "blocks of several components that follow others", _strips, block_size=96, overlap=1.0, key_interval=0
    ),
    "good-pieces-exact": _static(
        "exact bases of blocks of several components", _strips, block_size=96, key_seed="svd", key_interval=1
    ),
    "good-pieces-many-iterations": _static(
        "many iterations on many components", _pieces, block_size=240, keep=0.5, power=8, key_iterations=16
    ),
    "good-independent-predicted": Good("prediction where every block is on its own", lambda: _stream(key_interval=1)),
    "good-refined-ordered": Good(
        "refinement, and the order as given",
        lambda: encode(shuffled(torus(24, 16)), replace(BASE, step=None, keep=None, keep_order=True)),
    ),
    "good-coarser-alone": Good("coarser, where nothing is packed", _unused(coarser=7)),
    "good-metadata-forms": Good(
        "metadata: 300 in two bytes, -1, -300, 2^40, -0.0, a double, bytes, nothing",
        _metadata(
            write_map(
                [("a", 300), ("b", -1), ("c", -300), ("d", 1 << 40), ("e", -0.0), ("f", 0.1), ("g", b"\0\1"), ("h", "")]
            )
        ),
    ),
    "good-sequence-narrow": _sequence("dictionaries of few columns", 4, keep=0.05),
    "good-sequence-narrow-frames": _sequence("frames as they come, by few columns", 4, keep=0.1, low_delay=1),
    "good-sequence-ordered": _sequence(
        "ORDER of a sequence, and a frame rate in METADATA", 3, keep_order=True, frame_rate=12.5
    ),
    "good-sequence-key-seed": Good(
        "parts with exact bases", lambda: with_header(_sequence("", 3, keep=0.3).make(), exact=1)
    ),
    "good-sequence-unknown-end": Good(
        "a sequence whose length was not known", lambda: with_header(_sequence("", 7).make(), frames=None)
    ),
    "good-sequence-tangled": Good(
        "weights where triangles have no area",
        lambda: encode_sequence(
            [tangled().positions * (1 + 0.1 * t) for t in range(3)], tangled().faces, replace(SEQUENCE, keep=0.5)
        ),
    ),
}
