"""`bsm compare` and `bsm.look`: the same answers, pictures on request, and meshes of another numbering."""

import sys
from dataclasses import replace

import numpy as np
import pytest

import bsm
from bsm import (
    Attribute,
    EncodeOptions,
    Encoder,
    FormatError,
    MeshError,
    TriangleMesh,
    decode,
    read_mesh,
)
from bsm.account.comparison import in_order_of, read_permutation, reorder, write_permutation
from bsm.cli import main
from bsm.codec.look.measure import LOOK_VERSION, LookMetric
from tests.bsm.program import run_json
from tests.shapes import knot, soup, tetrahedron, torus


@pytest.fixture
def files(tmp_path):
    mesh = torus(30, 20)
    bsm.save(mesh, tmp_path / "a.ply")
    bsm.save(mesh, tmp_path / "b.bsm", theta=4)
    bsm.save(tetrahedron(), tmp_path / "other.off")
    return tmp_path


def test_the_command_says_what_python_says(files, capsys):
    seen = bsm.look(files / "a.ply", files / "b.bsm")
    found = run_json("compare", files / "a.ply", files / "b.bsm", "--look")
    original, decoded = (read_mesh(files / "a.ply").mesh, bsm.decode(files / "b.bsm"))
    assert found["look"] == {
        "distance": seen.distance,
        "version": LOOK_VERSION,
        "unlike": seen.unlike,
        "gone": seen.gone,
        "flat": pytest.approx(LookMetric(original).flat(decoded)),
    }
    assert seen.distance > 0
    assert found["theta_deg"] <= 4
    assert "look" not in run_json("compare", files / "a.ply", files / "b.bsm")
    assert main(["compare", str(files / "a.ply"), str(files / "b.bsm"), "--look"]) == 0
    assert (found["folded_before"], found["folded_after"]) == (0, 0)
    lines = capsys.readouterr().out.splitlines()[-2:]
    assert (
        lines[0].startswith(f"look               {seen.distance:.6g} ")
        and "look distance" in lines[0]
    )
    assert lines[1].startswith("look_flat          ")


def test_meshes_of_other_faces_are_looked_at(files):
    found = run_json("compare", files / "a.ply", files / "other.off", "--look")
    assert list(found) == ["look"]
    assert found["look"]["distance"] > 1
    assert main(["compare", str(files / "a.ply"), str(files / "other.off")]) == 3


def test_a_picture_shows_both_and_the_difference(files):
    image = pytest.importorskip("PIL.Image")
    target = files / "seen.png"
    run_json("compare", files / "a.ply", files / "b.bsm", "--picture", target)
    with image.open(target) as picture:
        assert picture.size == (3 * 384, 432)
        colors = np.asarray(picture.convert("RGB")).astype(int)
    assert (np.ptp(colors[60:300, :384], axis=2) < 30).all() and colors[60:300, :384].min() < 150, (
        "a gray mesh"
    )
    assert np.ptp(colors[60:300, 768:], axis=2).max() > 100, "errors in colors"
    again = ["compare", str(files / "a.ply"), str(files / "b.bsm"), "--picture", str(target)]
    assert main(again) != 0
    assert main([*again, "-f"]) == 0


def test_a_picture_needs_no_library(files, monkeypatch):
    monkeypatch.setitem(sys.modules, "PIL", None)
    monkeypatch.setitem(sys.modules, "PIL.Image", None)
    assert (
        main(
            [
                "compare",
                str(files / "a.ply"),
                str(files / "b.bsm"),
                "--picture",
                str(files / "own.png"),
            ]
        )
        == 0
    )
    assert (files / "own.png").read_bytes().startswith(b"\x89PNG")


def test_what_has_no_area_is_a_sentence(files, capsys):
    bsm.save(([(0, 0, 0), (1, 0, 0), (2, 0, 0)], [(0, 1, 2)]), files / "line.off")
    assert main(["compare", str(files / "line.off"), str(files / "a.ply"), "--look"]) == 3
    assert "cannot be looked at" in capsys.readouterr().err


def test_triangles_without_area_and_vertices_at_one_place_are_counted_beyond_the_inputs(
    tmp_path, capsys
):
    faces = [(0, 1, 2), (2, 1, 3), (0, 2, 4), (4, 2, 3), (0, 1, 5)]
    before = np.array(
        [(0, 0, 0), (1, 0, 0), (0.4, 0.1, 0), (1, 1, 0), (0, 1, 0), (2, 0, 0)]
    )  # the last is flat already
    after = before.copy()
    after[2] = 0.5, 0.0, 0.0  # on the line of 0 and 1, and so the first face
    found = bsm.compare((before, faces), (after, faces))
    assert (found.flattened, found.merged) == (1, 0)
    after[2] = before[4]
    found = bsm.compare((before, faces), (after, faces))
    assert (found.flattened, found.merged) == (2, 1)
    assert (
        bsm.compare((after, faces), (after, faces)).flattened,
        bsm.compare((before, faces), (before, faces)).merged,
    ) == (0, 0)
    bsm.save((before, faces), tmp_path / "a.ply")
    bsm.save((after, faces), tmp_path / "b.ply")
    assert main(["compare", str(tmp_path / "a.ply"), str(tmp_path / "b.ply"), "-q"]) == 0
    line = capsys.readouterr().out.splitlines()[0]
    assert line.endswith("; 2 triangles flattened by rounding; 1 vertex merged by rounding")
    found = run_json("compare", tmp_path / "a.ply", tmp_path / "b.ply")
    assert (found["flattened"], found["merged"]) == (2, 1)


SAMPLE = knot(600)


def renumbered(mesh, order):
    """Vertex j of the result is vertex order[j] of `mesh`."""
    places = np.argsort(order)
    return TriangleMesh(mesh.positions[order], places[mesh.faces])


@pytest.fixture(scope="module")
def order():
    return np.random.default_rng(0).permutation(len(SAMPLE.positions))


def test_reorder_undoes_a_numbering(order):
    back = reorder(renumbered(SAMPLE, order), order)
    assert np.array_equal(back.positions, SAMPLE.positions)
    assert np.array_equal(back.faces, SAMPLE.faces)


def test_equal_numbering_is_recognized_whatever_the_order_of_faces_and_corners():
    shuffled = np.random.default_rng(1).permutation(np.roll(SAMPLE.faces, 1, axis=1))
    other = TriangleMesh(SAMPLE.positions + 1, shuffled)
    assert np.array_equal(in_order_of(SAMPLE, other), other.positions)


@pytest.mark.parametrize("shift", range(4))
def test_a_symmetric_mesh_is_matched_vertex_by_vertex(shift):
    from bsm.bitstream.connectivity.faces import encode_connectivity

    faces = np.roll(np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]), shift, axis=0)
    mesh = TriangleMesh(np.array([[0, 0, 0], [1, 0, 0], [0, 2, 0], [0, 0, 3]]), faces)
    coded = encode_connectivity(faces, 4)
    decoded = TriangleMesh(mesh.positions[coded.vertex_order], coded.faces)
    assert np.array_equal(in_order_of(mesh, decoded), mesh.positions)


def test_other_faces_are_refused(order):
    flipped = TriangleMesh(SAMPLE.positions, SAMPLE.faces[:, ::-1])
    with pytest.raises(MeshError, match="--permutation"):
        in_order_of(SAMPLE, flipped)
    with pytest.raises(MeshError, match="different faces"):
        in_order_of(SAMPLE, renumbered(SAMPLE, order), np.arange(len(order)))
    with pytest.raises(MeshError, match="faces"):
        in_order_of(SAMPLE, TriangleMesh(SAMPLE.positions, SAMPLE.faces[1:]))
    with pytest.raises(MeshError, match="permutation"):
        reorder(SAMPLE, order[1:])


def test_faces_that_collapsed_are_told_apart():
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [1, 1, 0.001], [0, 1, 0]])
    before = TriangleMesh(square, np.array([[0, 1, 2], [1, 3, 2], [2, 3, 4], [0, 2, 4]], np.int32))
    for faces, told in (([[0, 1, 2], [0, 2, 3]], True), ([[0, 1, 2], [1, 2, 3]], False)):
        after = TriangleMesh(square[[0, 1, 2, 4]] + 1e-4, np.array(faces, np.int32))
        with pytest.raises(MeshError, match="different faces") as caught:
            in_order_of(before, after)
        assert ("collapsed where vertices merged" in str(caught.value)) == told


def test_an_attribute_of_another_name_is_found_by_its_meaning():
    shape, values = torus(8, 6), np.linspace(0.0, 1.0, 96, dtype=np.float32).reshape(48, 2)
    given = replace(
        shape,
        attributes=(Attribute("texcoord", values, semantic="texcoord"), Attribute("heat", values)),
    )
    uv, heat = (
        Attribute("uv", values + np.float32(0.5), semantic="texcoord"),
        Attribute("warmth", values),
    )
    errors = bsm.compare(given, replace(shape, attributes=(heat, uv))).attributes
    assert errors["texcoord"] is not None and errors["texcoord"].max_error == pytest.approx(
        0.5, abs=1e-6
    )
    assert errors["heat"] is None


def test_files(tmp_path, order):
    path = tmp_path / "order.npy"
    write_permutation(path, order, overwrite=False)
    assert np.array_equal(read_permutation(path), order)
    for content in (b"", b"no array", path.read_bytes()[:-8]):
        path.write_bytes(content)
        with pytest.raises(FormatError):
            read_permutation(path)
    for wrong in (np.zeros(3), np.zeros(3, int), np.zeros((2, 2), int)):
        np.save(path, wrong)
        with pytest.raises(FormatError):
            read_permutation(path)


def test_vertices_that_were_made_one_are_compared_with_that_one():
    mesh = knot(200)
    apart = soup(mesh)
    encoder = Encoder(apart, EncodeOptions(grid=16))
    decoded = decode(encoder.encode())
    for order in (None, encoder.vertex_order):
        assert np.abs(in_order_of(apart, decoded, order) - apart.positions).max() < 1e-3


def test_an_order_counts_vertices_that_no_face_uses(tmp_path):
    apart, near = (
        np.full((2, 3), 9.0),
        np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 0, 0], [1, 1, 0.2], [0, 1, 0]]),
    )
    mesh = TriangleMesh(np.concatenate([apart, near]), [[2, 3, 4], [5, 6, 7]])
    for keep in (False, True):
        encoder = Encoder(mesh, EncodeOptions(grid=10, keep_order=keep))
        decoded, order = decode(encoder.encode()), encoder.vertex_order
        assert bsm.compare(mesh, decoded, order=order).max_error_relative < 1e-3
    for wrong in (order * 0, order + 1, order[1:]):
        with pytest.raises(MeshError, match="permutation"):
            bsm.compare(mesh, decoded, order=wrong)


@pytest.mark.parametrize("preset", ["lossless", "grid14"])
def test_vertices_that_differ_in_the_sign_of_zero_are_as_many_as_the_encoder_keeps(preset):
    """Lossless streams join vertices by their bits, others by their values."""
    mesh = torus(9, 7)
    places = np.concatenate([mesh.positions, mesh.positions[:3], mesh.positions[:1]])
    places[0] = places[-4] = (0.0, 1.0, 2.0)
    places[-1] = (-0.0, 1.0, 2.0)
    faces = mesh.faces.copy()
    uses = np.argwhere(faces == 0)
    for (row, column), other in zip(uses[:2], (len(mesh.positions), len(places) - 1)):
        faces[row, column] = other
    mesh = TriangleMesh(places, faces)
    encoder = Encoder(mesh, EncodeOptions(preset=preset))
    decoded = decode(encoder.encode())
    found = bsm.compare(mesh, decoded, order=encoder.vertex_order)
    assert found.max_error_relative < 1e-3
    assert len(decoded.positions) == len(np.unique(mesh.positions[np.unique(faces)], axis=0)) + (
        preset == "lossless"
    )


def test_a_mesh_that_a_file_split_is_compared_where_rounding_merged_vertices():
    decoded = decode(bsm.encode(SAMPLE, grid=4))
    found = bsm.compare(SAMPLE, soup(decoded))
    assert found.merged > 0 and found == bsm.compare(SAMPLE, decoded)


def test_other_axes_and_units_are_named(tmp_path, capsys):
    mesh = torus(9, 7)
    for name, known in {
        "a": {"up": "y", "unit": "meters"},
        "b": {"up": "Y", "unit": "meter"},
        "c": {"up": "z", "unit": "mm"},
        "d": {},
    }.items():
        bsm.save(TriangleMesh(mesh.positions, mesh.faces, metadata=known), tmp_path / f"{name}.npz")
    for name, notes in (("b", 0), ("c", 2), ("d", 0)):
        assert main(["compare", str(tmp_path / "a.npz"), str(tmp_path / f"{name}.npz")]) == 0
        assert capsys.readouterr().err.count("positions are compared as they are") == notes


@pytest.mark.parametrize("suffix", ["ply", "glb", "obj"])
def test_colors_are_compared_as_shares_where_one_has_bytes(tmp_path, suffix):
    ring = torus(9, 6)
    shares = np.linspace(0.0, 1.0, len(ring.positions), dtype=np.float32)[:, None] * np.ones(
        3, np.float32
    )
    painted = replace(ring, attributes=(Attribute("color", shares, "vertex", "color"),))
    bsm.save(painted, tmp_path / f"a.{suffix}")
    found = bsm.compare(painted, tmp_path / f"a.{suffix}").attributes["color"]
    assert found is not None and found.max_error <= 0.51 / 255 and found.range == pytest.approx(1.0)


@pytest.mark.parametrize("size", [1e-69, 1e69])
def test_meshes_of_any_size_are_compared_alike_or_not_at_all(size):
    positions, faces = torus(8, 6).positions, torus(8, 6).faces
    moved = positions + np.random.default_rng(0).normal(0.0, 0.01, positions.shape)
    expected, found = (
        bsm.compare((scale * positions, faces), (scale * moved, faces)) for scale in (1.0, size)
    )
    assert found.theta_deg == pytest.approx(expected.theta_deg)
    assert found.nmsve == pytest.approx(expected.nmsve)
    assert found.max_error_relative == pytest.approx(expected.max_error_relative)
    for beyond in (size**1.1, size**2):
        with pytest.raises(bsm.MeshError, match="can be compared"):
            bsm.compare((beyond * positions, faces), (beyond * moved, faces))


@pytest.mark.parametrize("turn", [0, 1, 2])
def test_faces_whose_normals_are_rounding_count_nowhere(turn):
    """Needles of 1e-11, whichever corner of theirs comes first."""
    mesh = torus(12, 8)
    far = len(mesh.positions) + np.arange(30).reshape(-1, 3)
    needles = np.tile([(3.0, 0.0, 0.0), (4.0, 0.0, 0.0), (4.0, 1e-11, 0.0)], (10, 1)) + np.repeat(
        np.eye(10)[:, :1], 3, 0
    )
    positions, faces = (
        np.concatenate([mesh.positions, needles]),
        np.concatenate([mesh.faces, far]).astype(np.int32),
    )
    turned = np.roll(faces, turn, axis=1)
    assert bsm.compare((positions, turned), (positions, faces)).theta_deg == 0.0
    moved = positions + 1e-3 * np.sin(9.0 * positions)
    moved[far] = positions[far]
    found, bare = (
        bsm.compare((positions, turned), (moved, faces)),
        bsm.compare(mesh, (moved[: far[0, 0]], mesh.faces)),
    )
    assert found.theta_deg == pytest.approx(bare.theta_deg)
    assert found.angle_deg == pytest.approx(bare.angle_deg)


def test_vertices_that_single_precision_makes_one_are_compared():
    mesh = torus(12, 8)
    apart = np.concatenate([mesh.positions, mesh.positions[:1] * (1 + 1e-9)])
    faces = mesh.faces.copy()
    faces[np.unravel_index(np.argmax(faces == 0), faces.shape)] = len(mesh.positions)
    color = Attribute(
        "color", np.arange(3 * len(apart)).reshape(-1, 3).astype(np.uint16), "vertex", "color"
    )
    given = TriangleMesh(apart, faces, (color,))
    found = bsm.compare(given, bsm.encode(given, preset="lossless"))
    assert 0.0 < found.max_error_relative < 1e-7
    assert found.attributes["color"].max_error == 0


def test_the_line_of_encode_counts_faces_without_area_as_compare_does(files, capsys):
    found = run_json("encode", files / "a.ply", "-o", files / "flat.bsm", "--grid", "3")
    assert (
        found["flattened"]
        == run_json("compare", files / "a.ply", files / "flat.bsm")["flattened"]
        > 0
    )
    assert (
        main(["encode", str(files / "a.ply"), "-o", str(files / "flat.bsm"), "-f", "--grid", "3"])
        == 0
    )
    assert f", {found['flattened']} triangles flattened by rounding" in capsys.readouterr().err
    assert run_json("encode", files / "a.ply", "-o", files / "kept.bsm")["flattened"] == 0
    assert main(["encode", str(files / "a.ply"), "-o", str(files / "kept.bsm"), "-f"]) == 0
    assert "flattened" not in capsys.readouterr().err
