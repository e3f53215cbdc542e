"""Errors block by block, and the order of a block's rows."""

import numpy as np
import pytest

from bsm.codec.blocks.partition import partition_of_labels
from bsm.codec.geometry.graph import graph_of_faces
from bsm.codec.static.options import EncodeOptions
from bsm.evaluation.curve import paper_options
from tests.shapes import patch, torus
from tools.measure.blocks import BlockView, boundary_deviations, errors_along_chain, view_blocks

SMALL = EncodeOptions(block_size=150, threads=1)


def test_deviations_inside_and_at_the_boundary():
    # Three columns of a grid belong to part 0, three to part 1; columns 2 and 3 face each other.
    mesh = patch(8, 6)
    column = np.arange(48) % 6
    error = np.zeros((48, 3))
    error[column == 2, 0] = np.where(np.arange(8) % 2, 1.0, -1.0)
    error[column == 3, 1] = 5.0
    partition = partition_of_labels((column >= 3).astype(np.int32))
    view = BlockView(error, graph_of_faces(mesh.faces, 48), partition, None)
    found = boundary_deviations(view)
    assert found["inside"] == pytest.approx([0.0, 0.0])
    # Plus and minus one deviate by one; a common shift does not deviate at all.
    assert found["boundary"] == pytest.approx([1.0, 0.0])


def test_errors_along_the_chain_are_those_of_the_mesh():
    view = view_blocks(torus(), paper_options(block_size=150))
    rows = errors_along_chain(view)
    sizes = [len(view.blocks().core(index)) for index in range(len(rows))]
    total = sum(size * row["squared_error"] for size, row in zip(sizes, rows, strict=True))
    assert total == pytest.approx(np.square(view.error).sum())
    assert {row["coefficients"] for row in rows} == {float(view.info.header.coefficients)}
