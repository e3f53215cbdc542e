"""What people see first: short names, sizes in words, folders mirrored, sentences with units, maps and curves."""

import inspect

import numpy as np
import pytest

import bsm
from bsm.cli import main
from bsm.lengths import in_own_unit, parse_bytes, parse_length
from tests.bsm.program import bsm as program
from tests.shapes import torus
from tests.streams import events_of

MESH = torus()


def test_what_is_printed_fits_a_line():
    painted = bsm.TriangleMesh(MESH.positions, MESH.faces, (bsm.Attribute("heat", np.arange(len(MESH.positions))),))
    assert repr(painted) == f"TriangleMesh({len(MESH.positions)} vertices, {len(MESH.faces)} faces, heat)"
    assert repr(painted.attributes[0]) == f"Attribute('heat', {len(MESH.positions)} x 1 int32 per vertex, generic)"
    assert repr(bsm.Limits()) == "Limits()" and repr(bsm.Limits(work=3.0)) == "Limits(work=3.0)"
    for name in ("decode", "load", "decode_sequence", "read_mesh"):
        assert len(str(inspect.signature(getattr(bsm, name)))) < 400, name
    for event in events_of(bsm.encode(MESH, step=0.01)):
        if not isinstance(event, bsm.HeaderEvent):
            assert len(repr(event)) < 120 and "array" not in repr(event)


@pytest.mark.parametrize(
    ("text", "count"),
    [("20kB", 20e3), ("20k", 20e3), ("1.5MiB", 1.5 * 2**20), ("900 B", 900), ("1e4", 1e4), (700, 700), ("2 MB", 2e6)],
)
def test_sizes_are_read(text, count):
    assert parse_bytes("size", text) == count


@pytest.mark.parametrize("text", ["20 cows", "kB", "-3kB", None, "1.2.3", True])
def test_what_is_no_size_is_reported(text):
    with pytest.raises(bsm.ArgumentError, match="such as 20000 or 20kB"):
        parse_bytes("size", text)


def test_a_size_may_have_a_unit(tmp_path, capsys):
    bsm.save(torus(16, 12), tmp_path / "a.ply")
    assert main(["encode", str(tmp_path / "a.ply"), "--size", "2kB"]) == 0
    assert (tmp_path / "a.bsm").stat().st_size <= 2000
    assert main(["encode", str(tmp_path / "a.ply"), "-f", "--size", "two"]) == 2
    assert "20kB" in capsys.readouterr().err


def test_a_tree_is_mirrored(tmp_path, capsys):
    tree, out = tmp_path / "tree", tmp_path / "out"
    for name in ("scan_1/mesh.ply", "scan_2/mesh.ply", "scan_2/deep/mesh.obj", "top.stl"):
        (tree / name).parent.mkdir(parents=True, exist_ok=True)
        bsm.save(MESH, tree / name)
    (tree / "scan_1/notes.txt").write_text("no mesh")
    assert main(["encode", str(tree), "-o", str(out), "-r", "-q", "--grid", "8"]) == 0
    made = {path.relative_to(out).as_posix() for path in out.rglob("*") if path.is_file()}
    assert made == {"scan_1/mesh.bsm", "scan_2/mesh.bsm", "scan_2/deep/mesh.bsm", "top.bsm"}
    assert main(["encode", str(tree), "-r", "-q", "--grid", "8"]) == 0
    assert (tree / "scan_2/deep/mesh.bsm").exists(), "beside, without -o"
    assert main(["encode", str(tree / "top.stl"), "-r"]) == 2
    bsm.save(MESH, tree / "scan_1/mesh.off")
    assert main(["encode", str(tree), "-o", str(tmp_path / "new"), "-r", "-q", "--grid", "8"]) == 0
    assert {path.name for path in (tmp_path / "new/scan_1").iterdir()} == {"mesh.ply.bsm", "mesh.off.bsm"}
    (tmp_path / "empty").mkdir()
    assert main(["encode", str(tmp_path / "empty"), "-r"]) == 2
    errors = capsys.readouterr().err
    assert "not a local folder" in errors and "no mesh files" in errors


def test_compare_says_it_in_a_sentence_with_units(tmp_path, capsys):
    mesh = bsm.TriangleMesh(MESH.positions, MESH.faces, metadata={"unit": "mm"})
    bsm.save(mesh, tmp_path / "a.ply")
    moved = MESH.positions.copy()
    moved[3, 2] += 0.25
    bsm.save(bsm.TriangleMesh(moved, MESH.faces), tmp_path / "b.ply")
    assert main(["compare", str(tmp_path / "a.ply"), str(tmp_path / "b.ply")]) == 0
    first = capsys.readouterr().out.splitlines()[0]
    assert first.startswith("largest vertex error 0.25 mm, ") and "% of the diagonal" in first
    assert main(["compare", str(tmp_path / "a.ply"), str(tmp_path / "a.ply")]) == 0
    assert capsys.readouterr().out.startswith("all vertices are equal\n")


def test_a_map_shows_where_vertices_are_off(tmp_path, capsys):
    bsm.save(MESH, tmp_path / "a.ply")
    moved = MESH.positions.copy()
    moved[: len(moved) // 2, 2] += 0.25
    bsm.save(bsm.TriangleMesh(moved, MESH.faces), tmp_path / "b.ply")
    words = ["compare", str(tmp_path / "a.ply"), str(tmp_path / "b.ply"), "--map"]
    for name in ("map.ply", "map.obj"):
        assert main([*words, str(tmp_path / name)]) == 0
        color = next(a for a in bsm.load(tmp_path / name).attributes if a.semantic == "color").values
        assert color[0, 0] > color[0, 2] and color[-1, 2] > color[-1, 0], "red where it moved, blue where not"
    distance = next(a for a in bsm.load(tmp_path / "map.ply").attributes if a.name == "distance")
    np.testing.assert_allclose(distance.values[[0, -1], 0], [0.25, 0], atol=1e-6)
    assert main([*words, str(tmp_path / "map.png")]) == 0
    assert (tmp_path / "map.png").read_bytes().startswith(b"\x89PNG")
    assert main([*words, str(tmp_path / "map.png")]) != 0, "it is there"
    assert main([*words, str(tmp_path / "map.txt")]) == 2
    assert "a picture (.png)" in capsys.readouterr().err


def test_obj_has_colors_that_every_reader_takes(tmp_path, capsys):
    rgba = np.tile(np.array([[255, 0, 51, 128]], np.uint8), (len(MESH.positions), 1))
    mesh = bsm.TriangleMesh(MESH.positions, MESH.faces, (bsm.Attribute("color", rgba, semantic="color"),))
    assert bsm.save(mesh, tmp_path / "a.obj") == ("alpha of color",)
    rows = [line.split() for line in (tmp_path / "a.obj").read_text().splitlines() if line.startswith("v ")]
    assert {len(row) for row in rows} == {7} and rows[0][4:] == ["1", "0", "0.2"]


@pytest.fixture(scope="module")
def loop(tmp_path_factory):
    """A stream that goes round twice, and the frames."""
    tmp_path = tmp_path_factory.mktemp("loop")
    angles = 2 * np.pi * np.arange(24) / 12
    waves = np.sin(3.0 * MESH.positions[None, :, 2:] + angles[:, None, None])
    frames = MESH.positions + 0.1 * waves * [1.0, 0.0, 0.0]
    np.savez(tmp_path / "loop.npz", positions=frames, faces=MESH.faces)
    (tmp_path / "loop.bsm").write_bytes(bsm.encode_sequence(frames, MESH.faces, preset="near-lossless"))
    return tmp_path


def test_the_errors_of_frames_are_drawn_as_a_curve(loop, capsys):
    words = ["compare", str(loop / "loop.npz"), str(loop / "loop.bsm")]
    assert main([*words, "--picture", str(loop / "curve.png")]) == 0
    assert (loop / "curve.png").read_bytes().startswith(b"\x89PNG")
    assert main([*words, "--map", str(loop / "map.png")]) == 2
    assert "for sequences, --picture" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("given", "expected"),
    [("0.05mm", (0.05, True)), ("0.1%", (0.001, False)), (" 2e-3 ", (0.002, False)), (0.5, (0.5, False))],
)
def test_lengths(given, expected):
    assert parse_length("gap", given) == expected


@pytest.mark.parametrize("given", ["", "mm", ".mm", "1..2mm", "-1mm", "nan", True, None])
def test_what_is_no_length(given):
    with pytest.raises(bsm.ArgumentError, match="gap"):
        parse_length("gap", given)


@pytest.mark.parametrize("unit", ["mm", "millimeters", "Millimetre", "furlong"])
def test_the_same_unit_or_an_unknown_one(unit):
    assert in_own_unit({"max_error": "0.5mm", "size": "3kB"}, {"unit": unit}) == {}
    assert in_own_unit({"max_error": "0.5%"}, {"unit": unit}) == {}


@pytest.mark.parametrize("metadata", [{}, {"unit": ""}, {"unit": 7}, {"name": "mm"}])
def test_a_length_with_a_unit_needs_a_mesh_that_has_one(metadata):
    for plain in ("0.5%", 0.1, "0.1"):
        assert in_own_unit({"max_error": plain}, metadata) == {}
    with pytest.raises(bsm.OptionError, match=r"has no unit: add unit=mm .* such as 0\.1%"):
        in_own_unit({"max_error": "0.5mm"}, metadata)


def test_another_unit_is_converted(tmp_path):
    mesh, metadata = torus(8, 7), {"unit": "meters"}
    assert in_own_unit({"max_error": "0.05mm"}, metadata) == {"max_error": "5e-05meters"}
    own, other = (bsm.encode(mesh, metadata=metadata, max_error=text) for text in ("0.05meters", "50mm"))
    assert own == other
    bsm.save(mesh, tmp_path / "a.ply")
    words = ("encode", tmp_path / "a.ply", "-q", "-f", "-o", tmp_path / "a.bsm", "--meta", "unit=cm", "--max-error")
    assert program(*words, "0.01in").returncode == 0
    inches = (tmp_path / "a.bsm").read_bytes()
    assert program(*words, "0.0254cm").returncode == 0
    assert inches == (tmp_path / "a.bsm").read_bytes()
