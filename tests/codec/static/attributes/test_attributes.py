"""Attributes of meshes through whole streams."""

import re
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import bsm
from bsm.bitstream.container import packets
from bsm.bitstream.container.header import LEVELS, RECOMPUTED, TANGENTS
from bsm.codec.geometry.metrics import face_normals
from bsm.codec.geometry.welding import split_by_attributes
from bsm.codec.look.measure import AttributeLook, look, look_values
from tests.shapes import at_corners, curved, patch, tetrahedron, torus
from tests.streams import events_of, packets_of, without
from tools.surgery import frames_of, stream_of
from tools.vectors.good_attributes import charts, creases, with_attributes
from tools.vectors.good_swift import tangents

QUICK = bsm.EncodeOptions(grid=12)
"""Where the shape is not the point."""
KINDS = ("uint8", "int8", "uint16", "int16", "uint32", "int32")


def atlas(mesh: bsm.TriangleMesh) -> bsm.Attribute:
    """Texture coordinates in two charts, cut along a line of faces."""
    faces = mesh.faces
    right = mesh.positions[faces].mean(axis=1)[:, 0] > mesh.positions[:, 0].mean()
    corners = mesh.positions[faces][:, :, :2] * 0.4 + np.where(right, 0.5, 0.0)[:, None, None]
    return bsm.Attribute("uv", corners.reshape(-1, 2).astype(np.float32), "corner", "texcoord")


def normals(mesh: bsm.TriangleMesh) -> bsm.Attribute:
    flat = face_normals(mesh.positions, mesh.faces)
    return bsm.Attribute(
        "normal", np.repeat(flat, 3, axis=0).astype(np.float32), "corner", "normal"
    )


def dressed(mesh: bsm.TriangleMesh) -> bsm.TriangleMesh:
    """With one attribute of each sort."""
    random = np.random.default_rng(5)
    size = len(mesh.positions)
    colors = (128 + 100 * np.sin(3 * mesh.positions)).astype(np.uint8)
    group = np.sort(random.integers(0, 9, len(mesh.faces))).astype(np.int32)
    heat = np.cos(4 * mesh.positions[:, 0])
    wild = random.normal(size=(size, 2)).astype(np.float32)
    attributes = (
        bsm.Attribute("color", colors, "vertex", "color"),
        atlas(mesh),
        normals(mesh),
        bsm.Attribute("heat", heat),
        bsm.Attribute("group", group, "face"),
        bsm.Attribute("wild", wild),
    )
    return replace(mesh, attributes=attributes, metadata={"name": "thing", "unit": "mm", "n": 3})


def compared(
    given: bsm.TriangleMesh, decoded: bsm.TriangleMesh, encoder: bsm.Encoder
) -> dict[str, float]:
    """Largest error of each attribute, wherever its corners have come to be."""
    errors = {}
    order = encoder.vertex_order
    for attribute in given.attributes:
        found = next(found for found in decoded.attributes if found.name == attribute.name)
        assert (found.semantic, found.values.dtype) == (attribute.semantic, attribute.values.dtype)
        wanted, had = at_corners(given, attribute)[encoder.face_order], at_corners(decoded, found)
        # corners of a face may have been turned
        positions = given.positions[given.faces[encoder.face_order]]
        best = np.full(len(had), np.inf)
        for turn in range(3):
            fits = (np.roll(positions, -turn, axis=1) == given.positions[order[decoded.faces]]).all(
                axis=(1, 2)
            )
            off = np.abs(np.roll(wanted, -turn, axis=1).astype(float) - had.astype(float)).max(
                axis=(1, 2)
            )
            best = np.where(fits, np.minimum(best, off), best)
        errors[attribute.name] = float(best.max())
    return errors


EXACT = {"uv": "12bits", "color": "exact"}


@pytest.mark.parametrize(
    "options",
    [
        bsm.EncodeOptions(),
        bsm.PRESETS["grid14"],
        bsm.EncodeOptions(keep_order=True),
        replace(bsm.PRESETS["grid14"], keep_order=True),
    ],
    ids=["blocks", "grid", "blocks in order", "grid in order"],
)
@pytest.mark.parametrize(
    "shape", [patch(30, 24), torus(), tetrahedron()], ids=["patch", "torus", "tetrahedron"]
)
def test_everything_comes_back(shape, options):
    mesh = dressed(shape)
    encoder = bsm.Encoder(
        mesh, replace(options, normals="keep", attributes={} if options.grid else EXACT)
    )
    decoded = bsm.decode(encoder.encode())
    errors = compared(mesh, decoded, encoder)
    fine = options.grid is not None
    assert errors["color"] == errors["group"] == 0.0
    assert errors["uv"] <= 0.51 * np.ptp(mesh.attributes[1].values, axis=0).max() / (
        2 ** (14 if fine else 12) - 1
    )
    assert errors["normal"] <= (0.002 if fine else 0.006)
    assert errors["heat"] <= 2.0 / (2 ** (20 if fine else 16) - 1)
    assert errors["wild"] <= 8.0 / (2**16 - 1)
    assert dict(decoded.metadata) == dict(mesh.metadata)
    assert [attribute.name for attribute in decoded.attributes] == [
        attribute.name for attribute in mesh.attributes
    ]
    if options.keep_order:
        assert (decoded.faces == mesh.faces).all()
        assert [attribute.domain for attribute in decoded.attributes] == [
            a.domain for a in mesh.attributes
        ]
    assert any("uv: texcoord per corner" in note for note in encoder.notes)


def test_split_files_come_back_split():
    mesh = split_by_attributes(dressed(torus()))
    assert len(mesh.positions) > 40 * 24
    encoder = bsm.Encoder(mesh, bsm.PRESETS["grid14"])
    decoded = bsm.decode(encoder.encode())
    assert len(decoded.positions) == 40 * 24, "no gaping geometry"
    assert max(compared(mesh, decoded, encoder).values()) < 0.002
    again = split_by_attributes(decoded)
    sent = {"color", "uv", "normal", "heat", "wild"}
    assert (
        len(again.positions) <= len(mesh.positions)
        and {attribute.name for attribute in again.attributes} >= sent
    )
    assert all(attribute.domain != "corner" for attribute in again.attributes)


def test_split_files_come_back_with_their_indices():
    mesh = split_by_attributes(dressed(torus()))
    loose = bsm.TriangleMesh(
        np.concatenate([mesh.positions, [[7.0, 7, 7], [8, 8, 8]]]),
        mesh.faces,
        tuple(
            replace(a, values=np.concatenate([a.values, a.values[:2]]))
            if a.domain == "vertex"
            else a
            for a in mesh.attributes
        ),
    )
    options = replace(bsm.PRESETS["grid14"], keep_order=True, attributes={"*": "exact"})
    decoded = bsm.decode(bsm.encode(loose, options))
    assert (decoded.faces == loose.faces).all() and len(decoded.positions) == len(loose.positions)
    for attribute, found in zip(loose.attributes, decoded.attributes, strict=True):
        assert attribute.domain == found.domain and (attribute.values == found.values).all()


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("domain", ["vertex", "corner", "face"])
def test_whole_numbers_are_exact(kind, domain):
    mesh = patch(9, 7)
    bounds = np.iinfo(kind)
    count = {"vertex": len(mesh.positions), "corner": mesh.faces.size, "face": len(mesh.faces)}[
        domain
    ]
    random = np.random.default_rng(1)
    values = random.integers(
        bounds.min, bounds.max, (count, 4), dtype=np.int64, endpoint=True
    ).astype(kind)
    values[:2] = [[bounds.min] * 4, [bounds.max] * 4]
    whole = replace(mesh, attributes=(bsm.Attribute("x", values, domain),))
    decoded = bsm.decode(bsm.encode(whole, replace(QUICK, keep_order=True)))
    found = decoded.attributes[0]
    assert found.values.dtype == kind and found.domain == domain
    assert (at_corners(decoded, found) == at_corners(whole, whole.attributes[0])).all()


@pytest.mark.parametrize("kind", [np.float32, np.float64])
def test_floats_are_exact_to_the_bit(kind):
    mesh = patch(9, 7)
    random = np.random.default_rng(2)
    values = (random.normal(size=(63, 4)) * 10.0 ** random.integers(-30, 30, (63, 4))).astype(kind)
    values[0] = [0.0, -0.0, np.finfo(kind).max, -np.finfo(kind).tiny]
    given = replace(
        mesh, attributes=(bsm.Attribute("x", values), bsm.Attribute("half", np.arange(63) / 255.0))
    )
    decoded = bsm.decode(
        bsm.encode(given, replace(QUICK, keep_order=True, attributes={"*": "exact"}))
    )
    assert decoded.attributes[0].values.tobytes() == values.tobytes()
    assert (decoded.attributes[1].values == given.attributes[1].values).all()


@pytest.mark.parametrize(
    ("name", "quality", "most"),
    [
        ("heat", "0.01", 0.01),
        ("heat", "1%", 0.02),
        ("heat", "8bits", 1 / 255),
        ("color", "10", 10),
        ("color", "5bits", 4),
    ],
)
def test_bounds_are_kept(name, quality, most):
    mesh = dressed(torus())
    encoder = bsm.Encoder(mesh, replace(QUICK, attributes={name: quality}))
    errors = compared(mesh, bsm.decode(encoder.encode()), encoder)
    assert 0.0 < errors[name] <= most


@pytest.mark.parametrize("least", [-30.0, 0.0, 20.0, 3e38])
def test_bounds_leave_room_for_rounding_to_single_precision(least):
    """Each bound from one that rounding leaves no room to one that leaves plenty."""
    count, random = 4000, np.random.default_rng(6)
    spacing = float(np.spacing(np.float32(max(abs(least), least + 80.0))))
    heat = (least + 80.0 * max(spacing, 1.0) * random.random(count)).astype(np.float32)
    strip = np.arange(count - 2)[:, None] + np.arange(3)
    positions = np.column_stack(
        [np.arange(count) // 2, np.arange(count) % 2, np.zeros(count)]
    ).astype(float)
    mesh = bsm.TriangleMesh(positions, strip.astype(np.int32), (bsm.Attribute("heat", heat),), {})
    for bound in (1e-9, 0.4 * spacing, 0.6 * spacing, spacing, 3.1 * spacing, 1000.0 * spacing):
        encoder = bsm.Encoder(
            mesh, bsm.EncodeOptions(grid=16, effort="quick", attributes={"heat": repr(bound)})
        )
        decoded = bsm.decode(encoder.encode())
        own = heat[encoder.vertex_order].astype(float)
        assert np.abs(decoded.attributes[0].values[:, 0].astype(float) - own).max() <= bound


@pytest.mark.real
@pytest.mark.parametrize(
    "name", ["BoxTextured.glb", "Duck.glb", "cortex_sulc.ply", "cubevc.glb", "fuze_uv.obj"]
)
def test_each_spelling_of_a_quality_is_kept_for_files(meshes, name):
    mesh = bsm.load(meshes / "assets" / name)
    floats = [a for a in mesh.attributes if a.values.dtype.kind == "f" and a.semantic != "normal"]
    for spelled in ("exact", "12bits", "0.01", "1%", "0.1%", "0.0001"):
        options = replace(
            QUICK, effort="quick", attributes={attribute.name: spelled for attribute in floats}
        )
        decoded = bsm.decode(bsm.encode(mesh, options))
        assert len(decoded.attributes) == len(mesh.attributes), spelled


@pytest.mark.parametrize("degrees", [10.0, 1.0, 0.05])
def test_angles_of_normals_are_kept(degrees):
    mesh = dressed(torus())
    encoder = bsm.Encoder(
        mesh, replace(QUICK, keep_order=True, attributes={"normal": f"{degrees}deg"})
    )
    decoded = bsm.decode(encoder.encode())
    wanted, found = (at_corners(each, each.attributes[2]) for each in (mesh, decoded))
    off = np.degrees(np.arccos(np.clip((wanted.astype(float) * found).sum(axis=2), -1, 1)))
    assert degrees / 8 < off.max() <= degrees + 1e-3


def smooth_normals(mesh: bsm.TriangleMesh) -> np.ndarray:
    a, b, c = (mesh.positions[mesh.faces[:, k]] for k in range(3))
    found = np.zeros_like(mesh.positions)
    np.add.at(found, mesh.faces, np.cross(b - a, c - a)[:, None])
    return found / np.linalg.norm(found, axis=1, keepdims=True)


@pytest.mark.parametrize(
    "options", [bsm.EncodeOptions(), bsm.PRESETS["grid14"]], ids=["blocks", "grid"]
)
def test_normals_can_be_recomputed(options):
    mesh = torus()
    smooth = replace(
        mesh,
        attributes=(
            bsm.Attribute("normal", np.ones((len(mesh.positions), 3)), "vertex", "normal"),
        ),
    )
    stream = bsm.encode(smooth, replace(options, normals="recompute"))
    decoded = bsm.decode(stream)
    assert len(stream) < len(bsm.encode(mesh, replace(options, congruence=False))) + 40
    found = decoded.attributes[0].values
    np.testing.assert_allclose(found, smooth_normals(decoded), atol=1e-9)


def test_recomputed_normals_keep_their_creases():
    mesh = replace(tetrahedron(), attributes=(normals(tetrahedron()),))
    decoded = bsm.decode(
        bsm.encode(mesh, replace(bsm.PRESETS["grid14"], normals="recompute", keep_order=True))
    )
    np.testing.assert_allclose(
        at_corners(decoded, decoded.attributes[0]), at_corners(mesh, mesh.attributes[0]), atol=1e-6
    )


@pytest.mark.parametrize(("outwards", "wild"), [(1.0, 0.0), (1.0, 0.2), (-1.0, 0.0), (0.0, 0.0)])
def test_the_look_chooses_normals(outwards, wild):
    """What points against its face is never made anew, be it all (-1) or a single one (0)."""
    mesh = torus(60, 40)
    noise = np.random.default_rng(0).normal(0, wild, (len(mesh.positions), 3))
    signs = np.full((len(mesh.positions), 1), outwards or 1.0)
    signs[7] *= outwards or -1.0
    own = bsm.Attribute("normal", signs * smooth_normals(mesh) + noise, "vertex", "normal")
    mesh = replace(mesh, attributes=(own,))
    streams = {how: bsm.encode(mesh, bsm.EncodeOptions(normals=how)) for how in ("look", "keep")}
    assert len(streams["look"]) < 0.95 * len(streams["keep"])
    declared = of_kind(streams["look"], packets.Declared)[0].declaration
    assert (declared.coding == RECOMPUTED) == (outwards > 0 and not wild)
    assert look(mesh, bsm.decode(streams["look"])).distance <= 1.0


@pytest.mark.parametrize("preset", ["near-lossless", "grid14"])
@pytest.mark.parametrize(
    ("tilt", "computed"), [(0.0, True), (0.9, True), (1.2, False), (None, False)]
)
def test_near_normals_are_computed(preset, tilt, computed):
    """One vertex is tilted by some degrees, or has no length."""
    mesh = torus(60, 40)
    given = smooth_normals(mesh)
    if tilt is None:
        given[7] = 0.0
    elif tilt:
        across = np.cross(given[7], [0.0, 0.0, 1.0])
        across /= np.linalg.norm(across)
        given[7] = np.cos(np.radians(tilt)) * given[7] + np.sin(np.radians(tilt)) * across
    normal = bsm.Attribute("normal", given, "vertex", "normal")
    encoded = bsm.encode(
        replace(mesh, attributes=(normal,)), replace(bsm.PRESETS[preset], normals="near")
    )
    declared = of_kind(encoded, packets.Declared)[0].declaration
    assert (declared.coding == RECOMPUTED) == computed


@pytest.mark.parametrize("preset", ["small", "balanced", "fine"])
def test_texture_coordinates_and_shapes_keep_the_look_under_a_checker(preset):
    mesh = replace(torus(30, 20), attributes=())
    mesh = replace(mesh, attributes=(atlas(mesh),))
    encoder = bsm.Encoder(mesh, bsm.PRESETS[preset])
    decoded = bsm.decode(encoder.encode())
    places = look_values(mesh, "texcoord")
    seen = AttributeLook(mesh, "texcoord", places).compare(decoded)
    assert seen <= bsm.PRESETS[preset].contract.look + 1e-3
    requested = bsm.encode(mesh, replace(bsm.PRESETS[preset], attributes={"uv": "14bits"}))
    assert np.ptp(bsm.decode(requested).attributes[0].values) > 0.0 and len(encoder.encode()) < len(
        requested
    )


@pytest.mark.parametrize(
    ("kind", "domain"), [("uint8", "vertex"), ("float32", "corner"), ("uint16", "face")]
)
def test_colors_and_shapes_keep_the_look_in_colors(kind, domain):
    mesh = replace(torus(40, 30), attributes=())
    shades = 0.5 + 0.45 * np.sin(3 * mesh.positions @ np.array([[1, 2, 0], [0, 1, 3], [2, 0, 1]]))
    rows = {
        "vertex": shades,
        "corner": shades[mesh.faces].reshape(-1, 3),
        "face": shades[mesh.faces[:, 0]],
    }[domain]
    whole = 1 if kind == "float32" else np.iinfo(kind).max
    colors = bsm.Attribute("color", (rows * whole).astype(kind), domain, "color")
    mesh = replace(mesh, attributes=(colors,))
    data, requested = (
        bsm.encode(mesh),
        bsm.encode(mesh, bsm.EncodeOptions(attributes={"color": "exact"})),
    )
    values = look_values(mesh, "color")
    assert np.ptp(values) > 0.8
    seen = AttributeLook(mesh, "color", values).compare(bsm.decode(data))
    assert 0.0 < seen <= 1.0 + 1e-3
    assert len(data) < 0.8 * len(requested)


@pytest.mark.parametrize("how", ["few", "shining through", "beyond"])
def test_colors_that_are_labels_or_in_no_picture_are_kept(how):
    mesh = replace(torus(40, 30), attributes=())
    values = np.random.default_rng(0).integers(0, 256, (len(mesh.positions), 4)).astype(np.uint8)
    if how == "few":
        values = values[np.arange(len(values)) % 200]
    if how == "beyond":
        values = values.astype(np.float32) / 51
        values[:, 3] = 1
    mesh = replace(mesh, attributes=(bsm.Attribute("color", values, "vertex", "color"),))
    encoder = bsm.Encoder(mesh)
    off = compared(mesh, bsm.decode(encoder.encode()), encoder)["color"]
    assert off <= (0.0 if how != "beyond" else 5 / 254)


def test_textures_that_are_repeated_beyond_all_pictures_keep_twelve_bits():
    values = np.float32(1e30) * torus(12, 8).positions[:, :2]
    mesh = replace(torus(12, 8), attributes=(bsm.Attribute("uv", values, "vertex", "texcoord"),))
    encoder = bsm.Encoder(mesh)
    errors = compared(mesh, bsm.decode(encoder.encode()), encoder)
    assert 0 < errors["uv"] <= 1.001 * np.ptp(values, axis=0).max() / 4095 / 2
    far = bsm.Attribute(
        "w", 1e300 * mesh.positions / np.abs(mesh.positions).max(), semantic="normal"
    )
    with pytest.raises(bsm.OptionError, match="keep them exact"):
        bsm.encode(replace(mesh, attributes=(far,)), attributes={"w": "1%"})


def test_texture_coordinates_in_whole_numbers_are_kept():
    mesh = torus(12, 8)
    whole = (1000 * (mesh.positions[:, :2] + 2)).astype(np.uint16)
    decoded = bsm.decode(
        bsm.encode(replace(mesh, attributes=(bsm.Attribute("uv", whole, "vertex", "texcoord"),)))
    )
    assert set(map(tuple, decoded.attributes[0].values)) == set(map(tuple, whole))


@pytest.mark.parametrize(
    ("asked", "error"),
    [
        ({"uv": "nonsense"}, bsm.OptionError),
        ({"uv": "-1"}, bsm.OptionError),
        ({"uv": "2deg"}, bsm.OptionError),
        ({"uv": "recompute"}, bsm.OptionError),
        ({"nothing": "exact"}, bsm.OptionError),
        ({"heat": "1e-12"}, bsm.OptionError),
        ({"normal": "1e-9deg"}, bsm.TargetError),
    ],
)
def test_what_makes_no_sense_is_refused(asked, error):
    with pytest.raises(error):
        bsm.encode(dressed(torus()), replace(QUICK, attributes=asked))


def of_kind(stream: bytes, kind: type) -> list[Any]:
    return [packet for packet, *_ in packets_of(stream, kind)]


def tolerated(stream: bytes) -> tuple[set[str], int, int]:
    """Names of attributes that were decoded, losses, and how many vertices are missing."""
    *events, end = events_of(stream, tolerant=True)
    names = {event.name for event in events if isinstance(event, bsm.AttributeEvent)}
    return names, sum(isinstance(event, bsm.LossEvent) for event in events), len(end.losses.missing)


def test_what_is_lost_of_one_attribute_spoils_none_before_it():
    mesh = dressed(curved(patch(70, 65)))
    stream = bsm.encode(mesh, bsm.EncodeOptions(grid=12))
    for which, packet in enumerate(of_kind(stream, packets.Values)):
        name = mesh.attributes[packet.attribute].name
        names, *lost = tolerated(without(stream, packets.Values, which, "changed"))
        assert lost == [1, 0]
        assert names - {name} == {
            attribute.name for attribute in mesh.attributes[: packet.attribute]
        }
        frames = frames_of(stream)
        # decoders read four bytes ahead: so many may be missing without notice
        short = [
            (kind, data[:-9] if data[0] == packet.attribute and kind == 0 else data)
            for kind, data in frames
        ]
        with pytest.raises(bsm.BsmError, match=f"attribute '{name}'"):
            bsm.decode(stream_of(short))
    names, losses, missing = tolerated(without(stream, packets.Grid, -1, "changed"))
    assert names == set() and losses == 1 and missing > 0


def test_a_lost_declaration_loses_those_behind_it():
    mesh = dressed(patch(40, 35))
    stream = bsm.encode(mesh, QUICK)
    for packet in of_kind(stream, packets.Declared):
        broken = without(stream, packets.Declared, packet.index, "changed")
        names, losses, missing = tolerated(broken)
        assert losses >= 1 and missing == 0
        assert names == {attribute.name for attribute in mesh.attributes[: packet.index]}
        with pytest.raises(bsm.BsmError):
            bsm.decode(broken)


def test_seams_that_two_share_are_sent_once():
    mesh = dressed(torus())
    second = replace(mesh.attributes[1], name="uv2", values=1 - mesh.attributes[1].values)
    mesh = replace(mesh, attributes=(*mesh.attributes, second))
    declared = of_kind(bsm.encode(mesh, QUICK), packets.Declared)
    assert [p.declaration.seams_of for p in declared] == [0, 0, 0, 0, 0, 0, 2]
    assert [bool(p.seams) for p in declared] == [False, True, True, False, False, False, False]
    encoder = bsm.Encoder(mesh, QUICK)
    assert max(compared(mesh, bsm.decode(encoder.encode()), encoder).values()) < 0.006


@pytest.mark.parametrize(("kind", "value"), [("theta_deg", 3.0), ("size", 20000.0)])
def test_targets_count_attributes(kind, value):
    mesh = dressed(torus())
    attempt = bsm.Encoder(mesh, bsm.EncodeOptions(target=bsm.Target(kind, value))).result()
    assert [a.name for a in bsm.decode(b"".join(attempt.frames)).attributes] == [
        a.name for a in mesh.attributes
    ]
    assert attempt.size == len(b"".join(attempt.frames))
    assert attempt.size <= value if kind == "size" else attempt.comparison.theta_deg <= value


@settings(max_examples=60)
@given(st.integers(0, 2**32 - 1), st.integers(1, 14), st.integers(1, 12), st.booleans())
def test_any_triangles_keep_what_they_carry(seed, vertices, faces, ordered):
    random = np.random.default_rng(seed)
    positions = random.integers(0, 3, (vertices, 3)).astype(float)
    triangles = random.integers(0, vertices, (faces, 3))
    rows = random.integers(0, 4, (int(random.integers(1, 9)), 2)).astype(np.int16)
    shared = random.integers(0, len(rows), (faces, 3))
    attributes = (
        bsm.Attribute("vertex", random.integers(0, 3, (vertices, 1)).astype(np.uint8)),
        bsm.Attribute("float", random.integers(0, 2, (vertices, 2)) * 0.3),
        bsm.Attribute("corner", rows, "corner", "generic", shared),
        bsm.Attribute("again", rows[:, ::-1], "corner", "texcoord", shared),
        bsm.Attribute("face", random.integers(-5, 5, (faces, 1)).astype(np.int8), "face"),
    )
    mesh = bsm.TriangleMesh(positions, triangles, attributes)
    encoder = bsm.Encoder(
        mesh, bsm.EncodeOptions(grid=3, keep_order=ordered, attributes={"*": "exact"})
    )
    decoded = bsm.decode(encoder.encode())
    if ordered:
        assert (decoded.faces == mesh.faces).all()
        for given, found in zip(mesh.attributes, decoded.attributes, strict=True):
            assert found.domain == given.domain
            assert (at_corners(decoded, found) == at_corners(mesh, given)).all()
            assert given.domain != "vertex" or (found.values == given.values).all()
    assert max(compared(mesh, decoded, encoder).values()) == 0.0
    split = split_by_attributes(decoded)
    for attribute in split.attributes:
        before = next(result for result in decoded.attributes if result.name == attribute.name)
        assert (at_corners(split, attribute) == at_corners(decoded, before)).all()


TURNS = {"normal": "10bits", "tangent": "9bits"}


def tangential(
    mesh: bsm.TriangleMesh, change: Callable[[np.ndarray], np.ndarray] | None = None
) -> bsm.TriangleMesh:
    """A mesh with normals, texture coordinates and tangents, these perhaps changed."""
    dressed_mesh = with_attributes(mesh, creases, charts, tangents)
    *others, last = dressed_mesh.attributes
    values = last.values if change is None else change(last.values.copy()).astype(last.values.dtype)
    return replace(dressed_mesh, attributes=(*others, replace(last, values=values)))


def coding_of_last(stream: bytes) -> int:
    return packets_of(stream, packets.Declared)[-1][0].declaration.coding


@pytest.mark.parametrize("options", [{}, {"keep_order": True}, {"effort": "quick"}], ids=str)
def test_tangents_are_turns_about_decoded_normals(options):
    mesh = tangential(torus())
    encoder = bsm.Encoder(mesh, bsm.EncodeOptions(grid=12, attributes=TURNS, **options))
    stream = encoder.encode()
    assert coding_of_last(stream) == TANGENTS
    decoded = bsm.decode(stream)
    error = compared(mesh, decoded, encoder)["tangent"]
    assert error < np.radians(0.35)  # half a step of 9 bits, and the error of normals of 10 bits
    normal, _, tangent = (
        at_corners(decoded, attribute).astype(float) for attribute in decoded.attributes
    )
    np.testing.assert_allclose(np.linalg.norm(tangent[..., :3], axis=-1), 1.0, atol=1e-6)
    assert {*np.unique(tangent[..., 3])} == {-1.0, 1.0}
    upright = np.abs((tangent[..., :3] * normal).sum(axis=-1))
    # Where corners share a tangent, they may have different normals.
    assert np.quantile(upright, 0.5) < 1e-6
    note = next(note for note in encoder.notes if note.startswith("tangent"))
    told = re.fullmatch(r"tangent: per corner, 9 bits, within ([\d.]+) degrees", note)
    assert told and error <= np.radians(float(told[1])) * 1.06
    plain = bsm.encode(mesh, grid=12, attributes=TURNS, effort="best")
    assert coding_of_last(plain) == LEVELS


def tilted(values: np.ndarray) -> np.ndarray:
    values[5] = [0.0, 0.0, 1.0, 1.0]
    values[7] = [0.0, 1.0, 0.0, 1.0]
    return values


def without_length(values: np.ndarray) -> np.ndarray:
    values[5] = 0.0
    return values


@pytest.mark.parametrize("change", [tilted, without_length, lambda values: values * [1, 1, 1, 0.5]])
def test_what_is_not_at_right_angles_or_has_no_hand_keeps_its_numbers(change):
    mesh = tangential(torus(), change)
    encoder = bsm.Encoder(mesh, bsm.EncodeOptions(grid=12, attributes=TURNS))
    stream = encoder.encode()
    assert coding_of_last(stream) == LEVELS
    assert compared(mesh, bsm.decode(stream), encoder)["tangent"] <= 1.01 / 511


@pytest.mark.parametrize(
    "options",
    [
        {"attributes": TURNS | {"tangent": "exact"}},
        {"attributes": TURNS | {"tangent": "0.001"}},
        {"attributes": TURNS | {"normal": "none"}},
        {"attributes": TURNS | {"uv": "exact"}},
        {"attributes": {"normal": "4bits", "tangent": "12bits"}},
        {"attributes": TURNS, "grid": None, "coefficients": 30},
    ],
    ids=str,
)
def test_tangents_without_near_normals_a_texture_or_a_grid_keep_their_numbers(options):
    options = {"grid": 12} | options
    stream = bsm.Encoder(tangential(torus()), bsm.EncodeOptions(contract=None, **options)).encode()
    assert coding_of_last(stream) != TANGENTS


def test_tangents_are_lost_with_their_texture():
    stream = bsm.encode(tangential(curved(patch(70, 65))), grid=12, attributes=TURNS)
    assert coding_of_last(stream) == TANGENTS
    names, losses, missing = tolerated(without(stream, packets.Declared, 1, "changed"))
    assert (names, missing) == ({"normal"}, 0) and losses >= 1
    names, losses, missing = tolerated(without(stream, packets.Grid, -1, "changed"))
    assert names == set() and losses == 1 and missing > 0
