"""Cells against their definition, for all kinds of graphs; places that are prolonged, and fitted."""

import sys
from pathlib import Path

import numpy as np
import pytest

from bsm.codec.blocks.cells import cells_of, fitted, prolonged
from bsm.codec.geometry.graph import Graph, graph_of_faces
from bsm.codec.geometry.mesh import TriangleMesh
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
    rows = [graph.neighbors[a:b].tolist() for a, b in zip(graph.offsets[:-1], graph.offsets[1:], strict=True)]
    found = cells_of(graph, mesh.faces, reach)
    law = Cells(rows, mesh.faces.tolist(), (found.graph.size, reach, 3, 1))
    assert found.own.tolist() == law.own
    coarse = found.graph
    assert [
        coarse.neighbors[a:b].tolist() for a, b in zip(coarse.offsets[:-1], coarse.offsets[1:], strict=True)
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
    number[x + 2], number[x], number[x + 1] = np.arange(legs), legs + np.arange(legs), 2 * legs + np.arange(legs)
    number[0] = 3 * legs
    faces = number[faces].astype(np.int32)
    found = cells_of(graph_of_faces(faces, len(number)), faces, 2)
    assert found.graph.size == legs


def test_fitted_places_come_nearer_than_means() -> None:
    mesh = torus(120, 80)
    graph = graph_of(mesh)
    cells = cells_of(graph, mesh.faces, 2)
    sums = np.zeros((cells.graph.size, 3))
    np.add.at(sums, cells.own, mesh.positions)
    means = sums / np.bincount(cells.own)[:, None]
    places = fitted(cells, graph, mesh.positions, 8)
    errors = [float(np.square(prolonged(cells, graph, given, 8) - mesh.positions).mean()) for given in (means, places)]
    assert errors[1] < errors[0] / 16.0
