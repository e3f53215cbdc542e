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
