"""The page on production: the file of its container names what is there, and warnings reach the logger."""

import logging
import re
import sys
import tomllib
import warnings
from pathlib import Path

import pytest

import bsm

ROOT = Path(__file__).parents[1]
PAGE = (ROOT / "docs/guides/production.md").read_text("utf-8")
LOOSE = ([(0, 0, 0), (1, 0, 0), (0, 1, 0), (9, 9, 9)], [(0, 1, 2)])


def test_the_file_of_the_container_names_files_extras_and_options_that_there_are():
    (text,) = re.findall(r"```dockerfile\n(.*?)```", PAGE, re.DOTALL)
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    extras = re.findall(r"'(?:/checkout|([\w-]+))\[(\w+)\]'", text)
    assert (
        len(extras) == 2
        and {extra for _, extra in extras} <= project["optional-dependencies"].keys()
    )
    assert {name for name, _ in extras if name} == {project["name"]}
    copied = re.findall(r"^COPY (?!--from)(\S+) (\S+)$", text, re.MULTILINE)
    assert all((ROOT / source).exists() for source, _ in copied)
    places = dict(copied)
    (command,) = re.findall(r"^CMD \[(.*)\]$", text, re.MULTILINE)
    program, *words = re.findall(r'"(.*?)"', command)[1:]
    assert program == places["examples/service.py"]
    service = (ROOT / "examples/service.py").read_text("utf-8")
    assert all(f'"{word}"' in service for word in words if word.startswith("--"))
    # The check of health asks the port that the service opens and the file exposes.
    port = words[words.index("--port") + 1]
    assert (
        f"127.0.0.1:{port}/health" in text and f"EXPOSE {port}" in text and '"/health"' in service
    )


def test_the_logger_gets_each_warning_also_those_that_python_hides(caplog):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for _ in range(2):
            bsm.encode(LOOSE)
    assert [(record.name, record.levelno) for record in caplog.records] == [
        ("bsm", logging.WARNING)
    ] * 2
    assert "left out 1 vertex that no face uses" in caplog.text


def test_programs_that_do_not_log_see_each_warning_once(monkeypatch, capsys):
    monkeypatch.setattr(logging.getLogger("bsm"), "propagate", False)
    with pytest.warns(bsm.BsmWarning) as seen:
        bsm.encode(LOOSE)
    assert len(seen) == 1 and capsys.readouterr().err == ""
    monkeypatch.delitem(sys.modules, "logging")
    with pytest.warns(bsm.BsmWarning):
        bsm.encode(LOOSE)
