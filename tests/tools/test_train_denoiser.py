"""Made shapes and the training on them: closed, oriented, deterministic; and something is learnt."""

import numpy as np
import pytest

from bsm.codec.denoise.learnt.descriptors import BASE
from bsm.codec.denoise.surface import Topology, face_geometry
from tools.made_shapes import made_shape
from tools.noise import gaussian_along_normals
from tools.train_denoiser import Example, described, train


@pytest.mark.parametrize("seed", range(6))
def test_made_shapes_are_closed_look_outwards_and_are_repeated(seed: int) -> None:
    positions, faces = made_shape(seed, 18)
    assert np.isfinite(positions).all() and len(faces) > 100
    assert not Topology(faces, len(positions)).boundary.any()
    corners = positions[faces]
    assert np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() > 0.0
    again, other = made_shape(seed, 18)
    assert (again == positions).all() and (other == faces).all()


@pytest.mark.slow
def test_training_learns_and_is_repeated() -> None:
    cases = []
    for seed in range(3):
        positions, faces = made_shape(seed, 16)
        noisy = gaussian_along_normals(positions, faces, 0.3, seed)
        normals = face_geometry(positions, faces).normals
        cases.append(Example(Topology(faces, len(positions)), noisy, normals, np.arange(len(faces))))
    numbers, wanted = described(cases)
    first, again = (train(numbers, wanted, 1, rounds=25) for _ in range(2))
    apart = np.linalg.norm(first(numbers) - wanted, axis=1).mean()
    assert apart < 0.9 * np.linalg.norm(numbers[:, BASE] - wanted, axis=1).mean()
    assert (first(numbers) == again(numbers)).all()
