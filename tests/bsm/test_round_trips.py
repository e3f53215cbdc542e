"""Folders and files of museums, printers and animators, opened before and after by the libraries that they use."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bsm
from tests.bsm.program import run
from tests.shapes import torus

SHAPE = torus(24, 16)
BOUND = 0.01  # of the diagonal: largest vertex error of the default preset


@pytest.fixture
def museum(tmp_path, monkeypatch) -> dict[str, Any]:
    """A folder of rooms, each with an OBJ of two materials and their images; returns the images by their names."""
    pillow = pytest.importorskip("PIL.Image", reason="needs Pillow (extra formats)")
    monkeypatch.chdir(tmp_path)
    random = np.random.default_rng(5)
    images = {}
    half = len(SHAPE.faces) // 2
    places = "".join(f"v {x:.6f} {y:.6f} {z:.6f}\n" for x, y, z in SHAPE.positions)
    flat = "".join(f"vt {x / 4 + 0.5:.4f} {y / 4 + 0.5:.4f}\n" for x, y in SHAPE.positions[:, :2])
    lines = [f"f {a}/{a} {b}/{b} {c}/{c}\n" for a, b, c in SHAPE.faces + 1]
    for room in ("scans/Saal 1", "scans/Saal 2"):
        Path(room).mkdir(parents=True)
        library = ""
        for material in ("wood", "gold"):
            pixels = random.integers(0, 255, (16, 16, 3)).astype(np.uint8)
            pillow.fromarray(pixels).save(f"{room}/{material}.png")
            images[f"{room}/{material}"] = pixels
            library += (
                f"newmtl {material}\nKd 1 1 1\nKs 0.25 0.5 0.75\nNs 20\nmap_Kd {material}.png\n"
            )
        Path(room, "bust.mtl").write_text(library)
        faces = f"usemtl wood\n{''.join(lines[:half])}usemtl gold\n{''.join(lines[half:])}"
        Path(room, "bust.obj").write_text(f"mtllib bust.mtl\n{places}{flat}{faces}")
    assert run("encode", "-r", "scans", "-o", "small", "-q") == 0
    assert run("verify", "-r", "small", "-q") == 0
    assert run("decode", "-r", "small", "-o", "back", "--format", "same", "-q") == 0
    return images


def materials_by_trimesh(path: str) -> dict[str, Any]:
    """Return the image, specular color and size of each material of a file, as trimesh reads it."""
    trimesh = pytest.importorskip("trimesh")
    scene = trimesh.load(path, process=False, force="scene")
    found = {}
    for part in scene.geometry.values():
        material = part.visual.material
        pixels = np.asarray(material.image.convert("RGB"))
        found[material.name] = (
            pixels,
            np.asarray(material.specular)[:3],
            len(part.faces),
            part.bounds,
        )
    return found


@pytest.mark.parametrize("room", ["Saal 1", "Saal 2"])
def test_materials_and_images_of_a_museum_are_those_that_trimesh_read_before(museum, room):
    before, after = (
        materials_by_trimesh(f"{folder}/{room}/bust.obj") for folder in ("scans", "back")
    )
    assert before.keys() == after.keys() == {"wood", "gold"}
    for name, (pixels, specular, count, bounds) in before.items():
        np.testing.assert_array_equal(pixels, museum[f"scans/{room}/{name}"])
        np.testing.assert_array_equal(after[name][0], pixels)
        np.testing.assert_array_equal(after[name][1], specular)
        assert after[name][2] == count
        np.testing.assert_allclose(after[name][3], bounds, atol=BOUND * SHAPE.diagonal)


def test_images_of_a_museum_are_those_that_pymeshlab_read_before(museum):
    pymeshlab, pillow = pytest.importorskip("pymeshlab"), pytest.importorskip("PIL.Image")

    def texture_pixels(path: str) -> list[bytes]:
        meshes = pymeshlab.MeshSet()
        meshes.load_new_mesh(path)
        mesh = meshes.current_mesh()
        assert mesh.has_wedge_tex_coord() and mesh.face_number() == len(SHAPE.faces)
        pixels = []
        for image in mesh.textures().values():
            image.save("texture.png")
            pixels.append(pillow.open("texture.png").convert("RGB").tobytes())
        return sorted(pixels)

    before = texture_pixels("scans/Saal 1/bust.obj")
    assert len(before) == 2 and before == texture_pixels("back/Saal 1/bust.obj")


def box_by_lib3mf(path: str) -> tuple[str, Any, int]:
    """Return the unit, the box and the number of triangles of a 3MF, as lib3mf reads it."""
    lib3mf = pytest.importorskip("lib3mf")
    model = lib3mf.get_wrapper().CreateModel()
    model.QueryReader("3mf").ReadFromFile(path)
    objects = model.GetMeshObjects()
    objects.MoveNext()
    mesh = objects.GetCurrentMeshObject()
    places = np.array([list(vertex.Coordinates) for vertex in mesh.GetVertices()])
    return lib3mf.ModelUnit(model.GetUnit()).name, np.ptp(places, axis=0), mesh.GetTriangleCount()


def test_a_printed_part_keeps_its_unit_and_size(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    part = bsm.TriangleMesh(
        SHAPE.positions * 20, SHAPE.faces, metadata={"unit": "mm", "name": "ring"}
    )
    bsm.save(part, "ring.3mf")
    assert run("encode", "ring.3mf", "--max-error", "0.02mm", "-q") == 0
    assert run("decode", "ring.bsm", "-o", "back.3mf", "-q") == 0
    before, after = map(box_by_lib3mf, ("ring.3mf", "back.3mf"))
    assert before[0] == after[0] == "MilliMeter" and before[2] == after[2] == len(SHAPE.faces)
    np.testing.assert_allclose(after[1], before[1], atol=0.04)
    # A program for printing takes an STL in millimeters, as most do.
    assert run("decode", "ring.bsm", "-o", "inches.stl", "--unit-out", "in", "-q") == 0
    trimesh = pytest.importorskip("trimesh")
    inches = trimesh.load("inches.stl")
    np.testing.assert_allclose(25.4 * inches.extents, before[1], atol=0.05)
    assert inches.is_watertight and len(inches.faces) == len(SHAPE.faces)


def test_an_stl_with_a_unit_becomes_a_3mf_of_that_unit(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    bsm.save(SHAPE, "ring.stl")
    assert run("encode", "ring.stl", "--meta", "unit=in", "-q") == 0
    assert run("decode", "ring.bsm", "-o", "ring.3mf", "-q") == 0
    unit, box, count = box_by_lib3mf("ring.3mf")
    assert unit == "Inch" and count == len(SHAPE.faces)
    np.testing.assert_allclose(
        box, np.ptp(SHAPE.positions, axis=0), atol=2 * BOUND * SHAPE.diagonal
    )


@pytest.mark.parametrize("pattern", ["shot/walk_####.obj", "shot/walk_%04d.obj"])
def test_frames_come_back_under_their_numbers(tmp_path, monkeypatch, pattern):
    trimesh = pytest.importorskip("trimesh")
    monkeypatch.chdir(tmp_path)
    Path("shot").mkdir()
    frames = {number: SHAPE.positions + 0.05 * (number - 1001) for number in range(1001, 1007)}
    for number, frame in frames.items():
        bsm.save(bsm.TriangleMesh(frame, SHAPE.faces), f"shot/walk_{number}.obj")
    assert run("encode", pattern, "-o", "walk.bsm", "--keep-order", "-q") == 0
    assert run("decode", "walk.bsm", "-o", pattern.replace("shot", "back"), "-q") == 0
    assert {path.name for path in Path("back").glob("*.obj")} == {
        f"walk_{number}.obj" for number in frames
    }
    for number, frame in frames.items():
        read = trimesh.load(f"back/walk_{number}.obj", process=False)
        np.testing.assert_array_equal(read.faces, SHAPE.faces)
        assert np.abs(read.vertices - frame).max() < BOUND * SHAPE.diagonal
