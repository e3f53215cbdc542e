"""The tools that measure the README's figures: what they print, and how they fail."""

import json

import numpy as np

from bsm.files.mesh import write_mesh
from tests.shapes import torus
from tests.tools.running import tool


def test_figures_knows_its_names(tmp_path):
    done = tool("figures", tmp_path, "--only", "nothing")
    assert done.returncode == 2 and "no figure is called nothing" in done.stderr


def test_figures_says_which_mesh_is_missing(tmp_path):
    done = tool("figures", tmp_path, "--only", "basis")
    assert done.returncode == 2 and "holds no bunny_34834" in done.stderr


def test_a_figure(tmp_path, monkeypatch):
    monkeypatch.setattr("tools.measure.figures.BLOCKS", {"torus": 7})
    write_mesh(tmp_path / "torus.npz", torus(30, 30))
    done = tool("figures", tmp_path, "--only", "basis")
    assert done.returncode == 0, done.stderr
    assert "`python -m tools.measure figures FOLDER --only basis`" in done.stdout and "SVD, dB" in done.stdout


def test_sequences(tmp_path):
    mesh = torus(20, 16)
    frames = np.array([mesh.positions * (1 + 0.05 * t) for t in range(6)])
    np.savez(tmp_path / "swelling.npz", positions=frames, faces=mesh.faces)
    done = tool("sequences", tmp_path, "-o", tmp_path / "a.json", "--every", "2")
    assert done.returncode == 0, done.stderr
    result = json.loads((tmp_path / "a.json").read_text())["swelling"]
    assert [point["ours"]["kg"] <= point["draco"]["kg"] for point in result["at_draco"]] == [True, True]
    assert result["goal"]["kg"] <= 0.15


def test_an_unknown_measurement_is_answered_with_the_known_ones():
    done = tool("nothing")
    assert done.returncode == 2 and "house" in done.stdout
