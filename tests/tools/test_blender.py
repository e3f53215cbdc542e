"""The extension for Blender: in `bpy` where that can be had, in its own environment (BSM_BPY names its Python)."""

import importlib.util
import json
import os
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree

import bsm
from bsm import Attribute, TriangleMesh
from bsm.cli import main as cli
from tests.motion import animators_own, bending
from tests.shapes import torus
from tools.release.blender import main

ROOT = Path(__file__).parents[2]


def blender():
    """A Python that has bpy."""
    if named := os.environ.get("BSM_BPY"):
        return named
    if importlib.util.find_spec("bpy") is None:
        pytest.skip(
            "needs bpy (pip install bpy==5.0.1), in this environment or in that whose Python BSM_BPY names"
        )
    return sys.executable


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Streams to import, with texture coordinates, colors and a material."""
    folder = tmp_path_factory.mktemp("blender")
    (folder / "project").mkdir()
    positions, faces = bending(10)
    corners = positions[0][faces][:, :, :2].reshape(-1, 2).astype(np.float32)
    uv = Attribute("texcoord", corners, "corner", "texcoord")
    data = bsm.encode_sequence(positions, faces, mesh_attributes=[uv], frame_rate=12.5)
    (folder / "moving.bsm").write_bytes(data)
    mesh = torus(12, 8)
    color = Attribute("color", (np.abs(mesh.positions) * 90).astype(np.uint8), "vertex", "color")
    heat = Attribute("heat", mesh.positions[:, :1].astype(np.float32))
    metadata = {"material.0.name": "red", "material.0.baseColorFactor": "1 0.25 0 1", "up": "y"}
    still = TriangleMesh(mesh.positions, mesh.faces, (color, heat), metadata)
    (folder / "still.bsm").write_bytes(bsm.encode(still, preset="near-lossless"))
    meshes = [torus(size, 6, bumps=0.05 * t) for t, size in enumerate((10, 10, 10, 7, 7, 10))]
    np.save(folder / "turns.npy", [np.ptp(mesh.positions, axis=0) for mesh in meshes])
    (folder / "runs.bsm").write_bytes(bsm.encode_frames(meshes, step=0.002, runs=True))
    np.save(folder / "rig.npy", animators_own(folder, loose=0))
    for kind in ("pc2", "mdd"):
        words = (
            ["encode", f"rig.{kind}", "-o", f"{kind}.bsm", "--up", "y"],
            ["decode", f"{kind}.bsm", "-o", f"out.{kind}"],
        )
        assert not any(
            cli([str(folder / word) if "." in word else word for word in word]) for word in words
        )
        (folder / "out.obj").unlink()
    return folder


@pytest.fixture(scope="module")
def found(folder):
    """What Blender found."""
    words = [blender(), str(Path(__file__).parent / "in_blender.py"), str(folder)]
    path = os.pathsep.join([str(ROOT / "src"), str(ROOT), os.environ.get("PYTHONPATH", "")])
    setting = {**os.environ, "PYTHONPATH": path}
    done = subprocess.run(
        words, capture_output=True, text=True, timeout=600, env=setting, check=False
    )
    lines = [line for line in done.stdout.splitlines() if line.startswith("FOUND ")]
    assert lines, done.stderr[-4000:]
    return json.loads(lines[0].removeprefix("FOUND "))


def test_every_frame_is_the_decoders(found):
    assert (
        found["exact"]
        and found["scene"] == pytest.approx([1, 10, 12.5])
        and found["uv"] == ["texcoord"]
    )


def test_a_cache_plays_on_the_mesh_that_it_was_made_of(found):
    assert found["rig"] == [[24, 485, 3], True] * 2
    assert found["axes"] == {"own": [90, 0, 0], "stream": [90, 0, 0]}


def test_faces_that_change_are_objects_that_take_turns(found, folder):
    names = ["runs", "runs_00003", "runs_00005"]
    assert found["runs"] == [names, names]
    assert np.allclose(found["turns"], np.load(folder / "turns.npy"), atol=0.05)


def test_a_project_that_lost_its_cache_is_whole_again(found):
    assert (
        found["restored"] == ["moving"]
        and found["cache"] == "//bsm_cache/moving.pc2"
        and found["exact again"]
    )


def test_a_mesh_keeps_what_it_carries(found, folder):
    assert {"color BYTE_COLOR POINT", "heat FLOAT POINT"} <= set(found["still"])
    assert found["material"] == ["red"] and found["color"] == [1, 0.25, 0, 1]
    again, still = bsm.decode(folder / "still_again.bsm"), bsm.decode(folder / "still.bsm")
    attributes = {attribute.name: attribute for attribute in again.attributes}
    turned = np.stack(
        [still.positions[:, 0], -still.positions[:, 2], still.positions[:, 1]], axis=1
    )
    distance, same = cKDTree(again.positions).query(turned)
    assert distance.max() < 0.01 and again.metadata["up"] == "z"
    colors = next(attribute for attribute in still.attributes if attribute.name == "color").values
    assert np.array_equal(attributes["color"].values[same][:, :3], colors[:, :3])
    assert again.metadata["material.0.name"] == "red"


def test_an_object_is_written_as_it_is_seen(found, folder):
    assert found["exported"]["frames"] == 12
    shown = np.load(folder / "monkey.npy")
    decoded, faces = bsm.decode_sequence(folder / "monkey.bsm")
    same = cKDTree(shown[0]).query(decoded[0])[1]
    assert (
        decoded.shape == shown.shape
        and len(set(same)) == len(same)
        and found["exported"]["faces"] == len(faces)
    )
    diagonal = np.linalg.norm(np.ptp(shown[0], axis=0))
    assert np.abs(decoded - shown[:, same]).max() < 0.01 * diagonal
    assert "the faces of a sequence stay" in found["changing"] and not (folder / "x.bsm").exists()
    assert "no object is active" in found["nothing"]
    assert found["left out"] == ["left out: crease"]


def test_operators_and_dropped_files(found):
    assert found["operator"] == [["FINISHED"], "moving", 10]
    assert found["written"] == [["FINISHED"], True]
    near, far = found["looks"]
    assert near > far
    assert "broken.bsm" in found["broken"]
    assert found["handler"] == ".bsm"


def test_the_zip_has_what_blender_asks_for(tmp_path, capsys):
    wheels = [tmp_path / "bsm_codec-1-py3-none-any.whl", tmp_path / "msgpack-1-py3-none-any.whl"]
    for wheel in wheels:
        wheel.write_bytes(b"a wheel")
    main(["-o", str(tmp_path / "a.zip"), "--wheel", str(wheels[0]), "--wheel", str(wheels[1])])
    assert capsys.readouterr().out.strip().endswith("a.zip")
    with zipfile.ZipFile(tmp_path / "a.zip") as archive:
        names = archive.namelist()
        manifest = tomllib.loads(archive.read("blender_manifest.toml").decode())
    assert {"blender_manifest.toml", "__init__.py", "objects.py", "LICENSE"} < set(names)
    assert (
        manifest["id"] == "bsm"
        and manifest["version"].count(".") == 2
        and manifest["type"] == "add-on"
    )
    assert [name.removeprefix("./") for name in manifest["wheels"]] == [
        name for name in names if name[:6] == "wheels"
    ]
    assert len(manifest["wheels"]) == 2 and manifest["permissions"]["files"]
