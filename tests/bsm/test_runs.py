"""Sequences whose faces change, as users meet them."""

import json
from dataclasses import replace

import numpy as np
import pytest

import bsm
from bsm import Attribute, read_mesh
from bsm.files.table import FORMATS
from tests.bsm.program import run
from tests.gltf import unpack
from tests.motion import capture, sequence_in
from tests.shapes import ply_head
from tools.vectors.meshes import torus

RUNS = ("--runs", "--set", "step=0.002")
PIECES = ((10, 4), (7, 3), (10, 2))


def written(folder, meshes, kind="ply"):
    folder.mkdir()
    paths = [folder / f"f{number:03d}.{kind}" for number in range(len(meshes))]
    for path, mesh in zip(paths, meshes, strict=True):
        bsm.save(mesh, path)
    return paths


@pytest.fixture
def stream(tmp_path):
    paths = written(tmp_path / "capture", capture(*PIECES))
    assert run("encode", *paths, "-o", tmp_path / "a.bsm", *RUNS, "-q") == 0
    return tmp_path / "a.bsm"


def test_frames_of_other_faces_are_an_error_that_says_how_to_permit_them(tmp_path, capsys):
    paths = written(tmp_path / "capture", capture(*PIECES))
    assert run("encode", *paths, "-o", tmp_path / "a.bsm") != 0
    printed = capsys.readouterr().err
    assert (
        "f004.ply (frame 4) has other faces than" in printed
        and "42 vertices where there were 60" in printed
    )
    assert "--runs" in printed and not (tmp_path / "a.bsm").exists()


@pytest.mark.parametrize("kind", ["obj", "ply"])
def test_every_frame_comes_back_with_its_faces(stream, tmp_path, kind, capsys):
    assert run("decode", stream, "-o", tmp_path / "back" / f"%03d.{kind}") == 0
    assert "connectivity changes at frames 4, 7" in capsys.readouterr().err
    for number, mesh in enumerate(capture(*PIECES)):
        back = read_mesh(str(tmp_path / "back" / f"{number:03d}.{kind}")).mesh
        assert (len(back.positions), len(back.faces)) == (len(mesh.positions), len(mesh.faces))
    assert run("compare", tmp_path / "capture", tmp_path / "back", "--json") == 0
    found = json.loads(capsys.readouterr().out)
    assert len(found["frames"]) == 9 and found["max_error_relative"] <= 0.01
    assert run("compare", tmp_path / "capture", stream, "--look") == 0
    assert "look_worst" in capsys.readouterr().out


@pytest.mark.parametrize("way", ["corner", "order", "copy"])
def test_runs_that_differ_in_numbers_or_in_faces_without_area_are_compared(tmp_path, way, capsys):
    """The stream needs one run for them."""
    meshes = capture((10, 6))
    for number, mesh in enumerate(meshes):
        positions, faces = mesh.positions, mesh.faces
        late = number >= 3
        if way == "copy" and late:  # a vertex at the place of another
            faces = faces.copy()
            faces[tuple(np.argwhere(faces == 0)[0])] = len(positions)
            positions = np.vstack([positions, positions[:1]])
        elif way != "copy":  # a face that has two corners at one place
            faces = np.vstack(
                [faces, [[0, 0, 1] if not late else [0, 1, 1] if way == "corner" else [1, 0, 0]]]
            )
        meshes[number] = bsm.TriangleMesh(positions, faces)
    written(tmp_path / "capture", meshes)
    assert run("encode", tmp_path / "capture", "-o", tmp_path / "a.bsm", *RUNS, "-q") == 0
    capsys.readouterr()
    assert run("compare", tmp_path / "capture", tmp_path / "a.bsm", "--json", "--look") == 0
    found = json.loads(capsys.readouterr().out)
    assert (
        len(found["frames"]) == 6
        and 0.0 < found["max_error_relative"] <= 0.01
        and found["look_worst"] > 0.0
    )


def test_what_cannot_hold_them_says_so(stream, tmp_path, capsys):
    for kind in ("npz", "npy"):
        assert run("decode", stream, "-o", tmp_path / f"a.{kind}") != 0
        printed = capsys.readouterr().err
        assert f"{kind.upper()} holds one set of faces, and they change after 4 frames" in printed
        assert not (tmp_path / f"a.{kind}").exists()
        assert run("decode", stream, "-o", tmp_path / f"{kind}.{kind}", "--frames", ":4") == 0
        capsys.readouterr()


@pytest.mark.parametrize("kind", ["pc2", "mdd"])
def test_caches_are_a_series(stream, tmp_path, kind):
    assert run("decode", stream, "-o", tmp_path / f"a.{kind}") == 0
    starts = [0, 4, 7]
    names = [f"a_{start:05d}.{suffix}" for start in starts for suffix in ("obj", kind)]
    assert sorted(path.name for path in tmp_path.glob("a_*")) == sorted(names)
    meshes = capture(*PIECES)
    for start, (_, count) in zip(starts, PIECES, strict=True):
        source = sequence_in(str(tmp_path / f"a_{start:05d}.{kind}"))
        frames = np.array(list(source.frames))
        assert frames.shape == (count, len(meshes[start].positions), 3) and len(
            source.faces
        ) == len(meshes[start].faces)
        assert np.allclose(
            np.ptp(frames[-1], axis=0),
            np.ptp(meshes[start + count - 1].positions, axis=0),
            atol=0.05,
        )


def test_meshes_of_a_glb_take_turns(stream, tmp_path):
    """Each frame shows its own mesh, as a player of glTF evaluates scales and weights."""
    assert run("decode", stream, "-o", tmp_path / "a.glb") == 0
    tree, _ = unpack((tmp_path / "a.glb").read_bytes())
    assert [len(mesh["primitives"][0]["targets"]) for mesh in tree["meshes"]] == [
        count - 1 for _, count in PIECES
    ]
    source = sequence_in(str(tmp_path / "a.glb"), animation="frames", rate=24.0)
    ends = np.cumsum([0, *(len(torus(size, 6).positions) for size, _ in PIECES)])
    frames, meshes = list(source.frames), capture(*PIECES)
    assert source.count == len(frames) == len(meshes)
    turns = [number for number, (_, count) in enumerate(PIECES) for _ in range(count)]
    for frame, mesh, turn in zip(frames, meshes, turns, strict=True):
        for other in range(len(PIECES)):
            part = frame[ends[other] : ends[other + 1]]
            shown = np.ptp(mesh.positions, axis=0) if other == turn else np.zeros(3)
            assert np.allclose(np.ptp(part, axis=0), shown, atol=0.05)


EMPTY = {kind: row.empty for kind, row in FORMATS.items() if row.empty is not None}
EMPTY["ply"] = f"{ply_head(1, 0)}1 2 3\n".encode()  # a point


@pytest.mark.parametrize("kind", EMPTY)
@pytest.mark.parametrize("places", [(2,), (0, 5, 8)])
def test_frames_without_faces_come_back(tmp_path, capsys, kind, places):
    paths = written(tmp_path / "capture", capture(*PIECES), kind)
    for place in places:
        paths[place].write_bytes(EMPTY[kind])
    assert run("encode", tmp_path / "capture", "-o", tmp_path / "a.bsm", "--runs", "--look", 1) == 0
    assert run("decode", tmp_path / "a.bsm", "-o", tmp_path / "back" / f"%03d.{kind}") == 0
    assert run("encode", tmp_path / "capture", "-f", "-o", tmp_path / "b.bsm") == 3
    assert "--runs, frames may be without" in capsys.readouterr().err
    for number, mesh in enumerate(capture(*PIECES)):
        back = tmp_path / "back" / f"{number:03d}.{kind}"
        if number in places:
            with pytest.raises(bsm.MeshError, match="no faces"):
                read_mesh(str(back))
        else:
            assert len(read_mesh(str(back)).mesh.faces) == len(mesh.faces)


def test_frames_without_faces_go_to_usd_and_come_back(tmp_path):
    pytest.importorskip("pxr.Usd")
    nothing = np.zeros((0, 3)), np.zeros((0, 3), np.int32)
    meshes = [*capture((10, 2)), nothing, nothing, *capture((7, 1))]
    (tmp_path / "a.bsm").write_bytes(bsm.encode_frames(meshes))
    assert run("decode", tmp_path / "a.bsm", "-o", tmp_path / "a.usda", "-q") == 0
    assert run("encode", tmp_path / "a.usda", "-o", tmp_path / "b.bsm", "--runs", "-q") == 0
    assert [len(frame.faces) for frame in bsm.decode_frames(tmp_path / "b.bsm")] == [
        120,
        120,
        1,
        1,
        84,
    ]
    assert run("decode", tmp_path / "b.bsm", "-o", tmp_path / "a.glb", "-q") == 0


def test_usd_has_time_samples_of_faces(stream, tmp_path, capsys):
    pytest.importorskip("pxr.Usd")
    assert run("decode", stream, "-o", tmp_path / "a.usdc", "-q") == 0
    assert run("compare", stream, tmp_path / "a.usdc") != 0
    assert "change" in capsys.readouterr().err
    assert run("encode", tmp_path / "a.usdc", "-o", tmp_path / "b.bsm") != 0
    assert "--runs" in capsys.readouterr().err
    assert (
        run(
            "encode", tmp_path / "a.usdc", "-o", tmp_path / "b.bsm", "--runs", "--max-error", "1e-3"
        )
        == 0
    )
    assert "connectivity changes at frames 4, 7" in capsys.readouterr().err
    assert run("compare", stream, tmp_path / "b.bsm", "--json") == 0
    assert json.loads(capsys.readouterr().out)["max_error_relative"] < 2e-3


def test_colors_of_runs_go_to_usd_and_come_back(tmp_path):
    pytest.importorskip("pxr.Usd")
    meshes = [
        replace(
            mesh,
            attributes=(
                Attribute(
                    "color", np.full((len(mesh.positions), 3), 20 * k, np.uint8), "vertex", "color"
                ),
            ),
        )
        for k, mesh in enumerate(capture((10, 1), (7, 1), (5, 1)))
    ]
    data = bsm.encode_frames(meshes, step=0.002)
    (tmp_path / "a.bsm").write_bytes(data)
    assert run("decode", tmp_path / "a.bsm", "-o", tmp_path / "a.usda", "-q") == 0
    assert run("encode", tmp_path / "a.usda", "-o", tmp_path / "b.bsm", *RUNS, "-q") == 0
    shades = [
        int(frame.attributes[0].values[0, 0]) for frame in bsm.decode_frames(tmp_path / "b.bsm")
    ]
    assert shades == [0, 20, 40]


def test_info_tells_of_runs(stream, capsys):
    assert run("info", stream) == 0
    printed = capsys.readouterr().out
    assert "9 frames" in printed and "connectivity changes at frames 4, 7" in printed
    assert "run 1: 3 frames from 4 on, 42 vertices, 84 faces" in printed
    assert "run 2: 2 frames from 7 on, 60 vertices, 120 faces, the mesh of run 0 again" in printed
    assert run("info", stream, "--json") == 0
    found = json.loads(capsys.readouterr().out)
    assert [run["mesh"] for run in found["runs"]] == [0, 1, 0]
    samples = 60 * 6 + 42 * 3
    assert found["bpvf_total"] == pytest.approx(8 * stream.stat().st_size / samples)


def test_verify_and_part_of_a_sequence(stream, tmp_path):
    assert run("verify", stream) == 0
    assert run("decode", stream, "-o", tmp_path / "part.npz", "--frames", "4:7", "-q") == 0
    assert np.load(tmp_path / "part.npz")["positions"].shape == (3, 42, 3)


def test_permutations_are_of_one_mesh(stream, tmp_path, capsys):
    order = tmp_path / "order.npy"
    words = (
        "encode",
        tmp_path / "capture",
        "-o",
        tmp_path / "b.bsm",
        "--runs",
        "--permutation",
        order,
    )
    assert run(*words) != 0
    assert "order of one mesh" in capsys.readouterr().err


def test_functions():
    meshes = capture(*PIECES)
    data = bsm.encode_frames(iter(meshes), step=0.002)
    back = list(bsm.decode_frames(data))
    assert [len(frame.faces) for frame in back] == [len(mesh.faces) for mesh in meshes]
    with pytest.raises(bsm.MeshError, match="decode_frames"):
        bsm.decode_sequence(data)
    with pytest.raises(bsm.MeshError, match="other faces"):
        bsm.encode_frames(meshes, runs=False)
    with pytest.raises(bsm.MeshError, match="at least one frame"):
        bsm.encode_frames([])
    same = bsm.encode_frames([(mesh.positions, mesh.faces) for mesh in meshes[:4]], step=0.002)
    positions, faces = bsm.decode_sequence(same)
    assert positions.shape == (4, 60, 3) and len(faces) == 120
