"""What people type first works, or says what to type."""

import json
import shlex

import numpy as np
import pytest

import bsm
from bsm.cli import main
from tests.shapes import torus


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A folder with a mesh in two formats, and a stream of it."""
    monkeypatch.chdir(tmp_path)
    mesh = torus(16, 12)
    for name in ("ring.ply", "ring.glb", "ring.bsm"):
        bsm.save(mesh, name)
    return tmp_path


def run(*words):
    """Return the exit code of a command line."""
    try:
        return main([str(word) for word in words])
    except SystemExit as stop:
        return stop.code


@pytest.mark.parametrize("given", ["ring.ply", "ring.glb"])
@pytest.mark.parametrize(
    "output", ["out.glb", "out.gltf", "out.PLY", "out.stl", "out.obj", "out.drc", "out.usdz", "a b.ply"]
)
def test_a_stream_is_not_written_under_another_name(folder, capsys, given, output):
    assert run("encode", given, "-o", output) == 2
    said = capsys.readouterr().err
    assert not (folder / output).exists() and said.count("\n") == 1
    for command in said.partition("Run: ")[2].strip().split("; "):
        words = shlex.split(command.removeprefix("then "))
        assert run(*words[1:]) == 0, "the advice works"
    assert output.endswith((".drc", ".usdz")) or (folder / output.replace(".gltf", ".glb")).exists()


def test_a_stream_may_have_any_name(folder, capsys):
    for name in ("wrong.glb", "wrong.gltf", "wrong.ply"):
        (folder / "ring.bsm").rename(name)
        for words in (["info"], ["verify"], ["decode", "-f", "-o", "back.ply"], ["compare", "ring.ply"]):
            assert run(*words, name) == 0, (words, name)
        (folder / name).rename("ring.bsm")
    assert run("encode", "ring.bsm", "-o", "x.bsm") == 3
    assert "decode it first" in capsys.readouterr().err


def test_a_bare_number_is_questioned(folder, capsys):
    diagonal = f"{0.05 * bsm.load('ring.ply').diagonal:.3g} mm here"
    assert run("encode", "ring.ply", "-f", "--max-error", "0.05", "--meta", "unit=mm") == 2
    said = capsys.readouterr().err
    assert "0.05 is 5 % of the diagonal" in said and diagonal in said and "5%" in said and "0.05mm" in said
    with pytest.raises(bsm.OptionError, match="for that write 5%"):
        bsm.encode("ring.ply", max_error=0.05)
    for bound in ("5%", "0.019", "0.05mm"):
        assert run("encode", "ring.ply", "-f", "-q", "--max-error", bound, "--meta", "unit=mm") == 0


def test_an_unknown_unit_is_asked_for_once(folder, capsys):
    (folder / "parts").mkdir()
    for number in range(4):
        bsm.save(torus(16, 12), f"parts/{number}.ply")
    assert run("encode", "-r", "parts", "--max-error", "0.1mm", "--report", "r.json") == 2
    said = capsys.readouterr().err
    assert said.count("but the mesh has no unit") == 1 + 4 and "4 files in all have no unit" in said  # and in the table
    size = f"{np.ptp(bsm.load('ring.ply').positions, axis=0).max():.3g}"
    assert f"is it {size} m or {size} mm long?" in said and "--meta unit=m" in said


def test_errors_are_in_the_unit_that_was_asked_for(folder, capsys):
    words = ["encode", "ring.ply", "-f", "--meta", "unit=m", "--max-error", "5mm"]
    assert run(*words, "--report", "r.json") == 0
    said = capsys.readouterr().err
    facts = json.loads((folder / "r.json").read_text())
    error = facts["files"][0]["max_error"]
    assert facts["files"][0]["unit"] == "mm" and 0 < error <= 5
    assert said.count(f"{error:.3g} mm") == 3, "of the mesh, in the table, and the largest"
    assert facts["totals"]["largest_error"] == f"{error:.3g} mm (ring.ply)"
    back, vertices = bsm.load("ring.bsm").positions, bsm.load("ring.ply").positions
    farthest = max(np.linalg.norm(vertices - place, axis=1).min() for place in back)
    assert 1e3 * farthest == pytest.approx(error, rel=0.01), "the mesh is in meters"
    assert run(*words, "--json") == 0
    assert json.loads(capsys.readouterr().out)["unit"] == "mm"


def test_any_mesh_becomes_a_compressed_scene(folder, capsys):
    for name in ("ring.ply", "ring.bsm"):
        assert run("glb", name, "-o", "scene.glb", "-f") == 0
        assert run("info", "scene.glb") == 0 and "scene of 1 primitives, 1 streams" in capsys.readouterr().out
        assert run("decode", "scene.glb", "-o", "back.ply", "-f") == 0
        assert run("compare", "ring.ply", "back.ply") == 0
    (folder / "moving").mkdir()
    for number in range(3):
        bsm.save(torus(16, 12), f"moving/{number}.ply")
    assert run("glb", "moving", "-o", "scene.glb", "-f") == 2
    advice = capsys.readouterr().err.strip().partition("Run: ")[2].split("; ")
    assert [run(*shlex.split(line)[1:]) for line in advice] == [0, 0]


def test_materials_and_images_count_as_input(folder, capsys):
    pillow = pytest.importorskip("PIL.Image", reason="needs Pillow (extra formats)")
    pixels = np.random.default_rng(1).integers(0, 255, (64, 64, 3)).astype(np.uint8)
    pillow.fromarray(pixels).save("skin.png")
    (folder / "skin.mtl").write_text("newmtl skin\nmap_Kd skin.png\n")
    corners = "".join(f"vt {x} {y}\n" for x, y in ((0, 0), (1, 0), (0, 1)))
    places = "".join(f"v {x} {y} {z}\n" for x, y, z in ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)))
    faces = "f 1/1 2/2 3/3\nf 1/1 4/2 2/3\nf 2/1 4/2 3/3\nf 1/1 3/2 4/3\n"
    (folder / "statue.obj").write_text(f"mtllib skin.mtl\n{places}{corners}usemtl skin\n{faces}")
    size = sum((folder / name).stat().st_size for name in ("statue.obj", "skin.mtl", "skin.png"))
    for words in (["encode", "statue.obj"], ["glb", "statue.obj", "-o", "statue.glb"]):
        assert run(*words) == 0
        assert f"{size} -> " in capsys.readouterr().err
