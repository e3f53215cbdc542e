"""Streams with positions on a grid by the small model: as the encoder writes them, and as it never would."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from bsm.bitstream.connectivity.faces import encode_connectivity
from bsm.bitstream.container.header import MOST_GRID
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.static.encoder import encode
from bsm.codec.static.options import EncodeOptions
from tools.gridded import gridded, latticed, lightened
from tools.surgery import stream_of, with_header
from tools.vectors.good import Good
from tools.vectors.good_attributes import charts, colors, creases, groups, with_attributes
from tools.vectors.good_fields import exact_lattice, soup
from tools.vectors.meshes import hub, patch, shuffled, tangled, tent, tetrahedron, together, torus, triangle

Faces = npt.NDArray[np.int32]


def light(mesh: TriangleMesh, *counts: int, bits: int = 11, keep_order: bool = False) -> bytes:
    """Return rounded positions, in packets of this many vertices."""
    return lightened(encode(mesh, EncodeOptions(grid=bits, keep_order=keep_order)), *counts)


def drawn(faces: Faces, largest: tuple[int, int, int], kind: str = "noise", *counts: int) -> bytes:
    """Values that have nothing to do with each other: any, or ends of the range."""
    size = int(faces.max()) + 1
    values = np.random.default_rng(len(faces)).integers(0, np.array(largest) + 1, (size, 3))
    if kind == "ends":
        values = np.where(values * 2 > largest, largest, 0)
    coded = encode_connectivity(faces, size)
    return stream_of(gridded(coded, values.astype(np.int32), counts or (size,), grid=list(largest), light=1))


def apart(count: int) -> Faces:
    """Triangles that have nothing to do with each other."""
    return np.arange(3 * count, dtype=np.int32).reshape(-1, 3)


def small() -> TriangleMesh:
    """A torus of 120 vertices."""
    return torus(12, 10)


def _several() -> TriangleMesh:
    return together(torus(9, 8), patch(7, 6), tetrahedron(), torus(6, 5), triangle())


def _flat() -> TriangleMesh:
    return TriangleMesh(patch(9, 8).positions * (1.0, 1.0, 0.0), patch(9, 8).faces)


def _good(probes: str, make: Callable[[], bytes]) -> Good:
    return Good(f"small model: {probes}", make)


LIGHT: dict[str, Good] = {
    "good-light": _good("a grid of 11 bits", lambda: light(small())),
    "good-light-quick": Good(
        "what the encoder writes to be decoded quickly", lambda: encode(torus(16, 12), EncodeOptions(effort="quick"))
    ),
    "good-light-tetrahedron": _good("four vertices on a grid of one bit", lambda: light(tetrahedron(), bits=1)),
    "good-light-fine": _good("a grid of 20 bits", lambda: light(small(), bits=20)),
    "good-light-coarse": _good("a grid of 4 bits, most errors 0", lambda: light(small(), bits=4)),
    "good-light-border": _good("a surface with a border", lambda: light(patch(12, 9), bits=12)),
    "good-light-flat": _good(
        "an axis of one value", lambda: lightened(latticed(encode(_flat(), EncodeOptions(grid=10)), 1023, 364))
    ),
    "good-light-point": _good("a grid of one place", lambda: drawn(small().faces, (0, 0, 0))),
    "good-light-noise": _good(
        "values without relation on axes of 1,001, 4 and 2^20 values",
        lambda: drawn(small().faces, (1000, 3, MOST_GRID)),
    ),
    "good-light-ends": _good(
        "only ends of the longest axes, predictions far outside",
        lambda: drawn(tangled().faces.astype(np.int32), (MOST_GRID,) * 3, "ends"),
    ),
    "good-light-lattice": _good("a lattice under the grid", lambda: lightened(exact_lattice())),
    "good-light-corner": _good(
        "a grid that begins at given cells", lambda: with_header(light(small()), center=None, corner=[1, -70000, 0])
    ),
    "good-light-chunks": _good("three frames", lambda: light(small(), 1, 70, 49)),
    "good-light-vertices": _good("a frame for each vertex", lambda: light(torus(5, 4), *[1] * 20)),
    "good-light-tangled": _good(
        "non-manifold, repeated, turned and degenerate faces",
        lambda: light(tangled(), 20, len(tangled().positions) - 20),
    ),
    "good-light-hub": _good("a vertex with very many neighbors", lambda: light(hub())),
    "good-light-hub-noise": _good(
        "the same, values without relation", lambda: drawn(hub().faces.astype(np.int32), (99, 999, 9))
    ),
    "good-light-tent": _good("more ends and flaps than are looked at", lambda: light(tent())),
    "good-light-components": _good("many components", lambda: light(_several(), bits=9)),
    "good-light-apart": _good(
        "triangles apart: nothing known around most vertices", lambda: drawn(apart(9), (255, 255, 255))
    ),
    "good-light-one": _good(
        "one vertex, three times in its face", lambda: drawn(np.zeros((1, 3), np.int32), (5, 0, 7))
    ),
    "good-light-two": _good(
        "two vertices, faces that repeat one",
        lambda: drawn(np.array([[0, 1, 1], [0, 0, 1]], np.int32), (3, 300, 30000)),
    ),
    "good-light-ordered": _good("ORDER", lambda: light(shuffled(small()), bits=8, keep_order=True)),
    "good-light-splits": _good("ORDER with copies", lambda: light(soup(torus(7, 6)), bits=8, keep_order=True)),
    "good-light-attributes": _good(
        "attributes of vertices, corners and faces that lean on it",
        lambda: light(with_attributes(torus(12, 10), charts, creases, colors, groups), 50, 70, bits=9),
    ),
}
