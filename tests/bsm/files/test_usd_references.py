"""USD whose parts are elsewhere: images in packages and behind connections, and instances that come and go."""

import base64

import numpy as np
import pytest

import bsm
from bsm.files.formats.metadata import images_in
from tests.motion import sequence_in

pytest.importorskip("pxr")
PNG = base64.b64decode(
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=="
)
MESH = """
    def Mesh "q" (prepend apiSchemas = ["MaterialBindingAPI"]) {
        int[] faceVertexCounts = [4]
        int[] faceVertexIndices = [0, 1, 2, 3]
        uniform token subdivisionScheme = "none"
        point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
        texCoord2f[] primvars:st = [(0, 0), (1, 0), (1, 1), (0, 1)] (interpolation = "vertex")
        rel material:binding = </R/M>
    }
"""
LOOK = """
    def Material "M" {
        %(above)s
        token outputs:surface.connect = </R/M/S.outputs:surface>
        def Shader "S" {
            uniform token info:id = "UsdPreviewSurface"
            color3f inputs:diffuseColor.connect = </R/M/T.outputs:rgb>
            token outputs:surface
        }
        def Shader "T" {
            uniform token info:id = "UsdUVTexture"
            %(file)s
            float3 outputs:rgb
        }
    }
"""


def stage(body):
    return f'#usda 1.0\n(\n    defaultPrim = "R"\n)\ndef Xform "R" {{{body}}}\n'


def test_the_image_of_a_texture_is_found_through_the_interface_of_its_material(tmp_path):
    (tmp_path / "t.png").write_bytes(PNG)
    look = LOOK % {
        "above": "asset inputs:image = @t.png@",
        "file": "asset inputs:file.connect = </R/M.inputs:image>",
    }
    (tmp_path / "a.usda").write_text(stage(MESH + look))
    found = bsm.read_mesh(tmp_path / "a.usda")
    assert images_in(found.mesh.metadata) == {0: ("t.png", PNG)}


def test_images_of_a_package_that_is_referenced_are_in_the_package(tmp_path):
    from pxr import UsdUtils

    (tmp_path / "made").mkdir()
    (tmp_path / "made" / "t.png").write_bytes(PNG)
    look = LOOK % {"above": "", "file": "asset inputs:file = @t.png@"}
    (tmp_path / "made" / "a.usda").write_text(stage(MESH + look))
    assert UsdUtils.CreateNewUsdzPackage(
        str(tmp_path / "made" / "a.usda"), str(tmp_path / "a.usdz")
    )
    (tmp_path / "b.usda").write_text('#usda 1.0\ndef "R" (\n    references = @a.usdz@</R>\n) {}\n')
    found = bsm.read_mesh(tmp_path / "b.usda")
    assert [data for _, data in images_in(found.mesh.metadata).values()] == [PNG]
    assert not any("left out" in note for note in found.notes)


@pytest.mark.parametrize("counts", [[1, 2, 3], [3, 1, 2]])
def test_instances_that_come_and_go_are_shown_with_runs(counts, tmp_path):
    places = "".join(
        f"{n}: {[(3 * i, 0, 0) for i in range(count)]},\n" for n, count in enumerate(counts)
    )
    kinds = "".join(f"{n}: {[0] * count},\n" for n, count in enumerate(counts))
    instancer = (
        'def PointInstancer "i" {\npoint3f[] positions.timeSamples = {\n' + places + "}\n"
        "int[] protoIndices.timeSamples = {\n" + kinds + "}\nrel prototypes = </R/i/P/q>\n\n"
        'def "P" {\n' + MESH.replace("rel material:binding = </R/M>", "") + "}\n}\n"
    )
    head = (
        "#usda 1.0\n(\n    startTimeCode = 0\n    endTimeCode = 2\n    timeCodesPerSecond = 24\n)\n"
    )
    (tmp_path / "a.usda").write_text(head + stage(instancer).partition(")\n")[2])
    frames = sequence_in(str(tmp_path / "a.usda"), runs=True)
    assert [len(np.unique(mesh.faces)) for mesh in frames.meshes] == [4 * count for count in counts]
    assert any("appear, vanish" in note for note in bsm.read_mesh(tmp_path / "a.usda").notes)


VARIANTS = """#usda 1.0
def Xform "R" (
    variants = { string shape = "low" }
    prepend variantSets = "shape"
) {
    variantSet "shape" = {
        "low" {
            %s 1)]
            }
        }
        "high" {
            %s 9)]
            }
        }
    }
}
"""
TRIANGLE = """def Mesh "q" {
            int[] faceVertexCounts = [3]
            int[] faceVertexIndices = [0, 1, 2]
            point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1,"""


def test_variants_that_are_not_chosen_are_named(tmp_path):
    (tmp_path / "a.usda").write_text(VARIANTS % (TRIANGLE, TRIANGLE))
    (tmp_path / "b.usda").write_text(
        '#usda 1.0\ndef "R" (\n    prepend references = @a.usda@</R>\n)\n{\n}\n'
    )
    for name in "ab":
        found = bsm.read_mesh(tmp_path / f"{name}.usda")
        assert found.mesh.positions[:, 2].max() == 1
        assert "left out, variants that are not chosen: shape=high" in found.notes
