"""Streams that every decoder must refuse, each for one rule, and how."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any

import msgpack
import numpy as np
import zstandard

from bsm.bitstream.connectivity.partition import encode_labels
from bsm.bitstream.container.header import HEADER_FIELDS, LAW
from bsm.bitstream.container.wire import FrameType, write_frame, write_map, write_preamble, write_varint
from bsm.codec.decoding import decode
from bsm.codec.geometry.graph import graph_of_faces
from bsm.codec.static.encoder import encode
from bsm.codec.static.options import changed
from tools.attack.streams import one_block
from tools.surgery import Frames, frames_of, header_entries, stream_of, with_header, with_payload
from tools.vectors.good import BASE
from tools.vectors.meshes import patch, shuffled, together, torus

KINDS = ("format", "unsupported", "corrupt", "truncated", "limit", "numeric")
HEADER, CONNECTIVITY, PARTITION, ORDER, BLOCK = FrameType.HEADER, 3, 4, 5, FrameType.BLOCK
METADATA, GOP, END = FrameType.METADATA, FrameType.GOP, FrameType.END
PAPER = tuple(vars(LAW).values())


_NARROW = {"bits": 7}
_PACKED_BYTES = (3 * 6 * 7 + 7) // 8
_WIDE = {"bits": 16, "coefficients": 25}
_WIDE_BYTES = 3 * 25 * 2


@dataclass(frozen=True)
class Bad:
    """A stream to be refused with an error of the class `error`, one of `KINDS`."""

    probes: str
    error: str
    make: Callable[[], bytes]


@cache
def _base(**options: Any) -> bytes:
    """A sound stream without a checksum of positions; smaller ones fail in fewer ways."""
    return stream_of(frames_of(encode(patch(8, 7), changed(BASE, **{"coefficients": 6, **options}))))


@cache
def _ordered() -> bytes:
    mesh = shuffled(patch(5, 5))
    return encode(mesh, changed(BASE, keep_order=True, partition="metis", block_size=13))


@cache
def _small_component() -> bytes:
    mesh = together(torus(12, 7), torus(7, 6))
    options = {"block_size": 42, "overlap": 1.5, "coefficients": 60, "step": 1e-6}
    return encode(mesh, changed(BASE, **options))


def _lopsided() -> bytes:
    """Parts of 40 and 16 vertices, blocks of 32."""
    frames, labels = frames_of(_base()), np.repeat(np.array([0, 1], np.int32), [40, 16])
    graph = graph_of_faces(decode(_base()).faces, 56)
    payload = b"\0" + encode_labels(graph.offsets, graph.neighbors, labels, 2)
    return stream_of([*frames[:2], (PARTITION, payload), *frames[2:]])


def _changed(change: Callable[[Frames], object], base: Callable[[], bytes] = _base) -> bytes:
    frames = frames_of(base())
    change(frames)
    return stream_of(frames)


def _framed(change: Callable[[Frames], object], base: Callable[[], bytes] = _base) -> Callable[[], bytes]:
    return lambda: _changed(change, base)


_METADATA = (METADATA, b"\x81\xa1a\0")


def _place(frames: Frames, kind: int) -> int:
    return next(i for i, frame in enumerate(frames) if frame[0] == kind)


def _swap(first: int, second: int) -> Callable[[Frames], None]:
    def change(frames: Frames) -> None:
        i, j = _place(frames, first), _place(frames, second)
        frames[i], frames[j] = frames[j], frames[i]

    return change


def _edit(kind: int, edit: Callable[[bytes], bytes], which: int = 0) -> Callable[[Frames], None]:
    def change(frames: Frames) -> None:
        place = [i for i, frame in enumerate(frames) if frame[0] == kind][which]
        frames[place] = (kind, edit(frames[place][1]))

    return change


def _entries(**changes: Any) -> Callable[[], bytes]:
    return lambda: with_header(_base(), **changes)


def _map(edit: Callable[[dict[int, Any]], bytes]) -> Callable[[], bytes]:
    """A stream whose header is another map."""
    return lambda: with_payload(_base(), HEADER, edit(header_entries(frames_of(_base())[0][1])))


def _begun(**changes: Any) -> bytes:
    """A stream that ends behind its header."""
    return write_preamble() + write_frame(*frames_of(with_header(_base(), **changes))[0])


def _reversed(entries: dict[int, Any]) -> bytes:
    return write_map(sorted(entries.items(), reverse=True))


def _raw_frame(tag: bytes) -> bytes:
    return write_preamble() + tag


def _flipped(offset: int, bits: int = 0x10) -> bytes:
    data = bytearray(_base())
    data[offset] ^= bits
    return bytes(data)


def _long_damaged() -> bytes:
    frames = frames_of(_base())
    head = len(stream_of(frames[:1])) - 8
    data = bytearray(stream_of([frames[0], (8, bytes(200)), *frames[1:]]))
    data[head + 100] ^= 0x10
    return bytes(data)


def _inserting(kind: int) -> Callable[[Frames], None]:
    return lambda frames: frames.insert(1, (kind, b""))


def _end(frames: int, crc: int) -> bytes:
    data = _base()
    tail = write_frame(END, write_varint(len(frames_of(data))) + bytes(4))
    body = data[: len(data) - len(tail)]
    right = int.from_bytes(data[len(body) + 2 : len(body) + 6], "little")
    payload = write_varint(len(frames_of(data)) + frames) + (right ^ crc).to_bytes(4, "little")
    return body + write_frame(END, payload)


def unlike(stream: bytes) -> bytes:
    """The stream with another checksum of positions."""
    whole = stream_of(frames_of(stream))
    return whole[:-8] + write_frame(END, whole[-7:-2] + b"\xba\xdb\xad\x00")


def _packed(edit: Callable[[bytes], bytes], options: dict[str, int] = _NARROW) -> Callable[[], bytes]:
    """A stream of packed values with another first block."""

    def make() -> bytes:
        return _changed(_edit(BLOCK, lambda payload: payload[:2] + edit(payload[2:])), lambda: _base(**options))

    return make


def _zstd(content: bytes, size: bool = True) -> bytes:
    """A zstd frame without its magic number."""
    return zstandard.ZstdCompressor(write_content_size=size).compress(content)[4:]


def _zstd_window(size: int) -> bytes:
    """A zstd frame of `size` zeros, with a window of 2^24 bytes: descriptor, window, size, one repeated byte."""
    return b"\x80\x70" + size.to_bytes(4, "little") + (size << 3 | 3).to_bytes(3, "little") + b"\0"


FRAMING: dict[str, Bad] = {
    "bad-magic": Bad("another first byte", "format", lambda: b"\x88" + _base()[1:]),
    "bad-magic-late": Bad("another fourth byte", "format", lambda: b"\x89BSN" + _base()[4:]),
    "bad-empty": Bad("no bytes", "truncated", lambda: b""),
    "bad-magic-only": Bad("nothing behind the magic", "truncated", lambda: _base()[:4]),
    "unsupported-version": Bad("version 2", "unsupported", lambda: stream_of(frames_of(_base()), 0x20)),
    "unsupported-version-0": Bad("version 0", "unsupported", lambda: stream_of(frames_of(_base()), 0x00)),
    "bad-version-crc": Bad("another minor version, and not its checksum", "corrupt", lambda: _flipped(4, 0x01)),
    "bad-no-end": Bad("END is missing", "truncated", lambda: _base()[:-8]),
    "bad-half": Bad("the second half is missing", "truncated", lambda: _base()[: len(_base()) // 2]),
    "bad-trailing": Bad("a byte behind END", "corrupt", lambda: _base() + b"\0"),
    "bad-two-streams": Bad("a second stream behind the first", "corrupt", lambda: _base() + _base()),
    "bad-tag-long": Bad("a tag of six bytes", "corrupt", lambda: _raw_frame(b"\xff\xff\xff\xff\xff\x01")),
    "bad-tag-padded": Bad("a tag longer than need be", "corrupt", lambda: _raw_frame(b"\x81\x00" + bytes(8))),
    "bad-frame-huge": Bad("a frame that claims 2^30 bytes", "limit", lambda: _raw_frame(write_varint(1 << 34 | 1))),
    "bad-checksum-header": Bad("a wrong CRC-16 of a short frame", "corrupt", lambda: _flipped(12)),
    "bad-checksum-long": Bad("a wrong CRC-32 of a long frame", "corrupt", _long_damaged),
    "bad-checksum-block": Bad("a wrong CRC-16 of a block", "corrupt", lambda: _flipped(len(_base()) - 14)),
    "bad-end-count": Bad("END counts one frame too many", "corrupt", lambda: _end(1, 0)),
    "bad-end-crc": Bad("END has another CRC-32 of the stream", "corrupt", lambda: _end(0, 1)),
    "bad-end-long": Bad(
        "END has a byte too many", "corrupt", lambda: _base()[:-8] + write_frame(END, b"\x04" + bytes(5))
    ),
    "bad-end-positions": Bad("positions that are none of the encoder's", "corrupt", lambda: unlike(_ordered())),
    "bad-skippable-first": Bad("a skippable frame before HEADER", "corrupt", _framed(lambda f: f.insert(0, (8, b"")))),
    "bad-connectivity-first": Bad("CONNECTIVITY before HEADER", "corrupt", _framed(_swap(HEADER, CONNECTIVITY))),
    "bad-two-headers": Bad("HEADER twice", "corrupt", _framed(lambda f: f.insert(1, f[0]))),
    "bad-two-connectivities": Bad("CONNECTIVITY twice", "corrupt", _framed(lambda f: f.insert(1, f[1]))),
    "bad-no-connectivity": Bad("no CONNECTIVITY", "corrupt", _framed(lambda f: f.pop(1))),
    "bad-order-first": Bad("ORDER before PARTITION", "corrupt", _framed(_swap(PARTITION, ORDER), _ordered)),
    "bad-partition-late": Bad("PARTITION behind a block", "corrupt", _framed(_swap(PARTITION, BLOCK), _ordered)),
    "bad-metadata-first": Bad("METADATA before HEADER", "corrupt", _framed(lambda f: f.insert(0, (METADATA, b"\x80")))),
    "bad-metadata-again": Bad(
        "METADATA that speak of one name, before and behind a block",
        "corrupt",
        _framed(lambda f: f.__setitem__(slice(1, None), [_METADATA, *f[1:], _METADATA])),
    ),
    "bad-metadata-array": Bad(
        "METADATA with an array", "corrupt", _framed(lambda f: f.insert(1, (METADATA, b"\x81\xa1a\x90")))
    ),
    "bad-gop-static": Bad("a GOP in a static stream", "corrupt", _framed(lambda f: f.append((GOP, bytes(9))))),
    **{
        f"unsupported-type-{kind}": Bad(f"a frame of type {kind}", "unsupported", _framed(_inserting(kind)))
        for kind in (0, 12, 13, 14)
    },
}

HEADERS: dict[str, Bad] = {
    **{
        f"bad-lacks-{name.replace('_', '-')}": Bad(f"HEADER lacks {name}", "corrupt", _entries(**{name: None}))
        for name in ("vertices", "faces", "blocks", "block_size", "coefficients")
    },
    "bad-default-stored": Bad("a field is stored that has its default", "corrupt", _entries(key_interval=0)),
    "bad-default-stored-float": Bad("the default step is stored", "corrupt", _entries(step=2.0**-8)),
    "bad-int-as-float": Bad("a float where an int belongs", "corrupt", _entries(vertices=56.0)),
    "bad-float-as-int": Bad("an int where a float belongs", "corrupt", _entries(smoothing=1)),
    "bad-center-short": Bad("a center of two numbers", "corrupt", _entries(center=[1.0, 2.0])),
    "bad-center-type": Bad("a center of ints", "corrupt", _entries(center=[1, 2, 3])),
    "bad-scale-zero": Bad("scale = 0", "corrupt", _entries(scale=0.0)),
    "bad-step-zero": Bad("step = 0", "corrupt", _entries(step=0.0)),
    "bad-step-negative": Bad("step < 0", "corrupt", _entries(step=-0.5)),
    "bad-shift-zero": Bad("shift = 0", "corrupt", _entries(shift=0.0)),
    "bad-smoothing-negative": Bad("smoothing < 0", "corrupt", _entries(smoothing=-1.0)),
    "bad-power-65": Bad("power = 65", "corrupt", _entries(power=65)),
    "bad-iterations-zero": Bad("iterations = 0", "corrupt", _entries(iterations=0)),
    "bad-bits-33": Bad("bits = 33", "corrupt", _entries(bits=33)),
    "bad-vertices-zero": Bad("vertices = 0", "corrupt", _entries(vertices=0)),
    "bad-vertices-negative": Bad("vertices < 0", "corrupt", _entries(vertices=-1)),
    "bad-vertices-2-31": Bad("vertices = 2^31", "corrupt", _entries(vertices=2**31)),
    "bad-vertices-many": Bad("more vertices than corners of faces", "corrupt", _entries(faces=10)),
    "bad-blocks-many": Bad("more blocks than vertices", "corrupt", _entries(blocks=57)),
    "bad-block-large": Bad("blocks larger than the mesh", "corrupt", _entries(block_size=57)),
    "bad-blocks-small": Bad("blocks too small to cover the mesh", "corrupt", _entries(block_size=20)),
    "bad-blocks-overlap": Bad(
        "blocks that overlap too much by one",
        "corrupt",
        lambda: _begun(vertices=293, faces=586, blocks=265, block_size=265, coefficients=9),
    ),
    "bad-coefficients-many": Bad("more coefficients than rows", "corrupt", _entries(coefficients=50)),
    "bad-sequence-short": Bad("frames without a length for GOPs", "corrupt", _entries(sequence=[3])),
    "bad-run-static": Bad("a run of a static mesh", "corrupt", _entries(run=[1])),
    "bad-springs-2": Bad("springs = 2", "corrupt", _entries(springs=2)),
    "bad-paper-default": Bad("paper as the law has it", "corrupt", _entries(paper=list(map(float, PAPER)))),
    "bad-paper-short": Bad("paper of seven numbers", "corrupt", _entries(paper=[12.0, *map(float, PAPER[1:7])])),
    "bad-paper-fraction": Bad("half a bit", "corrupt", _entries(paper=[11.5, *map(float, PAPER[1:])])),
    "bad-paper-type": Bad("paper of ints", "corrupt", _entries(paper=[12, 0, 0, 3, 1, 2, 1, 1])),
    "bad-limit-vertices": Bad(
        "more vertices than a decoder should grant",
        "limit",
        _entries(vertices=2**30, faces=2**30, blocks=2**18, block_size=8192),
    ),
    "bad-limit-faces": Bad("more faces than a decoder should grant", "limit", _entries(faces=2**30)),
    "bad-limit-block-size": Bad(
        "larger blocks than a decoder should grant",
        "limit",
        _entries(vertices=100_000, faces=200_000, block_size=50_000),
    ),
    "bad-limit-coefficients": Bad(
        "more coefficients than a decoder should grant",
        "limit",
        _entries(vertices=10_000, faces=20_000, block_size=8000, coefficients=5000),
    ),
    "bad-limit-work": Bad(
        "one column, but 65,536 solutions", "limit", lambda: one_block(36, 36, 1, power=64, key_iterations=1024)
    ),
    "bad-limit-memory": Bad("a dictionary of 108 MB", "limit", lambda: one_block(36, 36, 1296, power=1)),
    "bad-key-order": Bad("keys that descend", "corrupt", _map(_reversed)),
    "bad-key-repeated": Bad("a key twice", "corrupt", _map(lambda e: write_map([(1, 56), *sorted(e.items())]))),
    "bad-key-negative": Bad("a negative key", "corrupt", _map(lambda e: write_map([(-1, 1), *sorted(e.items())]))),
    "bad-key-string": Bad(
        "a string among integer keys", "corrupt", _map(lambda e: write_map([*sorted(e.items()), ("a", 1)]))
    ),
    "bad-int-long": Bad(
        "an int that is longer than need be",
        "corrupt",
        _map(lambda e: write_map(sorted(e.items())).replace(b"\x01\x38", b"\x01\xcc\x38", 1)),
    ),
    "bad-float-long": Bad(
        "a float 64 where a float 32 holds the value",
        "corrupt",
        _map(lambda e: write_map(sorted({**e, 9: 2.0}.items())).replace(b"\xca\x40\0\0\0", b"\xcb\x40" + bytes(7), 1)),
    ),
    "bad-float-infinite": Bad(
        "an infinite scale",
        "corrupt",
        _map(lambda e: write_map(sorted({**e, 9: 2.0}.items())).replace(b"\xca\x40\0\0\0", b"\xca\x7f\x80\0\0", 1)),
    ),
    "bad-float-nan": Bad(
        "a scale that is no number",
        "corrupt",
        _map(lambda e: write_map(sorted({**e, 9: 2.0}.items())).replace(b"\xca\x40\0\0\0", b"\xca\x7f\xc0\0\0", 1)),
    ),
    "bad-map-nil": Bad("nil in a map", "corrupt", _map(lambda e: msgpack.packb({**e, 64: None}))),
    "bad-map-true": Bad("a boolean in a map", "corrupt", _map(lambda e: msgpack.packb({**e, 64: True}))),
    "bad-map-arrays": Bad(
        "arrays of 257 entries together",
        "corrupt",
        _map(lambda e: write_map([*e.items(), (64, [1] * 200), (65, [1] * 54)])),
    ),
    "bad-header-long": Bad(
        "a header of 65,537 bytes",
        "corrupt",
        _map(lambda e: write_map([*e.items(), (64, bytes(65_537 - 4 - len(write_map(sorted(e.items())))))])),
    ),
    "bad-map-nested": Bad("a map in a map", "corrupt", _map(lambda e: msgpack.packb({**e, 64: {1: 2}}))),
    "bad-map-trailing": Bad("a byte behind the map", "corrupt", _map(lambda e: write_map(sorted(e.items())) + b"\0")),
    "bad-map-array": Bad("an array instead of a map", "corrupt", _map(lambda e: msgpack.packb([1, 2]))),
    "bad-map-deep": Bad(
        "arrays nested 10,000 deep", "corrupt", _map(lambda e: b"\x81\x01" + b"\x91" * 10_000 + b"\x01")
    ),
    **{
        f"unsupported-key{name}": Bad(
            f"key {key}, which is unknown",
            "unsupported",
            _map(lambda e, key=key: write_map(sorted({**e, key: 1}.items()))),  # type: ignore[misc]
        )
        for name, key in (("", 20), ("-64", 64))
    },
    **{
        f"unsupported-{name}": Bad(
            f"a {name} that is not known", "unsupported", _entries(**{name: int(HEADER_FIELDS[name].high) + 1})
        )
        for name in ("light",)
    },
    "bad-not-finite": Bad(
        "positions beyond the greatest double",
        "numeric",
        lambda: with_header(_base(step=1e-6), scale=1e300, step=2.0**20),
    ),
}

PAYLOADS: dict[str, Bad] = {
    **{
        f"bad-{name}-{word}": Bad(probes.format(name.upper()), "corrupt", _framed(_edit(kind, edit), _ordered))
        for name, kind in (("connectivity", CONNECTIVITY), ("partition", PARTITION), ("order", ORDER))
        for word, probes, edit in (
            ("long", "bytes behind the last symbol of {}", lambda p: p + b"\x55" * 8),
            ("ff", "{} begins with four bytes of 255", lambda p: b"\0\0" * (p[:2] == b"\0\0") + b"\xff" * 8 + p[9:]),
        )
    },
    "bad-connectivity-short": Bad(
        "only one byte of data in CONNECTIVITY", "truncated", _framed(_edit(CONNECTIVITY, lambda p: p[:1]), _ordered)
    ),
    "bad-order-short": Bad(
        "only three bytes of data in ORDER", "corrupt", _framed(_edit(ORDER, lambda p: p[:3]), _ordered)
    ),
    "bad-connectivity-zeros": Bad(
        "CONNECTIVITY of zeros", "corrupt", _framed(_edit(CONNECTIVITY, lambda p: bytes(40)))
    ),
    "bad-connectivity-vertices": Bad("one vertex more than the faces have", "corrupt", _entries(vertices=57)),
    "bad-connectivity-faces": Bad("one face fewer than there are", "corrupt", _entries(faces=83)),
    "bad-partition-parts": Bad("more blocks than parts", "corrupt", lambda: with_header(_ordered(), blocks=3)),
    "bad-part-large": Bad("a part larger than a block", "corrupt", _lopsided),
    "bad-block-index": Bad(
        "a block index that is too large", "corrupt", _framed(_edit(BLOCK, lambda p: b"\x7f" + p[1:], which=1))
    ),
    "bad-block-descending": Bad(
        "block indices that descend", "corrupt", _framed(lambda f: f.__setitem__(slice(2, 4), [f[3], f[2]]))
    ),
    "bad-block-repeated": Bad("a block index twice", "corrupt", _framed(lambda f: f.insert(2, f[2]))),
    "bad-block-missing": Bad("the first block is missing", "corrupt", _framed(lambda f: f.pop(2))),
    "bad-block-missing-last": Bad("the last block is missing", "corrupt", _framed(lambda f: f.pop())),
    "bad-block-none": Bad("no block", "corrupt", _framed(lambda f: f.__delitem__(slice(2, None)))),
    "bad-block-empty": Bad("a block without index", "corrupt", _framed(_edit(BLOCK, lambda p: b""))),
    "bad-columns-zero": Bad("c_i = 0", "corrupt", _framed(_edit(BLOCK, lambda p: p[:1] + b"\0" + p[2:]))),
    "bad-columns-many": Bad(
        "c_i above the header's", "corrupt", _framed(_edit(BLOCK, lambda p: p[:1] + b"\x07" + p[2:]))
    ),
    "bad-columns-rows": Bad(
        "c_i above the rows of a small component's block",
        "corrupt",
        lambda: _changed(_edit(BLOCK, lambda p: p[:1] + b"\x3c" + p[2:], which=0), _small_component),
    ),
    "bad-levels-short": Bad("levels that end too early", "truncated", _framed(_edit(BLOCK, lambda p: p[:3]))),
    "bad-levels-long": Bad("bytes behind the levels", "corrupt", _framed(_edit(BLOCK, lambda p: p + b"\x55" * 8))),
    "bad-packed-short": Bad(
        "packed levels with a byte too few", "corrupt", _packed(lambda d: bytes(_PACKED_BYTES - 1))
    ),
    "bad-packed-long": Bad(
        "packed levels with a byte too many", "corrupt", _packed(lambda d: bytes(_PACKED_BYTES + 1))
    ),
    "bad-packed-padding": Bad(
        "bits that are not 0 behind packed levels", "corrupt", _packed(lambda d: b"\x55" * _PACKED_BYTES)
    ),
    "bad-packed-bomb": Bad(
        "a zstd frame with 2^20 bytes of content", "corrupt", _packed(lambda d: _zstd(bytes(1 << 20)), _WIDE)
    ),
    "bad-packed-no-size": Bad(
        "a zstd frame that does not state its size",
        "corrupt",
        _packed(lambda d: _zstd(bytes(_WIDE_BYTES), size=False), _WIDE),
    ),
    "bad-packed-extra": Bad(
        "bytes behind a zstd frame", "corrupt", _packed(lambda d: _zstd(bytes(_WIDE_BYTES)) + b"\0\0", _WIDE)
    ),
    "bad-packed-window": Bad(
        "a zstd frame with a window of 2^24 bytes", "corrupt", _packed(lambda d: _zstd_window(_WIDE_BYTES), _WIDE)
    ),
    "bad-packed-cut": Bad(
        "a zstd frame that is cut short", "corrupt", _packed(lambda d: _zstd(bytes(_WIDE_BYTES))[:-3], _WIDE)
    ),
}


BAD: dict[str, Bad] = {**FRAMING, **HEADERS, **PAYLOADS}
