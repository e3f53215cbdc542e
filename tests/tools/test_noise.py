"""Noise has the strength, the direction and the share of vertices it was asked for, and is repeatable."""

import numpy as np
import pytest

from bsm.bitstream.errors import OptionError
from bsm.codec.geometry.graph import mesh_edges
from bsm.codec.geometry.metrics import mean_edge_length
from tests.codec.denoise.denoise_shapes import sphere
from tools.noise import (
    correlated_along_normals,
    gaussian_along_axis,
    gaussian_along_normals,
    gaussian_in_part,
    gaussian_isotropic,
    impulsive,
    uniform_along_normals,
)

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


def test_noise_along_an_axis_moves_along_it_alone() -> None:
    moved = gaussian_along_axis(POSITIONS, FACES, 0.3, 1, (0.0, 2.0, 0.0)) - POSITIONS
    assert (moved[:, [0, 2]] == 0.0).all()
    assert moved[:, 1].std() == pytest.approx(0.3 * EDGE, rel=0.05)
    with pytest.raises(OptionError, match="axis"):
        gaussian_along_axis(POSITIONS, FACES, 0.3, 1, (0.0, 0.0, 0.0))


def test_uniform_noise_is_bounded() -> None:
    amounts = np.linalg.norm(uniform_along_normals(POSITIONS, FACES, 0.3, 1) - POSITIONS, axis=1)
    assert amounts.max() <= np.sqrt(3.0) * 0.3 * EDGE * (1.0 + 1e-9)
    assert np.sqrt(np.square(amounts).mean()) == pytest.approx(0.3 * EDGE, rel=0.05)


def test_correlated_noise_is_shared_by_neighbours() -> None:
    a, b = mesh_edges(FACES, len(POSITIONS)).T
    shared = []
    for make in (gaussian_along_normals, correlated_along_normals):
        amounts = np.einsum("ij,ij->i", make(POSITIONS, FACES, 0.3, 1) - POSITIONS, POSITIONS)
        assert amounts.std() == pytest.approx(0.3 * EDGE, rel=0.1)
        shared.append(np.corrcoef(amounts[a], amounts[b])[0, 1])
    assert abs(shared[0]) < 0.1 < 0.4 < shared[1]


def test_noise_in_part_of_the_mesh_leaves_the_rest_bit_for_bit() -> None:
    moved = (gaussian_in_part(POSITIONS, FACES, 0.3, 0.25, 1) != POSITIONS).any(axis=1)
    assert moved.sum() == pytest.approx(0.25 * len(POSITIONS), abs=1)
    with pytest.raises(OptionError, match="fraction"):
        gaussian_in_part(POSITIONS, FACES, 0.3, 1.5, 1)


def test_the_seed_decides() -> None:
    assert (gaussian_isotropic(POSITIONS, FACES, 0.1, 7) == gaussian_isotropic(POSITIONS, FACES, 0.1, 7)).all()
    assert (gaussian_isotropic(POSITIONS, FACES, 0.1, 7) != gaussian_isotropic(POSITIONS, FACES, 0.1, 8)).all()


@pytest.mark.parametrize("sigma", [-0.1, np.nan, np.inf])
def test_illegal_strengths_are_refused(sigma: float) -> None:
    with pytest.raises(OptionError):
        gaussian_along_normals(POSITIONS, FACES, sigma, seed=0)


@pytest.mark.parametrize("fraction", [-0.1, 1.1, np.nan])
def test_illegal_fractions_are_refused(fraction: float) -> None:
    with pytest.raises(OptionError):
        impulsive(POSITIONS, FACES, 0.1, fraction, seed=0)
