"""The public entry: one mesh, all frames of a sequence, and what is refused."""

import numpy as np
import pytest

from bsm import DenoiseOptions, HarmError, MeshError, OptionError, TriangleMesh
from bsm.codec.denoise import FrameDenoiser, denoise
from bsm.codec.denoise.coarse import CoarseFilter, by_lengths
from bsm.codec.denoise.filters import HAND_OVERS
from bsm.codec.denoise.surface import (
    GuidedFilter,
    Topology,
    guided_normal_filtering,
    surface_normals,
)
from tests.codec.denoise.denoise_shapes import Partners, sphere
from tests.shapes import theta
from tools.noise import gaussian_along_normals

CLEAN, FACES = sphere(14)
NOISY = gaussian_along_normals(CLEAN, FACES, 0.25, seed=2)


def test_either_step_may_stand_alone() -> None:
    mesh = TriangleMesh(NOISY, FACES)
    fine = denoise(mesh, DenoiseOptions(hand_over="none", iterations=3), force=True)
    assert (fine.positions == guided_normal_filtering(NOISY, FACES, 3)).all()
    coarse = denoise(mesh, DenoiseOptions(iterations=0, keep=0.2, block_size=200), force=True)
    assert coarse.positions == pytest.approx(
        CoarseFilter(FACES, len(NOISY), 0.2, 200, by_lengths(NOISY))(NOISY, 0.2)
    )


@pytest.mark.parametrize(
    "options",
    [None, DenoiseOptions(), DenoiseOptions(hand_over="normals", fine="bilateral-normal")],
)
def test_every_frame_of_a_sequence_is_denoised(options: DenoiseOptions | None) -> None:
    frames = np.stack(
        [gaussian_along_normals(CLEAN * scale, FACES, 0.25, seed=2) for scale in (1.0, 1.2, 1.5)]
    )
    denoised = np.stack(list(FrameDenoiser(frames[0], FACES, options)(frames)))
    assert denoised.shape == frames.shape
    for scale, before, after in zip((1.0, 1.2, 1.5), frames, denoised):
        assert theta(CLEAN * scale, after, FACES) < 0.6 * theta(CLEAN * scale, before, FACES)


@pytest.mark.parametrize("size", [3, 14])
def test_options_that_do_harm_are_refused_unless_forced(size: int) -> None:
    positions, faces = sphere(size)
    options = DenoiseOptions(keep=0.05)
    with pytest.raises(HarmError, match=r"unless it is forced$"):
        denoise(TriangleMesh(positions, faces), options)
    with pytest.raises(HarmError, match="frame 0"):
        list(FrameDenoiser(positions, faces, options)([positions, positions]))
    forced = denoise(TriangleMesh(positions, faces), options, force=True)
    assert (forced.positions != positions).any()


@pytest.mark.parametrize(
    "options",
    [
        {"fine": "best"},
        {"hand_over": "best"},
        {"iterations": -1},
        {"keep": 0.0},
        {"keep": 1.1},
        {"keep": np.nan},
        {"block_size": 0},
    ],
)
def test_illegal_options_are_refused(options: dict[str, object]) -> None:
    with pytest.raises(OptionError):
        DenoiseOptions(**options)  # type: ignore[arg-type]


@pytest.mark.parametrize("shape", [(4,), (4, 2), (2, 4, 3)])
def test_frames_of_another_shape_are_refused(shape: tuple[int, ...]) -> None:
    with pytest.raises(MeshError, match="shape"):
        FrameDenoiser(np.zeros(shape), FACES, DenoiseOptions())


def test_each_hand_over_takes_noise_away_before_the_fine_step() -> None:
    clean, faces = sphere(16)
    noisy = gaussian_along_normals(clean, faces, 0.3, seed=2)
    coarse, topology = CoarseFilter(faces, len(clean))(noisy), Topology(faces, len(noisy))
    guided = GuidedFilter(noisy, topology)
    for name in ("positions", "heights", "normals"):
        handed = HAND_OVERS[name](noisy, coarse, guided)
        assert theta(clean, handed, faces) < 0.6 * theta(clean, noisy, faces)
    moved = HAND_OVERS["heights"](noisy, coarse, guided) - noisy
    normals = surface_normals(coarse, topology)
    along = np.einsum("ij,ij->i", moved, normals)[:, None] * normals
    assert moved == pytest.approx(along, abs=1e-12) and np.abs(moved).max() > 0.0


@pytest.mark.real
@pytest.mark.parametrize(
    ("clean", "noisy", "expected"),
    [
        ("twelve_dodecahedron", "twelve_dodecahedron_noisy", 9.83),
        ("fandisk_6475", "fandisk_0.7_noisy", 14.56),
    ],
)
def test_the_coarse_step_is_as_good_as_the_published_one(
    partners: Partners, clean: str, noisy: str, expected: float
) -> None:
    original, mesh = partners(clean, noisy)
    n = len(mesh.positions)
    coarse = CoarseFilter(mesh.faces, n, block=n // 10)(mesh.positions)
    assert theta(original.positions, coarse, mesh.faces) < 1.02 * expected
    weighted = denoise(mesh, DenoiseOptions(), force=True).positions
    unweighted = guided_normal_filtering(CoarseFilter(mesh.faces, n)(mesh.positions), mesh.faces)
    assert theta(original.positions, weighted, mesh.faces) < theta(
        original.positions, unweighted, mesh.faces
    )
