"""Levels that are worth their bits: where errors are seen they are right, and elsewhere cheap."""

import numpy as np
import pytest

from bsm.codec.geometry.graph import graph_of_faces
from bsm.codec.signal.smooth import in_frames, local_frames
from bsm.codec.static.choice.settling import Settler
from tests.shapes import torus

MESH = torus(40, 30)
GRAPH = graph_of_faces(MESH.faces, len(MESH.positions))
ANYWHERE = np.full(len(MESH.positions), np.inf)
FRAMES = local_frames(MESH.positions, MESH.faces)
STEPS = np.tile((0.002, 0.006, 0.006), (len(MESH.positions), 1))


@pytest.fixture(scope="module")
def settler():
    return Settler(MESH.positions, MESH.faces, GRAPH)


def offsets(size, seed=0):
    return np.random.default_rng(seed).normal(0, size, MESH.positions.shape)


def same(levels):
    return STEPS


def entropy(levels):
    counts = np.unique(levels, return_counts=True)[1] / levels.size
    return -(counts * np.log2(counts)).sum()


def test_bits_that_cost_are_saved(settler):
    wanted, steps = offsets(0.01), STEPS
    sizes, errors = [], []
    for worth in (0.0, 0.1, 0.3, 1.0):
        levels = settler.levels(wanted, FRAMES, steps, same, worth, ANYWHERE)
        sizes.append(sum(entropy(levels[:, axis]) for axis in range(3)))
        errors.append(np.square(levels * steps - wanted).sum())
    assert sizes == sorted(sizes, reverse=True)
    assert errors == sorted(errors)


def test_no_vertex_ends_up_out_of_reach(settler):
    wanted, steps = offsets(0.01), STEPS
    rounded = np.sqrt(np.square(np.rint(wanted / steps) * steps - wanted).sum(axis=1))
    reach = np.full(len(wanted), 0.004)
    levels = settler.levels(wanted, FRAMES, steps, same, 3.0, reach)
    moved = np.sqrt(np.square(levels * steps - wanted).sum(axis=1))
    assert (moved <= np.maximum(reach, rounded) + 1e-12).all()


def test_errors_along_normals_cost_more(settler):
    wanted, steps = offsets(0.01), np.full((len(MESH.positions), 3), 0.004)
    levels = settler.levels(wanted, FRAMES, steps, lambda _: steps, 0.3, ANYWHERE)
    off = np.square(levels * steps - wanted).mean(axis=0)
    assert off[0] < 0.8 * off[1:].min()


def test_heights_make_good_what_is_left_along_axes_that_are_not_the_surfaces_own(settler):
    tilt = np.array([[np.cos(0.3), 0, np.sin(0.3)], [0, 1, 0], [-np.sin(0.3), 0, np.cos(0.3)]])
    frames = np.einsum("ab,nbj->naj", tilt, FRAMES.reshape(-1, 3, 3)).reshape(-1, 9)
    wanted, steps = offsets(0.01), STEPS * (1, 2, 2)
    errors = [steps * levels - wanted for levels in (
        np.rint(wanted / steps), settler.levels(wanted, frames, steps, lambda _: steps, 0.001, ANYWHERE)
    )]  # fmt: skip
    plain, settled = (np.abs((in_frames(FRAMES[:, :3], frames) * error).sum(axis=1)).mean() for error in errors)
    assert settled < 0.7 * plain
