"""The dictionaries of a sequence, on parts whose extension is known."""

from __future__ import annotations

import numpy as np
import pytest

from bitstream.limits import Limits
from codec.blocks.overlap import Blocks, grow_blocks
from codec.blocks.partition import derive_partition
from codec.geometry.graph import graph_of_faces
from codec.geometry.mesh import TriangleMesh
from codec.sequence.dictionaries import Part, build_dictionaries, differences
from codec.sequence.encoder import FIRST_FRAME
from codec.static.work import Allowance
from tests.shapes import patch, torus


def blocks_of(mesh: TriangleMesh, parts: int) -> Blocks:
    graph = graph_of_faces(mesh.faces, len(mesh.positions))
    partition = derive_partition(graph, parts)
    return grow_blocks(graph, partition, int(np.diff(partition.bounds).max()))


def dictionaries(mesh: TriangleMesh, parts: int, width: int, cotangent: bool = True) -> tuple[Part, ...]:
    blocks = blocks_of(mesh, parts)
    return build_dictionaries(
        blocks,
        mesh.faces,
        mesh.positions,
        FIRST_FRAME,
        width=width,
        cotangent=cotangent,
        threads=1,
        allowance=Allowance(Limits()),
    )


@pytest.mark.parametrize("cotangent", [True, False])
def test_full_dictionaries_give_a_field_back(cotangent: bool) -> None:
    mesh = torus(16, 10)
    parts = dictionaries(mesh, 4, 1000, cotangent)
    assert sorted(np.concatenate([part.vertices for part in parts]).tolist()) == list(range(160))
    wanted = np.random.default_rng(0).normal(size=(160, 5))
    field = np.zeros_like(wanted)
    for part, difference in zip(parts, differences(parts, wanted), strict=True):
        assert np.allclose(part.basis.T @ part.basis, np.eye(len(part.vertices)), atol=1e-10)
        part.place(field, difference)
    np.testing.assert_allclose(field, wanted, atol=1e-9)


def test_a_translation_is_all_in_the_first_part() -> None:
    mesh = patch(12, 12)
    parts = dictionaries(mesh, 5, 1000)
    first, *others = differences(parts, np.tile([1.0, -2.0, 3.0], (144, 1)))
    # The lowest column of a part that hangs on nothing is constant: its coefficient is sqrt(n) times the translation.
    assert first[0] == pytest.approx(np.sqrt(len(parts[0].vertices)) * np.array([1.0, -2.0, 3.0]))
    assert np.abs(first[1:]).max() < 1e-9
    assert max(np.abs(other).max() for other in others) < 1e-9


def test_the_extension_is_harmonic() -> None:
    mesh = patch(9, 9)
    graph = blocks_of(mesh, 2).graph
    _, second = dictionaries(mesh, 2, 5, cotangent=False)  # which is exact, however narrow the dictionary
    known = np.zeros((81, 3))
    outside = np.setdiff1d(np.arange(81), second.vertices)
    known[outside] = mesh.positions[outside]
    second.place(known, np.zeros((second.basis.shape[1], 3)))
    for vertex in second.vertices:
        around = graph.neighbours[graph.offsets[vertex] : graph.offsets[vertex + 1]]
        np.testing.assert_allclose(known[vertex], known[around].mean(axis=0), atol=1e-4)  # but for the tether


def test_a_narrow_dictionary_has_the_lowest_columns_of_a_wide_one() -> None:
    mesh = torus(16, 10)
    for narrow, wide in zip(dictionaries(mesh, 3, 7), dictionaries(mesh, 3, 1000), strict=True):
        np.testing.assert_allclose(narrow.basis, wide.basis[:, :7], atol=1e-9)
