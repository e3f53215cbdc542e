"""Meshes in tiles: borders, levels, shards, and the way back."""

import importlib
import io
import json
import shutil
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

import bsm
from bsm import read_mesh
from bsm.codec.geometry.metrics import distances_to_surface, face_normals
from bsm.commands import tile as command
from bsm.gltf.coding import EXTENSION
from bsm.gltf.document import read_document
from bsm.ground.console import Console
from bsm.tiles import reading
from bsm.tiles.cutting import Lattice
from bsm.tiles.making import simplified, welded
from tests.bsm.program import bsm as program
from tests.bsm.program import contents
from tests.shapes import curved, torus

CELL = 2.0**-14


@pytest.fixture(scope="module")
def mesh():
    made = curved(torus(80, 60))
    # Which every format holds to the bit.
    return bsm.TriangleMesh(made.positions.astype(np.float32), made.faces)


@pytest.fixture(scope="module")
def folder(mesh, tmp_path_factory):
    return made(mesh, tmp_path_factory.mktemp("tiles") / "out")


def made(mesh, output, *more, triangles=700, suffix="ply"):
    source = output.parent / f"mesh.{suffix}"
    bsm.save(mesh, source)
    tile(source, output, "--grid-cell", CELL, "--triangles", triangles, *more)
    return output


def tile(source, output, *more):
    done = program("tile", source, "-o", output, *more, text=True)
    assert done.returncode == 0, done.stderr
    return done


def sets(mesh, lattice=Lattice(CELL)):  # noqa: B008
    """Places that faces use, and faces as places from the first of their corners on, in order."""
    corners = lattice.places(mesh.positions)[mesh.faces]
    order = np.array([min(range(3), key=lambda first: face[first].tolist()) for face in corners])
    turned = np.take_along_axis(
        corners, ((order[:, None] + np.arange(3)) % 3)[..., None], axis=1
    ).reshape(-1, 9)
    return np.unique(corners.reshape(-1, 3), axis=0), turned[np.lexsort(turned.T)]


def same(first, second):
    return all(
        np.array_equal(first_set, second_set)
        for first_set, second_set in zip(sets(first), sets(second))
    )


def edges(faces):
    found = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    return np.unique(found, axis=0, return_counts=True)


@pytest.mark.parametrize("near", [0, 7])
def test_vertices_that_the_grid_joins_are_counted(near, mesh, tmp_path):
    inside = np.flatnonzero(
        (np.abs(mesh.positions / CELL - np.rint(mesh.positions / CELL)) < 0.25).all(axis=1)
    )[:near]
    assert len(inside) == near
    points = np.concatenate(
        [mesh.positions, mesh.positions[inside] + 0.125 * CELL, mesh.positions[:5]]
    )
    first = len(mesh.positions)
    faces = [
        [first + place, *mesh.faces[(mesh.faces == row).any(axis=1)][0][1:]]
        for place, row in enumerate(inside)
    ]
    # Repeated positions, as an STL has them, are not counted.
    equal = np.arange(5)[:, None] + [first + near, 0, 1]
    bsm.save(
        bsm.TriangleMesh(points.astype(np.float32), np.vstack([mesh.faces, *faces, equal])),
        tmp_path / "a.ply",
    )
    done = tile(tmp_path / "a.ply", tmp_path / "out", "--grid-cell", CELL, "--triangles", 10**6)
    assert ("are joined: 7 (fewer with --grid-cell 3.05176e-05)" in done.stderr) == bool(near)
    assert ("are joined" in done.stderr) == bool(near)
    again = bsm.open_tiles(str(tmp_path / "out")).manifest
    assert again["vertices"] - len(np.unique(Lattice(CELL).places(points), axis=0)) == near + 5


def test_faces_that_the_grid_flattens_are_left_out(tmp_path):
    bsm.save(ring := torus(64, 32), tmp_path / "a.ply")
    tile(tmp_path / "a.ply", tmp_path / "out", "--grid-cell", 2.0**-3)
    corners = Lattice(2.0**-3).places(ring.positions)[ring.faces]
    seen = (corners != np.roll(corners, 1, axis=1)).any(axis=2).all(axis=1).sum()
    assert (
        0
        < len(bsm.open_tiles(str(tmp_path / "out")).region((-9,) * 3, (9,) * 3).faces)
        == seen
        < len(ring.faces)
    )


def test_vertices_that_no_face_uses_say_nothing_of_the_grid(mesh, tmp_path):
    far = 1e4 + np.random.default_rng(0).random((20_000, 3))
    bsm.save(
        bsm.TriangleMesh(np.concatenate([mesh.positions, far]), mesh.faces), tmp_path / "mesh.ply"
    )
    tile(tmp_path / "mesh.ply", tmp_path / "out")
    assert bsm.open_tiles(str(tmp_path / "out")).lattice.cell < 0.01


def test_threads_may_share_tiles(folder):
    for _ in range(20):
        tiles = bsm.open_tiles(str(folder))
        with ThreadPoolExecutor(8) as pool:
            regions = [pool.submit(tiles.region, (-9, -9, -9), (9, 9, 9), 1e9) for _ in range(8)]
        assert len({len(region.result().faces) for region in regions}) == 1


@pytest.mark.parametrize("suffix", ["ply", "stl", "obj"])
def test_untile_gives_the_mesh_back(mesh, suffix, tmp_path):
    output = made(mesh, tmp_path / "out", "--finest", suffix=suffix)
    assert program("untile", output, "-o", tmp_path / "back.ply").returncode == 0
    back = bsm.load(tmp_path / "back.ply")
    assert same(bsm.load(tmp_path / f"mesh.{suffix}"), back) and len(back.positions) == len(
        mesh.positions
    )
    levels = bsm.open_tiles(str(output)).manifest["levels"]
    assert levels[-1]["tiles"] > 8 and levels[0]["level"] > 0
    assert (
        program(
            "untile", output, "-f", "-o", tmp_path / "back.ply", "--level", levels[-1]["level"]
        ).returncode
        == 0
    )
    assert (
        program("untile", output, "-f", "-o", tmp_path / "back.ply", "--level", 0).returncode == 2
    )
    assert not (output / ".work").exists()


def test_a_tile_whose_vertices_are_all_of_others(tmp_path):
    fan = [(place, 0, 1) for place in range(2, 66)]
    arc = np.linspace(0.0, 0.3, 64)
    positions = np.array([(1, 0, 0), (1, 1, 0), *np.column_stack([arc, arc**2, 0 * arc]).tolist()])
    bsm.save(
        bsm.TriangleMesh(positions, [*fan, *np.roll(fan, -1, axis=1).tolist()]), tmp_path / "a.ply"
    )
    tile(
        tmp_path / "a.ply", tmp_path / "out", "--grid-cell", 2.0**-12, "--triangles", 64, "--finest"
    )
    assert program("untile", tmp_path / "out", "-o", tmp_path / "back.ply").returncode == 0
    back = bsm.load(tmp_path / "back.ply")
    assert len(back.positions) == 66 and len(back.faces) == 128


def test_polygons_and_other_orders_of_obj(tmp_path):
    (tmp_path / "a.obj").write_text(
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nf -3/1 -2//2 -1\nv 0 1 0\nf 1 2 3 4\n# f 9 9 9\n"
    )
    tile(tmp_path / "a.obj", tmp_path / "out", "--grid-cell", 0.25)
    found = bsm.open_tiles(str(tmp_path / "out")).region((0, 0, 0), (1, 1, 1))
    assert len(found.positions) == 4 and len(found.faces) == 3


def test_tiles_that_meet_have_the_same_bits_there(mesh, folder):
    tiles = bsm.open_tiles(str(folder))
    seen, faces = {}, 0
    for shard, tile in tiles.chosen(0.0):
        decoded = bsm.decode(tiles.data(shard, tile))
        faces += len(decoded.faces)
        for place, position in zip(tiles.lattice.places(decoded.positions), decoded.positions):
            seen.setdefault(place.tobytes(), set()).add(position.tobytes())
    assert faces == len(mesh.faces)
    assert all(len(positions) == 1 for positions in seen.values())


def test_levels_meet_without_a_crack_and_are_as_near_as_they_say(mesh, folder):
    tiles = bsm.open_tiles(str(folder))
    nodes = {
        tile.name: (shard, tile)
        for shard in tiles.manifest["shards"]
        for tile in tiles.index(shard)
    }
    inner = [
        name
        for name in nodes
        if name + "0" <= max(nodes) and any(other[:-1] == name for other in nodes)
    ]
    leaves = [tile.name for _, tile in tiles.chosen(0.0)]
    coarse = [name for name in inner if len(name) > 1]
    assert len(coarse) > 2 and all(nodes[name][1].error > 0 for name in coarse)
    for name in ("r", *coarse):
        parts = [
            tiles.decoded(*nodes[n])
            for n in (name, *(leaf for leaf in leaves if not leaf.startswith(name)))
        ]
        offsets = np.cumsum([0, *(len(places) for places, _ in parts)])
        _, numbers, _ = welded(np.concatenate([places for places, _ in parts]).astype(int))
        corners = numbers[
            np.concatenate([faces + first for (_, faces), first in zip(parts, offsets)])
        ]
        solid = corners[(corners != np.roll(corners, 1, axis=1)).all(axis=1)]
        _, counts = edges(solid)
        assert (counts == 2).all(), name
        places, faces = parts[0]
        below = [tiles.decoded(*nodes[leaf])[0] for leaf in leaves if leaf.startswith(name)]
        apart = (
            distances_to_surface(
                np.concatenate(below).astype(float), places.astype(float), faces
            ).max()
            * CELL
        )
        assert apart <= nodes[name][1].error
    assert tiles.manifest["levels"][0]["faces"] < 0.4 * len(mesh.faces)


def test_a_region_in_python(mesh, folder):
    tiles = bsm.open_tiles(folder)
    low, high = (-10.0, -10.0, -10.0), (10.0, 10.0, 10.0)
    assert same(tiles.region(low, high), mesh)
    coarse = tiles.region(low, high, error=1e9)
    assert len(coarse.faces) < 0.4 * len(mesh.faces)
    part = tiles.region((0, 0, 0), high)
    assert 0 < len(part.faces) < len(mesh.faces)
    assert (part.positions[part.faces].max(axis=1) >= 0).all()
    with pytest.raises(bsm.OptionError, match="no part of the mesh"):
        tiles.region((8, 8, 8), high)
    for wrong in (("abc", "def"), ((0, 0, 0), (1, 1)), (low, high, "a"), (low, high, None)):
        with pytest.raises(bsm.ArgumentError):
            tiles.region(*wrong)
    with pytest.raises(bsm.ArgumentError):
        tiles.region(low, high, level="finest")


def test_untile_of_a_box_and_of_a_level(folder, tmp_path):
    assert (
        program(
            "untile", folder, "-o", tmp_path / "a.bsm", "--error", "1e9", "--box", "0,0,0,9,9,9"
        ).returncode
        == 0
    )
    expected = bsm.open_tiles(str(folder)).region((0, 0, 0), (9, 9, 9), 1e9)
    assert same(bsm.load(tmp_path / "a.bsm"), expected)


@pytest.mark.parametrize("suffix", ["ply", "obj"])
def test_colors_and_normals_go_along(mesh, tmp_path, suffix):
    color = (np.abs(mesh.positions) * 90).astype(np.uint8)
    normal = (mesh.positions / np.linalg.norm(mesh.positions, axis=1, keepdims=True)).astype(
        np.float32
    )
    dressed = [bsm.Attribute("color", color, "vertex", "color")]
    dressed += [] if suffix == "obj" else [bsm.Attribute("normal", normal, "vertex", "normal")]
    output = made(
        bsm.TriangleMesh(mesh.positions, mesh.faces, dressed), tmp_path / "out", suffix=suffix
    )
    assert program("untile", output, "-o", tmp_path / "back.ply").returncode == 0
    back = bsm.load(tmp_path / "back.ply")
    assert same(bsm.load(tmp_path / f"mesh.{suffix}"), back) and len(back.positions) == len(
        mesh.positions
    )
    places = Lattice(CELL).places
    order, other = (np.lexsort(places(shown.positions).T) for shown in (mesh, back))
    found = {attribute.name: attribute.values[other] for attribute in back.attributes}
    assert np.array_equal(found["color"], color[order])
    if suffix != "obj":
        assert np.abs(found["normal"] - normal[order]).max() < 0.01
    assert program("untile", output, "-o", tmp_path / "coarse.bsm", "--level", 0).returncode == 0
    coarse = bsm.load(tmp_path / "coarse.bsm")
    nearest = np.argmin(((coarse.positions[:, None] - mesh.positions) ** 2).sum(axis=2), axis=1)
    coarse_colors = next(
        attribute.values for attribute in coarse.attributes if attribute.name == "color"
    ).astype(int)
    assert (
        len(coarse.faces) < 0.4 * len(mesh.faces)
        and np.abs(coarse_colors - color[nearest]).mean() < 4
    )


def test_vertices_that_differ_in_color_alone_stay_apart(tmp_path):
    positions = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 0), (1, 1, 0)], float)
    color = np.array([(1, 2, 3)] * 4 + [(9, 9, 9)] * 2, np.uint8)
    square = bsm.TriangleMesh(
        positions, [(0, 1, 2), (4, 5, 3)], [bsm.Attribute("color", color, "vertex", "color")]
    )
    bsm.save(square, tmp_path / "a.ply")
    tile(tmp_path / "a.ply", tmp_path / "out", "--grid-cell", 1)
    found = bsm.open_tiles(str(tmp_path / "out")).region((0, 0, 0), (1, 1, 1))
    rows = {
        (*at, *it) for at, it in zip(found.positions.tolist(), found.attributes[0].values.tolist())
    }
    assert rows == {(*at, *it) for at, it in zip(positions.tolist(), color.tolist())}


@pytest.mark.parametrize("suffix", ["obj", "glb"])
def test_a_textured_tile_shows_what_the_mesh_shows(tmp_path, suffix):
    image = pytest.importorskip("PIL.Image")
    rows, columns = np.mgrid[:41, :81].astype(float)
    positions = np.column_stack([columns.ravel(), rows.ravel(), np.sin(columns.ravel() / 9)])
    corner = (np.arange(40)[:, None] * 81 + np.arange(80)).reshape(-1, 1)
    faces = (corner + np.array([0, 1, 82, 0, 82, 81])).reshape(-1, 3)
    at = positions[faces, :2]
    # The chart of this half is elsewhere, and turned.
    right = at[..., 0].mean(axis=1)[:, None, None] > 40
    uv = (
        np.where(
            right, np.stack([at[..., 1] + 52, 85 - at[..., 0]], axis=2), at + np.array([4, 44])
        )
        / 100
    )
    # A color tells a place; no chart has that of the rest.
    texels = np.full((200, 200, 3), (255, 0, 255), np.uint8)
    up, across = 100 - (np.mgrid[:200, :200] + 0.5) / 2
    across = 100 - across
    left, other = (across < 46) & (up > 42), (across > 50) & (up < 46)
    for there, x, y in ((left, across - 4, up - 44), (other, 85 - up, across - 52)):
        texels[there] = np.stack([x * 3, y * 6, 0 * x], axis=2).clip(0, 255)[there]
    image.fromarray(texels).save(tmp_path / "a.png")
    values, indices = np.unique(uv.reshape(-1, 2).astype(np.float32), axis=0, return_inverse=True)
    texture = bsm.Attribute(
        "texcoord", values, "corner", "texcoord", indices.reshape(-1, 3).astype(np.int32)
    )
    about = {
        "material.0.map_Kd": 0,
        "image.0.name": "a.png",
        "image.0.data": (tmp_path / "a.png").read_bytes(),
    }
    bsm.save(
        bsm.TriangleMesh(positions, faces, [texture], about),
        tmp_path / f"a.{suffix}",
        overwrite=True,
    )
    tile(tmp_path / f"a.{suffix}", tmp_path / "out", "--triangles", 500, "--images", "png")
    assert (
        program("untile", tmp_path / "out", "-o", tmp_path / "site" / "tileset.json").returncode
        == 0
    )
    tiles = bsm.open_tiles(str(tmp_path / "out"))
    assert (deepest := tiles.manifest["levels"][-1]["level"]) > 1
    for shard, entry in tiles.all():
        mesh = tiles.mesh(shard, entry)
        picture = np.asarray(image.open(io.BytesIO(mesh.metadata["image.0.data"]))).astype(float)
        for corners in ([0.98, 0.01, 0.01], [1 / 3] * 3, [0.02, 0.49, 0.49]):
            place = np.tensordot(corners, mesh.positions[mesh.faces], (0, 1))
            u, v = np.tensordot(
                corners, mesh.attributes[0].values[mesh.attributes[0].indices], (0, 1)
            ).T
            seen = picture[((1 - v) * len(picture)).astype(int), (u * picture.shape[1]).astype(int)]
            off = np.abs(seen - np.column_stack([place[:, :2] * [3, 6], 0 * u])).max()
            assert off < 8 * 2 ** (deepest - entry.level)
    glb = (tmp_path / "site" / "glb" / f"{entry.name}.glb").read_bytes()
    assert all(word in glb for word in (b"baseColorTexture", b"image/png", b"NORMAL"))
    tree = json.loads((tmp_path / "site" / "tileset.json").read_text())
    assert (
        tree["root"]["geometricError"]
        == 16 * next(entry for _, entry in tiles.all() if entry.name == "r").error
    )


def test_pieces_of_an_obj_are_read_as_the_whole(tmp_path):
    image = pytest.importorskip("PIL.Image")
    image.new("RGB", (2, 2), (255, 0, 0)).save(tmp_path / "red.png")
    (tmp_path / "a.mtl").write_text("newmtl red\nmap_Kd red.png\nnewmtl plain\n")
    points = [f"v {x} {y} 0\nvt {x / 9} {y / 9}\n" for y in range(9) for x in range(9)]
    squares = [
        f"f {a}/{a} {a + 1}/{a + 1} {a + 10}/{a + 10} {a + 9}/{a + 9}\n"
        for a in range(1, 72)
        if a % 9
    ]
    last = "v 0 0 1\nvt 1 1\nusemtl plain\nf 1 2 -1\nf 2/-1 3/1 -1\n"
    found = []
    # Comments take most of a piece, so that the few lines of the second file are in many pieces.
    for name, comment in (("short", "#\n"), ("long", "#" + 700_000 * " " + "\n")):
        lines = ["mtllib a.mtl\n", *points, "usemtl red\n", *squares]
        parts = ["".join(lines[begin : begin + 16]) for begin in range(0, len(lines), 16)]
        (tmp_path / f"{name}.obj").write_text(comment.join([*parts, last]))
        (folder := tmp_path / name).mkdir()
        raw = reading.read_big(str(tmp_path / f"{name}.obj"), None, folder, Console(quiet=True))
        assert raw.textures == 2 and not raw.left_out
        found.append(contents(folder))
    assert found[0] == found[1]
    faces = raw.table("faces")
    assert faces[-2:].tolist() == [[0, 1, 81, 0, 0, 0, 1], [1, 2, 81, 82, 1, 0, 1]]
    assert (
        len(faces) == 130
        and not faces[:-2, 6].any()
        and (faces[:-2, 3:6] == faces[:-2, :3] + 1).all()
    )


@pytest.mark.parametrize("keep", [9, 60, 120, -2000])
@pytest.mark.parametrize("kind", ["png", "jpeg", "webp", "tga"])
def test_a_broken_image_is_named(mesh, tmp_path, kind, keep):
    image = pytest.importorskip("PIL.Image")
    noise = np.random.default_rng(0).integers(0, 255, (40, 40, 3)).astype(np.uint8)
    image.fromarray(noise).save(tmp_path / f"skin.{kind}")
    data = (tmp_path / f"skin.{kind}").read_bytes()
    (tmp_path / f"skin.{kind}").write_bytes(data[:keep])
    places = "".join(f"v {x} {y} {z}\nvt {x} {y}\n" for x, y, z in mesh.positions)
    faces = "".join(f"f {a}/{a} {b}/{b} {c}/{c}\n" for a, b, c in mesh.faces + 1)
    (tmp_path / "a.obj").write_text(f"mtllib a.mtl\n{places}usemtl m\n{faces}")
    (tmp_path / "a.mtl").write_text(f"newmtl m\nmap_Kd skin.{kind}\n")
    done = program("tile", tmp_path / "a.obj", "-o", tmp_path / "out", text=True)
    # Left out, since no format is known.
    known = done.returncode == 0 and f"skin.{kind}" in done.stderr
    assert known or (
        done.returncode == 3 and f"the image skin.{kind}: it cannot be read" in done.stderr
    ), done.stderr


@pytest.mark.parametrize(("suffix", "names"), [("ply", "s, t"), ("obj", "texcoord")])
def test_textures_without_an_image_are_left_out(mesh, tmp_path, suffix, names):
    texture = bsm.Attribute("texcoord", mesh.positions[:, :2], "vertex", "texcoord")
    bsm.save(bsm.TriangleMesh(mesh.positions, mesh.faces, [texture]), tmp_path / f"a.{suffix}")
    assert f"left out: {names};" in tile(tmp_path / f"a.{suffix}", tmp_path / "out").stderr


def test_a_tileset_says_where_tiles_are_and_how_far_off(mesh, folder, tmp_path):
    output = tmp_path / "made" / "tileset.json"
    output.parent.mkdir()
    assert program("untile", folder, "-o", output, "--content", "plain").returncode == 0
    tree = json.loads(output.read_text())
    faces, seen = 0, 0

    def walk(node, origin, above):
        nonlocal faces, seen
        here = origin + node["transform"][12:15]
        box = np.reshape(node["boundingVolume"]["box"], (4, 3))
        center, half = box[0], np.diag(box[1:])
        assert node["geometricError"] <= above
        drawn = read_mesh(str(output.parent / node["content"]["uri"])).mesh
        (normal,) = drawn.attributes
        assert (
            normal.values[drawn.faces] @ face_normals(drawn.positions, drawn.faces)[..., None] > 0
        ).mean() > 0.9
        # glTF has y upwards, 3D Tiles z.
        turned = drawn.positions @ [(1, 0, 0), (0, 0, 1), (0, -1, 0)] + here
        assert (np.abs(turned - here - center) <= half + 1e-6).all()
        seen += 1
        for child in node.get("children", ()):
            walk(child, here, node["geometricError"])
        if "children" not in node:
            assert node["geometricError"] == 0
            faces += len(drawn.faces)
            assert np.isin(Lattice(CELL).places(turned).view("i4,i4,i4"), finest).all()

    finest = Lattice(CELL).places(mesh.positions).view("i4,i4,i4")
    walk(tree["root"], np.zeros(3), tree["geometricError"])
    assert faces == len(mesh.faces)
    assert seen == sum(level["tiles"] for level in bsm.open_tiles(str(folder)).manifest["levels"])


def test_contents_that_are_compressed(folder, tmp_path):
    (tmp_path / "plain").mkdir()
    assert program("untile", folder, "-o", tmp_path / "tileset.json").returncode == 0
    assert (
        program(
            "untile", folder, "-o", tmp_path / "plain" / "tileset.json", "--content", "plain"
        ).returncode
        == 0
    )
    tiles = sum(level["tiles"] for level in bsm.open_tiles(str(folder)).manifest["levels"])
    found = list((tmp_path / "glb").iterdir())
    assert len(found) == tiles
    for path in found:
        coded, plain = (
            read_document(str(file)) for file in (path, tmp_path / "plain" / "glb" / path.name)
        )
        views = coded.items("bufferViews")
        stream = next(
            view["extensions"][EXTENSION]["stream"] for view in views if "extensions" in view
        )
        primitive = next(plain.primitives())
        corners = plain.array(primitive["indices"]).reshape(-1, 3).astype(np.int32)
        positions = plain.array(primitive["attributes"]["POSITION"]).astype(float)
        assert same(decoded := bsm.decode(coded.view(stream)), bsm.TriangleMesh(positions, corners))
        assert (
            "NORMAL"
            in {attribute.name for attribute in decoded.attributes} & primitive["attributes"].keys()
        )


def test_borders_stay_and_what_is_no_surface_is_left_alone():
    mesh = torus(60, 40)
    places = Lattice(CELL).places(mesh.positions)
    open_ones = mesh.faces[(mesh.faces < 1200).all(axis=1)]
    nothing = np.zeros(len(places), bool)
    new, faces, _ = simplified(places, open_ones, nothing, 300)
    known, counts = edges(open_ones)
    border = places[np.unique(known[counts == 1])]
    left, number = edges(faces)
    assert len(faces) < 600 < len(open_ones)
    assert set(map(tuple, border.tolist())) == set(
        map(tuple, new[np.unique(left[number == 1])].tolist())
    )
    soup = np.random.default_rng(0).integers(0, 40, (3000, 3)).astype(np.int32)
    soup = soup[(soup != np.roll(soup, 1, axis=1)).all(axis=1)]
    assert len(simplified(places, soup, nothing, 10)[1]) == len(soup)
    corner = np.array([(0, 0, 0), (9, 0, 0), (0, 9, 0), (0, 0, 9)], np.int32)
    solid = np.array([(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)], np.int32)
    assert len(simplified(corner, solid, np.zeros(4, bool), 1)[1]) == 4


@pytest.mark.slow
def test_processes_and_clusters_give_the_same_bytes(mesh, folder, tmp_path):
    distributed = pytest.importorskip("distributed")
    assert contents(made(mesh, tmp_path / "two", "-j", "2")) == contents(folder)
    options = {
        "n_workers": 2,
        "threads_per_worker": 1,
        "dashboard_address": ":0",
        "silence_logs": 50,
    }
    with distributed.LocalCluster(**options) as cluster:
        assert contents(
            made(mesh, tmp_path / "dask", "--dask", cluster.scheduler_address)
        ) == contents(folder)


@pytest.mark.parametrize("most", [20_000, 100_000, 300_000])
def test_a_full_disk_is_reported(mesh, folder, tmp_path, most):
    bsm.save(mesh, tmp_path / "mesh.ply")
    resource = importlib.import_module("resource")
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (most, before[1]))
    try:
        done = program(
            "tile", tmp_path / "mesh.ply", "-o", tmp_path / "out", "--triangles", 9000, text=True
        )
        back = program("untile", folder, "-o", tmp_path / "back.ply", text=True)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    whole = program("verify", tmp_path / "out", text=True)
    assert (done.returncode == 0) == (whole.returncode == 0)
    assert done.returncode == 0 or "these tiles are unfinished; " in whole.stderr
    assert (back.returncode == 0) == (tmp_path / "back.ply").exists()
    for process in (ended for ended in (done, back) if ended.returncode):
        assert process.returncode == 9 and process.stderr.strip().endswith(": File too large")
        assert "/" in process.stderr.splitlines()[-1]
        assert ".work: " not in process.stderr, "the file that there is no room for is named"


def test_a_run_that_was_interrupted_goes_on(mesh, folder, tmp_path, monkeypatch):
    source, output = tmp_path / "mesh.ply", tmp_path / "out"
    bsm.save(mesh, source)
    words = ("tile", source, "-o", output, "--grid-cell", CELL, "--triangles", 700)
    done = []

    def interrupted(job, console, most=5, work=command.tile_one):
        if len(done) == most:
            raise KeyboardInterrupt
        done.append(job.output)
        return work(job, console)

    interrupted.__name__ = command.tile_one.__name__
    monkeypatch.setattr(command, "tile_one", interrupted)
    assert program(*words).returncode == 130
    for what in (("info",), ("verify",), ("untile", "-o", tmp_path / "back.ply"), ("view",)):
        resumed = program(what[0], output, *what[1:], text=True)
        assert resumed.returncode == 12 and not (tmp_path / "back.ply").exists()
        assert (
            f"bsm tile {source} -o {output} --resume goes on" in resumed.stderr
            and resumed.stderr.count("\n") == 1
        )
    assert json.loads((output / "manifest.json").read_text())["complete"] is False
    monkeypatch.setattr(interrupted, "__defaults__", (1 << 30, *interrupted.__defaults__[1:]))
    assert program(*words, "--resume", "--triangles", 800).returncode == 3
    assert program(*words, "--resume").returncode == 0
    assert len(done) == len(set(done)) and contents(output) == contents(folder)


def test_tiles_that_were_whole_stay_so_until_there_are_others(mesh, folder, tmp_path, monkeypatch):
    output = shutil.copytree(folder, tmp_path / "out")
    bsm.save(mesh, tmp_path / "mesh.ply")

    def killed(*given, **keywords):
        (output / "00000.tiles").write_bytes(b"")
        raise KeyboardInterrupt

    for name, code in ("read_big", 0), ("write_shards", 12):
        monkeypatch.setattr(command, name, killed)
        assert (
            program("tile", tmp_path / "mesh.ply", "-o", output, "--grid-cell", CELL).returncode
            == 9
        )
        assert (
            program(
                "tile", tmp_path / "mesh.ply", "-o", output, "--grid-cell", CELL, "-f"
            ).returncode
            == 130
        )
        monkeypatch.undo()
        assert program("info", output).returncode == code
    assert (
        program(
            "tile", tmp_path / "mesh.ply", "-o", output, "--grid-cell", CELL, "--resume"
        ).returncode
        == 0
    )
    assert program("verify", output).returncode == 0


@pytest.mark.parametrize("harm", ["changed", "cut", "missing", "index"])
def test_damage_is_reported(folder, tmp_path, harm):
    for name, data in contents(folder).items():
        (tmp_path / name).write_bytes(data)
    shard = tmp_path / "00000.tiles"
    data = shard.read_bytes()
    at = 1000 if harm == "changed" else len(data) - 100
    if harm == "missing":
        shard.unlink()
    else:
        shard.write_bytes(
            data[:-5] if harm == "cut" else data[:at] + bytes([data[at] ^ 1]) + data[at + 1 :]
        )
    done = program("verify", tmp_path, text=True)
    message = {
        "changed": "differs from the index",
        "cut": "there are",
        "missing": "No such file",
        "index": "the index",
    }
    assert (
        done.returncode in (4, 9, 12)
        and message[harm] in done.stderr
        and "00000.tiles" in done.stderr
    )
    expected = {"missing": FileNotFoundError, "cut": bsm.TruncatedError}.get(harm, bsm.CorruptError)
    with pytest.raises(expected):
        bsm.open_tiles(str(tmp_path)).region((-9, -9, -9), (9, 9, 9))


@pytest.mark.parametrize("ranges", [True, False])
def test_tiles_behind_urls(mesh, folder, tmp_path, ranges):
    fsspec = pytest.importorskip("fsspec")
    memory = fsspec.filesystem("memory")
    bsm.save(mesh, tmp_path / "mesh.ply")
    tile(
        tmp_path / "mesh.ply",
        "memory://tiles/out",
        "--grid-cell",
        CELL,
        "--triangles",
        700,
        "--work",
        tmp_path / "w",
    )
    assert {name: memory.cat(f"/tiles/out/{name}") for name in contents(folder)} == contents(folder)

    class Whole(type(memory)):
        """A server that knows no ranges."""

        protocol = "whole"

        @classmethod
        def _strip_protocol(cls, path):
            return super()._strip_protocol(path.replace("whole://", "memory://"))

        def cat_file(self, path, **_):
            return super().cat_file(path)

    fsspec.register_implementation("whole", Whole, clobber=True)
    place = "memory://tiles/out" if ranges else "whole://tiles/out"
    assert same(bsm.open_tiles(place).region((-9, -9, -9), (9, 9, 9)), mesh)
    assert program("verify", f"{place}/").returncode == 0
    memory.rm("/tiles", recursive=True)


def test_info_of_a_folder(folder):
    printed = program("info", folder, text=True).stdout
    assert "level 0" in printed and "1 shards" in printed
    assert json.loads(program("info", folder, "--json").stdout)["cell"] == CELL


@pytest.mark.parametrize(
    "change",
    [
        {"attributes": {"color": ["O", 3]}},
        {"cell": 0},
        {"format": "x"},
        {"shards": [{"file": "../../x"}]},
        {"root": {}},
        {"version": 2},
        {"levels": 1},
    ],
)
def test_a_manifest_that_makes_no_sense(folder, tmp_path, change):
    manifest = json.loads((folder / "manifest.json").read_text())
    (tmp_path / "manifest.json").write_text(json.dumps(manifest | change))
    with pytest.raises(bsm.FormatError, match="manifest"):
        bsm.open_tiles(str(tmp_path))


def test_tiles_of_another_format_are_refused_by_their_manifest(folder, tmp_path):
    manifest = json.loads((folder / "manifest.json").read_text())
    assert manifest.pop("stream") == 1
    (tmp_path / "manifest.json").write_text(json.dumps(manifest))
    for what in ("view", "info", "verify"):
        done = program(what, tmp_path, text=True)
        assert (
            done.returncode == 5
            and "version 0 of the format" in done.stderr
            and "source again" in done.stderr
        )
    (tmp_path / "manifest.json").write_text(json.dumps({**manifest, "stream": 2}))
    with pytest.raises(bsm.UnsupportedError, match="a later release"):
        bsm.open_tiles(str(tmp_path))


@pytest.mark.parametrize(
    ("harm", "message", "code"),
    [("cut", "cut short", 12), ("index", "outside 0", 3), ("nan", "not finite", 3)],
)
def test_inputs_that_are_no_meshes(mesh, tmp_path, harm, message, code):
    source = tmp_path / "mesh.ply"
    bsm.save(mesh, source)
    data = source.read_bytes()
    body = data.index(b"end_header\n") + 11
    harmed = {
        "cut": data[:-7],
        "index": data[:-4] + (1 << 30).to_bytes(4, "little"),
        "nan": data[:body] + b"\xff" * 8 + data[body + 8 :],
    }[harm]
    source.write_bytes(harmed)
    done = program("tile", source, "-o", tmp_path / "out", text=True)
    assert done.returncode == code and message in done.stderr
    assert not (tmp_path / "out").exists()
    source.write_bytes(data)
    tile(source, tmp_path / "out")


def test_grids_that_cannot_be_stored_exactly(mesh, tmp_path):
    source = tmp_path / "mesh.ply"
    bsm.save(bsm.TriangleMesh(mesh.positions + 1e6, mesh.faces), source)
    done = program("tile", source, "-o", tmp_path / "out", "--grid-cell", "0.001", text=True)
    assert done.returncode == 2 and "a power of two does" in done.stderr
    power = done.stderr.rsplit("--grid-cell ", 1)[1].strip()
    # The grid then begins near the mesh.
    bsm.save(bsm.TriangleMesh(mesh.positions + 1e9, mesh.faces), source)
    tile(source, tmp_path / "out", "--grid-cell", power, "--finest")
    shown = bsm.open_tiles(str(tmp_path / "out")).region((0,) * 3, (2e9,) * 3)
    assert len(shown.faces) == len(mesh.faces) and not (shown.positions % float(power)).any()


def test_text_and_lists_are_read_as_a_whole_and_faces_may_be_points(tmp_path):
    head = "ply\nformat ascii 1.0\nelement vertex 3" + "".join(
        f"\nproperty float {axis}" for axis in "xyz"
    )
    lists = "\nelement face 3\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\nend_header\n"
    (tmp_path / "b.ply").write_text(
        f"{head}{lists}1 2 3\n4 5 6\n7 7 7\n3 0 0 0 0\n3 1 1 1 0\n3 2 2 2 0\n"
    )
    tile(tmp_path / "b.ply", tmp_path / "out")
    assert program("verify", tmp_path / "out").returncode == 0


def test_what_is_left_out_is_reported_and_the_files_of_others_stay(tmp_path, monkeypatch):
    (tmp_path / "a.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\n")
    done = program(
        "tile",
        tmp_path / "a.obj",
        "-o",
        tmp_path / "out",
        "--work",
        tmp_path,
        "--grid-cell",
        1,
        text=True,
    )
    assert (
        done.returncode == 2
        and "holds other files" in done.stderr
        and (tmp_path / "a.obj").exists()
    )
    printed = tile(tmp_path / "a.obj", tmp_path / "out", "--grid-cell", 1).stderr
    assert "left out: normal; tiles have positions, faces" in printed
    bsm.save(
        bsm.TriangleMesh(np.eye(3), [(0, 1, 2)], metadata={"comment": "by a scanner"}),
        tmp_path / "b.ply",
    )
    printed = tile(tmp_path / "b.ply", tmp_path / "commented", "--grid-cell", 1).stderr
    assert "left out: lines of comment; tiles have" in printed
    monkeypatch.chdir(tmp_path)
    Path("tileset.json").write_text("of another mesh")
    tile(tmp_path / "b.ply", ".", "--grid-cell", 1, "-f")
    assert Path("manifest.json").exists() and not Path("tileset.json").exists()


def test_the_grid_is_chosen_by_the_look_in_any_order_of_faces_and_vertices_slide(tmp_path):
    large, found, rng = torus(180, 140), list[bsm.Tiles](), np.random.default_rng(4)
    points, sides = large.positions.copy(), np.diff(large.positions[large.faces], axis=1)
    points[large.faces[:, 0]] += 0.4 * (rng.random((50400, 2, 1)) * sides).sum(axis=1)
    for name, order in ("in", np.arange(50400)), ("out", rng.permutation(50400)):
        bsm.save(given := bsm.TriangleMesh(points, large.faces[order]), tmp_path / f"{name}.ply")
        tile(tmp_path / f"{name}.ply", tmp_path / name, "--triangles", 20000, "--finest")
        found.append(bsm.open_tiles(str(tmp_path / name)))
    cell, lattice, back = (
        found[0].lattice.cell,
        found[1].lattice,
        found[1].region((-9,) * 3, (9,) * 3),
    )
    assert cell == lattice.cell and (16 * np.frexp(cell)[0]) % 1 == 0 and 1e-5 < cell < 0.1
    assert (edges(back.faces)[1] == 2).all() and bsm.look(given, back).distance < 1.0
    assert not np.array_equal(sets(given, lattice)[0], sets(back, lattice)[0])
