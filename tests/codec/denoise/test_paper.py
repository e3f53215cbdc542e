"""The paper's scheme for one mesh, against orthogonal iterations written here."""

import numpy as np
import pytest

from bsm import DenoiseOptions, OptionError, TriangleMesh
from bsm.codec.blocks.overlap import Blend
from bsm.codec.denoise import FrameDenoiser, denoise
from bsm.codec.denoise.coarse import KEEP, RULES, overlapping
from bsm.codec.denoise.surface import guided_normal_filtering
from bsm.encoding.options import denoise_options
from tests.shapes import theta, torus
from tools.laplacians import dense_laplacian
from tools.noise import gaussian_along_normals

CLEAN = torus(44, 36, bumps=0.02)
NOISY = gaussian_along_normals(CLEAN.positions, CLEAN.faces, 0.2, seed=3)


def iterated(power: int, rounds: int, block: int) -> np.ndarray:
    """The coarse step by Algorithm 1 in numpy: exact vectors of the first block, then Onorm(R^z U)."""
    blocks, size = overlapping(CLEAN.faces, len(NOISY), block)
    blend, width, basis = Blend(len(NOISY)), round(KEEP * size), None
    for index in range(blocks.count):
        laplacian = dense_laplacian(blocks.block(index))
        if basis is None or len(basis) != len(laplacian):
            basis = np.linalg.eigh(laplacian)[1][:, :width]
        else:
            inverse = np.linalg.inv(laplacian + RULES.shift * np.eye(len(laplacian)))
            for _ in range(rounds):
                basis = np.linalg.qr(np.linalg.matrix_power(inverse, power) @ basis)[0]
        vertices, degrees = blocks.block(index).vertices, blocks.block(index).degrees
        center = NOISY[vertices].mean(axis=0)
        blend.add(
            vertices, basis @ (basis.T @ (NOISY[vertices] - center)) + center, degrees.astype(float)
        )
    return blend.all_positions()


def mean_edge() -> float:
    sides = CLEAN.positions[CLEAN.faces[:, 0]] - CLEAN.positions[CLEAN.faces[:, 1]]
    return float(np.linalg.norm(sides, axis=1).mean())


@pytest.mark.parametrize(("power", "rounds"), [(1, 1), (3, 1), (2, 2), (5, 1)])
def test_the_coarse_step_is_that_of_the_paper(power: int, rounds: int) -> None:
    options = DenoiseOptions(method="oi", power=power, rounds=rounds, iterations=0, block_size=300)
    coarse = denoise(TriangleMesh(NOISY, CLEAN.faces), options, force=True).positions
    own, other = iterated(power, rounds, 300), iterated(power, rounds + 2, 300)
    apart = np.linalg.norm(coarse - own, axis=1).mean()
    assert apart < 0.001 * mean_edge()
    # What is compared depends on the iterations: more of them give another result.
    assert np.linalg.norm(coarse - other, axis=1).mean() > 3.0 * apart


def test_the_fine_step_follows_the_coarse_one() -> None:
    mesh = TriangleMesh(NOISY, CLEAN.faces)
    coarse = denoise(mesh, DenoiseOptions(method="oi", iterations=0), force=True).positions
    both = denoise(mesh, DenoiseOptions(method="oi", iterations=5), force=True).positions
    assert both == pytest.approx(guided_normal_filtering(coarse, CLEAN.faces, 5), abs=1e-12)
    angles = [theta(CLEAN.positions, positions, CLEAN.faces) for positions in (NOISY, both)]
    assert angles[1] < 0.6 * angles[0]


def test_frames_share_the_bases_and_are_denoised_like_single_meshes() -> None:
    options = DenoiseOptions(method="oi", iterations=0)
    together = list(FrameDenoiser(NOISY, CLEAN.faces, options, force=True)([NOISY, 1.5 * NOISY]))
    alone = denoise(TriangleMesh(NOISY, CLEAN.faces), options, force=True).positions
    assert together[0] == pytest.approx(alone, abs=1e-12)
    assert together[1] == pytest.approx(1.5 * alone, abs=1e-6)


def test_a_mesh_of_parts_and_one_smaller_than_a_block_are_denoised() -> None:
    small = torus(6, 5)
    faces = np.concatenate([CLEAN.faces, small.faces + len(NOISY)])
    both = TriangleMesh(np.concatenate([NOISY, small.positions]), faces)
    for mesh in (both, small):
        result = denoise(mesh, DenoiseOptions(method="oi", iterations=0), force=True).positions
        assert np.isfinite(result).all() and (result != mesh.positions).any()


def test_options_of_other_methods_are_refused() -> None:
    assert denoise_options(method="auto") is None
    assert denoise_options(method="spectral") == DenoiseOptions()
    with pytest.raises(OptionError, match="method auto chooses keep itself"):
        denoise_options(method="auto", keep=0.2)
    with pytest.raises(OptionError, match="power and rounds are for method oi, not for spectral"):
        DenoiseOptions(power=2)
    for wrong in ({"method": "svd"}, {"method": "oi", "power": 0}, {"method": "oi", "rounds": 0}):
        with pytest.raises(OptionError):
            DenoiseOptions(**wrong)  # type: ignore[arg-type]
