"""Streams with grids whose axes are turned to those of the mesh."""

import struct
from typing import Any

from bsm.bitstream.connectivity.faces import encode_connectivity
from bsm.bitstream.container.header import MOST_GRID
from bsm.bitstream.container.packets import BRIEF_TURNED
from bsm.bitstream.container.wire import FrameType, write_frame, write_map, write_preamble
from bsm.codec.static.encoder import encode
from tools.gridded import gridded
from tools.surgery import first_payload, header_entries, stream_of, with_header, with_payload
from tools.vectors.bounds import Bad
from tools.vectors.good import Good
from tools.vectors.good_attributes import charts, colors, creases, with_attributes
from tools.vectors.good_brief import brief
from tools.vectors.good_congruence import Ints, about, drawn, mirrors, placed
from tools.vectors.meshes import tangled, torus

TURN = [0.25, -0.5, 0.125]
DOUBLES: dict[str, Any] = {"turn": [0.1, -1.0 / 3.0, 0.7], "scale": 0.1, "center": [1.1, -2e6, 1e-9]}


def _turned(*counts: int, **fields: Any) -> bytes:
    """A torus on a grid whose axes are turned."""
    mesh = torus(16, 12)
    coded = encode_connectivity(mesh.faces, len(mesh.positions))
    values: Ints = (mesh.positions[coded.vertex_order] * 100.0).round().astype("int32") + 500
    given: dict[str, Any] = {"grid": [1000] * 3, "turn": TURN} | fields
    return stream_of(gridded(coded, values, counts or [len(values)], None, **given))


def _brief(turn: list[float]) -> bytes:
    """A brief stream with a turn, which may be none."""
    value = header_entries(first_payload(brief(_turned(center=[1.0, 2.5, -3.0], scale=0.75))))[BRIEF_TURNED]
    at = value.index(struct.pack(">4f", 0.75, 1.0, 2.5, -3.0)) + 16
    return _of({BRIEF_TURNED: value[:at] + struct.pack(">3f", *turn) + value[at + 12 :]})


def _of(entries: dict[int, object]) -> bytes:
    return write_preamble(1) + write_frame(FrameType.HEADER, write_map(sorted(entries.items())))


def _not_finite(stream: bytes) -> bytes:
    """A stream whose turn has an infinite entry."""
    payload = first_payload(stream).replace(struct.pack(">f", 0.25), struct.pack(">f", float("inf")))
    return with_payload(stream, FrameType.HEADER, payload)


def _shaded() -> bytes:
    """Attributes, and normals that a decoder makes, of a grid that is turned afterwards."""
    stream = encode(with_attributes(torus(24, 20), charts, creases, colors))
    return with_header(stream, turn=TURN)


TURNS: dict[str, Good] = {
    f"good-{name}": Good(f"a turned grid: {probes}", make)
    for name, probes, make in (
        ("turn-plain", "floats", lambda: _turned(scale=0.125, center=[2.0, -30.0, 0.5])),
        ("turn-doubles", "doubles", lambda: _turned(**DOUBLES)),
        ("turn-once", "about one axis, little", lambda: _turned(turn=[0.0, 0.0, -(2.0**-149)])),
        ("turn-most", "the largest entries", lambda: _turned(turn=[1.0, -1.0, 1.0])),
        ("turn-chunks", "frames", lambda: _turned(1, 90, 101, **DOUBLES)),
        (
            "turn-lattice",
            "of counted cells",
            lambda: _turned(lattice=[4321, 1000], corner=[-7, 0, 2**31 - 1], scale=0.1),
        ),
        ("turn-ends", "ends of the range", lambda: with_header(drawn(tangled(), (MOST_GRID,) * 3, 9, True), **DOUBLES)),
        (
            "turn-congruence",
            "congruent parts",
            lambda: placed(torus(15, 12), 700, [about(2, 5), *mirrors()], **DOUBLES),
        ),
        ("turn-attributes", "attributes, whose directions stay as they are", _shaded),
        ("brief-turned", "in one frame", lambda: _brief(TURN)),
        ("brief-turned-not", "by nothing, in one frame", lambda: _brief([0.0] * 3)),
        (
            "brief-turned-congruence",
            "congruent parts, in one frame",
            lambda: brief(placed(torus(15, 12), 700, mirrors(), turn=TURN)),
        ),
    )
}
TURNS_BAD: dict[str, Bad] = {
    "bad-turn-none": Bad(
        "a turn by nothing, which is the default", "corrupt", lambda: with_header(_turned(), turn=[0.0] * 3)
    ),
    "bad-turn-short": Bad("a turn of two numbers", "corrupt", lambda: with_header(_turned(), turn=TURN[:2])),
    "bad-turn-long": Bad("a turn of four numbers", "corrupt", lambda: with_header(_turned(), turn=[*TURN, 0.5])),
    "bad-turn-integers": Bad("a turn of integers", "corrupt", lambda: with_header(_turned(), turn=[1, 0, 0])),
    "bad-turn-number": Bad("a turn that is a number", "corrupt", lambda: with_header(_turned(), turn=0.5)),
    "bad-turn-more": Bad("an entry above 1", "corrupt", lambda: _turned(turn=[0.0, 1.0 + 2.0**-23, 0.0])),
    "bad-turn-less": Bad("an entry below -1", "corrupt", lambda: _turned(turn=[0.0, 0.0, -1.0 - 2.0**-52])),
    "bad-turn-infinite": Bad("an infinite entry", "corrupt", lambda: _not_finite(_turned())),
    "bad-turn-light": Bad("a turn of a light grid", "corrupt", lambda: with_header(_turned(), light=1)),
    "bad-turn-exact": Bad("a turn of exact floats", "corrupt", lambda: with_header(_turned(), light=2)),
    "bad-turn-blocks": Bad("a turn without a grid", "corrupt", lambda: with_header(_turned(), grid=None)),
    "bad-turn-overflow": Bad(
        "positions that are finite until they are turned",
        "numeric",
        lambda: _turned(turn=[1.0] * 3, scale=1e300, corner=[150_000_000, -150_000_000, 150_000_000]),
    ),
    "bad-brief-turned-more": Bad("an entry above 1, in one frame", "corrupt", lambda: _brief([0.0, 1.5, 0.0])),
    "bad-brief-turned-no-number": Bad("an entry that is NaN", "corrupt", lambda: _brief([float("nan"), 0.0, 0.0])),
    "bad-brief-turned-short": Bad(
        "a turn that ends early",
        "corrupt",
        lambda: _of({BRIEF_TURNED: bytes([4, 4, 80, 80, 80, 0]) + struct.pack(">6f", 1, 0, 0, 0, 0, 0)}),
    ),
    "bad-brief-turned-text": Bad(
        "a brief header with a turn that is a text", "corrupt", lambda: _of({BRIEF_TURNED: "a mesh"})
    ),
    "unsupported-brief-turned-beside": Bad(
        "other fields, too", "unsupported", lambda: _of({1: 4, 2: 4, BRIEF_TURNED: b"\4"})
    ),
}
