"""The tables of the paper: all of them are there, and stand beside its numbers."""

import numpy as np
import pytest

from bsm.files.mesh import write_mesh
from tests.shapes import torus
from tools.replicate import paper
from tools.replicate.fetch import Source


@pytest.fixture
def study(tmp_path):
    sources = []
    for count in range(24, 42, 2):
        mesh, path = torus(count, 30), tmp_path / f"torus{count}.ply"
        write_mesh(path, mesh)
        sources.append(Source(path.stem, path, "unseen", len(mesh.positions)))
    return paper.Study(None, sources, True)


@pytest.mark.slow
def test_every_table_stands_beside_the_paper_s_numbers(study):
    tables = [table for make in paper.TABLES.values() for table in make(study)]
    assert len({table["title"] for table in tables}) == len(tables) == len(paper.TABLES) + 2
    assert all(len(row) == len(table["columns"]) for table in tables for row in table["rows"])
    assert sum(cell.endswith(")") for table in tables for row in table["rows"] for cell in row[1:]) > 80
    assert sum("hold" in table["note"] for table in tables) > 4


def test_the_paper_s_numbers_stand_in_brackets(study):
    table = paper.printed("t", ("x", "y"), [("near", (1.05, 2.0), (1.0,)), ("none", (3.0, 2.0), ())], "a remark")
    assert table["rows"] == [["near", "1.05 (1)", "2"], ["none", "3", "2"]] and table["note"] == "a remark"
    assert paper.claim("It is so", False, "it was not.") == '"It is so" does not hold: it was not.'
    models = {study.model(role).name for role in ("bunny", "julio", "twelve")}
    assert len(models) == 3  # no mesh plays two roles


def test_a_matrix_left_out_of_its_mean_is_farther_from_it():
    random = np.random.default_rng(0)
    matrices = [random.normal(size=(3, 20, 20)) for _ in range(4)]
    printed, honest = paper.coherence_errors(matrices), paper.left_out(matrices)
    assert paper.smallest_on_diagonal(printed) == 4  # even of noise, which has no coherence
    assert paper.smallest_on_diagonal(honest) < 4 and (np.diag(honest) > np.diag(printed)).all()
    off = ~np.eye(4, dtype=bool)
    assert (honest[off] == printed[off]).all()
