"""Cells against their definition, for all kinds of graphs; places that are prolonged, and fitted."""

import sys
from pathlib import Path

import numpy as np
import pytest

from bsm import TriangleMesh
from bsm.codec.arrays import Matrix
from bsm.codec.blocks.cells import BENT, Fit, cells_of, prolonged
from bsm.codec.geometry.graph import Graph, graph_of_faces
from tools.vectors.good_base import bowtie, cylinder, flipped, loose, pages, strip
from tools.vectors.meshes import hub, patch, tangled, tent, torus

sys.path.insert(0, str(Path(__file__).parents[3] / "spec"))
MESHES = {mesh.__name__: mesh for mesh in (bowtie, flipped, hub, tangled, tent)} | {
    "cylinder": lambda: cylinder(30),
    "loose": lambda: loose(9),
    "pages": lambda: pages(4),
    "patch": lambda: patch(19, 23),
    "strip": lambda: strip(70),
    "torus": lambda: torus(20, 14),
}


def graph_of(mesh: TriangleMesh) -> Graph:
    return graph_of_faces(mesh.faces, len(mesh.positions))


@pytest.mark.parametrize("reach", [1, 2, 3, 8])
@pytest.mark.parametrize("name", MESHES)
def test_they_are_those_of_the_law(name: str, reach: int) -> None:
    from reference_base import Cells

    mesh = MESHES[name]()
    graph = graph_of(mesh)
    rows = [
        graph.neighbors[a:b].tolist()
        for a, b in zip(graph.offsets[:-1], graph.offsets[1:], strict=True)
    ]
    found = cells_of(graph, mesh.faces, reach)
    law = Cells(rows, mesh.faces.tolist(), (found.graph.size, reach, 3, 1))
    assert found.own.tolist() == law.own
    coarse = found.graph
    assert [
        coarse.neighbors[a:b].tolist()
        for a, b in zip(coarse.offsets[:-1], coarse.offsets[1:], strict=True)
    ] == law.graph
    assert [tuple(face) for face in found.faces.tolist()] == law.faces
    places = np.random.default_rng(0).normal(size=(coarse.size, 3))
    assert np.array_equal(prolonged(found, graph, places, 3), law.prolonged(places))


def test_a_hub_with_many_legs_takes_no_longer_for_its_many_centers() -> None:
    """Each leg ends in a center, and the hub is near all of them: what is nearer already is not visited again."""
    legs = 200_000
    x = 1 + 3 * np.arange(legs)
    faces = np.concatenate([np.stack([0 * x, x, x + 1], 1), np.stack([x + 1, x, x + 2], 1)])
    number = np.empty(1 + 3 * legs, np.int64)
    number[x + 2], number[x], number[x + 1] = (
        np.arange(legs),
        legs + np.arange(legs),
        2 * legs + np.arange(legs),
    )
    number[0] = 3 * legs
    faces = number[faces].astype(np.int32)
    found = cells_of(graph_of_faces(faces, len(number)), faces, 2)
    assert found.graph.size == legs


def fit_of(mesh: TriangleMesh) -> Fit:
    graph = graph_of(mesh)
    return Fit(cells_of(graph, mesh.faces, 2), graph, mesh.positions, 8)


def error_of(fit: Fit, places: Matrix) -> float:
    return float(
        np.square(prolonged(fit.cells, fit.graph, places, fit.rounds) - fit.positions).mean()
    )


def test_fitted_places_come_nearer_than_means() -> None:
    fit = fit_of(torus(120, 80))
    own = fit.cells.own
    means = (
        np.column_stack([np.bincount(own, column) for column in fit.positions.T])
        / np.bincount(own)[:, None]
    )
    assert error_of(fit, fit.places) < error_of(fit, means) / 16.0


def test_coupled_cells_are_those_of_the_definition() -> None:
    fit = fit_of(torus(60, 40))
    size, coarse = fit.cells.graph.size, fit.cells.graph
    columns = [
        prolonged(fit.cells, fit.graph, np.tile(row, (3, 1)).T.copy(), 8)[:, 0]
        for row in np.eye(size)
    ]
    bends = -np.eye(size)
    for cell in range(size):
        around = coarse.neighbors[coarse.offsets[cell] : coarse.offsets[cell + 1]]
        bends[cell, around] = 1.0 / len(around)
    exact = np.array(columns) @ np.array(columns).T + BENT * bends.T @ bends
    starts, ends, values, weights = fit._coupling
    found = np.diag(weights)
    found[np.repeat(np.arange(size), np.diff(starts)), ends] = values
    assert np.array_equal(found, found.T)
    assert np.abs(found - exact).max() < 0.05 * weights.mean()


def test_levels_chosen_together_bring_vertices_nearer() -> None:
    fit = fit_of(torus(120, 80))
    step, frames = 0.01, np.tile(np.eye(3).ravel(), (len(fit.places), 1))
    levels = np.rint(fit.places / step).astype(np.int32)
    rounded, steps = levels.copy(), np.full(levels.shape, step)
    fit.level(frames, steps, step * levels, levels, first=1)
    assert np.array_equal(levels[:, 0], rounded[:, 0])
    fit.level(frames, steps, step * levels, levels)
    kept = error_of(fit, fit.places)
    assert error_of(fit, step * levels) - kept < 0.6 * (error_of(fit, step * rounded) - kept)
