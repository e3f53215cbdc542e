"""The choice of a temporal basis, on motion whose components are known."""

import numpy as np
import pytest

from bsm._core import codec as kernels
from bsm.codec.sequence.temporal import (
    FINEST_EXPONENT,
    OCTAVE,
    PRECISION,
    WORTH,
    Decomposition,
    free_of,
    learn_basis,
    lengths_of,
)

ROWS, COLUMNS, STEP = 400, 24, 0.01


def motion_of(scales: list[float]) -> tuple[np.ndarray, np.ndarray]:
    """Trajectories with principal components of given deviations, and these components."""
    random = np.random.default_rng(0)
    weights, _ = np.linalg.qr(random.normal(size=(ROWS, len(scales))))
    basis, _ = np.linalg.qr(random.normal(size=(COLUMNS, len(scales))))
    return np.sqrt(ROWS) * (weights * scales) @ basis.T, basis


def test_the_components_of_motion_are_found_by_descending_energy() -> None:
    motion, basis = motion_of([1.0, 4.0, 2.0])
    columns, _ = learn_basis(motion, STEP, 1000)
    overlap = np.abs(columns.T @ basis[:, [1, 2, 0]])
    np.testing.assert_allclose(overlap, np.eye(3), atol=1e-10)


def test_the_finer_the_larger_what_a_component_multiplies() -> None:
    deviations = [4.0, 2.0, 1.0]
    _, exponents = learn_basis(motion_of(deviations)[0], STEP, 1000)
    exact = OCTAVE * np.log2(np.array(deviations) * np.sqrt(ROWS) / (PRECISION * STEP))
    assert exponents.tolist() == np.round(exact).tolist()
    assert learn_basis(motion_of(deviations)[0], STEP, 7)[1].tolist() == [7, 7, 7]
    assert learn_basis(motion_of([1e9])[0], 1e-9, 10**9)[1][0] == FINEST_EXPONENT


def test_what_costs_more_than_it_brings_is_left_out() -> None:
    least = np.sqrt(WORTH * COLUMNS / ROWS) * STEP  # the deviation whose energy just pays
    assert learn_basis(motion_of([1.0, 1.01 * least, 0.99 * least])[0], STEP, 1000)[0].shape == (
        COLUMNS,
        2,
    )
    assert learn_basis(np.zeros((ROWS, COLUMNS)), STEP, 1000)[0].shape == (COLUMNS, 0)


@pytest.mark.parametrize(("frames", "vertices"), [(7, 60), (40, 12), (1, 5), (30, 200)])
def test_motion_is_the_product_of_its_fields_and_shapes(frames, vertices):
    random = np.random.default_rng(3)
    given = np.tensordot(random.normal(size=(frames, 4)), random.normal(size=(4, vertices, 3)), 1)
    motion = Decomposition(given).motion(STEP)
    np.testing.assert_allclose(
        np.tensordot(motion.shapes, motion.fields, (0, 1)).transpose(1, 2, 0), given, atol=1e-6
    )
    assert len(motion.shapes) <= min(12, 3 * frames, vertices)
    assert Decomposition(np.zeros((frames, vertices, 3))).motion(STEP).shapes.shape == (
        0,
        3,
        frames,
    )


def clip(seed, frames, rank=6, vertices=500):
    """Smooth motion of some rank."""
    random, time = np.random.default_rng(seed), np.arange(frames)[:, None]
    waves = np.sin(random.uniform(0.05, 0.4, rank) * time + random.uniform(0, 6, rank))
    return 0.2 * np.tensordot(waves, random.normal(size=(rank, vertices, 3)), 1)


@pytest.mark.parametrize("lengths", [(200,), (70, 90), (60, 100, 41), (30, 30, 30, 30)])
def test_gops_are_as_long_as_clips(lengths):
    frames = np.concatenate([clip(seed, length) for seed, length in enumerate(lengths)])
    found = np.cumsum(lengths_of(Decomposition(frames).motion(STEP), STEP))
    assert len(found) == len(lengths) and np.abs(found - np.cumsum(lengths)).max() <= 1


def test_loops_and_jumps_are_not_cut():
    frames = clip(0, 240)
    jumps = frames.reshape(12, 20, -1, 3)[np.random.default_rng(0).permutation(12)].reshape(
        frames.shape
    )
    for whole in (
        np.tile(frames[:40], (6, 1, 1)),
        jumps,
        frames[:12],
        frames[:1],
        np.zeros((50, 9, 3)),
    ):
        assert lengths_of(Decomposition(whole).motion(STEP), STEP) == [len(whole)]


def columns_of(free):
    columns = np.array(free, order="C")
    kernels.turn_columns(columns, np.empty(len(free)), np.empty(free.shape[1]))
    return columns


def right_angled(rows, columns):
    basis, _ = np.linalg.qr(np.random.default_rng(rows).normal(size=(rows, columns)))
    return basis


def one_by_one(free):
    """`columns_of` as the specification has it."""
    columns = free.copy()
    for k in reversed(range(free.shape[1])):
        vector = free[:, k].copy()
        if length := np.linalg.norm(vector):
            vector[k] += -length if vector[k] < 0.0 else length
            columns[:, k + 1 :] -= np.outer(
                vector, 2.0 * (vector @ columns[:, k + 1 :]) / (vector @ vector)
            )
    return columns


@pytest.mark.parametrize(("rows", "columns"), [(60, 13), (24, 24), (3, 1), (6, 0)])
def test_columns_return_from_what_is_free_in_them(rows, columns):
    basis = right_angled(rows, columns)
    free = free_of(basis)
    assert np.array_equal(free, np.tril(free))
    assert (np.diagonal(free) >= 0.0).all()
    found = columns_of(free)
    np.testing.assert_allclose(found * np.sign((found * basis).sum(axis=0)), basis, atol=1e-13)


def test_columns_are_what_reflections_make_of_them():
    free = np.tril(np.random.default_rng(1).normal(size=(120, 70)))
    free[:, 3] = 0.0
    free[40:, 40], free[40, 40] = 0.0, -2.0
    np.testing.assert_allclose(columns_of(free), one_by_one(free), atol=1e-11)


@pytest.mark.parametrize("least", [-1e-20, -0.0, 0.0, 1e-20])
def test_what_rounding_leaves_of_a_diagonal_turns_no_column(least):
    basis = np.array([[least, 0.6], [1.0, 0.3], [0.0, 0.8], [0.0, 0.0]])
    found = columns_of(free_of(basis))
    found /= np.linalg.norm(found, axis=0)
    np.testing.assert_allclose(found @ (found.T @ basis), basis, atol=1e-8)
