"""Sequences in the files of other programs: read as those show them, written so that those read them."""

import json
import re
import shutil
import struct
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree

from bsm import (
    Attribute,
    BsmError,
    FormatError,
    LimitError,
    Limits,
    MeshError,
    OptionError,
    TriangleMesh,
    TruncatedError,
    decode_frames,
    encode_frames,
    read_mesh,
    save,
)
from bsm.files import conventions
from bsm.files.formats.metadata import named, names_in
from bsm.files.motion.folder import in_order, look_like_frames, times_in
from bsm.files.motion.frames import Shared, Wanted, painted_like
from bsm.files.sequence import open_frames, sequence_kind, sequence_writer
from bsm.gltf.scene import Keyframes, matrix_of, read_gltf
from tests.bsm.program import run as bsm
from tests.gltf import Built, glb, unpack
from tests.motion import animators_own, bending, save_frames, sequence_in
from tests.shapes import torus

MOVING = Path(__file__).parent / "moving"
"""What Blender 5.0.1 wrote, and what it showed at each of the 25 frames."""
COUNT = 6


def frames_of(path, **keywords):
    source = sequence_in(str(path), **keywords)
    return source, np.array(list(source.frames))


def needs(kind):
    if kind.startswith("usd"):
        pytest.importorskip("pxr.Usd")
    if kind == "glb":
        pytest.importorskip("trimesh")


@pytest.mark.parametrize("name", ["skinned", "morphing"])
@pytest.mark.parametrize("kind", ["glb", "usdc"])
def test_frames_are_those_that_blender_shows(name, kind):
    needs(kind)
    source, frames = frames_of(MOVING / f"{name}.{kind}")
    shown = np.load(MOVING / f"{name}.npz")["positions"].astype(np.float64)
    if kind == "glb":  # whose up is y
        shown = np.stack([shown[..., 0], shown[..., 2], -shown[..., 1]], axis=-1)
    assert frames.shape == shown.shape and source.count == 25 and source.frame_rate == 24
    assert np.ptp(shown, axis=0).max() > 0.3
    distance, same = cKDTree(shown[0]).query(frames[0])
    assert len(set(same)) == len(same) and distance.max() < 1e-5
    assert np.abs(frames - shown[:, same]).max() < 1e-5
    assert source.metadata["up"] == ("y" if kind == "glb" else "z")
    assert any(
        attribute.semantic == "texcoord" and attribute.domain == "corner"
        for attribute in source.attributes
    )


def test_an_animation_is_sampled_at_the_rate_that_is_asked_for():
    _, slow = frames_of(MOVING / "morphing.glb", rate=12)
    _, fast = frames_of(MOVING / "morphing.glb", rate=24)
    assert len(slow) == 13 and np.allclose(slow, fast[::2], atol=1e-6)


def painted(frames=COUNT):
    """A bending torus with texture coordinates at corners and colors."""
    positions, faces = bending(frames)
    positions = positions.astype(np.float32).astype(np.float64)
    corners = positions[0][faces][:, :, :2].reshape(-1, 2).astype(np.float32) * 0.3 + 0.5
    color = (np.abs(positions[0]) * 99).astype(np.uint8)
    attributes = (
        Attribute("texcoord", corners, "corner", "texcoord"),
        Attribute("color", color, "vertex", "color"),
    )
    return positions, faces, attributes


@pytest.mark.parametrize(
    "kind", ["pc2", "mdd", "glb", "usda", "usdc", "usdz", "obj", "ply", "off", "stl", "npz"]
)
def test_there_and_back(tmp_path, kind):
    needs(kind)
    positions, faces, attributes = painted()
    one_file = (
        sequence_kind(f"a.{kind}", None) if kind not in ("obj", "ply", "off", "stl") else None
    )
    path = tmp_path / (f"a.{kind}" if one_file else f"%02d.{kind}")
    shared = Shared(lambda: attributes, lambda: {"unit": "cm", "up": "z", "frame_rate": 25.0})
    save_frames(path, kind, positions, faces, shared)
    source, frames = frames_of(path)
    assert source.count == COUNT
    if kind == "stl":  # which has no vertices, but corners
        assert np.allclose(frames[:, source.faces], positions[:, faces], atol=1e-6)
        return
    if kind == "glb":  # whose up is y, and whose unit is a meter
        frames = 100 * np.stack([frames[..., 0], -frames[..., 2], frames[..., 1]], axis=-1)
    same = cKDTree(positions[0]).query(frames[0])[1]
    assert len(set(same)) == len(same) == positions.shape[1]
    assert np.abs(frames - positions[:, same]).max() < 1e-6
    assert np.array_equal(np.sort(same[source.faces]), np.sort(faces))
    holds = {"ply": {"color"}, "off": {"color"}, "npz": set(), "obj": {"texcoord", "color"}}
    assert {attribute.semantic for attribute in source.attributes} >= holds.get(
        kind, {"texcoord", "color"}
    ) - {"color" * (kind == "off")}
    assert source.frame_rate == (25 if kind in ("mdd", "glb", "usda", "usdc", "usdz") else 0)
    texcoord = next(
        (attribute for attribute in source.attributes if attribute.semantic == "texcoord"), None
    )
    if texcoord is not None:
        shown = (
            texcoord.values[texcoord.indices]
            if texcoord.indices is not None
            else texcoord.values[source.faces]
        )
        assert np.allclose(shown, positions[0][same[source.faces]][:, :, :2] * 0.3 + 0.5, atol=1e-5)
    if kind.startswith("usd"):
        assert (source.metadata["unit"], source.metadata["up"]) == ("centimeters", "z")


def test_a_glb_grows_with_the_frames_and_not_with_their_square(tmp_path):
    positions = (
        np.random.default_rng(0).normal(size=(1200, 4, 3)).astype(np.float32).astype(np.float64)
    )
    faces = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], np.int32)
    sizes = []
    for count in (300, 1200):
        path = tmp_path / f"{count}.glb"
        save_frames(path, "glb", positions[:count], faces)
        sizes.append(path.stat().st_size)
    assert sizes[1] < 4.2 * sizes[0]
    _, frames = frames_of(tmp_path / "1200.glb", rate=24.0)
    same = cKDTree(positions[0]).query(frames[0])[1]
    assert frames.shape == positions.shape and np.abs(frames - positions[:, same]).max() < 1e-3


def corners_of(path):
    """The faces that have an area: their vertices and texture coordinates, whatever corner is the first."""
    mesh = read_mesh(path).mesh
    (texcoord,) = mesh.attributes
    places = texcoord.values[texcoord.indices].round(3).tolist()
    faces = (
        zip(face, map(tuple, uv), strict=True)
        for face, uv in zip(mesh.faces.tolist(), places, strict=True)
    )
    return {
        found
        for found in map(frozenset, faces)
        if len(found) == 3 and len({v for v, _ in found}) == 3
    }


@pytest.mark.parametrize("kind", ["pc2", "mdd"])
def test_a_cache_comes_back_for_the_mesh_that_it_moves(tmp_path, capsys, kind):
    positions = animators_own(tmp_path)
    (tmp_path / "back").mkdir()
    own = (tmp_path / "rig.obj").read_bytes()
    (tmp_path / "back" / f"rig.{kind}").write_bytes(b"an older one")
    (tmp_path / "back" / "rig.obj").write_bytes(own)
    encode = ["encode", tmp_path / f"rig.{kind}", "-f", "-o", tmp_path / "a.bsm", "--quick"]
    assert bsm(*encode) == 0 and "the order of vertices and faces takes" in capsys.readouterr().err
    size = (tmp_path / "a.bsm").stat().st_size
    assert bsm("decode", tmp_path / "a.bsm", "-f", "-o", tmp_path / "back" / f"rig.{kind}") == 0
    assert (tmp_path / "back" / "rig.obj").read_bytes() == own
    _, frames = frames_of(tmp_path / "back" / f"rig.{kind}")
    assert frames.shape == positions.shape
    assert np.abs(frames - positions).max() < 0.01 * np.linalg.norm(np.ptp(positions[0], axis=0))
    assert bsm("decode", tmp_path / "a.bsm", "-o", tmp_path / f"other.{kind}") == 0
    corners = [corners_of(tmp_path / f"{name}.obj") for name in ("rig", "other")]
    assert len(corners[0]) == 960 and corners[0] == corners[1]
    assert bsm(*encode, "--no-keep-order") == 0 and (tmp_path / "a.bsm").stat().st_size < size
    (tmp_path / "back" / f"rig.{kind}").unlink()
    assert bsm("decode", tmp_path / "a.bsm", "-o", tmp_path / "back" / f"rig.{kind}") != 0
    assert (tmp_path / "back" / "rig.obj").read_bytes() == own


@pytest.mark.parametrize(("sample", "points"), [("None", 0), ("[(0, 0, 0), (1, 0, 0)]", 2)])
def test_a_sample_of_a_stage_that_is_blocked_or_short_is_named(tmp_path, sample, points):
    pytest.importorskip("pxr")
    whole = "[(0, 0, 0), (1, 0, 0), (0, 1, 0)]"
    points_of = f"point3f[] points.timeSamples = {{ 1: {whole}, 2: {sample}, 3: {whole.replace('0)]', '1)]')} }}"
    faces = "int[] faceVertexCounts = [3]\n int[] faceVertexIndices = [0, 1, 2]"
    text = f'#usda 1.0\n( startTimeCode = 1\n endTimeCode = 3 )\ndef Mesh "m" {{\n {faces}\n {points_of}\n}}\n'
    (tmp_path / "a.usda").write_text(text)
    with pytest.raises(MeshError, match=f"/m has {points} points at time 2 and 3 before"):
        frames_of(tmp_path / "a.usda")


def test_usd_core_reads_what_we_write(tmp_path):
    pxr = pytest.importorskip("pxr.Usd")
    from pxr import UsdGeom

    positions, faces, attributes = painted()
    shared = Shared(lambda: attributes, lambda: {"unit": "mm", "up": "z", "frame_rate": 30.0})
    save_frames(tmp_path / "a.usdc", "usdc", positions, faces, shared)
    stage = pxr.Stage.Open(str(tmp_path / "a.usdc"))
    assert (stage.GetStartTimeCode(), stage.GetEndTimeCode(), stage.GetTimeCodesPerSecond()) == (
        0,
        COUNT - 1,
        30,
    )
    assert UsdGeom.GetStageUpAxis(stage) == "Z" and UsdGeom.GetStageMetersPerUnit(stage) == 0.001
    mesh = UsdGeom.Mesh(stage.GetDefaultPrim())
    for number, frame in enumerate(positions):
        assert np.array_equal(np.array(mesh.GetPointsAttr().Get(number)), frame.astype(np.float32))
    between = np.array(mesh.GetPointsAttr().Get(0.5))
    assert np.allclose(between, (positions[0] + positions[1]) / 2, atol=1e-6)
    assert UsdGeom.PrimvarsAPI(mesh).GetPrimvar("st").GetInterpolation() == "faceVarying"


def stage_of(path, points, times, counts=(3, 3), corners=(0, 1, 2, 0, 2, 3), place=None, hand=None):
    """A stage as usd-core writes it."""
    from pxr import Gf, Usd, UsdGeom

    stage = Usd.Stage.CreateNew(str(path))
    above = UsdGeom.Xform.Define(stage, "/above")
    mesh = UsdGeom.Mesh.Define(stage, "/above/mesh")
    mesh.CreateFaceVertexCountsAttr(list(counts))
    mesh.CreateFaceVertexIndicesAttr(list(corners))
    for time, places in zip(times, points):
        mesh.CreatePointsAttr().Set([Gf.Vec3f(*map(float, point)) for point in places], time)
    if hand:
        mesh.CreateOrientationAttr(hand)
    if place is not None:
        above.AddTranslateOp().Set(Gf.Vec3d(*place), times[-1])
        above.GetOrderedXformOps()[0].Set(Gf.Vec3d(0, 0, 0), times[0])
    stage.Save()
    return mesh, stage


SQUARE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)


def test_stages_of_others(tmp_path):
    pytest.importorskip("pxr.Usd")
    stage_of(
        tmp_path / "a.usda", [SQUARE, 3 * SQUARE], (0, 12), place=(0, 0, 24), hand="leftHanded"
    )
    source, frames = frames_of(tmp_path / "a.usda")
    assert len(frames) == 13 and source.frame_rate == 24
    assert np.allclose(frames[6], 2 * SQUARE + [0, 0, 12]), (
        "between samples USD goes straight on, above the mesh as well"
    )
    assert source.faces.tolist() == [[0, 2, 1], [0, 3, 2]]
    _, fine = frames_of(tmp_path / "a.usda", rate=48)
    assert len(fine) == 25 and np.allclose(fine[::2], frames)


@pytest.mark.parametrize(
    ("start", "end", "first", "count", "outside"),
    [(4, 8, 1.5, 5, 3), (-4, 12, 1, 17, 0), (12, 0, 1, 13, 0)],
)
def test_a_stage_begins_where_it_says(tmp_path, start, end, first, count, outside):
    """A range that ends before it begins says nothing."""
    pytest.importorskip("pxr.Usd")
    mesh, stage = stage_of(
        tmp_path / "a.usda", [SQUARE, SQUARE, 2 * SQUARE, 2 * SQUARE], (0, 2, 6, 12)
    )
    mesh.CreateDisplayColorPrimvar("vertex").Set([(0, 0, 0)] * 4, 0)
    mesh.GetDisplayColorPrimvar().Set([(1, 1, 1)] * 4, 4)
    stage.SetStartTimeCode(start)
    stage.SetEndTimeCode(end)
    stage.Save()
    source, frames = frames_of(tmp_path / "a.usda")
    assert len(frames) == count and np.allclose(frames[0], first * SQUARE)
    assert [note for note in source.notes if "outside" in note] == (
        [f"{outside} time samples lie outside {start} to {end}"] if outside else []
    )
    still = read_mesh(tmp_path / "a.usda").mesh
    assert np.allclose(still.positions, frames[0])
    assert still.attributes[0].values.max() == (255 if start == 4 else 0)


@pytest.mark.parametrize("purpose", ["render", "default"])
def test_stand_ins_of_a_stage_are_left_out_where_there_is_the_real_thing(tmp_path, purpose):
    pytest.importorskip("pxr.Usd")
    from pxr import UsdGeom

    mesh, stage = stage_of(tmp_path / "a.usda", [SQUARE], (0,))
    mesh.CreatePurposeAttr(purpose)
    other = UsdGeom.Mesh.Define(stage, "/above/other")
    other.CreateFaceVertexCountsAttr([3])
    other.CreateFaceVertexIndicesAttr([0, 1, 2])
    other.CreatePointsAttr([(0, 0, 0), (1, 0, 0), (0, 1, 0)])
    other.CreatePurposeAttr("proxy")
    stage.Save()
    given = read_mesh(tmp_path / "a.usda")
    assert len(given.mesh.faces) == (2 if purpose == "render" else 3)
    noted = ["left out, stand-ins (purpose proxy): /above/other"] if purpose == "render" else []
    assert [note for note in given.notes if "stand-ins" in note] == noted


def test_a_stage_without_time_codes_per_second_is_refused(tmp_path):
    """usd-core itself would count samples for ever, for a layer below, too."""
    pytest.importorskip("pxr.Usd")
    _, stage = stage_of(tmp_path / "a.usda", [SQUARE, 2 * SQUARE], (0, 6))
    stage.SetTimeCodesPerSecond(0)
    stage.Save()
    (tmp_path / "b.usda").write_text("#usda 1.0\n(\n    subLayers = [@a.usda@]\n)\n")
    for name in "ab":
        with pytest.raises(FormatError, match="timeCodesPerSecond"):
            read_mesh(tmp_path / f"{name}.usda")


def area_vectors(mesh):
    first, second, third = (mesh.positions[corner] for corner in mesh.faces.T)
    return np.cross(second - first, third - first)


@pytest.mark.parametrize("hand", ["rightHanded", "leftHanded"])
def test_a_mirror_turns_the_faces(tmp_path, hand):
    pytest.importorskip("pxr.Usd")
    from pxr import Gf, UsdGeom

    cube = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    mesh, stage = stage_of(tmp_path / "a.usda", [cube], (0,), hand=hand)
    plain = read_mesh(tmp_path / "a.usda").mesh
    UsdGeom.Xformable(mesh.GetPrim()).AddScaleOp().Set(Gf.Vec3f(-1, 1, 1))
    stage.Save()
    mirrored = read_mesh(tmp_path / "a.usda").mesh
    assert mirrored.positions[:, 0].min() == -1 and np.allclose(
        area_vectors(mirrored), area_vectors(plain)
    )


def test_a_face_of_a_part_has_no_vertices_of_the_next(tmp_path):
    needs("usdc")
    mesh = "def Mesh {} {{\nint[] faceVertexCounts = [3]\nint[] faceVertexIndices = [0, 1, {}]\n{}\n}}\n"
    points = "point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]"
    (tmp_path / "a.usda").write_text(
        "#usda 1.0\n" + mesh.format('"a"', 3, points) + mesh.format('"b"', 2, points)
    )
    with pytest.raises(MeshError, match="a face of /a refers to a vertex that it does not have"):
        read_mesh(tmp_path / "a.usda")


def test_what_a_stage_loses_is_noted(tmp_path):
    pytest.importorskip("pxr.Usd")
    from pxr import UsdGeom

    _, stage = stage_of(tmp_path / "a.usda", [SQUARE], (0,))
    subset = UsdGeom.Subset.Define(stage, "/above/mesh/ears")
    subset.CreateElementTypeAttr(UsdGeom.Tokens.face)
    subset.CreateIndicesAttr([0])
    nose = UsdGeom.Subset.Define(stage, "/above/mesh/nose")  # of the same face
    nose.CreateElementTypeAttr(UsdGeom.Tokens.face)
    nose.CreateIndicesAttr([0])
    for name in ("hidden", "guide"):
        other = UsdGeom.Mesh.Define(stage, f"/above/{name}")
        other.CreatePointsAttr(SQUARE.tolist())
        other.CreateFaceVertexCountsAttr([4])
        other.CreateFaceVertexIndicesAttr([0, 1, 2, 3])
    UsdGeom.Imageable(stage.GetPrimAtPath("/above/hidden")).MakeInvisible()
    UsdGeom.Imageable(stage.GetPrimAtPath("/above/guide")).CreatePurposeAttr(UsdGeom.Tokens.guide)
    stage.Save()
    found = read_mesh(tmp_path / "a.usda")
    assert len(found.mesh.positions) == 4
    assert {
        "left out, face sets without a material: ears, nose",
        "left out, hidden: /above/hidden",
        "left out, guides: /above/guide",
    } <= set(found.notes)


@pytest.mark.parametrize(
    "names", [["left ear", "left ear", "/a/nose"], [f"part {n}" for n in range(40)]]
)
@pytest.mark.parametrize("kind", ["usda", "usdc", "usdz"])
def test_names_of_parts_come_back(tmp_path, capsys, kind, names):
    needs("usdc")
    faces = np.arange(6 * len(names)).reshape(-1, 3)
    positions = np.random.default_rng(1).random((6 * len(names), 3)).astype(np.float32)
    parts = Attribute(
        "part", np.repeat(np.arange(len(names), dtype=np.int32), 2)[::-1, None].copy(), "face"
    )
    frames = [TriangleMesh(each, faces, (parts,)) for each in (positions, 2 * positions)]
    data = encode_frames(frames, metadata=named(names, "part"), keep_order=True)
    (tmp_path / "a.bsm").write_bytes(data)
    assert bsm("decode", tmp_path / "a.bsm", "-o", tmp_path / f"a.{kind}") == 0
    assert "not written" not in capsys.readouterr().err
    found = read_mesh(tmp_path / f"a.{kind}").mesh
    (back,) = found.attributes
    assert (back.name, back.domain) == ("part", "face") and np.array_equal(
        back.values, parts.values
    )
    assert names_in(found.metadata, "part") == dict(enumerate(names))


def test_face_sets_of_one_mesh_are_its_parts(tmp_path):
    needs("usdc")
    (tmp_path / "a.usda").write_text(
        """#usda 1.0
def Mesh "m" {
    int[] faceVertexCounts = [4, 3, 3]
    int[] faceVertexIndices = [0, 1, 2, 3, 0, 1, 2, 1, 2, 3]
    point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 1)]
    def GeomSubset "ears" {
        uniform token elementType = "face"
        int[] indices = [2, 9, -1]
    }
}"""
    )
    found = read_mesh(tmp_path / "a.usda")
    assert [a.values.ravel().tolist() for a in found.mesh.attributes if a.name == "part"] == [
        [1, 1, 1, 0]
    ]
    assert names_in(found.mesh.metadata, "part") == {0: "ears", 1: "rest"}


def test_instances_of_stages(tmp_path):
    pytest.importorskip("pxr.Usd")
    from pxr import Gf, Sdf, UsdGeom

    _, stage = stage_of(tmp_path / "a.usda", [SQUARE], (0,))
    stage.DefinePrim("/above").GetReferences().ClearReferences()
    for number in range(3):
        copy = UsdGeom.Xform.Define(stage, f"/copy{number}")
        copy.GetPrim().GetReferences().AddInternalReference(Sdf.Path("/above"))
        copy.GetPrim().SetInstanceable(True)
        copy.AddTranslateOp().Set(Gf.Vec3d(0, 0, number + 1))
    instancer = UsdGeom.PointInstancer.Define(stage, "/many")
    tree = UsdGeom.Mesh.Define(stage, "/many/tree")
    tree.CreatePointsAttr([(0, 0, 0), (1, 0, 0), (0, 1, 0)])
    tree.CreateFaceVertexCountsAttr([3])
    tree.CreateFaceVertexIndicesAttr([0, 1, 2])
    tree.AddScaleOp().Set(Gf.Vec3f(2, 2, 2))
    instancer.CreatePrototypesRel().AddTarget("/many/tree")
    instancer.CreateProtoIndicesAttr([0, 0, 0])
    instancer.CreatePositionsAttr().Set([(10, 0, 0), (20, 0, 0), (30, 0, 0)], 0)
    instancer.GetPositionsAttr().Set([(10, 0, 8), (20, 0, 8), (30, 0, 8)], 8)
    instancer.CreateInvisibleIdsAttr([1])
    stage.SetStartTimeCode(0)
    stage.SetEndTimeCode(8)
    stage.Save()
    source, frames = frames_of(tmp_path / "a.usda")
    assert frames.shape == (9, 4 * 4 + 2 * 3, 3)
    assert sorted(set(frames[0, :16, 2])) == [0, 1, 2, 3]
    assert np.allclose(
        frames[4, 16:], [[10, 0, 4], [12, 0, 4], [10, 2, 4], [30, 0, 4], [32, 0, 4], [30, 2, 4]]
    )
    assert {"/many[0]", "/many[2]"} < set(
        source.metadata["part.names"].splitlines()
        if "part.names" in source.metadata
        else source.metadata.values()
    )


@pytest.mark.parametrize("way", ["nested", "attributes", "attributes of loose vertices"])
def test_instances_that_multiply_are_refused_before_they_are_made(tmp_path, way):
    pytest.importorskip("pxr.Usd")
    from pxr import Sdf, UsdGeom

    _, stage = stage_of(tmp_path / "a.usda", [SQUARE], (0,))
    if way == "nested":  # 10 levels of 10 instances each
        below = "/above"
        for level in range(10):
            for number in range(10):
                prim = UsdGeom.Xform.Define(stage, f"/level{level}/copy{number}").GetPrim()
                prim.GetReferences().AddInternalReference(Sdf.Path(below))
                prim.SetInstanceable(True)
            below = f"/level{level}"
    else:
        loose = 200 if way == "attributes of loose vertices" else 0
        for number in range(400 if loose else 2000):
            other = UsdGeom.Mesh.Define(stage, f"/mesh{number}")
            other.CreatePointsAttr([(0, 0, 0), (1, 0, 0), (0, 1, 0), *([(0, 0, 0)] * 10 * loose)])
            other.CreateFaceVertexCountsAttr([3])
            other.CreateFaceVertexIndicesAttr([0, 1, 2])
            primvar = UsdGeom.PrimvarsAPI(other).CreatePrimvar(
                f"heat{number}", Sdf.ValueTypeNames.FloatArray, UsdGeom.Tokens.vertex
            )
            primvar.Set([0.0] * (3 + 10 * loose))
    stage.Save()
    with pytest.raises(LimitError):
        read_mesh(tmp_path / "a.usda", limits=Limits.service(), isolated=False)


def test_stages_that_are_no_sequence(tmp_path, capsys):
    pytest.importorskip("pxr.Usd")
    from pxr import Usd

    stage_of(tmp_path / "still.usda", [SQUARE], (0,))
    assert sequence_in(str(tmp_path / "still.usda")) is None
    assert read_mesh(tmp_path / "still.usda").mesh.positions.shape == (4, 3)
    Usd.Stage.CreateNew(str(tmp_path / "empty.usda")).Save()
    with pytest.raises(FormatError, match="no meshes"):
        sequence_in(str(tmp_path / "empty.usda"))
    unknown = b'#usda 1.0\ndef Mesh "a" {\nfloats[] points = [1]\n}\n'
    package = (MOVING / "painted.usdz").read_bytes()
    for name, data, message in (
        ("wrong.usdc", b"PXR-USDC and no more", "usd-core"),
        ("latin.usda", b"#usda 1.0\n\xe9", "cannot read"),
        ("unknown.usda", unknown, "no sense|cannot read"),
        ("wrong.usdz", package.replace(b"PK\1\2", b"PK\0\0"), "no sense|cannot read"),
    ):
        (tmp_path / name).write_bytes(data)
        with pytest.raises(FormatError, match=message):
            sequence_in(str(tmp_path / name))
    mesh, stage = stage_of(tmp_path / "other.usda", [SQUARE, SQUARE, SQUARE], (0, 1, 2))
    mesh.GetFaceVertexIndicesAttr().Set([0, 1, 2, 0, 2, 3], 0)
    mesh.GetFaceVertexIndicesAttr().Set([0, 1, 3, 1, 2, 3], 2)
    stage.Save()
    assert bsm("encode", tmp_path / "other.usda", "-o", tmp_path / "x.bsm") == 3
    assert "the faces of /above/mesh change at time 2" in capsys.readouterr().err
    assert not (tmp_path / "x.bsm").exists()


# ------------------------------------------------------------------------------------------------------------- folders


def written(folder, positions, faces, suffix="ply"):
    folder.mkdir()
    for number, frame in enumerate(positions):
        save(TriangleMesh(frame, faces), folder / f"walk_{number + 7}.{suffix}")
    return sorted(map(str, folder.iterdir()))


def test_many_files_make_one_stream(tmp_path, capsys):
    positions, faces = bending(11)
    names = written(tmp_path / "run", positions, faces)
    assert names[0].endswith("walk_10.ply"), "as a shell gives them"
    assert bsm("encode", *names, "-o", tmp_path / "a.bsm", "--set", "step=0.002") == 0
    assert "11 frames" in capsys.readouterr().err
    assert bsm("decode", tmp_path / "a.bsm", "-o", tmp_path / "back.npz") == 0
    back = np.load(tmp_path / "back.npz")["positions"]
    same = cKDTree(back[0]).query(positions[0])[1]
    assert np.abs(back[:, same] - positions).max() < 0.005 * np.linalg.norm(
        np.ptp(positions[0], axis=0)
    )
    capsys.readouterr()
    assert bsm("encode", *names[:3]) == 0
    printed = capsys.readouterr().err
    assert "3 inputs are numbered like the frames" in printed and "-o NAME.bsm" in printed


def test_what_is_wrong_with_a_folder_is_named(tmp_path, capsys):
    positions, faces = bending(5)
    for name, spoil, expected in (
        ("gap", lambda files: files[2].unlink(), "frame 9 is missing between"),
        (
            "nan",
            lambda files: files[3].write_bytes(with_nan(files[3].read_bytes(), 11)),
            "(frame 3): vertex 11",
        ),
        (
            "cut",
            lambda files: files[1].write_bytes(files[1].read_bytes()[:-9]),
            "walk_8.ply (frame 1)",
        ),
    ):
        written(tmp_path / name, positions, faces)
        spoil(sorted((tmp_path / name).iterdir(), key=lambda file: int(file.stem[5:])))
        assert bsm("encode", tmp_path / name, "-o", tmp_path / "x.bsm") != 0
        assert expected in capsys.readouterr().err
        assert [file.name for file in tmp_path.iterdir() if "x.bsm" in file.name] == [], (
            "nothing half-written"
        )


def with_nan(ply, vertex):
    place = ply.index(b"end_header\n") + 11 + 12 * vertex
    return ply[:place] + b"\xff" * 4 + ply[place + 4 :]


def test_how_frames_differ_is_reported(tmp_path):
    positions, faces = bending(3)
    names = written(tmp_path / "a", positions, faces)
    turned = faces.copy()
    turned[5] = np.roll(turned[5], 1)
    save(TriangleMesh(positions[1], turned), names[1])
    with pytest.raises(
        MeshError, match=r"walk_8.ply \(frame 1\) has other faces than .*walk_7.ply: face 5 is"
    ):
        list(open_frames(names, None, Limits(), Wanted(), isolated=None).frames)
    save(TriangleMesh(positions[1], faces[:-2]), names[1])
    with pytest.raises(MeshError, match="958 faces where there were 960"):
        list(open_frames(names, None, Limits(), Wanted(), isolated=None).frames)


def test_order_and_gaps():
    assert in_order(["a10.obj", "a9.obj", "a8.obj"]) == ["a8.obj", "a9.obj", "a10.obj"]
    assert in_order(["v2_4.obj", "v2_2.obj", "v2_6.obj"]) == ["v2_2.obj", "v2_4.obj", "v2_6.obj"], (
        "every second frame"
    )
    assert in_order(["b.obj", "a.obj"]) == ["a.obj", "b.obj"]
    with pytest.raises(MeshError, match=r"frame 4 is missing between a3\.obj and a5\.obj"):
        in_order(["a1.obj", "a2.obj", "a3.obj", "a5.obj"])
    assert look_like_frames(["x/a1.obj", "x/a2.obj"]) and not look_like_frames(
        ["horse.obj", "cow.obj"]
    )
    assert not look_like_frames(["a1b7.obj", "a2b9.obj"])


@pytest.mark.parametrize(
    "names",
    [
        [f"f_{number}.obj" for number in range(-5, 7)],
        [f"run.{number:04d}.ply" for number in range(-12, 3)],
        [f"{number}.ply" for number in (-20, -10, 0, 10)],
        [f"take-{number}.obj" for number in range(1, 12)],  # hyphens
        [f"2026-01-{day:02d}.ply" for day in range(1, 12)],
        [f"box1.{number}.obj" for number in range(8, 12)],
        [f"t_{number / 2}.obj" for number in range(9)],
    ],
)
def test_signed_numbers_count_up(names):
    assert in_order(names[::-1]) == in_order(sorted(names)) == names


@pytest.mark.parametrize(
    "names",
    [
        [f"f{number}.obj" for number in range(-5, 7)],
        ["walk-2.obj", "walk-1.obj", "walk0.obj"],
        ["t_0.25.ply", "t_0.5.ply", "t_0.75.ply", "t_1.0.ply"],
        ["t_0.ply", "t_0.5.ply", "t_1.ply", "t_1.5.ply"],
    ],
)
def test_numbers_that_can_be_read_in_two_ways_are_refused(names):
    for given in (names, names[::-1]):
        with pytest.raises(MeshError, match="is unclear"):
            in_order(given)


def test_numbered_files_are_removed_after_an_error(tmp_path):
    positions, faces = bending(3)
    (tmp_path / "keep.txt").write_text("mine")
    for folder in (tmp_path, tmp_path / "new"):
        with (
            pytest.raises(RuntimeError),
            sequence_writer(str(folder / "f%03d.obj"), "obj", faces, 3, overwrite=False) as write,
        ):
            write(positions[0])
            assert (folder / "f000.obj").exists()
            raise RuntimeError
    assert [file.name for file in tmp_path.iterdir()] == ["keep.txt"]
    for path in ("%d%d.obj", "a.obj", "a.abc"):
        with pytest.raises(OptionError):
            sequence_kind(path, None)


# -------------------------------------------------------------------------------------------------------------- caches


def test_pc2_and_mdd_byte_by_byte(tmp_path):
    positions, faces = bending(2)
    positions = positions[:, :9]
    faces = np.array([[0, 1, 2], [3, 4, 5], [6, 7, 8]])
    for kind in ("pc2", "mdd"):
        shared = Shared(metadata=lambda: {"frame_rate": 4.0})
        save_frames(tmp_path / f"a.{kind}", kind, positions, faces, shared)
    head = struct.pack("<12siiffi", b"POINTCACHE2\0", 1, 9, 0.0, 1.0, 2)
    assert (tmp_path / "a.pc2").read_bytes() == head + positions.astype("<f4").tobytes()
    head = struct.pack(">iiff", 2, 9, 0.0, 0.25)
    assert (tmp_path / "a.mdd").read_bytes() == head + positions.astype(">f4").tobytes()
    assert frames_of(tmp_path / "a.mdd")[0].frame_rate == 4
    shutil.move(tmp_path / "a.obj", tmp_path / "b.obj")
    with pytest.raises(MeshError, match=r"--mesh"):
        sequence_in(str(tmp_path / "a.pc2"))
    source, frames = frames_of(tmp_path / "a.pc2", mesh=tmp_path / "b.obj")
    assert np.allclose(frames, positions, atol=1e-6) and np.array_equal(source.faces, faces)
    save(torus(5, 4), tmp_path / "a.obj")
    with pytest.raises(MeshError, match=r"9 points and the mesh .* has 20 vertices"):
        sequence_in(str(tmp_path / "a.pc2"))


@pytest.mark.parametrize(
    ("kind", "data", "error"),
    [
        ("pc2", b"", FormatError),
        ("pc2", b"POINTCACHE2", FormatError),
        ("pc2", struct.pack("<12siiffi", b"POINTCACHE2\0", 2, 9, 0, 1, 2), FormatError),
        ("pc2", struct.pack("<12siiffi", b"POINTCACHE2\0", 1, -9, 0, 1, 2), FormatError),
        (
            "pc2",
            struct.pack("<12siiffi", b"POINTCACHE2\0", 1, 2**31 - 1, 0, 1, 2**31 - 1),
            TruncatedError,
        ),
        ("mdd", b"123", TruncatedError),
        ("mdd", struct.pack(">ii", -1, 4), FormatError),
        ("mdd", struct.pack(">ii", 2**31 - 1, 4), TruncatedError),
        ("mdd", struct.pack(">iif", 1, 2**31 - 1, 0.0), TruncatedError),
    ],
)
def test_damaged_caches(tmp_path, kind, data, error):
    save(torus(5, 4), tmp_path / "a.obj")
    (tmp_path / f"a.{kind}").write_bytes(data)
    with pytest.raises(error):
        sequence_in(str(tmp_path / f"a.{kind}"))


TIMES = {
    "start": ("mdd", [1.0, 1.04, 1.08, 1.12]),
    "uneven": ("mdd", [0.0, 0.04, 0.2, 0.21]),
    "nearly even": ("mdd", [0.0, 0.0403, 0.08, 0.12]),
    "before zero": ("mdd", [-0.08, -0.04, 0.0, 0.04]),
    "shot": ("pc2", (1001.0, 1.0)),
    "half frames": ("pc2", (-3.5, 0.5)),
}


@pytest.mark.parametrize("name", TIMES)
def test_the_timing_of_a_cache_comes_back(tmp_path, capsys, name):
    kind, times = TIMES[name]
    mesh = torus(5, 4)
    save(mesh, tmp_path / "a.obj")
    frames = np.array([mesh.positions * (1 + 0.1 * t) for t in range(4)])
    if kind == "pc2":
        head = struct.pack("<12siiffi", b"POINTCACHE2\0", 1, len(mesh.positions), *times, 4)
    else:
        head = struct.pack(">ii4f", 4, len(mesh.positions), *times)
    (tmp_path / f"a.{kind}").write_bytes(
        head + frames.astype("<f4" if kind == "pc2" else ">f4").tobytes()
    )
    assert bsm("encode", tmp_path / f"a.{kind}", "-o", tmp_path / "a.bsm", "--quick") == 0
    assert bsm("decode", tmp_path / "a.bsm", "-o", tmp_path / f"b.{kind}") == 0
    assert (tmp_path / f"b.{kind}").read_bytes()[: len(head)] == head
    assert bsm("decode", tmp_path / "a.bsm", "--frames", "2:4", "-o", tmp_path / f"c.{kind}") == 0
    later = (tmp_path / f"c.{kind}").read_bytes()
    if kind == "pc2":
        assert struct.unpack_from("<ffi", later, 20) == (times[0] + 2 * times[1], times[1], 2)
    else:
        assert np.allclose(struct.unpack_from(">2f", later, 8), times[2:], atol=1e-6)
    assert bsm("decode", tmp_path / "a.bsm", "-o", tmp_path / "b.npz") == 0
    assert bsm("encode", tmp_path / "b.npz", "-o", tmp_path / "b.bsm", "--quick") == 0
    assert bsm("decode", tmp_path / "b.bsm", "-f", "-o", tmp_path / f"b.{kind}") == 0
    assert (tmp_path / f"b.{kind}").read_bytes()[: len(head)] == head


def test_times_that_make_no_sense_are_noted(tmp_path, capsys):
    mesh = torus(5, 4)
    save(mesh, tmp_path / "a.obj")
    points = np.tile(mesh.positions, (2, 1, 1))
    for kind, head in (
        ("mdd", struct.pack(">ii2f", 2, len(mesh.positions), 1.0, 0.0)),
        ("pc2", struct.pack("<12siiffi", b"POINTCACHE2\0", 1, len(mesh.positions), np.nan, 1.0, 2)),
    ):
        (tmp_path / f"a.{kind}").write_bytes(
            head + points.astype(f"{'<' if kind == 'pc2' else '>'}f4").tobytes()
        )
        assert bsm("encode", tmp_path / f"a.{kind}", "-o", tmp_path / f"{kind}.bsm", "--quick") == 0
        assert "the times of frames are not numbers that grow" in capsys.readouterr().err


def test_the_start_of_a_stage_comes_back_and_samples_between_frames_are_noted(tmp_path, capsys):
    pxr = pytest.importorskip("pxr.Usd")
    stage_of(tmp_path / "a.usda", [SQUARE, 3 * SQUARE, 2 * SQUARE], (1001, 1001.5, 1003))
    assert bsm("encode", tmp_path / "a.usda", "-o", tmp_path / "a.bsm", "--quick") == 0
    printed = capsys.readouterr().err
    assert (
        "1 of 3 time samples lie between the frames and are not read; --frame-rate 48 reads them"
        in printed
    )
    assert (
        bsm(
            "encode",
            tmp_path / "a.usda",
            "-f",
            "-o",
            tmp_path / "a.bsm",
            "--quick",
            "--frame-rate",
            48,
        )
        == 0
    )
    assert "between the frames" not in capsys.readouterr().err
    assert bsm("decode", tmp_path / "a.bsm", "-o", tmp_path / "b.usda") == 0
    stage = pxr.Stage.Open(str(tmp_path / "b.usda"))
    assert (stage.GetStartTimeCode(), stage.GetEndTimeCode(), stage.GetTimeCodesPerSecond()) == (
        2002,
        2006,
        48,
    )


def test_other_materials_of_later_frames_are_noted(tmp_path, capsys):
    mesh = torus(5, 4)
    for folder, more in (("same", ()), ("runs", ("--runs",))):
        (tmp_path / folder).mkdir()
        for number in range(3):
            known = {
                "material.0.name": "skin",
                "material.0.baseColorFactor": "1 0 0 1" if number < 2 else "0 1 0 1",
            }
            faces = mesh.faces if folder == "same" or number < 2 else mesh.faces[:-1]
            moved = TriangleMesh(mesh.positions * (1 + 0.1 * number), faces, metadata=known)
            save(moved, tmp_path / folder / f"{number}.npz")
        assert (
            bsm("encode", tmp_path / folder, "-o", tmp_path / f"{folder}.bsm", "--quick", *more)
            == 0
        )
        assert (
            "material.0.baseColorFactor changes at frame 2, but stays as before"
            in capsys.readouterr().err
        )


def test_a_cache_with_nan_names_the_frame(tmp_path, capsys):
    mesh = torus(5, 4)
    save(mesh, tmp_path / "a.obj")
    frames = np.tile(mesh.positions, (20, 1, 1)).astype("<f4")
    frames[17, 3, 2] = np.nan
    head = struct.pack("<12siiffi", b"POINTCACHE2\0", 1, len(mesh.positions), 0, 1, 20)
    (tmp_path / "a.pc2").write_bytes(head + frames.tobytes())
    assert (
        bsm(
            "encode", tmp_path / "a.pc2", "-o", tmp_path / "a.bsm", "--gop", 4, "--set", "step=0.01"
        )
        == 3
    )
    assert "vertex 3 of frame 17 has" in capsys.readouterr().err
    assert sorted(file.name for file in tmp_path.iterdir()) == ["a.obj", "a.pc2"]
    np.savez(tmp_path / "a.npz", positions=frames, faces=mesh.faces)
    for name in ("a.npz", "a.pc2"):
        assert bsm("compare", tmp_path / name, tmp_path / name) == 3
        assert "vertex 3 of frame 17 has" in capsys.readouterr().err


# ---------------------------------------------------------------------------------------------------------------- glTF


def test_what_is_no_moving_gltf(tmp_path, capsys):
    pytest.importorskip("trimesh")
    save(torus(5, 4), tmp_path / "still.glb")
    assert bsm("encode", tmp_path / "still.glb", "--animation", 0, "-o", tmp_path / "a.bsm") == 3
    assert "still.glb: this glTF has no animation" in capsys.readouterr().err
    with pytest.raises(OptionError, match="no animation 1"):
        frames_of(MOVING / "skinned.glb", animation="1")
    with pytest.raises(OptionError, match=r"no animation .jump.; the names are .ArmatureAction"):
        frames_of(MOVING / "skinned.glb", animation="jump")
    assert frames_of(MOVING / "skinned.glb", animation="ArmatureAction")[0].count == 25


HOSTILE = (-1, 1 << 40, 2.5, "x", None, [], {}, [[]])


def test_hostile_gltf_gives_errors_of_ours(tmp_path):
    """Whatever stands anywhere in the tree; and bytes that are not there."""
    tree, binary = unpack((MOVING / "skinned.glb").read_bytes())
    path = tmp_path / "a.glb"
    refused = 0
    for number, place in enumerate(leaves(json.loads(json.dumps(tree)))):
        for wrong in HOSTILE[number % 3 :: 3]:
            spoiled = json.loads(json.dumps(tree))
            where = spoiled
            for key in place[:-1]:
                where = where[key]
            where[place[-1]] = wrong
            path.write_bytes(glb(spoiled, binary))
            try:
                for _, frame in zip(range(2), read_gltf(str(path), Wanted()).frames):
                    assert np.isfinite(frame).all()
            except BsmError:
                refused += 1
    assert refused > 100
    for size in range(0, len(binary), 997):
        path.write_bytes(glb(tree, binary[:size]))
        with pytest.raises(TruncatedError):
            frames_of(path)
    whole = (MOVING / "skinned.glb").read_bytes()
    for size in (0, 4, 19, 40, 5000):
        path.write_bytes(whole[:size])
        with pytest.raises(BsmError):
            frames_of(path)


def leaves(tree, place=()):
    if isinstance(tree, dict | list):
        for key, value in tree.items() if isinstance(tree, dict) else enumerate(tree):
            yield from leaves(value, (*place, key))
    elif place[:1] != ("materials",) and "bufferViews" not in place[:1]:
        yield place


def test_a_node_below_itself_ends(tmp_path):
    tree, binary = unpack((MOVING / "morphing.glb").read_bytes())
    tree["nodes"][0]["children"] = [0]
    (tmp_path / "a.glb").write_bytes(glb(tree, binary))
    with pytest.raises(FormatError, match="two places"):
        frames_of(tmp_path / "a.glb")


def test_bytes_that_are_used_many_times_are_bounded(tmp_path):
    tree, binary = unpack((MOVING / "morphing.glb").read_bytes())
    moving = next(node for node in tree["nodes"] if "mesh" in node)
    many = json.loads(json.dumps(tree))
    many["nodes"] += [moving] * 2000
    many["scenes"][0]["nodes"] = list(range(len(many["nodes"])))
    (tmp_path / "a.glb").write_bytes(glb(many, binary))
    with pytest.raises(LimitError, match="vertices"):
        sequence_in(str(tmp_path / "a.glb"), limits=Limits(vertices=100_000))
    zeros = json.loads(json.dumps(tree))
    zeros["accessors"].append({"componentType": 5126, "type": "VEC3", "count": 1 << 23})
    primitive = zeros["meshes"][0]["primitives"][0]
    primitive["attributes"]["POSITION"] = len(zeros["accessors"]) - 1
    primitive["targets"] = [{"POSITION": len(zeros["accessors"]) - 1}] * 50
    (tmp_path / "a.glb").write_bytes(glb(zeros, binary))
    with pytest.raises(LimitError, match=r"meshes of this glTF"):
        frames_of(tmp_path / "a.glb")


def test_curves_go_as_gltf_says():
    times = np.array([1.0, 3.0])
    line = Keyframes(times, np.array([[0.0], [4.0]]), "LINEAR")
    assert [float(line.at(t)[0]) for t in (0, 1, 2, 3, 9)] == [0, 0, 2, 4, 4]
    step = Keyframes(times, np.array([[0.0], [4.0]]), "STEP")
    assert [float(step.at(t)[0]) for t in (1, 2.9, 3)] == [0, 0, 4]
    # A cubic through both values with the slopes that are given: v(t) = t^2 on [1, 3].
    cubic = Keyframes(times, np.array([[0], [1], [2], [6], [9], [0]], float), "CUBICSPLINE")
    assert np.allclose([cubic.at(t)[0] for t in (1, 1.5, 2, 3)], [1, 2.25, 4, 9])
    # A quarter turn about z, by the shorter way, though the second quaternion has the other sign.
    half = np.sqrt(0.5)
    turn = Keyframes(
        np.array([0.0, 1.0]), np.array([[0, 0, 0, 1], [0, 0, -half, -half]]), "LINEAR", True
    )
    angle = np.pi / 4
    eighth = matrix_of(np.zeros(3), turn.at(0.5), np.ones(3))[:2, :2]
    assert np.allclose(eighth, [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    with pytest.raises(FormatError):
        Keyframes(times[::-1], np.zeros((2, 1)), "LINEAR")


def painted_frames(count=5):
    positions, faces = bending(count)
    positions = positions.astype(np.float32).astype(np.float64)
    shades = 0.5 + 0.4 * np.sin(positions + np.arange(count)[:, None, None])
    return positions, faces, shades.astype(np.float32)


@pytest.mark.parametrize("kind", ["glb", "usdc"])
def test_colors_that_change_come_in(tmp_path, kind, capsys):
    """As COLOR_0 of the morph targets of a glTF, as primvars of USD."""
    needs(kind)
    positions, faces, shades = painted_frames()
    path = tmp_path / f"a.{kind}"
    if kind == "glb":
        built = Built()
        singles = positions.astype(np.float32)
        given = {"POSITION": built.array(singles[0]), "COLOR_0": built.array(shades[0])}
        deltas = zip(singles[1:] - singles[0], shades[1:] - shades[0], strict=True)
        targets = [{"POSITION": built.array(p), "COLOR_0": built.array(s)} for p, s in deltas]
        corners = built.array(faces.ravel().astype(np.uint32))
        built.nodes(
            {"mesh": built.mesh({"attributes": given, "indices": corners, "targets": targets})}
        )
        weights = built.array(np.vstack([np.zeros((1, 4)), np.eye(4)]).astype(np.float32).ravel())
        sampler = {"input": built.array((np.arange(5) / 24).astype(np.float32)), "output": weights}
        channel = {"sampler": 0, "target": {"node": 0, "path": "weights"}}
        built.tree["animations"] = [{"samplers": [sampler], "channels": [channel]}]
        path.write_bytes(built.bytes)
    else:
        from pxr import Sdf, Usd, UsdGeom, Vt

        stage = Usd.Stage.CreateNew(str(path))
        stage.SetTimeCodesPerSecond(24)
        mesh = UsdGeom.Mesh.Define(stage, "/mesh")
        mesh.CreateFaceVertexCountsAttr([3] * len(faces))
        mesh.CreateFaceVertexIndicesAttr(
            Vt.IntArray.FromNumpy(np.ascontiguousarray(faces.reshape(-1)))
        )
        points = mesh.CreatePointsAttr()
        color = UsdGeom.PrimvarsAPI(mesh).CreatePrimvar(
            "displayColor", Sdf.ValueTypeNames.Color3fArray, "vertex"
        )
        for time in range(5):
            points.Set(Vt.Vec3fArray.FromNumpy(positions[time].astype(np.float32)), time)
            color.Set(Vt.Vec3fArray.FromNumpy(shades[time]), time)
        stage.Save()
    assert bsm("encode", path, "-o", tmp_path / "a.bsm", "--animation", "0", "--quick") == 0
    assert "color: per vertex, moves" in capsys.readouterr().err
    found = list(decode_frames(tmp_path / "a.bsm"))
    assert len(found) == 5
    for number, frame in enumerate(found):
        same = cKDTree(positions[number]).query(frame.positions)[1]
        (color,) = frame.attributes
        off = color.values[:, :3] - conventions.to_srgb(shades[number])[same]
        assert np.sqrt(np.square(off).mean()) < 0.02


def test_colors_are_of_the_kind_that_they_are_first():
    mesh = torus(6, 5)
    colors = [np.full((30, 3), value) for value in (np.uint8(255), np.float32(0.5))]
    whole, part = (
        replace(mesh, attributes=(Attribute("color", color, "vertex", "color"),))
        for color in colors
    )
    for first, other, value in ((whole, part, 128), (part, whole, 1.0)):
        (now,) = painted_like(first, other).attributes
        assert now.values.dtype == first.attributes[0].values.dtype and (now.values == value).all()


ROOT = Path(__file__).parents[3]
MODULES = ROOT / "web" / "node_modules"


def shown_by_three(path, rate, count):
    if shutil.which("node") is None or not (MODULES / "three").is_dir():
        pytest.skip("needs node, and three.js in web (npm ci)")
    words = ["node", MOVING / "three.mjs", path, str(rate), str(count), MODULES]
    done = subprocess.run(words, capture_output=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr.decode()
    return np.frombuffer(done.stdout).reshape(count, -1, 3)


@pytest.mark.parametrize("name", ["skinned", "morphing"])
def test_what_blender_wrote(name):
    """Bones that turn and targets that mix, as three.js' own mixer moves them."""
    frames = np.array(list(sequence_in(str(MOVING / f"{name}.glb")).frames))
    shown = shown_by_three(MOVING / f"{name}.glb", 24, len(frames))
    distance, same = cKDTree(frames[0]).query(shown[0])
    assert set(same) == set(range(frames.shape[1])) and distance.max() < 1e-5
    diagonal = np.linalg.norm(np.ptp(frames[0], axis=0))
    assert np.abs(frames[:, same] - shown).max() < 3e-6 * diagonal


def test_what_we_write(tmp_path):
    positions, faces = bending(9)
    positions = positions.astype(np.float32).astype(np.float64)
    shared = Shared(metadata=lambda: {"frame_rate": 25.0})
    save_frames(tmp_path / "a.glb", "glb", positions, faces, shared)
    shown = shown_by_three(tmp_path / "a.glb", 25, 9)
    assert np.abs(shown - positions).max() < 1e-6


@pytest.mark.parametrize(
    "names",
    [
        [f"times/{time}/wall.vtp" for time in ("0", "0.05", "0.1", "0.15", "1", "2", "10")],
        [f"w_{time}.obj" for time in ("9e-06", "1e-05", "1.1e-05")],
        [f"w_{time}.obj" for time in ("-1.5e-3", "-9e-06", "-1e-06", "0", "1.5e3")],
        [f"w_{time}.obj" for time in ("-1.5", "-0.5", "0.25", "0.5")],
        [f"w_{time}.obj" for time in ("9.0D-06", "1.0D-05", ".1d-03", "1.5D+01")],
        [f"w_{time}/mesh2.obj" for time in ("-0.5", "-0.25", "1")],
        [f"scans/f{number}/mesh.obj" for number in range(8, 12)],
        [f"model3d-0{number}.obj" for number in range(1, 5)],
        [f"{number}/mesh_{number}.obj" for number in range(8, 12)],
    ],
)
def test_frames_are_ordered_by_what_differs_in_their_paths(names):
    for given in (names, names[::-1], sorted(names)):
        assert in_order(given) == names
    looks = names if names[0].startswith(("times", "w_")) else []
    plain = [re.sub("[dD]([-+])", r"e\1", name) for name in looks]
    assert times_in(names) == [
        float(re.findall(r"-?[\d.]*\d(?:e[-+]?\d+)?", name)[0]) for name in plain
    ]


@pytest.mark.parametrize(
    "names",
    [
        ["a/f1.obj", "a/f2.obj", "b/f1.obj"],
        ["0.1/a.vtp", "0.10/a.vtp", "0.2/a.vtp"],
        ["1/f2.obj", "2/f1.obj"],
        ["w_1e0.obj", "w_2e0.obj", "w_1e1.obj"],
        ["w_500us.obj", "w_1ms.obj"],
        ["w_.5.obj", "w_1.5.obj"],
    ],
)
def test_paths_without_one_order_are_refused(names):
    with pytest.raises(MeshError, match=r"is unclear|one time"):
        in_order(names)


def test_parts_of_a_pvd_at_one_time_are_joined_and_a_pvd_is_written(tmp_path):
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    for number in range(3):
        save(
            TriangleMesh(np.add(square, (3 * number, 0, number)), faces),
            tmp_path / f"p{number}.vtp",
        )
    rows = '<DataSet timestep="0.5" file="p0.vtp"/><DataSet timestep="0.5" file="p1.vtp"/>'
    rows += '<DataSet timestep="2" file="p1.vtp"/><DataSet timestep="2" file="p2.vtp"/>'
    head = '<VTKFile type="Collection" version="0.1"><Collection>{}</Collection></VTKFile>'
    (tmp_path / "a.pvd").write_text(head.format(rows))
    frames = sequence_in(str(tmp_path / "a.pvd"))
    assert [frame[:, 0].max() for frame in frames.frames] == [
        4,
        7,
    ] and frames.frame_rate == pytest.approx(1 / 1.5)
    for nothing in ("", ' timestep=""'):
        first = re.sub(' timestep="[^"]*"', nothing, rows.partition('<DataSet timestep="2"')[0])
        (tmp_path / "b.pvd").write_text(head.format(first))
        assert sequence_in(str(tmp_path / "b.pvd")).count == 1
    bsm("encode", tmp_path / "a.pvd", "-f", "--quick", "-o", tmp_path / "a.bsm")
    assert bsm("decode", tmp_path / "a.bsm", "-o", tmp_path / "out.pvd") == 0
    text = (tmp_path / "out.pvd").read_text()
    found = re.findall('timestep="(.*?)" .*file="(.*?)"', text)
    assert [name for _, name in found] == ["out/00000.vtp", "out/00001.vtp"]
    assert [float(time) for time, _ in found] == pytest.approx([0.5, 2], abs=1e-5)
    assert sequence_in(str(tmp_path / "out.pvd")).count == 2
