"""Noise has the strength, the direction and the share of vertices it was asked for, and is repeatable."""

import numpy as np
import pytest

from bsm.bitstream.errors import OptionError
from bsm.codec.geometry.metrics import mean_edge_length
from tests.codec.denoise.denoise_shapes import sphere
from tools.noise import gaussian_along_normals, gaussian_isotropic, impulsive

POSITIONS, FACES = sphere(24)
EDGE = mean_edge_length(POSITIONS, FACES)


def test_gaussian_noise_has_the_asked_deviation() -> None:
    along = gaussian_along_normals(POSITIONS, FACES, 0.3, seed=1) - POSITIONS
    assert np.linalg.norm(along) / np.sqrt(len(POSITIONS)) == pytest.approx(0.3 * EDGE, rel=0.05)
    radial = np.einsum("ij,ij->i", along, POSITIONS)
    assert np.linalg.norm(along - radial[:, None] * POSITIONS) < 0.05 * np.linalg.norm(along)
    everywhere = gaussian_isotropic(POSITIONS, FACES, 0.3, seed=1) - POSITIONS
    assert everywhere.std(axis=0) == pytest.approx(0.3 * EDGE, rel=0.05)


def test_impulsive_noise_moves_the_asked_share() -> None:
    moved = (impulsive(POSITIONS, FACES, 0.5, 0.25, seed=2) != POSITIONS).any(axis=1)
    assert moved.sum() == round(0.25 * len(POSITIONS))
    assert (impulsive(POSITIONS, FACES, 0.5, 0.0, seed=2) == POSITIONS).all()


def test_the_seed_decides() -> None:
    assert (gaussian_isotropic(POSITIONS, FACES, 0.1, 7) == gaussian_isotropic(POSITIONS, FACES, 0.1, 7)).all()
    assert (gaussian_isotropic(POSITIONS, FACES, 0.1, 7) != gaussian_isotropic(POSITIONS, FACES, 0.1, 8)).all()


@pytest.mark.parametrize("sigma", [-0.1, np.nan, np.inf])
def test_illegal_strengths_are_refused(sigma: float) -> None:
    with pytest.raises(OptionError):
        gaussian_along_normals(POSITIONS, FACES, sigma, seed=0)
