"""Materials of USD: what Blender writes is read, and what is written here usd-core reads."""

import shutil
import zipfile
from pathlib import Path

import numpy as np
import pytest

import bsm
from bsm import read_mesh
from bsm.cli import main
from tests.motion import sequence_in

PAINTED = Path(__file__).parent / "moving" / "painted.usdz"
"""A ball in red and a box in red and a texture; it moves. Made in Blender."""
pytest.importorskip("pxr.Usd")


def found_in(path):
    source = sequence_in(str(path))
    assert source is not None
    return source


def of_faces(source, name):
    return next(attribute for attribute in source.attributes if attribute.name == name).values[:, 0]


def materials_of(source):
    """Return the entries of each material by name, with the bytes of its image and its number of faces."""
    found = {}
    for number, count in zip(
        *np.unique(of_faces(source, "material"), return_counts=True), strict=True
    ):
        begin = f"material.{number}."
        words = {
            name.removeprefix(begin): value
            for name, value in source.metadata.items()
            if name.startswith(begin)
        }
        if "baseColorTexture" in words:
            words["baseColorTexture"] = source.metadata[f"image.{words['baseColorTexture']}.data"]
        found[words.pop("name")] = (words, int(count))
    return found


EXPECTED = {
    "Red": {
        "baseColorFactor": "0.8 0.1 0.05 1",
        "metallicFactor": "1",
        "roughnessFactor": "0.5",
        "doubleSided": 1,
    },
    "Painted": {"metallicFactor": "0", "roughnessFactor": "0.25", "doubleSided": 1},
}


def test_materials_of_blender_come_in():
    with zipfile.ZipFile(PAINTED) as package:
        (image,) = (package.read(name) for name in package.namelist() if name.endswith(".png"))
    source = found_in(PAINTED)
    metadata = materials_of(source)
    assert metadata["Red"] == (EXPECTED["Red"], 64 + 4)
    assert metadata["Painted"] == (EXPECTED["Painted"] | {"baseColorTexture": image}, 8)
    assert len(set(of_faces(source, "part"))) == 2
    texcoord = next(
        attribute for attribute in source.attributes if attribute.semantic == "texcoord"
    )
    assert texcoord.indices is not None and texcoord.indices.shape == (76, 3)
    assert {**read_mesh(PAINTED).mesh.metadata, "frame_start": 1.0} == source.metadata


def test_images_beside_a_stage_are_looked_for_there_alone(tmp_path):
    with zipfile.ZipFile(PAINTED) as package:
        package.extractall(tmp_path / "here")
    (stage,) = (tmp_path / "here").glob("*.usdc")
    assert materials_of(found_in(stage)) == materials_of(found_in(PAINTED))
    shutil.copy(stage, tmp_path / "alone.usdc")
    source = found_in(tmp_path / "alone.usdc")
    assert "image.0.data" not in source.metadata
    assert any("image" in note and "left out" in note for note in source.notes)


@pytest.mark.parametrize("kind", ["usdz", "usdc"])
def test_materials_there_and_back(kind, tmp_path, capsys):
    from pxr import Usd, UsdGeom, UsdShade

    stream, back = tmp_path / "painted.bsm", tmp_path / f"back.{kind}"
    assert main(["encode", str(PAINTED), "-o", str(stream)]) == 0
    capsys.readouterr()
    assert main(["decode", str(stream), "-o", str(back)]) == 0
    printed, shown = capsys.readouterr().err, found_in(back)
    before, after = materials_of(found_in(PAINTED)), None
    if kind == "usdz":
        after = materials_of(shown)
        assert "image" not in printed
    else:  # which has no images in it, and says so
        assert "the image" in printed
        assert not any(name.startswith("image.") for name in shown.metadata)
        del before["Painted"][0]["baseColorTexture"]
        after = materials_of(shown)
    assert after == before

    stage = Usd.Stage.Open(str(back))
    mesh = UsdGeom.Mesh(stage.GetDefaultPrim())
    valid, why = UsdGeom.Subset.ValidateFamily(
        mesh, UsdGeom.Tokens.face, UsdShade.Tokens.materialBind
    )
    assert valid, why
    subsets = UsdShade.MaterialBindingAPI(mesh).GetMaterialBindSubsets()
    bound = {
        str(UsdShade.MaterialBindingAPI(s).ComputeBoundMaterial()[0].GetPrim().GetName())
        for s in subsets
    }
    assert bound == {"Red", "Painted"}
    assert sum(len(subset.GetIndicesAttr().Get()) for subset in subsets) == 76


STAGE = """#usda 1.0
def Mesh "G" (prepend apiSchemas = ["MaterialBindingAPI"]) {
    point3f[] points = [(0,0,0),(1,0,0),(0,1,0)]
    int[] faceVertexCounts = [3]
    int[] faceVertexIndices = [0,1,2]
    rel material:binding = </M>
}
def Material "M" {
    color3f inputs:tint = (0, 1, 0)
    token outputs:surface.connect = </M/S.outputs:surface>
    def Shader "S" { uniform token info:id = "UsdPreviewSurface"
        %s
        token outputs:surface
    }
    def Shader "T" { uniform token info:id = "UsdUVTexture"
        asset inputs:file = @in/W.png@
        float3 outputs:rgb
    }
}
"""


@pytest.mark.parametrize(
    ("inputs", "words"),
    [
        ("", {"baseColorFactor": "0.18 0.18 0.18 1"}),
        ("color3f inputs:diffuseColor.connect = </M.inputs:tint>", {"baseColorFactor": "0 1 0 1"}),
        (
            "color3f inputs:emissiveColor.connect = </M/T.outputs:rgb>",
            {"emissiveFactor": "1 1 1", "emissiveTexture": 0},
        ),
        (
            "color3f inputs:diffuseColor = (1, 1, 0.5)\nfloat inputs:opacity = 0.25",
            {"baseColorFactor": "1 1 0.5 0.25"},
        ),
        ("color3f inputs:emissiveColor = (0, nan, 0)", {}),
    ],
)
def test_defaults_and_inputs_of_surfaces(inputs, words, tmp_path):
    """Defaults are values, and interfaces are followed."""
    (tmp_path / "in").mkdir()
    (tmp_path / "in" / "W.png").write_bytes(b"\x89PNG\r\n\x1a\n")
    (tmp_path / "a.usda").write_text(STAGE % inputs)
    mesh = read_mesh(tmp_path / "a.usda").mesh
    found = {key.removeprefix("material.0."): value for key, value in mesh.metadata.items()}
    assert mesh.attributes == () and ("emissiveFactor" in words) == ("emissiveFactor" in found)
    assert {"metallicFactor": "0", "roughnessFactor": "0.5", **words}.items() <= found.items()


def test_a_broken_stage_is_told_with_its_line(tmp_path):
    (tmp_path / "a.usda").write_text('#usda 1.0\ndef Mesh "a" {\n this is broken\n}\n')
    with pytest.raises(bsm.FormatError, match=r"a\.usda:3"):
        read_mesh(tmp_path / "a.usda")


@pytest.mark.parametrize("place", ["/World/crane", "/crane"])
def test_a_mesh_comes_back_under_its_own_path(tmp_path, place):
    from pxr import Usd, UsdGeom

    stage = Usd.Stage.CreateNew(str(tmp_path / "a.usda"))
    mesh = UsdGeom.Mesh.Define(stage, place)
    for time in (1, 2):
        mesh.CreatePointsAttr().Set([(0, 0, 0), (1, 0, 0), (0, time, 0)], time)
    mesh.CreateFaceVertexCountsAttr().Set([3])
    mesh.CreateFaceVertexIndicesAttr().Set([0, 1, 2])
    stage.Save()
    assert main(["encode", str(tmp_path / "a.usda")]) == 0
    assert main(["decode", str(tmp_path / "a.bsm"), "-o", str(tmp_path / "b.usda")]) == 0
    back = Usd.Stage.Open(str(tmp_path / "b.usda"))
    assert back.GetPrimAtPath(place).IsA(UsdGeom.Mesh)
    assert back.GetDefaultPrim().GetPath() == "/" + place.split("/")[1]
