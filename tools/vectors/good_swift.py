"""Streams with swift attributes: of vertices and corners, on a grid and beside blocks, plain and mixed."""

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.static.attributes.encoding import with_attributes as with_attributes_of
from bsm.codec.static.choice.attributes import Sent
from bsm.codec.static.choice.grids import rounded
from bsm.codec.static.encoder import encode
from bsm.codec.static.options import EncodeOptions
from tools.surgery import frames_of, stream_of, with_declaration, with_header
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
    return Attribute(
        "coarse", (np.arange(len(mesh.positions)) // 3 % 2).astype(np.uint8)[:, None], "vertex"
    )


def tangents(mesh: TriangleMesh) -> Attribute:
    """Directions at right angles to the normals of `creases`, turned where charts are, and hands that differ."""
    normals = creases(mesh).values.astype(np.float64)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    at = mesh.positions[mesh.faces].reshape(-1, 3)
    toward = np.column_stack([np.cos(3.0 * at[:, 0]), np.sin(3.0 * at[:, 0]), 0.3 * at[:, 1] + 0.1])
    toward -= (toward * normals).sum(axis=1, keepdims=True) * normals
    toward /= np.linalg.norm(toward, axis=1, keepdims=True)
    hand = np.where(mesh.positions[mesh.faces].mean(axis=1)[:, 2] > 0.0, 1.0, -1.0).repeat(3)
    return Attribute("tangent", np.column_stack([toward, hand]).astype(np.float32), "corner")


def turned(mesh: TriangleMesh, effort: str, **options: Any) -> bytes:
    """A mesh with normals of 10 bits, texture coordinates, and tangents of 9 bits, which are turns."""
    return of(
        mesh,
        effort,
        creases,
        charts,
        tangents,
        attributes={"normal": "10bits", "tangent": "9bits"},
        **options,
    )


def in_chunks(effort: str) -> bytes:
    """Values in several frames of each attribute."""
    mesh = with_attributes(torus(24, 16), creases, charts, colors, tangents)
    qualities = {"normal": "10bits", "tangent": "9bits"}
    sent = Sent(mesh, EncodeOptions(threads=1, effort=effort, grid=9, attributes=qualities))
    return b"".join(with_attributes_of(rounded(sent.prepared, 9), sent.carried, {}, 101).frames)


def of(
    mesh: TriangleMesh, effort: str, *makers: Callable[[TriangleMesh], Attribute], **options: Any
) -> bytes:
    """A mesh on a grid of 9 bits unless options say otherwise, with attributes of these makers; none: usual ones."""
    given = with_attributes(mesh, *(makers or USUAL))
    return encode(given, EncodeOptions(threads=1, effort=effort, **({"grid": 9} | options)))


def _damaged(change: Callable[[bytes], bytes], effort: str = "quick") -> bytes:
    """Other bytes in the last frame of values."""
    frames = frames_of(of(torus(24, 16), effort, creases))
    kind, payload = frames[-1]
    return stream_of([*frames[:-1], (kind, change(payload))])


def _bare(**fields: Any) -> bytes:
    return with_header(
        encode(torus(24, 16), EncodeOptions(threads=1, effort="quick", grid=9)), **fields
    )


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
    "pieces": (
        "numbers of two pieces, in groups of four",
        lambda effort: of(torus(12, 9), effort, numbers, coarse),
    ),
    "tangents": ("tangents that are turns", partial(turned, torus(24, 16))),
    "tangents-border": ("tangents at a border", partial(turned, patch(9, 14))),
    "tangents-hub": ("tangents around a vertex of many faces", partial(turned, hub())),
    "tangents-tent": ("tangents where faces have no area", partial(turned, tent())),
    "tangents-order": (
        "tangents of faces in the given order",
        lambda effort: turned(shuffled(torus(24, 16)), effort, keep_order=True),
    ),
    "chunks": ("values in several frames", in_chunks),
    "bits": (
        "normals of 16 bits",
        lambda effort: of(torus(12, 9), effort, creases, attributes={"*": "16bits"}),
    ),
}
SWIFTS: dict[str, Good] = {
    f"good-swift-{kind}-{name}": Good(f"swift {number}: {probes}", partial(make, effort))
    for number, kind, effort in ((1, "plain", "quick"), (2, "mixed", "normal"))
    for name, (probes, make) in _MADE.items()
    if (kind, name) != ("plain", "blocks")
}
SWIFTS_BAD: dict[str, Bad] = {
    "bad-swift-none": Bad("swift attributes, and none", "corrupt", lambda: _bare(swift=1)),
    "bad-swift-zero": Bad(
        "a stored default", "corrupt", lambda: with_header(of(torus(12, 9), "quick"), swift=0)
    ),
    "unsupported-swift-method": Bad(
        "a method that is not known",
        "unsupported",
        lambda: with_header(of(torus(12, 9), "quick"), swift=3),
    ),
    "bad-swift-short": Bad(
        "values that end early", "truncated", lambda: _damaged(lambda payload: payload[:-9])
    ),
    "bad-swift-long": Bad(
        "values that end late", "corrupt", lambda: _damaged(lambda payload: payload + b"\1\2\3\4\5")
    ),
    "bad-swift-range": Bad(
        "a normal beyond the octahedron",
        "corrupt",
        lambda: _damaged(lambda payload: payload[:6] + b"\x7f" * 999),
    ),
    "bad-swift-tangents-header": Bad(
        "tangents without `swift`",
        "corrupt",
        lambda: with_header(turned(torus(12, 9), "quick"), swift=None),
    ),
    "bad-swift-tangents-bases": Bad(
        "tangents without bases",
        "corrupt",
        lambda: with_declaration(turned(torus(12, 9), "quick"), 2, bases=None),
    ),
    "bad-swift-tangents-later": Bad(
        "bases that come later",
        "corrupt",
        lambda: with_declaration(turned(torus(12, 9), "quick"), 2, bases=[1, 3]),
    ),
    "bad-swift-tangents-exchanged": Bad(
        "bases in the other order",
        "corrupt",
        lambda: with_declaration(turned(torus(12, 9), "quick"), 2, bases=[2, 1]),
    ),
    "bad-swift-tangents-size": Bad(
        "a diamond of no whole size",
        "corrupt",
        lambda: with_declaration(turned(torus(12, 9), "quick"), 2, largest=[1026, 1]),
    ),
    "bad-swift-tangents-stray": Bad(
        "bases of another attribute",
        "corrupt",
        lambda: with_declaration(turned(torus(12, 9), "quick"), 1, bases=[1, 1]),
    ),
    "bad-swift-mixed-range": Bad(
        "a normal beyond it",
        "corrupt",
        lambda: _damaged(lambda payload: payload[:6] + b"\x7f" * 999, "normal"),
    ),
}
