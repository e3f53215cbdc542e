"""Streams with swift attributes: of vertices and corners, on a grid and beside blocks, plain and mixed."""

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.static.encoder import encode
from bsm.codec.static.options import EncodeOptions
from tools.surgery import frames_of, stream_of, with_header
from tools.vectors.good import Bad, Good
from tools.vectors.good_attributes import charts, colors, creases, groups, with_attributes
from tools.vectors.meshes import hub, patch, shuffled, tangled, tent, torus

USUAL = creases, charts, colors, groups


def numbers(mesh: TriangleMesh) -> Attribute:
    """Doubles to the bit, of which each takes two numbers of two pieces."""
    values = np.sin(mesh.positions[:, :1] * np.array([1.0, 2.0, 1e-3, 1e9]))
    return Attribute("numbers", values, "vertex")


def coarse(mesh: TriangleMesh) -> Attribute:
    """Whole numbers of vertices, which are 0 and 1."""
    return Attribute("coarse", (np.arange(len(mesh.positions)) // 3 % 2).astype(np.uint8)[:, None], "vertex")


def of(mesh: TriangleMesh, effort: str, *makers: Callable[[TriangleMesh], Attribute], **options: Any) -> bytes:
    """A mesh on a grid of 9 bits unless options say otherwise, with attributes of these makers; none: usual ones."""
    given = with_attributes(mesh, *(makers or USUAL))
    return encode(given, EncodeOptions(threads=1, effort=effort, **({"grid": 9} | options)))


def _damaged(change: Callable[[bytes], bytes], effort: str = "quick") -> bytes:
    """Other bytes in the last frame of values."""
    frames = frames_of(of(torus(24, 16), effort, creases))
    kind, payload = frames[-1]
    return stream_of([*frames[:-1], (kind, change(payload))])


def _bare(**fields: Any) -> bytes:
    return with_header(encode(torus(24, 16), EncodeOptions(threads=1, effort="quick", grid=9)), **fields)


_MADE: dict[str, tuple[str, Callable[[str], bytes]]] = {
    "grid": ("attributes that lean on a grid", partial(of, torus(24, 16))),
    "blocks": (
        "attributes beside blocks, without a geometry",
        lambda effort: of(torus(24, 16), effort, grid=None, contract=None, coefficients=30),
    ),
    "border": ("a border and loose ends", partial(of, patch(9, 14))),
    "tangled": ("edges of three faces, and faces that repeat a corner", partial(of, tangled())),
    "hub": ("a vertex of many faces", partial(of, hub())),
    "tent": ("normals that turn over, where faces have no area", partial(of, tent())),
    "order": (
        "vertices and faces in the given order",
        lambda effort: of(shuffled(torus(24, 16)), effort, keep_order=True),
    ),
    "pieces": ("numbers of two pieces, in groups of four", lambda effort: of(torus(12, 9), effort, numbers, coarse)),
    "bits": ("normals of 16 bits", lambda effort: of(torus(12, 9), effort, creases, attributes={"*": "16bits"})),
}
SWIFTS: dict[str, Good] = {
    f"good-swift-{kind}-{name}": Good(f"swift {number}: {probes}", partial(make, effort))
    for number, kind, effort in ((1, "plain", "quick"), (2, "mixed", "normal"))
    for name, (probes, make) in _MADE.items()
    if (kind, name) != ("plain", "blocks")
}
SWIFTS_BAD: dict[str, Bad] = {
    "bad-swift-none": Bad("swift attributes, and none", "corrupt", lambda: _bare(swift=1)),
    "bad-swift-zero": Bad("a stored default", "corrupt", lambda: with_header(of(torus(12, 9), "quick"), swift=0)),
    "unsupported-swift-method": Bad(
        "a method that is not known", "unsupported", lambda: with_header(of(torus(12, 9), "quick"), swift=3)
    ),
    "bad-swift-short": Bad("values that end early", "truncated", lambda: _damaged(lambda payload: payload[:-9])),
    "bad-swift-long": Bad("values that end late", "corrupt", lambda: _damaged(lambda payload: payload + b"\1\2\3\4\5")),
    "bad-swift-range": Bad(
        "a normal beyond the octahedron", "corrupt", lambda: _damaged(lambda payload: payload[:6] + b"\x7f" * 999)
    ),
    "bad-swift-mixed-range": Bad(
        "a normal beyond it", "corrupt", lambda: _damaged(lambda payload: payload[:6] + b"\x7f" * 999, "normal")
    ),
}
