"""Streams that every decoder must decode, each for one thing that it probes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from bsm.bitstream.coefficients.packed import pack_coefficients
from bsm.bitstream.container.wire import VERSION, FrameType
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.static.encoder import encode
from bsm.codec.static.options import EncodeOptions, changed
from tools.surgery import frames_of, stream_of, with_header
from tools.vectors.meshes import hub, patch, shuffled, tangled, tetrahedron, together, torus, triangle

BASE = EncodeOptions(block_size=30, keep=0.3, step=1 / 256, smoothing=0.0, threads=1)


PAPER: dict[str, object] = {"bits": 12, "key_interval": 0}
"""The coding of the paper."""


@dataclass(frozen=True)
class Good:
    """A stream to be decoded; `make` is called only when vectors are written."""

    probes: str
    make: Callable[[], bytes]


def _static(probes: str, mesh: Callable[[], TriangleMesh], **options: object) -> Good:
    return Good(probes, lambda: encode(mesh(), changed(BASE, **options)))


def _small() -> TriangleMesh:
    return torus(12, 10)


def _uneven() -> TriangleMesh:
    """Rough on one side only."""
    mesh = torus(18, 12)
    x = mesh.positions[:, 0]
    bumps = 0.1 * np.sin(40 * mesh.positions[:, 1] + 9 * np.arange(len(x))) * (x > 0.7)
    return TriangleMesh(mesh.positions * (1 + bumps[:, None]), mesh.faces)


def _onorm(**options: object) -> bytes:
    return encode(_small(), changed(BASE, **PAPER, **options))


def _coarser() -> bytes:
    stream = encode(_small(), changed(BASE, bits=12))
    return with_header(stream, coarser=2)


def _compressed() -> bytes:
    """A stream with the same few levels in every block."""
    stream = encode(_small(), changed(BASE, bits=16, coefficients=21))
    frames = frames_of(stream)
    values = np.full(63, 1 << 15)
    values[3:9] += 8000
    short = pack_coefficients(values, 16)
    return stream_of([(kind, payload[:2] + short if kind == FrameType.BLOCK else payload) for kind, payload in frames])


def _with_isolated() -> TriangleMesh:
    mesh = patch(6, 6)
    return TriangleMesh(np.concatenate([[[9.0, 9.0, 9.0]], mesh.positions]), mesh.faces + 1)


def _skippable(version: int = VERSION) -> bytes:
    frames = frames_of(encode(_small(), BASE))
    return stream_of(
        [frames[0], (8, b""), *frames[1:3], (11, b"skip this"), *frames[3:], (9, bytes(127)), (9, bytes(128))], version
    )


def _metadata() -> bytes:
    frames = frames_of(encode(patch(6, 6), BASE))
    text = bytes.fromhex("83 a1 61 01 a1 62 ca 3f 00 00 00 a4 6e 61 6d 65 a3 c3 a9 21")
    return stream_of([frames[0], (FrameType.METADATA, text), *frames[1:]])


def _metadata_everywhere() -> bytes:
    """METADATA behind each frame, each of a name of its own."""
    frames = frames_of(encode(torus(16, 12), BASE))
    metadata = [(FrameType.METADATA, bytes([0x81, 0xA1, 0x61 + place, place])) for place in range(len(frames))]
    metadata[-1] = (FrameType.METADATA, b"\x80")
    return stream_of([frame for pair in zip(frames, metadata, strict=True) for frame in pair])


STATIC: dict[str, Good] = {
    "good-tetrahedron": _static("four vertices, one block", tetrahedron, coefficients=4),
    "good-triangle": _static("one face, and a boundary of three edges", triangle, coefficients=3),
    "good-one-block": _static("one block that is the whole mesh", lambda: patch(6, 6), block_size=36),
    "good-one-more": _static(
        "one vertex more than a block holds", lambda: patch(6, 6), block_size=18, overlap=35 / 18, key_interval=0
    ),
    "good-chain": _static("several blocks in one chain, with prediction", _small, key_interval=0),
    "good-keys": _static("key blocks in mid-stream: chains of two blocks", _small, key_interval=2),
    "good-independent": _static("every block on its own", _small, key_interval=1),
    "good-no-prediction": _static("a chain without prediction", _small, predict=False),
    "good-exact": _static("exact bases of all blocks", _small, key_seed="svd", key_interval=1),
    "good-exact-clusters": _static(
        "exact basis of one block with repeated eigenvalues", lambda: torus(6, 6), key_seed="svd", block_size=36
    ),
    "good-key-seed": _static("chains that begin with an exact basis", _small, key_seed="svd", key_interval=3),
    "good-one-column": _static("c = 1 in every block", _small, coefficients=1),
    "good-all-columns": _static("c = n_d: as many coefficients as rows", _small, keep=1.0, step=1e-5),
    "good-rising-falling": _static("c_i rises and falls along a chain", _uneven, keep=1.0, step=0.02),
    "good-components": _static(
        "three components of the mesh, in blocks that hold several",
        lambda: together(torus(7, 6), patch(6, 5), triangle()),
    ),
    "good-small-component": _static(
        "a component smaller than a block: a block with fewer rows",
        lambda: together(torus(12, 7), torus(7, 6)),
        block_size=42,
        overlap=1.5,
    ),
    "good-isolated": _static("a vertex in no face: not in the stream", _with_isolated),
    "good-tangled": _static("non-manifold, repeated, turned and degenerate faces; a vertex without edges", tangled),
    "good-hub": _static("a vertex with more neighbors than a block has rows", hub, block_size=12),
    "good-boundary": _static("a disc: one boundary loop", lambda: patch(12, 11)),
    "good-genus": _static("closed, genus one", lambda: torus(9, 8)),
    "good-ordered": _static(
        "ORDER: vertices, faces and first corners as given", lambda: shuffled(_small()), keep_order=True
    ),
    "good-labels": _static("PARTITION: labels of the parts are stored", _small, partition="metis"),
    "good-packed": _static("packed coefficients of 12 bits", _small, bits=12),
    "good-packed-7": _static("packed coefficients of 7 bits, which do not end at a byte", _small, bits=7),
    "good-onorm": _static("Onorm in doubles after two solutions, in one chain", _small, **PAPER, power=2),
    "good-onorm-three": _static("two iterations of three solutions", _small, **PAPER, power=3, iterations=2),
    "good-onorm-panels": _static(
        "Onorm in doubles of columns in several panels, of a key block as well",
        lambda: torus(18, 14),
        **(PAPER | {"key_seed": "cosines", "block_size": 120, "keep": 0.6}),
        power=2,
    ),
    "good-onorm-rest": Good(
        "five solutions, two by two and the last alone", lambda: with_header(_onorm(power=5), onorm=2)
    ),
    "good-onorm-dependent": Good(
        "columns of which eight solutions leave nothing: they are made one by one in doubles",
        lambda: with_header(_onorm(power=8, shift=2.0**-16), onorm=8),
    ),
    "good-onorm-pieces": _static(
        "Onorm in doubles where blocks hold several components",
        lambda: together(torus(7, 6), patch(6, 5), tetrahedron()),
        **PAPER,
        power=2,
    ),
    "good-packed-coarser": Good("packed coefficients whose first row is coarser", _coarser),
    "good-packed-zstd": Good("packed coefficients that zstd shortens", _compressed),
    "good-smoothing": _static("smoothing over the whole mesh, boundary included", lambda: patch(12, 11), smoothing=2.0),
    "good-smoothing-tangled": _static("smoothing of a mesh with a vertex without edges", tangled, smoothing=0.5),
    "good-parameters": _static(
        "other exponent, iterations and shift", _small, power=1, iterations=3, key_iterations=5, shift=0.5
    ),
    "good-ill-conditioned": _static(
        "a power of which rounding leaves nothing, unless every solution is orthonormalized",
        _small,
        power=16,
        shift=1e-6,
        keep=1.0,
        step=1e-4,
    ),
    "good-extreme": Good(
        "the largest power, the least shift", lambda: with_header(encode(_small(), BASE), power=64, shift=2.0**-30)
    ),
    "good-shifted": Good(
        "the largest shift: nothing is left to tell the columns apart",
        lambda: with_header(encode(_small(), BASE), shift=2.0**30),
    ),
    "good-springs": _static(
        "springs between blocks that hold several components",
        lambda: together(torus(7, 6), patch(6, 5), tetrahedron()),
        shift=2.0**-5,
        key_interval=0,
    ),
    "good-fine": _static("a fine step: levels of many bits", _small, step=1e-6, keep=1.0),
    "good-coarse": _static("a coarse step: most levels are 0", _small, step=0.04),
    "good-all": _static(
        "everything as the encoder chooses it", lambda: torus(24, 16), block_size=100, keep=0.2, smoothing=1.0
    ),
    "good-far": _static(
        "a mesh far from the origin, and small",
        lambda: TriangleMesh(1e-3 * torus(12, 10).positions + [1e4, -3e5, 7.0], torus(12, 10).faces),
    ),
    "good-skippable": Good("skippable frames between the others", _skippable),
    "good-minor": Good("minor version 15, and what is new is skippable", lambda: _skippable(VERSION | 15)),
    "good-metadata-everywhere": Good("metadata behind each frame", _metadata_everywhere),
    "good-metadata": Good("metadata: an integer, a float, a string beyond ASCII", _metadata),
}
