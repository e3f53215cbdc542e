"""Streams with positions on a grid by the small model that every decoder must refuse."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

from bsm.bitstream.container.wire import FrameType
from bsm.codec.static.encoder import encode
from tools.surgery import frames_of, stream_of, with_header, with_payload
from tools.vectors.bad import Bad
from tools.vectors.good import BASE
from tools.vectors.good_light import drawn, light
from tools.vectors.meshes import torus

GRID = FrameType.GRID


@cache
def _light() -> bytes:
    return light(torus(8, 7), 30, 26)


@cache
def _noise() -> bytes:
    return drawn(torus(8, 7).faces, (250, 250, 250))


def _payload(change: Callable[[bytes], bytes], which: int = 0, make: Callable[[], bytes] = _light) -> bytes:
    """With other bytes in a GRID."""
    payloads = [payload for kind, payload in frames_of(make()) if kind == GRID]
    return with_payload(make(), GRID, change(payloads[which]), which)


def _grids(change: Callable[[list[tuple[int, bytes]]], list[tuple[int, bytes]]]) -> bytes:
    """With other GRIDs behind what stands before them."""
    frames = frames_of(_light())
    grids = [frame for frame in frames if frame[0] == GRID]
    return stream_of([*(frame for frame in frames if frame[0] != GRID), *change(grids)])


BAD_LIGHT: dict[str, Bad] = {
    "bad-light-blocks": Bad(
        "the small model without a grid", "corrupt", lambda: with_header(encode(torus(8, 7), BASE), light=1)
    ),
    "bad-light-no-grid": Bad(
        "the small model where `grid` is missing", "corrupt", lambda: with_header(_light(), grid=None)
    ),
    "bad-light-default": Bad("`light` stored though it is 0", "corrupt", lambda: with_header(_light(), light=0)),
    "bad-light-256": Bad("`light` above what a method may be", "corrupt", lambda: with_header(_light(), light=256)),
    "unsupported-light": Bad("a model that is not known", "unsupported", lambda: with_header(_light(), light=3)),
    "unsupported-light-blocks": Bad(
        "a model that is not known, and no grid", "unsupported", lambda: with_header(_light(), light=255, grid=None)
    ),
    "bad-light-outside": Bad(
        "values above the largest", "corrupt", lambda: with_header(_noise(), grid=[250, 200, 250])
    ),
    "bad-light-outside-point": Bad(
        "values above the largest, which is 0", "corrupt", lambda: with_header(_noise(), grid=[250, 250, 0])
    ),
    "bad-light-missing": Bad("the second frame is missing", "corrupt", lambda: _grids(lambda grids: grids[:1])),
    "bad-light-gap": Bad("the first frame is missing", "corrupt", lambda: _grids(lambda grids: grids[1:])),
    "bad-light-descending": Bad("frames out of order", "corrupt", lambda: _grids(lambda grids: grids[::-1])),
    "bad-light-again": Bad("the first frame twice", "corrupt", lambda: _grids(lambda grids: [grids[0], *grids])),
    "bad-light-empty-frame": Bad(
        "a frame of no vertices", "corrupt", lambda: _payload(lambda payload: b"\0\0" + payload[2:])
    ),
    "bad-light-short": Bad("a frame that ends early", "truncated", lambda: _payload(lambda payload: payload[:-9])),
    "bad-light-nothing": Bad(
        "a frame that holds nothing", "truncated", lambda: _payload(lambda payload: payload[:2], make=_noise)
    ),
    "bad-light-long": Bad(
        "bytes behind the last vertex", "corrupt", lambda: _payload(lambda payload: payload + bytes(9), 1)
    ),
    "bad-light-ones": Bad(
        "four bytes of 255 at the beginning of a frame",
        "corrupt",
        lambda: _payload(lambda payload: payload[:2] + b"\xff" * 4 + payload[6:], 1),
    ),
}
