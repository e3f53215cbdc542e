"""Streams with grids that are predicted from congruent parts: of meshes that have some, and of noise."""

from collections.abc import Callable
from functools import partial
from random import Random
from typing import Any

import numpy as np
import numpy.typing as npt

from bsm.bitstream.connectivity.faces import encode_connectivity
from bsm.bitstream.container.header import MOST_GRID
from bsm.bitstream.container.wire import VERSION
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.static.choice.congruence import coded_transforms
from bsm.codec.static.encoder import encode
from bsm.codec.static.options import EncodeOptions
from tools.gridded import any_transforms, gridded
from tools.surgery import frames_of, stream_of, with_header
from tools.vectors.bounds import Bad
from tools.vectors.good import Good
from tools.vectors.good_attributes import charts, colors, creases, groups, with_attributes
from tools.vectors.meshes import hub, patch, tangled, tent, tetrahedron, together, torus, triangle

Ints = npt.NDArray[np.int32]


def placed(mesh: TriangleMesh, cells: int, turns: npt.ArrayLike, *counts: int, **fields: Any) -> bytes:
    """A mesh around the origin on a grid of so many cells to each side, and turns about the middle."""
    coded = encode_connectivity(mesh.faces, len(mesh.positions))
    unit = cells / np.abs(mesh.positions).max()
    values = np.rint(mesh.positions[coded.vertex_order] * unit).astype(np.int32) + cells
    given = np.asarray(turns, float).reshape(-1, 3, 3)
    shifts = cells - given.sum(axis=2) * cells
    rows = coded_transforms(given, shifts, [2 * cells] * 3)
    sizes = counts or (len(values),)
    return stream_of(gridded(coded, values, sizes, rows, **{"grid": [2 * cells] * 3} | fields))


def drawn(mesh: TriangleMesh, largest: tuple[int, int, int], count: int, ends: bool = False, **fields: Any) -> bytes:
    """Values and transforms that have nothing to do with each other."""
    numbers, size = np.random.default_rng(count), len(mesh.positions)
    values = numbers.integers(0, np.array(largest) + 1, (size, 3))
    values = np.where(values * 2 > largest, largest, 0) if ends else values
    coded = encode_connectivity(mesh.faces, size)
    rows = any_transforms(Random(count), count, largest)
    return stream_of(gridded(coded, values.astype(np.int32), [size], rows, grid=list(largest), **fields))


def about(axis: int, parts: int) -> npt.NDArray[np.float64]:
    """A turn about an axis by a part of the circle."""
    angle, (i, j) = 2.0 * np.pi / parts, ((1, 2), (2, 0), (0, 1))[axis]
    turn = np.eye(3)
    turn[i, i] = turn[j, j] = np.cos(angle)
    turn[j, i], turn[i, j] = np.sin(angle), -np.sin(angle)
    return turn


def mirrors() -> npt.NDArray[np.float64]:
    """Mirrors along each axis."""
    return np.array([np.diag([-1.0, 1.0, 1.0]), np.diag([1.0, -1.0, 1.0]), np.diag([1.0, 1.0, -1.0])])


def _staying(count: int) -> bytes:
    """Everything at one place, and turns that leave it there."""
    mesh = torus(12, 10)
    coded = encode_connectivity(mesh.faces, 120)
    rows = np.array([[48, 0, *[1 << 3] * 3, *[12] * 3]] * count, np.int32)
    return stream_of(gridded(coded, np.zeros((120, 3), np.int32), [120], rows, grid=[1, 1, 1]))


def _changed(**fields: Any) -> bytes:
    """Another header before a grid without transforms."""
    coded = encode_connectivity(torus(5, 4).faces, 20)
    return with_header(stream_of(gridded(coded, np.zeros((20, 3), np.int32), [20], grid=[1, 1, 1])), **fields)


def _minor_0(make: Callable[[], bytes]) -> bytes:
    """A stream whose minor version is too small, which is no reason to refuse it (F 2.2)."""
    return stream_of(frames_of(make()), VERSION)


CONGRUENCE: dict[str, Good] = {
    "good-congruence-attributes": Good(
        "congruent parts: attributes that lean on the grid",
        lambda: encode(with_attributes(torus(24, 20), charts, creases, colors, groups), EncodeOptions(keep_order=True)),
    )
} | {
    f"good-congruence-{name}{later}": Good(f"congruent parts{of}: {probes}", make if later else partial(_minor_0, make))
    for later, of in (("", ""), ("-later", " in a stream of 1.1"))
    for name, probes, make in (
        ("echoes", "flaps alike, no transforms", lambda: placed(torus(16, 12), 500, [])),
        ("mirrors", "mirrors along the axes", lambda: placed(torus(16, 12), 500, mirrors())),
        (
            "turned",
            "turns about an axis, with inverses",
            lambda: placed(torus(15, 12), 700, [about(2, 5), about(2, 3)]),
        ),
        ("turned-mirror", "a turned mirror", lambda: placed(torus(15, 12), 700, [about(2, 5) @ mirrors()[0]])),
        ("half", "a turn that is its own inverse", lambda: placed(torus(16, 12), 300, [about(1, 2) @ about(0, 2)])),
        ("fine", "a grid of 20 bits", lambda: placed(torus(15, 8), MOST_GRID // 2, [about(2, 5), *mirrors()])),
        ("coarse", "many vertices in a cell", lambda: placed(torus(40, 30), 12, [about(2, 4), *mirrors()])),
        ("chunks", "frames", lambda: placed(torus(16, 12), 500, [*mirrors(), about(2, 8)], 1, 90, 101)),
        ("noise", "16 transforms without sense", lambda: drawn(torus(12, 10), (1000, 3, MOST_GRID), 16)),
        ("ends", "ends of the range", lambda: drawn(tangled(), (MOST_GRID,) * 3, 9, ends=True)),
        ("hub", "a vertex with very many neighbors", lambda: drawn(hub(), (99, 999, 9), 5)),
        ("tent", "more neighbors and flaps than count", lambda: drawn(tent(), (255, 255, 255), 7)),
        ("point", "a grid of one place", lambda: drawn(tetrahedron(), (0, 0, 0), 4)),
        ("staying", "16 transforms that move nothing", lambda: _staying(16)),
        ("components", "parts", lambda: placed(together(*[torus(7, 6)] * 3, patch(4, 4), triangle()), 200, mirrors())),
        ("long", "more flaps than are remembered", lambda: placed(torus(64, 48), 300, [about(2, 16)])),
    )
}
CONGRUENCE |= {
    f"good-congruence-whole-{name}": Good(f"congruent parts, whole vertices: {probes}", make)
    for name, probes, make in (
        ("echoes", "flaps alike, no transforms", lambda: placed(torus(16, 12), 500, [], whole=True)),
        ("mirrors", "mirrors along the axes", lambda: placed(torus(16, 12), 500, mirrors(), whole=True)),
        ("turned", "turns about an axis", lambda: placed(torus(15, 12), 700, [about(2, 5)], whole=True)),
        ("chunks", "frames", lambda: placed(torus(16, 12), 500, mirrors(), 1, 90, 101, whole=True)),
        ("noise", "16 transforms without sense", lambda: drawn(torus(12, 10), (1000, 3, MOST_GRID), 16, whole=True)),
        ("ends", "ends of the range", lambda: drawn(tangled(), (MOST_GRID,) * 3, 9, True, whole=True)),
        ("hub", "a vertex with very many neighbors", lambda: drawn(hub(), (99, 999, 9), 5, whole=True)),
        ("tent", "more neighbors and flaps than count", lambda: drawn(tent(), (255, 255, 255), 7, whole=True)),
        ("point", "a grid of one place", lambda: drawn(tetrahedron(), (0, 0, 0), 4, whole=True)),
        ("long", "more flaps than are remembered", lambda: placed(torus(64, 48), 300, [about(2, 16)], whole=True)),
        ("turn", "turned axes", lambda: placed(torus(15, 12), 700, mirrors(), whole=True, turn=[0.25, -0.5, 0.125])),
    )
}
CONGRUENCE |= {
    f"good-congruence-light-{name}": Good(f"congruent parts, light: {probes}", make)
    for name, probes, make in (
        ("none", "no transforms", lambda: placed(torus(16, 12), 500, [], light=1)),
        ("mirrors", "mirrors along the axes", lambda: placed(torus(16, 12), 500, mirrors(), light=1)),
        ("turned", "turns, whole vertices", lambda: placed(torus(15, 12), 700, [about(2, 5)], light=1, whole=True)),
        ("chunks", "frames", lambda: placed(torus(16, 12), 500, mirrors(), 1, 90, 101, light=1, whole=True)),
        ("noise", "16 transforms without sense", lambda: drawn(torus(12, 10), (1000, 3, MOST_GRID), 16, light=1)),
        ("ends", "ends of the range", lambda: drawn(tangled(), (MOST_GRID,) * 3, 9, True, light=1, whole=True)),
        ("hub", "a vertex with very many neighbors", lambda: drawn(hub(), (99, 999, 9), 5, light=1, whole=True)),
        ("tent", "more neighbors and flaps than count", lambda: drawn(tent(), (255, 255, 255), 7, light=1)),
        ("point", "a grid of one place", lambda: drawn(tetrahedron(), (0, 0, 0), 4, light=1, whole=True)),
        ("coarse", "many vertices in a cell", lambda: placed(torus(40, 30), 12, [about(2, 4), *mirrors()], light=1)),
    )
}
CONGRUENCE_BAD: dict[str, Bad] = {
    "bad-congruence-light-short": Bad(
        "a light grid, 16 transforms, in a payload without", "truncated", lambda: _changed(light=1, congruence=51)
    ),
    "bad-congruence-light-not": Bad(
        "congruent parts of a light grid that the header does not have",
        "corrupt",
        lambda: with_header(drawn(torus(12, 10), (1000, 3, MOST_GRID), 16, light=1), congruence=None),
    ),
    "bad-congruence-blocks": Bad(
        "congruent parts without a grid", "corrupt", lambda: _changed(grid=None, congruence=35)
    ),
    "bad-congruence-more": Bad("beyond all transforms", "corrupt", lambda: _changed(congruence=69)),
    "bad-congruence-none": Bad("a default that is stored", "corrupt", lambda: _changed(congruence=0)),
    "unsupported-congruence-draft": Bad("1 transform of a draft", "unsupported", lambda: _changed(congruence=2)),
    "unsupported-congruence-draft-learnt": Bad(
        "16 transforms of a draft", "unsupported", lambda: _changed(congruence=34)
    ),
    "bad-congruence-whole-short": Bad(
        "whole vertices, 16 transforms, in a payload without", "truncated", lambda: _changed(congruence=68)
    ),
    "bad-congruence-whole-not": Bad(
        "whole vertices that the header does not have",
        "corrupt",
        lambda: with_header(placed(torus(16, 12), 500, mirrors(), whole=True), congruence=38),
    ),
    "bad-congruence-whole-wrong": Bad(
        "whole vertices that only the header has",
        "corrupt",
        lambda: with_header(placed(torus(16, 12), 500, mirrors()), congruence=55),
    ),
    "bad-congruence-short": Bad("16 transforms, in a payload without", "truncated", lambda: _changed(congruence=51)),
}
