"""A few bombs that are quickly made; `python -m tools.attack bombs` and `charges` measure all of them."""

import sys
from dataclasses import replace
from pathlib import Path

import pytest

from bsm import CorruptError, Decoder, LimitError, Limits
from bsm.bitstream.container.header import HEADER_FIELDS, Declaration, fields_of
from bsm.bitstream.container.wire import FrameType
from tools.attack.bombs import THINGS, YARDSTICK, things
from tools.attack.streams import BOMBS, _apart, ring
from tools.attack.taken import decode_all, taken_by, warm_up
from tools.attack.walk import bases, cases

REFUSED = {
    "members-illegal": (CorruptError, "overlap too much"),
    "narrow": (LimitError, "work"),
    "narrow-small": (LimitError, "work"),
    "wide": (LimitError, "memory"),
    "wide-exact": (LimitError, "memory"),
    "careful": (LimitError, "work"),
    "expander": (LimitError, "entangled"),
    "gop-wide": (LimitError, "memory"),
    "moving": (LimitError, "memory"),
    "moving-frames": (LimitError, "work"),
    "moving-most": (LimitError, "work"),
    "sequence-power": (LimitError, "work"),
    "seams-many": (LimitError, "memory"),
    "nested-header": (CorruptError, "a header of"),
    "nested-attribute": (CorruptError, "a declaration of"),
}
"""How, and what the message is about."""


LONG = ("moving", "moving-frames", "moving-most", "seams-many", "nested-attribute", "nested-header")


@pytest.mark.parametrize(
    "name", [pytest.param(n, marks=pytest.mark.slow) if n in LONG else n for n in REFUSED]
)
def test_what_asks_for_too_much_is_refused(name):
    error, about = REFUSED[name]
    taken = decode_all(BOMBS[name](), "events", Limits())
    assert taken.outcome.startswith(error.__name__)
    assert about in taken.outcome


def test_looks_all_over_memory_are_charged_vertex_by_vertex():
    stream = _apart(ring(64, 64), 6)
    most = decode_all(stream, "events", Limits.wide()).work
    assert most > 4096 * 25_000  # twice what everything else costs
    for work, outcome in (
        (most, "decoded"),
        (most - 1, "LimitError: most_work"),
        (most / 2, "LimitError: most_work"),
    ):
        taken = decode_all(stream, "events", replace(Limits.wide(), most_work=work))
        assert taken.outcome.startswith(outcome) and taken.work < work + 32 * 8 * 9 * 100


ALLOWED = "members tiny copies grid-chunks congruent-chunks light-chunks light-hubs layers-chunks gop-still"


@pytest.mark.parametrize("name", ALLOWED.split())
def test_what_is_allowed_is_paid_for(name):
    stream = BOMBS[name]()
    taken, limits = decode_all(stream, "events", Limits()), Limits()
    granted = limits.work + limits.work_per_vertex * (taken.vertices + taken.shown)
    assert 0.0 < taken.work <= granted + limits.work_per_byte * len(stream)


def test_a_service_has_an_absolute_bound():
    limits = Limits.service()
    with Decoder(limits) as decoder, pytest.raises(LimitError, match="most_work"):
        decoder.receive_data(BOMBS["narrow"]())
        decoder.decode_rest()
    for bound in ("most_work", "most_memory"):
        assert getattr(Limits(), bound) > getattr(limits, bound)


@pytest.mark.skipif(sys.platform != "linux", reason="memory is measured as Linux tells it")
@pytest.mark.parametrize("how", ["events", "browser"])
def test_the_measure_sees_what_a_stream_takes(how):
    warm_up()
    taken = taken_by(BOMBS["members"](), how, "default")
    assert "missing" in taken.outcome
    assert taken.vertices == 65536
    assert 2 << 20 < taken.memory < (1 << 26) + 1024 * taken.vertices
    assert 0.0 < taken.seconds < 3.6


def test_many_and_large_streams_are_made_of_all_that_there_can_be_many_of():
    assert things() <= set(THINGS)
    assert {YARDSTICK, *(name for pair in THINGS.values() for name in pair)} <= set(BOMBS)
    assert all(many != large for many, large in THINGS.values())


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
