"""The dictionaries of a sequence, on parts whose extension is known."""

from __future__ import annotations

import numpy as np
import pytest

from bsm import TriangleMesh
from bsm.codec.basis.laplacian import cotangent_weights
from bsm.codec.blocks.overlap import Blocks, derive_partition, grow_blocks
from bsm.codec.geometry.graph import graph_of_faces
from bsm.codec.sequence.dictionaries import Part, make_parts
from bsm.codec.sequence.run_encoding import FIRST_FRAME
from bsm.codec.static.coding import Adaptive, Scheme
from tests.shapes import patch, torus


def blocks_of(mesh: TriangleMesh, parts: int) -> Blocks:
    graph = graph_of_faces(mesh.faces, len(mesh.positions))
    partition = derive_partition(graph, parts)
    return grow_blocks(graph, partition, int(np.diff(partition.bounds).max()))


def parts_of(mesh: TriangleMesh, parts: int, width: int) -> tuple[Part, ...]:
    scheme = Scheme(blocks_of(mesh, parts), FIRST_FRAME, Adaptive(width, 0.01))
    return make_parts(scheme, mesh.faces, mesh.positions, width=width, threads=2)


def differences(parts: tuple[Part, ...], field: np.ndarray) -> list[np.ndarray]:
    return [part.difference(field, field) for part in parts]


def test_full_dictionaries_give_a_field_back() -> None:
    mesh = torus(16, 10)
    parts = parts_of(mesh, 4, 1000)
    assert sorted(np.concatenate([part.vertices for part in parts]).tolist()) == list(range(160))
    wanted = np.random.default_rng(0).normal(size=(160, 5))
    field = np.zeros_like(wanted)
    for part, difference in zip(parts, differences(parts, wanted), strict=True):
        assert np.allclose(part.basis.T @ part.basis, np.eye(len(part.vertices)), atol=1e-5)
        part.place(field, difference)
    np.testing.assert_allclose(field, wanted, atol=1e-4)


def test_a_translation_is_all_in_the_first_part() -> None:
    mesh = patch(12, 12)
    parts = parts_of(mesh, 5, 1000)
    first, *others = differences(parts, np.tile([1.0, -2.0, 3.0], (144, 1)))
    # The lowest column of a part that hangs on nothing is constant: its coefficient is sqrt(n) times the translation.
    assert first[0] == pytest.approx(np.sqrt(len(parts[0].vertices)) * np.array([1.0, -2.0, 3.0]), rel=1e-4)
    assert np.abs(first[1:]).max() < 1e-4
    assert max(np.abs(other).max() for other in others) < 1e-4


def test_the_extension_is_harmonic() -> None:
    mesh = patch(9, 9)
    graph = blocks_of(mesh, 2).graph
    _, second = parts_of(mesh, 2, 5)  # which is exact, however narrow the dictionary
    known = np.zeros((81, 3))
    outside = np.setdiff1d(np.arange(81), second.vertices)
    known[outside] = mesh.positions[outside]
    second.place(known, np.zeros((second.basis.shape[1], 3)))
    weights = cotangent_weights(graph, mesh.faces, mesh.positions)
    for vertex in second.vertices:
        edges = slice(graph.offsets[vertex], graph.offsets[vertex + 1])
        mean = np.average(known[graph.neighbors[edges]], axis=0, weights=weights[edges])
        np.testing.assert_allclose(known[vertex], mean, atol=1e-4)  # but for the tether


def test_a_narrow_dictionary_has_the_lowest_columns_of_a_wide_one() -> None:
    mesh = torus(16, 10)
    for narrow, wide in zip(parts_of(mesh, 3, 7), parts_of(mesh, 3, 1000), strict=True):
        assert np.array_equal(narrow.basis, wide.basis[:, :7])
