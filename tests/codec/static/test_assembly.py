"""Putting blocks together by hand: averages, units, numbering, what is final, and what is missing."""

from __future__ import annotations

import numpy as np
import pytest

from bsm.bitstream.errors import NumericError
from bsm.codec.blocks.overlap import Blocks
from bsm.codec.geometry.graph import graph_of_faces
from bsm.codec.static.assembly import Assembly, DecodedBlock, blended
from bsm.codec.static.numbering import Numbering
from bsm.codec.static.units import Units

FACES = np.array([[0, 1, 2], [1, 2, 3], [2, 3, 4]], np.int32)
PLAIN = Units((0.0, 0.0, 0.0), 1.0)


def strip() -> Blocks:
    """A strip of three triangles in two blocks, 0 1 2 and 2 3 4."""
    return Blocks(
        graph_of_faces(FACES, 5),
        np.array([0, 1], np.int32),
        np.array([3, 2], np.int32),
        np.array([0, 3, 6]),
        np.array([9, 9]),
        np.array([0, 1, 2, 3, 4, 2], np.int32),
    )


def block(index: int, vertices: list[int], x: list[float], weights: list[float]) -> DecodedBlock:
    positions = np.stack([np.array(x), np.zeros(len(x)), np.ones(len(x))], axis=1)
    return DecodedBlock(index, np.array(vertices, np.int32), positions, np.array(weights, np.float64))


FIRST, SECOND = block(0, [0, 1, 2], [0, 1, 2], [1, 1, 3]), block(1, [2, 3, 4], [6, 3, 4], [1, 2, 1])


def test_copies_are_averaged_by_their_weights() -> None:
    assert blended(5, [FIRST, SECOND])[:, 0].tolist() == [0, 1, 3, 3, 4]


def test_a_mesh_in_its_own_unit_and_numbers() -> None:
    order = np.array([4, 3, 2, 1, 0], np.int32)
    assembly = Assembly(strip(), 0.0, Units((10.0, 20.0, 30.0), 2.0), Numbering(order[FACES], order))
    assembly.add(FIRST)
    assembly.add(SECOND)
    mesh = assembly.mesh()
    assert mesh.positions.tolist() == [[x, 20, 32] for x in (18, 16, 16, 12, 10)]
    assert mesh.faces.tolist() == [[4, 3, 2], [3, 2, 1], [2, 1, 0]]


def test_a_vertex_is_final_when_its_last_copy_has_come() -> None:
    assembly = Assembly(strip(), 0.0, PLAIN, Numbering(FACES))
    first = assembly.changes(FIRST)
    assert dict(zip(first.vertices.tolist(), first.final.tolist())) == {0: True, 1: True, 2: False}
    second = assembly.changes(SECOND)
    assert second.final.all() and sorted(second.vertices.tolist()) == [2, 3, 4]
    assert dict(zip(second.vertices.tolist(), second.positions[:, 0].tolist())) == {2: 3.0, 3: 3.0, 4: 4.0}


def test_a_lost_block_leaves_vertices_missing_and_others_less_good() -> None:
    assembly = Assembly(strip(), 0.0, PLAIN, Numbering(FACES))
    assembly.changes(FIRST)
    assembly.lose(1)
    losses = assembly.losses()
    assert losses.missing.tolist() == [3, 4] and losses.degraded.tolist() == [2]


def test_with_smoothing_nothing_is_final_while_its_surroundings_are_not_there() -> None:
    assembly = Assembly(strip(), 1.0, PLAIN, Numbering(FACES))
    assert not assembly.changes(FIRST).final.any()
    assert sorted(assembly.changes(SECOND).vertices.tolist()) == [0, 1, 2, 3, 4]


def test_positions_beyond_the_range_of_numbers_are_an_error() -> None:
    assembly = Assembly(strip(), 0.0, Units((0.0, 0.0, 0.0), 1e308), Numbering(FACES))
    assembly.add(FIRST)
    assembly.add(SECOND)
    with pytest.raises(NumericError):
        assembly.mesh()
