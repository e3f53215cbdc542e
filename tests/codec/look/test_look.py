"""Looking the same: known answers, what must be seen, and what must not."""

import math
from dataclasses import replace
from itertools import pairwise, product

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from bsm import (
    PRESETS,
    Attribute,
    BsmWarning,
    Encoder,
    Look,
    MeshError,
    TargetError,
    TriangleMesh,
    decode,
    encode,
    read_mesh,
)
from bsm.codec.look.measure import LookMetric, look, summed
from bsm.codec.look.pictures import (
    CREASE,
    LEAST_PIXELS,
    Canvas,
    Shape,
    Size,
    axes,
    cameras,
    difference,
)
from tests.shapes import patch, soup, tetrahedron, together, torus, turned

MESH = torus(60, 40)


def moved(mesh, positions):
    return TriangleMesh(positions, mesh.faces)


def noisy(mesh, size, seed=0):
    noise = np.random.default_rng(seed).uniform(-1, 1, mesh.positions.shape)
    return moved(mesh, mesh.positions + size * mesh.diagonal * noise)


def plane(rows):
    """A square patch without its bumps."""
    mesh = patch(rows, rows)
    return moved(mesh, mesh.positions * (1, 1, 0))


def slid(mesh, size):
    """Inner vertices of a plane moved within it."""
    low, high = mesh.positions.min(axis=0), mesh.positions.max(axis=0)
    inside = ((mesh.positions > low) & (mesh.positions < high))[:, :2].all(axis=1)
    noise = (
        np.random.default_rng(0).uniform(-size, size, mesh.positions.shape)
        * mesh.diagonal
        * (1, 1, 0)
    )
    return moved(mesh, mesh.positions + noise * inside[:, None])


# ------------------------------------------------------------------------------------------------ the same


def test_the_same_mesh_is_at_distance_nothing():
    seen = look(MESH, MESH)
    assert seen.distance < 1e-3
    assert seen.unlike < 1e-3 and seen.gone == 0


def test_order_of_vertices_and_faces_does_not_count():
    random = np.random.default_rng(1)
    order = random.permutation(len(MESH.positions))
    back = np.argsort(order)
    faces = back[MESH.faces][random.permutation(len(MESH.faces))]
    turned = np.roll(faces, 1, axis=1)
    other = TriangleMesh(MESH.positions[order], turned)
    assert look(MESH, other).distance < 0.01
    worse = noisy(MESH, 0.001)
    known = look(MESH, worse)
    found = look(MESH, TriangleMesh(worse.positions[order], turned))
    assert found.distance == pytest.approx(known.distance, rel=0.02)


def test_splitting_vertices_and_faces_does_not_count():
    assert look(MESH, soup(MESH)).distance < 1e-3
    assert look(soup(MESH), MESH).distance < 1e-3
    flat = plane(12)
    halves = (flat.positions[flat.faces[:, 0]] + flat.positions[flat.faces[:, 1]]) / 2
    first, second, third = flat.faces.T
    middle = len(flat.positions) + np.arange(len(halves))
    faces = np.vstack(
        [np.column_stack([first, middle, third]), np.column_stack([middle, second, third])]
    )
    assert look(flat, TriangleMesh(np.vstack([flat.positions, halves]), faces)).distance < 0.05


@pytest.mark.parametrize("scale", [1e-200, 1e-9, 3.0, 1e12, 1e140])
def test_scale_and_place_do_not_count(scale):
    worse = noisy(MESH, 0.002)
    known = look(MESH, worse)
    offset = np.array([1.0, -2.0, 3.0])
    large, larger = (moved(mesh, (mesh.positions + offset) * scale) for mesh in (MESH, worse))
    assert look(large, larger).distance == pytest.approx(known.distance, rel=0.01)


def test_sliding_within_a_plane_does_not_count():
    flat = plane(20)
    assert look(flat, slid(flat, 0.008)).distance < 0.1
    lifted = (
        flat.positions
        + np.random.default_rng(0).normal(0, 0.002, flat.positions.shape) * flat.diagonal
    )
    assert look(flat, moved(flat, lifted)).distance > 1


# ------------------------------------------------------------------------------------------------ different


def test_noise_is_seen_the_more_of_it():
    looker = LookMetric(MESH)
    distances = [
        looker.distance(noisy(MESH, size).positions)
        for size in (1e-4, 2e-4, 4e-4, 8e-4, 1.6e-3, 3.2e-3)
    ]
    assert distances == sorted(distances)
    assert distances[0] < 1 < distances[-1]


def test_a_missing_part_is_seen():
    small = moved(tetrahedron(), tetrahedron().positions * 0.1 + MESH.positions.max(axis=0))
    both = together(MESH, small)
    assert look(both, MESH).distance > 3
    assert look(both, both).distance < 1e-3


@pytest.mark.real
@pytest.mark.parametrize(
    "name", ["static/c3d_spot.ply", "static/fandisk_6475.ply", "assets/robot_forearm.obj"]
)
def test_bits_of_a_quantizer_are_seen_one_by_one(meshes, name):
    mesh = read_mesh(meshes / name).mesh.bare
    looker = LookMetric(mesh)
    low, extent = mesh.positions.min(axis=0), np.ptp(mesh.positions, axis=0).max()
    distances = []
    for bits in range(8, 16):
        step = extent / (2**bits - 1)
        distances.append(looker.distance(low + np.rint((mesh.positions - low) / step) * step))
    # A crease near 40 degrees may be shaded otherwise by chance, which strikes.
    assert all(finer < coarser + 0.1 for coarser, finer in pairwise(distances))
    assert 2**0.5 < (distances[1] / distances[-1]) ** (1 / 6) < 2**1.5


def test_both_sides_of_a_face_are_lit_alike():
    turned = TriangleMesh(MESH.positions, MESH.faces[:, ::-1])
    assert look(MESH, turned).distance < 0.01


def test_normals_that_a_mesh_has_are_looked_at_too():
    smooth = Shape.of(MESH.positions, MESH.faces).normals(MESH.positions).reshape(-1, 3)
    own = TriangleMesh(
        MESH.positions, MESH.faces, (Attribute("normal", smooth, "corner", "normal"),)
    )
    assert look(own, own).distance < 1e-3
    assert look(own, MESH).distance < 0.01  # normals of doubles
    tilted = smooth + np.array([0.5, 0.0, 0.0], np.float32)
    other = TriangleMesh(
        MESH.positions, MESH.faces, (Attribute("normal", tilted, "corner", "normal"),)
    )
    assert look(own, other).distance > 1
    assert look(MESH, other).distance < 1e-3


@pytest.mark.parametrize(("degrees", "enough"), [(0.5, True), (1.8, False)])
def test_normals_that_are_turned_do_not_pass_where_pictures_show_little(degrees, enough):
    smooth = Shape.of(MESH.positions, MESH.faces).normals(MESH.positions)
    looker = LookMetric(
        TriangleMesh(
            MESH.positions,
            MESH.faces,
            (Attribute("normal", smooth.reshape(-1, 3), "corner", "normal"),),
        )
    )
    own = smooth.reshape(-1, 3)
    aside = np.cross(own, np.random.default_rng(0).normal(size=3))
    turned = own + math.tan(math.radians(degrees)) * aside / np.linalg.norm(
        aside, axis=1, keepdims=True
    )
    turned /= np.linalg.norm(turned, axis=1, keepdims=True)
    found = looker.shaded(MESH.positions, np.ascontiguousarray(turned.reshape(-1, 9), np.float32))
    assert (max(found) <= 1.0) == enough
    assert not looker.against_faces


def test_positions_are_looked_at_by_normals_that_the_original_has():
    # Every face shaded by itself.
    shades = np.random.default_rng(0).normal(size=(len(MESH.faces), 3))
    own = Attribute("normal", np.repeat(shades, 3, axis=0), "corner", "normal")
    worse = noisy(MESH, 0.002)
    known = look(
        TriangleMesh(MESH.positions, MESH.faces, (own,)),
        TriangleMesh(worse.positions, MESH.faces, (own,)),
    )
    assert (
        LookMetric(TriangleMesh(MESH.positions, MESH.faces, (own,))).look(worse.positions) == known
    )
    assert known.distance > LookMetric(MESH).distance(worse.positions)


# ------------------------------------------------------------------------------------------------ known answers


def test_the_distance_is_one_at_its_bounds():
    def judged(unlike: float, gone: float) -> Look:
        return summed(np.array([[unlike, gone]]))

    assert judged(0.0155, 0.0).distance == judged(0.0, 0.08).distance == 1
    assert judged(0.031, 0.08).distance == pytest.approx(2 ** (4 / 3))
    assert judged(0.0155, 0.16).distance == 4
    assert judged(0.0, 0.0).distance == 0


def test_a_square_from_above_has_one_shade():
    square = TriangleMesh([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2), (0, 2, 3)])
    camera = cameras(square.positions, 400)[0]
    normals = np.tile(np.array([0, 0, 1], np.float32), (2, 3))
    canvas = Canvas(400)
    picture, samples = canvas.draw(square.positions, square.faces, normals, camera), canvas.samples
    inside = samples < 1
    towards = axes((2, 2, 1))
    cosine = 0.35 * towards[0, 2] + 0.5 * towards[1, 2] + 0.79 * towards[2, 2]
    assert samples[inside] == pytest.approx(0.12 + 0.78 * cosine, abs=1e-6)
    cosine, sine = math.cos(math.radians(33.0)), math.sin(math.radians(33.0))
    right, up = cosine * towards[0] + sine * towards[1], cosine * towards[1] - sine * towards[0]
    side = 1.03 * max(np.ptp(square.positions @ right), np.ptp(square.positions @ up))
    assert inside.sum() == pytest.approx((400 / side) ** 2 / 3, rel=0.01), (
        "seen at an angle, by a rolled camera"
    )
    assert samples[0].min() == samples[:, -1].min() == 1
    assert picture == pytest.approx(samples.reshape(100, 4, 100, 4).mean(axis=(1, 3)), abs=1e-6)


def test_edges_along_an_axis_cross_columns_and_rows_of_samples():
    """A last bit of a coordinate then moves no whole column of samples to the other side of an edge."""
    box = np.array(np.meshgrid((0.0, 1.0), (0.0, 1.0), (0.0, 1.0))).reshape(3, -1).T
    for camera in cameras(box, 400):
        slopes = np.abs(camera[:12].reshape(3, 4)[:2, :3])
        assert (slopes.min(axis=0) > 0.05 * slopes.max()).all(), (
            "no axis of the mesh is along one of the picture"
        )


def test_a_difference_is_that_of_the_definition():
    ndimage = pytest.importorskip("scipy.ndimage")
    random = np.random.default_rng(2)
    x, y = (random.uniform(0.1, 0.9, (40, 50)) for _ in range(2))
    x[:, :7] = y[:, :7] = 1.0

    def blur(picture, outside=1.0):
        return ndimage.gaussian_filter(picture, 1.5, radius=5, mode="constant", cval=outside)

    varied = (blur(x * x) - blur(x) ** 2) + (blur(y * y) - blur(y) ** 2)
    u = blur((x - y) ** 2, 0.0) / (varied + 0.02)
    inside = (x < 0.999) | (y < 0.999)
    found = difference(x.astype(np.float32), y.astype(np.float32))
    assert found[0] == pytest.approx(math.sqrt(u[inside].sum() / x.size), rel=1e-4)
    assert found[1] == pytest.approx(np.abs(blur(x) - blur(y)).max(), rel=1e-4)
    white = np.ones((8, 8), np.float32)
    assert (difference(white, white) == 0).all()


def test_the_distance_is_that_of_the_definition():
    """Samples, pixels, sides and the distance by numpy, from the pictures that are drawn."""
    worse, size = noisy(MESH, 0.001), Size.of(MESH.positions / MESH.diagonal, MESH.faces)
    low, high = MESH.positions.min(axis=0), MESH.positions.max(axis=0)
    originals, others = (
        [mesh.positions - (low + high) / 2 for mesh in (MESH, worse)][k]
        / np.linalg.norm(high - low)
        for k in range(2)
    )
    unlike, gone = [], []
    for camera in cameras(originals, size.pixels):
        drawn = []
        for at in (originals, others):
            at = np.ascontiguousarray(at)
            canvas, shape = Canvas(size.pixels), Shape.of(at, MESH.faces)
            canvas.draw(at, shape.faces, shape.normals(at), camera)
            drawn.append(canvas.samples.reshape(size.pixels // 4, 4, -1, 4).mean(axis=(1, 3)))
        sums = difference(*drawn)
        unlike.append(sums[0])
        gone.append(sums[1])
    distance = max((np.mean(unlike) / 0.0155) ** (4 / 3), (max(gone) / 0.08) ** 2)
    assert len(unlike) == 6
    assert look(MESH, worse).distance == pytest.approx(distance, rel=1e-3)


@pytest.mark.parametrize("turn", range(3))
def test_spans_and_single_samples_show_the_same(turn):
    """Wide faces are drawn by eight samples at once, as small ones are one by one."""
    corners = np.roll(np.array([[(0.0, 0, 0), (1, 0.02, 0.3), (0.01, 1, 0.1)]]), turn, axis=1)
    normals = np.random.default_rng(turn).normal(size=(1, 9)).astype(np.float32)
    wide = np.ascontiguousarray(corners.reshape(3, 3))
    camera = cameras(wide, 256)[4]
    canvas = Canvas(256)
    canvas.draw(wide, np.array([[0, 1, 2]], np.int32), normals, camera)
    whole = canvas.samples.copy()
    inside = np.argwhere(whole < 1.0)
    placed = wide @ camera[:12].reshape(3, 4)[:, :3].T + camera[:12].reshape(3, 4)[:, 3]
    (ax, ay), (bx, by), (cx, cy) = placed[:, :2]
    area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    for row, column in inside[:: max(1, len(inside) // 200)]:
        across, down = column + 0.5 - ax, row + 0.5 - ay
        s = min(max((across * (cy - ay) - down * (cx - ax)) / area, 0.0), 1.0)
        r = min(max(((bx - ax) * down - (by - ay) * across) / area, 0.0), 1.0)
        n = (np.array([1 - s - r, s, r])[:, None] * normals.reshape(3, 3)).sum(axis=0)
        shade = 0.12 + 0.78 * abs(n @ camera[12:]) / np.linalg.norm(n)
        assert whole[row, column] == pytest.approx(shade, abs=1e-5)


def planes(count):
    """Large triangles above each other."""
    corners = np.tile([[-1.0, -1.0], [1.0, -1.0], [0.0, 1.0]], (count, 1))
    return np.column_stack([corners, np.repeat(np.arange(count) / count, 3)]), np.arange(
        3 * count
    ).reshape(-1, 3)


def test_pictures_of_few_faces_are_small_however_short_edges_are():
    positions, faces = planes(1)
    tiny = np.concatenate(
        [faces, np.repeat([[0, 3, 3]], 100, axis=0), np.repeat([[3, 3, 3]], 1000, axis=0)]
    )
    size = Size.of(np.vstack([positions, positions[0] + 1e-6]), tiny)
    assert size.pixels**2 <= LEAST_PIXELS**2 + 8 * len(tiny)


def test_the_work_of_a_picture_is_bounded_however_often_its_pixels_are_covered():
    single, many = (Size.of(*planes(count)) for count in (1, 3000))
    assert single.pixels == LEAST_PIXELS
    assert many.pixels < LEAST_PIXELS / 4
    copies = Size.of(planes(1)[0], np.tile([[0, 1, 2]], (3000, 1)))
    assert copies.pixels < LEAST_PIXELS / 4


def test_threads_change_nothing():
    worse = noisy(MESH, 0.001)
    assert look(MESH, worse, threads=1) == look(MESH, worse, threads=4)


def test_a_fan_of_very_many_faces_is_quick():
    count = 40000
    angles = np.linspace(0, 2 * np.pi, count, endpoint=False)
    ring = np.column_stack([np.cos(angles), np.sin(angles), np.zeros(count)])
    middle = np.full(count, count)
    faces = np.column_stack([np.arange(count), (np.arange(count) + 1) % count, middle])
    fan = TriangleMesh(np.vstack([ring, [0, 0, 0.5]]), faces)
    assert LookMetric(fan).distance(fan.positions) < 1e-3


# ------------------------------------------------------------------------------------------------ what cannot be seen


def test_what_has_no_area_is_refused():
    for corners in ([(0, 0, 0)] * 3, [(0, 0, 0), (1, 1, 1), (2, 2, 2)]):
        with pytest.raises(MeshError, match="cannot be looked at"):
            LookMetric(TriangleMesh(corners, [(0, 1, 2)]))
    with pytest.raises(MeshError, match="too large"):
        LookMetric(moved(MESH, MESH.positions * 1e200))


def test_positions_of_another_shape_are_refused():
    looker = LookMetric(MESH)
    with pytest.raises(MeshError, match="shape"):
        looker.look(MESH.positions[:-1])
    with pytest.raises(MeshError, match="not finite"):
        looker.look(np.full(MESH.positions.shape, np.nan))


def test_what_vanishes_or_flies_away_is_seen():
    looker = LookMetric(MESH)
    assert looker.distance(np.zeros(MESH.positions.shape)) > 5
    assert looker.distance(np.full(MESH.positions.shape, 1e300)) > 5
    spiked = MESH.positions.copy()
    spiked[0] = 1e6
    assert looker.distance(spiked) > 1


def test_the_side_that_differs_most_is_drawn():
    dented = MESH.positions.copy()
    top = dented[:, 2] > 0.8 * dented[:, 2].max()
    dented[top, 2] *= 0.9
    looker = LookMetric(MESH)
    right, up, towards = looker.view(moved(MESH, dented))
    assert np.allclose(np.cross(right, up), towards) and towards[2] > 0.3, (
        "from above, where the dent is"
    )


def test_of_faces_at_one_place_the_brightest_is_shown():
    square = np.array([(0.0, -1, -1), (0, 1, -1), (0, 1, 1), (0, -1, 1)])
    faces = np.array([(0, 2, 1), (0, 3, 2), (0, 1, 2), (0, 2, 3)], np.int32)
    for order in ([0, 1, 2, 3], [2, 3, 0, 1]):
        mine = np.ascontiguousarray(faces[order])
        normals = np.zeros((4, 9), np.float32)
        normals[:, ::3], normals[[order.index(2), order.index(3)], 2::3] = 1.0, 0.5
        camera = cameras(square, 64)[0]
        canvas = Canvas(64)
        canvas.draw(square, mine, normals, camera)
        picture, owner = canvas.samples, canvas.owner
        assert set(owner[owner >= 0]) == {order.index(2), order.index(3)}
        assert np.ptp(picture[owner >= 0]) < 1e-6


def test_last_bits_do_not_decide_which_face_is_seen():
    """Roofs without a ridge overlap in one plane; edges of a cube from the side meet the centers of samples."""
    random, square = (
        np.random.default_rng(7),
        np.array([(0.0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]),
    )
    eaves = [(i, 4 + i, 4 + (i + 1) % 4) for i in range(4)] + [
        (i, 4 + (i + 1) % 4, (i + 1) % 4) for i in range(4)
    ]
    faces = np.array([(0, 1, 2), (0, 2, 3), *eaves])
    roof = np.vstack([square, square * (1.3, 1.3, 0.92) - (0.15, 0.15, 0)])
    roofs = np.vstack(
        [roof * (*random.uniform(0.5, 1.5, 2), 1) + (*random.uniform(0, 1, 2), 0) for _ in range(4)]
    )
    roofs @= np.linalg.qr(random.normal(size=(3, 3)))[0]
    together = TriangleMesh(roofs, np.vstack([faces + 8 * i for i in range(4)]))
    for shifted in (roofs * (1 + 1e-12), roofs + random.uniform(-1e-7, 1e-7, roofs.shape)):
        assert look(together, moved(together, shifted)).distance < 0.02
    assert look(together, decode(encode(together, preset="near-lossless"))).distance <= 0.25
    with pytest.warns(BsmWarning, match="single precision"):
        assert look(together, decode(encode(together, preset="lossless"))).distance < 1e-3
    corners = np.array(list(product((0.0, 1.0), repeat=3)))
    cube = TriangleMesh(corners, ConvexHull(corners).simplices)
    assert look(cube, moved(cube, corners * (1 + 1e-12))).distance < 1e-3


def test_narrow_faces_are_as_bright_as_faces_can_be_and_no_nearer_than_their_corners():
    """Their depths and shades are sums whose rounding errors are large; the last face is in front of them."""
    random = np.random.default_rng(3)
    middles = random.integers(0, 64, (2000, 2)) + 0.5
    along = np.exp2(random.uniform(0, 40, (2000, 1))) * random.integers(-1, 2, (2000, 2))
    aside = np.exp2(random.uniform(-48, 6, (2000, 1))) * random.normal(size=(2000, 2))
    narrow = np.stack([middles + along, middles - along, middles + aside], axis=1)
    depths = random.uniform(0, 9, (2000, 3, 1))
    front = [[(-900.0, -900.0, 100.0), (900.0, -900.0, 100.0), (0.0, 900.0, 100.0)]]
    positions = np.vstack([np.concatenate([narrow, depths], axis=2), front]).reshape(-1, 3)
    normals = np.tile(np.eye(3, dtype=np.float32).ravel(), (2001, 1))
    faces, camera = (
        np.arange(6003, dtype=np.int32).reshape(-1, 3),
        np.r_[np.eye(3, 4).ravel(), 0.6, 0.0, 0.8],
    )
    canvas = Canvas(64)
    canvas.draw(positions, faces[:-1], normals, camera)
    shown = canvas.samples[canvas.owner >= 0]
    assert len(shown) > 1000 and shown.min() >= np.float32(0.12) and shown.max() <= np.float32(0.9)
    canvas.draw(positions, faces, normals, camera)
    assert (canvas.owner == 2000).all()


def test_vertices_that_come_to_one_place_are_shaded_as_one():
    coarse = moved(MESH, np.round(MESH.positions / MESH.diagonal * 20) / 20 * MESH.diagonal)
    assert LookMetric(MESH).look(coarse.positions) == look(MESH, coarse)


def test_normals_are_sums_of_what_is_around_and_not_behind_a_crease():
    """By a plain sum over pairs, on a mesh that is smooth here and sharp there."""
    mesh = together(MESH, tetrahedron())
    shape = Shape.of(mesh.positions, mesh.faces)
    corners = mesh.positions[mesh.faces]
    crosses = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    unit = crosses / np.linalg.norm(crosses, axis=1, keepdims=True)
    found = shape.normals(mesh.positions).reshape(-1, 3, 3)
    for face in range(0, len(mesh.faces), 97):
        for corner in range(3):
            around = (mesh.faces == mesh.faces[face, corner]).any(axis=1) & (
                unit @ unit[face] > CREASE
            )
            total = crosses[around].sum(axis=0)
            assert found[face, corner] == pytest.approx(total / np.linalg.norm(total), abs=1e-6)


def test_a_mesh_on_a_line_cannot_be_looked_at_however_its_coordinates_are_rounded():
    at = np.linspace(0.0, 1.0, 40)
    faces = np.arange(38, dtype=np.int32)[:, None] + np.arange(3, dtype=np.int32)
    for direction in ((1.0, 2.0, 3.0), (0.3, 0.7, 1.1)):
        with pytest.raises(MeshError, match="no area"):
            LookMetric(TriangleMesh(np.outer(at, direction), faces))


# ------------------------------------------------------------------------------------------------ promises


def test_faces_without_area_do_not_count():
    """Rows of quads make tips of which half of the faces have no area: encoders leave these out."""
    around = 70
    angles = 2 * np.pi * (np.arange(around + 1) % around) / around
    ring = np.column_stack([np.cos(angles), np.sin(angles), np.zeros(around + 1)])
    positions = np.vstack([ring, np.tile([0, 0, 2], (around + 1, 1)), [[0, 0, 9]]])
    low = np.arange(around)
    sides = np.column_stack([low, low + 1, low + around + 1])
    flat = np.column_stack([low + 1, low + around + 2, low + around + 1])
    # From the tip to a vertex that nothing else has.
    far = [(around + 1, around + 2, 2 * around + 2)]
    bare, given = (
        TriangleMesh(positions, faces) for faces in (sides, np.vstack([sides, flat, far]))
    )
    assert LookMetric(bare).pixels == LookMetric(given).pixels
    worse = noisy(bare, 0.003)
    worst = moved(bare, np.where(positions == [0, 0, 9], positions, worse.positions))
    assert look(given, bare) == look(bare, bare) == Look(0.0, 0.0, 0.0)
    assert look(given, worst) == look(bare, worst)


@pytest.mark.parametrize(
    "seed", [*range(8), *(pytest.param(seed, marks=pytest.mark.long) for seed in range(8, 2000))]
)
def test_the_mesh_as_given_judges_what_was_promised(seed):
    promises = sorted(
        (name, options.promise) for name, options in PRESETS.items() if options.promise
    )
    preset, promise = promises[seed % len(promises)]
    given = turned(np.random.default_rng(seed))
    try:
        stream = encode(given, preset=preset, threads=1)
    except TargetError:
        return
    assert look(given, decode(stream)).distance <= promise.look


def test_a_look_that_cannot_be_measured_is_said():
    """Where one stray vertex is very far away, all others are one point of its pictures."""
    small, far = torus(12, 8), [[1e12, 0, 0]]
    faces = np.vstack([small.faces, [[0, 1, len(small.positions)]]])
    stray = TriangleMesh(np.vstack([small.positions * 1e-4, far]), faces)
    with pytest.raises(MeshError, match=r"beside the distance to the vertex at \(1e\+12, 0, 0\)"):
        LookMetric(stray)
    encoder = Encoder(stray, replace(PRESETS["balanced"], threads=1))
    encoder.encode()
    assert encoder.look is None and "(1e+12, 0, 0); remove it" in encoder.losses[-1]


def test_pictures_do_not_show_what_was_drawn_before():
    wide = np.array([(0.0, -1, -1), (0, 1, -1), (0, 1, 1)])
    face, normals = np.array([[0, 1, 2]], np.int32), np.ones((1, 9), np.float32)
    camera, used = cameras(wide, 64)[0], Canvas(64)
    for owned, scale in enumerate((1.0, 0.1, -0.3, 1e9, 0.2, 0.5)):
        fresh = Canvas(64)
        for canvas in (used, fresh):
            canvas.draw(wide * scale + scale, face, normals, camera, owned=bool(owned % 2))
        assert np.array_equal(used.samples, fresh.samples)
        assert np.array_equal(used.owner, fresh.owner) and used.owner.size == (
            64 * 64 if owned % 2 else 0
        )
