"""Streams with grids, refinement or given vertices that every decoder must refuse."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np

from bsm.bitstream.container.wire import FrameType, write_varint
from bsm.codec.static.encoder import encode
from bsm.codec.static.options import EncodeOptions
from tools.surgery import frames_of, stream_of, with_header, with_payload
from tools.vectors.bad import Bad
from tools.vectors.good import BASE
from tools.vectors.good_fields import LAYER, on_grid, refined, soup
from tools.vectors.meshes import torus

GRID, REFINEMENT, ORDER, BLOCK = FrameType.GRID, FrameType.REFINEMENT, FrameType.ORDER, FrameType.BLOCK


@cache
def _grid() -> bytes:
    return on_grid(torus(8, 7), counts=(30, 26))


@cache
def _refined() -> bytes:
    return refined(torus(8, 7), LAYER, (30, 26))


@cache
def _split() -> bytes:
    return encode(soup(torus(6, 5)), EncodeOptions(grid=8, keep_order=True))


def _frame(make: Callable[[], bytes], kind: int, change: Callable[[bytes], bytes], which: int = 0) -> bytes:
    """With another payload in frame number `which` of a type."""
    stream = make()
    payload = [payload for type_, payload in frames_of(stream) if type_ == kind][which]
    return with_payload(stream, FrameType(kind), change(payload), which)


def _without(make: Callable[[], bytes], kind: int, which: int) -> bytes:
    frames = frames_of(make())
    place = [i for i, frame in enumerate(frames) if frame[0] == kind][which]
    return stream_of(frames[:place] + frames[place + 1 :])


def _order(
    probes: str, change: Callable[[bytes], bytes], error: str = "corrupt", make: Callable[[], bytes] = _split
) -> Bad:
    """With other data in ORDER."""
    return Bad(probes, error, lambda: _frame(make, ORDER, change))


def _loose() -> bytes:
    """With a vertex in no face."""
    mesh = torus(6, 5)
    return encode(
        replace(mesh, positions=np.concatenate([mesh.positions, [[2.0, 3.0, 4.0]]])),
        EncodeOptions(grid=8, keep_order=True),
    )


def _with_block() -> bytes:
    blocks = [frame for frame in frames_of(_refined()) if frame[0] == BLOCK]
    return stream_of([*frames_of(_grid()), blocks[0]])


BAD_FIELDS: dict[str, Bad] = {
    "unsupported-grid": Bad(
        "GRID where `grid` is empty",
        "unsupported",
        lambda: stream_of([*frames_of(encode(torus(8, 7), BASE))[:2], (GRID, b"\0\1\0")]),
    ),
    "bad-grid-missing": Bad("the second chunk of a grid is missing", "corrupt", lambda: _without(_grid, GRID, 1)),
    "bad-grid-gap": Bad("the first chunk of a grid is missing", "corrupt", lambda: _without(_grid, GRID, 0)),
    "bad-grid-empty-chunk": Bad(
        "a chunk of no vertices", "corrupt", lambda: _frame(_grid, GRID, lambda p: b"\0\0" + p[2:])
    ),
    "bad-grid-too-many": Bad(
        "more vertices than there are", "corrupt", lambda: _frame(_grid, GRID, lambda p: p[:1] + b"\x7f" + p[2:])
    ),
    "bad-grid-outside": Bad("values above the largest", "corrupt", lambda: with_header(_grid(), grid=[3, 255, 255])),
    "bad-grid-short": Bad("a chunk that ends early", "truncated", lambda: _frame(_grid, GRID, lambda p: p[:6])),
    "bad-grid-long": Bad(
        "bytes behind the last vertex", "corrupt", lambda: _frame(_grid, GRID, lambda p: p + bytes(9))
    ),
    "bad-grid-block": Bad("BLOCK behind a grid", "corrupt", _with_block),
    "bad-grid-and-blocks": Bad("a grid, and blocks", "corrupt", lambda: with_header(_grid(), blocks=1)),
    "bad-grid-two-axes": Bad("a grid of two axes", "corrupt", lambda: with_header(_grid(), grid=[255, 255])),
    "bad-lattice-points": Bad(
        "a lattice of fewer points than values", "corrupt", lambda: with_header(_grid(), lattice=[1000, 100])
    ),
    "bad-lattice-cells": Bad(
        "a lattice of more points than cells", "corrupt", lambda: with_header(_grid(), lattice=[300, 400])
    ),
    "bad-corner-two": Bad("a corner of two axes", "corrupt", lambda: with_header(_grid(), center=None, corner=[1, 2])),
    "bad-corner-center": Bad("a corner and a center", "corrupt", lambda: with_header(_grid(), corner=[1, 2, 3])),
    "bad-corner-blocks": Bad("a corner of blocks", "corrupt", lambda: with_header(_refined(), corner=[1, 2, 3])),
    "bad-no-blocks-no-grid": Bad("neither blocks nor a grid", "corrupt", lambda: with_header(_grid(), grid=None)),
    "unsupported-refinement": Bad(
        "REFINEMENT where `refinement` is empty", "unsupported", lambda: with_header(_refined(), refinement=None)
    ),
    "bad-refinement-gap": Bad(
        "the first chunk of a layer is missing", "corrupt", lambda: _without(_refined, REFINEMENT, 0)
    ),
    "bad-refinement-short": Bad(
        "levels that end early", "truncated", lambda: _frame(_refined, REFINEMENT, lambda p: p[:5])
    ),
    "bad-refinement-step": Bad("a step above 1", "corrupt", lambda: with_header(_refined(), refinement=[1.5, 3.0])),
    "bad-refinement-ratio": Bad(
        "a ratio below 1/16", "corrupt", lambda: with_header(_refined(), refinement=[0.1, 0.06])
    ),
    "bad-refinement-ratio-large": Bad(
        "a ratio above 64", "corrupt", lambda: with_header(_refined(), refinement=[0.1, 64.5])
    ),
    "bad-center-far": Bad(
        "a center out of range", "corrupt", lambda: with_header(_grid(), center=[0.0, 1.01e300, 0.0])
    ),
    "bad-refinement-odd": Bad("a step without a ratio", "corrupt", lambda: with_header(_refined(), refinement=[0.1])),
    "bad-refinement-two": Bad(
        "two layers", "corrupt", lambda: with_header(_refined(), refinement=[0.1, 3.0, 0.1, 3.0])
    ),
    "bad-paper-grid": Bad("a grid, and packed coefficients", "corrupt", lambda: with_header(_grid(), bits=12)),
    "bad-refinement-early": Bad(
        "REFINEMENT before the last BLOCK", "corrupt", lambda: stream_of(_early(frames_of(_refined())))
    ),
    "bad-splits-count": _order("one copy fewer than there are", lambda p: write_varint(149) + p[2:]),
    "bad-splits-many": _order("more copies than corners", lambda p: write_varint(151) + p[2:]),
    "bad-splits-many-loose": _order(
        "more given vertices than may be numbered", lambda p: p[:2] + write_varint((1 << 24) - 180)
    ),
    "bad-splits-short": _order("kinds of given vertices that are cut", lambda p: p[:-2], "truncated"),
    "bad-splits-long": _order("bytes behind the last corner", lambda p: p + bytes(9)),
    "bad-splits-none": _order("copies that are not announced", lambda p: bytes(2) + p[3:]),
    "bad-splits-cut": _order("positions of loose vertices that are not there", lambda p: p[:20], make=_loose),
    "bad-splits-nan": _order(
        "a loose vertex that is not finite", lambda p: p[:2] + b"\0\0\0\0\0\0\xf8\x7f" + p[10:], make=_loose
    ),
}


def _early(frames: list[tuple[int, bytes]]) -> list[tuple[int, bytes]]:
    block = max(i for i, frame in enumerate(frames) if frame[0] == BLOCK)
    return [*frames[:block], frames[block + 1], frames[block], *frames[block + 2 :]]
