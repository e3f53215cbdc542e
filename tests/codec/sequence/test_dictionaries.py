"""The dictionaries of a sequence, on parts whose extension is known."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from bsm.bitstream.errors import LimitError
from bsm.bitstream.limits import Limits
from bsm.codec.arrays import Matrix
from bsm.codec.basis.laplacian import cotangent_weights
from bsm.codec.blocks.overlap import Blocks, derive_partition, grow_blocks
from bsm.codec.geometry.graph import graph_of_faces
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.sequence.dictionaries import SPARE, Dictionaries, Part, find_sites
from bsm.codec.sequence.run_encoding import FIRST_FRAME
from bsm.codec.static.work import Budget
from tests.shapes import patch, torus


def blocks_of(mesh: TriangleMesh, parts: int) -> Blocks:
    graph = graph_of_faces(mesh.faces, len(mesh.positions))
    partition = derive_partition(graph, parts)
    return grow_blocks(graph, partition, int(np.diff(partition.bounds).max()))


def dictionaries(mesh: TriangleMesh, parts: int, width: int, budget: Budget | None = None) -> Dictionaries:
    budget = budget or Budget(Limits())
    sites = find_sites(blocks_of(mesh, parts), mesh.faces, mesh.positions, width=width, threads=1, budget=budget)
    return Dictionaries(sites, FIRST_FRAME, budget, threads=2)


def parts_of(*arguments: Any) -> tuple[Part, ...]:
    return tuple(dictionaries(*arguments).each(lambda _, part: part))


def differences(parts: tuple[Part, ...], field: Matrix) -> list[Matrix]:
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
        mean = np.average(known[graph.neighbours[edges]], axis=0, weights=weights[edges])
        np.testing.assert_allclose(known[vertex], mean, atol=1e-4)  # but for the tether


def test_a_narrow_dictionary_has_the_lowest_columns_of_a_wide_one() -> None:
    mesh = torus(16, 10)
    for narrow, wide in zip(parts_of(mesh, 3, 7), parts_of(mesh, 3, 1000), strict=True):
        assert np.array_equal(narrow.basis, wide.basis[:, :7])


def test_what_there_is_no_room_for_is_made_again() -> None:
    mesh = torus(40, 30)
    ample = dictionaries(mesh, 12, 1000)
    ample.reserve()
    wanted = [part.basis for part in ample.each(lambda _, part: part)]
    assert all(expected is f.basis for expected, f in zip(wanted, ample.each(lambda _, part: part), strict=True))

    def bases(_: int, part: Part) -> Matrix:
        return part.basis

    needed = sum(site.memory for site in ample.sites)
    largest = max(site.making for site in ample.sites)
    budget = Budget(Limits())
    narrow = dictionaries(mesh, 12, 1000, budget=budget)
    budget.reserve(budget.room() - largest - SPARE - 0.4 * needed)
    narrow.reserve()
    first, second = list(narrow.each(bases)), list(narrow.each(bases))
    for expected, found, repeated in zip(wanted, first, second, strict=True):
        np.testing.assert_array_equal(expected, found)
        np.testing.assert_array_equal(expected, repeated)
    again = [expected is not found for expected, found in zip(first, second, strict=True)]
    assert 0 < sum(again) < 12
    assert again == sorted(again)  # the first ones are kept
    with pytest.raises(LimitError, match="memory"):
        narrow.reserve(needed)
    assert len(list(narrow.each(bases))) == 12
