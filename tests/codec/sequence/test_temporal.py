"""The choice of a temporal basis, on motion whose components are known."""

from __future__ import annotations

import numpy as np

from bsm.codec.sequence.temporal import FINEST_EXPONENT, OCTAVE, PRECISION, WORTH, learn_basis

ROWS, COLUMNS, STEP = 400, 24, 0.01


def motion_of(scales: list[float]) -> tuple[np.ndarray, np.ndarray]:
    """Trajectories with principal components of given deviations, and these components."""
    random = np.random.default_rng(0)
    weights, _ = np.linalg.qr(random.normal(size=(ROWS, len(scales))))
    basis, _ = np.linalg.qr(random.normal(size=(COLUMNS, len(scales))))
    return np.sqrt(ROWS) * (weights * scales) @ basis.T, basis


def test_the_components_of_motion_are_found_by_descending_energy() -> None:
    motion, basis = motion_of([1.0, 4.0, 2.0])
    learnt = learn_basis(motion, STEP, 1000)
    overlap = np.abs(learnt.columns.T @ basis[:, [1, 2, 0]])
    np.testing.assert_allclose(overlap, np.eye(3), atol=1e-10)


def test_the_finer_the_larger_what_a_component_multiplies() -> None:
    deviations = [4.0, 2.0, 1.0]
    learnt = learn_basis(motion_of(deviations)[0], STEP, 1000)
    exact = OCTAVE * np.log2(np.array(deviations) * np.sqrt(ROWS) / (PRECISION * STEP))
    assert learnt.exponents.tolist() == np.round(exact).tolist()
    assert learn_basis(motion_of(deviations)[0], STEP, 7).exponents.tolist() == [7, 7, 7]
    assert learn_basis(motion_of([1e9])[0], 1e-9, 10**9).exponents[0] == FINEST_EXPONENT


def test_what_costs_more_than_it_brings_is_left_out() -> None:
    least = np.sqrt(WORTH * COLUMNS / ROWS) * STEP  # the deviation whose energy just pays
    assert learn_basis(motion_of([1.0, 1.01 * least, 0.99 * least])[0], STEP, 1000).columns.shape == (COLUMNS, 2)
    assert learn_basis(np.zeros((ROWS, COLUMNS)), STEP, 1000).columns.shape == (COLUMNS, 0)


def test_few_vertices_over_many_frames_have_the_same_components_as_the_rest_of_the_mesh_at_rest() -> None:
    motion = np.random.default_rng(3).normal(size=(4, COLUMNS)) * [[4.0], [2.0], [1.0], [0.5]]
    few, many = (learn_basis(rows, STEP, 1000) for rows in (motion, np.vstack([motion, np.zeros((ROWS, COLUMNS))])))
    assert few.exponents.tolist() == many.exponents.tolist() and few.columns.shape == (COLUMNS, 4)
    np.testing.assert_allclose(np.abs(few.columns.T @ many.columns), np.eye(4), atol=1e-12)
