"""What the frames of a sequence cost; see `codec.static.work`."""

from __future__ import annotations

from bsm.bitstream.container.gop import GopBody, GopMethod
from bsm.codec.basis.cost import solve_cost
from bsm.codec.basis.solver.fronts import Fronts
from bsm.codec.sequence.dictionaries import Site
from bsm.codec.sequence.gop import BATCH
from bsm.codec.static.work import LEVEL

FRAME, SHOWN = 2.5e4, 11.0
"""Of a frame, and of a vertex in it."""
PART = 6e4
"""Of a part in a GOP, whatever its size."""
LOOP = 40.0
"""Of a column in a row of a closed loop."""


def gop_memory(vertices: int, body: GopBody) -> float:
    """Bytes for decoding a GOP, besides those of one part after the other: levels, components, a few frames."""
    shown = 48.0 * min(body.frames, BATCH) + 96.0
    basis = body.components * (120.0 * body.frames + 24.0 * body.components)
    return vertices * (12.0 * body.components + shown) + basis


def loop_memory(rows: int, body: GopBody) -> float:
    """Bytes for a part of so many vertices: its levels and coefficients in the loop, and what becomes of them."""
    return 48.0 * rows * body.components


def gop_cost(sites: tuple[Site, ...], vertices: int, body: GopBody) -> float:
    """Work of the levels, loops and fields of a GOP, and of its frames."""
    columns, frames = body.components, body.frames
    fields = sum(_part_cost(site.fronts, site.width, columns) for site in sites)
    basis = frames * columns * (30.0 + 6.0 * columns) if body.method is GopMethod.LEARNT else 0.0
    shown = frames * (FRAME + vertices * (SHOWN + 0.2 * columns))
    return PART * len(sites) + fields + basis + shown


def _part_cost(fronts: Fronts, width: int, columns: int) -> float:
    rows = len(fronts.rows)
    loop = float(width * columns) * (LEVEL + LOOP)
    return loop + solve_cost(fronts, columns) + rows * (width * (1.0 + 0.1 * columns) + 20.0 * columns)
