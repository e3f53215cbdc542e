"""Levels that are worth their bits: where errors are seen they are right, and elsewhere cheap."""

import numpy as np
import pytest

from bsm import TriangleMesh
from bsm.codec.geometry.graph import graph_of_faces
from bsm.codec.look.measure import LookMetric
from bsm.codec.signal.smooth import in_frames, local_frames, tangent_steps
from bsm.codec.static.choice.settling import RATIO, Sensitivity
from tests.shapes import patch, together, torus

MESH = torus(40, 30)
GRAPH = graph_of_faces(MESH.faces, len(MESH.positions))
ANYWHERE = np.full(len(MESH.positions), np.inf)
FRAMES = local_frames(MESH.positions, MESH.faces)
STEPS = np.tile((0.002, 0.006, 0.006), (len(MESH.positions), 1))


@pytest.fixture(scope="module")
def sensitivity():
    return Sensitivity(MESH.positions, MESH.faces, GRAPH, LookMetric(MESH), 0.002 * MESH.diagonal)


def offsets(size, seed=0):
    return np.random.default_rng(seed).normal(0, size, MESH.positions.shape)


def same(levels):
    return STEPS


def entropy(levels):
    counts = np.unique(levels, return_counts=True)[1] / levels.size
    return -(counts * np.log2(counts)).sum()


def test_free_bits_are_rounding(sensitivity):
    wanted, steps = offsets(0.01), STEPS
    levels = sensitivity.levels(wanted, FRAMES, steps, same, 0.0, ANYWHERE)
    assert (levels == np.rint(wanted / steps)).all()


def test_bits_that_cost_are_saved(sensitivity):
    wanted, steps = offsets(0.01), STEPS
    sizes, errors = [], []
    for worth in (0.0, 0.1, 0.3, 1.0):
        levels = sensitivity.levels(wanted, FRAMES, steps, same, worth, ANYWHERE)
        sizes.append(sum(entropy(levels[:, axis]) for axis in range(3)))
        errors.append(np.square(levels * steps - wanted).sum())
    assert sizes == sorted(sizes, reverse=True)
    assert errors == sorted(errors)


def test_no_vertex_ends_up_out_of_reach(sensitivity):
    wanted, steps = offsets(0.01), STEPS
    rounded = np.sqrt(np.square(np.rint(wanted / steps) * steps - wanted).sum(axis=1))
    reach = np.full(len(wanted), 0.004)
    levels = sensitivity.levels(wanted, FRAMES, steps, same, 3.0, reach)
    moved = np.sqrt(np.square(levels * steps - wanted).sum(axis=1))
    assert (moved <= np.maximum(reach, rounded) + 1e-12).all()


def test_errors_along_normals_cost_more(sensitivity):
    normal, tangent = sensitivity.costs
    assert normal.shape == tangent.shape == (len(MESH.positions),)
    assert np.median(normal) > 4 * np.median(tangent)
    assert tangent.min() > 0


def test_what_is_hidden_costs_little():
    inner = TriangleMesh(patch(12, 12).positions * 0.1, patch(12, 12).faces)
    shell = TriangleMesh(MESH.positions / MESH.diagonal, MESH.faces)
    # The patch lies inside the tube of the torus.
    ring = shell.positions[np.argmax(shell.positions[:, 0])] * (0.8, 1, 0)
    both = together(shell, TriangleMesh(inner.positions * 0.3 + ring, inner.faces))
    graph = graph_of_faces(both.faces, len(both.positions))
    measured = Sensitivity(both.positions, both.faces, graph, LookMetric(both), 0.002)
    normal, _ = measured.costs
    outside, hidden = normal[: len(shell.positions)], normal[len(shell.positions) :]
    assert np.median(hidden) < 0.5 * np.median(outside)


def test_the_step_for_a_look_is_about_right(sensitivity):
    step = sensitivity.first_step(1.0)
    assert sensitivity.first_step(2.0) == pytest.approx(step * 2 ** (0.5 / 0.8))
    aside = tangent_steps(MESH.positions, MESH.faces, step, RATIO)
    noise = np.random.default_rng(1).uniform(-0.5, 0.5, MESH.positions.shape)
    noise *= np.column_stack([np.full(len(aside), step), aside, aside])
    seen = LookMetric(MESH).distance(MESH.positions + np.einsum("na,nad->nd", noise, FRAMES.reshape(-1, 3, 3)))
    assert 0.4 < seen < 3.0


def test_heights_make_good_what_is_left_along_axes_that_are_not_the_surfaces_own(sensitivity):
    tilt = np.array([[np.cos(0.3), 0, np.sin(0.3)], [0, 1, 0], [-np.sin(0.3), 0, np.cos(0.3)]])
    frames = np.einsum("ab,nbj->naj", tilt, FRAMES.reshape(-1, 3, 3)).reshape(-1, 9)
    wanted, steps = offsets(0.01), STEPS * (1, 2, 2)
    errors = [steps * levels - wanted for levels in (
        np.rint(wanted / steps), sensitivity.levels(wanted, frames, steps, lambda _: steps, 0.001, ANYWHERE)
    )]  # fmt: skip
    plain, settled = (np.abs((in_frames(FRAMES[:, :3], frames) * error).sum(axis=1)).mean() for error in errors)
    assert settled < 0.7 * plain


def test_slides_keep_heights_and_follow_their_steps(sensitivity):
    wanted, steps = offsets(0.01), STEPS
    levels = sensitivity.levels(wanted, FRAMES, steps, same, 0.001, ANYWHERE)
    finer = steps * (1, 0.25, 0.25)
    slides = sensitivity.levels(wanted, FRAMES, steps, lambda _: finer, 0.001, ANYWHERE)
    assert (slides[:, 0] == levels[:, 0]).all()
    assert np.abs((finer * slides - wanted)[:, 1:]).mean() < 0.7 * np.abs((steps * levels - wanted)[:, 1:]).mean()
