"""What a file says comes back, or a note names what does not: names, groups, polygons, headers, and other libraries."""

import gzip
import struct
import warnings

import numpy as np
import pytest

import bsm
from bsm import (
    Attribute,
    BsmWarning,
    FormatError,
    LimitError,
    Limits,
    MeshError,
    TriangleMesh,
    TruncatedError,
    read_mesh,
)
from bsm.files.formats.metadata import images_in, materials_in
from bsm.files.formats.polygons import Column, Polygons, meaning_of
from bsm.files.libraries import as_mesh
from tests.bsm.files.test_file_attributes import attribute, png
from tests.bsm.program import bsm as program
from tests.motion import sequence_in
from tests.shapes import at_corners, boxes, file_of, ply_head, torus
from tools.attack.readers import chained_objects, three_mf


def run(*arguments):
    return program(*arguments, text=True)


THREE = "v 0 0 0\nv 1 0 0\nv 1 1 0\n"
SQUARE = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])


def area(mesh):
    a, b, c = (mesh.positions[mesh.faces[:, corner]] for corner in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2


def names(mesh, what):
    return [
        value
        for key, value in mesh.metadata.items()
        if key.startswith(f"{what}.") and key.endswith(".name")
    ]


# ---------------------------------------------------------------------------------------------------------- OBJ and MTL


def test_a_number_sign_begins_a_comment_at_the_start_of_a_line_and_after_numbers(tmp_path):
    (tmp_path / "a.mtl").write_text(
        "newmtl M #1\nKd 1 0 0 # red\n # map_Kd no.png\nmap_Kd h#1.png\nnewmtl M #2\n"
    )
    (tmp_path / "h#1.png").write_bytes(png())
    (tmp_path / "a.obj").write_text(
        f"  # f 9 9 9\nmtllib a.mtl\n{THREE}v 0 0 1 # top\ng left #1\nusemtl M #1\nf 1 2 3 # 1\nusemtl M #2\nf 1 2 4\n"
    )
    read = read_mesh(tmp_path / "a.obj")
    assert read.notes == ("left out: comments amid the data (2)",)
    assert read.mesh.faces.tolist() == [[0, 1, 2], [0, 1, 3]]
    assert names(read.mesh, "material") == ["M #1", "M #2"] and names(read.mesh, "group") == [
        "left #1"
    ]
    assert materials_in(read.mesh.metadata)[0] == {"name": "M #1", "Kd": "1 0 0", "map_Kd": 0}
    assert images_in(read.mesh.metadata) == {0: ("h#1.png", png())}


def test_continued_lines_marks_of_encodings_and_options_of_images(tmp_path):
    text = "newmtl A\nKd 1 \\\n0 0\nNewmtl B\nKd 0 1 0\nmap_Kd -type sphere -s 1 1 1 a b.png\n"
    (tmp_path / "a b.png").write_bytes(png())
    path = f"# of C:\\models\\\nmtllib a.mtl\n{THREE}usemtl A\nf 1 \\\n2 3\nusemtl B\nf 1 3 2\n#MRGB ffffffff\n"
    (tmp_path / "a.obj").write_text(path)
    for encoding in ("utf-8", "utf-8-sig", "utf-16"):
        (tmp_path / "a.mtl").write_bytes(text.encode(encoding))
        read = read_mesh(tmp_path / "a.obj")
        assert (
            read.notes == ("left out: colors in comments (#MRGB)",)
            and len(read.mesh.positions) == 3
        )
        of_a, of_b = materials_in(read.mesh.metadata).values()
        assert (
            of_a["Kd"].split() == ["1", "0", "0"]
            and of_b["map_Kd.options"] == "-type sphere -s 1 1 1"
        )
        assert images_in(read.mesh.metadata) == {0: ("a b.png", png())}


def test_several_libraries_of_several_lines_and_with_spaces(tmp_path):
    (tmp_path / "a b.mtl").write_text("newmtl A\nKd 1 0 0\nmap_Kd one.png\n")
    (tmp_path / "c.mtl").write_text("newmtl A\nKd 0 0 0\nnewmtl C\nKd\t0 1 0\nmap_Kd\ttwo.png\n")
    (tmp_path / "d.mtl").write_text("newmtl\tD\nKd 0 0 1\n")
    for name in ("one.png", "two.png"):
        (tmp_path / name).write_bytes(png())
    faces = "".join(f"usemtl\t{name}\nf 1 2 3\n" for name in "ACD")
    (tmp_path / "a.obj").write_text(
        f"mtllib a b.mtl\nmtllib c.mtl\td.mtl\nmtllib away.mtl\n{THREE}{faces}"
    )
    read = read_mesh(tmp_path / "a.obj")
    words = materials_in(read.mesh.metadata).values()
    assert [(m["name"], m["Kd"]) for m in words] == [("A", "1 0 0"), ("C", "0 1 0"), ("D", "0 0 1")]
    images = images_in(read.mesh.metadata)
    assert [images[m["map_Kd"]][0] for m in words if "map_Kd" in m] == ["one.png", "two.png"]
    assert [note for note in read.notes if "materials" in note] == [
        "the materials in away.mtl were left out: no such file beside the mesh"
    ]


@pytest.mark.parametrize("encoding", ["utf-8", "latin-1", "gbk", "cp1251"])
def test_names_in_any_encoding_stay_different(encoding, tmp_path):
    called = {"gbk": ("\u7ea2", "\u7eff"), "cp1251": ("\u0436", "\u0437")}.get(
        encoding, ("Gr\u00fcn", "Gr\u00e4n")
    )
    (tmp_path / "a.mtl").write_bytes(
        "".join(f"newmtl {name}\nKd {i} 0 0\n" for i, name in enumerate(called)).encode(encoding)
    )
    faces = "".join(f"g {name}\nusemtl {name}\nf 1 2 3\n" for name in called)
    (tmp_path / "a.obj").write_bytes(f"mtllib a.mtl\n{THREE}{faces}".encode(encoding))
    mesh = read_mesh(tmp_path / "a.obj").mesh
    assert [m["Kd"] for m in materials_in(mesh.metadata).values()] == ["0 0 0", "1 0 0"]
    assert len(set(names(mesh, "group"))) == 2
    if encoding != "gbk" and encoding != "cp1251":
        assert tuple(names(mesh, "material")) == called


def test_materials_of_one_name_are_written_with_different_names(tmp_path):
    material = Attribute("material", np.array([0, 1, 2], np.int32), "face")
    metadata = {f"material.{i}.name": name for i, name in enumerate(("red", "red", "red_2"))}
    metadata |= {f"material.{i}.Kd": f"{i} 0 0" for i in range(3)}
    mesh = TriangleMesh(SQUARE, [[0, 1, 2], [0, 2, 3], [1, 2, 3]], [material], metadata)
    left = bsm.save(mesh, tmp_path / "a.obj")
    again = read_mesh(tmp_path / "a.obj").mesh
    assert [m["Kd"] for m in materials_in(again.metadata).values()] == ["0 0 0", "1 0 0", "2 0 0"]
    assert len(set(names(again, "material"))) == 3 and "name of materials red, red_2" in left


def test_two_hundred_materials_with_an_image_each_come_back(tmp_path):
    library, lines = "", ["mtllib a.mtl", THREE]
    for i in range(200):
        library += f"newmtl m{i}\nKd 0 {i / 200} 1\nNs {i}\nmap_Kd {i}.png\n"
        lines += [f"usemtl m{i}", "f 1 2 3"]
        (tmp_path / f"{i}.png").write_bytes(png() + bytes([i]))
    (tmp_path / "a.mtl").write_text(library)
    (tmp_path / "a.obj").write_text("\n".join(lines))
    read = read_mesh(tmp_path / "a.obj")
    data = bsm.encode(read.mesh, preset="grid14")
    decoded = bsm.decode(data, limits=Limits.service())
    assert read.notes == () and dict(decoded.metadata) == dict(read.mesh.metadata)
    assert bsm.save(decoded, tmp_path / "out.obj") == ()
    again = read_mesh(tmp_path / "out.obj").mesh
    assert [data for _, data in images_in(again.metadata).values()] == [
        png() + bytes([i]) for i in range(200)
    ]
    assert [m["Ns"] for m in materials_in(again.metadata).values()] == [str(i) for i in range(200)]


def test_one_image_under_many_names_is_read_once_and_large_images_stay(tmp_path):
    (tmp_path / "a.png").write_bytes(png() + bytes(5000))
    for i in range(20):
        (tmp_path / f"{i}.png").write_bytes(png() + bytes(5000))
    many = "".join(f"newmtl m{i}\nmap_Kd {'./' * i}a.png\nmap_Ke {i}.png\n" for i in range(20))
    (tmp_path / "a.mtl").write_text(many)
    (tmp_path / "a.obj").write_text(f"mtllib a.mtl\n{THREE}f 1 2 3\n")
    read = read_mesh(tmp_path / "a.obj", limits=Limits(metadata_bytes=10_000))
    assert all(data for _, data in images_in(read.mesh.metadata).values()) and read.notes == ()
    with pytest.raises(LimitError, match=r"over the limit of [\d,]+ for a section"):
        read_mesh(tmp_path / "a.obj", limits=Limits(frame_bytes=12_000))


def test_an_image_in_the_folder_of_a_library_is_found_there(tmp_path):
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "a.png").write_bytes(png())
    (tmp_path / "sub" / "a.mtl").write_text("newmtl m\nmap_Kd a.png\n")
    (tmp_path / "a.obj").write_text(f"mtllib sub/a.mtl\n{THREE}f 1 2 3\n")
    for path in (tmp_path / "a.obj", tmp_path / "a.obj.gz"):
        if path.suffix == ".gz":
            path.write_bytes(gzip.compress((tmp_path / "a.obj").read_bytes()))
        assert read_mesh(path).mesh.metadata["image.0.data"] == png()


FACET = (
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
)


@pytest.mark.parametrize(
    "text",
    [
        f"solid a\n{FACET}",
        f"solid a\n{FACET}end solid a\n",
        f"# by somebody\nsolid a\n{FACET}endsolid\n",
        f"solid a\n{FACET.replace('endfacet', 'end facet')}endsolid\n",
        f"solid a\n{FACET.replace(chr(10), ' ').rstrip()}\nendsolid\n",
        f"solid a\r\n{FACET.replace(chr(10), chr(13) + chr(10))}endsolid\r\n",
    ],
)
def test_text_of_an_stl_as_other_programs_write_it(text):
    mesh = read_mesh(text.encode(), "stl").mesh
    assert mesh.positions[mesh.faces].tolist() == [[[0, 0, 0], [1, 0, 0], [0, 1, 0]]]


@pytest.mark.parametrize(
    ("data", "kind"),
    [
        (b"<!DOCTYPE html><html><body>not found</body></html>" + b" " * 100, "an HTML page"),
        (b"# made by hand\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n" + b"# \n" * 30, "an OBJ"),
    ],
)
def test_another_kind_of_file_that_is_called_stl_is_named(data, kind):
    with pytest.raises(FormatError, match=kind):
        read_mesh(data, "stl")


def test_frames_whose_polygons_turn_concave_are_cut_as_the_first(tmp_path):
    corners = np.array([[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0]], float)
    for number, inward in enumerate((2.0, 1.5, 0.5)):
        corners[2] = inward, inward, 0
        lines = "".join(f"v {x} {y} {z}\n" for x, y, z in corners)
        (tmp_path / f"f_{number}.obj").write_text(f"{lines}f 2 3 4 1\n")
    frames = sequence_in(str(tmp_path))
    assert frames.count == 3 and len([*frames.frames]) == 3


def test_two_files_for_a_frame_and_two_series_are_errors_and_hidden_files_are_not_read(tmp_path):
    mesh = torus(5, 4)
    for name in ("f_0.obj", "f_1.obj"):
        bsm.save(mesh, tmp_path / name)
    (tmp_path / "._f_0.obj").write_bytes(b"\0\5\x16\7")
    assert sequence_in(str(tmp_path)).count == 2
    for name in ("g_0.obj", "g_1.obj"):
        bsm.save(mesh, tmp_path / name)
    with pytest.raises(MeshError, match="2 series of frames"):
        sequence_in(str(tmp_path))
    for name in ("g_0.obj", "g_1.obj"):
        (tmp_path / name).unlink()
    bsm.save(mesh, tmp_path / "f_0.ply")
    with pytest.raises(MeshError, match="two files for one frame"):
        sequence_in(str(tmp_path))


@pytest.mark.parametrize(
    ("names", "why"),
    [
        (("start", "middle", "end"), "nothing in their names tells it"),
        (("left/mesh", "right/mesh"), "nothing in their names tells it"),
        (("t.50", "t.75", "t1.00"), "a point ahead of the number"),
        (("a", "b", "c"), None),
    ],
)
def test_names_that_tell_no_order_are_refused(names, why, tmp_path):
    for name in names:
        (tmp_path / name).parent.mkdir(exist_ok=True)
        bsm.save(torus(5, 4), tmp_path / f"{name}.obj")
    pattern = str(tmp_path / ("*/*.obj" if "/" in names[0] else "*.obj"))
    if why is None:
        assert sequence_in(pattern).count == 3
    else:
        with pytest.raises(MeshError, match=why):
            sequence_in(pattern)


def test_numbers_and_lines_of_an_obj_that_mean_nothing_to_a_mesh_are_named():
    read = read_mesh(b"v 0 0 0 1 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\nbevel on\ncstype bezier\n")
    assert read.mesh.attributes == ()
    assert read.notes == (
        "left out: lines that begin with bevel, cstype, numbers after the coordinates (1 vertices have some)",
    )
    assert read_mesh(b"v 0 0 0 1.0\nv 1 0 0 1.0\nv 1 1 0 1.0\nf 1 2 3\n").notes == ()


# ------------------------------------------------------------------------------------------------------------- polygons


def comb(teeth):
    """A comb of `teeth` slots, 1 wide and 2 deep, in a plate 3 high; its area, too."""
    top = [
        point
        for i in range(teeth)
        for point in ((2 * i + 1, 3), (2 * i + 1, 1), (2 * i + 2, 1), (2 * i + 2, 3))
    ]
    width = 2 * teeth + 1
    outline = np.array([(0, 0), (0, 3), *top, (width, 3), (width, 0)], float)[::-1]
    return np.column_stack([outline, 0.3 * outline @ [1, 2]]), (3 * width - 2 * teeth) * np.sqrt(
        1 + 0.09 + 0.36
    )


@pytest.mark.parametrize(
    "turn", [np.eye(3), -np.eye(3), np.eye(3)[[1, 2, 0]], np.eye(3)[[2, 1, 0]]]
)
@pytest.mark.parametrize("teeth", [1, 2, 9])
def test_polygons_that_are_not_convex_are_cut_without_overlaps(teeth, turn):
    pytest.importorskip("mapbox_earcut")
    points, expected = comb(teeth)
    points = points @ turn
    polygon = np.arange(len(points))
    normal = sum(np.cross(points[i], points[(i + 1) % len(points)]) for i in range(len(points)))
    flat = np.concatenate([[len(points)], polygon])
    text = (
        "".join(f"v {x} {y} {z}\n" for x, y, z in points.tolist())
        + f"f {' '.join(map(str, polygon + 1))}\n"
    )
    meshes = [as_mesh((points, faces)) for faces in (polygon[None], [polygon], flat)]
    for mesh in (*meshes, read_mesh(text.encode()).mesh):
        assert len(mesh.faces) == len(points) - 2 and area(mesh) == pytest.approx(expected)
        a, b, c = (mesh.positions[mesh.faces[:, corner]] for corner in range(3))
        assert (np.cross(b - a, c - a) @ normal >= -1e-9).all(), "all triangles face the same side"


def test_a_corner_on_a_side_of_a_polygon_stays_connected():
    pytest.importorskip("mapbox_earcut")
    outline = [
        (0, 0),
        (2, 0),
        (4, 0),
        (4, 3),
        (3, 3),
        (3, 1),
        (2, 1),
        (1, 1),
        (1, 3),
        (0, 3),
        (0, 2),
        (0, 1),
    ]
    points = np.column_stack([np.array(outline, float), np.zeros(len(outline))])
    mesh = as_mesh((points, np.arange(len(points))[None]))
    sides = {
        tuple(side)
        for face in mesh.faces
        for side in zip(face.tolist(), np.roll(face, -1).tolist())
    }
    open_sides = {side for side in sides if side[::-1] not in sides}
    assert open_sides == {(i, (i + 1) % 12) for i in range(12)} and area(mesh) == pytest.approx(8)


def test_a_polygon_whose_sides_cross_is_reported_and_a_huge_one_refused():
    pytest.importorskip("mapbox_earcut")
    with pytest.warns(BsmWarning, match="polygons whose sides cross"):
        turns = np.arange(5) * 4 * np.pi / 5 + 0.1
        as_mesh(
            (np.column_stack([np.cos(turns), np.sin(turns), turns]) * [1, 1, 0], [[0, 1, 2, 3, 4]])
        )
    points, _ = comb(9000)
    with pytest.raises(MeshError, match="cut it into triangles"):
        as_mesh((points, np.arange(len(points))[None]))


# ------------------------------------------------------------------------------------------------------------------ PLY


def seamed(*more):
    mesh = torus(8, 6)
    uv = np.tile(np.linspace(0, 1, 2 * len(mesh.positions), dtype=np.float32)[:, None], (1, 2))
    seam = mesh.faces + np.where(np.arange(len(mesh.faces)) % 2, len(mesh.positions), 0)[:, None]
    smooth = Attribute(
        "smooth", np.arange(len(mesh.positions), dtype=np.float32), "corner", indices=mesh.faces
    )
    return TriangleMesh(
        mesh.positions,
        mesh.faces,
        [Attribute("texcoord", uv, "corner", "texcoord", seam), smooth, *more],
    )


def test_a_ply_with_seams_keeps_its_vertices(tmp_path):
    mesh = seamed(
        Attribute(
            "paint", np.arange(36 * 8, dtype=np.uint8)[:, None].repeat(3, 1), "corner", "generic"
        )
    )
    again = read_mesh(file_of(mesh, "ply")).mesh
    assert again.positions[: len(mesh.positions)] == pytest.approx(mesh.positions)
    assert again.positions[again.faces] == pytest.approx(mesh.positions[mesh.faces])
    for name in ("texcoord", "paint", "smooth"):
        assert attribute(again, name).domain == "vertex"
        assert np.array_equal(
            at_corners(again, attribute(again, name)), at_corners(mesh, attribute(mesh, name))
        )
    bsm.save(seamed(), tmp_path / "a.bsm", preset="grid14", keep_order=True)
    done = run("decode", tmp_path / "a.bsm", "-o", tmp_path / "b.ply")
    assert done.returncode == 0, done.stderr
    decoded, back = bsm.load(tmp_path / "a.bsm"), read_mesh(tmp_path / "b.ply").mesh
    assert back.positions[: len(mesh.positions)] == pytest.approx(decoded.positions)
    first = back.faces < len(mesh.positions)
    assert np.array_equal(back.faces[first], mesh.faces[first]) and not first.all()


def test_other_programs_read_the_seams_of_a_ply(tmp_path):
    trimesh = pytest.importorskip("trimesh")
    mesh = seamed()
    bsm.save(mesh, tmp_path / "a.ply")
    theirs = trimesh.load_mesh(tmp_path / "a.ply", process=False)
    assert theirs.triangles == pytest.approx(mesh.positions[mesh.faces])
    assert theirs.visual.uv[theirs.faces] == pytest.approx(
        at_corners(mesh, attribute(mesh, "texcoord"))
    )


def test_a_ply_with_whole_numbers_of_64_bits_and_lists_of_vertices():
    more = "property list uchar float weights\nproperty int64 id\n"
    head = ply_head(order="binary_little_endian", more=more, corners="uchar uint64")
    points = [(0, 0, 0), (1, 0, 0), (1, 1, 0)]
    body = b"".join(
        struct.pack("<3fB", *p, i) + bytes(4 * i) + struct.pack("<q", -i)
        for i, p in enumerate(points)
    )
    read = read_mesh(head.encode() + body + struct.pack("<B3Q", 3, 0, 1, 2))
    assert read.mesh.faces.tolist() == [[0, 1, 2]] and attribute(read.mesh, "id").values[
        :, 0
    ].tolist() == [0, -1, -2]
    assert read.notes == ("left out: the list weights of vertices",)
    text = (
        head.replace("binary_little_endian", "ascii")
        + "0 0 0 0 0\n1 0 0 1 9 -1\n1 1 0 2 9 9 -2\n3 0 1 2\n"
    )
    assert attribute(read_mesh(text.encode()).mesh, "id").values[:, 0].tolist() == [0, -1, -2]


@pytest.mark.parametrize(
    "ends", [("\n", "\n"), ("\r\n", "\r\n"), ("\r", "\r"), ("\n", "\r\n"), ("\r\n", "\n")]
)
@pytest.mark.parametrize("comment", ["short", "c" * 70_000])
def test_line_ends_and_lengths_of_ply_headers(ends, comment):
    data = file_of(torus(5, 4), "ply")
    head, body = data.split(b"end_header\n")
    lines = head.decode().splitlines()
    lines.insert(2, f"comment {comment}")
    mixed = "".join(line + ends[i % 2] for i, line in enumerate([*lines, "end_header"])).encode()
    for first in (b"", b"\n"):  # of the body
        whole = mixed + (first + body[1:] if first else body)
        read = read_mesh(whole)
        assert read.mesh.faces.tolist() == torus(5, 4).faces.tolist()


# ---------------------------------------------------------------------------------------------------------- STL and OFF


def solid(name, moved, word="solid"):
    loop = "".join(f"vertex {x + moved} {y} 0\n" for x, y in ((0, 0), (1, 0), (1, 1)))
    return f"{word} {name}\nfacet normal 0 0 1\nouter loop\n{loop}endloop\nendfacet\nend{word} {name}\n"


def test_solids_of_a_text_are_groups(tmp_path):
    text = solid("Inlet A", 0) + solid("wall #2", 5) + solid("Inlet A", 9)
    (tmp_path / "a.stl").write_text(text)
    mesh = read_mesh(tmp_path / "a.stl").mesh
    assert names(mesh, "group") == ["Inlet A", "wall #2", "Inlet A"]
    assert attribute(mesh, "group").values[:, 0].tolist() == [0, 1, 2]
    bsm.save(mesh, tmp_path / "b.obj")
    assert names(read_mesh(tmp_path / "b.obj").mesh, "group") == ["Inlet A", "wall #2", "Inlet A_2"]
    for other in (
        b"\xef\xbb\xbf" + text.encode(),
        text.encode("utf-16"),
        text.replace("\n", "\r").encode(),
    ):
        assert names(read_mesh(other, "stl").mesh, "group") == ["Inlet A", "wall #2", "Inlet A"]
    bare = read_mesh((solid("", 0) + solid("", 5)).encode(), "stl").mesh
    assert attribute(bare, "group").values[:, 0].tolist() == [0, 1] and not names(bare, "group")
    assert read_mesh(solid("one", 0, "SOLID").upper().encode(), "stl").mesh.faces.tolist() == [
        [0, 1, 2]
    ]
    bsm.save(mesh, tmp_path / "a.bsm", preset="grid14")
    done = run("decode", tmp_path / "a.bsm", "-o", tmp_path / "c.stl")
    assert done.returncode == 0 and "group" in done.stderr, "an STL that we write has no groups"


def binary(head, count, triangles, tail=b""):
    corners = np.random.default_rng(1).random((triangles, 3, 3)).astype("<f4")
    records = b"".join(bytes(12) + triangle.tobytes() + b"\0\0" for triangle in corners)
    return head.ljust(80, b" ") + struct.pack("<I", count) + records + tail


@pytest.mark.parametrize(
    ("data", "faces", "note"),
    [
        (binary(b"solid", 12, 12), 12, ""),
        (binary(b"SOLID of bytes", 12, 12), 12, ""),
        (binary(b"x", 0, 12), 12, "in the header (0; by its size, the file has 12)"),
        (binary(b"x", 6, 12), 12, "in the header (6; by its size, the file has 12)"),
        (
            binary(b"x", 0xFFFFFFFF, 12),
            12,
            "in the header (4294967295; by its size, the file has 12)",
        ),
        (binary(b"solid", 12, 12, b"more"), 12, "4 bytes after the last triangle"),
    ],
)
def test_the_size_of_a_binary_stl_decides(data, faces, note, tmp_path):
    read = read_mesh(data, "stl")
    assert len(read.mesh.faces) == faces and any(note in line for line in read.notes)
    assert len(read.notes) == 1 + bool(note)
    (tmp_path / "a.stl").write_bytes(data)
    assert len(read_mesh(tmp_path / "a.stl").mesh.faces) == faces
    done = run("tile", tmp_path / "a.stl", "-o", tmp_path / "tiles", "--grid-cell", 0.001)
    assert done.returncode == 0 and note in done.stderr, done.stderr


def test_an_stl_that_is_cut_short_is_refused():
    for data in (binary(b"x", 12, 12)[:-1], binary(b"x", 12, 11)):
        with pytest.raises(TruncatedError, match="it has 11 of 12 triangles"):
            read_mesh(data, "stl")
    with pytest.raises((TruncatedError, FormatError, LimitError)):
        read_mesh(b"SOLID of something else " + b"\1" * 100, "stl")


def test_an_off_as_meshlab_writes_it_has_colors_before_normals():
    row = "{} {} 0 255 128 0 255 0 0 1"
    rows = "\n".join(row.format(x, y) for x, y in ((0, 0), (1, 0), (1, 1)))
    mesh = read_mesh(f"NCOFF\n3 1 0\n{rows}\n3 0 1 2\n".encode()).mesh
    assert attribute(mesh, "normal").values.tolist() == [[0, 0, 1]] * 3
    assert attribute(mesh, "color").values.tolist() == [[255, 128, 0, 255]] * 3


# ----------------------------------------------------------------------------------------------------- other libraries


def notes_of(mesh):
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        bsm.encode(mesh, preset="grid14")
    return " | ".join(str(warning.message) for warning in caught if warning.category is BsmWarning)


def test_what_meshio_has_and_a_mesh_cannot_have_is_a_warning():
    meshio = pytest.importorskip("meshio")
    theirs = meshio.Mesh(
        SQUARE,
        [("triangle", [[0, 1, 2], [0, 2, 3]]), ("line", [[0, 1]])],
        point_data={
            "wide": np.ones((4, 9)),
            "gaps": np.array([0, np.nan, 1, 2]),
            "words": np.array(["a"] * 4),
        },
        cell_data={"tensor": [np.ones((2, 3, 3)), np.ones((1, 3, 3))]},
        point_sets={"fixed": np.array([0])},
        cell_sets={"inlet": [np.array([0]), np.array([])]},
        field_data={"gmsh name": np.array([1, 2])},
    )
    told = notes_of(theirs)
    for name in (
        "values of gaps that are not numbers (1); gaps.none marks them",
        "words",
        "line",
        "fixed",
        "inlet",
    ):
        assert name in told, told
    assert "gmsh name" in told


def test_what_trimesh_has_and_a_mesh_cannot_have_is_a_warning():
    trimesh = pytest.importorskip("trimesh")
    wide = {"wide": np.ones((4, 33))}
    theirs = trimesh.Trimesh(
        SQUARE,
        [[0, 1, 2], [0, 2, 3]],
        vertex_attributes=wide,
        metadata={"list": [1]},
        process=False,
    )
    for given in (theirs, trimesh.Scene({"a": theirs})):
        assert "wide" in notes_of(given) and "metadata list" in notes_of(given)


def test_what_pyvista_has_and_a_mesh_cannot_have_is_a_warning():
    pyvista = pytest.importorskip("pyvista")
    theirs = pyvista.PolyData(SQUARE, [3, 0, 1, 2, 3, 0, 2, 3])
    theirs.point_data["words"] = ["a", "b", "c", "d"]
    theirs.field_data["series"] = np.arange(3.0)
    theirs.point_data["wide"] = np.ones((4, 33))
    told = notes_of(theirs)
    assert all(name in told for name in ("words", "field data series", "wide")), told
    with pytest.raises(MeshError, match=r"extract_surface\(\)"):
        bsm.encode(theirs.cast_to_unstructured_grid())


def test_textures_of_open3d_are_a_warning():
    class Open3D:
        """As `open3d.geometry.TriangleMesh` has it."""

        vertices, triangles = SQUARE, np.array([[0, 1, 2], [0, 2, 3]])
        vertex_normals = vertex_colors = triangle_uvs = triangle_material_ids = np.zeros((0, 3))
        textures = (np.zeros((2, 2, 3), np.uint8),)

    assert "left out: textures" in notes_of(Open3D())


def test_tiles_name_what_an_obj_or_an_stl_has_and_read_lines_that_go_on(tmp_path):
    (tmp_path / "a.obj").write_text(
        f"{THREE}v 0 1 \\\n 0\ng one\nf 1 2 3\ng two\nf 1 \\\n3 4\nl 1 2\n"
    )
    done = run("tile", tmp_path / "a.obj", "-o", tmp_path / "tiles", "--grid-cell", 0.001)
    assert done.returncode == 0 and "left out: group, lines" in done.stderr, done.stderr
    data = bytearray(binary(b"x", 2, 2))
    data[84 + 48] = 7
    (tmp_path / "a.stl").write_bytes(data)
    done = run("tile", tmp_path / "a.stl", "-o", tmp_path / "more", "--grid-cell", 0.001)
    assert done.returncode == 0 and "left out: attribute" in done.stderr, done.stderr


# --------------------------------------------------------------------------------------------- promises about numbers


def test_lossless_refuses_what_single_precision_would_move_and_the_way_out_works(tmp_path):
    near = torus(20, 12)
    far = TriangleMesh(100 * near.positions + [500_000.123, 4_400_000.456, 20], near.faces)
    bsm.save(far, tmp_path / "a.ply")
    done = run("encode", tmp_path / "a.ply", "-o", tmp_path / "a.bsm", "--preset", "lossless")
    assert (
        done.returncode == 10
        and not (tmp_path / "a.bsm").exists()
        and "moves a vertex by 0.2" in done.stderr
    )
    way = done.stderr.split("in place of the preset, give ")[1].split()[:3]
    done = run("encode", tmp_path / "a.ply", "-o", tmp_path / "a.bsm", "--keep-order", *way)
    assert done.returncode == 0, done.stderr
    assert (
        np.abs(bsm.load(tmp_path / "a.bsm").positions - far.positions).max()
        <= float(way[1]) / 2 + 1e-9
    )
    grid = TriangleMesh(np.round(near.positions / 0.05) * 0.05 + 70_000, near.faces)
    with pytest.raises(bsm.TargetError, match="grid-origin"):
        bsm.encode(grid, preset="lossless")
    encoder = bsm.Encoder(TriangleMesh(near.positions, near.faces), bsm.EncodeOptions(exact=True))
    assert any("rounded to single precision, by" in note for note in encoder.notes)


@pytest.mark.parametrize(
    ("more", "lost"),
    [
        ("l 1 2\n", "lines"),
        ("f 1 2\n", "corners"),
        (f'# meta story: "{"x" * (9 << 20)}"\n', "story"),
    ],
)
def test_lossless_drops_nothing_unless_it_is_told_to(tmp_path, more, lost):
    file, stream = tmp_path / "a.obj", tmp_path / "a.bsm"
    file.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n" + more)
    done = run("encode", file, "-o", stream, "--preset", "lossless")
    assert (
        done.returncode == 11
        and lost in done.stderr
        and "--force" in done.stderr
        and not stream.exists()
    )
    done = run("encode", file, "-o", stream, "--preset", "lossless", "--force")
    assert (
        done.returncode == 0
        and stream.exists()
        and f"left out: {lost}" in done.stderr.replace("faces with fewer than three ", "")
    )
    assert run("encode", file, "-o", stream, "--force").returncode == 0


def test_floats_that_are_labels_stay_exact():
    mesh = torus(20, 12)
    rows = len(mesh.positions)
    values = {
        "label": np.arange(rows) * 7 // rows,
        "id": np.random.default_rng(1).permutation(rows) * 37.0,
    }
    values["height"] = mesh.positions[:, 2]
    attributes = [Attribute(name, column.astype(np.float32)) for name, column in values.items()]
    labeled = TriangleMesh(mesh.positions, mesh.faces, attributes)
    decoded = bsm.decode(bsm.encode(labeled, keep_order=True))
    for name in ("label", "id"):
        assert np.array_equal(attribute(decoded, name).values, attribute(labeled, name).values)
    assert not np.array_equal(
        attribute(decoded, "height").values, attribute(labeled, "height").values
    )


# ---------------------------------------------------------------------------------------------------------- 3MF and DAE


GEOMETRY = """<geometry id="g"><mesh><source id="p"><float_array id="a" count="9">0 0 0 1 0 0 1 1 0</float_array>
<technique_common><accessor source="#a" count="3" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION"
source="#p"/></vertices><triangles count="1" material="m"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p>
</triangles></mesh></geometry>"""


def collada(nodes, scene, more=""):
    return (
        '<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset/>'
        f"<library_geometries>{GEOMETRY}</library_geometries><library_nodes>{nodes}</library_nodes>{more}"
        f'<library_visual_scenes><visual_scene id="s">{scene}</visual_scene></library_visual_scenes>'
        '<scene><instance_visual_scene url="#s"/></scene></COLLADA>'
    ).encode()


SHOWN = '<instance_geometry url="#g"/>'


def chained(length):
    """Nodes, each of which shows the one before twice."""
    first = f'<node id="n0">{SHOWN}</node>'
    twice = ('<instance_node url="#n{0}"/>' * 2).format
    return first + "".join(f'<node id="n{i}">{twice(i - 1)}</node>' for i in range(1, length + 1))


def test_nodes_of_a_dae_may_show_others_but_not_themselves(tmp_path):
    pytest.importorskip("collada")
    path = tmp_path / "a.dae"
    path.write_bytes(collada(chained(3), '<node id="x"><instance_node url="#n3"/></node>'))
    assert len(read_mesh(path).mesh.faces) == 8
    path.write_bytes(
        collada(
            '<node id="l"><instance_node url="#l"/></node>',
            '<node><instance_node url="#l"/></node>',
        )
    )
    with pytest.raises(FormatError, match="Node #l not found"):
        read_mesh(path)


def test_a_dae_names_what_is_left_out_and_its_images_come_from_its_folder(tmp_path):
    pytest.importorskip("collada")
    material = '<instance_material symbol="m" target="#away"/>'
    binding = f"<bind_material><technique_common>{material}</technique_common></bind_material>"
    broken = f'<instance_geometry url="#g">{binding}</instance_geometry>'
    (tmp_path / "a.dae").write_bytes(
        collada("", f'<node id="x">{SHOWN}</node><node id="y">{broken}</node>')
    )
    read = read_mesh(tmp_path / "a.dae")
    assert len(read.mesh.faces) == 1
    assert any("(Material #away not found)" in note for note in read.notes), read.notes


def drawn_dae(drawn, effect="", points=""):
    """A DAE whose geometry draws other elements, over other points and with an effect."""
    bound = SHOWN.replace(
        "/>", "><bind_material><technique_common><instance_material symbol='m' target='#mm'/>"
    )
    bound += "</technique_common></bind_material></instance_geometry>" if effect else ""
    used = f'<library_effects><effect id="e"><profile_COMMON><technique sid="c"><phong>{effect}</phong></technique>'
    used += '</profile_COMMON></effect></library_effects><library_materials><material id="mm" name="glass">'
    used += '<instance_effect url="#e"/></material></library_materials>'
    text = collada(
        "", f'<node id="x">{bound if effect else SHOWN}</node>', used if effect else ""
    ).decode()
    if points:
        count = len(points.split())
        text = text.replace("0 0 0 1 0 0 1 1 0", points).replace('count="9"', f'count="{count}"')
        text = text.replace('count="3" stride', f'count="{count // 3}" stride')
    before, _, after = text.partition("<triangles")
    return f"{before}{drawn}</mesh></geometry>{after.partition('</geometry>')[2]}".encode()


OF_POINTS = '<input semantic="VERTEX" source="#v" offset="0"/>'
GRID = " ".join(f"{x} {y} 0" for y in range(5) for x in range(5))
OUTER, INNER = "0 4 24 20", ["6 11 12 7", "13 18 17"]


@pytest.mark.parametrize(("kind", "more"), [("polylist", "<vcount>8</vcount>"), ("polygons", "")])
def test_polygons_of_a_dae_that_are_not_convex_are_cut_without_overlaps(kind, more):
    pytest.importorskip("collada")
    points = "0 0 0 3 0 0 3 3 0 2 3 0 2 1 0 1 1 0 1 3 0 0 3 0"
    drawn = f'<{kind} count="1">{OF_POINTS}{more}<p>0 1 2 3 4 5 6 7</p></{kind}>'
    read = read_mesh(drawn_dae(drawn, points=points), "dae")
    assert (
        area(read.mesh) == pytest.approx(7) and "polygons were cut into triangles: 1" in read.notes
    )


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("holes", [0, 1, 2])
def test_polygons_of_a_dae_are_cut_with_their_holes(holes, turned):
    pytest.importorskip("collada")
    pytest.importorskip("mapbox_earcut")
    outer = " ".join(OUTER.split()[::-1]) if turned else OUTER
    held = "".join(f"<h>{ring}</h>" for ring in INNER[:holes])
    drawn = f'<polygons count="3">{OF_POINTS}<ph><p>{outer}</p>{held}</ph><p>0 1 5</p><ph><p>1 6 5</p></ph></polygons>'
    read = read_mesh(drawn_dae(drawn, points=GRID), "dae")
    assert area(read.mesh) == pytest.approx(16 - [0, 1, 1.5][holes] + 1) and read.dropped == ()
    a, b, c = (read.mesh.positions[read.mesh.faces[:-2, corner]] for corner in range(3))
    assert ((np.cross(b - a, c - a)[:, 2] < 0) == turned).all(), (
        "faces look to the side of their polygon"
    )


def test_values_at_corners_of_holes_stay_theirs():
    pytest.importorskip("collada")
    pytest.importorskip("mapbox_earcut")
    inputs = OF_POINTS + '<input semantic="TEXCOORD" source="#t" offset="1"/>'
    values = "".join(f'<param name="{name}" type="float"/>' for name in "STP")
    source = (
        f'<source id="t"><float_array id="ta" count="75">{GRID}</float_array><technique_common>'
    )
    source += f'<accessor source="#ta" count="25" stride="3">{values}</accessor></technique_common></source>'
    rings = [
        " ".join(f"{corner} {corner}" for corner in ring.split()) for ring in (OUTER, INNER[0])
    ]
    drawn = f'{source}<polygons count="1">{inputs}<ph><p>{rings[0]}</p><h>{rings[1]}</h></ph></polygons>'
    mesh = read_mesh(drawn_dae(drawn, points=GRID), "dae").mesh
    assert (
        len(mesh.faces) == 8
        and (
            at_corners(mesh, attribute(mesh, "texcoord")) == mesh.positions[mesh.faces][..., :2]
        ).all()
    )


EMPTY = [
    f'<{kind} count="0">{OF_POINTS}{p}</{kind}>'
    for kind in ("triangles", "lines")
    for p in ("", "<p></p>", "<p/>")
]
EMPTY += [
    f'<polylist count="0">{OF_POINTS}<vcount/><p/></polylist>',
    f'<polygons count="0">{OF_POINTS}</polygons>',
]
EMPTY += [
    f'<{kind} count="0">{OF_POINTS}</{kind}>' for kind in ("tristrips", "trifans", "linestrips")
]


@pytest.mark.parametrize(
    "empty", [*EMPTY, f'<linestrips count="1">{OF_POINTS}<p>0 1 2</p></linestrips>']
)
def test_an_empty_element_of_a_dae_costs_no_other(empty):
    pytest.importorskip("collada")
    drawn = f'{empty}<triangles count="1">{OF_POINTS}<p>0 1 2</p></triangles>{empty}'
    read = read_mesh(drawn_dae(drawn), "dae")
    lines = (f"{empty[1:].split()[0]} of mesh",) if "<line" in empty else ()
    assert len(read.mesh.faces) == 1 and read.dropped == lines


@pytest.mark.parametrize(
    ("mode", "color", "transparency", "opacity"),
    [
        ("A_ONE", "1 1 1 0.3", None, 0.3),
        (None, "0 0 0 0.5", 0.5, 0.25),
        ("A_ZERO", "1 1 1 0.7", None, 0.3),
        ("RGB_ZERO", "0.7 0.7 0.7 1", None, 0.3),
        ("RGB_ZERO", "1 1 1 1", 0.0, 1.0),
        ("RGB_ONE", "0.3 0.3 0.3 1", 1.0, 0.3),
        (None, None, 0.4, 0.4),
        ("A_ONE", "1 1 1 1", None, 1.0),
    ],
)
def test_the_opacity_of_a_dae_is_its_color_and_its_number(mode, color, transparency, opacity):
    pytest.importorskip("collada")
    effect = "<diffuse><color>0 1 0 1</color></diffuse>"
    effect += (
        f"<transparent{f' opaque={chr(34)}{mode}{chr(34)}' if mode else ''}><color>{color}</color></transparent>"
        * bool(color)
    )
    effect += (
        f"<transparency><float>{transparency}</float></transparency>"
        if transparency is not None
        else ""
    )
    drawn = f'<triangles count="1" material="m">{OF_POINTS}<p>0 1 2</p></triangles>'
    mesh = read_mesh(drawn_dae(drawn, effect), "dae").mesh
    assert mesh.metadata.get("material.0.d", 1.0) == pytest.approx(opacity)
    glb = read_mesh(file_of(mesh, "glb"), "glb").mesh
    assert glb.metadata.get("material.0.alphaMode") == ("BLEND" if opacity < 1 else None)


def test_thousands_of_polygons_that_are_not_convex_are_cut_in_one_go():
    pytest.importorskip("mapbox_earcut")
    plates = [comb(1 + number % 2)[0] + [20 * number, 0, 0] for number in range(2000)]
    sizes, points = np.array([len(plate) for plate in plates]), np.concatenate(plates)
    text = "".join(f"v {x} {y} {z}\n" for x, y, z in points.tolist())
    ends = np.cumsum(sizes)
    text += "".join(
        f"f {' '.join(map(str, range(e - s + 1, e + 1)))}\n"
        for s, e in zip(sizes.tolist(), ends.tolist())
    )
    assert area(read_mesh(text.encode(), "obj").mesh) == pytest.approx(
        1000 * (comb(1)[1] + comb(2)[1])
    )


def test_a_dae_keeps_values_of_corners_materials_and_shared_vertices(tmp_path):
    pytest.importorskip("collada")
    (tmp_path / "a b.png").write_bytes(png())
    uv = '<source id="t"><float_array id="ta" count="4">0 0 1 1</float_array><technique_common><accessor source="#ta" '
    uv += 'count="2" stride="2"><param name="S" type="float"/><param name="T" type="float"/></accessor>'
    uv += "</technique_common></source>"
    inputs = '<input semantic="VERTEX" source="#v" offset="0"/><input semantic="TEXCOORD" source="#t" offset="1"/>'
    strip = f'<tristrips count="1" material="m">{inputs}<p>0 0 1 1 2 0 0 1</p></tristrips></mesh>'
    effect = '<library_images><image id="i"><init_from>a%20b.png</init_from></image></library_images><library_effects>'
    effect += '<effect id="e"><profile_COMMON><newparam sid="s"><surface type="2D"><init_from>i</init_from></surface>'
    effect += '</newparam><newparam sid="q"><sampler2D><source>s</source></sampler2D></newparam><technique sid="c">'
    effect += '<phong><diffuse><texture texture="q" texcoord="x"/></diffuse><shininess><float>9</float></shininess>'
    effect += "</phong></technique></profile_COMMON></effect></library_effects><library_materials><material "
    effect += 'id="mm" name="Skin #1"><instance_effect url="#e"/></material></library_materials>'
    bound = SHOWN.replace(
        "/>", "><bind_material><technique_common><instance_material symbol='m' target='#mm'/>"
    )
    bound += "</technique_common></bind_material></instance_geometry>"
    mirror = "<matrix>-1 0 0 5 0 1 0 0 0 0 1 0 0 0 0 1</matrix>"
    text = collada(
        "", f'<node id="x">{bound}</node><node id="y">{mirror}{SHOWN}</node>', effect
    ).decode()
    before, _, after = text.partition("<vertices")
    (tmp_path / "a.dae").write_text(f"{before}{uv}<vertices{after}".replace("</mesh>", strip))
    mesh = read_mesh(tmp_path / "a.dae").mesh
    assert len(mesh.positions) == 12 and len(mesh.faces) == 6
    normals = np.cross(*np.diff(mesh.positions[mesh.faces[[0, 3]]], axis=1).swapaxes(0, 1))
    assert (normals[:, 2] > 0).all(), "the mirrored part, too"
    first = materials_in(mesh.metadata)[0]
    assert (
        first["name"] == "Skin #1"
        and first["Ns"] == 9
        and images_in(mesh.metadata)[first["map_Kd"]][1] == png()
    )
    assert attribute(mesh, "material").values[:, 0].tolist() == [0, 0, 0, 1, 1, 1]
    found = at_corners(mesh, attribute(mesh, "texcoord"))
    assert found[1].tolist() == [[0, 0], [1, 1], [0, 0]] and not found[0].any()


def test_a_3mf_file_has_colors_materials_and_an_error_where_its_build_is_empty(tmp_path):
    pytest.importorskip("lib3mf")
    base = '<basematerials id="9"><base name="oak" displaycolor="#FF000080"/></basematerials>'
    shades = (
        '<m:colorgroup id="8"><m:color color="#00FF0080"/><m:color color="#0000FF"/></m:colorgroup>'
    )
    painted = (
        chained_objects(0)
        + base
        + shades
        + box_3mf(1, 'pid="9" pindex="0"', 'pid="8" p1="0" p2="1" p3="1"')
    )
    mesh = read_mesh(three_mf(painted, '<item objectid="1"/>'), "3mf").mesh
    color = attribute(mesh, "color")
    assert color.values[color.indices][:2].tolist() == [
        [[255] * 4] * 3,
        [[0, 255, 0, 128], *[[0, 0, 255, 255]] * 2],
    ]
    assert mesh.metadata["material.0.name"] == "oak" and mesh.metadata["material.0.Kd"] == "1 0 0"
    assert mesh.metadata["material.0.d"] == "0.501961" and (
        mesh.metadata["up"],
        mesh.metadata["unit"],
    ) == ("z", "millimeters")
    with pytest.raises(MeshError, match="its build has no item"):
        read_mesh(three_mf(chained_objects(1), ""), "3mf")


def box_3mf(number, of_object="", of_second=""):
    """An object of two triangles, with properties of itself and of its second triangle."""
    corners = "".join(
        f'<vertex x="{x}" y="{y}" z="0"/>' for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))
    )
    faces = f'<triangle v1="0" v2="1" v3="2"/><triangle v1="0" v2="2" v3="3" {of_second}/>'
    mesh = f"<mesh><vertices>{corners}</vertices><triangles>{faces}</triangles></mesh>"
    return f'<object id="{number}" {of_object}>{mesh}</object>'


def test_components_of_part_files_are_the_objects_that_they_name():
    pytest.importorskip("lib3mf")
    inside = '<component objectid="{}" p:path="/3D/Objects/{}.model" transform="{} 0 0 0 1 0 0 0 1 0 0 0"/>'.format
    root = f'<object id="7"><components>{inside(1, "a", 1)}{inside(2, "a", 2)}{inside(1, "b", 4)}</components></object>'
    nested = '<object id="9"><components><component objectid="1"/><component objectid="1"/></components></object>'
    parts = {"a": box_3mf(1) + box_3mf(2) + nested, "b": box_3mf(1)}
    items = '<item objectid="7"/><item objectid="9" p:path="/3D/Objects/a.model"/>'
    corners = (mesh := read_mesh(three_mf(root, items, parts), "3mf").mesh).positions[mesh.faces]
    areas = (
        np.linalg.norm(
            np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
        )
        / 2
    )
    assert areas.sum() == 1 + 2 + 4 + 1 + 1


def test_what_a_ply_has_twice_or_for_some_faces_only():
    twice = ply_head(more="property float q\n" * 2) + "0 0 0 1 2\n1 0 0 3 4\n0 1 0 5 6\n3 0 1 2\n"
    read = read_mesh(twice.encode(), "ply")
    assert read.notes == ("left out: the first q, of which there are several",)
    assert attribute(read.mesh, "q").values[:, 0].tolist() == [2, 4, 6]
    with pytest.raises(MeshError, match="the element vertex several times"):
        read_mesh(twice.replace("element face", "element vertex 0\nelement face").encode(), "ply")
    rows = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 6 0 0 1 0 1 1\n3 0 2 1 0\n"
    read = read_mesh(
        (ply_head(faces=2, last="property list uchar float texcoord\n") + rows).encode(), "ply"
    )
    assert read.notes == ("faces without texture coordinates were given zeros: 1",)


def test_colors_and_names_of_values_that_could_mean_something_else():
    off = (
        "COFF\n3 1 0\n"
        + "".join(f"{x} {y} 0 1 0 0 1\n" for x, y in ((0, 0), (1, 0), (0, 1)))
        + "3 0 1 2\n"
    )
    assert attribute(read_mesh(off.encode(), "off").mesh, "color").values[0].tolist() == [
        255,
        0,
        0,
        255,
    ]
    with pytest.raises(MeshError, match="binary OFF"):
        read_mesh(b"OFF BINARY\n\0\0\0\3\0\0\0\1", "off")
    given = {
        ("Normals", 3): "normal",
        ("normality", 3): "generic",
        ("color", 1): "generic",
        ("face_color_2", 4): "color",
    }
    assert {name: meaning_of(*name) for name in given} == given


def test_an_obj_in_utf16_and_a_ply_with_a_line_that_is_a_comment():
    text = f"{THREE}g \u00fc\nf 1 2 3\n"
    for encoding in ("utf-16", "utf-8-sig"):
        assert names(read_mesh(text.encode(encoding), "obj").mesh, "group") == ["\u00fc"]
    head, body = file_of(torus(5, 4), "ply").split(b"format", 1)
    assert len(read_mesh(head + b"Created by somebody\nformat" + body).mesh.faces) == 40


def test_an_image_beyond_the_limit_of_small_metadata_comes_back(tmp_path):
    data = png() + bytes(bsm.Limits().metadata_bytes)
    (tmp_path / "a.png").write_bytes(data)
    (tmp_path / "a.mtl").write_text("newmtl m\nmap_Kd a.png\n")
    (tmp_path / "a.obj").write_text(f"mtllib a.mtl\nusemtl m\n{THREE}f 1 2 3\n")
    assert (
        bsm.decode(bsm.encode(str(tmp_path / "a.obj"), preset="lossless")).metadata["image.0.data"]
        == data
    )
    with pytest.raises(bsm.OptionError, match="metadata_bytes"):
        bsm.encode(
            TriangleMesh(SQUARE, [[0, 1, 2]], (), {"story": "x" * bsm.Limits().metadata_bytes})
        )


@pytest.mark.parametrize(
    ("mtl", "words"),
    [
        ("newmtl A # the body\nkd 0.5\nKD 1,0,0\n", {"Kd": "1 0 0"}),
        ('NEWMTL A\nKd 0.5\nmap_kd "T X.PNG"\n', {"Kd": "0.5 0.5 0.5", "map_Kd": 0}),
        ("newmtl A\nmap_Kd 't.tga'\n", {"map_Kd": 0}),
    ],
)
def test_libraries_as_people_write_them(mtl, words, tmp_path):
    (tmp_path / "t x.png").write_bytes(png())
    (tmp_path / "T.TGA").write_bytes(bytes([0, 0, 2, *9 * [0], 1, 0, 1, 0, 24, 0, 9, 9, 9]))
    (tmp_path / "a.mtl").write_text(mtl)
    (tmp_path / "a.obj").write_text(f"mtllib A.MTL\n{THREE}usemtl A\nf 1 2 3\n")
    read = read_mesh(tmp_path / "a.obj")
    assert materials_in(read.mesh.metadata)[0] == {"name": "A", **words} and not read.notes
    assert words.get("map_Kd", 1) != 0 or images_in(read.mesh.metadata)[0][1]


def test_factors_stay_in_range_and_far_meshes_go_by_a_node(tmp_path):
    metadata = {"material.0.Kd": "1.5 0 0", "material.0.Ke": "10 10 10", "material.0.d": "1.0"}
    positions = np.add([[0, 0, 0], [1, 0, 0], [0, 1, 0.1]], [500123.25, 100.5, -4649776.75])
    left = bsm.save(TriangleMesh(positions, [[0, 1, 2]], (), metadata), tmp_path / "a.glb")
    assert left == ("Kd of material 0 (for programs other than bsm)",)
    again = read_mesh(tmp_path / "a.glb").mesh
    assert again.positions == pytest.approx(positions, abs=1e-6)
    assert again.metadata["material.0.emissiveFactor"] == "223.826 223.826 223.826"
    assert again.metadata["material.0.baseColorFactor"] == "1 0 0 1"
    beyond = TriangleMesh(SQUARE, [[0, 1, 2]], (), {"material.0.baseColorFactor": "2 -1 0 1"})
    assert bsm.save(beyond, tmp_path / "b.obj") == (
        "baseColorFactor of material 0 (for programs other than bsm)",
    )
    assert (tmp_path / "b.mtl").read_text().splitlines()[1:] == ["Kd 1 0 0"]


def test_the_first_image_of_a_ply_has_the_color(tmp_path):
    metadata = {"material.0.normalTexture": 0, "material.0.baseColorTexture": 1}
    metadata |= {f"image.{number}.data": png() + bytes([number]) for number in range(2)}
    bsm.save(TriangleMesh(SQUARE, [[0, 1, 2]], (), metadata), tmp_path / "a.ply")
    assert (tmp_path / "a.ply").read_bytes().partition(b"TextureFile ")[2].startswith(b"a.1.png")
    assert metadata.items() <= read_mesh(tmp_path / "a.ply").mesh.metadata.items()


@pytest.mark.parametrize("way", [(1, 0, 0), (1, 1, 0), (1, 1, 1)])  # by a face, an edge, a vertex
def test_bodies_that_touch_stay_bodies_and_are_objects_of_a_3mf(way, tmp_path):
    box = boxes((0, 0, 0), way)
    two = TriangleMesh(
        box.positions, box.faces, [bsm.Attribute("object", np.repeat([0, 1], 12), "face")]
    )
    assert len(bsm.Encoder(two).notes) == 1
    for kind in ("stl", "obj"):
        bsm.save(two, tmp_path / f"a.{kind}", overwrite=True)
        assert len(bsm.decode(bsm.encode(tmp_path / f"a.{kind}")).positions) == 16
    pytest.importorskip("lib3mf")
    assert bsm.save(bsm.decode(bsm.encode(two, preset="lossless")), tmp_path / "a.3mf") == ()
    assert len(read_mesh(tmp_path / "a.3mf").mesh.positions) == 16


@pytest.mark.parametrize("kind", ["ply", "off", "vtp"])
def test_formats_without_materials_say_so_though_bsm_reads_them_back(kind, tmp_path):
    mesh = TriangleMesh(SQUARE, [[0, 1, 2]], (), {"material.0.baseColorFactor": "1 0 0 1"})
    lost = bsm.save(mesh, tmp_path / f"a.{kind}")
    assert lost == ("baseColorFactor of material 0 (for programs other than bsm)",)
    assert bsm.load(tmp_path / f"a.{kind}").metadata["material.0.baseColorFactor"] == "1 0 0 1"
    assert (
        bsm.save(mesh, tmp_path / "a.obj") == () and "Kd 1 0 0" in (tmp_path / "a.mtl").read_text()
    )


@pytest.mark.parametrize("kind", ["mesh", "post", "su2", "med", "ugrid", "xyz"])
def test_formats_of_other_libraries_do_not_leak_in(kind, tmp_path):
    (tmp_path / f"a.{kind}").write_text("1 2 3\n")
    with pytest.raises(FormatError, match=f"{kind} is not a mesh format"):
        read_mesh(tmp_path / f"a.{kind}")


def test_comments_of_an_obj_come_back_or_are_named(tmp_path):
    text = f"# 3D Slicer output. SPACE=RAS\n# by hand\n{THREE}# 3 vertices\n# twice as fine here\nf 1 2 3 # flat\n"
    (tmp_path / "a.obj").write_text(text)
    mesh, _, dropped = vars(read_mesh(tmp_path / "a.obj")).values()
    assert (
        mesh.metadata["comment"] == "3D Slicer output. SPACE=RAS\nby hand"
        and "comments amid the data (2)" in dropped
    )
    for kind, line in (
        ("obj", "# 3D Slicer output. SPACE=RAS"),
        ("ply", "comment 3D Slicer output. SPACE=RAS"),
    ):
        bsm.save(mesh, tmp_path / f"b.{kind}")
        assert line in (tmp_path / f"b.{kind}").read_bytes().decode("latin-1").splitlines()
        assert (
            read_mesh(tmp_path / f"b.{kind}").mesh.metadata["comment"] == mesh.metadata["comment"]
        )


def test_a_unit_that_others_do_not_read_is_a_note(tmp_path):
    (tmp_path / "a.obj").write_text(f"{THREE}f 1 2 3\n")
    for meta, told in (
        (("unit=mm", "up=z"), "the unit (mm) and the upward axis (z)"),
        (("unit=m", "up=y"), ""),
    ):
        words = [word for one in meta for word in ("--meta", one)]
        program("encode", tmp_path / "a.obj", "-f", "--quick", *words)
        done = program("decode", tmp_path / "a.bsm", "-f", "-o", tmp_path / "b.obj", text=True)
        assert (
            done.returncode == 0
            and ("other programs do not read" in done.stderr) == bool(told)
            and told in done.stderr
        )


def test_facets_of_four_corners_are_told_from_a_file_that_is_cut(tmp_path):
    corners = "".join(f"vertex {x} {y} 0\n" for x, y in ((0, 0), (1, 0), (1, 1), (0, 1)))
    text = f"solid a\nfacet normal 0 0 1\nouter loop\n{corners}endloop\nendfacet\nendsolid a\n"
    (tmp_path / "a.stl").write_text(text)
    with pytest.raises(bsm.FormatError, match="1 facets have 4 corners"):
        read_mesh(tmp_path / "a.stl")
    (tmp_path / "a.stl").write_text(text[:-20])
    with pytest.raises(bsm.TruncatedError):
        read_mesh(tmp_path / "a.stl")


def test_colors_of_corners_stay_in_a_3mf(tmp_path):
    pytest.importorskip("lib3mf")
    colors = np.array([[255, 0, 0, 128], [0, 255, 0, 255], [1, 2, 3, 255], [9, 9, 9, 9]], np.uint8)
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
    attribute = bsm.Attribute("color", colors, semantic="color")
    mesh = bsm.TriangleMesh(square, np.array([[0, 1, 2], [0, 2, 3]]), (attribute,))
    assert "color" not in bsm.save(mesh, tmp_path / "a.3mf")
    found = read_mesh(tmp_path / "a.3mf").mesh
    shown = next(a for a in found.attributes if a.semantic == "color")
    assert (shown.values[shown.indices] == colors[mesh.faces]).all()


def test_tensors_are_attributes_of_their_axes():
    values = np.arange(24.0).reshape(4, 6)
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
    column = Column("stress", values)
    found = (
        Polygons(square, np.array([4]), np.arange(4), columns=(column,)).checked(bsm.Limits()).mesh
    )
    assert [a.name for a in found.attributes] == [
        f"stress.{axes}" for axes in ("xx", "yy", "zz", "xy", "yz", "xz")
    ]
    assert np.array_equal(np.column_stack([a.values for a in found.attributes]), values)
