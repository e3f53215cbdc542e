"""Streams with floats in the cells of a grid: positions to the bit."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np

from bsm.bitstream.container.wire import FrameType
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.static.encoder import encode
from bsm.codec.static.options import EncodeOptions
from tools.vectors.good import Good
from tools.vectors.good_attributes import charts, colors, creases, with_attributes
from tools.vectors.good_fields import soup
from tools.vectors.meshes import shuffled, torus, triangle

GRID = FrameType.GRID


def lossless(mesh: TriangleMesh, *, keep_order: bool = False) -> bytes:
    """Positions to the bit."""
    return encode(mesh, EncodeOptions(exact=True, keep_order=keep_order, attributes={"*": "exact"}))


def _moved(mesh: TriangleMesh, scale: float, offset: float = 0.0) -> TriangleMesh:
    return replace(mesh, positions=mesh.positions * scale + offset)


def _round() -> TriangleMesh:
    """Coordinates that many vertices share, zeros of both signs among them."""
    mesh = torus(12, 9)
    positions = np.round(mesh.positions, 1)
    positions[::3, 2], positions[1::3, 2] = -0.0, 0.0
    return replace(mesh, positions=positions)


@cache
def _stream() -> bytes:
    return lossless(torus(8, 7))


EXACT: dict[str, Good] = {
    "good-exact": Good("floats to the bit", lambda: lossless(torus(12, 9))),
    "good-exact-round": Good("floats that are met again, and zeros of both signs", lambda: lossless(_round())),
    "good-exact-far": Good(
        "floats far from the origin, few in a cell", lambda: lossless(_moved(torus(9, 8), 50.0, 1e7))
    ),
    "good-exact-tiny": Good("floats that are not normal", lambda: lossless(_moved(torus(9, 8), 1e-41))),
    "good-exact-huge": Good("floats up to the greatest", lambda: lossless(_moved(torus(9, 8), 2e38))),
    "good-exact-triangle": Good("three vertices", lambda: lossless(triangle())),
    "good-exact-splits": Good("ORDER, with copies", lambda: lossless(soup(shuffled(torus(7, 6))), keep_order=True)),
    "good-exact-attributes": Good(
        "attributes that lean on the grid, exact",
        lambda: lossless(with_attributes(torus(10, 8), charts, creases, colors)),
    ),
}
