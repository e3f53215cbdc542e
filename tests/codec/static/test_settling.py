"""Levels that are worth their bits: right where errors are seen and at creases, and cheap elsewhere."""

from itertools import combinations

import numpy as np
import pytest

from bsm import TriangleMesh
from bsm.codec.geometry.graph import graph_of_faces, vertex_faces
from bsm.codec.geometry.metrics import face_normals
from bsm.codec.look.pictures import CREASE
from bsm.codec.signal.smooth import in_frames, local_frames
from bsm.codec.static.choice.settling import WITHIN, Creases, Settler, creases_of
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
    plain, settled = (
        np.abs((in_frames(FRAMES[:, :3], frames) * error).sum(axis=1)).mean() for error in errors
    )
    assert settled < 0.7 * plain


BENT = torus(60, 9)
"""Bends around its tube are near 40 degrees, more on the outside than on the inside."""
RNG = np.random.default_rng(3)
ROUGH = TriangleMesh(
    BENT.positions + RNG.normal(0, 0.003 * BENT.diagonal, BENT.positions.shape), BENT.faces
)


def wrong(creases: Creases, positions):
    normals = face_normals(positions, creases.faces)
    cosines = (normals[creases.pairs[:, 0]] * normals[creases.pairs[:, 1]]).sum(axis=1)
    return (cosines <= CREASE) != creases.sharp.astype(bool)


def test_pairs_and_costs_are_those_of_all_corners():
    positions, faces = ROUGH.positions, ROUGH.faces
    creases = creases_of(positions, faces)
    normals = face_normals(positions, faces)
    area = np.linalg.norm(
        np.cross(
            positions[faces[:, 1]] - positions[faces[:, 0]],
            positions[faces[:, 2]] - positions[faces[:, 0]],
        ),
        axis=1,
    )
    around = vertex_faces(faces, len(positions))
    expected = {}
    for vertex in range(len(positions)):
        rows = around.members[around.starts[vertex] : around.starts[vertex + 1]]
        for f, g in combinations(sorted(int(row) for row in rows), 2):
            if abs(np.degrees(np.arccos(normals[f] @ normals[g])) - 40.0) < WITHIN:
                expected[f, g] = expected.get((f, g), 0.0) + (area[f] + area[g]) / (3 * area.sum())
    found = {
        tuple(sorted(map(int, pair))): cost
        for pair, cost in zip(creases.pairs, creases.costs, strict=True)
    }
    assert found.keys() == expected.keys()
    assert len(found) == len(creases.pairs) > 100
    assert found == pytest.approx(expected)
    assert not wrong(creases, positions).any()
    assert 0 < creases.sharp.sum() < len(creases.sharp)


class Smooth(Settler):
    """To which creases are worth nothing."""

    @property
    def _creases(self):
        creases = creases_of(self._positions, self._faces)
        return creases._replace(costs=np.zeros_like(creases.costs))


def test_levels_keep_creases():
    positions, faces = ROUGH.positions / ROUGH.diagonal, ROUGH.faces
    graph, count = graph_of_faces(faces, len(positions)), len(positions)
    frames = local_frames(positions, faces)
    offsets = np.random.default_rng(0).normal(0, 0.01, (count, 3))
    steps = np.tile((0.002, 0.006, 0.006), (count, 1))
    creases = creases_of(positions, faces)
    broken, errors = [], []
    for kind in (Smooth, Settler):
        levels = kind(positions, faces, graph).levels(
            offsets, frames, steps, lambda _: steps, 0.05, np.full(count, np.inf)
        )
        error = levels * steps - offsets
        broken.append(
            wrong(
                creases, positions + np.einsum("na,nad->nd", error, frames.reshape(-1, 3, 3))
            ).mean()
        )
        errors.append(np.sqrt(np.square(error).mean()))
    assert broken[1] < 0.5 * broken[0]
    assert errors[1] < 1.5 * errors[0]
