"""Folders of parts in several formats that share images: what a robot is made of."""

from pathlib import Path

import numpy as np
import pytest

import bsm
from bsm.cli import main
from bsm.files.mesh import read_mesh, write_mesh
from tests.shapes import torus

SHAPE = torus(16, 12)


@pytest.fixture
def robot(tmp_path, monkeypatch):
    """Two folders with parts in two formats, and one image for all of them; returns the bytes of all files."""
    pillow = pytest.importorskip("PIL.Image", reason="needs Pillow (extra formats)")
    monkeypatch.chdir(tmp_path)
    noise = np.random.default_rng(1).integers(0, 255, (64, 64, 3)).astype(np.uint8)
    flat = "".join(f"vt {x:.4f} {y:.4f}\n" for x, y in SHAPE.positions[:, :2])
    places = "".join(f"v {x:.5f} {y:.5f} {z:.5f}\n" for x, y, z in SHAPE.positions)
    faces = "".join(f"f {a}/{a} {b}/{b} {c}/{c}\n" for a, b, c in SHAPE.faces + 1)
    for folder in (Path("robot"), Path("robot/arm")):
        folder.mkdir()
        pillow.fromarray(noise).save(folder / "skin.png")
        (folder / "skin.mtl").write_text("newmtl skin\nmap_Kd skin.png\n")
        for name in ("hand.obj", "foot.obj"):
            (folder / name).write_text(f"mtllib skin.mtl\n{places}{flat}usemtl skin\n{faces}")
        write_mesh(folder / "hand.STL", SHAPE)
    return sum(path.stat().st_size for path in Path("robot").rglob("*") if path.is_file())


def files_of(folder):
    return {str(path.relative_to(folder)) for path in Path(folder).rglob("*") if path.suffix not in (".mtl", "")}


def test_a_shared_image_is_stored_once_and_a_folder_comes_back_under_its_names(robot, capsys):
    assert main(["encode", "-r", "robot", "-o", "small"]) == 0
    said, image = capsys.readouterr().err, Path("robot/skin.png").read_bytes()
    assert "1 image of several meshes" in said and " texels" in said and f"6 of 6 files, {robot} -> " in said
    assert [path.read_bytes() for path in Path("small/images").iterdir()] == [image]
    streams = [path.stat().st_size for path in Path("small").rglob("*.bsm")]
    assert max(streams) < len(image) and f"-> {sum(streams) + len(image)} bytes" in said
    assert main(["compare", "-r", "robot", "small"]) == 0
    assert "6 of 6 files compared" in capsys.readouterr().out
    Path("small/cut.bsm").write_bytes(Path("small/foot.bsm").read_bytes()[:99])
    assert main(["decode", "-r", "small", "-o", "back", "--format", "same"]) == 12
    assert files_of("back") == files_of("robot")
    assert read_mesh("back/arm/foot.obj").mesh.metadata["image.0.data"] == image
    assert main(["compare", "-r", "robot", "back"]) == 0


def test_images_are_linked_kept_or_left_out(robot, capsys):
    image = Path("robot/skin.png").read_bytes()
    for rule in ("keep", "none", "link"):
        assert main(["encode", "robot/hand.obj", "-f", "-o", "hand.bsm", "--images", rule]) == 0
        assert (Path("hand.bsm").stat().st_size > len(image)) == (rule == "keep")
        assert Path("images").is_dir() == (rule == "link")
    assert bsm.load("hand.bsm").metadata["image.0.data"] == image
    assert main(["encode", "robot/hand.obj", "-o", "-", "--images", "link"]) == 2
    for link in ("", "../secret.png", f"images/../{32 * '0'}.png", f"images/{32 * '0'}.png"):
        if link:
            next(Path("images").iterdir()).write_bytes(b"another")
            bsm.save(bsm.TriangleMesh(SHAPE.positions, SHAPE.faces, (), {"image.0.link": link}), "hand.bsm")
        assert main(["decode", "hand.bsm", "-f", "-o", "out.obj"]) == 0
        assert ("which is not there" in capsys.readouterr().err) == bool(link)


def test_coordinates_are_scaled_to_the_unit_that_is_asked_for(robot):
    assert main(["encode", "robot/hand.STL", "-o", "hand.bsm", "--meta", "unit=in"]) == 0
    assert main(["decode", "hand.bsm", "-o", "hand.ply", "--unit-out", "m"]) == 0
    own, scaled = (np.ptp(read_mesh(name).mesh.positions, axis=0) for name in ("robot/hand.STL", "hand.ply"))
    np.testing.assert_allclose(scaled, 0.0254 * own, rtol=0.02)
    with pytest.raises(SystemExit):
        main(["decode", "hand.bsm", "-o", "hand.ply", "--unit-out", "parsec"])
    assert main(["encode", "robot/hand.STL", "-f", "-o", "hand.bsm"]) == 0
    assert main(["decode", "hand.bsm", "-f", "-o", "hand.ply", "--unit-out", "m"]) == 0
    np.testing.assert_allclose(np.ptp(read_mesh("hand.ply").mesh.positions, axis=0), own, rtol=0.02)
