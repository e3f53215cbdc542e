"""Noise that changes from frame to frame."""

import numpy as np
import pytest

from bsm.codec.denoise import FrameDenoiser
from bsm.codec.denoise.coarse import FEWEST_FRAMES, TemporalFilter, noise_deviation, shrunk
from bsm.codec.denoise.frames import WINDOW
from bsm.codec.geometry.metrics import mean_edge_length
from tests.codec.denoise.denoise_shapes import sphere
from tests.shapes import knot, theta
from tools.noise import gaussian_along_normals

CLEAN, FACES = sphere(14)
EDGE = mean_edge_length(CLEAN, FACES)


def turning(count: int) -> np.ndarray:
    """The shape turning and swelling, shape (count, n, 3)."""
    frames = []
    for angle in np.linspace(0.0, 2.0, count):
        turn = np.array(
            [
                [np.cos(angle), -np.sin(angle), 0],
                [np.sin(angle), np.cos(angle), 0],
                [0, 0, 1 + 0.2 * angle],
            ]
        )
        frames.append(CLEAN @ turn.T + [angle, 0.0, 0.0])
    return np.stack(frames)


def with_noise(frames: np.ndarray, sigma: float) -> np.ndarray:
    return np.stack(
        [gaussian_along_normals(frame, FACES, sigma, seed) for seed, frame in enumerate(frames)]
    )


def rms(frames: np.ndarray) -> float:
    return float(np.sqrt(np.square(frames).sum(axis=2).mean()))


@pytest.mark.parametrize("shape", [(300, 60), (60, 300), (100, 100)])
def test_the_strength_of_noise_on_a_matrix_of_low_rank(shape) -> None:  # type: ignore[no-untyped-def]
    random = np.random.default_rng(0)
    clean = 20.0 * random.normal(size=(shape[0], 3)) @ random.normal(size=(3, shape[1]))
    noisy = clean + 0.5 * random.normal(size=shape)
    assert noise_deviation(noisy) == pytest.approx(0.5, rel=0.05)
    filtered, rank = shrunk(noisy, 0.5)
    assert rank == 4
    assert np.linalg.norm(filtered - clean) < 0.4 * np.linalg.norm(noisy - clean)


def test_noise_goes_and_motion_stays() -> None:
    frames = turning(32)
    noisy = with_noise(frames, 0.3)
    steadied, deviation, remaining = TemporalFilter(FACES, len(CLEAN))(noisy)
    assert rms(steadied - frames) < 0.4 * rms(noisy - frames)
    assert np.sqrt(3.0) * deviation == pytest.approx(0.3 * EDGE, rel=0.25)
    assert remaining == pytest.approx(rms(steadied - frames) / rms(noisy - frames), rel=0.5)


@pytest.mark.slow
def test_a_sequence_is_better_than_its_frames() -> None:
    frames = turning(16)
    noisy = with_noise(frames, 0.3)
    together = np.stack(list(FrameDenoiser(noisy[0], FACES)(noisy)))
    alone = np.stack([next(iter(FrameDenoiser(frame, FACES)([frame]))) for frame in noisy[:3]])
    assert rms(together - frames) < 0.85 * rms(alone - frames[:3])
    angles = [
        np.mean([theta(a, b, FACES) for a, b in zip(frames, each)]) for each in (together, alone)
    ]
    assert angles[0] < 0.8 * angles[1]


def test_what_is_left_in_time_is_not_taken_for_noise_that_networks_know() -> None:
    mesh = knot(800)
    clean = np.stack([mesh.positions * (1.0, 1.0, 1.0 + 0.05 * number) for number in range(12)])
    noisy = np.stack(
        [gaussian_along_normals(frame, mesh.faces, 0.2, seed) for seed, frame in enumerate(clean)]
    )
    denoised = FrameDenoiser(noisy[0], mesh.faces)(noisy)
    pairs = zip(clean, noisy, denoised, strict=True)
    angles = np.mean([[theta(a, x, mesh.faces) for x in (b, c)] for a, b, c in pairs], axis=0)
    assert angles[1] < 0.32 * angles[0]


def test_clean_motion_comes_back_bit_for_bit() -> None:
    frames = turning(20)
    assert (np.stack(list(FrameDenoiser(frames[0], FACES)(frames))) == frames).all()


@pytest.mark.parametrize(
    "count", [1, WINDOW - 1, WINDOW, WINDOW + 1, 2 * WINDOW - FEWEST_FRAMES, 2 * WINDOW + 3]
)
def test_windows_hand_out_every_frame_once(count: int) -> None:
    small, faces = sphere(3)
    frames = np.stack([small + number for number in range(count)])
    denoised = list(FrameDenoiser(frames[0], faces)(iter(frames)))
    assert len(denoised) == count
    assert np.allclose(np.stack(denoised), frames, atol=1e-6)
