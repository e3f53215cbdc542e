"""Errors block by block, and the order of a block's rows."""

import numpy as np
import pytest

from bsm.codec.blocks.partition import partition_of_labels
from bsm.codec.geometry.graph import graph_of_faces
from bsm.codec.static.options import EncodeOptions
from bsm.evaluation.curve import paper_options
from tests.shapes import patch, torus
from tools.measure.blocks import (
    BlockView,
    boundary_deviations,
    boundary_table,
    draw_boxes,
    draw_per_block,
    errors_along_chain,
    in_bisection_order,
    in_breadth_first_order,
    permuted,
    quartiles,
    spread,
    view_blocks,
)

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


def test_overlap_lowers_the_error_at_boundaries():
    options = paper_options(block_size=150, power=2, keep=0.15)
    medians = {
        case: {where: quartiles(values)["median"] for where, values in groups.items()}
        for case, groups in boundary_table(torus(60, 40), options).items()
    }
    assert medians["weighted average"]["boundary"] < 0.9 * medians["no overlap"]["boundary"]


def test_one_block_has_no_boundary():
    assert quartiles(boundary_deviations(view_blocks(patch(8, 8), SMALL))["boundary"])["median"] is None


def test_errors_along_the_chain_are_those_of_the_mesh():
    view = view_blocks(torus(), paper_options(block_size=150))
    rows = errors_along_chain(view)
    sizes = [len(view.blocks().core(index)) for index in range(len(rows))]
    total = sum(size * row["squared_error"] for size, row in zip(sizes, rows, strict=True))
    assert total == pytest.approx(np.square(view.error).sum())
    assert {row["coefficients"] for row in rows} == {float(view.info.header.coefficients)}


def test_spread():
    assert spread([{"squared_error": 1.0}, {"squared_error": 9.0}]) == pytest.approx(0.5)


def test_reordered_rows_are_the_same_block():
    view = view_blocks(torus(), SMALL)
    blocks = view.blocks()
    block, found = in_bisection_order(blocks, 1).block, in_breadth_first_order(blocks, 1)
    other = found.block
    assert other.vertices.tolist() == blocks.members_of(1).tolist()
    back = permuted(found, np.argsort(other.vertices)[np.argsort(np.argsort(block.vertices))]).block
    assert back.vertices.tolist() == block.vertices.tolist()
    assert edges(back) == edges(block)


def test_pictures(tmp_path):
    pytest.importorskip("matplotlib")
    written = draw_boxes({"no overlap": {"inside": np.ones(3), "boundary": np.arange(4.0)}}, tmp_path / "box")
    written += draw_per_block({"fixed": [{"squared_error": 1e-6, "coefficients": 9.0}] * 3}, tmp_path / "blocks")
    assert [path.name for path in written] == ["box.png", "box.svg", "blocks.png", "blocks.svg"]


def edges(block) -> set[tuple[int, int]]:
    rows = np.repeat(np.arange(block.size), np.diff(block.offsets))
    return set(zip(rows.tolist(), block.neighbours.tolist(), strict=True))
