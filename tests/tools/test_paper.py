"""The tables of the paper: all of them are there, stand beside its numbers, and are scored."""

import json
import re

import numpy as np
import pytest

from bsm.codec.blocks.overlap import partition_of_labels
from bsm.codec.geometry.graph import graph_of_faces
from bsm.evaluation.curve import paper_options
from tests.shapes import patch, torus
from tests.tools.running import tool
from tools.measure import paper


@pytest.mark.slow
def test_every_table_stands_beside_the_paper_s_numbers():
    ran = tool("paper", "--quick", "--json")
    assert ran.returncode == 0, ran.stderr
    tables = json.loads(ran.stdout)["tables"]
    assert len(tables) == 22
    assert sum(other is not None for table in tables for _, _, theirs in table["rows"] for other in theirs) > 80
    assert all(len(ours) == len(table["columns"]) for table in tables for _, ours, _ in table["rows"])
    claims = [claim for table in tables for claim in table["claims"]]
    assert len(claims) > 10 and all(claim["found"] and claim["says"] for claim in claims)


def test_what_is_refused(tmp_path):
    for words, message in (
        (["--meshes", str(tmp_path / "nowhere")], "has no folder static/"),
        (["--only", "best"], "no table is called best"),
    ):
        done = tool("paper", "--quick", *words)
        assert done.returncode == 2 and message in done.stderr and "Traceback" not in done.stderr


def test_what_differs_has_a_star_and_counts():
    rows = [("near", (1.05, 2.0), (1.0,)), ("far", (1.2, 2.0), (1.0, 9.0)), ("none", (3.0, 2.0), ())]
    claims = (paper.Claim("It is so.", False, "it was not."),)
    table = paper.Table("t", {"x": 0.1, "y": None}, rows, ("a remark",), claims)
    assert table.score() == (1, 2)
    assert "| near | 1.05 (1) | 2 |\n| far | 1.2 (1)* | 2 (9) |\n| none | 3 | 2 |" in table.text()
    assert "a remark\n- It is so. **Does not hold**: it was not." in table.text()


def test_a_matrix_left_out_of_its_mean_is_farther_from_it():
    random = np.random.default_rng(0)
    matrices = [random.normal(size=(3, 20, 20)) for _ in range(4)]
    printed, honest = paper.coherence_errors(matrices), paper.left_out(matrices)
    assert paper.smallest_on_diagonal(printed) == 4  # even of noise, which has no coherence
    assert paper.smallest_on_diagonal(honest) < 4 and (np.diag(honest) > np.diag(printed)).all()
    off = ~np.eye(4, dtype=bool)
    assert (honest[off] == printed[off]).all()


def test_deviations_inside_and_at_the_boundary():
    # Three columns of a grid belong to part 0, three to part 1; columns 2 and 3 face each other.
    column, error = np.arange(48) % 6, np.zeros((48, 3))
    error[column == 2, 0] = np.where(np.arange(8) % 2, 1.0, -1.0)
    error[column == 3, 1] = 5.0
    partition = partition_of_labels((column >= 3).astype(np.int32))
    found = paper.boundary_deviations(paper.BlockView(error, graph_of_faces(patch(8, 6).faces, 48), partition, None))
    assert found["inside"] == pytest.approx([0.0, 0.0])
    assert found["boundary"] == pytest.approx([1.0, 0.0])  # a common shift does not deviate at all


def test_errors_along_the_chain_are_those_of_the_mesh():
    view = paper.view_blocks(torus(), paper_options(block_size=150))
    rows = paper.errors_along_chain(view)
    sizes = [len(view.blocks().core(index)) for index in range(len(rows))]
    assert np.dot(sizes, rows[:, 0]) == pytest.approx(np.square(view.error).sum())
    assert {*rows[:, 1]} == {float(view.info.header.coefficients)}


@pytest.mark.real
def test_real_meshes_are_found(meshes):
    study = paper.Study(meshes, True, lambda text: None)
    angles, frames = paper.make_tables(study, ["normals", "sequences"])
    assert study.model("twelve").name == "twelve_dodecahedron"
    difference = float(re.search(r"differ by (\S+) at most", frames.remarks[0]).group(1))
    together, _, *anew = (ours[0] for _, ours, _ in frames.rows)
    assert difference < 1e-10 and min(anew) > 5 * together > 0
    (_, (noisy, _), _), (_, (coarse, _), _) = angles.rows
    assert coarse < 0.5 * noisy
