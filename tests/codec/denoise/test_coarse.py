"""The coarse step is a projection on low graph frequencies, blended; and what is handed over."""

from dataclasses import replace

import numpy as np
import pytest

from bsm import OptionError
from bsm.codec.denoise.coarse import RULES, CoarseFilter
from bsm.codec.denoise.recipe import hand_over
from bsm.codec.denoise.surface import Topology, surface_normals
from bsm.codec.geometry.graph import graph_of_faces
from bsm.codec.geometry.metrics import theta
from bsm.codec.signal.chain import ChainRules
from tests.codec.denoise.denoise_shapes import Partners, cube, sphere
from tools.noise import gaussian_along_normals


def dense_laplacian(faces: np.ndarray, n: int) -> np.ndarray:
    graph = graph_of_faces(faces, n)
    laplacian = np.diag(np.diff(graph.offsets).astype(float))
    laplacian[np.repeat(np.arange(n), np.diff(graph.offsets)), graph.neighbors] = -1
    return laplacian


def test_one_block_with_exact_basis_is_the_spectral_projection() -> None:
    positions, faces = sphere(5)
    n = len(positions)
    noisy = gaussian_along_normals(positions, faces, 0.3, seed=1)
    values, vectors = np.linalg.eigh(dense_laplacian(faces, n))
    # Cut inside a gap of the spectrum, where the subspace is unique.
    width = 10 + int(np.argmax(np.diff(values[9:40])))
    coarse = CoarseFilter(faces, n, keep=width / n, block=n, rules=replace(RULES, exact=True, key_interval=1))
    low = vectors[:, :width]
    assert coarse(noisy, width / n) == pytest.approx(low @ (low.T @ noisy), abs=1e-5)


def test_orthogonal_iterations_approach_the_exact_basis() -> None:
    positions, faces = sphere(12)
    noisy = gaussian_along_normals(positions, faces, 0.3, seed=1)

    def filtered(rules: ChainRules) -> np.ndarray:
        return CoarseFilter(faces, len(positions), 0.1, 200, rules)(noisy, 0.1)

    exact = filtered(replace(RULES, exact=True, key_interval=1))
    apart = [np.linalg.norm(filtered(replace(RULES, iterations=t, key_iterations=t)) - exact) for t in (1, 2, 8, 32)]
    assert apart[0] > apart[1] > apart[2] > apart[3]
    assert apart[2] < 0.25 * np.linalg.norm(noisy - exact)
    assert apart[3] < 0.05 * np.linalg.norm(noisy - exact)


def test_place_is_kept_and_frames_are_filtered_together() -> None:
    positions, faces = cube(10)
    coarse = CoarseFilter(faces, len(positions), 0.2, 150)
    moved = coarse(positions + 5.0, 0.1)
    assert moved == pytest.approx(coarse(positions, 0.1) + 5.0, abs=1e-9)
    frames = np.concatenate([positions, positions**2], axis=1)
    together = coarse(frames, 0.2)
    assert together[:, 3:] == pytest.approx(coarse(positions**2, 0.2), abs=1e-9)


def test_a_smaller_fraction_is_the_same_as_a_smaller_dictionary_and_everything_is_everything() -> None:
    positions, faces = sphere(12)
    whole, large, small = (CoarseFilter(faces, len(positions), keep, 200) for keep in (1.0, 0.3, 0.1))
    assert large(positions, 0.1) == pytest.approx(small(positions, 0.1), abs=1e-8)
    assert whole(positions, 1.0) == pytest.approx(positions, abs=1e-5)


@pytest.mark.parametrize("keep", [0.0, -0.1, 1.5, np.nan])
def test_illegal_fractions_are_refused(keep: float) -> None:
    positions, faces = cube(2)
    with pytest.raises(OptionError):
        CoarseFilter(faces, len(positions), keep)
    with pytest.raises(OptionError):
        CoarseFilter(faces, len(positions), 0.5)(positions, keep)


def test_each_hand_over_takes_noise_away_before_the_fine_step() -> None:
    clean, faces = sphere(16)
    noisy = gaussian_along_normals(clean, faces, 0.3, seed=2)
    coarse, topology = CoarseFilter(faces, len(clean))(noisy), Topology(faces, len(noisy))
    for name in ("positions", "heights", "normals"):
        handed = hand_over(name)(noisy, coarse, topology)
        assert theta(clean, handed, faces) < 0.6 * theta(clean, noisy, faces)
    moved = hand_over("heights")(noisy, coarse, topology) - noisy
    normals = surface_normals(coarse, topology)
    along = np.einsum("ij,ij->i", moved, normals)[:, None] * normals
    assert moved == pytest.approx(along, abs=1e-12) and np.abs(moved).max() > 0.0


@pytest.mark.real
@pytest.mark.parametrize(
    ("clean", "noisy", "expected"),
    [("twelve_dodecahedron", "twelve_dodecahedron_noisy", 9.83), ("fandisk_6475", "fandisk_0.7_noisy", 14.56)],
)
def test_the_coarse_step_is_as_good_as_the_published_one(
    partners: Partners, clean: str, noisy: str, expected: float
) -> None:
    original, mesh = partners(clean, noisy)
    n = len(mesh.positions)
    coarse = CoarseFilter(mesh.faces, n, block=n // 10)(mesh.positions)
    assert theta(original.positions, coarse, mesh.faces) < 1.02 * expected
