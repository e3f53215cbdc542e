"""What `bsm glb` leaves alone, what it keeps exactly, and that a scene comes back."""

import copy
import io
import json

import numpy as np
import pytest

import bsm
from bsm.cli import main
from bsm.gltf.coding import EXTENSION
from bsm.gltf.compress import compress, restore
from bsm.gltf.document import Document, read_document
from tests.bsm.test_gltf import WEB, coded_of, waves
from tests.gltf import Built, glb
from tests.shapes import torus
from tools.attack.doors import errors_of

FINE = {"preset": "grid14"}


def ring(attributes=None, more=None, targets=(), count=24):
    """A scene of one torus with more attributes of its vertices."""
    shape = torus(count, 16)
    built = Built()
    points = shape.positions.astype(np.float32)
    bounds = {"min": points.min(axis=0).tolist(), "max": points.max(axis=0).tolist()}
    given = {"POSITION": built.array(points, **bounds)}
    for name, value in (attributes or {}).items():
        values, how = value if isinstance(value, tuple) else (value, {})
        given[name] = built.array(values, **how)
    moved = [{name: built.array(values) for name, values in target.items()} for target in targets]
    faces = built.array(shape.faces.astype(np.uint16).reshape(-1))
    primitive = {
        "attributes": given,
        "indices": faces,
        **({"targets": moved} if moved else {}),
        **(more or {}),
    }
    built.nodes({"mesh": built.mesh(primitive)})
    return built, len(shape.positions)


@pytest.mark.slow
@pytest.mark.parametrize("preset", ["grid14", "near-lossless"])
def test_a_face_with_many_small_targets_is_coded(preset):
    """As 20 expressions of a face of 50,000 vertices: each moves some vertices a little."""
    count, random = 3125, np.random.default_rng(0)
    points = 0.1 * torus(count, 16).positions
    targets = []
    for center in points[random.integers(0, len(points), 20)]:
        near = np.exp(-((points - center) ** 2).sum(axis=1) / 0.0008)
        near[near < 1e-3] = 0.0
        targets.append(
            {"POSITION": (near[:, None] * random.normal(size=3) * 0.006).astype(np.float32)}
        )
    built, _ = ring(targets=targets, count=count)
    found, after = rewritten(built, {"preset": preset, "effort": "quick"})
    assert found.coded == 1, found.unchanged
    assert len(found.data) < len(built.bytes) / 5
    bound = np.ptp(torus(count, 16).positions, axis=0).max() / (1 << 15)
    for number, target in enumerate(after.tree["meshes"][0]["primitives"][0]["targets"]):
        moved = after.array(target["POSITION"])
        assert (
            np.abs(np.sort(moved, axis=0) - np.sort(targets[number]["POSITION"], axis=0)).max()
            <= bound
        )


def test_a_scene_of_which_nothing_is_coded_is_said_first_and_not_written(tmp_path, capsys):
    built, _ = ring(more={"mode": 1})
    source, target = tmp_path / "lines.glb", tmp_path / "out.glb"
    source.write_bytes(built.bytes)
    assert main(["glb", str(source), "-o", str(target)]) == 11
    assert capsys.readouterr().err.startswith(
        f"bsm: {source}: nothing was coded: points or lines; --force"
    )
    assert (
        not target.exists()
        and main(["glb", str(source), "-f", "-o", str(target)]) == 0
        and target.exists()
    )
    source.write_bytes(built.bytes[:-4])
    assert main(["glb", str(source), "-f", "-o", str(target)]) == 12
    assert (
        capsys.readouterr().err.splitlines()[-1].startswith(f"bsm: {source}: this GLB should have")
    )


def rewritten(built, options=FINE, **more):
    found = compress(Document(built.bytes), options, **more)
    return found, Document(found.data)


def first(document):
    return document.tree["meshes"][0]["primitives"][0]


def test_extras_are_never_entered():
    """Whatever they hold, under keys that glTF has elsewhere."""
    extras = {
        "attributes": {"hp": 4},
        "input": 1,
        "indices": 2,
        "stream": 0,
        "bufferView": 1,
        "extensions": {"A": 3},
    }
    built, _ = ring({"NORMAL": np.tile(np.eye(3, dtype=np.float32)[:1], (384, 1))})
    primitive = built.tree["meshes"][0]["primitives"][0]
    for place in (built.tree, built.tree["nodes"][0], primitive, built.tree["accessors"][0]):
        place["extras"] = extras
    found, after = rewritten(built)
    assert found.coded == 1
    positions = after.item("accessors", first(after)["attributes"]["POSITION"])
    places = (after.tree, after.tree["nodes"][0], first(after), positions)
    assert all(place["extras"] == extras for place in places)


def test_names_of_accessors_stay():
    built, _ = ring()
    for number, accessor in enumerate(built.tree["accessors"]):
        accessor["name"] = f"number {number}"
    _, after = rewritten(built)
    assert after.item("accessors", first(after)["attributes"]["POSITION"])["name"] == "number 0"
    assert after.item("accessors", first(after)["indices"])["name"] == "number 1"


@pytest.mark.parametrize("coded", [False, True])
def test_tables_of_an_extension_that_is_not_known_keep_their_numbers_and_bytes(coded):
    """As EXT_structural_metadata has them: numbers of bufferViews under any key."""
    built, _ = ring(more={} if coded else {"mode": 0})
    early = built.view(b"early bytes!")
    late = [built.view(bytes([k]) * 40) for k in range(5)]
    unused = built.array(np.arange(7, dtype=np.float32))
    properties = {"height": {"values": late[3], "stringOffsets": late[1], "arrayOffsets": early}}
    table = {
        "class": "c",
        "count": 10,
        "properties": properties,
        "pointer": f"/accessors/{unused}/min",
    }
    built.tree["extensions"] = {"EXT_whatever": {"propertyTables": [table]}}
    built.tree["extensionsUsed"] = ["EXT_whatever"]
    before = Document(built.bytes)
    found, after = rewritten(built)
    assert found.coded == coded
    assert after.tree["extensions"] == before.tree["extensions"]
    for view in (early, late[1], late[3]):
        assert after.view(view) == before.view(view)
    np.testing.assert_array_equal(after.array(unused), before.array(unused))


def test_bytes_that_another_extension_may_name_stay():
    """Its number is that of the positions: they are in the stream, and still there."""
    built, _ = ring()
    built.tree["nodes"][0]["extensions"] = {"EXT_whatever": {"TRANSLATION": 0}}
    before = Document(built.bytes)
    found, after = rewritten(built)
    np.testing.assert_array_equal(after.array(0), before.array(0))
    assert found.coded == 0 or first(after)["attributes"]["POSITION"] != 0


PLACES = {
    "outline": lambda p, m: p.setdefault("extensions", {}).update(
        CESIUM_primitive_outline={"indices": 1}
    ),
    "edges": lambda p, m: p.setdefault("extensions", {}).update(
        EXT_mesh_primitive_edge_visibility={"visibility": 1}
    ),
    "manifold": lambda p, m: m.setdefault("extensions", {}).update(
        EXT_mesh_manifold={"mergeIndices": 1}
    ),
    "numbered features": lambda p, m: p.setdefault("extensions", {}).update(
        EXT_mesh_features={"featureIds": [{"featureCount": 384}]}
    ),
}


@pytest.mark.parametrize("put", PLACES.values(), ids=PLACES)
def test_primitives_whose_vertices_are_named_stay(put):
    built, _ = ring()
    mesh = built.tree["meshes"][0]
    put(mesh["primitives"][0], mesh)
    built.tree["extensionsUsed"] = ["X"]
    before = Document(built.bytes)
    found, after = rewritten(built)
    assert found.coded == 0 and "may name vertices" in "".join(found.unchanged)
    assert (
        after.tree["meshes"] == before.tree["meshes"]
        and EXTENSION not in after.tree["extensionsUsed"]
    )
    for number in range(2):
        np.testing.assert_array_equal(after.array(number), before.array(number))


def test_a_primitive_with_bytes_that_are_not_known_stays_and_others_are_compressed():
    built, _ = ring()
    other = copy.deepcopy(built.tree["meshes"][0])
    other["primitives"][0]["attributes"]["POSITION"] = built.array(
        torus(24, 16).positions.astype(np.float32)
    )
    built.tree["meshes"].append(other)
    how = {"EXT_packs": {"buffer": 0, "byteOffset": 4}}
    built.tree["bufferViews"][0]["extensions"] = how
    built.tree["extensionsUsed"] = ["EXT_packs"]
    found, after = rewritten(built)
    assert found.coded == 1 and found.unchanged == {"EXT_packs may hold other bytes": 1}
    view = after.tree["bufferViews"][
        after.item("accessors", first(after)["attributes"]["POSITION"])["bufferView"]
    ]
    assert view["extensions"] == how and after.buffer(0)[: len(built.data)] == built.data


def test_weights_of_all_sets_have_one_sum():
    random = np.random.default_rng(0).random((384, 8)).astype(np.float32)
    weights = random / random.sum(axis=1, keepdims=True)
    joints = np.tile(np.arange(4, dtype=np.uint8), (384, 1))
    built, _ = ring(
        {
            "JOINTS_0": joints,
            "JOINTS_1": joints,
            "WEIGHTS_0": weights[:, :4],
            "WEIGHTS_1": weights[:, 4:],
        }
    )
    found, after = rewritten(built)
    named = first(after)["attributes"]
    total = sum(after.numbers(named[f"WEIGHTS_{k}"]).sum(axis=1) for k in range(2))
    assert found.coded == 1
    np.testing.assert_allclose(total, 1, atol=1e-12)
    kept = np.hstack([after.numbers(named[f"WEIGHTS_{k}"]) for k in range(2)])
    assert np.abs(kept[:, None] - weights[None]).max(axis=2).min(axis=1).max() < 1 / 255
    found, after = rewritten(built, {"preset": "lossless"})
    named = first(after)["attributes"]
    kept = np.hstack([after.numbers(named[f"WEIGHTS_{k}"]) for k in range(2)])
    assert sorted(map(tuple, kept.tolist())) == sorted(map(tuple, weights.tolist()))


@pytest.mark.parametrize("how", ["targets", "sparse targets", "skin", "nothing"])
def test_faces_that_something_opens_are_kept(how):
    """A seam of eyelids: two rows of vertices at one place."""
    across, up = np.meshgrid(
        np.linspace(0, 1, 30), np.repeat(np.linspace(0, 1, 12), [1] * 5 + [2] + [1] * 6)
    )
    points = np.column_stack([across.ravel(), up.ravel(), np.sin(5 * across.ravel())]).astype(
        np.float32
    )
    number = np.arange(len(points)).reshape(across.shape)
    a, b, c, d = number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]
    faces = np.concatenate(
        [np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)]
    )
    moved = np.where(
        (np.arange(len(points)) // 30 > 5)[:, None], np.float32(0.1), np.float32(0)
    ) * np.ones((1, 3), "f4")
    built = Built()
    given = {"POSITION": built.array(points)}
    if how == "skin":
        given["JOINTS_0"] = built.array(
            np.where(moved[:, :1] > 0, np.uint8(1), np.uint8(0)) * np.array([[1, 0, 0, 0]], "u1")
        )
        given["WEIGHTS_0"] = built.array(np.tile(np.eye(4, dtype=np.float32)[:1], (len(points), 1)))
    primitive = {"attributes": given, "indices": built.array(faces.astype(np.uint16).reshape(-1))}
    if how == "targets":
        primitive["targets"] = [{"POSITION": built.array(moved)}]
    if how == "sparse targets":
        places = np.flatnonzero(moved[:, 0]).astype(np.uint16)
        sparse = {
            "count": len(places),
            "indices": {"bufferView": built.view(places.tobytes()), "componentType": 5123},
            "values": {"bufferView": built.view(moved[places].tobytes())},
        }
        built.tree["accessors"].append(
            {"componentType": 5126, "type": "VEC3", "count": len(points), "sparse": sparse}
        )
        primitive["targets"] = [{"POSITION": len(built.tree["accessors"]) - 1}]
    built.nodes({"mesh": built.mesh(primitive)})
    found, after = rewritten(built)
    kept = after.count(first(after)["indices"]) // 3
    assert found.coded == 1
    assert kept == len(faces) - (58 if how == "nothing" else 0)
    assert dict(found.notes) == ({"left out 58 faces without area": 1} if how == "nothing" else {})
    if "targets" in how:
        target = after.numbers(first(after)["targets"][0]["POSITION"])
        corners = after.numbers(first(after)["indices"])[:, 0].astype(int).reshape(-1, 3)
        points = after.numbers(first(after)["attributes"]["POSITION"]) + target
        sides = np.cross(
            points[corners[:, 1]] - points[corners[:, 0]],
            points[corners[:, 2]] - points[corners[:, 0]],
        )
        assert np.linalg.norm(sides, axis=1).min() > 1e-5


IDS = {
    "bytes": np.arange(384, dtype=np.uint8)[:, None] % 7,
    "shorts": np.arange(384, dtype=np.uint16)[:, None] * 3,
    "floats": np.arange(384, dtype=np.float32)[:, None] * 40_000,
    "negative floats": np.arange(384, dtype=np.float32)[:, None] - 17,
    "pairs": np.arange(768, dtype=np.uint8).reshape(-1, 2),
}


@pytest.mark.parametrize("preset", ["grid14", "balanced", "lossless"])
@pytest.mark.parametrize("ids", IDS.values(), ids=IDS)
def test_identifiers_are_exact(ids, preset):
    shape = torus(24, 16)
    built, _ = ring({"_FEATURE_ID_0": ids})
    built.tree["meshes"][0]["primitives"][0]["extensions"] = {
        "EXT_mesh_features": {"featureIds": [{"featureCount": 384, "attribute": 0}]}
    }
    found, after = rewritten(built, {"preset": preset})
    assert found.coded == 1 and not found.unchanged
    places, values = (
        after.numbers(first(after)["attributes"][name]) for name in ("POSITION", "_FEATURE_ID_0")
    )
    nearest = np.linalg.norm(places[:, None] - shape.positions[None], axis=2).argmin(axis=1)
    np.testing.assert_array_equal(values, ids[nearest])


@pytest.mark.parametrize("extent", [1.0, 100.0])
@pytest.mark.parametrize(("side", "kind"), [(16, "PNG"), (4096, "JPEG"), (4096, "WEBP")])
def test_texture_coordinates_are_bound_in_texels(extent, side, kind):
    image = pytest.importorskip("PIL.Image")
    image.new("L", (side, 8)).save(file := io.BytesIO(), kind)
    random = np.random.default_rng(1).random((384, 2)).astype(np.float32) * np.float32(extent)
    built, _ = ring({"TEXCOORD_0": random}, {"material": 0})
    built.tree["images"] = [
        {"bufferView": built.view(file.getvalue()), "mimeType": f"image/{kind.lower()}"}
    ]
    built.tree["textures"] = [{"source": 0}]
    built.tree["materials"] = [{"normalTexture": {"index": 0}}]
    _, after = rewritten(built)
    found = after.numbers(first(after)["attributes"]["TEXCOORD_0"])
    off = np.abs(found[:, None] - random[None]).max(axis=2).min(axis=1).max()
    assert off <= min(0.25 / side, extent / 8192) * 1.001


def test_qualities_are_those_that_are_asked_for(tmp_path, capsys):
    random = np.random.default_rng(1).random((384, 2)).astype(np.float32)
    built, _ = ring(
        {"TEXCOORD_0": random, "_HEIGHT": random[:, :1], "COLOR_0": np.hstack([random, random])}
    )
    (tmp_path / "a.glb").write_bytes(built.bytes)
    command = ["glb", str(tmp_path / "a.glb"), "-f", "-o", str(tmp_path / "b.glb")]
    given = [
        "--attribute",
        "TEXCOORD_0=exact",
        "--attribute",
        "_HEIGHT=0.1",
        "--attribute",
        "COLOR_0=none",
    ]
    assert main([*command, *given]) == 0
    after = read_document(str(tmp_path / "b.glb"))
    named = first(after)["attributes"]
    assert "COLOR_0" not in named
    exact = {*map(tuple, random.tolist())}
    assert {*map(tuple, after.numbers(named["TEXCOORD_0"]).tolist())} == exact
    heights = after.numbers(named["_HEIGHT"])
    assert 1e-4 < np.abs(heights - random[:, :1].T).min(axis=1).max() <= 0.1
    for wrong in ("COLOR_0", "NORMAL=recompute", "POSITION=none", "=8bits"):
        assert main([*command, "--attribute", wrong]) == 2
    assert "--attribute" in capsys.readouterr().err


def normals_of(shape, tilt):
    """Normals by area, one of which is tilted by some degrees."""
    a, b, c = shape.positions[shape.faces.T]
    normals = np.zeros_like(shape.positions)
    np.add.at(normals, shape.faces, np.cross(b - a, c - a)[:, None])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    across = np.cross(normals[7], [0.0, 0.0, 1.0])
    across /= np.linalg.norm(across)
    normals[7] = np.cos(np.radians(tilt)) * normals[7] + np.sin(np.radians(tilt)) * across
    return normals.astype(np.float32)


@pytest.mark.parametrize(
    ("tilt", "asked", "preset", "is_stored"),
    [
        (0.0, {}, "grid14", False),
        (0.0, {}, "near-lossless", False),
        (2.0, {}, "grid14", True),
        (0.0, {"NORMAL": "12bits"}, "grid14", True),
        (0.0, {"*": "10bits"}, "grid14", True),
        (0.0, {}, "lossless", True),
    ],
)
def test_normals_are_left_out_where_all_are_within_a_degree(tilt, asked, preset, is_stored):
    shape = torus(48, 32)
    normals = normals_of(shape, tilt)
    built = Built()
    attributes = {
        "POSITION": built.array(shape.positions.astype(np.float32)),
        "NORMAL": built.array(normals),
    }
    faces = built.array(shape.faces.astype(np.uint16).reshape(-1))
    built.nodes({"mesh": built.mesh({"attributes": attributes, "indices": faces})})
    found, after = rewritten(built, {"preset": preset, "attributes": asked})
    assert any(note.startswith("normals are not stored") for note in found.notes) != is_stored
    plain = Document(restore(after))
    accessors = first(plain)["attributes"]
    positions, restored = plain.array(accessors["POSITION"]), plain.array(accessors["NORMAL"])
    apart = np.linalg.norm(positions[:, None] - shape.positions.astype(np.float32), axis=2)
    nearest = apart.argmin(axis=1)
    cosines = (restored * normals[nearest]).sum(axis=1)
    assert np.degrees(np.arccos(cosines.clip(-1.0, 1.0))).max() <= 1.0


def test_lossless_scenes_have_all_numbers(tmp_path):
    random = np.random.default_rng(1).random((384, 3)).astype(np.float32)
    built, _ = ring(
        {
            "NORMAL": random,
            "TEXCOORD_0": random[:, :2],
            "TANGENT": np.hstack([random, random[:, :1]]),
        }
    )
    before = Document(built.bytes)
    _, after = rewritten(built, {"preset": "lossless"})
    tables = [
        np.hstack(
            [
                d.numbers(first(d)["attributes"][n])
                for n in ("POSITION", "NORMAL", "TEXCOORD_0", "TANGENT")
            ]
        )
        for d in (before, after)
    ]
    assert sorted(map(tuple, tables[0].tolist())) == sorted(map(tuple, tables[1].tolist()))


def test_meshes_share_a_grid():
    """Two halves of a surface in nodes of their own, which were moved apart: their seam is one again."""
    shape = torus(40, 24)
    left = shape.positions[shape.faces].mean(axis=1)[:, 0] < 0
    built = Built()
    nodes, seams = [], []
    for number, some in enumerate((left, ~left)):
        used, corners = np.unique(shape.faces[some], return_inverse=True)
        shift = np.array([0.37, -0.21, 1.13]) * number
        points = (shape.positions[used] - shift).astype(np.float32)
        primitive = {
            "attributes": {"POSITION": built.array(points)},
            "indices": built.array(corners.astype("u2").ravel()),
        }
        nodes.append({"mesh": built.mesh(primitive), "translation": shift.tolist()})
        seams.append({*map(tuple, np.round(points + shift, 5).tolist())})
    built.nodes(*nodes)
    gaps = []
    for one_grid in (False, True):
        found, after = rewritten(built, one_grid=one_grid)
        assert found.coded == 2
        tables = [
            after.numbers(mesh["primitives"][0]["attributes"]["POSITION"])
            + np.array(node["translation"])
            for mesh, node in zip(after.tree["meshes"], after.tree["nodes"], strict=True)
        ]
        apart = np.linalg.norm(tables[0][:, None] - tables[1][None], axis=2).min(axis=1)
        gaps.append(np.sort(apart)[: len(seams[0] & seams[1])].max())
    assert gaps[1] < 1e-6 < 1e-5 < gaps[0]


def test_a_far_component_is_named(tmp_path, capsys):
    near, far = torus(12, 8), torus(12, 8)
    built = Built()
    points = np.vstack([near.positions, far.positions + np.array([1e4, 0, 0])]).astype(np.float32)
    faces = np.vstack([near.faces, far.faces + len(near.positions)]).astype(np.uint16)
    built.nodes(
        {
            "mesh": built.mesh(
                {
                    "attributes": {"POSITION": built.array(points)},
                    "indices": built.array(faces.ravel()),
                }
            )
        }
    )
    (tmp_path / "a.glb").write_bytes(built.bytes)
    assert main(["glb", str(tmp_path / "a.glb"), "-o", str(tmp_path / "b.glb")]) == 0
    errors = capsys.readouterr().err
    assert (
        "% of the diagonal of its component" in errors and "small components are coarse" in errors
    )


@pytest.mark.parametrize(
    ("data", "kind"),
    [
        (b"\x89PNG\r\n\x1a\n----", "image/png"),
        (b"\xff\xd8\xff-----", "image/jpeg"),
        (b"RIFF----WEBP", "image/webp"),
        (b"\xabKTX 20\xbb\r\n\x1a\n", "image/ktx2"),
        (b"\0\0\0 ftypavif", "image/avif"),
    ],
)
def test_types_of_images_are_told_by_their_bytes(data, kind, tmp_path):
    built, _ = ring()
    built.tree["images"] = [
        {"uri": "image.bin"},
        {"uri": "https://example.org/a.png"},
        {"uri": "not%20there.png"},
    ]
    (tmp_path / "image.bin").write_bytes(data)
    (tmp_path / "a.glb").write_bytes(built.bytes)
    assert main(["glb", str(tmp_path / "a.glb"), "-o", str(tmp_path / "b.glb")]) == 0
    after = read_document(str(tmp_path / "b.glb"))
    images = after.tree["images"]
    assert images[0]["mimeType"] == kind and after.view(images[0]["bufferView"]) == data
    assert images[1:] == built.tree["images"][1:]


def test_zeros_without_bytes_are_not_counted_as_saved():
    built = Built()
    built.tree["accessors"] = [{"componentType": 5126, "type": "VEC3", "count": 60_000}]
    built.nodes(
        {
            "mesh": built.mesh(
                {"attributes": {"POSITION": 0}, "indices": built.array(np.arange(3, dtype="u2"))}
            )
        }
    )
    assert len(compress(Document(built.bytes), FINE).data) <= len(restore(Document(built.bytes)))


def test_zeros_without_bytes_stay_beside_those_that_were_replaced():
    built, count = ring(more={"targets": [{"POSITION": 2}]})
    zeros = {"componentType": 5126, "type": "VEC3"}
    built.tree["accessors"] += [{**zeros, "count": count}, {**zeros, "count": 2}]
    built.mesh({"attributes": {"POSITION": 3}, "mode": 0})
    found, after = rewritten(built)
    assert found.coded == 1 and {**zeros, "count": 2} in after.tree["accessors"]


def test_strips_become_triangles():
    built = Built()
    row = np.arange(200, dtype=np.float32)
    points = np.column_stack([row // 2, row % 2, np.sin(row / 9)])
    built.nodes({"mesh": built.mesh({"attributes": {"POSITION": built.array(points)}, "mode": 5})})
    found, after = rewritten(built)
    assert found.coded == 1 and "mode" not in first(after)
    assert after.count(first(after)["indices"]) == 3 * 198


def test_threads_give_the_same_scene(tmp_path):
    built, _ = ring()
    for number in range(3):
        built.tree["meshes"].append(copy.deepcopy(built.tree["meshes"][0]))
        attributes = built.tree["meshes"][-1]["primitives"][0]["attributes"]
        attributes["POSITION"] = built.array(
            torus(24, 16).positions.astype(np.float32) * (number + 2)
        )
    (tmp_path / "a.glb").write_bytes(built.bytes)
    for jobs in ("1", "2"):
        assert (
            main(["glb", str(tmp_path / "a.glb"), "-j", jobs, "-o", str(tmp_path / f"{jobs}.glb")])
            == 0
        )
    assert (tmp_path / "1.glb").read_bytes() == (tmp_path / "2.glb").read_bytes()


def test_a_scene_is_restored(tmp_path):
    ids = np.arange(384, dtype=np.uint16)[:, None]
    built, _ = ring({"_ID": ids, "NORMAL": np.tile(np.eye(3, dtype=np.float32)[:1], (384, 1))})
    built.tree["extensions"] = {"EXT_whatever": {"view": built.view(b"keep")}}
    built.tree["extensionsUsed"] = ["EXT_whatever"]
    (tmp_path / "a.glb").write_bytes(built.bytes)
    small, plain = str(tmp_path / "b.glb"), str(tmp_path / "c.glb")
    assert main(["glb", str(tmp_path / "a.glb"), "-o", small]) == 0
    assert main(["decode", small, "-o", plain]) == 0
    coded, after = read_document(small), read_document(plain)
    assert coded_of(coded) and not after.compressed and len(after.tree["buffers"]) == 1
    assert not any("extensions" in view for view in after.tree["bufferViews"])
    for name, index in first(coded)["attributes"].items():
        np.testing.assert_array_equal(
            after.numbers(first(after)["attributes"][name]), coded.numbers(index)
        )
    assert after.view(built.tree["extensions"]["EXT_whatever"]["view"]) == b"keep"
    assert main(["decode", small, "-f", "-o", str(tmp_path / "d.ply")]) == 0
    assert len(bsm.load(tmp_path / "d.ply").faces) == 768
    for refused in (
        ["d.usdc"],
        ["d"],
        ["e.ply", "--frames", "0:1"],
        ["e.ply", "--layers", "1"],
        ["e.ply", "--tolerant"],
    ):
        assert main(["decode", small, "-o", str(tmp_path / refused[0]), *refused[1:]]) == 2
        assert not (tmp_path / refused[0]).exists()


def test_scenes_are_compared_as_one_mesh(tmp_path, capsys):
    """Two primitives that share their vertices are one stream, whose faces have another order."""
    built, _ = ring(
        {
            "_ID": np.arange(384, dtype=np.uint16)[:, None],
            "COLOR_0": np.full((384, 4), 0.5, np.float32),
        }
    )
    faces = torus(24, 16).faces.astype(np.uint16)
    given = first(built)
    built.tree["meshes"][0]["primitives"] = [
        {**given, "indices": built.array(some.reshape(-1))} for some in (faces[:300], faces[300:])
    ]
    built.tree["meshes"].append({"primitives": [{"attributes": given["attributes"], "mode": 0}]})
    original, small = str(tmp_path / "a.glb"), str(tmp_path / "b.glb")
    (tmp_path / "a.glb").write_bytes(built.bytes)
    assert main(["glb", original, "-o", small]) == 0
    capsys.readouterr()
    assert main(["compare", original, small, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert 0 < found["max_error_relative"] < 1e-4
    assert (
        found["attributes"]["ID"]["max_error"] == 0
        and found["attributes"]["color"]["max_error"] < 0.003
    )
    assert main(["info", small]) == 0
    assert "scene of 3 primitives, 1 stream\n" in capsys.readouterr().out


def test_references_that_lead_nowhere_and_numbers_that_are_none_are_errors():
    for spoil in (
        lambda tree: tree.update(images=[{"bufferView": 99}]),
        lambda tree: tree.update(skins=[{"joints": [0], "inverseBindMatrices": 99}]),
        lambda tree: tree["nodes"][0].update(translation=[0, 0, float("inf")]),
    ):
        built, _ = ring()
        spoil(built.tree)
        text = json.dumps(built.tree | {"buffers": [{"byteLength": len(built.data)}]}).replace(
            "Infinity", "1e999"
        )
        data = glb(json.loads(text), built.data) if "1e999" not in text else None
        document = Document(data or text.encode())
        document._binary = built.data
        with pytest.raises(bsm.FormatError):
            compress(document, FINE)


@pytest.mark.skipif(not (WEB / "node_modules/gltf-validator").is_dir(), reason="npm ci in web")
def test_no_output_has_an_error_that_its_input_had_not(tmp_path):
    up = np.tile(np.array([[0, 0, 1]], np.float32), (384, 1))
    color = (np.full((384, 4), 9, np.uint8), {"normalized": True})
    weights = np.tile(np.eye(4, dtype=np.float32)[:1], (384, 1))
    scenes = {
        "plain": ring(),
        "dressed": ring({"NORMAL": up, "TEXCOORD_0": up[:, :2].copy(), "COLOR_0": color}),
        "ids": ring({"_FEATURE_ID_0": IDS["bytes"].astype(np.float32)}),
        "targets": ring(
            {"NORMAL": up}, targets=[{"POSITION": up, "NORMAL": up}, {"POSITION": up, "NORMAL": up}]
        ),
        "skin": ring({"JOINTS_0": np.zeros((384, 4), np.uint8), "WEIGHTS_0": weights}),
    }
    scenes["skin"][0].tree["skins"] = [{"joints": [1]}]
    scenes["skin"][0].nodes({"mesh": 0, "skin": 0}, {})
    before, after = [], []
    for name, (built, _) in scenes.items():
        before.append(tmp_path / f"{name}.glb")
        before[-1].write_bytes(built.bytes)
        for kind, more in {
            "grid": [],
            "lossless": ["--preset", "lossless"],
            "fallback": ["--fallback"],
        }.items():
            after.append(tmp_path / f"{name}.{kind}.glb")
            assert main(["glb", str(before[-1]), "-o", str(after[-1]), *more]) == 0
        (tmp_path / f"{name}.plain.glb").write_bytes(restore(read_document(str(after[-3]))))
        after.append(tmp_path / f"{name}.plain.glb")
    (tmp_path / "moving.bsm").write_bytes(waves())
    assert main(["glb", str(tmp_path / "moving.bsm"), "-o", str(tmp_path / "moving.glb")]) == 0
    assert errors_of([tmp_path / "moving.glb"]) == [[]]
    known = errors_of(before)
    for number, found in enumerate(errors_of(after)):
        assert not set(found) - set(known[number // 4]), after[number]
