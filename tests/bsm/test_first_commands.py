"""What people type first works, or says what to type."""

import json
import shlex
from pathlib import Path

import numpy as np
import pytest

import bsm
from tests.bsm.program import run
from tests.shapes import torus


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A folder with a mesh in two formats, and a stream of it."""
    monkeypatch.chdir(tmp_path)
    mesh = torus(16, 12)
    for name in ("ring.ply", "ring.glb", "ring.bsm"):
        bsm.save(mesh, name)
    return tmp_path


def test_a_stream_may_have_any_name(folder, capsys):
    for name in ("wrong.glb", "wrong.gltf", "wrong.ply"):
        (folder / "ring.bsm").rename(name)
        for words in (
            ["info"],
            ["verify"],
            ["decode", "-f", "-o", "back.ply"],
            ["compare", "ring.ply"],
        ):
            assert run(*words, name) == 0, (words, name)
        (folder / name).rename("ring.bsm")
    assert run("encode", "ring.bsm", "-o", "x.bsm") == 3
    assert "decode it first" in capsys.readouterr().err


@pytest.mark.parametrize("away", [40.0, 3000.0, 2e6])
def test_single_precision_goes_back_from_any_place(folder, away, capsys):
    bsm.save(
        bsm.TriangleMesh((torus(16, 12).positions + away).astype(np.float32), torus(16, 12).faces),
        "far.stl",
    )
    assert run("encode", "far.stl", "-f") == 0
    for name in ("back.stl", "back.glb", "back.ply"):
        assert run("decode", "-f", "far.bsm", "-o", name) == 0
        error = np.abs(
            bsm.load(name).positions.mean(axis=0) - bsm.load("far.stl").positions.mean(axis=0)
        ).max()
        assert error < 0.02 + 1e-7 * away
    bsm.save(
        bsm.TriangleMesh(torus(16, 12).positions / 3 + away, torus(16, 12).faces), "double.ply"
    )
    assert run("encode", "double.ply", "-f") == 0
    assert (
        run("decode", "double.bsm", "-o", "double.stl") == 3
        and "--float32" in capsys.readouterr().err
    )
    assert run("decode", "double.bsm", "-o", "double.stl", "--float32") == 0


def test_a_bare_number_is_questioned(folder, capsys):
    diagonal = f"{0.05 * bsm.load('ring.ply').diagonal:.3g} mm here"
    assert run("encode", "ring.ply", "-f", "--max-error", "0.05", "--meta", "unit=mm") == 2
    said = capsys.readouterr().err
    assert (
        "0.05 is 5 % of the diagonal" in said
        and diagonal in said
        and "5%" in said
        and "0.05mm" in said
    )
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
    # And in the table.
    assert said.count("but the mesh has no unit") == 1 + 4 and "4 files in all have no unit" in said
    size = f"{np.ptp(bsm.load('ring.ply').positions, axis=0).max():.3g}"
    assert f"is it {size} m or {size} mm long?" in said and "--meta unit=m" in said


def test_errors_are_in_the_unit_that_was_asked_for(folder, capsys):
    words = ["encode", "ring.ply", "-f", "--meta", "unit=m", "--max-error", "5mm"]
    assert run(*words, "--report", "r.json") == 0
    said = capsys.readouterr().err
    facts = json.loads((folder / "r.json").read_text())
    error = facts["files"][0]["max_error"]
    assert facts["files"][0]["unit"] == "mm" and 0 < error <= 5
    assert said.count(f"{error:.3g} mm") == 2, "in the table, and the largest"
    assert facts["totals"]["largest_error"] == f"{error:.3g} mm (ring.ply)"
    back, vertices = bsm.load("ring.bsm").positions, bsm.load("ring.ply").positions
    farthest = max(np.linalg.norm(vertices - place, axis=1).min() for place in back)
    assert 1e3 * farthest == pytest.approx(error, rel=0.01), "the mesh is in meters"
    assert run(*words, "--json") == 0
    assert json.loads(capsys.readouterr().out)["unit"] == "mm"


def test_any_mesh_becomes_a_compressed_scene(folder, capsys):
    for name in ("ring.ply", "ring.bsm"):
        assert run("glb", name, "-o", "scene.glb", "-f") == 0
        assert (
            run("info", "scene.glb") == 0
            and "scene of 1 primitive, 1 stream\n" in capsys.readouterr().out
        )
        assert run("decode", "scene.glb", "-o", "back.ply", "-f") == 0
        assert run("compare", "ring.ply", "back.ply") == 0
    (folder / "moving").mkdir()
    for number in range(3):
        bsm.save(torus(16, 12), f"moving/{number}.ply")
    assert run("glb", "moving", "-o", "scene.glb", "-f") == 2
    advice = capsys.readouterr().err.strip().partition("Run: ")[2].split("; ")
    assert [run(*shlex.split(line)[1:]) for line in advice] == [0, 0]


@pytest.fixture
def statue(folder):
    """An OBJ with a material and a picture of noise; the size of all three files."""
    pillow = pytest.importorskip("PIL.Image", reason="needs Pillow (extra formats)")
    pixels = np.random.default_rng(1).integers(0, 255, (64, 64, 3)).astype(np.uint8)
    pillow.fromarray(pixels).save("skin.png")
    (folder / "skin.mtl").write_text("newmtl skin\nmap_Kd skin.png\n")
    corners = "".join(f"vt {x} {y}\n" for x, y in ((0, 0), (1, 0), (0, 1)))
    places = "".join(f"v {x} {y} {z}\n" for x, y, z in ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)))
    faces = "f 1/1 2/2 3/3\nf 1/1 4/2 2/3\nf 2/1 4/2 3/3\nf 1/1 3/2 4/3\n"
    (folder / "statue.obj").write_text(f"mtllib skin.mtl\n{places}{corners}usemtl skin\n{faces}")
    return sum((folder / name).stat().st_size for name in ("statue.obj", "skin.mtl", "skin.png"))


def test_materials_and_images_count_as_input(statue, capsys):
    for words in (["encode", "statue.obj"], ["glb", "statue.obj", "-o", "statue.glb"]):
        assert run(*words) == 0
        said = capsys.readouterr().err
        assert f"{statue} -> " in said and "--images webp:85 makes them smaller" in said


def test_images_are_written_anew(statue, folder, capsys):
    assert run("encode", "statue.obj", "--images", "webp:50") == 0
    assert "unchanged" not in capsys.readouterr().err
    assert run("encode", "statue.obj", "-o", "large.bsm") == 0
    sizes = [(folder / name).stat().st_size for name in ("statue.bsm", "large.bsm")]
    assert sizes[0] < 0.5 * sizes[1]
    (folder / "back").mkdir()
    for output in ("back/statue.obj", "back/statue.glb"):
        assert run("decode", "statue.bsm", "-o", output) == 0
    assert (folder / "back/statue.0.webp").read_bytes()[8:12] == b"WEBP"
    assert "statue.0.webp" in next((folder / "back").glob("*.mtl")).read_text()
    assert b"EXT_texture_webp" in (folder / "back/statue.glb").read_bytes()
    assert run("encode", "statue.obj", "-f", "--images", "gif") == 2
    assert "webp:85" in capsys.readouterr().err


@pytest.fixture
def walk(folder):
    """A sequence of twelve frames, and the scene that `bsm glb` makes of it."""
    frames = np.array([torus(16, 12).positions + 0.1 * number for number in range(12)])
    np.savez("walk.npz", positions=frames, faces=torus(16, 12).faces)
    assert (
        run("encode", "walk.npz", "-q") == 0 and run("glb", "walk.bsm", "-o", "walk.glb", "-q") == 0
    )
    return frames


def test_one_frame_is_one_file(walk, capsys):
    for name in ("frame3.obj", "frame3.ply", "frame3.stl"):
        assert run("decode", "walk.bsm", "--frames", "3:4", "-o", name) == 0
        low = bsm.load(name).positions.min(axis=0)
        assert np.allclose(low, walk[3].min(axis=0), atol=0.05), "frames count from 0"
    assert run("decode", "walk.bsm", "-o", "all.obj") == 2
    said = capsys.readouterr().err
    assert "all-%04d.obj" in said and "--frames 0:1" in said
    assert (
        run("decode", "walk.bsm", "-o", "all-%04d.obj") == 0
        and bsm.load("all-0011.obj") is not None
    )


def test_the_scene_of_a_sequence_is_read(walk, folder, capsys):
    assert run("decode", "walk.glb", "-o", "back.npz") == 0
    assert np.load("back.npz")["positions"].shape == walk.shape
    assert run("decode", "walk.glb", "--frames", "2:3", "-o", "two.ply") == 0
    for pair in (("walk.npz", "walk.glb"), ("walk.glb", "walk.bsm"), ("walk.glb", "walk.glb")):
        assert run("compare", *pair) == 0, pair
    assert "worst_frame" in capsys.readouterr().out
    assert run("verify", "walk.glb") == 0 and "1 stream" in capsys.readouterr().err
    assert run("verify", "ring.glb") == 3 and "no streams" in capsys.readouterr().err
    assert run("compare", "walk.npz", "ring.ply") == 3
    said = capsys.readouterr().err
    assert "bsm." not in said.replace("walk.npz", "") and "--animation" not in said


def test_folders_are_decoded_verified_and_compared(folder, capsys):
    for name in ("scans/a.ply", "scans/deep/b.obj"):
        (folder / name).parent.mkdir(exist_ok=True)
        bsm.save(torus(16, 12), name)
    assert run("encode", "-r", "scans", "-o", "small", "--meta", "unit=mm") == 0
    assert "of 2 files" in (said := capsys.readouterr().err) and "mm (scans/" in said, (
        "the largest error, in units"
    )
    assert run("verify", "small") == 2 and "verify -r" in capsys.readouterr().err
    assert run("verify", "-r", "small") == 0 and "2 of 2 files" in capsys.readouterr().err
    assert run("decode", "-r", "small", "-o", "back") == 0
    assert {path.name for path in (folder / "back").rglob("*.ply")} == {"a.ply", "b.ply"}
    assert run("compare", "-r", "scans", "back") == 0
    assert "2 of 2 files compared; largest vertex error" in capsys.readouterr().out
    assert run("compare", "-r", "scans", "small") == 0
    assert capsys.readouterr().out.count(" mm") == 5, (
        "the unit of the streams, with two errors each, and the largest"
    )
    (folder / "back/a.ply").unlink()
    assert run("compare", "-r", "scans", "back", "--json") == 9
    files = json.loads(capsys.readouterr().out)["files"]
    assert [file["exit"] for file in files if "error" in file] == [9]
    assert run("decode", "-r", "scans") == 2 and "no streams in" in capsys.readouterr().err


@pytest.mark.parametrize("given", [("info",), ("encode", "-o", "x.bsm", "--format", "glb")])
def test_a_command_that_is_named_can_be_pasted_whatever_the_file_is_called(folder, capsys, given):
    (folder / "a; touch b.ply").write_bytes((folder / "ring.ply").read_bytes())
    assert run(*given, "a; touch b.ply") != 0
    assert "a; touch b.ply" in shlex.split(capsys.readouterr().err.partition("run: ")[2])
    (folder / "my scans").mkdir()
    assert run("decode", "my scans") != 0
    assert "my scans" in shlex.split(
        capsys.readouterr().err.partition("run: ")[2].partition(";")[0]
    )


@pytest.mark.parametrize("pattern", ["walk", "walk/w_####.ply", "walk/w_%04d.ply", "walk/*.ply"])
def test_frames_are_named_in_each_usual_way(walk, pattern, capsys):
    assert run("decode", "walk.bsm", "-o", "walk/w_####.ply") == 0
    assert sorted(path.name for path in Path("walk").iterdir())[0] == "w_0000.ply"
    frames = len(walk)
    # Streams of an earlier run in the same folder are not input.
    assert run("encode", "walk/w_0000.ply", "-q") == 0
    assert run("encode", "-f", "--json", pattern, "-o", "all.bsm") == 0
    facts = json.loads(capsys.readouterr().out)
    assert facts["frames"] == frames
    assert facts["input_bytes"] == sum(path.stat().st_size for path in Path("walk").glob("*.ply"))
    assert run("encode", "-f", "--json", pattern, "--frames", "2:5", "-o", "some.bsm") == 0
    assert json.loads(capsys.readouterr().out)["frames"] == 3
    some, all_frames = (bsm.decode_sequence(name)[0] for name in ("some.bsm", "all.bsm"))
    assert np.allclose(some.mean(axis=1), all_frames[2:5].mean(axis=1), atol=0.02)
    assert run("encode", "-f", pattern, "--frames", "40:50", "-o", "none.bsm") == 2


def test_a_range_of_frames_is_taken_from_each_kind_of_sequence(walk, capsys):
    for name in ("walk.npz", "walk.pc2"):
        if name.endswith("pc2"):
            assert run("decode", "walk.bsm", "-o", "walk.pc2") == 0
        capsys.readouterr()
        assert run("encode", "-f", "--json", name, "--frames", "2:5", "-o", "some.bsm") == 0
        assert json.loads(capsys.readouterr().out)["frames"] == 3
    assert run("encode", "ring.ply", "--frames", "2:5") == 2
    assert run("encode", "walk.npz", "--frames", "5:2") == 2


@pytest.mark.parametrize(
    ("name", "meant"), [("units", "unit=mm"), ("up_axis", "up=mm"), ("FPS", "frame_rate=mm")]
)
def test_metadata_under_a_name_that_nothing_reads_are_questioned(folder, capsys, name, meant):
    assert run("encode", "ring.ply", "-f", "--meta", f"{name}=mm") == 2
    assert meant in capsys.readouterr().err
