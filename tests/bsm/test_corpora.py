"""Folders of many kinds of files: names that would meet, what is there already, reasons, and lines for programs."""

import json

import pytest

from bsm import OptionError
from bsm.files.pipes import _errors_of
from bsm.jobs.plan import plan
from bsm.jobs.report import table
from tests.bsm.program import bsm

TRIANGLE = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
OBJ = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"


@pytest.fixture
def corpus(tmp_path):
    folder = tmp_path / "scans"
    folder.mkdir()
    (folder / "part.off").write_text(TRIANGLE)
    (folder / "part.obj").write_text(OBJ)
    (folder / "other.off").write_text(TRIANGLE)
    (folder / "broken.off").write_text("OFF\n3 1 0\n")
    return folder


def test_inputs_that_differ_in_their_suffix_alone_keep_it(corpus, tmp_path):
    done = bsm("encode", "-r", corpus, "-o", tmp_path / "out", "--report", tmp_path / "r.json", text=True)
    assert done.returncode == 12
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == ["other.bsm", "part.obj.bsm", "part.off.bsm"]
    report = json.loads((tmp_path / "r.json").read_text())
    outputs = {entry["input"].rpartition("/")[2]: entry["output"].rpartition("/")[2] for entry in report["files"]}
    assert outputs["part.obj"] == "part.obj.bsm" and outputs["other.off"] == "other.bsm"
    lines = done.stderr.splitlines()
    head = next(number for number, line in enumerate(lines) if line.startswith("input "))
    assert "broken.off" in lines[head + 1] and lines[head + 1].count("broken.off") == 1
    assert "failed: the file is cut short" in lines[head + 1]
    again = bsm("encode", "-r", corpus, "-o", tmp_path / "out", "--report", tmp_path / "r.json", "--resume", text=True)
    assert "3 of 4 were up to date" in again.stderr and "as it was" not in again.stderr.splitlines()[0]


def test_the_table_has_all_rows_and_failures_first():
    files = [{"input": f"{n}.ply", "output": ""} for n in range(99)] + [{"input": "x", "output": "", "error": "x: bad"}]
    lines = list(table(files))
    assert len(lines) == 101 and lines[1].endswith("failed: bad")


def test_patterns_behind_file_urls_are_expanded(corpus, tmp_path):
    jobs = plan([f"file://{corpus}/*.off"], f"file://{tmp_path}/out/", lambda _: ".bsm")
    assert [job.output.rpartition("/")[2] for job in jobs] == ["broken.bsm", "other.bsm", "part.bsm"]
    with pytest.raises(FileNotFoundError, match="no such file"):
        plan([f"file://{corpus}/*.xyz"], None, lambda _: ".bsm")
    with pytest.raises(OptionError, match="two outputs"):
        plan([str(corpus / "part.off"), str(corpus / "part.off")], f"{tmp_path}/out/", lambda _: ".bsm")


def test_a_server_that_is_down_differs_from_a_missing_file():
    for cause, message in (
        (ConnectionRefusedError(111, "refused"), "does not answer: Connection refused"),
        (None, "No such"),
    ):
        with pytest.raises(OSError, match=message), _errors_of("http://127.0.0.1:1/a.ply"):
            raise FileNotFoundError("http://127.0.0.1:1/a.ply") from cause


@pytest.mark.parametrize("name", ["other.off", "broken.off", "nothere.off"])
def test_with_json_every_line_of_standard_error_is_json(corpus, tmp_path, name):
    done = bsm("encode", corpus / name, corpus / "part.obj", "-o", f"{tmp_path}/", "--json", text=True)
    lines = [json.loads(line) for line in done.stderr.splitlines()]
    assert lines and all({*line} <= {"note", "error", "stage", "share", "seconds", "seconds_left"} for line in lines)
    json.loads(done.stdout)
    alone = bsm("encode", corpus / name, "-o", tmp_path / "a.bsm", "--json", text=True)
    assert [json.loads(line) for line in alone.stderr.splitlines()]
