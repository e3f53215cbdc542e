"""Scenes of glTF: geometry is coded, all else stays as it was."""

import contextlib
import copy
import io
import json
import os
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import bsm
from bsm.cli import main
from bsm.files.images import ImageRule, smaller
from bsm.gltf.coding import EXTENSION, array_of, drawn
from bsm.gltf.compress import compress, count_primitives
from bsm.gltf.document import Document, read_document
from tests.gltf import Built, glb, scene
from tests.shapes import torus
from tests.streams import info_of

WEB = Path(__file__).parents[2] / "web"
CODE = {"grid": 13}
"""Quick, where the look is not what is tested."""


@pytest.fixture
def source(tmp_path):
    path = tmp_path / "scene.glb"
    path.write_bytes(scene().bytes)
    return path


def coded_of(document):
    """The streams of a document, and what each accessor says of one."""
    views = document.tree["bufferViews"]
    found = {}
    for number, accessor in enumerate(document.tree["accessors"]):
        extension = (
            views[accessor["bufferView"]].get("extensions", {}).get(EXTENSION)
            if "bufferView" in accessor
            else None
        )
        if extension:
            found[number] = (extension, accessor)
    return found


def test_geometry_is_coded_and_all_else_stays(source, tmp_path, capsys):
    target = tmp_path / "small.glb"
    assert main(["glb", str(source), "-o", str(target)]) == 0
    assert "2 of 2 primitives coded" in capsys.readouterr().err
    assert main(["glb", str(source), "-o", str(target), "-f", "--json"]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert (facts["primitives"], facts["coded"], facts["unchanged"], facts["images"]) == (
        2,
        2,
        {},
        [],
    )
    assert (facts["input_bytes"], facts["output_bytes"]) == (
        source.stat().st_size,
        target.stat().st_size,
    )
    assert 0 < facts["max_error_of_component"] < 0.01 and "unchanged images" in facts["notes"][0]
    before, after = read_document(str(source)), read_document(str(target))
    assert target.stat().st_size < 0.3 * source.stat().st_size
    for name in ("nodes", "scenes", "materials", "textures"):
        assert after.tree[name] == before.tree[name]
    assert after.tree["extensionsUsed"] == [*before.tree["extensionsUsed"], EXTENSION]
    assert after.tree["extensionsRequired"] == [EXTENSION]
    assert main(["encode", str(target), "-o", str(tmp_path / "small.bsm")]) == 0
    assert f"compressed already, by {EXTENSION}: errors add up" in capsys.readouterr().err
    assert after.view(after.tree["images"][0]["bufferView"]) == before.view(
        before.tree["images"][0]["bufferView"]
    )

    def value(document, *path):
        node = document.tree
        for key in path:
            node = node[key]
        return document.array(node)

    for path in (
        ("animations", 0, "samplers", 0, "input"),
        ("animations", 0, "samplers", 0, "output"),
    ):
        np.testing.assert_array_equal(value(after, *path), value(before, *path))
    matrices = after.tree["accessors"][after.tree["skins"][0]["inverseBindMatrices"]]
    assert after.view(matrices["bufferView"]) == before.view(7)


def test_accessors_say_what_the_stream_holds(source):
    document = read_document(str(source))
    after = Document(compress(document, CODE).data)
    coded = coded_of(after)
    streams = sorted({extension["stream"] for extension, _ in coded.values()})
    assert len(streams) == 2  # of the mesh with a skin, and of the one that morphs
    morphing = bsm.decode(after.view(streams[1]))
    np.testing.assert_allclose(
        next(a.values for a in morphing.attributes if a.name == "0/POSITION"), 0.25, atol=1e-4
    )
    stream = streams[0]
    coded = {number: pair for number, pair in coded.items() if pair[0]["stream"] == stream}
    mesh = bsm.decode(after.view(stream))
    shape = drawn(mesh)
    kinds = {
        extension["attribute"]: (a["count"], a["componentType"], a["type"])
        for extension, a in coded.values()
    }
    assert kinds == {
        "POSITION": (len(shape.arrays["POSITION"]), 5126, "VEC3"),
        "TEXCOORD_0": (len(shape.arrays["POSITION"]), 5126, "VEC2"),
        "JOINTS_0": (len(shape.arrays["POSITION"]), 5121, "VEC4"),
        "WEIGHTS_0": (len(shape.arrays["POSITION"]), 5121, "VEC4"),
        "indices": (len(shape.index), 5123, "SCALAR"),
    }
    assert {extension.get("componentType") for extension, _ in coded.values()} == {None, 5121, 5123}
    primitive = after.tree["meshes"][0]["primitives"][0]
    positions = after.tree["accessors"][primitive["attributes"]["POSITION"]]
    np.testing.assert_allclose(positions["min"], mesh.positions.min(axis=0), atol=1e-6)
    weights = next(a for a in mesh.attributes if a.name == "WEIGHTS_0")
    assert (weights.values.sum(axis=1) == 255).all()
    sizes = [v["byteLength"] for v in after.tree["bufferViews"] if v["buffer"] == 1]
    assert after.tree["buffers"][1]["byteLength"] == max(sizes)


def test_colors_of_a_stream_of_a_mesh_become_linear():
    mesh = replace(
        torus(8, 6),
        attributes=(bsm.Attribute("color", np.full((48, 3), 188, np.uint8), semantic="color"),),
    )
    np.testing.assert_allclose(array_of((mesh, drawn(mesh)), "COLOR_0", None), 0.5029, atol=1e-4)


def test_quantized_geometry_becomes_floats():
    built, mesh = scene(), torus(40, 24)
    built.tree["extensionsUsed"] = built.tree["extensionsRequired"] = ["KHR_mesh_quantization"]
    for number, dtype, most in ((0, np.int16, 32767), (1, np.uint16, 65535), (6, np.int8, 127)):
        values = Document(built.bytes).array(number)
        built.array(np.rint(np.clip(values / 2, -1, 1) * most).astype(dtype), normalized=True)
        built.tree["accessors"][number] |= built.tree["accessors"].pop()
    after = Document(compress(Document(built.bytes), CODE).data)
    coded = coded_of(after)
    assert {extension["attribute"] for extension, _ in coded.values()} >= {
        "POSITION",
        "TEXCOORD_0",
        "0/POSITION",
    }
    for extension, accessor in coded.values():
        if extension["attribute"] in ("POSITION", "TEXCOORD_0", "0/POSITION"):
            assert accessor["componentType"] == 5126 and "normalized" not in accessor
    first = after.tree["accessors"][
        after.tree["meshes"][0]["primitives"][0]["attributes"]["POSITION"]
    ]
    np.testing.assert_allclose(first["max"], mesh.positions.max(axis=0) / 2, atol=2e-3)
    stream = next(
        extension["stream"]
        for extension, _ in coded.values()
        if extension["attribute"] == "0/POSITION"
    )
    moved = next(a for a in bsm.decode(after.view(stream)).attributes if a.name == "0/POSITION")
    np.testing.assert_allclose(moved.values, 16 / 127, atol=1e-4)


def test_what_plain_geometry_shares_with_coded_one_is_let_go():
    built, corners = scene(), np.array([[0], [1], [2]], np.uint16)
    merged = Document(built.bytes).view(4)
    shared = built.view(merged + corners.tobytes() + b"\0\0")
    built.tree["accessors"][4]["bufferView"] = shared
    index = built.array(corners)
    built.tree["accessors"][index] |= {"bufferView": shared, "byteOffset": len(merged)}
    few = built.array(
        np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32), min=[0, 0, 0], max=[1, 1, 0]
    )
    built.mesh({"attributes": {"POSITION": few}, "indices": index})
    found = compress(Document(built.bytes), CODE)
    assert found.coded == 2
    after = Document(found.data)
    index = after.tree["meshes"][2]["primitives"][0]["indices"]
    np.testing.assert_array_equal(after.array(index), corners)
    assert len(after.view(after.tree["accessors"][index]["bufferView"])) == corners.nbytes


def pieces_of(document, stream):
    """Triangles of each primitive that a stream holds, as coordinates."""
    mesh = bsm.decode(document.view(stream))
    shape = drawn(mesh)
    return [
        shape.arrays["POSITION"][shape.index[start : start + count]]
        for start, count in shape.pieces
    ]


def test_primitives_of_a_mesh_share_a_stream(source):
    document = read_document(str(source))
    given = document.tree["meshes"][0]["primitives"]
    half = document.tree["accessors"][4]["count"] // 6 * 3
    for number, (offset, count) in enumerate(
        [(0, half), (2 * half, document.tree["accessors"][4]["count"] - half)]
    ):
        document.tree["accessors"].append(
            {**document.tree["accessors"][4], "byteOffset": offset, "count": count}
        )
        if number:
            given.append(copy.deepcopy(given[0]))
        given[number]["indices"] = len(document.tree["accessors"]) - 1
    found = compress(document, CODE)
    assert found.coded == 3 and not found.unchanged
    after = Document(found.data)
    first, second = after.tree["meshes"][0]["primitives"]
    assert first["attributes"] == second["attributes"] and first["indices"] != second["indices"]
    accessors = [after.tree["accessors"][primitive["indices"]] for primitive in (first, second)]
    assert accessors[0]["bufferView"] == accessors[1]["bufferView"]
    extension = after.tree["bufferViews"][accessors[0]["bufferView"]]["extensions"][EXTENSION]
    pieces = pieces_of(after, extension["stream"])
    positions, faces = document.array(0), document.array(4).ravel()
    for accessor, piece, corners in zip(
        accessors, pieces, (faces[:half], faces[half:]), strict=True
    ):
        assert accessor["count"] == len(corners) == len(piece)
        centers = [some.reshape(-1, 3, 3).mean(axis=1) for some in (piece, positions[corners])]
        apart = np.linalg.norm(centers[0][:, None] - centers[1][None], axis=-1)
        assert apart.min(axis=0).max() < 0.03 and apart.min(axis=1).max() < 0.03
    assert accessors[1]["byteOffset"] == 2 * half and "byteOffset" not in accessors[0]


def test_equal_meshes_share_a_stream():
    built, mesh = Built(), torus(40, 24)
    for number, scale in enumerate((1.0, 1.0, 1.5)):
        table = (scale * mesh.positions).astype(np.float32)
        positions = built.array(
            table, min=table.min(axis=0).tolist(), max=table.max(axis=0).tolist()
        )
        normals = built.array(mesh.positions.astype(np.float32) / 2, name=f"normals {number}")
        indices = built.array(mesh.faces.astype(np.uint16).ravel())
        built.mesh({"attributes": {"POSITION": positions, "NORMAL": normals}, "indices": indices})
    built.nodes({"mesh": 0}, {"mesh": 1}, {"mesh": 2})
    compressed = compress(Document(built.bytes), CODE)
    after = Document(compressed.data)
    assert compressed.coded == 3 and len(after.streams) == 2
    one, two, larger = (mesh["primitives"][0] for mesh in after.tree["meshes"])
    assert one["indices"] == two["indices"] != larger["indices"]
    assert (
        one["attributes"]["POSITION"]
        == two["attributes"]["POSITION"]
        != larger["attributes"]["POSITION"]
    )
    named = [after.tree["accessors"][primitive["attributes"]["NORMAL"]] for primitive in (one, two)]
    assert [accessor["name"] for accessor in named] == ["normals 0", "normals 1"]
    assert named[0]["bufferView"] == named[1]["bufferView"]
    alone = Document(built.bytes)
    del alone.tree["meshes"][1:], alone.tree["nodes"][1:]
    alone.tree["scenes"][0]["nodes"] = [0]
    single = Document(compress(alone, CODE).data)
    for name, index in two["attributes"].items():
        expected = single.array(single.tree["meshes"][0]["primitives"][0]["attributes"][name])
        np.testing.assert_array_equal(after.array(index), expected)


def test_fallback_holds_what_decoders_fill_in(source, tmp_path):
    target = tmp_path / "with space.glb"
    assert main(["glb", str(source), "-o", str(target), "--fallback"]) == 0
    after = read_document(str(target))
    assert after.tree["buffers"][1]["uri"] == "with%20space.fallback.bin"
    assert "extensionsRequired" not in after.tree and EXTENSION in after.tree["extensionsUsed"]
    coded = coded_of(after)
    primitive = after.tree["meshes"][0]["primitives"][0]
    extension = after.tree["bufferViews"][
        after.tree["accessors"][primitive["indices"]]["bufferView"]
    ]["extensions"][EXTENSION]
    mesh = bsm.decode(after.view(extension["stream"]))
    for view in after.tree["bufferViews"]:
        view.pop("extensions", None)  # as loaders see it that do not know them
    plain = {
        s["attribute"]: after.array(n)
        for n, (s, _) in coded.items()
        if s["stream"] == extension["stream"]
    }
    np.testing.assert_array_equal(
        plain["POSITION"][plain["indices"].ravel()], mesh.positions[mesh.faces.ravel()].astype("f4")
    )
    assert (plain["WEIGHTS_0"].sum(axis=1) == 255).all() and plain["TEXCOORD_0"].shape[1] == 2


def waves(count=8):
    mesh = torus(40, 24)
    times = np.linspace(0, 2 * np.pi, count, endpoint=False)
    frames = np.stack(
        [mesh.positions * (1 + 0.1 * np.sin(3 * mesh.positions[:, :1] + time)) for time in times]
    )
    across = (
        (mesh.positions - mesh.positions.min(axis=0)) / np.ptp(mesh.positions, axis=0)
    ).astype(np.float32)
    uv = bsm.codec.geometry.attributes.Attribute("uv", across[:, :2], "vertex", "texcoord")
    return bsm.encode_sequence(
        frames, mesh.faces, mesh_attributes=(uv,), metadata={"up": "z", "name": "waves"}, step=0.005
    )


def test_a_sequence_becomes_a_scene_that_moves(tmp_path, capsys):
    stream = waves()
    (tmp_path / "waves.bsm").write_bytes(stream)
    given = [str(tmp_path / name) for name in ("waves.bsm", "waves.glb")]
    assert main(["glb", given[0], "-o", given[1]]) == 0
    document = read_document(given[1])
    tree = document.tree
    assert document.view(0) == stream and tree["meshes"][0]["extensions"][EXTENSION] == {
        "stream": 0
    }
    assert tree["nodes"][0]["name"] == "waves" and tree["nodes"][0]["rotation"][0] < 0
    first = bsm.decode_sequence(stream)[0][0].astype(np.float32)
    found = {
        extension["attribute"]: accessor for extension, accessor in coded_of(document).values()
    }
    assert (
        found["POSITION"]["max"] == first.max(axis=0).tolist()
        and found["indices"]["count"] == 3 * 40 * 24 * 2
    )
    assert {
        name: value["type"] for name, value in found.items() if value["count"] == len(first)
    } == {"POSITION": "VEC3", "NORMAL": "VEC3", "TEXCOORD_0": "VEC2"}
    for more in (["--fallback"], ["--quick"], ["--preset", "fine"], ["--images", "webp"]):
        assert main(["glb", given[0], "-o", given[1], "-f", *more]) == 2
    (tmp_path / "still.bsm").write_bytes(bsm.encode(torus(12, 8)))
    assert main(["glb", str(tmp_path / "still.bsm"), "-o", given[1], "-f"]) == 0, (
        "a mesh is coded anew"
    )
    assert "errors add up" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("count", "more", "light"),
    [(15, [], False), (16, [], True), (16, ["--no-quick"], False), (1, ["--quick"], True)],
)
def test_scenes_of_many_meshes_are_quick_to_decode(tmp_path, count, more, light):
    bsm.save(torus(24, 16), tmp_path / "one.glb")
    document = read_document(str(tmp_path / "one.glb"))
    primitive = document.tree["meshes"][0]["primitives"][0]
    document.tree["meshes"] = [{"primitives": [copy.deepcopy(primitive)]} for _ in range(count)]
    (tmp_path / "many.glb").write_bytes(glb(document.tree, document.buffer(0)))
    assert main(["glb", str(tmp_path / "many.glb"), "-o", str(tmp_path / "small.glb"), *more]) == 0
    after = read_document(str(tmp_path / "small.glb"))
    streams = {extension["stream"] for extension, _ in coded_of(after).values()}
    headers = [info_of(after.view(stream)).header for stream in streams]
    assert headers and all((header.light == 1) == light for header in headers)


def test_images_by_a_rule(source, tmp_path):
    target = tmp_path / "small.glb"
    assert main(["glb", str(source), "-o", str(target), "--images", "webp:80@32"]) == 0
    after = read_document(str(target))
    image = after.view(after.tree["images"][0]["bufferView"])
    assert image.startswith(b"RIFF") and after.tree["images"][0]["mimeType"] == "image/webp"
    assert after.tree["textures"] == [{"extensions": {"EXT_texture_webp": {"source": 0}}}]
    assert "EXT_texture_webp" in after.tree["extensionsRequired"]
    from PIL import Image

    assert Image.open(io.BytesIO(image)).size == (32, 32)
    assert smaller(b"no image", ImageRule("webp")) is None


def test_a_gltf_with_files_beside_it(tmp_path):
    built = scene()
    tree, data = built.tree, built.data
    tree["buffers"] = [{"byteLength": len(data), "uri": "some%20data.bin"}]
    (tmp_path / "some data.bin").write_bytes(data)
    (tmp_path / "scene.gltf").write_text(json.dumps(tree))
    assert main(["glb", str(tmp_path / "scene.gltf"), "-o", str(tmp_path / "small.glb")]) == 0
    assert coded_of(read_document(str(tmp_path / "small.glb")))
    (tmp_path / "loop").symlink_to("loop")
    os.mkfifo(tmp_path / "pipe")
    for uri, why in {
        "../elsewhere.bin": "not in the folder",
        "https://example.org/a.bin": "no such file beside",
        "loop": "cannot be opened|no such file beside",
        "pipe": "no such file beside",
        "none": "no such file beside",
        "./" * 600: "1200 characters",
        "a\0b": "cannot be opened",
    }.items():
        tree["buffers"][0]["uri"] = uri
        (tmp_path / "scene.gltf").write_text(json.dumps(tree))
        with pytest.raises(bsm.FormatError, match=why):
            compress(read_document(str(tmp_path / "scene.gltf")), CODE)
        words = [
            "encode",
            str(tmp_path / "scene.gltf"),
            "--animation",
            "0",
            "-o",
            str(tmp_path / "a.bsm"),
        ]
        assert main(words) == 3


def test_what_an_animation_uses_stays(source):
    document = read_document(str(source))
    # The positions of the mesh with a skin.
    document.tree["animations"][0]["samplers"][0]["output"] = 0
    found = compress(document, CODE)
    after = Document(found.data)
    kept = after.tree["animations"][0]["samplers"][0]["output"]
    np.testing.assert_array_equal(after.array(kept), document.array(0))
    assert (
        found.coded == 2
        and after.tree["meshes"][0]["primitives"][0]["attributes"]["POSITION"] != kept
    )


def test_numbers_are_as_short_as_single_precision_allows(source):
    document = read_document(str(source))
    numbers = [-0.0, 0.06499999761581421, 0.1, 3.0, 1e300]
    document.tree["nodes"][2]["weights"] = numbers
    document.tree["extras"] = {"numbers": numbers}
    short = Document(compress(document, CODE).data).tree
    assert json.dumps(short["nodes"][2]["weights"]) == json.dumps([0, 0.065, 0.1, 3, 1e300])
    assert json.dumps(short["extras"]["numbers"]) == json.dumps(numbers), "extras are not touched"


WRONG = (
    -1,
    0,
    2**31 - 1,
    2**63,
    -(2**40),
    1.5,
    1e308,
    float("nan"),
    None,
    True,
    "x",
    "data:,a\0",
    [],
    {},
    [[]],
    5125,
)


def test_whatever_a_tree_holds_is_an_error_of_ours():
    """Each value replaced by some of what it may not be: numbers, names, lists, whole entries."""
    built = scene()
    tree, data = built.tree | {"buffers": [{"byteLength": len(built.data)}]}, built.data

    def placed(node, path=()):
        for key, value in node.items() if isinstance(node, dict) else enumerate(node):
            yield (*path, key)
            if isinstance(value, dict | list):
                yield from placed(value, (*path, key))

    tried = refused = 0
    for number, place in enumerate(placed(tree)):
        for value in WRONG[number % 16 :: 16]:
            wrong = copy.deepcopy(tree)
            node = wrong
            for key in place[:-1]:
                node = node[key]
            node[place[-1]] = value
            tried += 1
            try:
                document = Document(glb(wrong, data))
                count_primitives(document)
                compress(document, {"grid": 4, "effort": "quick"})
            except bsm.BsmError:
                refused += 1
    assert tried > 150 and refused > tried / 5


def test_bytes_that_are_used_again_and_again_are_counted():
    """A mebibyte of floats as many overlapping accessors of as many primitives of one mesh."""
    built = Built()
    part = {
        "bufferView": built.view(bytes(1 << 20)),
        "componentType": 5126,
        "type": "VEC3",
        "count": 80_000,
    }
    built.tree["accessors"] = [{**part, "byteOffset": 4 * k} for k in range(200)]
    built.mesh(*({"attributes": {"POSITION": k}} for k in range(200)))
    with pytest.raises(bsm.LimitError, match="memory"):
        compress(Document(built.bytes), CODE)


def test_trees_that_are_nested_without_end(tmp_path):
    path = tmp_path / "deep.gltf"
    for depth in (700, 100_000):
        path.write_text(
            '{"asset": {"version": "2.0"}, "extras": ' + "[" * depth + "]" * depth + "}"
        )
        with contextlib.suppress(bsm.FormatError):
            compress(read_document(str(path)), CODE)


def test_no_gltf():
    for content in (b"", b"glTF", b"{}", b"[1]", glb({"asset": 3}, b"")):
        with pytest.raises((bsm.FormatError, bsm.TruncatedError)):
            Document(content)
