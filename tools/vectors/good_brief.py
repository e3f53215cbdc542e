"""Brief streams: small meshes on grids, each in one frame."""

from typing import Any

import numpy as np

from bsm.bitstream.connectivity.faces import encode_connectivity
from bsm.bitstream.container.header import MOST_GRID
from bsm.bitstream.container.packets import BRIEF, BRIEF_METADATA, Header, Metadata, MetadataValue, Packet, write_brief
from bsm.bitstream.container.wire import FrameType, write_frame, write_map, write_preamble
from bsm.codec.geometry.mesh import TriangleMesh
from tools.gridded import gridded
from tools.surgery import first_payload, header_entries, scan, stream_of
from tools.vectors.bounds import Bad
from tools.vectors.good import Good
from tools.vectors.good_congruence import mirrors, placed
from tools.vectors.meshes import patch, tetrahedron, together, torus, triangle


def brief(stream: bytes, *more: Packet) -> bytes:
    """A stream of one grid as a brief one, with more packets."""
    header, *body = (packet for packet, span in scan(stream) if span.type != FrameType.END)
    assert isinstance(header, Header)
    payload = write_brief(header, [*body, *more])
    assert payload is not None
    return write_preamble(1) + write_frame(FrameType.HEADER, payload)


def on_grid(mesh: TriangleMesh, cells: int, **fields: Any) -> bytes:
    """A mesh around the origin, on a grid of so many cells to each side."""
    coded = encode_connectivity(mesh.faces, len(mesh.positions))
    values = np.rint(mesh.positions[coded.vertex_order] * (cells / np.abs(mesh.positions).max())) + cells
    return brief(stream_of(gridded(coded, values.astype(np.int32), [len(values)], grid=[2 * cells] * 3, **fields)))


def _with(value: object, beside: dict[int, object] | None = None, behind: bytes = b"") -> bytes:
    """A stream whose header has this for `brief`."""
    entries = dict(sorted(((beside or {}) | {BRIEF: value}).items()))
    return write_preamble(1) + write_frame(FrameType.HEADER, write_map(entries.items())) + behind


def _value() -> bytes:
    """The bytes of a good stream: 4 vertices, 4 faces, a grid, no congruence; floats from byte 6 on."""
    value = header_entries(first_payload(on_grid(tetrahedron(), 40, scale=0.75, center=[1.0, 2.5, -3.0])))[BRIEF]
    assert isinstance(value, bytes) and value[:6] == bytes([4, 4, 80, 80, 80, 0])
    return value


def _put(at: int, data: bytes, over: int | None = None) -> bytes:
    """A good stream with other bytes in a place, instead of as many, or `over` of them."""
    value = _value()
    return _with(value[:at] + data + value[at + (len(data) if over is None else over) :])


def _named(**metadata: MetadataValue) -> bytes:
    """A brief stream with metadata."""
    return brief(on_grid(torus(7, 6), 90), Metadata(metadata))


BRIEFS: dict[str, Good] = {
    f"good-brief-{name}": Good(f"one frame: {probes}", make)
    for name, probes, make in (
        ("plain", "no congruent parts", lambda: on_grid(torus(16, 12), 500, scale=0.125)),
        ("centered", "a center", lambda: on_grid(torus(7, 6), 90, scale=0.1875, center=[2.0, -(2.0**99), 2.0**-149])),
        ("defaults", "a scale and a center that are defaults", lambda: on_grid(torus(7, 6), 9, scale=1.0)),
        ("open", "fewer faces than two a vertex", lambda: on_grid(together(patch(5, 4), triangle()), 60)),
        ("many", "more faces than two a vertex", lambda: on_grid(together(torus(9, 7), tetrahedron()), 60)),
        ("fine", "a grid of 20 bits", lambda: on_grid(torus(9, 7), MOST_GRID // 2)),
        ("echoes", "congruent parts, no transforms", lambda: brief(placed(torus(16, 12), 500, []))),
        ("mirrors", "congruent parts, mirrors", lambda: brief(placed(torus(16, 12), 500, mirrors()))),
        ("whole", "whole vertices", lambda: brief(placed(torus(16, 12), 500, mirrors(), whole=True))),
        ("short", "a payload with a CRC-16", lambda: on_grid(triangle(), 3)),
        ("metadata", "metadata", lambda: _named(author="A. Bee", part=7, unit="mm", weight=0.3)),
        ("metadata-bytes", "metadata that are bytes", lambda: _named(icon=bytes(range(256)), name="")),
    )
}
BRIEFS_BAD: dict[str, Bad] = {
    "bad-brief-text": Bad("a brief header that is a text", "corrupt", lambda: _with("a mesh")),
    "bad-brief-integer": Bad("a brief header that is an integer", "corrupt", lambda: _with(300)),
    "bad-brief-none": Bad("a brief header of no bytes", "corrupt", lambda: _with(b"")),
    "bad-brief-vertices": Bad("no vertices", "corrupt", lambda: _put(0, b"\0")),
    "bad-brief-faces": Bad("too few faces for the vertices", "corrupt", lambda: _put(1, b"\1")),
    "bad-brief-faces-none": Bad("no faces", "corrupt", lambda: _put(1, b"\0")),
    "bad-brief-limit": Bad("more vertices than are granted", "limit", lambda: _put(0, b"\x81\x80\x80\x08" * 2, 2)),
    "bad-brief-grid": Bad("a grid of 21 bits", "corrupt", lambda: _put(3, b"\x80\x80\x40", 1)),
    "bad-brief-varint": Bad("a varint that is not the shortest", "corrupt", lambda: _put(3, b"\xd0\0", 1)),
    "bad-brief-congruence": Bad("beyond all transforms", "corrupt", lambda: _put(5, b"\x45")),
    "bad-brief-scale": Bad("a scale of 0", "corrupt", lambda: _put(6, b"\0\0\0\0")),
    "bad-brief-scale-negative": Bad("a scale below 0", "corrupt", lambda: _put(6, b"\xbf")),
    "bad-brief-infinite": Bad("a center that is not finite", "corrupt", lambda: _put(10, b"\x7f\x80\0\0")),
    "bad-brief-no-number": Bad("a center that is no number", "corrupt", lambda: _put(18, b"\x7f\xc0\0\0")),
    "bad-brief-numbers": Bad("numbers that end early", "corrupt", lambda: _with(_value()[:20])),
    "bad-brief-lengths": Bad("fewer faces than their length", "corrupt", lambda: _put(22, b"\x7f")),
    "bad-brief-cut": Bad("too few bytes of positions", "truncated", lambda: _with(_value()[:-4])),
    "bad-brief-behind": Bad("a frame after it", "corrupt", lambda: _with(_value(), behind=write_frame(8, b""))),
    "bad-brief-next": Bad("another one after it", "corrupt", lambda: _with(_value()) + _with(_value())[5:]),
    "bad-brief-frame": Bad("a wrong checksum", "corrupt", lambda: _with(_value())[:-1] + b"\0"),
    "bad-brief-end": Bad("data that end too early", "truncated", lambda: _with(_value())[:-1]),
    "unsupported-brief-beside": Bad("other fields, too", "unsupported", lambda: _with(_value(), {1: 4, 2: 4})),
    "unsupported-brief-unknown": Bad("a later field, too", "unsupported", lambda: _with(_value(), {27: b"\x80"})),
    "unsupported-brief-metadata-beside": Bad(
        "metadata and a later field", "unsupported", lambda: _with(_value(), {BRIEF_METADATA: b"\x80", 27: 1})
    ),
    "bad-brief-metadata-none": Bad("metadata of no bytes", "corrupt", lambda: _with(_value(), {BRIEF_METADATA: b""})),
    "bad-brief-metadata-text": Bad("metadata as a text", "corrupt", lambda: _with(_value(), {BRIEF_METADATA: "a"})),
    "bad-brief-metadata-map": Bad("a map, not its bytes", "corrupt", lambda: _with(_value(), {BRIEF_METADATA: {}})),
    "bad-brief-metadata-list": Bad(
        "metadata with an array", "corrupt", lambda: _with(_value(), {BRIEF_METADATA: b"\x81\xa1a\x91\x07"})
    ),
    "bad-brief-metadata-keys": Bad(
        "metadata whose names are integers", "corrupt", lambda: _with(_value(), {BRIEF_METADATA: b"\x81\x01\x07"})
    ),
    "bad-brief-metadata-order": Bad(
        "metadata whose names do not ascend",
        "corrupt",
        lambda: _with(_value(), {BRIEF_METADATA: b"\x82\xa1b\x07\xa1a\x07"}),
    ),
    "bad-brief-metadata-behind": Bad(
        "bytes behind metadata", "corrupt", lambda: _with(_value(), {BRIEF_METADATA: b"\x81\xa1a\x07\x07"})
    ),
}
