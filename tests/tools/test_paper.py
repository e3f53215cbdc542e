"""bsm paper: every table and figure is there, stands on its own, and says what it is made from."""

import json
import re

import numpy as np
import pytest

from bsm.bitstream.errors import OptionError
from tests.tools.running import tool
from tools.measure.paper.command import make_exhibits
from tools.measure.paper.report import Cell, Column, Exhibit, Picture, Table, report, summary
from tools.measure.paper.segments import errors, left_out, smallest_on_diagonal
from tools.measure.paper.study import QUICK, Study


@pytest.fixture(scope="module")
def quick(tmp_path_factory) -> tuple[str, dict]:
    """A quick report, and the data it printed."""
    path = tmp_path_factory.mktemp("paper") / "report.html"
    ran = tool("paper", "-o", path, "--quick", "--json")
    assert ran.returncode == 0, ran.stderr
    assert "generated" in ran.stderr
    return path.read_text(), json.loads(ran.stdout)


@pytest.mark.slow
def test_the_scoreboard_counts_numbers_and_claims(quick):
    text, data = quick
    assert 'id="scoreboard"' in text
    claims = [claim for exhibit in data.values() for claim in exhibit["claims"]]
    assert len(claims) >= 5
    assert {claim["says"].split(":")[0] for claim in data["rates"]["claims"]} == {"OI, R"}
    assert any("jumps" in claim["says"] for claim in data["dynamic"]["claims"])
    for claim in claims:
        assert claim["found"] and claim["says"] in text.replace("&#x27;", "'")


@pytest.mark.slow
def test_every_number_of_the_paper_stands_beside_ours_and_differences_are_explained(quick):
    text, data = quick
    cells = [cell for e in data.values() for t in e["tables"] for row in t["rows"] for cell in row["cells"]]
    there = [cell for cell in cells if cell["paper"] is not None]
    assert len(there) > 80
    for cell in there:
        assert cell["ours"] is not None
        assert cell["note"] is None or len(cell["note"]) > 20
    embedded = re.search(r'<script type="application/json" id="data">(.+)</script>', text).group(1)
    assert json.loads(embedded) == data
    assert "generated ones stand in" in text


def test_what_is_refused(tmp_path):
    for words, said in (
        (["--meshes", str(tmp_path / "nowhere")], "has no folder static/"),
        (["--only", "nothing"], "nothing"),
    ):
        done = tool("paper", "-o", tmp_path / "r.html", "--quick", *words)
        assert done.returncode == 2 and said in done.stderr and "Traceback" not in done.stderr
    with pytest.raises(OptionError):
        make_exhibits(Study(None, QUICK, lambda text: None), ["best"])


def test_notes_stand_where_numbers_differ_and_nowhere_else():
    column = Column("x", 1, 0.1, "since <b> is so")
    table = Table("t", "", (column,), (("near", (Cell(1.05, 1.0),)), ("far", (Cell(1.2, 1.0),)), ("no", (Cell(3.0),))))
    assert table.compared() == (2, 1)
    exhibit = Exhibit("title", "place", (table,), (Picture("p", "image/png", b"data"),), ("a remark",))
    text = report({"key": exhibit}, table, generated=False, quick=False)
    assert text.count("since &lt;b&gt; is so") == 2  # below each of the two tables
    assert "+20&thinsp;%" in text and "+5&thinsp;%" not in text
    assert "generated ones stand in" not in text
    assert "1 of 2 numbers" in summary({"key": exhibit})


def test_a_matrix_left_out_of_its_mean_is_farther_from_it():
    random = np.random.default_rng(0)
    matrices = [random.normal(size=(3, 20, 20)) for _ in range(4)]
    printed, honest = errors(matrices), left_out(matrices)
    assert smallest_on_diagonal(printed) == 4  # even of noise, which has no coherence
    assert smallest_on_diagonal(honest) < 4
    assert (np.diag(honest) > np.diag(printed)).all()
    off = ~np.eye(4, dtype=bool)
    assert (honest[off] == printed[off]).all()


@pytest.mark.real
def test_real_meshes_are_found(meshes):
    study = Study(meshes, QUICK, lambda text: None)
    exhibits = make_exhibits(study, ["normals", "sequences"])
    assert "Shared dictionaries" in exhibits["sequences"].remarks[0]
    assert study.model("twelve").name == "twelve_dodecahedron"
    difference = float(re.search(r"differ by (\S+) at most", exhibits["sequences"].remarks[0]).group(1))
    together, _, *anew = (cells[0].ours for _, cells in exhibits["sequences"].tables[0].rows)
    assert difference < 1e-10 and min(anew) > 5 * together > 0
    theta = [cells[0].ours for _, cells in exhibits["normals"].tables[0].rows]
    assert theta[0] == 0.0 and theta[2] < 0.5 * theta[1]
