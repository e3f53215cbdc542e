"""`bsm encode --simplify`: fewer triangles where they keep the promise to the original, all of them elsewhere."""

import json

import numpy as np
import pytest
from scipy.spatial import ConvexHull

import bsm
from bsm.codec.geometry.metrics import distances_to_surface, surface_distance
from bsm.encoding.simplification import Source, collapsed, slid
from tests.bsm.program import bsm as program
from tests.bsm.program import process
from tests.shapes import grid_faces, together, torus


def ball(vertices: int, rough: float = 0.0) -> bsm.TriangleMesh:
    """A ball of scattered vertices, with some noise."""
    random = np.random.default_rng(0)
    points = random.normal(size=(vertices, 3))
    points /= np.linalg.norm(points, axis=1)[:, None]
    faces = ConvexHull(points).simplices
    a, b, c = (points[faces[:, corner]] for corner in range(3))
    inwards = np.einsum("ij,ij->i", np.cross(b - a, c - a), a) < 0
    faces[inwards] = faces[inwards][:, ::-1]
    return bsm.TriangleMesh(points * (1.0 + rough * random.normal(size=(vertices, 1))), faces)


SMOOTH = ball(4000)


def test_a_smooth_ball_gets_smaller_and_keeps_the_promise(tmp_path):
    path, stream = tmp_path / "ball.ply", tmp_path / "ball.bsm"
    bsm.save(SMOOTH, path)
    done = process(
        "encode", path, "-o", stream, "--simplify", "--preset", "small", "--json", text=True
    )
    assert done.returncode == 0, done.stderr
    facts, decoded = json.loads(done.stdout), bsm.decode(stream)
    plain = bsm.encode(path, preset="small")
    assert len(decoded.faces) == facts["faces"] <= 0.8 * len(SMOOTH.faces)
    assert facts["faces_before"] == len(SMOOTH.faces)
    assert f"{len(decoded.faces)} faces, " in done.stderr
    assert f"{len(SMOOTH.faces)} faces before simplifying" in done.stderr
    assert facts["bytes"] < 0.85 * len(plain)
    assert bsm.look(path, stream).distance == pytest.approx(facts["look"])
    assert facts["look"] <= 3.0
    apart = surface_distance(
        SMOOTH.positions, SMOOTH.faces, decoded.positions, decoded.faces
    ).hausdorff
    assert (
        apart
        <= 1.05 * facts["max_error_relative"] * SMOOTH.diagonal
        <= 1.05 * 0.02 * SMOOTH.diagonal
    )
    assert bsm.encode(path, preset="small", simplify=True) == stream.read_bytes()
    (row,) = bsm.encode_many([path], tmp_path / "many/", preset="small", simplify=True)
    assert (row["faces"], row["bytes"]) == (facts["faces"], facts["bytes"])


def test_a_rough_ball_is_kept_whole(tmp_path):
    path = tmp_path / "rough.ply"
    bsm.save(ball(2000, rough=0.01), path)
    done = program("encode", path, "--simplify", text=True)
    assert done.returncode == 0 and "all triangles are kept" in done.stderr
    assert (tmp_path / "rough.bsm").read_bytes() == bsm.encode(path)


def test_without_a_look_the_distance_between_surfaces_is_kept():
    data = bsm.encode(SMOOTH, preset="none", max_error=0.004, simplify=True)
    decoded = bsm.decode(data)
    assert len(decoded.faces) < len(SMOOTH.faces) // 4
    for one, other in ((SMOOTH, decoded), (decoded, SMOOTH)):
        far = distances_to_surface(one.positions, other.positions, other.faces).max()
        assert far <= 0.004 * SMOOTH.diagonal


def test_vertices_slide_in_the_plane_to_where_they_are_even_and_borders_stay():
    even = np.insert(np.argwhere(np.ones((12, 12))) / 12.0, 2, 0.0, axis=1)
    inside = ((even[:, :2] > 0.01) & (even[:, :2] < 0.9)).all(axis=1)
    moved = even + inside[:, None] * np.random.default_rng(0).uniform(-0.03, 0.03, even.shape) * [
        1,
        1,
        0,
    ]
    positions, faces, *_, quadrics = collapsed(moved, grid_faces(12, 12), np.zeros(144, bool), 242)
    found = slid(positions, faces, quadrics, 0.1)
    assert np.abs(found[:, 2]).max() < 1e-12 and np.array_equal(found[~inside], even[~inside])
    assert np.square(found - even).sum() < 0.4 * np.square(moved - even).sum()


def test_a_small_part_has_a_bound_of_its_own():
    small = bsm.TriangleMesh(0.05 * ball(1000).positions + [1.5, 0, 0], ball(1000).faces)
    faces = np.concatenate([SMOOTH.faces, small.faces + 4000])
    both = bsm.TriangleMesh(np.concatenate([SMOOTH.positions, small.positions]), faces)
    source = Source(both, bsm.EncodeOptions(contract=bsm.Contract(0.01, by_part=0.01)))
    reach = np.repeat([0.01, 0.001], [4000, 1000]) * both.diagonal
    parts = slice(4000), slice(4000, None)
    for moved, part in (
        (0.005, parts[0]),
        (0.012, parts[0]),
        (0.0008, parts[1]),
        (0.0012, parts[1]),
    ):
        positions = both.positions.copy()
        positions[part, 1] += moved * both.diagonal
        other, bound = bsm.TriangleMesh(positions, both.faces), 0.001 if part.start else 0.01
        share = source.apart(other, reach)
        assert source.distance(other) == pytest.approx(moved * both.diagonal, rel=0.1)
        assert share == pytest.approx(moved / bound, rel=0.1) if moved > bound else share <= 1.0


def test_colors_and_normals_stay():
    mesh = ball(1500)
    up = mesh.positions[:, 2:] / 2 + 0.5
    shades = np.rint(255 * np.hstack([up, 1 - up, up])).astype(np.uint8)
    given = [bsm.Attribute("color", shades, semantic="color")]
    given += [bsm.Attribute("normal", mesh.positions.astype(np.float32), semantic="normal")]
    dressed = bsm.TriangleMesh(mesh.positions, mesh.faces, given, {"name": "ball"})
    decoded = bsm.decode(bsm.encode(dressed, preset="none", look=9, simplify=True))
    assert len(decoded.faces) < len(mesh.faces) and decoded.metadata == {"name": "ball"}
    color, normal = (attribute.values.astype(float) for attribute in decoded.attributes)
    outwards = decoded.positions / np.linalg.norm(decoded.positions, axis=1)[:, None]
    assert np.abs(color[:, 0] - 255 * (outwards[:, 2] / 2 + 0.5)).max() < 40
    assert np.einsum("ij,ij->i", normal, outwards).min() > 0.9
    speckles = np.random.default_rng(1).integers(0, 256, (1500, 3)).astype(np.uint8)
    spots = bsm.Attribute("color", speckles, semantic="color")
    noisy = Source(bsm.TriangleMesh(mesh.positions, mesh.faces, [spots]), bsm.PRESETS["small"])
    assert noisy.look(noisy.full_mesh) == 0.0
    assert noisy.stand_in(16, 0).spent > 1.0


@pytest.mark.parametrize(
    ("options", "reason"),
    [
        ({"preset": "lossless"}, "needs a promise"),
        ({"grid": 12, "preset": "none"}, "needs a promise"),
        ({"step": 0.01}, "needs a promise"),
        ({"keep_order": True}, "excludes keep_order"),
        ({"theta": 5.0}, "excludes targets"),
    ],
)
def test_what_needs_the_triangles_of_the_original_is_refused(options, reason):
    with pytest.raises(bsm.OptionError, match=reason):
        bsm.encode(torus(), simplify=True, **options)


def test_seams_and_other_attributes_are_refused():
    mesh = torus()
    corners = np.arange(3 * len(mesh.faces), dtype=np.int32).reshape(-1, 3)
    places = bsm.Attribute("texcoord", np.zeros((len(mesh.positions), 2)), semantic="texcoord")
    normals = np.random.default_rng(0).normal(size=(corners.size, 3)).astype(np.float32)
    seams = bsm.Attribute("normal", normals, "corner", "normal", corners)
    for attribute, reason in ((places, "not texcoord: leave it out"), (seams, "normal has seams")):
        given = bsm.TriangleMesh(mesh.positions, mesh.faces, [attribute])
        with pytest.raises(bsm.OptionError, match=reason):
            bsm.encode(given, simplify=True)
        assert bsm.encode(given, simplify=True, attributes={attribute.name: "none"})


def test_sequences_and_permutations_are_refused(tmp_path):
    bsm.save(torus(), tmp_path / "a.ply")
    order = program(
        "encode", tmp_path / "a.ply", "--simplify", "--permutation", tmp_path / "p.npy", text=True
    )
    assert order.returncode == 2 and "--permutation orders all vertices" in order.stderr
    with pytest.raises(bsm.ArgumentError, match="simplify is for single meshes"):
        bsm.encode_sequence(np.array([torus().positions] * 2), torus().faces, simplify=True)


@pytest.mark.filterwarnings("ignore:no look is promised")
def test_a_mesh_without_area_keeps_its_faces():
    for width, options in ((0, {"simplify": True}), (0, {"size": 1000}), (1, {"simplify": True})):
        flat = bsm.TriangleMesh(
            np.arange(4)[:, None] * [width, 0, 0], np.array([[0, 1, 2], [1, 2, 3]])
        )
        assert len(bsm.decode(bsm.encode(flat, **options)).faces) == 2


def test_meshes_of_different_faces_are_compared_as_surfaces(tmp_path):
    bsm.save(torus(), tmp_path / "a.ply")
    bsm.save(together(torus(30, 20)), tmp_path / "b.ply")
    done = program("compare", tmp_path / "a.ply", tmp_path / "b.ply", text=True)
    assert done.returncode == 3 and "bsm compare --look --surface" in done.stderr
    done = program(
        "compare", tmp_path / "a.ply", tmp_path / "b.ply", "--surface", "--json", text=True
    )
    a, b = (bsm.load(tmp_path / name) for name in ("a.ply", "b.ply"))
    expected = surface_distance(a.positions, a.faces, b.positions, b.faces)
    assert json.loads(done.stdout)["hausdorff"] == expected.hausdorff
    assert "vertices are not compared: the meshes have different faces" in done.stderr
    bsm.save(bsm.TriangleMesh(1e150 * torus().positions, torus().faces), tmp_path / "b.ply")
    done = program(
        "compare", tmp_path / "a.ply", tmp_path / "b.ply", "--surface", "--json", text=True
    )
    assert done.returncode == 3 and "e+150 from the origin" in done.stderr
