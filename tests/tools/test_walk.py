"""A part of the walk over all frames and fields; `python -m tools.attack walk --web` is the whole."""

import shutil
import sys
from pathlib import Path

import pytest

from bsm.bitstream.container.declaration import Declaration
from bsm.bitstream.container.header import HEADER_FIELDS, fields_of
from bsm.bitstream.container.wire import FrameType
from bsm.bitstream.limits import Limits
from tools.attack.measure import decode_all
from tools.attack.walk import bases, cases, problem_of, web_problems

LAW = (Path(__file__).parents[2] / "spec" / "limits.md").read_text()
CASES = {case.name: case for case in cases(20_000)}
SOME = dict(list(CASES.items())[::6])
linux = pytest.mark.skipif(sys.platform != "linux", reason="memory is measured as Linux tells it")


def test_the_walk_visits_every_frame_type_and_every_field():
    for kind in FrameType:
        assert kind is FrameType.END or f"{kind.name}, many" in CASES
    for name in HEADER_FIELDS:
        assert all(f"{base} header {name} 0" in CASES for base in bases())
    for name in fields_of(Declaration):
        assert f"declaration {name} 0" in CASES


def test_the_law_says_of_every_frame_type_who_charges_it():
    rows = [line.split("|")[1:-1] for line in LAW.splitlines() if line.startswith("| ")]
    assert {kind.name for kind in FrameType} <= {row[0].strip() for row in rows}
    fields = {**HEADER_FIELDS, **fields_of(Declaration)}
    lists = [name for name, declared in fields.items() if declared.type in (tuple, str, bytes)]
    assert {"refinement", "name"} <= set(lists)
    for name in lists:
        assert any(f"`{name}`" in row[1] for row in rows), name
    assert all(row[2].strip() for row in rows if row[1].strip() != "nothing")


@pytest.mark.slow
@linux
def test_what_is_as_large_as_its_bytes_allow_stays_within_the_law():
    decode_all(next(iter(bases().values())), "whole", Limits())  # what is loaded once is nobody's fault
    found = {name: problem_of(case.make(), "whole", "default") for name, case in SOME.items()}
    assert not {name: problem for name, problem in found.items() if problem}


@pytest.mark.slow
@linux
@pytest.mark.skipif(shutil.which("node") is None, reason="there is no node")
def test_the_decoder_for_browsers_stays_within_it_too():
    assert not web_problems({name: case.make() for name, case in SOME.items()})
