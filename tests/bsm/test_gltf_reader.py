"""Scenes of glTF as meshes: what accessors, nodes, skins and compressed views hold, with known answers."""

import re
import sys

import numpy as np
import pytest

import bsm
from bsm import read_mesh
from bsm.cli import main
from bsm.files import conventions
from bsm.gltf.document import read_document
from tests.bsm.files.test_doors import SHOWN, collada
from tests.bsm.files.test_file_attributes import attribute
from tests.bsm.program import python
from tests.gltf import Built, glb, scene
from tests.shapes import torus

POINTS = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], np.float32)
CORNERS = np.array([0, 1, 2, 0, 2, 3], np.uint16)


def one(attributes=None, node=None, **primitive):
    """A square with more attributes, in one node."""
    built = Built()
    given = {"POSITION": built.array(POINTS)} | {
        n: built.array(*v) for n, v in (attributes or {}).items()
    }
    built.nodes(
        {
            "mesh": built.mesh({"attributes": given, "indices": built.array(CORNERS), **primitive}),
            **(node or {}),
        }
    )
    return built


def test_normalized_integers_are_shares():
    built = Built()
    points = built.array(np.rint(POINTS * 32767).astype(np.int16), normalized=True)
    uv = built.array(
        np.array([[0, 0], [65535, 0], [65535, 65535], [0, 65535]], np.uint16), normalized=True
    )
    plain = built.array(np.array([[0, 0], [3, 0], [3, 3], [0, 3]], np.uint8))
    given = {"POSITION": points, "TEXCOORD_0": uv, "TEXCOORD_1": plain}
    built.nodes({"mesh": built.mesh({"attributes": given, "indices": built.array(CORNERS)})})
    mesh = built.read().mesh
    np.testing.assert_array_equal(mesh.positions, POINTS)
    np.testing.assert_array_equal(
        attribute(mesh, "texcoord").values, [[0, 1], [1, 1], [1, 0], [0, 0]]
    )
    np.testing.assert_array_equal(
        attribute(mesh, "texcoord1").values, [[0, 1], [3, 1], [3, -2], [0, -2]]
    )


@pytest.mark.parametrize("blank", [False, True])
def test_sparse_accessors_replace_values(blank):
    built = one()
    accessor = built.tree["accessors"][0]
    if blank:
        del accessor["bufferView"]
    places, values = np.array([1, 3], np.uint16), np.array([[0, 0, 9], [2, 2, 2]], np.float32)
    accessor["sparse"] = {
        "count": 2,
        "indices": {"bufferView": built.view(places.tobytes()), "componentType": 5123},
        "values": {"bufferView": built.view(values.tobytes())},
    }
    expected = np.zeros((4, 3)) if blank else POINTS.copy()
    expected[[1, 3]] = values
    np.testing.assert_array_equal(built.read().mesh.positions, expected)


PLACES = {
    "mirrored": {"scale": [-1, 1, 1]},
    "turned inside out": {"scale": [-1, -2, -0.5]},
    "stretched": {"scale": [3, 1, 0.2], "rotation": [0, 0.6, 0, 0.8]},
    "sheared": {"matrix": [1, 0, 0, 0, 0.7, 1, 0, 0, 0, -0.4, 2, 0, 5, 6, 7, 1]},
    "sheared and mirrored": {"matrix": [1, 0, 0, 0, 0.7, -1, 0, 0, 0, -0.4, 2, 0, 5, 6, 7, 1]},
}


def alignment(mesh):
    """The smallest cosine between the normals of faces and those of their corners."""
    a, b, c = (mesh.positions[mesh.faces[:, place]] for place in range(3))
    across = np.cross(b - a, c - a)
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    normals = attribute(mesh, "normal").values[mesh.faces]
    assert np.abs(np.linalg.norm(normals, axis=2) - 1).max() < 1e-6
    return (normals * across[:, None]).sum(axis=2).min()


@pytest.mark.parametrize("place", PLACES.values(), ids=PLACES)
def test_normals_of_placed_nodes_agree_with_their_faces(place):
    shape = torus(20, 12)
    points = shape.positions[shape.faces]
    across = np.cross(points[:, 1] - points[:, 0], points[:, 2] - points[:, 0])
    across = np.repeat(across / np.linalg.norm(across, axis=1, keepdims=True), 3, axis=0)
    built = Built()
    given = {
        "POSITION": built.array(points.reshape(-1, 3).astype("f4")),
        "NORMAL": built.array(across.astype("f4")),
    }
    mesh = built.mesh({"attributes": given})
    still, moved = (built.nodes({"mesh": mesh, **more}).read().mesh for more in ({}, place))
    assert alignment(still) > 0.999 and alignment(moved) > 0.999
    sides = [np.cross(*np.moveaxis(m.positions[m.faces], 1, 0)[:2]) for m in (still, moved)]
    volumes = [
        (side * m.positions[m.faces][:, 2]).sum()
        for side, m in zip(sides, (still, moved), strict=True)
    ]
    assert volumes[0] * volumes[1] > 0, "a mirror turns the faces around, too"


NORMAL = '<input semantic="NORMAL" source="#n" offset="0"/>'


@pytest.mark.parametrize("kind", ["dae", "scene"])
def test_normals_of_mirrored_parts_of_trimesh_agree_with_their_faces(kind, tmp_path):
    trimesh = pytest.importorskip("trimesh")
    ball = trimesh.creation.icosphere(subdivisions=3)
    ball.vertex_normals  # noqa: B018, trimesh keeps them from now on
    made = trimesh.Scene()
    made.add_geometry(ball, transform=np.diag([-1.0, 2.0, 1.0, 1.0]))
    if kind == "dae":
        pytest.importorskip("collada")
        text = (
            collada("", f'<node id="x"><scale>1 -3 1</scale>{SHOWN}</node>')
            .decode()
            .replace("1 1 0<", "0 1 1<")
        )
        accessor = re.search("<technique_common>.*?</source>", text, re.DOTALL)[0].replace(
            "#a", "#na"
        )
        normals = f'<source id="n"><float_array id="na" count="9">{"0 -0.7071 0.7071 " * 3}</float_array>{accessor}'
        text = text.replace("<vertices", f"{normals}<vertices").replace(
            'offset="0"/>', 'offset="0"/>' + NORMAL
        )
        (tmp_path / "a.dae").write_text(text)
        mesh = read_mesh(tmp_path / "a.dae").mesh
    else:
        from bsm.files.formats.with_trimesh import joined

        mesh = joined(made, bsm.Limits()).checked(bsm.Limits()).mesh
    assert alignment(mesh) > (0.999 if kind == "dae" else 0.97)


def test_details_that_a_mesh_cannot_hold_are_named():
    built = one({"_COLORMAP": (POINTS[:, :1],), "TEXCOORD_0": (POINTS[:, :2],)})
    built.tree["nodes"].append({"mesh": 0})
    built.tree["asset"] |= {"copyright": "by me", "extras": {"author": "me", "list": [1]}}
    read = built.read()
    assert read.dropped == ("nodes outside of the scene", "extras (list)")
    assert attribute(read.mesh, "COLORMAP").semantic == "generic"
    assert read.mesh.metadata["copyright"] == "by me" and read.mesh.metadata["author"] == "me"


def test_colors_of_different_kinds_are_shares_of_one_range():
    built = one({"COLOR_0": (np.full((4, 3), 51, np.uint8),)})
    built.tree["accessors"][-2]["normalized"] = True
    floats = {
        "POSITION": built.array(POINTS),
        "COLOR_0": built.array(np.full((4, 3), 0.3001, np.float32)),
    }
    plain = {"POSITION": built.array(POINTS)}
    built.mesh(
        *({"attributes": given, "indices": built.array(CORNERS)} for given in (floats, plain))
    )
    built.nodes({"mesh": 0}, {"mesh": 1})
    colors = attribute(built.read().mesh, "color").values[[0, 4, 8], 0]
    assert conventions.to_linear(colors) == pytest.approx([0.2, 0.3001, 1.0], abs=2e-5)


def test_faces_of_mirrored_joints_are_turned_alone():
    built = one({
        "NORMAL": (np.tile(np.float32([0, 0, 1]), (4, 1)),), "JOINTS_0": (np.zeros((4, 4), np.uint8),),
        "WEIGHTS_0": (np.tile(np.float32([1, 0, 0, 0]), (4, 1)),),
    }, {"skin": 0})  # fmt: skip
    given = built.tree["meshes"][0]["primitives"][0]["attributes"]
    joints = np.repeat(np.uint8([[0, 0, 0, 0], [1, 0, 0, 0]]), 4, axis=0)
    doubled = {
        "JOINTS_0": joints,
        "POSITION": np.tile(POINTS, (2, 1))
        + np.repeat(np.float32([[0, 0, 0], [0, 5, 0]]), 4, axis=0),
    }
    doubled |= {
        "NORMAL": np.tile(np.float32([0, 0, 1]), (8, 1)),
        "WEIGHTS_0": np.tile(np.float32([1, 0, 0, 0]), (8, 1)),
    }
    given |= {name: built.array(values) for name, values in doubled.items()}
    built.tree["meshes"][0]["primitives"][0]["indices"] = built.array(
        np.concatenate([CORNERS, CORNERS + 4])
    )
    built.tree["nodes"] += [{}, {"scale": [-1, 1, 1]}]
    built.tree |= {"skins": [{"joints": [1, 2]}], "scenes": [{"nodes": [0, 1, 2]}]}
    assert alignment(built.read().mesh) > 0.999


def test_texture_coordinates_need_no_material():
    uv = np.array([[0, 0], [1, 0], [1, 1], [0, 0.25]], np.float32)
    mesh = one({"TEXCOORD_0": (uv,)}).read().mesh
    np.testing.assert_array_equal(attribute(mesh, "texcoord").values, uv * [1, -1] + [0, 1])


@pytest.mark.parametrize("width", [3, 4])
@pytest.mark.parametrize("dtype", [np.uint8, np.uint16, np.float32])
def test_colors_are_linear_in_a_file_and_in_srgb_in_a_mesh(dtype, width, tmp_path):
    values = np.random.default_rng(2).random((4, width)).astype(np.float32)
    values = values if dtype == np.float32 else np.rint(values * np.iinfo(dtype).max).astype(dtype)
    built = Built()
    color = built.array(values, **({} if dtype == np.float32 else {"normalized": True}))
    given = {"POSITION": built.array(POINTS), "COLOR_0": color}
    built.nodes({"mesh": built.mesh({"attributes": given, "indices": built.array(CORNERS)})})
    mesh = built.read().mesh
    bsm.save(mesh, tmp_path / "a.glb")
    for found in (mesh, read_mesh(tmp_path / "a.glb").mesh):
        colors = attribute(found, "color")
        assert colors.semantic == "color"
        linear = conventions.to_linear(conventions.shares_of(colors.values))
        assert linear == pytest.approx(conventions.shares_of(values), abs=2e-5)
    document = read_document(str(tmp_path / "a.glb"))
    stored = document.array(next(document.primitives())["attributes"]["COLOR_0"])
    if dtype == np.uint8:
        np.testing.assert_array_equal(stored, values)
    assert conventions.shares_of(stored) == pytest.approx(conventions.shares_of(values), abs=1e-6)


@pytest.mark.parametrize("width", [3, 4])
def test_each_byte_of_a_color_comes_back_from_a_glb(width, tmp_path):
    bytes_ = np.repeat(np.arange(256, dtype=np.uint8)[:, None], width, axis=1)
    mesh = bsm.TriangleMesh(
        np.eye(256, 3), [[0, 1, 2]], [bsm.Attribute("color", bytes_, semantic="color")]
    )
    bsm.save(mesh, tmp_path / "a.glb")
    document = read_document(str(tmp_path / "a.glb"))
    stored = document.numbers(next(document.primitives())["attributes"]["COLOR_0"])
    assert stored[1, :3] == pytest.approx(1 / 255 / 12.92, abs=1e-5)
    again = attribute(read_mesh(tmp_path / "a.glb").mesh, "color").values
    assert again.dtype == np.uint8 and again.tolist() == bytes_[:3].tolist()


@pytest.mark.parametrize(
    ("mode", "corners", "expected"),
    [
        (5, [0, 1, 3, 2], [[0, 1, 3], [1, 2, 3]]),
        (5, [0, 1, 3, 3, 2, 2, 1, 0], [[0, 1, 3], [2, 0, 1]]),
        (6, [0, 1, 2, 3], [[1, 2, 0], [2, 3, 0]]),
    ],
)
def test_strips_and_fans(mode, corners, expected):
    built = Built()
    primitive = {
        "attributes": {"POSITION": built.array(POINTS)},
        "indices": built.array(np.array(corners, np.uint8)),
    }
    built.nodes({"mesh": built.mesh({**primitive, "mode": mode})})
    found = built.read()
    turned = [sorted((row[k:] + row[:k]) for k in range(3))[0] for row in found.mesh.faces.tolist()]
    assert turned == [sorted((row[k:] + row[:k]) for k in range(3))[0] for row in expected]
    assert found.notes == ()


def test_instances_are_placed_and_their_other_attributes_named():
    built = one()
    half = 0.5**0.5
    places = {
        "TRANSLATION": built.array(np.array([[0, 0, 5], [2, 0, 0]], np.float32)),
        "ROTATION": built.array(np.array([[0, 0, 0, 1], [0, 0, half, half]], np.float32)),
        "SCALE": built.array(np.array([[1, 1, 1], [-2, 2, 2]], np.float32)),
        "_ID": built.array(np.arange(2, dtype=np.float32)),
    }
    node = built.tree["nodes"][0]
    node |= {
        "translation": [1, 0, 0],
        "extensions": {"EXT_mesh_gpu_instancing": {"attributes": places}},
    }
    built.tree["extensionsUsed"] = ["EXT_mesh_gpu_instancing"]
    read = built.read()
    assert "left out: _ID of instances" in read.notes and read.mesh.faces.tolist()[2:] == [
        [6, 5, 4],
        [7, 6, 4],
    ]
    turned = POINTS[:, [1, 0, 2]] * [-2, -2, 2] + [3, 0, 0]
    np.testing.assert_allclose(
        read.mesh.positions, np.concatenate([np.add(POINTS, [1, 0, 5]), turned]), atol=1e-6
    )


def test_instances_that_are_too_many_or_do_not_match_are_refused():
    built = one()
    places = {
        "TRANSLATION": built.array(np.zeros((2, 3), np.float32)),
        "SCALE": built.array(np.ones((3, 3), np.float32)),
    }
    built.tree["nodes"][0]["extensions"] = {"EXT_mesh_gpu_instancing": {"attributes": places}}
    with pytest.raises(bsm.FormatError, match="as many"):
        built.read()
    del places["SCALE"]
    built.tree["accessors"][places["TRANSLATION"]] = {
        "componentType": 5126,
        "type": "VEC3",
        "count": 40_000_000,
    }
    with pytest.raises(bsm.LimitError, match="memory"):
        built.read()


def test_bytes_that_a_required_extension_packs_are_not_read_as_they_are():
    built = one()
    built.tree["bufferViews"][0]["extensions"] = {"EXT_packs": {}}
    built.tree["extensionsUsed"] = ["EXT_packs"]
    assert len(built.read().mesh.faces) == 2
    built.tree["extensionsRequired"] = ["EXT_packs"]
    with pytest.raises(bsm.UnsupportedError, match="EXT_packs"):
        built.read()


def test_points_and_lines_are_named():
    built = one()
    built.tree["meshes"][0]["primitives"].append({"attributes": {"POSITION": 0}, "mode": 0})
    assert "points and lines (1)" in built.read().dropped


def test_morph_targets_and_skins_stand_as_at_rest():
    shift = np.tile(np.array([0, 0, 2], np.float32), (4, 1))
    built = one()
    primitive = built.tree["meshes"][0]["primitives"][0]
    primitive["targets"] = [{"POSITION": built.array(shift)}]
    built.tree["meshes"][0]["weights"] = [0.25]
    found = built.read()
    np.testing.assert_allclose(found.mesh.positions, POINTS + np.array([0, 0, 0.5]))
    assert "morph targets" in found.dropped
    built = one({f"JOINTS_{k}": (np.full((4, 4), k, np.uint8),) for k in range(2)})
    primitive = built.tree["meshes"][0]["primitives"][0]
    for number, share in enumerate((0.75, 0.25)):
        weights = np.zeros((4, 4), np.float32)
        weights[:, 0] = share
        primitive["attributes"][f"WEIGHTS_{number}"] = built.array(weights)
    built.tree["skins"] = [{"joints": [1, 2]}]
    built.nodes(
        {"mesh": 0, "skin": 0, "translation": [9, 9, 9]},
        {"translation": [0, 0, 4]},
        {"scale": [2, 2, 2]},
    )
    expected = 0.75 * (POINTS + np.array([0, 0, 4])) + 0.25 * 2 * POINTS
    np.testing.assert_allclose(built.read().mesh.positions, expected, atol=1e-6)


def test_primitives_that_share_vertices_take_those_that_they_use():
    built = one()
    built.tree["meshes"][0]["primitives"] = [
        {
            "attributes": {"POSITION": 0},
            "indices": built.array(CORNERS[k : k + 3]),
            "material": k // 3,
        }
        for k in (0, 3)
    ]
    built.tree["materials"] = [{"name": "same"}, {"name": "same"}]
    mesh = built.read().mesh
    assert len(mesh.positions) == 6 and attribute(mesh, "material").values[:, 0].tolist() == [0, 1]
    np.testing.assert_array_equal(mesh.positions[mesh.faces], POINTS[CORNERS.reshape(2, 3)])


def test_values_of_another_kind_are_told_with_the_place_of_the_reader():
    built = one(material=0)
    built.tree["meshes"][0]["weights"] = [1, 2]
    built.tree["meshes"][0]["primitives"][0]["targets"] = [{"POSITION": 0}]
    with pytest.raises(
        bsm.FormatError, match=r"does not fit the others.* \(scene\.py, line \d+\)$"
    ):
        built.read()


def test_images_that_are_elsewhere_are_named(tmp_path):
    built = one({"TEXCOORD_0": (POINTS[:, :2].copy(),)}, material=0)
    names = ("https://example.org/a.png", "lost.png", "../secret.png")
    built.tree |= {"images": [{"uri": name} for name in names], "textures": [{"source": 0}]}
    built.tree["materials"] = [
        {"name": "m", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}
    ]
    (tmp_path / "a.glb").write_bytes(built.bytes)
    found = read_mesh(tmp_path / "a.glb")
    assert "the image https://example.org/a.png was left out: it lies at an address" in found.notes
    notes = " ".join(found.notes)
    assert "the image lost.png was left out: no such file beside the mesh" in notes
    assert "the image ../secret.png was left out: it is not in the folder" in notes
    assert (
        found.mesh.metadata["material.0.name"] == "m"
        and "material.0.baseColorTexture" not in found.mesh.metadata
    )


# ------------------------------------------------------------------------------------------------- compressed geometry


def test_draco(tmp_path, monkeypatch, capsys):
    draco = pytest.importorskip("DracoPy")
    shape = torus(20, 12)
    uv = np.random.default_rng(0).random((len(shape.positions), 2))
    data = draco.encode(
        shape.positions, faces=shape.faces.astype(np.uint32), tex_coord=uv, quantization_bits=16
    )
    held = {a["attribute_type"]: a["unique_id"] for a in draco.decode(data).attributes}
    count = len(draco.decode(data).points)
    built = Built(
        extensionsUsed=["KHR_draco_mesh_compression"],
        extensionsRequired=["KHR_draco_mesh_compression"],
    )
    numbers = {"POSITION": held[0], "TEXCOORD_0": held[3]}
    built.tree["accessors"] = [
        {"componentType": 5126, "count": count, "type": "VEC3"},
        {"componentType": 5126, "count": count, "type": "VEC2"},
        {"componentType": 5125, "count": shape.faces.size, "type": "SCALAR"},
    ]
    extension = {
        "KHR_draco_mesh_compression": {"bufferView": built.view(data), "attributes": numbers}
    }
    primitive = {
        "attributes": {"POSITION": 0, "TEXCOORD_0": 1},
        "indices": 2,
        "extensions": extension,
    }
    built.nodes({"mesh": built.mesh(primitive)})
    mesh = built.read().mesh
    middles = [np.sort(m.positions[m.faces].mean(axis=1), axis=0) for m in (mesh, shape)]
    np.testing.assert_allclose(*middles, atol=1e-3)
    assert attribute(mesh, "texcoord").values.shape == (count, 2)
    (tmp_path / "a.glb").write_bytes(built.bytes)
    assert main(["glb", str(tmp_path / "a.glb"), "-o", str(tmp_path / "b.glb")]) == 0
    said = capsys.readouterr().err
    assert "1 of 1 primitives coded" in said
    assert "a.glb: compressed already, by KHR_draco_mesh_compression: errors add up" in said
    grew = (tmp_path / "b.glb").stat().st_size > (tmp_path / "a.glb").stat().st_size
    assert grew == (
        "larger than the input, as KHR_draco_mesh_compression had made that small" in said
    )
    assert read_document(str(tmp_path / "b.glb")).compressed == ["EXT_bsm_compression"]
    monkeypatch.setitem(sys.modules, "DracoPy", None)
    assert main(["encode", str(tmp_path / "a.glb"), "-o", str(tmp_path / "a.bsm")]) == 8
    assert "DracoPy" in capsys.readouterr().err and not (tmp_path / "a.bsm").exists()


def test_meshopt_without_its_library(tmp_path, monkeypatch, capsys):
    built = one()
    view = built.tree["bufferViews"][0]
    how = {**view, "byteStride": 12, "count": 4, "mode": "ATTRIBUTES"}
    view["extensions"] = {"EXT_meshopt_compression": how}
    built.tree["extensionsUsed"] = built.tree["extensionsRequired"] = ["EXT_meshopt_compression"]
    (tmp_path / "a.glb").write_bytes(built.bytes)
    monkeypatch.setitem(sys.modules, "meshoptimizer", None)
    assert main(["encode", str(tmp_path / "a.glb"), "-o", str(tmp_path / "a.bsm")]) == 8
    assert "pip install meshoptimizer" in capsys.readouterr().err
    monkeypatch.undo()
    pytest.importorskip("meshoptimizer")
    with pytest.raises(bsm.FormatError, match="meshoptimizer cannot decode"):
        built.read()


def test_meshopt():
    library = pytest.importorskip("meshoptimizer")
    built = Built(extensionsUsed=["EXT_meshopt_compression"])
    points = built.array(POINTS)
    faces = built.array(CORNERS)
    packed = (
        library.encode_vertex_buffer(POINTS),
        library.encode_index_buffer(CORNERS.astype(np.uint32), 6, 4),
    )
    shapes = ((12, 4, "ATTRIBUTES"), (2, 6, "TRIANGLES"))
    for place, (data, (stride, count, mode)) in enumerate(zip(packed, shapes, strict=True)):
        how = {
            **built.tree["bufferViews"][built.view(bytes(data))],
            "byteStride": stride,
            "count": count,
            "mode": mode,
        }
        built.tree["bufferViews"][place]["extensions"] = {"EXT_meshopt_compression": how}
    built.data = bytes(48 + 12) + built.data[60:]  # only the compressed bytes are there
    mesh = (
        built.nodes({"mesh": built.mesh({"attributes": {"POSITION": points}, "indices": faces})})
        .read()
        .mesh
    )
    np.testing.assert_array_equal(mesh.positions, POINTS)
    np.testing.assert_array_equal(np.sort(mesh.faces, axis=1), [[0, 1, 2], [0, 2, 3]])


def test_our_own_scenes_are_read(tmp_path):
    (tmp_path / "a.glb").write_bytes(scene().bytes)
    assert main(["glb", str(tmp_path / "a.glb"), "-o", str(tmp_path / "b.glb")]) == 0
    before, after = (read_mesh(tmp_path / name).mesh for name in ("a.glb", "b.glb"))
    assert len(before.faces) == len(after.faces)
    middles = [np.sort(mesh.positions[mesh.faces].mean(axis=1), axis=0) for mesh in (before, after)]
    np.testing.assert_allclose(*middles, atol=2e-3)
    assert {a.name for a in before.attributes} == {a.name for a in after.attributes}


# --------------------------------------------------------------------------------------------------------------- walls


@pytest.mark.parametrize("animated", [False, True])
def test_uses_of_primitives_are_counted_before_any_is_made(animated, tmp_path):
    """A thousand targets of one primitive, with three hundred skins: each skin would have tables of its own."""
    count = 300
    built = one(
        {"JOINTS_0": (np.zeros((4, 4), np.uint8),), "WEIGHTS_0": (np.eye(4, dtype=np.float32),)}
    )
    primitive = built.tree["meshes"][0]["primitives"][0]
    points = built.array(np.random.default_rng(0).random((count, 3)).astype(np.float32))
    primitive["attributes"] = {
        "POSITION": points,
        "JOINTS_0": built.array(np.zeros((count, 4), np.uint8)),
        "WEIGHTS_0": built.array(np.tile(np.eye(4, dtype=np.float32)[:1], (count, 1))),
    }
    primitive["targets"] = [{"POSITION": points}] * 1000
    built.tree["skins"] = [{"joints": [0]} for _ in range(300)]
    built.nodes({}, *({"mesh": 0, "skin": number} for number in range(300)))
    times, moves = (
        built.array(np.array([0, 1], np.float32)),
        built.array(np.array([[0, 0, 0], [1, 0, 0]], np.float32)),
    )
    channel = {"sampler": 0, "target": {"node": 0, "path": "translation"}}
    built.tree["animations"] = [
        {"samplers": [{"input": times, "output": moves}], "channels": [channel]}
    ]
    (tmp_path / "a.glb").write_bytes(built.bytes)
    script = """
import resource, sys
import bsm
from bsm.files.motion.frames import Wanted
from bsm.gltf.scene import read_gltf
before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
try:
    read_gltf(sys.argv[1], Wanted()) if sys.argv[2] == "True" else bsm.read_mesh(sys.argv[1])
except bsm.LimitError as error:
    print((resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) // 1024)
"""
    assert int(python("-c", script, tmp_path / "a.glb", animated).stdout) < 60, "megabytes"


def test_skins_of_many_nodes_are_counted():
    """Ten thousand nodes with a skin of ten thousand joints."""
    built = one(
        {"JOINTS_0": (np.zeros((4, 4), np.uint8),), "WEIGHTS_0": (np.eye(4, dtype=np.float32),)}
    )
    built.tree["skins"] = [{"joints": [0] * 10_000}]
    built.nodes({}, *({"mesh": 0, "skin": 0} for _ in range(10_000)))
    with pytest.raises(bsm.LimitError, match="work"):
        built.read()


def test_an_old_gltf_is_named():
    built = one()
    built.tree["asset"] = {"version": "1.0"}
    with pytest.raises(bsm.FormatError, match=r"glTF 1\.0"):
        built.read()


def test_images_that_share_bytes_are_counted():
    built = one({"TEXCOORD_0": (POINTS[:, :2].copy(),)})
    image = built.view(b"\x89PNG\r\n\x1a\n" + bytes((1 << 20) + 3000))
    start, size = built.tree["bufferViews"][image]["byteOffset"], 1 << 20
    built.tree["bufferViews"] += [
        {"buffer": 0, "byteOffset": start + k, "byteLength": size} for k in range(3000)
    ]
    built.tree["images"] = [
        {"bufferView": image + 1 + k, "mimeType": "image/png"} for k in range(3000)
    ]
    built.tree["textures"] = [{"source": k} for k in range(3000)]
    built.tree["materials"] = [
        {"pbrMetallicRoughness": {"baseColorTexture": {"index": k}}} for k in range(3000)
    ]
    corners = built.array(CORNERS)
    built.tree["meshes"][0]["primitives"] = [
        {"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": corners, "material": k}
        for k in range(3000)
    ]
    with pytest.raises(bsm.LimitError, match="memory"):
        built.read()


def test_each_value_of_another_kind_is_named_by_its_place():
    """A text, number, list, object or null in place of each value, and each value missing."""
    built = scene()
    assert built.read().mesh.faces.size
    told = r"'\w+' object|\w+Error\b|\bint\(\)|NoneType|subscriptable|reshape|broadcast|argument|iterable"

    def places(tree):
        for key in [*tree] if isinstance(tree, dict) else range(len(tree)):
            yield tree, key
            if isinstance(tree[key], (dict, list)):
                yield from places(tree[key])

    refused = 0
    for tree, key in [*places(built.tree)]:
        kept = tree[key]
        for wrong in ("x", 7, 1.5, [], {}, None):
            tree[key] = wrong
            try:
                read_mesh(glb(built.tree, built.data), "glb")
            except bsm.BsmError as error:
                refused += 1
                assert not re.search(told, str(error)), (key, wrong, str(error))
        tree[key] = kept
    assert refused > 200
    for part, wrong, expected in (
        (
            "meshes",
            {"primitives": ["x"]},
            r'meshes\[0\]\.primitives\[0\] must be an object, not "x"',
        ),
        ("nodes", {"rotation": [1]}, r"nodes\[0\]\.rotation must have 4 values, not 1"),
        ("meshes", {}, "'primitives' is missing"),
    ):
        built = scene()
        built.tree[part][0] = wrong
        with pytest.raises(bsm.FormatError, match=expected):
            built.read()
