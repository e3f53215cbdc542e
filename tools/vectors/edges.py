"""Streams at the edges of rules: two faults at once, numbers in other forms, many components, claims without data."""

from __future__ import annotations

import struct
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import zstandard

from bsm.api import encode_sequence
from bsm.bitstream.container.header import HEADER_FIELDS
from bsm.bitstream.container.wire import FrameType, write_frame, write_map
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.sequence.options import SequenceOptions
from bsm.codec.static.encoder import encode
from bsm.codec.static.options import changed
from tools.surgery import frames_of, header_entries, stream_of, with_header, with_payload
from tools.vectors.bad import Bad
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


def _with_map(edit: Callable[[dict[int, Any]], bytes]) -> Callable[[], bytes]:
    return lambda: with_payload(_stream(), HEADER, edit(header_entries(frames_of(_stream())[0][1])))


def _metadata(payload: bytes) -> Callable[[], bytes]:
    def make() -> bytes:
        frames = frames_of(_stream())
        return stream_of([frames[0], (METADATA, payload), *frames[1:]])

    return make


def _zstd_with_checksum() -> bytes:
    """The bytes of a block as a zstd frame with a checksum of its content."""
    stream = _stream(bits=16, coefficients=25)
    payload = next(payload for kind, payload in frames_of(stream) if kind == BLOCK)
    content = bytes.fromhex("80 00") * 75
    frame = zstandard.ZstdCompressor(write_checksum=True).compress(content)
    return with_payload(stream, BLOCK, payload[:2] + frame[4:])


def _short_then_wrong() -> bytes:
    """The first block ends too early, and END has another CRC."""
    frames = frames_of(_stream())
    place = next(i for i, (kind, _) in enumerate(frames) if kind == BLOCK)
    frames[place] = (BLOCK, frames[place][1][:6])
    whole = stream_of(frames)
    payload = bytearray(whole[-7:-2])
    payload[1] ^= 1
    return whole[:-8] + write_frame(FrameType.END, bytes(payload))


def _swap_after(edit: Callable[[bytes], bytes]) -> Callable[[], bytes]:
    """CONNECTIVITY with other data, and a second one behind it."""

    def make() -> bytes:
        frames = frames_of(_stream())
        return stream_of([frames[0], (CONNECTIVITY, edit(frames[1][1])), *frames[1:]])

    return make


def _claims(**header: Any) -> Callable[[], bytes]:
    """The faces of a large regular mesh, and no block, whatever the header claims."""

    def make() -> bytes:
        frames = frames_of(with_header(encode(torus(48, 48), BASE), **header))
        return stream_of([frame for frame in frames if frame[0] != BLOCK])

    return make


def _unused(**changes: Any) -> Callable[[], bytes]:
    return lambda: with_header(_stream(), **changes)


METHOD = int(HEADER_FIELDS["light"].high) + 1

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

EDGES_BAD: dict[str, Bad] = {
    "unsupported-key-and-range": Bad(
        "an unknown key behind a value out of range",
        "unsupported",
        _with_map(lambda e: _entries({**e, 10: -1.0, 20: 1})),
    ),
    "unsupported-method-and-range": Bad(
        "an unknown method behind a value out of range", "unsupported", _unused(smoothing=-1.0, light=METHOD)
    ),
    "unsupported-method-and-lack": Bad(
        "an unknown method, and no number of faces", "unsupported", _unused(faces=None, light=METHOD)
    ),
    "unsupported-method-and-limit": Bad(
        "an unknown method of a mesh beyond all limits",
        "unsupported",
        _unused(vertices=2**30, faces=2**30, blocks=2**18, block_size=8192, light=METHOD),
    ),
    "unsupported-method-and-default": Bad(
        "an unknown method behind a default that is stored", "unsupported", _unused(key_interval=0, light=METHOD)
    ),
    "bad-range-and-limit": Bad(
        "a mesh beyond all limits, and a value out of range",
        "corrupt",
        _unused(vertices=2**30, faces=2**30, blocks=2**18, block_size=8192, power=65),
    ),
    "bad-map-and-key": Bad(
        "an unknown key in a map that is not canonical",
        "corrupt",
        _with_map(lambda e: _entries({**e, 20: 1}).replace(b"\x01\x38", b"\x01\xcc\x38", 1)),
    ),
    "bad-method-float": Bad("a method that is no int", "corrupt", _unused(light=float(METHOD))),
    "bad-int16": Bad("300 as int 16", "corrupt", _metadata(b"\x81\xa1a\xd1\x01\x2c")),
    "bad-int16-header": Bad(
        "a number of faces as int 16",
        "corrupt",
        _with_map(lambda e: _entries({**e, 2: 300}).replace(b"\x02\xcd\x01\x2c", b"\x02\xd1\x01\x2c", 1)),
    ),
    "bad-int32": Bad("70,000 as int 32", "corrupt", _metadata(b"\x81\xa1a\xd2" + struct.pack(">i", 70_000))),
    "bad-int64": Bad("2^40 as int 64", "corrupt", _metadata(b"\x81\xa1a\xd3" + struct.pack(">q", 1 << 40))),
    "bad-int8": Bad("-3 as int 8", "corrupt", _metadata(b"\x81\xa1a\xd0\xfd")),
    "bad-uint16": Bad("200 as uint 16", "corrupt", _metadata(b"\x81\xa1a\xcd\0\xc8")),
    "bad-string-long": Bad("a string of one byte as str 8", "corrupt", _metadata(b"\x81\xa1a\xd9\x01b")),
    "bad-string-utf8": Bad("a string that is no UTF-8", "corrupt", _metadata(b"\x81\xa1a\xa1\xff")),
    "bad-minus-zero": Bad("-0.0, the default, is stored", "corrupt", _unused(smoothing=-0.0)),
    "bad-minus-zero-center": Bad("a center of -0.0", "corrupt", _unused(center=[0.0, -0.0, 0.0])),
    "bad-packed-checksum": Bad("a zstd frame with a checksum of its content", "corrupt", _zstd_with_checksum),
    "bad-first-of-two": Bad(
        "levels that end too early, and then another CRC-32 in END", "truncated", _short_then_wrong
    ),
    "bad-order-of-faults": Bad(
        "faces that end too early, and then a second CONNECTIVITY", "truncated", _swap_after(lambda data: data[:2])
    ),
    "bad-claims": Bad("a regular mesh without blocks", "corrupt", _claims()),
    "bad-claims-wide": Bad("the same with dictionaries as wide as they may be", "corrupt", _claims(power=64, exact=1)),
    "bad-claims-blocks": Bad(
        "the same with a block for every vertex, each as large as the mesh",
        "corrupt",
        _claims(blocks=2304, block_size=2304, coefficients=2304),
    ),
    "bad-sequence-limit-gop-frames": Bad(
        "longer GOPs than a decoder should grant",
        "limit",
        lambda: with_header(_sequence("", 2).make(), gop_frames=4096),
    ),
    "bad-sequence-limit-frames": Bad(
        "more frames than a decoder should grant", "limit", lambda: with_header(_sequence("", 2).make(), frames=2**21)
    ),
}


def _entries(entries: dict[int, Any]) -> bytes:
    return write_map(sorted(entries.items()))
