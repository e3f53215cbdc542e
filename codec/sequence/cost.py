"""What the frames of a sequence cost; see `codec.static.work`."""

from __future__ import annotations

from bitstream.container.gop import GopBody, GopMethod
from codec.basis.cost import solve_cost
from codec.sequence.dictionaries import Part
from codec.sequence.gop import Setting
from codec.static.work import LEVEL

FRAME, SHOWN = 3e4, 20.0
"""Of a frame, and of a vertex in it."""
PART = 1.5e5
"""Of a part in a GOP, whatever its size."""
LOOP = 40.0
"""Of a column in a row of a closed loop."""


def gop_memory(vertices: int, body: GopBody) -> float:
    """Bytes for decoding a GOP."""
    cosines = 8.0 * (3 * body.frames) ** 2 if body.method is GopMethod.COSINES else 0.0
    return 16.0 * body.components * (vertices + 3 * body.frames) + cosines


def gop_cost(setting: Setting, body: GopBody) -> float:
    """Of the levels, loops and fields of a GOP, and of its frames."""
    columns, frames = body.components, body.frames
    fields = sum(_part_cost(part, columns) for part in setting.parts)
    cosines = 10.0 * (3 * frames) ** 2 if body.method <= GopMethod.COSINES else 0.0
    shown = frames * (FRAME + setting.vertices * (SHOWN + 0.3 * columns))
    return PART * len(setting.parts) + fields + cosines + shown


def _part_cost(part: Part, columns: int) -> float:
    rows, width = len(part.basis), part.basis.shape[1]
    loop = float(width * columns) * (LEVEL + LOOP)
    return float(loop + solve_cost(part.held.laplacian.fronts, columns) + columns * rows * (0.1 * width + 20.0))
