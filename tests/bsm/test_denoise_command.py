"""bsm denoise: words that a user types, and their results."""

import json
import os
import shutil
import subprocess
import sys
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from bsm import DenoiseOptions, MeshError, TriangleMesh, api, read_mesh, save
from bsm.codec import denoise as library
from bsm.codec.denoise import filters, rehearsal, surface
from bsm.codec.denoise.coarse import FEWEST_FRAMES
from bsm.codec.denoise.frames import WINDOW
from bsm.commands.denoise import FINISHES, GOALS, _found
from bsm.commands.flags import FLAGS
from tests.bsm import program
from tests.shapes import file_of, mnd, theta, torus
from tools.noise import denoise_automatically, gaussian_along_normals
from tools.sampled import ball, voxelized

CLEAN = torus(36, 28, bumps=0.02)
NOISY = gaussian_along_normals(CLEAN.positions, CLEAN.faces, 0.25, seed=3)
bsm = partial(program.bsm, text=True)
FEW = ("--iterations", "2", "--block-size", "200")


@pytest.fixture(scope="module")
def noisy_file(tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp("denoise") / "noisy.ply"
    save(TriangleMesh(NOISY, CLEAN.faces), path)
    return path


@pytest.fixture(scope="module")
def frames() -> np.ndarray:
    """More frames than pass the coarse step together."""
    scales = np.linspace(1.0, 1.5, 11)
    return np.stack(
        [gaussian_along_normals(CLEAN.positions * s, CLEAN.faces, 0.2, seed=2) for s in scales]
    )


def test_every_finish_has_words():
    choice = denoise_automatically(NOISY, CLEAN.faces)[1]
    for finish in ("learnt", "flat", "flat, learnt"):
        told = list(_found(replace(choice, finish=finish), "shading", 1.0))
        assert told[-1] == f"finish     {FINISHES[finish]}"


def test_without_options_it_says_what_it_chose(noisy_file, tmp_path):
    ran = bsm("denoise", noisy_file, "-o", tmp_path / "out.obj", "--json")
    assert ran.returncode == 0
    result = json.loads(ran.stdout)
    expected, choice = denoise_automatically(read_mesh(noisy_file).mesh.positions, CLEAN.faces)
    denoised = read_mesh(tmp_path / "out.obj").mesh
    assert np.allclose(denoised.positions, expected, atol=1e-6)
    assert [step["iterations"] for step in result["automatic"]["steps"]] == [
        step.iterations for step in choice.steps
    ]
    assert result["automatic"]["kind"] == "white"
    assert result["automatic"]["noise"]["normal"] == pytest.approx(0.25, rel=0.3)
    assert result["options"] is None
    assert f"{choice.steps[0].iterations} iterations" in ran.stderr
    assert f"{choice.noise.normal:.2f} edges" in ran.stderr
    assert choice.reason in ran.stderr
    before, after = (
        theta(CLEAN.positions, positions, CLEAN.faces) for positions in (NOISY, denoised.positions)
    )
    assert after < 0.5 * before


@pytest.mark.parametrize("goal", ["shading", "shape"])
def test_no_error_is_promised_where_none_is_known(tmp_path, goal):
    pytest.importorskip("vtkmodules")
    stairs = voxelized(ball, 30)
    save(TriangleMesh(stairs.positions, stairs.faces), tmp_path / "stairs.ply")
    said = bsm("denoise", tmp_path / "stairs.ply", "-o", tmp_path / "out.ply", "--for", goal).stderr
    assert "stairs along x, y and z" in said and "the error cannot be estimated here" in said
    assert " -> 0.00" not in said and "rays" not in said


def test_a_clean_mesh_comes_back_with_a_sentence(tmp_path):
    save(CLEAN, tmp_path / "clean.npz")
    ran = bsm("denoise", tmp_path / "clean.npz", "-o", tmp_path / "out.npz")
    assert ran.returncode == 0
    assert "unchanged  " in ran.stderr
    assert (read_mesh(tmp_path / "out.npz").mesh.positions == CLEAN.positions).all()
    command = (
        ran.stderr.split("choose a filter: bsm ")[1]
        .splitlines()[0]
        .replace("IN", str(tmp_path / "clean.npz"))
    )
    assert bsm(*command.split(), "-o", tmp_path / "forced.npz").returncode == 0
    assert (read_mesh(tmp_path / "forced.npz").mesh.positions != CLEAN.positions).any()


def test_a_mesh_that_stays_as_it_was_is_copied_with_what_it_names(tmp_path):
    (tmp_path / "out").mkdir()
    named = b"mtllib red.mtl\nusemtl red\n" + file_of(CLEAN, "obj") + b"# as it was\n"
    files = {
        "red.mtl": b"newmtl red\nKd 1 0 0\n",
        "clean.obj": named,
        "clean.glb": file_of(CLEAN, "glb") + b"    ",
    }
    for name, data in files.items():
        (tmp_path / name).write_bytes(data)
    for name in ("clean.obj", "clean.glb"):
        ran = bsm("denoise", tmp_path / name, "-o", tmp_path / "out" / name)
        assert ran.returncode == 0 and "copied" in ran.stderr and "left out" not in ran.stderr
    assert {name: (tmp_path / "out" / name).read_bytes() for name in files} == files
    (tmp_path / "red.mtl").unlink()
    assert (
        "left out: red.mtl"
        in bsm("denoise", tmp_path / "clean.obj", "-o", tmp_path / "out" / "b.obj").stderr
    )
    assert (
        "copied"
        not in bsm("denoise", tmp_path / "clean.obj", "-o", tmp_path / "out" / "c.off").stderr
    )


def test_harm_has_an_exit_code_of_its_own_and_writes_nothing_unless_forced(tmp_path):
    save(CLEAN, tmp_path / "clean.npz")
    arguments = (
        "denoise",
        tmp_path / "clean.npz",
        "-o",
        tmp_path / "out.npz",
        "--keep",
        "0.05",
        *FEW,
    )
    ran = bsm(*arguments)
    assert ran.returncode == 11
    assert "force" in ran.stderr and "frame" not in ran.stderr
    assert not (tmp_path / "out.npz").exists()
    assert bsm(*arguments, "--force").returncode == 0
    assert (read_mesh(tmp_path / "out.npz").mesh.positions != CLEAN.positions).any()


def test_every_option_reaches_the_library(noisy_file, tmp_path):
    given = ("--fine", "bilateral-normal", "--hand-over", "normals", "--keep", "0.2", *FEW)
    given = (*given, "--method", "oi", "--power", "2", "--rounds", "3")
    ran = bsm("denoise", noisy_file, "-o", tmp_path / "out.ply", "--json", "-q", *given)
    assert ran.returncode == 0 and ran.stderr == ""
    assert json.loads(ran.stdout)["options"] == {
        "method": "oi",
        "power": 2,
        "rounds": 3,
        "fine": "bilateral-normal",
        "hand_over": "normals",
        "keep": 0.2,
        "iterations": 2,
        "block_size": 200,
    }


def test_an_npz_sequence_is_denoised_frame_by_frame(frames, tmp_path):
    np.savez_compressed(
        tmp_path / "run.npz", positions=frames.astype(np.float32), faces=CLEAN.faces
    )
    ran = bsm("denoise", tmp_path / "run.npz", "-o", tmp_path / "out.npz", "--json", *FEW)
    assert ran.returncode == 0, ran.stderr
    assert json.loads(ran.stdout)["frames"] == len(frames)
    with np.load(tmp_path / "out.npz") as out:
        assert out["positions"].shape == frames.shape
        assert (out["faces"] == CLEAN.faces).all()
        two = frames[[-1, 0]].astype(np.float32)
        np.savez_compressed(tmp_path / "two.npz", positions=two, faces=CLEAN.faces)
        assert (
            bsm("denoise", tmp_path / "two.npz", "-o", tmp_path / "two_out.npz", *FEW).returncode
            == 0
        )
        with np.load(tmp_path / "two_out.npz") as others:
            assert np.abs(out["positions"][[-1, 0]] - others["positions"]).max() < 1e-10


def test_a_folder_of_frames_becomes_a_folder(frames, tmp_path):
    (tmp_path / "in").mkdir()
    for number, frame in enumerate(frames[:3]):
        save(TriangleMesh(frame, CLEAN.faces), tmp_path / "in" / f"frame{number}.obj")
    ran = bsm("denoise", tmp_path / "in", "-o", tmp_path / "out", *FEW)
    assert ran.returncode == 0, ran.stderr
    assert len(list((tmp_path / "out").iterdir())) == 3


def test_frames_come_and_go_through_pipes(frames, tmp_path):
    with open(tmp_path / "in.npy", "wb") as file:
        np.save(file, CLEAN.faces)
        for frame in frames[:3]:
            np.save(file, frame)
    with open(tmp_path / "in.npy", "rb") as source, open(tmp_path / "out.npy", "wb") as sink:
        command = [
            sys.executable,
            "-m",
            "bsm",
            "denoise",
            "-",
            "-o",
            "-",
            "--format",
            "npy",
            "-q",
            *FEW,
        ]
        subprocess.run(
            command, stdin=source, stdout=sink, timeout=120, cwd=program.ROOT, check=True
        )
    expected = library.FrameDenoiser(
        frames[0], CLEAN.faces, DenoiseOptions(iterations=2, block_size=200)
    )(frames[:3])
    with open(tmp_path / "out.npy", "rb") as file:
        assert (np.load(file) == CLEAN.faces).all()
        for frame in expected:
            assert np.allclose(np.load(file), frame, atol=1e-10)
        assert file.read() == b""


@pytest.mark.parametrize("options", [None, DenoiseOptions(iterations=1)])
def test_frames_that_are_none_are_refused(frames, options):
    broken = frames[0].copy()
    broken[5, 1] = np.nan
    with pytest.raises(MeshError, match="finite"):
        library.FrameDenoiser(broken, CLEAN.faces, options)
    denoiser = library.FrameDenoiser(frames[0], CLEAN.faces, options)
    with pytest.raises(MeshError, match="finite"):
        list(denoiser([frames[0], broken]))
    with pytest.raises(MeshError, match="shape"):
        list(denoiser([frames[0][1:]]))


def test_the_command_knows_all_choices_of_the_library():
    choices = {flag.field: set(flag.value.split("|")) for flag in FLAGS["denoise method"]}
    assert choices["fine"] == set(surface.FINE_STEPS) and choices["hand_over"] == set(
        filters.HAND_OVERS
    )
    assert set(GOALS) <= set(rehearsal.GOALS)


def test_no_more_than_a_few_frames_are_held():
    still, held, most = torus(16, 12), 0, 0

    def endless():
        nonlocal held, most
        while True:
            held += 1
            most = max(most, held)
            yield still.positions

    denoiser = library.FrameDenoiser(still.positions, still.faces)
    results = denoiser(endless())
    for _ in range(2 * WINDOW + 5):
        assert next(results).shape == still.positions.shape
        held -= 1
    assert most <= WINDOW + FEWEST_FRAMES + 2 * (os.cpu_count() or 1) + 2


def test_compare_measures_surfaces_when_asked_to(noisy_file, tmp_path):
    save(CLEAN, tmp_path / "clean.npz")
    plain, full = (
        json.loads(bsm("compare", tmp_path / "clean.npz", noisy_file, "--json", *flag).stdout)
        for flag in ((), ("--surface",))
    )
    noisy = read_mesh(noisy_file).mesh.positions
    assert plain.items() <= full.items() and "mnd" not in plain
    assert full["mnd"] == pytest.approx(mnd(CLEAN.positions, noisy, CLEAN.faces))
    assert full["rms_over_edge"] == pytest.approx(0.25, rel=0.1)
    assert 0 < full["surface_distance"] < full["hausdorff"] <= full["max_error"]
    assert full["hausdorff_relative"] == pytest.approx(full["hausdorff"] / CLEAN.diagonal)


def test_the_default_name_a_folder_of_meshes_and_strength(noisy_file, tmp_path):
    folder = tmp_path / "scans"
    folder.mkdir()
    shutil.copy(noisy_file, folder / "a.ply")
    save(TriangleMesh(CLEAN.positions, CLEAN.faces[:-1]), folder / "b.ply")
    ran = bsm("denoise", folder, "-o", tmp_path / "out")
    assert ran.returncode == 0, ran.stderr
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == ["a.ply", "b.ply"]
    whole = read_mesh(tmp_path / "out" / "a.ply").mesh.positions
    ran = bsm("denoise", folder / "a.ply", "--strength", "0.5", "--look", "--json")
    assert ran.returncode == 0, ran.stderr
    half = read_mesh(folder / "a.denoised.ply").mesh.positions
    noisy = read_mesh(noisy_file).mesh.positions
    assert half == pytest.approx(0.5 * (noisy + whole), abs=1e-6)
    facts = json.loads(ran.stdout)
    far = np.linalg.norm(half - noisy, axis=1)
    assert facts["moved"]["farthest"] == pytest.approx(far.max(), rel=1e-3)
    assert facts["moved"]["mean"] == pytest.approx(far[far > 0.0].mean(), rel=1e-3)
    assert facts["look"]["distance"] > 0.0
    assert "edges" in ran.stderr and "on average" in ran.stderr and "from the input" in ran.stderr
    assert bsm("denoise", noisy_file, "-o", tmp_path / "x.ply", "--strength", "2").returncode != 0


def test_streams_are_written_as_well(noisy_file, tmp_path):
    assert bsm("denoise", noisy_file, "-o", tmp_path / "a.bsm").returncode == 0
    assert bsm("denoise", noisy_file, "-o", tmp_path / "a.ply").returncode == 0
    streamed, written = api.load(tmp_path / "a.bsm"), read_mesh(tmp_path / "a.ply").mesh
    diagonal = np.linalg.norm(np.ptp(written.positions, axis=0))
    assert len(streamed.positions) == len(written.positions)
    assert np.ptp(streamed.positions, axis=0) == pytest.approx(
        np.ptp(written.positions, axis=0), abs=2e-3 * diagonal
    )
