"""Local frames: orthonormal whatever the surface, smooth in the positions, and inverse to what they add."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from bsm.codec.signal.frames import displaced, in_frames, local_frames
from tests.shapes import tetrahedron, torus


def test_frames_of_a_torus_are_orthonormal_and_stand_on_it() -> None:
    mesh = torus()
    frames = local_frames(mesh.positions, mesh.faces).reshape(-1, 3, 3)
    assert np.abs(frames @ frames.transpose(0, 2, 1) - np.eye(3)).max() < 1e-12
    a, b, c = (mesh.positions[mesh.faces[:, k]] for k in range(3))
    across = np.cross(b - a, c - a)
    assert ((frames[mesh.faces[:, 0], 0] * across).sum(axis=1) > 0).all()


@given(st.integers(0, 2**32 - 1))
def test_a_base_off_by_rounding_turns_frames_by_little(seed: int) -> None:
    mesh = torus(12, 8)
    noise = np.random.default_rng(seed).normal(size=mesh.positions.shape)
    moved = local_frames(mesh.positions + 1e-9 * noise, mesh.faces)
    assert np.abs(moved - local_frames(mesh.positions, mesh.faces)).max() < 1e-5


def test_faces_without_area_have_the_frame_of_the_pole() -> None:
    frames = local_frames(np.zeros((3, 3)), np.array([[0, 1, 2]], np.int32))
    assert np.allclose(frames[:, :3], (0.48, 0.6, 0.64))
    assert np.allclose(frames[:, 3:6], (-0.8, 0.0, 0.6))


def test_levels_add_up_along_the_axes() -> None:
    mesh = tetrahedron()
    frames = local_frames(mesh.positions, mesh.faces)
    levels = np.array([[1, -2, 3], [0, 0, 0], [4, 0, -1], [0, 5, 0]], np.int32)
    moved = displaced(mesh.positions, frames, levels, 0.25, 2.0)
    back = in_frames(moved - mesh.positions, frames)
    assert np.allclose(back, levels * np.array([0.25, 0.5, 0.5]), atol=1e-12)
    heights = displaced(mesh.positions, frames, levels[:, :1], 0.25, 0.0)
    assert np.allclose(in_frames(heights - mesh.positions, frames), levels * np.array([0.25, 0.0, 0.0]), atol=1e-12)
