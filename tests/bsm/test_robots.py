"""Folders of parts in several formats that share images: what a robot is made of."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bsm
from bsm import read_mesh
from bsm.cli import main
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
        bsm.save(SHAPE, folder / "hand.STL")
    return sum(path.stat().st_size for path in Path("robot").rglob("*") if path.is_file())


def files_of(folder):
    return {
        str(path.relative_to(folder))
        for path in Path(folder).rglob("*")
        if path.suffix not in (".mtl", "")
    }


def test_a_shared_image_is_stored_once_and_a_folder_comes_back_under_its_names(robot, capsys):
    assert main(["encode", "-r", "robot", "-o", "small"]) == 0
    said, image = capsys.readouterr().err, Path("robot/skin.png").read_bytes()
    assert (
        "1 image of several meshes" in said
        and " texels" in said
        and f"6 of 6 files, {robot} -> " in said
    )
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
            bsm.save(
                bsm.TriangleMesh(SHAPE.positions, SHAPE.faces, (), {"image.0.link": link}),
                "hand.bsm",
            )
        assert main(["decode", "hand.bsm", "-f", "-o", "out.obj"]) == 0
        assert ("which is missing" in capsys.readouterr().err) == bool(link)


def test_coordinates_are_scaled_to_the_unit_that_is_asked_for(robot):
    assert main(["encode", "robot/hand.STL", "-o", "hand.bsm", "--meta", "unit=in"]) == 0
    assert main(["decode", "hand.bsm", "-o", "hand.ply", "--unit-out", "m"]) == 0
    own, scaled = (
        np.ptp(read_mesh(name).mesh.positions, axis=0) for name in ("robot/hand.STL", "hand.ply")
    )
    np.testing.assert_allclose(scaled, 0.0254 * own, rtol=0.02)
    with pytest.raises(SystemExit):
        main(["decode", "hand.bsm", "-o", "hand.ply", "--unit-out", "parsec"])
    assert main(["encode", "robot/hand.STL", "-f", "-o", "hand.bsm"]) == 0
    assert main(["decode", "hand.bsm", "-f", "-o", "hand.ply", "--unit-out", "m"]) == 0
    np.testing.assert_allclose(np.ptp(read_mesh("hand.ply").mesh.positions, axis=0), own, rtol=0.02)


URDF = """<robot name="arm">
<link name="base"><visual><geometry><mesh filename="package://arm/meshes/base.dae"/></geometry></visual></link>
<link name="hand"><visual><geometry>
<mesh filename="package://arm/meshes/hand.stl" scale="0.001 0.001 0.001"/></geometry></visual></link>
<joint name="j" type="revolute"><parent link="base"/><child link="hand"/><origin xyz="0 0 0.3" rpy="0.1 0.2 0.3"/>
<axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>
"""


def write_dae_of_a_maker(path: Path, unit: float) -> None:
    """A DAE in centimeters whose z axis points up, written by pycollada itself."""
    collada = pytest.importorskip("collada")
    document = collada.Collada()
    document.assetInfo.upaxis, document.assetInfo.unitmeter, document.assetInfo.unitname = (
        "Z_UP",
        unit,
        "centimeter",
    )
    effect = collada.material.Effect("e", [], "phong", diffuse=(0.8, 0.2, 0.1, 1))
    material = collada.material.Material("m", "orange", effect)
    document.effects.append(effect)
    document.materials.append(material)
    places = collada.source.FloatSource(
        "v", (SHAPE.positions * (3.0, 2.0, 1.0)).reshape(-1), ("X", "Y", "Z")
    )
    geometry = collada.geometry.Geometry(document, "g", "base", [places])
    inputs = collada.source.InputList()
    inputs.addInput(0, "VERTEX", "#v")
    geometry.primitives.append(geometry.createTriangleSet(SHAPE.faces.reshape(-1), inputs, "r"))
    document.geometries.append(geometry)
    shown = collada.scene.GeometryNode(
        geometry, [collada.scene.MaterialNode("r", material, inputs=[])]
    )
    document.scene = collada.scene.Scene("s", [collada.scene.Node("base", children=[shown])])
    document.scenes.append(document.scene)
    with path.open("wb") as file:
        document.write(file)


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    for folder in ("arm/meshes", "arm/urdf"):
        Path(folder).mkdir(parents=True)
    Path("arm/package.xml").write_text("<package><name>arm</name></package>\n")
    Path("arm/urdf/arm.urdf").write_text(URDF)
    Path("arm/notes.xml").write_text("<notes/>")
    Path("arm/scene.xml").write_text("<!-- a scene -->\n<mujoco/>")
    write_dae_of_a_maker(Path("arm/meshes/base.dae"), 0.01)
    bsm.save(bsm.TriangleMesh(1000 * SHAPE.positions, SHAPE.faces), "arm/meshes/hand.stl")
    return tmp_path


def test_a_package_loads_as_before(package: Path, capsys: pytest.CaptureFixture[str]) -> None:
    loader = pytest.importorskip("yourdfpy")
    assert main(["encode", "-r", "arm", "-o", "small", "--preset", "near-lossless"]) == 0
    assert (
        "copied 3 files that refer to meshes: arm.urdf, package.xml, scene.xml"
        in capsys.readouterr().err
    )
    assert main(["decode", "-q", "-r", "small", "-o", "back", "--format", "same"]) == 0
    scenes = []
    for folder in ("arm", "back"):
        place = f"{package}/{folder}"
        robot = loader.URDF.load(
            f"{folder}/urdf/arm.urdf",
            filename_handler=lambda fname, to=place: fname.replace("package://arm", to),
        )
        scenes.append(robot.scene)
    before, after = scenes
    assert len(before.geometry) == len(after.geometry) == 2
    size = np.ptp(before.bounds, axis=0).max()
    assert np.abs(before.bounds - after.bounds).max() <= 1e-3 * size
    poses = [
        sorted(scene.graph.get(node)[0].tolist() for node in scene.graph.nodes_geometry)
        for scene in scenes
    ]
    assert np.abs(np.subtract(*poses)).max() == 0
    for one, other in zip(before.geometry.values(), after.geometry.values(), strict=True):
        assert np.abs(one.bounds - other.bounds).max() <= 1e-3 * np.ptp(one.bounds, axis=0).max()


# Of pycollada, which has matrices of numpy.
@pytest.mark.filterwarnings("ignore::PendingDeprecationWarning")
def test_a_dae_comes_back_in_its_axes_units_and_names(package: Path) -> None:
    collada = pytest.importorskip("collada")
    assert main(["encode", "-q", "-f", "-r", "arm", "-o", "small", "--preset", "lossless"]) == 0
    assert main(["decode", "-q", "-r", "small", "-o", "back", "--format", "same"]) == 0
    before, after = (collada.Collada(f"{folder}/meshes/base.dae") for folder in ("arm", "back"))
    assert after.errors == []
    assert (after.assetInfo.upaxis, after.assetInfo.unitmeter) == ("Z_UP", 0.01)
    assert after.materials[0].name == "orange" and after.effects[0].diffuse == (0.8, 0.2, 0.1, 1.0)
    assert vertices_of(before) == vertices_of(after)


def vertices_of(document: Any) -> set[tuple[float, ...]]:
    """The places of all vertices of the scene of a DAE, as pycollada finds them."""
    shapes = [shape for bound in document.scene.objects("geometry") for shape in bound.primitives()]
    return {tuple(row) for shape in shapes for row in shape.vertex.tolist()}


def test_descriptions_are_not_overwritten(package: Path) -> None:
    assert main(["encode", "-q", "-r", "arm", "-o", "small"]) == 0
    Path("small/urdf/arm.urdf").write_text("mine")
    assert main(["encode", "-q", "-r", "arm", "-o", "small"]) == 9
    assert Path("small/urdf/arm.urdf").read_text() == "mine"
    assert main(["encode", "-q", "-f", "-r", "arm", "-o", "small"]) == 0
    assert Path("small/urdf/arm.urdf").read_text() == URDF
