"""Each figure that `bsm encode` states is what `bsm compare` of the given file and the stream finds."""

import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import bsm
from bsm.jobs.report import largest_error
from tests.bsm.program import bsm as program
from tests.bsm.program import run_json
from tests.motion import bending
from tests.shapes import patch, soup, torus
from tools.attack.figures import CHANGES, MOVING, STATIC, cases, moving, odd, of_frames, of_mesh

QUICK = [words for words in STATIC if "best" not in words]
SEEDS = st.integers(0, 10**6)


def of_odd_mesh(seed, changes, words, folder, suffix):
    names = {words[-1].partition("=")[0]} & {"color", "normal"} if "--attribute" in words else set()
    return of_mesh(odd(np.random.default_rng(seed), sorted(changes | names)), words, folder, suffix)


@settings(max_examples=20, derandomize=True)
@given(
    SEEDS,
    st.sets(st.sampled_from(CHANGES), max_size=4),
    st.sampled_from(QUICK),
    st.sampled_from(["npz", "ply"]),
)
def test_of_odd_meshes(tmp_path_factory, seed, changes, words, suffix):
    folder = tmp_path_factory.mktemp("odd")
    assert not of_odd_mesh(seed, changes, words, folder, suffix)


@settings(max_examples=6, derandomize=True)
@given(
    SEEDS,
    st.sets(st.sampled_from(CHANGES[:5]), max_size=2),
    st.sampled_from(MOVING),
    st.integers(3, 8),
)
def test_of_odd_sequences(tmp_path_factory, seed, changes, words, frames):
    random = np.random.default_rng(seed)
    mesh = odd(random, sorted(changes))
    assert not of_frames(
        moving(random, mesh, frames), mesh.faces, words, tmp_path_factory.mktemp("odd")
    )


@pytest.mark.slow
@pytest.mark.parametrize("first", range(0, 60, 20))
def test_of_more(tmp_path, first):
    found = [problem for seed in range(first, first + 20) for problem in cases(seed, tmp_path)]
    assert not found + [
        problem
        for seed in range(first, first + 6)
        for problem in cases(seed, tmp_path, frames=True)
    ]


@pytest.mark.real
@pytest.mark.slow
@pytest.mark.parametrize("name", ["block", "sharpsphere", "fandisk_6475"])
@pytest.mark.parametrize("words", [(), ("--keep-order", "--preset", "fine"), ("--simplify",)])
def test_of_real_meshes(meshes, tmp_path, name, words):
    assert not of_mesh(meshes / "static" / f"{name}.ply", words, tmp_path)


def test_vertices_at_one_place_are_measured_once_whatever_is_kept(tmp_path):
    """A soup that keeps its order comes back as one: its vertices have the neighbors of the surface all the same."""
    pieces = soup(patch(7, 7))
    for words in (("--keep-order",), ()):
        assert of_mesh(pieces, words, tmp_path) == []
    frames = np.array(
        [
            pieces.positions * (1.0 + 0.1 * t) + 0.05 * np.sin(9.0 * pieces.positions + t)
            for t in range(4)
        ]
    )
    assert of_frames(frames, pieces.faces, ("--keep-order", "--kg", "0.2"), tmp_path) == []


def test_vertices_that_part_later_are_compared(tmp_path):
    """Two copies part in the third frame, and two never do: the encoder merges these."""
    positions, faces = bending(4, 12, 8)
    faces = faces.copy()
    for copy, vertex in enumerate((3, 20)):
        faces[tuple(np.argwhere(faces == vertex)[0])] = positions.shape[1] + copy
    positions = np.concatenate([positions, positions[:, [3, 20]]], axis=1)
    positions[2:, -1] += 0.01
    assert of_frames(positions, faces, (), tmp_path) == []


def test_lengths_do_not_count_vertices_in_no_face(tmp_path):
    mesh = torus(12, 8)
    far = bsm.TriangleMesh(np.vstack([mesh.positions, [[900.0, 0.0, 0.0]]]), mesh.faces)
    for words in (("--meta", "unit=mm"), ("--meta", "unit=mm", "--simplify", "--preset", "small")):
        assert of_mesh(far, words, tmp_path) == []
    bsm.save(far, tmp_path / "far.npz")
    done = program(
        "encode", tmp_path / "far.npz", "--meta", "unit=mm", "--max-error", "2mm", text=True
    )
    assert "of this mesh's size" in done.stderr


def test_batches_tell_vertices_from_surfaces():
    """With fewer triangles, the error is a distance of surfaces."""
    found = [
        {"input": "a", "max_error_relative": 0.002, "error_of": "vertices"},
        {"input": "b", "max_error_relative": 0.004, "error_of": "surfaces"},
        {"input": "c", "max_error_relative": 0.001, "error_of": "vertices"},
        {
            "input": "d",
            "max_error_relative": 0.003,
            "error_of": "vertices",
            "max_error": 0.5,
            "unit": "mm",
        },
    ]
    assert largest_error(found) == (
        "0.3 % of the diagonal (d) and 0.4 % of the diagonal (b, surfaces apart)"
    )


def test_of_batches(tmp_path):
    names = [tmp_path / name for name in ("a.ply", "b.npz", "c.npz")]
    for name, mesh in zip(names, (torus(12, 8), soup(patch(6, 6)), patch(9, 5)), strict=True):
        bsm.save(mesh, name)
    found = run_json("encode", *names, "-o", f"{tmp_path}/out/", "--report", tmp_path / "r.json")[
        "files"
    ]
    report = json.loads((tmp_path / "r.json").read_text())
    assert report["files"] == found
    errors = {}
    for facts in found:
        seen = run_json("compare", facts["input"], facts["output"], "--look")
        errors[seen["max_error_relative"]] = facts["input"]
        assert facts["look"] == pytest.approx(seen["look"]["distance"], rel=1e-3)
        assert facts["angle_deg"] == pytest.approx(seen["angle_deg"], rel=1e-4)
        assert facts["max_error_relative"] == pytest.approx(seen["max_error_relative"], rel=1e-4)
    totals, sizes = (
        report["totals"],
        [(tmp_path / "out" / f"{name.stem}.bsm").stat().st_size for name in names],
    )
    assert totals["output_bytes"] == sum(sizes)
    assert totals["ratio"] == pytest.approx(sum(name.stat().st_size for name in names) / sum(sizes))
    assert (
        totals["largest_error"]
        == f"{100 * max(errors):.3g} % of the diagonal ({errors[max(errors)]})"
    )
