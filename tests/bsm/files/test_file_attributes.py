"""What mesh files hold beside positions and faces: what is read, and what comes back after writing."""

import io
import struct
import zlib

import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

import bsm
from bsm import Attribute, BsmError, Limits, TriangleMesh, read_mesh
from bsm.files.mesh import size_with_parts, written_mesh
from bsm.files.table import MESH_FORMATS, WRITTEN_FORMATS
from tests.shapes import at_corners, patch, tetrahedron, torus

TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\n"


def png(*head, pixels=bytes([0, 200, 10, 20])):
    """A picture of one point, or another with its sides, bits and kind of colors, and rows of pixels."""

    def chunk(kind, data):
        body = kind + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))

    begin = chunk(b"IHDR", struct.pack(">IIBBBBB", *(head or (1, 1, 8, 2)), 0, 0, 0))
    return (
        b"\x89PNG\r\n\x1a\n" + begin + chunk(b"IDAT", zlib.compress(pixels)) + chunk(b"IEND", b"")
    )


def attribute(mesh, name):
    return next(a for a in mesh.attributes if a.name == name)


def dressed(image=b""):
    """A mesh with everything: a seam, normals, colors, numbers, materials, an image, metadata."""
    mesh = patch(5, 4)
    n, m = len(mesh.positions), len(mesh.faces)
    random = np.random.default_rng(5)
    uv = random.random((m + 4, 2)).astype(np.float32)
    indices = random.integers(0, len(uv), (m, 3))
    normals = random.normal(size=(n, 3))
    normals = (normals / np.linalg.norm(normals, axis=1, keepdims=True)).astype(np.float32)
    attributes = (
        Attribute("color", random.integers(0, 256, (n, 3), np.uint8), semantic="color"),
        Attribute("normal", normals, semantic="normal"),
        Attribute("texcoord", uv, "corner", "texcoord", indices),
        Attribute("height", random.normal(size=n), semantic="generic"),
        Attribute("label", random.integers(-5, 5, (n, 2), np.int16)),
        Attribute("material", np.arange(m) % 2, "face"),
        Attribute("face_color", random.integers(0, 256, (m, 3), np.uint8), "face", "color"),
    )
    metadata = {
        "name": "Tuch № 1",
        "unit": "mm",
        "year": 1994,
        "scale": 0.25,
        "secret": b"\x00\x01",
        "material.0.name": "red",
        "material.0.Kd": "1 0 0",
        "material.1.name": "painted",
        "material.1.map_Kd": 0,
        "image.0.name": "picture.png",
        "image.0.data": image or png(),
    }
    return TriangleMesh(mesh.positions, mesh.faces, attributes, metadata)


def assert_same(mesh, again, names, error=0.0):
    assert np.allclose(again.positions[again.faces], mesh.positions[mesh.faces], atol=1e-6)
    for name in names:
        found = attribute(again, name)
        before = attribute(mesh, name)
        assert found.semantic == before.semantic and found.components == before.components
        assert (
            np.abs(at_corners(again, found).astype(float) - at_corners(mesh, before)).max() <= error
        ), name


# ------------------------------------------------------------------------------------------------------------ reading


def test_an_obj_with_everything(tmp_path):
    (tmp_path / "a.mtl").write_text(
        "newmtl red\nKd 1 0 0\nNs 10 # shine\nnewmtl painted\nmap_Kd -s 2 2 1 sub/skin 1.png\nnewmtl spare\nd 0.5\n"
    )
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "skin 1.png").write_bytes(png())
    (tmp_path / "a.obj").write_text(
        "mtllib a.mtl\no body\nv 0 0 0 1 0 0.501961\nv 1 0 0 0 0 0\nv 1 1 0 0 0 0\nv 0 1 0 0 1 0\n"
        "vt 0 0\nvt 1 0\nvt 1 1\nvt 0.5 1\nvn 0 0 1\nvn 0 1 0\n"
        "f 1/1/1 2/2/1 3/3/1\nusemtl painted\ng a b\nf -4/-4/-2 -2/-2/-1 -1/-1/-1\nusemtl red\nf 1/1/1 2/2/1 4/4/2\n"
    )
    source = read_mesh(tmp_path / "a.obj")
    mesh = source.mesh
    assert source.dropped == source.notes == ()
    assert attribute(mesh, "color").values.tolist() == [
        [255, 0, 128],
        [0, 0, 0],
        [0, 0, 0],
        [0, 255, 0],
    ]
    assert at_corners(mesh, attribute(mesh, "texcoord"))[1].tolist() == [[0, 0], [1, 1], [0.5, 1]]
    assert at_corners(mesh, attribute(mesh, "normal"))[1].tolist() == [
        [0, 0, 1],
        [0, 1, 0],
        [0, 1, 0],
    ]
    assert attribute(mesh, "material").values[:, 0].tolist() == [0, 1, 2]
    assert attribute(mesh, "group").values[:, 0].tolist() == [0, 1, 1]
    entries = dict(mesh.metadata)
    assert entries.pop("image.0.data") == png()
    assert entries == {
        "mtllib": "a.mtl",
        "object.0.name": "body",
        "group.0.name": "",
        "group.1.name": "a b",
        "material.0.name": "",
        "material.1.name": "painted",
        "material.1.map_Kd": 0,
        "material.1.map_Kd.options": "-s 2 2 1",
        "material.2.name": "red",
        "material.2.Kd": "1 0 0",
        "material.2.Ns": "10",
        "material.3.name": "spare",
        "material.3.d": "0.5",
        "image.0.name": "sub/skin 1.png",
    }


def test_corners_without_a_value_get_zeros():
    source = read_mesh(f"{TRIANGLE}vt 0.5 0.5\nf 1/1 2/1 3\n".encode())
    found = attribute(source.mesh, "texcoord")
    assert at_corners(source.mesh, found).tolist() == [[[0.5, 0.5], [0.5, 0.5], [0, 0]]]
    assert source.notes == ("corners without texture coordinates were given zeros: 1",)


@pytest.mark.parametrize(
    ("lines", "dropped", "why"),
    [
        ("vt 0 0\nf 1/1 2/2 3/1\n", "texture coordinates", "a corner refers to value 1"),
        ("vt 0 0\nf 1/1 2/-3 3/1\n", "texture coordinates", "a corner refers to value -2"),
        ("vn nan nan nan\nf 1//1 2//1 3//1\n", "normals", "not finite"),
        ("l 1 2\np 3\nf 1 2 3\n", "lines that begin with l, p", ""),
    ],
)
def test_what_is_wrong_in_an_obj_is_left_out_and_reported(lines, dropped, why):
    source = read_mesh((TRIANGLE + lines).encode())
    assert source.mesh.attributes == ()
    assert ", ".join(source.dropped) == dropped
    assert dropped in source.notes[-1] and why in source.notes[-1]


@pytest.mark.parametrize("corner", ["/1", "1/1/1/1", "1/x", "1.5", "0", "1/1_0"])
def test_corners_that_are_none(corner):
    with pytest.raises(BsmError):
        read_mesh(f"{TRIANGLE}vt 0 0\nf {corner} 2 3\n".encode())


def test_images_outside_the_folder_are_not_taken(tmp_path):
    inside = tmp_path / "inside"
    inside.mkdir()
    (tmp_path / "secret.png").write_bytes(png())
    (inside / "letter.png").write_text("dear all")
    (inside / "link.png").symlink_to(tmp_path / "secret.png")
    names = ["../secret.png", str(tmp_path / "secret.png"), "letter.png", "link.png", "\0", "."]
    (inside / "a.mtl").write_text(
        "".join(f"newmtl m{i}\nmap_Kd {name}\n" for i, name in enumerate(names))
    )
    (inside / "a.obj").write_text(f"mtllib a.mtl\n{TRIANGLE}f 1 2 3\n")
    source = read_mesh(inside / "a.obj")
    assert not any(isinstance(value, bytes) for value in source.mesh.metadata.values())
    assert len([note for note in source.notes if "its name was kept" in note]) == len(names)
    (inside / "a.obj").write_text(
        f"mtllib ../{tmp_path.name}/../../etc/passwd\n{TRIANGLE}f 1 2 3\n"
    )
    assert "not in the folder of the mesh" in " ".join(read_mesh(inside / "a.obj").notes)


def test_metadata_that_are_too_large_are_left_out_and_reported(tmp_path):
    (tmp_path / "a.mtl").write_text("newmtl m\nmap_Kd a.png\nmap_Bump b.png\n")
    (tmp_path / "a.png").write_bytes(png() + bytes(900))
    (tmp_path / "b.png").write_bytes(png() + bytes(5000))
    (tmp_path / "a.obj").write_text(
        f'# meta story: "{"long " * 300}"\nmtllib a.mtl\nusemtl m\n{TRIANGLE}f 1 2 3\n'
    )
    source = read_mesh(tmp_path / "a.obj", limits=Limits(metadata_bytes=1000))
    assert {"image.0.data", "image.1.data"} <= source.mesh.metadata.keys(), "images do not count"
    assert source.dropped == ("story",) and "more than 1000" in source.notes[-1]


def test_many_names_are_one_entry(tmp_path):
    names = [f"part {number}" for number in range(900)]
    lines = "".join(f"g {name}\nusemtl m{number}\nf 1 2 3\n" for number, name in enumerate(names))
    source = read_mesh((TRIANGLE + lines).encode())
    assert source.mesh.metadata["group.names"].split("\n") == names and source.dropped == ()
    stream = bsm.encode(source.mesh, keep_order=True, grid=8)
    assert bsm.decode(stream).metadata == source.mesh.metadata
    bsm.save(source.mesh, tmp_path / "a.obj")
    again = read_mesh(tmp_path / "a.obj").mesh
    assert again.metadata == source.mesh.metadata
    assert_same(source.mesh, again, ["group", "material"])


def test_more_entries_than_there_can_be_are_left_out_and_reported(tmp_path):
    (tmp_path / "a.mtl").write_text(
        "".join(f"newmtl m{n}\nKd 1 0 0\nKa 0 0 0\nNs 1\n" for n in range(8200))
    )
    (tmp_path / "a.obj").write_text(f"mtllib a.mtl\n{TRIANGLE}f 1 2 3\n")
    source = read_mesh(tmp_path / "a.obj")
    assert (
        len(source.mesh.metadata) == 1 << 15
        and "33 entries of metadata, material.8191." in source.notes[-1]
    )
    assert bsm.decode(bsm.encode(source.mesh, grid=8)).metadata == source.mesh.metadata


def test_a_ply_as_text_with_everything():
    lines = [
        "ply", "format ascii 1.0", "comment TextureFile skin.png", 'obj_info meta unit: "cm"', "element vertex 4",
        *(f"property float {name}" for name in ["x", "y", "z", "nx", "ny", "nz", "s", "t", "quality"]),
        *(f"property uchar {name}" for name in ["red", "green", "blue", "alpha"]),
        "property double f_0", "property double f_1", "element face 2", "property uchar flags",
        "property list uchar float texcoord", "property list uchar int vertex_indices", "property int texnumber",
        "element edge 1", "property int vertex1", "end_header",
        *(f"{x} {y} 0 0 0 1 {x} {y} {x + y} 1 2 3 {x} 0.5 {y}" for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))),
        "7 8 0 0 1 0 1 1 0 1 4 0 1 2 3 0", "9 6 0 0 0.5 0 1 1 3 0 1 2 1", "0",
    ]  # fmt: skip
    source = read_mesh("\n".join(lines).encode())
    mesh = source.mesh
    assert [
        (a.name, a.domain, a.semantic, a.values.dtype.name, a.components) for a in mesh.attributes
    ] == [
        ("normal", "vertex", "normal", "float32", 3),
        ("color", "vertex", "color", "uint8", 4),
        ("texcoord", "vertex", "texcoord", "float32", 2),
        ("quality", "vertex", "generic", "float32", 1),
        ("f", "vertex", "generic", "float64", 2),
        ("flags", "face", "generic", "uint8", 1),
        ("material", "face", "generic", "int32", 1),
        ("corner_texcoord", "corner", "texcoord", "float32", 2),
    ]
    assert attribute(mesh, "flags").values[:, 0].tolist() == [7, 7, 9], "a square is two triangles"
    wedges = at_corners(mesh, attribute(mesh, "corner_texcoord"))
    assert wedges.tolist() == [
        [[0, 0], [1, 0], [1, 1]],
        [[0, 0], [1, 1], [0, 1]],
        [[0, 0], [0.5, 0], [1, 1]],
    ]
    assert source.dropped == ("edge",)
    assert mesh.metadata["unit"] == "cm" and mesh.metadata["image.0.name"] == "skin.png"


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("ragged", [False, True])
def test_a_binary_ply(order, ragged):
    head = (
        f"ply\nformat binary_{'little' if order == '<' else 'big'}_endian 1.0\nelement vertex 4\n"
        "property float x\nproperty float y\nproperty float z\nproperty ushort weight\nelement face 2\n"
        "property short part\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\n"
        "property list uchar float odd\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n"
    )
    points = b"".join(
        struct.pack(f"{order}3fH", x, y, 0, 500 + x) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))
    )
    faces = b""
    for part, corners in ((-3, [0, 1, 2, 3] if ragged else [0, 1, 3]), (4, [1, 2, 3])):
        uv = [0.25 * i for i in range(2 * len(corners))]
        faces += struct.pack(
            f"{order}hB{len(corners)}iB{len(uv)}fB1f3B",
            part,
            len(corners),
            *corners,
            len(uv),
            *uv,
            1,
            9,
            1,
            2,
            3,
        )
    source = read_mesh(head.encode() + points + faces)
    parts = [-3, -3, 4] if ragged else [-3, 4]
    assert attribute(source.mesh, "part").values[:, 0].tolist() == parts
    assert attribute(source.mesh, "weight").values[:, 0].tolist() == [500, 501, 501, 500]
    assert attribute(source.mesh, "color").values.tolist() == [[1, 2, 3]] * len(parts)
    last = at_corners(source.mesh, attribute(source.mesh, "texcoord"))[-1]
    assert last.tolist() == [[0, 0.25], [0.5, 0.75], [1, 1.25]]
    assert source.dropped == ("odd",)


@pytest.mark.parametrize(
    ("head", "behind", "of_face", "expected", "dropped"),
    [
        ("COFF", " 255 0 7 9", "", {"color": [255, 0, 7, 9]}, ()),
        ("COFF", " 0.5 0.25 0", "", {"color": [0.5, 0.25, 0]}, ()),
        ("COFF", " 1 0 0", "", {"color": [1, 0, 0]}, ()),
        ("COFF", " 1.0 0.0 0.0", "", {"color": [255, 0, 0]}, ()),
        ("NOFF", " 0 0 1", "", {"normal": [0, 0, 1]}, ()),
        (
            "STCNOFF",
            " 0 0 1 9 9 9 0.5 1",
            "",
            {"normal": [0, 0, 1], "color": [9, 9, 9], "texcoord": [0.5, 1]},
            (),
        ),
        ("OFF", "", " 1.0 0.5 0.0", {"color": [1, 0.5, 0]}, ()),
        ("OFF", "", " 30 20 10 255", {"color": [30, 20, 10, 255]}, ()),
        ("OFF", " 7 8 9", "", {}, ("numbers after the coordinates",)),
        ("OFF", "", " 5", {}, ("colors of faces",)),
    ],
)
def test_an_off(head, behind, of_face, expected, dropped):
    rows = "".join(f"{row}{behind}\n" for row in ("0 0 0", "1 0 0", "1 1 0", "0 1 0"))
    source = read_mesh(f"{head}\n4 1 0\n{rows}4 0 1 2 3{of_face}\n".encode())
    assert {a.name: a.values[0].tolist() for a in source.mesh.attributes} == expected
    assert source.dropped == dropped


def test_the_arrays_of_an_npz(tmp_path):
    mesh = tetrahedron()
    np.savez(
        tmp_path / "a.npz",
        positions=mesh.positions,
        faces=mesh.faces,
        colors=np.zeros((4, 3), np.uint8),
        uv=np.zeros(2),
        label=np.array(["a"] * 4),
        **{
            "face/group": np.arange(4),
            "corner/texcoord": np.zeros((4, 3, 2)),
            "vertex/huge": np.full(4, 2**40),
        },
    )
    source = read_mesh(tmp_path / "a.npz")
    assert {(a.name, a.domain, a.semantic) for a in source.mesh.attributes} == {
        ("colors", "vertex", "color"),
        ("group", "face", "generic"),
        ("texcoord", "corner", "texcoord"),
    }
    assert source.dropped == ("uv", "label", "huge")


def test_numbers_of_an_stl():
    mesh = tetrahedron()
    marked = TriangleMesh(
        mesh.positions, mesh.faces, [Attribute("attribute", np.arange(4, dtype=np.uint16), "face")]
    )
    again = read_mesh(written_mesh(marked, "stl").data).mesh
    assert attribute(again, "attribute").values[:, 0].tolist() == [0, 1, 2, 3]
    assert read_mesh(written_mesh(mesh, "stl").data).mesh.attributes == ()


@pytest.mark.parametrize("kind", ["dae", "3mf", "glb"])
def test_what_trimesh_tells(kind):
    trimesh = pytest.importorskip("trimesh")
    for needed in {"3mf": ("networkx", "lxml", "lib3mf"), "dae": ("collada",)}.get(kind, ()):
        pytest.importorskip(needed)
    box = trimesh.creation.box()
    box.visual = trimesh.visual.ColorVisuals(
        box, vertex_colors=np.arange(32, dtype=np.uint8).reshape(8, 4)
    )
    data = box.export(file_type=kind)
    source = read_mesh(data if isinstance(data, bytes) else data.encode(), kind)
    held = {attribute.name for attribute in source.mesh.attributes}
    assert ("color" in held) == (kind in ("dae", "glb"))
    assert source.mesh.metadata.get("unit") == {
        "dae": "meters",
        "glb": "meters",
        "3mf": "millimeters",
    }.get(kind)
    assert source.mesh.metadata.get("up") == {"dae": "y", "glb": "y", "3mf": "z"}.get(kind)


# ---------------------------------------------------------------------------------------------------- there and back


KEPT = {
    "npz": {"color", "normal", "texcoord", "height", "label", "material", "face_color"},
    "ply": {"color", "normal", "texcoord", "height", "label", "material", "face_color"},
    "obj": {"color", "normal", "texcoord", "material"},
    "off": {"color", "normal", "texcoord", "face_color"},
    "vtp": {"color", "normal", "texcoord", "height", "label", "material", "face_color"},
    "stl": set(),
}


def by_material(mesh):
    order = np.argsort(attribute(mesh, "material").values[:, 0], kind="stable")
    taken = [
        attribute.taken(np.arange(len(mesh.positions)), order) for attribute in mesh.attributes
    ]
    return TriangleMesh(mesh.positions, mesh.faces[order], taken, mesh.metadata)


def obj_of(*values):
    """Texture coordinates and faces in an OBJ of two triangles with these values at their corners."""
    uv = Attribute("uv", np.array(values, np.float32), "corner", "texcoord")
    mesh = TriangleMesh(np.eye(4, 3), [[0, 1, 2], [1, 3, 2]], [uv])
    return [
        line
        for line in written_mesh(mesh, "obj").data.decode().splitlines()
        if line.startswith(("v", "f"))
    ]


def test_texture_coordinates_of_an_obj_are_written_once():
    """As they are first needed, and 0.0 apart from -0.0."""
    lines = obj_of([1, 1], [0, 0.5], [1, 1], [-0.0, 0.5], [0, 0.5], [1, 1])
    assert lines[4:] == ["vt 1 1", "vt 0 0.5", "vt -0 0.5", "f 1/1 2/2 3/1", "f 2/3 4/2 3/1"]


def test_texture_coordinates_without_seams_have_the_numbers_of_vertices(tmp_path):
    lines = obj_of([1, 1], [0, 0.5], [1, 1], [0, 0.5], [0.5, 0], [1, 1])
    assert lines[4:] == [
        "vt 1 1",
        "vt 0 0.5",
        "vt 1 1",
        "vt 0.5 0",
        "f 1/1 2/2 3/3",
        "f 2/2 4/4 3/3",
    ]
    vtk = pytest.importorskip("vtkmodules.vtkIOGeometry")
    (tmp_path / "a.obj").write_text("\n".join(lines))
    reader = vtk.vtkOBJReader()
    reader.SetFileName(str(tmp_path / "a.obj"))
    reader.Update()
    assert reader.GetOutput().GetNumberOfPoints() == 4, "VTK cuts every corner of other files"


def test_faces_of_an_obj_are_grouped_unless_they_are():
    mesh = torus(40, 24)
    for numbers, changes in (
        (np.arange(len(mesh.faces)) % 3, 3),
        (np.arange(len(mesh.faces)) // 100 % 3, 20),
    ):
        of_faces = Attribute("material", numbers, "face")
        data = written_mesh(TriangleMesh(mesh.positions, mesh.faces, [of_faces]), "obj").data
        assert data.count(b"usemtl") == changes
        again = read_mesh(data, "obj").mesh
        assert (
            np.bincount(attribute(again, "material").values[:, 0]).tolist()
            == np.bincount(numbers).tolist()
        )


@pytest.mark.parametrize("kind", MESH_FORMATS)
def test_there_and_back(kind, tmp_path):
    mesh = dressed()
    left_out = bsm.save(mesh, tmp_path / f"b.{kind}")
    source = read_mesh(tmp_path / f"b.{kind}")
    attributes = {name for name in left_out if name not in mesh.metadata and " " not in name}
    assert attributes == KEPT["npz"] - KEPT[kind]
    assert ("the image picture.png" in left_out) == ("material" not in KEPT[kind])
    if KEPT[kind]:
        assert_same(by_material(mesh) if kind == "obj" else mesh, source.mesh, KEPT[kind])
        for name in ("name", "unit", "year", "scale"):
            assert source.mesh.metadata[name] == mesh.metadata[name]
        assert ("secret" in left_out) == (kind not in ("npz", "vtp"))
    if kind in ("obj", "ply"):
        assert source.mesh.metadata["image.0.data"] == png()
        assert source.notes == source.dropped == ()
    if kind == "obj":
        assert (
            tmp_path / "b.mtl"
        ).read_text() == "newmtl red\nKd 1 0 0\nnewmtl painted\nmap_Kd b.0.png\n"
        assert source.mesh.metadata["material.1.map_Kd"] == 0
    if kind in ("npz", "vtp"):
        assert source.mesh.metadata == mesh.metadata


def test_glb_there_and_back(tmp_path):
    pytest.importorskip("trimesh")
    pytest.importorskip("PIL")
    mesh = dressed()
    left_out = bsm.save(mesh, tmp_path / "b.glb")
    source = read_mesh(tmp_path / "b.glb")
    assert set(left_out) == {"height", "face_color", "secret"}, "doubles are no floats"
    again = source.mesh
    # Faces are together that have one material.
    order = np.argsort(attribute(mesh, "material").values[:, 0], kind="stable")
    assert np.allclose(
        1000 * again.positions[again.faces], mesh.positions[mesh.faces[order]], atol=1e-6
    )
    for name in ("normal", "texcoord", "label"):
        before = at_corners(mesh, attribute(mesh, name))[order]
        assert at_corners(again, attribute(again, name)) == pytest.approx(before, abs=1e-6), name
    colors = at_corners(again, attribute(again, "color"))
    assert np.array_equal(colors[:, :, :3], at_corners(mesh, attribute(mesh, "color"))[order])
    assert attribute(again, "material").values[:, 0].tolist() == sorted(
        np.arange(len(mesh.faces)) % 2
    )
    entries = again.metadata
    assert entries["image.0.data"] == png() and entries["material.1.baseColorTexture"] == 0
    assert (
        entries["material.0.name"] == "red" and entries["material.0.baseColorFactor"] == "1 0 0 1"
    )
    assert (entries["name"], entries["unit"], entries["year"], entries["scale"]) == (
        "Tuch № 1",
        "meters",
        1994,
        0.25,
    )


def test_a_jpeg_is_not_compressed_again(tmp_path):
    pytest.importorskip("trimesh")
    image = pytest.importorskip("PIL.Image")
    buffer = io.BytesIO()
    image.effect_noise((32, 32), 80).convert("RGB").save(buffer, format="JPEG", quality=60)
    assert buffer.getvalue() in written_mesh(dressed(buffer.getvalue()), "glb").data


@pytest.mark.parametrize("name", ["red.png", r".\red.png", r"C:\work\red.png"])
def test_images_that_are_found_count_as_input_by_whatever_name(tmp_path, name):
    (tmp_path / "a.obj").write_text(f"mtllib a.mtl\nusemtl m\n{TRIANGLE}f 1 2 3\n")
    (tmp_path / "a.mtl").write_text(f"newmtl m\nmap_Kd {name}\n")
    (tmp_path / "red.png").write_bytes(png())
    metadata = read_mesh(tmp_path / "a.obj").mesh.metadata
    assert metadata["image.0.data"] == png()
    taken, parts = size_with_parts(str(tmp_path / "a.obj"), metadata)
    assert {path.rpartition("/")[2] for path in parts} == {"a.mtl", "red.png"}
    assert taken == sum((tmp_path / part).stat().st_size for part in ("a.obj", "a.mtl", "red.png"))


def test_what_lies_beside_is_called_like_the_file(tmp_path):
    hostile = {
        "image.0.name": "../../evil.png",
        "image.0.data": png(),
        "material.0.name": "a\nusemtl b",
        "mtllib": "/x",
    }
    mesh = tetrahedron()
    mesh = TriangleMesh(
        mesh.positions,
        mesh.faces,
        (),
        {**hostile, "material.0.map_Kd": 0, "material.7.Kd": "1\nnewmtl q"},
    )
    assert set(written_mesh(mesh, "obj", tmp_path / "c.obj").beside) == {"c.mtl", "c.0.png"}
    bsm.save(mesh, tmp_path / "c.obj")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["c.0.png", "c.mtl", "c.obj"]
    assert "newmtl q" not in (tmp_path / "c.mtl").read_text().splitlines()
    (tmp_path / "d.0.png").write_bytes(b"mine")
    with pytest.raises(FileExistsError):
        bsm.save(mesh, tmp_path / "d.obj", overwrite=False)
    assert (tmp_path / "d.0.png").read_bytes() == b"mine" and not (tmp_path / "d.obj").exists()


numbers = st.sampled_from(
    ["uint8", "int8", "uint16", "int16", "uint32", "int32", "float32", "float64"]
)
names = st.text(st.characters(codec="utf-8", exclude_characters="\0"), min_size=1, max_size=20)


@st.composite
def meshes(draw):
    mesh = torus(4, 3)
    sizes = {"vertex": len(mesh.positions), "face": len(mesh.faces), "corner": 3 * len(mesh.faces)}
    found = []
    for name in draw(st.lists(names, max_size=4, unique=True)):
        domain, kind = draw(st.sampled_from(list(sizes))), draw(numbers)
        random = np.random.default_rng(draw(st.integers(0, 9)))
        shape = (sizes[domain], draw(st.integers(1, 4)))
        values = random.integers(0, 100, shape).astype(kind)
        semantic = draw(st.sampled_from(["generic", "color", "normal", "texcoord"]))
        found.append(Attribute(name, values, domain, semantic))
    value = st.text(max_size=9) | st.integers(-9, 9) | st.floats(-9, 9) | st.binary(max_size=9)
    return TriangleMesh(
        mesh.positions, mesh.faces, found, draw(st.dictionaries(names, value, max_size=3))
    )


@settings(max_examples=60, suppress_health_check=[HealthCheck.too_slow])
@given(mesh=meshes(), kind=st.sampled_from(MESH_FORMATS))
def test_whatever_is_written_is_read(mesh, kind):
    written = written_mesh(mesh, kind, "a")
    again = read_mesh(written.data, kind).mesh
    assert len(again.faces) == len(mesh.faces)
    lost = {name.removeprefix("alpha of ") for name in written.left_out}
    assert lost <= {a.name for a in mesh.attributes} | set(mesh.metadata)
    if kind == "npz":
        assert {a.name for a in again.attributes} == {a.name for a in mesh.attributes}
    if kind == "ply":
        values = [at_corners(mesh, a).astype(float).sum() for a in mesh.attributes]
        assert sum(
            at_corners(again, a).astype(float).sum() for a in again.attributes
        ) == pytest.approx(sum(values))


GLTF_WORDS = "baseColorFactor baseColorTexture metallicFactor doubleSided"
words = st.sampled_from(f"name Kd d map_Kd map_Kd.options {GLTF_WORDS}".split())
things = (
    st.sampled_from(["", "1 0 0", "1 1 1 x", "nan", "-s 1", "\n", "\ud800"])
    | st.integers(-1, 3)
    | st.floats()
)


@settings(max_examples=60)
@example(statements={(0, "Kd"): float("inf")}, images={}, kind="glb")
@example(statements={(0, "name"): "\ud800"}, images={}, kind="3mf")
@given(
    statements=st.dictionaries(st.tuples(st.integers(0, 2), words), things, max_size=5),
    images=st.dictionaries(
        st.integers(0, 2), st.sampled_from([b"", b"x", png(), png()[:20]]), max_size=2
    ),
    kind=st.sampled_from(WRITTEN_FORMATS),
)
def test_materials_of_any_kind_are_written_or_left_out(statements, images, kind):
    if kind == "glb":
        pytest.importorskip("trimesh")
        pytest.importorskip("PIL")
    pytest.importorskip({"3mf": "lib3mf"}.get(kind, "bsm"))
    metadata = {f"material.{number}.{word}": value for (number, word), value in statements.items()}
    metadata |= {f"image.{number}.data": data for number, data in images.items()}
    mesh = tetrahedron()
    uv = Attribute("texcoord", np.zeros((4, 2), np.float32), semantic="texcoord")
    faces = Attribute("material", np.arange(4) % 3, "face")
    written = written_mesh(
        TriangleMesh(mesh.positions, mesh.faces, [uv, faces], metadata), kind, "a"
    )
    assert len(read_mesh(written.data, kind).mesh.faces) == 4


# -------------------------------------------------------------------------------------------------------- real meshes


@pytest.mark.real
@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("spot_uv.obj", {"texcoord": 3225}),
        ("fuze_colours.ply", {"color": 502, "face_color": 1000, "texcoord": 3000}),
        ("cortex_sulc.ply", {"sulc": 32492}),
        ("robot_hand.obj", {"normal": 10542}),
        ("stirrer.obj", {"normal": 10658, "object": 20736}),
    ],
)
def test_real_files(meshes, name, expected, tmp_path):
    source = read_mesh(meshes / "assets" / name)
    assert source.dropped == ()
    assert {a.name: len(a.values) for a in source.mesh.attributes} == expected
    for kind in ("ply", "obj"):
        bsm.save(source.mesh, tmp_path / f"a.{kind}")
        again = read_mesh(tmp_path / f"a.{kind}").mesh
        # OBJ has no alpha, no colors of faces and no other values.
        kept = [n for n in expected if kind == "ply" or n not in ("face_color", "sulc")]
        kept = [n for n in kept if kind == "ply" or attribute(source.mesh, n).components < 4]
        assert_same(source.mesh, again, kept)


@pytest.mark.real
@pytest.mark.parametrize(
    ("name", "vertices", "attributes", "dropped"),
    [
        ("Duck.glb", 2399, ["normal", "texcoord"], ("cameras",)),
        ("BoxTextured.glb", 24, ["normal", "texcoord"], ()),
        ("cubevc.glb", 54, ["normal", "texcoord", "color"], ("TANGENT of attributes",)),
        ("monkey.glb", 1966, ["normal", "texcoord"], ()),
    ],
)
def test_real_scenes(meshes, name, vertices, attributes, dropped, tmp_path):
    pytest.importorskip("trimesh")
    source = read_mesh(meshes / "assets" / name)
    assert len(source.mesh.positions) == vertices and source.dropped == dropped
    assert [a.name for a in source.mesh.attributes] == attributes
    assert (source.mesh.metadata["up"], source.mesh.metadata["unit"]) == ("y", "meters")
    bsm.save(source.mesh, tmp_path / "a.glb")
    again = read_mesh(tmp_path / "a.glb").mesh
    assert_same(source.mesh, again, attributes, 3e-7)  # trimesh makes normals of length one again
    assert again.metadata == source.mesh.metadata
    data = (meshes / "assets" / name).read_bytes()
    assert all(value in data for value in again.metadata.values() if isinstance(value, bytes))
