"""A part of the walk over all frames and fields; `python -m tools.attack walk` is the whole."""

from pathlib import Path

from bsm.bitstream.container.header import HEADER_FIELDS, Declaration, fields_of
from bsm.bitstream.container.wire import FrameType
from tools.attack.walk import bases, cases

LAW = (Path(__file__).parents[2] / "spec" / "limits.md").read_text()
CASES = {case.name: case for case in cases(20_000)}


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
