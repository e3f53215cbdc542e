"""Moving GLBs against what three.js shows of them, frame by frame."""

import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree

from bsm.files.motion.frames import Shared, Wanted
from bsm.files.sequence import open_sequence
from tests.motion import bending, save_frames

ROOT = Path(__file__).parents[3]
MOVING = Path(__file__).parent / "moving"
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
    frames = np.array(list(open_sequence(str(MOVING / f"{name}.glb"), wanted=Wanted()).frames))
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
