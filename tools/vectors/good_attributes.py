"""Streams with attributes: of vertices, corners and faces, with and without seams, of every kind and coding."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from bsm.api import encode_sequence
from bsm.bitstream.container.packets import Attribute as Declared
from bsm.bitstream.container.packets import Packet, Refinement, Values
from bsm.codec.geometry.attributes import Attribute, Domain
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.welding import split_by_attributes
from bsm.codec.progress import Nearing
from bsm.codec.static.attributes.encoding import ranges
from bsm.codec.static.choice.blocks import InBlocks
from bsm.codec.static.encoder import Encoder, encode
from bsm.codec.static.options import EncodeOptions
from bsm.codec.static.preamble_encoding import Draft
from bsm.codec.static.ways.grid import levels_field
from tools.surgery import frames_of, stream_of, with_header, write_stream
from tools.vectors.good import BASE, Good
from tools.vectors.good_fields import LAYER, soup
from tools.vectors.good_sequences import BASE as MOVING
from tools.vectors.meshes import hub, patch, shuffled, tangled, tent, tetrahedron, torus

GRID = EncodeOptions(grid=9)
ORDERED = replace(GRID, keep_order=True)


def charts(mesh: TriangleMesh, kind: str = "float32") -> Attribute:
    """Texture coordinates in two charts, and one corner for itself."""
    at = mesh.positions[mesh.faces]
    right = at.mean(axis=1)[:, 0] > mesh.positions[:, 0].mean()
    corners = np.where(right[:, None, None], at[:, :, :2], 2.0 - at[:, :, 1:])
    corners[0, 0] += 0.5
    return Attribute("uv", corners.reshape(-1, 2).astype(kind), "corner", "texcoord")


def creases(mesh: TriangleMesh) -> Attribute:
    """Normals: of faces on one side, of vertices on the other."""
    a, b, c = (mesh.positions[mesh.faces[:, k]] for k in range(3))
    flat = np.cross(b - a, c - a) + np.array([0.0, 0.0, 1e-9])
    smooth = np.zeros_like(mesh.positions)
    for k in range(3):
        np.add.at(smooth, mesh.faces[:, k], flat)
    sharp = (mesh.positions[mesh.faces].mean(axis=1)[:, 1] > mesh.positions[:, 1].mean())[:, None, None]
    corners = np.where(sharp, flat[:, None], smooth[mesh.faces])
    return Attribute("normal", corners.reshape(-1, 3).astype(np.float32), "corner", "normal")


def tips(mesh: TriangleMesh) -> Attribute:
    """Normals of vertices; those of the last two are not what their many faces say."""
    a, b, c = (mesh.positions[mesh.faces[:, k]] for k in range(3))
    smooth = np.zeros_like(mesh.positions)
    for k in range(3):
        np.add.at(smooth, mesh.faces[:, k], np.cross(b - a, c - a))
    smooth[-2:] = [[0.6, 0.0, 0.8], [0.0, 0.6, -0.8]]
    return Attribute("normal", smooth.astype(np.float32), semantic="normal")


def colors(mesh: TriangleMesh, kind: str = "uint8") -> Attribute:
    """Smooth ones of vertices."""
    shades = 0.5 + 0.45 * np.sin(3 * mesh.positions @ np.array([[1, 2, 0, 1], [0, 1, 3, 1], [2, 0, 1, 1.0]]))
    shades *= {"uint8": 255, "uint16": 65535}.get(kind, 1)
    return Attribute("color", shades.astype(kind), "vertex", "color")


def groups(mesh: TriangleMesh) -> Attribute:
    """Numbers of faces."""
    return Attribute("group", (np.arange(len(mesh.faces)) // 9 * 7 % 5).astype(np.int32), "face")


def wild(mesh: TriangleMesh, kind: str, domain: Domain = "vertex", components: int = 1) -> Attribute:
    """Any numbers of a kind, its ends among them."""
    count = {"vertex": len(mesh.positions), "corner": mesh.faces.size, "face": len(mesh.faces)}[domain]
    bits = np.arange(count * components, dtype=np.uint64) * np.uint64(0x9E3779B97F4A7C15)
    size = np.dtype(kind).itemsize
    values = (bits >> np.uint64(64 - 8 * size)).astype(f"u{size}").view(kind).copy()
    if values.dtype.kind == "f":
        values = np.where(np.isfinite(values), values, 0).astype(kind)
        values[:2] = 0.0, -0.0
    else:
        values[:2] = np.iinfo(kind).min, np.iinfo(kind).max
    return Attribute(kind, values.reshape(count, components), domain)


_HALVES = bytes.fromhex(
    "89504e470d0a1a0a0000000d49484452000000080000000808020000004b6d29dc0000001849444154789c633cc1801d30e1102743829161"
    "01cded0000df5c0177668f05260000000049454e44ae426082"
)
"""A PNG of 8 x 8 pixels, red above and green below."""


def _textured() -> TriangleMesh:
    """A wall that the upper half of an image is on above, where z points up."""
    mesh = patch(9, 9)
    low, high = mesh.positions.min(axis=0), mesh.positions.max(axis=0)
    across = (mesh.positions - low) / (high - low)
    wall = np.stack([2 * across[:, 0] - 1, 0.1 * across[:, 2], 2 * across[:, 1] - 1], axis=1)
    material: dict[str, str | int | float | bytes] = {"baseColorTexture": 0, "metallicFactor": 0.0, "doubleSided": 1}
    material |= {"name": "halves"}
    metadata = {f"material.0.{name}": value for name, value in material.items()}
    return replace(
        mesh,
        positions=wall,
        attributes=(Attribute("texcoord", across[:, :2].astype(np.float32), "vertex", "texcoord"),),
        metadata=metadata | {"image.0.data": _HALVES, "up": "z"},
    )


def with_attributes(mesh: TriangleMesh, *make: Callable[[TriangleMesh], Attribute]) -> TriangleMesh:
    """A mesh with attributes."""
    return replace(mesh, attributes=tuple(maker(mesh) for maker in make))


def in_chunks(mesh: TriangleMesh, options: EncodeOptions, size: int) -> bytes:
    """Return values in chunks of this many."""
    encoder = Encoder(mesh, options)
    return with_values(encoder, encoder._bare(Nearing(None)), size)


def on_layers(mesh: TriangleMesh, count: int) -> bytes:
    """After a layer of refinement that ends early, after this many vertices."""
    encoder = Encoder(mesh, BASE)
    made = InBlocks(encoder._input.prepared, BASE).base(BASE.first_step)
    levels = made.wanted(made.expected_steps(LAYER))[0]
    levels[count:], levels[:, 1:] = 0, 0  # of a layer that ends early, heights alone count
    draft = made.refined(LAYER, levels, made.moved(LAYER, levels, made.known_steps(LAYER, levels)))
    layer = Refinement(0, count, levels_field(made.prepared.mesh.faces, levels).write(count)[0])
    body = (*(packet for packet in draft.body if not isinstance(packet, Refinement)), layer)
    return with_values(encoder, replace(draft, body=body), 1000)


def with_values(encoder: Encoder, draft: Draft, size: int) -> bytes:
    """Return a draft with the attributes of its mesh, in chunks of this many values."""
    prepared, carried = encoder._input.prepared, encoder._input.carried
    declared: list[Packet] = []
    values: list[Packet] = []
    for index, attribute in enumerate(carried):
        leans = draft.places is not None and attribute.declaration.semantic in (2, 3)
        declaration = replace(attribute.declaration, leans=int(leans))
        declared.append(Declared(index, declaration, attribute.seams))
        chunks = attribute.chunks(draft.places if leans else None, size)
        parts = zip(ranges(declaration.rows, size), chunks, strict=True)
        values += [Values(index, start, count, data) for (start, count), data in parts]
    before = len(prepared.before_blocks if draft.places is None else prepared.before_grid)
    header = replace(draft.header, attributes=len(carried))
    body: list[Packet] = [*draft.body[:before], *declared, *draft.body[before:], *values]
    return write_stream([header, *body])


def asked(mesh: TriangleMesh, options: EncodeOptions, **qualities: str) -> bytes:
    """Encode with qualities of attributes."""
    return encode(mesh, replace(options, attributes=qualities))


def _split() -> TriangleMesh:
    """Vertices split where corners differ, and two in no face."""
    mesh = split_by_attributes(with_attributes(torus(8, 7), charts, creases, colors, groups))
    loose = np.array([[9.0, 9.0, 9.0], [8.0, 8.0, 8.0]])
    values = [np.concatenate([attribute.values, attribute.values[3:5]]) for attribute in mesh.attributes]
    attributes = [
        replace(attribute, values=more) if attribute.domain == "vertex" else attribute
        for attribute, more in zip(mesh.attributes, values, strict=True)
    ]
    return TriangleMesh(np.concatenate([mesh.positions, loose]), mesh.faces, tuple(attributes))


def _sequence() -> bytes:
    meshes = [torus(10, 8, phase=0.2 * t) for t in range(4)]
    attributes = with_attributes(meshes[0], charts, colors, groups).attributes
    positions = np.array([mesh.positions for mesh in meshes])
    return encode_sequence(positions, meshes[0].faces, MOVING, metadata={"name": "torus"}, mesh_attributes=attributes)


def _second(mesh: TriangleMesh) -> Attribute:
    return replace(charts(mesh), name="uv 2", values=charts(mesh).values[:, ::-1] ** 2)


def _few_seams(mesh: TriangleMesh) -> Attribute:
    return replace(charts(mesh), name="few", values=np.round(charts(mesh).values, 1), semantic="generic")


def _small() -> bytes:
    """One cell of a grid, coded as the two points of a lattice in a grid of 511 cells."""
    mesh = with_attributes(tetrahedron(), charts, creases, groups)
    scale = float(np.float32(1) / np.float32(511))
    points = with_header(encode(mesh, EncodeOptions(grid=1)), scale=scale, lattice=[511, 1])
    return stream_of(frames_of(points), positions=encode(mesh, GRID)[-6:-2])


ATTRIBUTES: dict[str, Good] = {
    "good-attribute-uv-grid": Good(
        "texture coordinates with seams that lean on a grid",
        lambda: encode(with_attributes(torus(12, 10), charts), GRID),
    ),
    "good-attribute-uv-blocks": Good(
        "texture coordinates of a mesh in blocks", lambda: in_chunks(with_attributes(torus(12, 10), charts), BASE, 50)
    ),
    "good-attribute-uv-plain": Good(
        "texture coordinates that lean on nothing", lambda: in_chunks(with_attributes(patch(9, 8), charts), BASE, 1000)
    ),
    "good-attribute-layers": Good(
        "attributes behind a layer of refinement, which ends early",
        lambda: on_layers(with_attributes(torus(10, 8), charts, creases), 50),
    ),
    "good-attribute-normals": Good(
        "normals with creases, on a grid", lambda: encode(with_attributes(torus(12, 10), creases), GRID)
    ),
    "good-attribute-normals-blocks": Good(
        "normals and texture coordinates of a mesh in blocks, in chunks",
        lambda: in_chunks(with_attributes(torus(10, 8), creases, charts), BASE, 33),
    ),
    "good-attribute-normals-coarse": Good(
        "normals of two bits that lean on nothing",
        lambda: in_chunks(with_attributes(patch(8, 7), creases), replace(BASE, attributes={"normal": "2bits"}), 1000),
    ),
    "good-attribute-recomputed": Good(
        "normals that are recomputed, of vertices and with creases",
        lambda: encode(with_attributes(torus(9, 8), creases), replace(BASE, normals="recompute")),
    ),
    "good-attribute-recomputed-tangled": Good(
        "normals that are recomputed where faces have no area, and of loose vertices",
        lambda: encode(
            with_attributes(soup(torus(6, 5)), lambda mesh: Attribute("n", 0 * mesh.positions + 1, semantic="normal")),
            replace(ORDERED, normals="recompute"),
        ),
    ),
    "good-attribute-colors": Good(
        "colors of vertices, four bytes each, in chunks",
        lambda: in_chunks(with_attributes(torus(9, 8), colors), BASE, 40),
    ),
    "good-attribute-colors-float": Good(
        "colors as floats, and of 16 bits",
        lambda: encode(
            with_attributes(
                torus(9, 8), lambda m: colors(m, "float32"), lambda m: replace(colors(m, "uint16"), name="c16")
            ),
            GRID,
        ),
    ),
    "good-attribute-groups": Good(
        "numbers of faces, in chunks", lambda: in_chunks(with_attributes(torus(9, 8), groups), GRID, 60)
    ),
    "good-attribute-exact": Good(
        "every type of whole numbers, exact",
        lambda: encode(
            with_attributes(
                patch(6, 5),
                *(
                    lambda m, k=kind, d=domain: wild(m, k, d, 2)
                    for kind, domain in (
                        ("uint8", "vertex"),
                        ("int8", "corner"),
                        ("uint16", "face"),
                        ("int16", "vertex"),
                        ("uint32", "corner"),
                        ("int32", "face"),
                    )
                ),
            ),
            ORDERED,
        ),
    ),
    "good-attribute-bits": Good(
        "floats to the bit, more words than one group of pieces holds",
        lambda: asked(
            with_attributes(
                patch(6, 5), lambda m: wild(m, "float32", "corner"), lambda m: wild(m, "float64", "vertex", 4)
            ),
            ORDERED,
            **{"*": "exact"},
        ),
    ),
    "good-attribute-steps": Good(
        "bounds: steps of each kind, and of whole numbers",
        lambda: asked(
            with_attributes(
                torus(9, 8),
                lambda m: Attribute("heat", np.sin(3 * m.positions[:, :1])),
                lambda m: Attribute("height", (1000 * m.positions[:, 2]).astype(np.int16)),
            ),
            GRID,
            heat="1%",
            height="7",
        ),
    ),
    "good-attribute-shared": Good(
        "seams of another attribute, and seams beside two others",
        lambda: encode(with_attributes(torus(10, 8), charts, creases, _second, _few_seams), GRID),
    ),
    "good-attribute-tangled": Good(
        "non-manifold, repeated, turned and degenerate faces, each corner for itself",
        lambda: encode(with_attributes(tangled(), charts, creases, lambda m: wild(m, "uint8", "corner")), ORDERED),
    ),
    "good-attribute-hub": Good(
        "a vertex of very many corners", lambda: encode(with_attributes(hub(), charts, creases, colors), GRID)
    ),
    "good-attribute-tent": Good(
        "more neighbors, flaps, bases and corners than are looked at",
        lambda: encode(with_attributes(tent(), tips, colors), GRID),
    ),
    "good-attribute-small": Good("four faces with values of their own", _small),
    "good-attribute-constant": Good(
        "one value everywhere",
        lambda: encode(with_attributes(torus(6, 5), lambda m: Attribute("one", np.full(len(m.positions), 3.5))), GRID),
    ),
    "good-attribute-no-seams": Good(
        "corners that are coded by vertices",
        lambda: encode(
            with_attributes(torus(9, 8), lambda m: Attribute("uv", m.positions[:, :2], "corner", "texcoord", m.faces)),
            BASE,
        ),
    ),
    "good-attribute-shuffled": Good(
        "corners and faces in the order of ORDER",
        lambda: encode(with_attributes(shuffled(torus(9, 8)), charts, creases, colors, groups), ORDERED),
    ),
    "good-attribute-split": Good(
        "vertices that were split, given by corners", lambda: encode(_split(), replace(GRID, keep_order=False))
    ),
    "good-attribute-split-ordered": Good(
        "vertices that were split, and two in no face, as they were", lambda: encode(_split(), ORDERED)
    ),
    "good-attribute-split-blocks": Good("the same in blocks", lambda: encode(_split(), replace(BASE, keep_order=True))),
    "good-attribute-metadata": Good(
        "METADATA, ORDER and attributes",
        lambda: encode(
            replace(with_attributes(torus(8, 7), colors), metadata={"name": "torus", "unit": "mm"}), ORDERED
        ),
    ),
    "good-attribute-textured": Good(
        "a wall with texture coordinates, a material with an image, and z up", lambda: encode(_textured(), GRID)
    ),
    "good-sequence-attributes": Good("a sequence with attributes that are the same in all frames", _sequence),
}
