"""What is written acts in other programs: size, up, opacity, colors; parts that differ are joined without a loss."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest

from bsm import (
    Attribute,
    FormatError,
    Limits,
    MeshError,
    TriangleMesh,
    __version__,
    read_mesh,
    save,
)
from bsm.cli import main
from bsm.files.conventions import placement
from bsm.files.formats.appearance import Texture, appearance, in_mtl
from bsm.files.formats.metadata import in_words, materials_in
from bsm.files.formats.polygons import Column, Part, joined_parts
from bsm.files.mesh import written_mesh
from bsm.files.motion.frames import Shared
from bsm.files.sequence import sequence_writer
from bsm.gltf.coding import MATTE
from bsm.ground.lengths import metres, unit_named
from tests.bsm.files.test_file_attributes import png
from tests.gltf import unpack

TRIANGLE = np.array([[0, 0, 0], [1, 0, 0], [0, 2, 3]], float)


@pytest.mark.parametrize("up", ["x", "y", "z"])
@pytest.mark.parametrize("unit", ["mm", "inches", "0.5 m", "0.01 * meters", "meters", ""])
def test_a_glb_has_the_size_in_meters_and_y_up(unit, up, tmp_path):
    metadata = {"up": up, **({"unit": unit} if unit else {})}
    written = written_mesh(TriangleMesh(TRIANGLE, [[0, 1, 2]], (), metadata), "glb")
    trimesh = pytest.importorskip("trimesh")
    (tmp_path / "a.glb").write_bytes(written.data)
    size = metres(unit) if unit else 1.0
    upward = size * np.ptp(TRIANGLE[:, "xyz".index(up)])
    assert trimesh.load(tmp_path / "a.glb", process=False).extents[1] == pytest.approx(
        upward, rel=1e-6
    )
    again = read_mesh(tmp_path / "a.glb").mesh
    assert np.ptp(again.positions, axis=0)[1] == pytest.approx(upward, rel=1e-6)
    assert (again.metadata["unit"], again.metadata["up"]) == (
        "meters",
        "y",
    ) and written.left_out == ()


@pytest.mark.parametrize("up", ["x", "y", "z"])
@pytest.mark.parametrize(
    ("unit", "named"), [("mm", "millimeters"), ("inches", "inches"), ("0.5 m", "millimeters")]
)
def test_a_3mf_has_its_unit_and_z_up(unit, named, up, tmp_path):
    pytest.importorskip("lib3mf")
    mesh = TriangleMesh(TRIANGLE, [[0, 1, 2]], (), {"unit": unit, "up": up, "Title": "One"})
    assert save(mesh, tmp_path / "a.3mf") == ()
    again = read_mesh(tmp_path / "a.3mf").mesh
    assert {**again.metadata} == {"unit": named, "up": "z", "Title": "One"}
    upward = metres(unit) * np.ptp(TRIANGLE[:, "xyz".index(up)])
    assert metres(named) * np.ptp(again.positions[:, 2]) == pytest.approx(upward, rel=1e-6)
    trimesh = pytest.importorskip("trimesh")
    pytest.importorskip("networkx")
    pytest.importorskip("lxml")
    assert trimesh.load(tmp_path / "a.3mf").extents[2] == pytest.approx(
        np.ptp(again.positions[:, 2]), rel=1e-6
    )


@pytest.mark.parametrize("size", [1e-7, 1e-3, 1.0, 1e3, 1e6])
def test_a_3mf_has_enough_digits_for_any_size(size, tmp_path):
    pytest.importorskip("lib3mf")
    save(TriangleMesh(np.float32(size / 3 * TRIANGLE), [[0, 1, 2]]), tmp_path / "a.3mf")
    assert read_mesh(tmp_path / "a.3mf").mesh.positions == pytest.approx(
        size / 3 * TRIANGLE, rel=3e-7
    )


def test_what_lib3mf_does_not_write_is_named(tmp_path):
    pytest.importorskip("lib3mf")
    with pytest.raises(MeshError, match="lib3mf cannot write"):
        save(TriangleMesh(1e12 * TRIANGLE, [[0, 1, 2]]), tmp_path / "a.3mf")
    for faces in ([[0, 1, 1]], [[2, 1, 2], [0, 0, 0]]):
        with pytest.raises(
            MeshError, match=f"^{len(faces)} faces? with one vertex twice.*write PLY"
        ):
            save(TriangleMesh(TRIANGLE, [[0, 1, 2], *faces]), tmp_path / "a.3mf")


def test_a_unit_that_is_unknown_is_kept_and_changes_no_size():
    assert metres("furlong") is None and placement({"unit": "furlong"}, "glb").scale == 1.0
    assert unit_named(0.001) == "millimeters" and metres(unit_named(0.0123)) == pytest.approx(
        0.0123
    )


@pytest.mark.parametrize(
    ("words", "opacity", "mode"),
    [
        ({"Kd": "0 1 0", "d": "0.3"}, 0.3, "BLEND"),
        ({"Tr": "0.7"}, 0.3, "BLEND"),
        ({"technique": "0"}, 1.0, "OPAQUE"),
        ({"map_Kd": 0, "map_d": 0}, 1.0, "BLEND"),
        ({"Kd": "1 1 1", "map_d": 0}, 1.0, "OPAQUE"),
        ({"baseColorFactor": "1 1 1 0.5", "alphaMode": "OPAQUE"}, 0.5, "OPAQUE"),
    ],
)
def test_opacity_acts_and_only_gltf_is_metal_by_default(words, opacity, mode):
    look = appearance(words)
    assert (look.mode, look.opacity, look.metallic) == (
        mode,
        pytest.approx(opacity),
        "baseColorFactor" in words,
    )


def test_colors_of_materials_are_linear_in_gltf_and_srgb_in_mtl():
    look = appearance({"Kd": "0.501961 0 1", "Ke": "0.501961 0 0"})
    assert look.color[0] == look.emission[0] == 0.215861
    assert in_mtl({"baseColorFactor": "0.215861 0 1 1"}) == {"Kd": "0.501961 0 1"}
    assert "d" not in in_mtl({"baseColorFactor": "1 1 1 0.5", "alphaMode": "OPAQUE"})
    assert in_mtl({"baseColorFactor": "1 1 1 0.5"})["d"] == "0.5"


@pytest.mark.parametrize(
    ("words", "metal", "painted"),
    [
        ({"Kd": "1 0 0"}, 0.0, False),
        ({"Kd": "1 0 0", "Pm": "0.5"}, 0.5, False),
        ({"map_Pr": 0}, 0.0, True),
        ({"map_Pr": 0, "map_Pm": 0}, 1.0, True),
        ({"map_Pr": 0, "Pm": "0.5"}, 0.5, False),
        ({"map_Pr": 0, "map_Pm": 1}, 0.0, False),
    ],
)
def test_materials_of_mtl_are_no_metals_and_maps_of_roughness_act(words, metal, painted):
    metadata = {f"material.0.{name}": value for name, value in words.items()}
    metadata |= {f"image.{number}.data": png() + bytes(number) for number in range(2)}
    written = written_mesh(TriangleMesh(TRIANGLE, [[0, 1, 2]], (), metadata), "glb")
    surface = unpack(written.data)[0]["materials"][0]["pbrMetallicRoughness"]
    assert (
        surface.get("metallicFactor", 1.0) == metal
        and ("metallicRoughnessTexture" in surface) == painted
    )
    assert any("map_Pr" in name for name in written.left_out) == ("map_Pr" in words and not painted)


@pytest.mark.parametrize("header", [b"COLOR=\xff\x80\0\xff by hand", b"", b"solid of a program"])
def test_the_header_of_an_stl_comes_back(header):
    data = (
        header.ljust(80, b"\0") + written_mesh(TriangleMesh(TRIANGLE, [[0, 1, 2]]), "stl").data[80:]
    )
    mesh = read_mesh(data, "stl").mesh
    written = written_mesh(mesh, "stl")
    text = header.startswith(b"solid")  # which would make others take it for a text
    assert (written.data == data) != text and written.left_out == (("stl_header",) if text else ())


@pytest.mark.parametrize(
    ("name", "contents", "said"),
    [
        ("a.obj", written_mesh(TriangleMesh(TRIANGLE, [[0, 1, 2]]), "ply").data, "a PLY"),
        ("a.glb", written_mesh(TriangleMesh(TRIANGLE, [[0, 1, 2]]), "ply").data, "a PLY, not .glb"),
        ("a.obj", b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n", "an STL, not .obj"),
        ("a.ply", b"<!DOCTYPE html><html>", "an HTML page"),
        ("a.off", b"ISO-10303-21;", "a STEP file"),
        ("a.step", b"ISO-10303-21;", "holds surfaces"),
        ("a.las", b"LASF", "point clouds are not supported"),
        (
            "a.ply",
            b"ply\nformat ascii 1.0\nelement vertex 0\nelement range_grid 0\nend_header\n",
            "a range grid",
        ),
    ],
)
def test_files_of_other_kinds_are_named(name, contents, said, tmp_path):
    (tmp_path / name).write_bytes(contents)
    with pytest.raises((FormatError, MeshError), match=said):
        read_mesh(tmp_path / name)


def test_vertices_that_are_transparent_blend():
    shades = Attribute("color", np.array([[255, 0, 0, 128]] * 3, np.uint8), semantic="color")
    data = written_mesh(TriangleMesh(TRIANGLE, [[0, 1, 2]], [shades]), "glb").data
    assert unpack(data)[0]["materials"] == [{**MATTE, "alphaMode": "BLEND"}]
    again = read_mesh(data, "glb").mesh
    assert again.attributes[0].values[0].tolist() == [255, 0, 0, 128]
    opaque = data.replace(b'"BLEND"', b'"MASK" ')
    assert read_mesh(opaque, "glb").mesh.metadata["material.0.alphaMode"] == "MASK"


def test_options_of_images_and_words_for_what_is_lost():
    assert appearance({"norm": 1, "norm.options": "-s 2 3"}).normal_texture == Texture(
        1, (2.0, 3.0), (0.0, 0.0)
    )
    assert appearance({"norm": 1, "norm.options": "-clamp on"}).normal_texture == Texture(
        1, wrap=("clamp", "clamp")
    )
    assert "norm.options" not in appearance({"norm": 1, "norm.options": "-bm 2"}).stated
    metadata = {
        "material.0.name": "Glass",
        "material.0.d": "0.3",
        "material.1.d": "0.5",
        "image.0.name": "oak.png",
    }
    assert in_words([*metadata], metadata) == [
        "the image oak.png",
        "name, opacity of material Glass",
        "opacity of material 1",
    ]


SAID = {
    "": 0,
    ".options": "-s 2 3 1 -o 0.5 0.25 0",
    ".rotation": 0.5,
    ".wrap": "clamp mirror",
    ".set": 1,
}
SAID = {f"material.0.baseColorTexture{entry}": value for entry, value in SAID.items()} | {
    "material.0.unlit": 1
}


def with_two_sets(words=SAID):
    sets = [
        Attribute(name, np.eye(3, 2) * n, "vertex", "texcoord") for n, name in enumerate("ab", 1)
    ]
    return TriangleMesh(
        TRIANGLE, [[0, 1, 2]], sets, {"image.0.name": "a.png", "image.0.data": png(), **words}
    )


def test_what_gltf_says_of_a_texture_comes_back():
    written = written_mesh(with_two_sets(), "glb")
    tree, _ = unpack(written.data)
    material, again = tree["materials"][0], read_mesh(written.data, "glb")
    info = material["pbrMetallicRoughness"]["baseColorTexture"]
    moved = info["extensions"]["KHR_texture_transform"]
    assert info["texCoord"] == 1 and tree["samplers"] == [{"wrapS": 33071, "wrapT": 33648}]
    assert {*tree["extensionsUsed"]} == {*material["extensions"], "KHR_texture_transform"}
    x, y, cos, sin = 0.25 * 2, 0.75 * 3, np.cos(moved["rotation"]), np.sin(moved["rotation"])
    # And glTF counts from above.
    expected = [cos * x - sin * y + 0.5, 1 - (sin * x + cos * y + 0.25)]
    x, y = moved["scale"] * np.array([0.25, 1 - 0.75])
    assert moved["offset"] + np.array([cos * x + sin * y, cos * y - sin * x]) == pytest.approx(
        expected
    )
    assert written.left_out == again.dropped == () and SAID.items() <= again.mesh.metadata.items()
    one = replace(with_two_sets(), attributes=with_two_sets().attributes[:1])
    assert written_mesh(one, "glb").left_out == (
        "baseColorTexture.set of material 0 (for programs other than bsm)",
    )
    swapped = re.sub(
        rb"TEXCOORD_(.)", lambda found: b"TEXCOORD_%d" % (1 - int(found[1])), written.data
    )
    # Sets have numbers.
    assert [a.values.max() for a in read_mesh(swapped, "glb").mesh.attributes] == [2, 1]


def test_what_usd_says_of_a_texture_comes_back(tmp_path):
    usd = pytest.importorskip("pxr.Usd")
    mesh, path = with_two_sets(), str(tmp_path / "a.usdz")
    shared = Shared(lambda: mesh.attributes, lambda: mesh.metadata)
    with sequence_writer(path, "usdz", mesh.faces, 1, overwrite=True, shared=shared) as write:
        write(mesh.positions)
    assert shared.left_out == ["baseColorTexture.set, unlit of material 0"]
    stage, again = usd.Stage.Open(path), read_mesh(path)
    given = {prim.GetName(): prim.GetAttribute for prim in stage.Traverse()}
    assert [given["diffuseColor_texture"](f"inputs:wrap{side}").Get() for side in "ST"] == [
        "clamp",
        "mirror",
    ]
    moved = [
        given["diffuseColor_transform"](f"inputs:{name}").Get()
        for name in ("scale", "rotation", "translation")
    ]
    assert moved == [(2, 3), pytest.approx(np.degrees(0.5)), (0.5, 0.25)] and again.dropped == ()
    assert appearance(materials_in(again.mesh.metadata)[0]).color_texture == Texture(
        0, (2, 3), (0.5, 0.25), pytest.approx(0.5), ("clamp", "mirror")
    )


def test_what_mtl_says_of_a_texture_comes_back(tmp_path):
    lost = "baseColorTexture.rotation, baseColorTexture.wrap, baseColorTexture.set, unlit of material 0"
    assert save(with_two_sets(), tmp_path / "a.obj") == (
        "b",
        f"{lost} (for programs other than bsm)",
    )
    assert b"map_Kd -s 2 3 1 -o 0.5 0.25 0 " in (tmp_path / "a.mtl").read_bytes()
    data = written_mesh(
        with_two_sets({"material.0.map_Kd": 0, "material.0.map_Kd.options": "-clamp on"}), "glb"
    ).data
    assert unpack(data)[0]["samplers"] == [{"wrapS": 33071, "wrapT": 33071}]
    save(read_mesh(data, "glb").mesh, tmp_path / "b.obj")
    assert b"map_Kd -clamp on b.0.png" in (tmp_path / "b.mtl").read_bytes()


def part(*columns):
    return Part(TRIANGLE, np.array([3]), np.arange(3), columns, np.zeros(1, np.int64), "")


def joined(*parts):
    found = joined_parts(parts, [(3, 1)] * len(parts), Limits(), 1 << 20).checked(Limits())
    return {attribute.name: attribute for attribute in found.mesh.attributes}, found.notes


@pytest.mark.parametrize(
    ("meaning", "blank", "filled"), [("color", 255, "white"), ("generic", 0, "zeros")]
)
@pytest.mark.parametrize("widths", [(3, 4), (4, 3), (3, 3)])
def test_values_of_fewer_numbers_are_filled_up(widths, meaning, blank, filled):
    tables, most = [np.full((3, width), 7, np.uint8) for width in widths], max(widths)
    found, notes = joined(
        *(part(Column("W", table, "vertex", meaning)) for table in tables), part()
    )
    assert found["W"].values[::3].tolist() == [
        [7] * width + [blank] * (most - width) for width in (*widths, 0)
    ]
    told = f"parts whose W has fewer than {most} numbers were given zeros after them" in notes
    assert (
        told == (meaning == "generic" and most > min(widths))
        and f"parts without W were given {filled}: 1" in notes
    )


def test_parts_without_normals_get_those_of_their_faces():
    slanted = np.tile([0.6, 0.8, 0.0], (3, 1))
    found, notes = joined(part(Column("normal", slanted, semantic="normal")), part())
    normals = found["normal"].values[found["normal"].indices]
    flat = np.cross(TRIANGLE[1] - TRIANGLE[0], TRIANGLE[2] - TRIANGLE[0])
    assert normals[0] == pytest.approx(slanted) and normals[1] == pytest.approx(
        np.tile(flat / np.linalg.norm(flat), (3, 1))
    )
    assert "parts without normals were given those of their faces: 1" in notes


def test_usd_has_linear_colors_opacity_holes_and_parts_that_come_and_go(tmp_path):
    pytest.importorskip("pxr")
    stage = """#usda 1.0
(
    metersPerUnit = 0.01
    upAxis = "Z"
    startTimeCode = 0
    endTimeCode = 2
)
def Xform "W" {
color3f[] primvars:displayColor = [(0.2158605, 0, 1)] (interpolation = "constant")
def Mesh "a" {
int[] faceVertexCounts = [3, 3]
int[] faceVertexIndices = [0, 1, 2, 0, 2, 3]
int[] holeIndices = [1]
point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
}
def Mesh "b" {
int[] faceVertexCounts = [3]
int[] faceVertexIndices = [0, 1, 2]
point3f[] points.timeSamples = {0: [(0, 0, 0), (1, 0, 0), (0, 1, 0)], 2: [(0, 0, 1), (1, 0, 1), (0, 1, 1)]}
token visibility.timeSamples = {0: "invisible", 1: "inherited"}
}
def Cube "c" {}
}
"""
    (tmp_path / "a.usda").write_text(stage)
    read = read_mesh(tmp_path / "a.usda")
    assert len(read.mesh.faces) == 1 and read.mesh.metadata["unit"] == "centimeters"
    (color,) = (a for a in read.mesh.attributes if a.name == "color")
    assert color.values.tolist() == [[128, 0, 255]] * 4
    assert "Cube, which is not a mesh" in read.dropped
    assert any("they appear later (--runs): /W/b" in note for note in read.notes)
    from bsm.files.motion.frames import Wanted
    from bsm.files.sequence import open_sequence

    frames = open_sequence(str(tmp_path / "a.usda"), None, Wanted(runs=True))
    assert [len(mesh.faces) for mesh in frames.meshes] == [1, 2, 2]


def test_tiles_keep_the_unit_and_the_axis(tmp_path):
    mesh = TriangleMesh(10 * TRIANGLE, [[0, 1, 2]], (), {"unit": "mm", "up": "y"})
    (tmp_path / "a.ply").write_bytes(written_mesh(mesh, "ply").data)
    assert (
        main(["tile", str(tmp_path / "a.ply"), "-o", str(tmp_path / "t"), "--grid-cell", "0.25"])
        == 0
    )
    assert main(["untile", str(tmp_path / "t"), "-o", str(tmp_path / "tileset.json")]) == 0
    tree = json.loads((tmp_path / "tileset.json").read_text())["root"]
    center = np.array(tree["transform"]).reshape(4, 4).T @ [*tree["boundingVolume"]["box"][:3], 1]
    assert center[:3] == pytest.approx([0.005, -0.015, 0.01], abs=1e-6)
    for name in ("b.ply", "b.obj"):
        assert main(["untile", str(tmp_path / "t"), "-o", str(tmp_path / name)]) == 0
        assert read_mesh(tmp_path / name).mesh.metadata == {
            "provenance": f"bsm {__version__}",
            "unit": "mm",
            "up": "y",
        }
