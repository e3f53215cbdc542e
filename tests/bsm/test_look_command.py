"""`bsm.look` and `bsm compare --look`: the same answer, pictures on request, and sentences where there is none."""

import sys

import numpy as np
import pytest

import bsm
from bsm.cli import main
from bsm.codec.look.measure import LookMetric
from bsm.files.mesh import read_mesh
from tests.bsm.program import run_json
from tests.shapes import tetrahedron, torus


@pytest.fixture
def files(tmp_path):
    mesh = torus(30, 20)
    bsm.save(mesh, tmp_path / "a.ply")
    bsm.save(mesh, tmp_path / "b.bsm", theta=4)
    bsm.save(tetrahedron(), tmp_path / "other.off")
    return tmp_path


def test_the_command_says_what_python_says(files, capsys):
    seen = bsm.look(files / "a.ply", files / "b.bsm")
    found = run_json("compare", files / "a.ply", files / "b.bsm", "--look")
    original, decoded = (read_mesh(files / "a.ply").mesh, bsm.decode(files / "b.bsm"))
    assert found["look"] == {
        "distance": seen.distance,
        "unlike": seen.unlike,
        "gone": seen.gone,
        "flat": pytest.approx(LookMetric(original).flat(decoded)),
    }
    assert seen.distance > 0
    assert found["theta_deg"] <= 4
    assert "look" not in run_json("compare", files / "a.ply", files / "b.bsm")
    assert main(["compare", str(files / "a.ply"), str(files / "b.bsm"), "--look"]) == 0
    assert (found["folded_before"], found["folded_after"]) == (0, 0)
    lines = capsys.readouterr().out.splitlines()[-2:]
    assert lines[0].startswith(f"look               {seen.distance:.6g} ") and "look distance" in lines[0]
    assert lines[1].startswith("look_flat          ")


def test_meshes_of_other_faces_are_looked_at(files):
    found = run_json("compare", files / "a.ply", files / "other.off", "--look")
    assert list(found) == ["look"]
    assert found["look"]["distance"] > 1
    assert main(["compare", str(files / "a.ply"), str(files / "other.off")]) == 3


def test_a_picture_shows_both_and_the_difference(files):
    image = pytest.importorskip("PIL.Image")
    target = files / "seen.png"
    run_json("compare", files / "a.ply", files / "b.bsm", "--picture", target)
    with image.open(target) as picture:
        assert picture.size == (3 * 512, 512)
        shades = np.asarray(picture)
    assert shades[:, :512].min() < 128 < shades[0, :1024].min()
    assert shades[:, 1024:].min() < 255
    again = ["compare", str(files / "a.ply"), str(files / "b.bsm"), "--picture", str(target)]
    assert main(again) != 0
    assert main([*again, "-f"]) == 0


def test_a_picture_needs_no_library(files, monkeypatch):
    monkeypatch.setitem(sys.modules, "PIL", None)
    monkeypatch.setitem(sys.modules, "PIL.Image", None)
    assert main(["compare", str(files / "a.ply"), str(files / "b.bsm"), "--picture", str(files / "own.png")]) == 0
    assert (files / "own.png").read_bytes().startswith(b"\x89PNG")


def test_what_has_no_area_is_a_sentence(files, capsys):
    bsm.save(([(0, 0, 0), (1, 0, 0), (2, 0, 0)], [(0, 1, 2)]), files / "line.off")
    assert main(["compare", str(files / "line.off"), str(files / "a.ply"), "--look"]) == 3
    assert "cannot be looked at" in capsys.readouterr().err


def test_triangles_without_area_and_vertices_at_one_place_are_counted_beyond_the_inputs(tmp_path, capsys):
    faces = [(0, 1, 2), (2, 1, 3), (0, 2, 4), (4, 2, 3), (0, 1, 5)]
    before = np.array(
        [(0, 0, 0), (1, 0, 0), (0.4, 0.1, 0), (1, 1, 0), (0, 1, 0), (2, 0, 0)]
    )  # the last is flat already
    after = before.copy()
    after[2] = 0.5, 0.0, 0.0  # on the line of 0 and 1, and so the first face
    found = bsm.compare((before, faces), (after, faces))
    assert (found.flattened, found.merged) == (1, 0)
    after[2] = before[4]
    found = bsm.compare((before, faces), (after, faces))
    assert (found.flattened, found.merged) == (2, 1)
    assert (
        bsm.compare((after, faces), (after, faces)).flattened,
        bsm.compare((before, faces), (before, faces)).merged,
    ) == (0, 0)
    bsm.save((before, faces), tmp_path / "a.ply")
    bsm.save((after, faces), tmp_path / "b.ply")
    assert main(["compare", str(tmp_path / "a.ply"), str(tmp_path / "b.ply"), "-q"]) == 0
    line = capsys.readouterr().out.splitlines()[0]
    assert line.endswith("; 2 triangles flattened by rounding; 1 vertex merged by rounding")
    found = run_json("compare", tmp_path / "a.ply", tmp_path / "b.ply")
    assert (found["flattened"], found["merged"]) == (2, 1)
