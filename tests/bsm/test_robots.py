"""Folders of parts in several formats that share images: what a robot is made of."""

from pathlib import Path

import numpy as np
import pytest

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


def test_a_folder_comes_back_under_its_names(robot, capsys):
    assert main(["encode", "-r", "robot", "-o", "small", "--images", "none"]) == 0
    assert f"6 of 6 files, {robot} -> " in capsys.readouterr().err, "an image of several meshes counts once"
    size = Path("robot/skin.png").stat().st_size
    assert all(path.stat().st_size < size for path in Path("small").rglob("*.bsm"))
    assert main(["compare", "-r", "robot", "small"]) == 0
    assert "6 of 6 files compared" in capsys.readouterr().out
    assert main(["decode", "-r", "small", "-o", "back", "--format", "same"]) == 0
    assert files_of("back") == {name for name in files_of("robot") if not name.endswith(".png")}
    assert "map_Kd skin.png" in Path("back/arm/foot.mtl").read_text()
    assert main(["compare", "-r", "robot", "back"]) == 0


def test_coordinates_are_scaled_to_the_unit_that_is_asked_for(robot):
    assert main(["encode", "robot/hand.STL", "-o", "hand.bsm", "--meta", "unit=in"]) == 0
    assert main(["decode", "hand.bsm", "-o", "hand.ply", "--unit-out", "m"]) == 0
    own, scaled = (np.ptp(read_mesh(name).mesh.positions, axis=0) for name in ("robot/hand.STL", "hand.ply"))
    np.testing.assert_allclose(scaled, 0.0254 * own, rtol=0.02)
    assert main(["decode", "hand.bsm", "-f", "-o", "hand.ply", "--unit-out", "parsec"]) == 2
    assert main(["encode", "robot/hand.STL", "-f", "-o", "hand.bsm"]) == 0
    assert main(["decode", "hand.bsm", "-f", "-o", "hand.ply", "--unit-out", "m"]) == 2
