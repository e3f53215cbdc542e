"""Planes that explain a noisy surface: where there are some, where there are none, and vertices on them."""

import numpy as np
import pytest

from bsm.codec.denoise.planes import Planes, find_planes
from bsm.codec.denoise.surface import Topology
from bsm.codec.geometry.metrics import face_normals, mean_edge_length
from tests.codec.denoise.denoise_shapes import cube, sphere
from tools.noise import gaussian_along_normals


def found(clean: np.ndarray, faces: np.ndarray, sigma: float) -> tuple[np.ndarray, Planes]:
    """The noisy mesh and its planes, where the clean mesh shows them."""
    noisy = gaussian_along_normals(clean, faces, sigma, seed=4)
    topology = Topology(faces, len(clean))
    return noisy, find_planes(noisy, clean, sigma * mean_edge_length(clean, faces), topology)


@pytest.mark.parametrize("far", [0.0, 1e5])
@pytest.mark.parametrize("sigma", [0.05, 0.4])
def test_a_cube_is_six_planes(sigma: float, far: float) -> None:
    clean, faces = cube(16)
    clean = clean + far
    noisy, planes = found(clean, faces, sigma)
    assert planes.share == 1.0 and len(np.unique(planes.labels)) == 6
    assert planes.normals[planes.labels] == pytest.approx(face_normals(clean, faces), abs=0.05)
    put = planes.put(noisy, Topology(faces, len(noisy)))
    assert np.linalg.norm(put - noisy, axis=1).max() < 6.0 * sigma * mean_edge_length(clean, faces)
    off = (
        np.einsum("ij,ikj->ik", planes.normals[planes.labels], put[faces])
        - planes.heights[planes.labels][:, None]
    )
    assert np.abs(off).max() < 0.01 * sigma * mean_edge_length(clean, faces)


@pytest.mark.parametrize("size", [12, 30])
@pytest.mark.parametrize("sigma", [0.1, 0.4])
def test_a_ball_has_no_planes(size: int, sigma: float) -> None:
    clean, faces = sphere(size)
    noisy, planes = found(clean, faces, sigma)
    assert planes.share == 0.0
    assert (planes.put(noisy, Topology(faces, len(noisy))) == noisy).all()


def test_only_the_flat_half_of_a_shape_is_put_on_a_plane() -> None:
    clean, faces = sphere(24)
    clean[:, 2] = np.maximum(clean[:, 2], 0.0)
    _, planes = found(clean, faces, 0.2)
    flat = (clean[faces][:, :, 2] == 0.0).all(axis=1)
    assert (planes.labels[flat] >= 0).mean() > 0.98
    assert (planes.labels[~flat] >= 0).mean() < 0.05


def test_no_faces_have_no_planes() -> None:
    planes = find_planes(
        np.zeros((3, 3)), np.zeros((3, 3)), 1.0, Topology(np.array([[0, 1, 2]], np.int32), 3)
    )
    assert planes.share == 0.0
