"""What the frames of a sequence cost; see `codec.static.work`."""

from __future__ import annotations

from collections.abc import Iterator

from bsm.bitstream.container.gop import GopBody, GopMethod
from bsm.codec.basis.cost import solve_cost
from bsm.codec.sequence.dictionaries import Site
from bsm.codec.sequence.history import INHERITED
from bsm.codec.sequence.shown import BATCH
from bsm.codec.sequence.tracks import LEAST_KEPT, frames_kept, lags
from bsm.codec.static.work import LEVEL

FRAME, SHOWN = 2.5e4, 11.0 / 3.0
"""Of a field of a frame, and of a number of a vertex in it."""
PART, ANOTHER = 6e4, 2.5e4
"""Of a part in a GOP, whatever its size, and of another field there."""
LOOP, AROUND = 66.0, 10.0
"""Of a column in a row of a closed loop, and of a vertex around that it begins with."""
INHERITED_LOOP, INHERITED_AROUND = 90.0, 10.0
"""What these cost more where components of the GOP before are known."""
REFERRED = 1.1
"""Of two columns that are known of low-delay frames, in a row, and of a vertex around."""


def gop_memory(vertices: int, body: GopBody, sites: tuple[Site, ...] = ()) -> float:
    """Bytes for decoding a GOP, besides those of one part after the other: levels, components, a few frames."""
    width = sum(field.width for field in body.fields)
    shown = (16.0 * min(body.frames, BATCH) + 32.0) * width
    bases = (field.components * (40.0 * field.width * body.frames + 24.0 * field.components) for field in body.fields)
    around = sum(len(site.around) for site in sites)
    if body.method.has_basis:
        needed = INHERITED if body.method is GopMethod.LEARNT_NEXT else 0
        kept = sum(min(field.components, INHERITED) + needed for field in body.fields)
        left = 8.0 * kept * (vertices + around)
    else:
        frames = 24.0 * frames_kept(vertices) * (vertices + around)
        left = frames + width * (4.0 * body.frames * vertices + 8.0 * (body.frames + 4.0) * around)
    return vertices * (12.0 * _columns(body) + shown) + sum(bases) + left


def loop_memory(rows: int, body: GopBody) -> float:
    """Bytes for a part of so many vertices: its levels and coefficients in the loop, and what becomes of them."""
    return 48.0 * rows * _columns(body)


def gop_cost(sites: tuple[Site, ...], vertices: int, given: int, body: GopBody) -> float:
    """Work of the levels, loops and fields of a GOP, and of its frames, whose user knows so many vertices as given."""
    frames = body.frames
    more = body.method is GopMethod.LEARNT_NEXT
    loop, around = (LOOP + INHERITED_LOOP, AROUND + INHERITED_AROUND) if more else (LOOP, AROUND)
    others = sum(not body.method.has_basis or field.components > 0 for field in body.fields[1:])
    fields = sum(_part_cost(site, _columns(body), loop, around) for site in sites)
    work = (PART + ANOTHER * others) * len(sites) + fields + frames * FRAME * len(body.fields)
    if not body.method.has_basis:
        rows = sum(site.width + len(site.around) for site in sites)
        work += REFERRED * rows * sum(count**2 for count in _known(vertices, body))
    for field in body.fields:
        width, columns = field.width, field.components
        basis = frames * width * columns * (10.0 + 2.0 * columns) if body.method.has_basis else 0.0
        work += basis + frames * width * (given * SHOWN + vertices * columns / 15.0)
    return work


def _known(vertices: int, body: GopBody) -> Iterator[int]:
    for number, field in enumerate(body.fields):
        kept = LEAST_KEPT if number else frames_kept(vertices)
        yield field.width * (2 + (1 if field.brief else len(lags(kept))) + (field.back > 0))


def _columns(body: GopBody) -> int:
    if body.method.has_basis:
        return sum(field.components for field in body.fields)
    return sum(field.width * body.frames for field in body.fields)


def _part_cost(site: Site, columns: int, loop: float, around: float) -> float:
    rows, width = len(site.vertices), site.width
    loops = columns * (width * (LEVEL + loop) + len(site.around) * around)
    return loops + solve_cost(site.fronts, columns) + rows * (width * (1.0 + 0.1 * columns) + 20.0 * columns)
