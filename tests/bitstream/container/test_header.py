"""Headers: known bytes, round trips, refusals, and the tables of the specification, which say what the code does."""

import math
import re
from dataclasses import MISSING, replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from bsm import CorruptError
from bsm.bitstream.container.header import (
    HEADER_FIELDS,
    LAW,
    LAW_OF_SEQUENCES,
    PAPER,
    Constants,
    Declaration,
    Header,
    fields_of,
)
from bsm.bitstream.container.packets import write_header
from bsm.bitstream.container.wire import SHORT, SKIPPABLE_TYPES, FrameType, checksum, write_map
from tests.streams import info_of
from tools.surgery import record_of, stream_of

SMALL_HEADER = Header(vertices=100, faces=190, blocks=3, block_size=60, coefficients=10)


def parse(payload: bytes) -> Header:
    return record_of(Header, payload)


def test_known_bytes():
    # fixmap of 5; 1: 100, 2: uint8 190, 3: 3, 4: 60, 5: 10
    assert write_header(SMALL_HEADER).hex() == "85016402ccbe0303043c050a"
    # 7 (step): 0.5 is exact in single precision; 9 (scale): 0.1 is not
    header = replace(SMALL_HEADER, step=0.5, scale=0.1)
    assert write_header(header).hex() == "87016402ccbe0303043c050a07ca3f00000009cb3fb999999999999a"


def legal_value(name):
    declared = HEADER_FIELDS[name]
    if declared.type is int:
        return st.integers(int(declared.low), int(declared.high))
    if declared.type is tuple and declared.item is int:
        number = st.integers(int(declared.low), int(declared.high))
    else:
        number = st.floats(declared.low, declared.high)
    if declared.type is float:
        return number
    least, most = declared.lengths
    return st.lists(number, min_size=least, max_size=most).map(tuple)


NOT_ALONE = {
    *("vertices", "faces"),
    *(
        "blocks",
        "block_size",
        "coefficients",
        "refinement",
        "grid",
        "lattice",
        "corner",
        "light",
        "sequence",
        "run",
    ),
    "paper",
}
PAPERS = st.builds(
    Constants,
    bits=st.integers(0, 32),
    coarser=st.integers(0, 30),
    exact=st.integers(0, 1),
    power=st.integers(1, 64),
    iterations=st.integers(1, 1024),
    key_iterations=st.integers(1, 1024),
    shift=st.floats(2.0**-30, 2.0**30),
    springs=st.integers(0, 1),
)


@given(
    st.fixed_dictionaries(
        {}, optional={n: legal_value(n) for n in HEADER_FIELDS if n not in NOT_ALONE}
    ),
    st.just(()) | st.tuples(st.integers(0, 2**31 - 1), st.integers(1, 2**31 - 1)),
    PAPERS,
)
def test_round_trip(changes, sequence, paper):
    law = LAW_OF_SEQUENCES if sequence else LAW
    header = replace(SMALL_HEADER, **changes, sequence=sequence, paper=paper.entry(law))
    assert parse(write_header(header)) == header
    assert header.constants == paper
    assert (header.frames, header.gop_frames) == (sequence or (0, 0))


@pytest.mark.parametrize(("sequence", "law"), [((), LAW), ((3, 3), LAW_OF_SEQUENCES)])
def test_constants_of_the_law_are_not_stored(sequence, law):
    header = replace(SMALL_HEADER, sequence=sequence)
    assert header.constants == law and law.entry(law) == ()


LAYERS = st.tuples(st.floats(2.0**-40, 1.0), st.floats(1 / 16, 64.0))


def test_a_mesh_that_a_run_has_again_comes_back():
    again = Header(vertices=100, faces=190, sequence=(300, 9), run=(4, 2))
    # 17: [uint16 300, 9], 18: [4, 2]
    assert write_header(again).hex() == "84016402ccbe1192cd012c0912920402"
    assert parse(write_header(again)) == again
    assert (again.run_number, again.mesh_of, SMALL_HEADER.run_number, SMALL_HEADER.mesh_of) == (
        4,
        2,
        0,
        None,
    )


@given(LAYERS)
def test_a_layer_round_trips(layer):
    header = parse(write_header(replace(SMALL_HEADER, refinement=layer)))
    assert header.layer is not None and (header.layer.step, header.layer.ratio) == layer
    assert SMALL_HEADER.layer is None


SMALL = {1: 100, 2: 190, 3: 3, 4: 60, 5: 10}
ILLEGAL = ({1: 4_000_000_000}, {1: "x"}, {9: "x"})
UNREADABLE = (
    *(write_map(sorted((SMALL | changes).items())) for changes in ILLEGAL),
    write_map([(1, 100)]),
    b"\x81\x01" + b"\x91" * 100_000 + b"\x01",
    b"\x81\x01" * 100_000 + b"\x01",
    b"\x81\x01\xdb\xff\xff\xff\xff",
    b"\x81\x01\xdd\xff\xff\xff\xff",
    b"\x91\x01",
    b"",
)


@pytest.mark.parametrize("payload", UNREADABLE)
def test_headers_that_cannot_be_read(payload):
    with pytest.raises(CorruptError):
        info_of(stream_of([(FrameType.HEADER, payload)]))


@pytest.mark.parametrize(
    "changes", [{"vertices": 0}, {"step": math.nan}, {"step": 0.0}, {"center": (1, 2)}]
)
def test_a_header_cannot_have_illegal_values(changes):
    with pytest.raises(CorruptError):
        info_of(stream_of([(FrameType.HEADER, write_header(replace(SMALL_HEADER, **changes)))]))


SPEC = Path(__file__).parents[3] / "spec"
DOCUMENT = (SPEC / "core-1-stream.md").read_text()


def number(value) -> str:
    """A number as the document writes it: extreme powers of two as such."""
    if value in (2**20 - 1, 2**31 - 1, 2**32 - 1):
        return f"2^{int(value).bit_length()}-1"
    if value < 0 and number(-value).startswith("2^"):
        return f"-{number(-value)}"
    mantissa, exponent = math.frexp(value)
    if mantissa == 0.5 and not 1e-3 < value < 1e6:
        return f"2^{exponent - 1}"
    return f"{value:g}"


def row(name: str, record: type = Header) -> str:
    """The line of the document's table for one field, without its meaning."""
    declared = fields_of(record)[name]
    least, most = declared.lengths
    kind = {
        int: "method" if declared.is_method else "int",
        float: "float",
        tuple: "floats",
        str: "text",
    }[declared.type]
    if declared.type is tuple:
        kind = "ints" if declared.item is int else kind
        kind += f" [{least}]" if least == most else f" [{least} to {most}]"
    default, listed = declared.default, declared.type is tuple
    shown = (
        "none"
        if default is MISSING
        else f"[{', '.join(map(number, default))}]"
        if listed
        else number(default)
    )
    return f"| {declared.key} | {name} | {kind} | {number(declared.low)}..{number(declared.high)} | {shown} |"


@pytest.mark.parametrize("name", HEADER_FIELDS)
def test_header_field_is_documented(name):
    lines = [line for line in DOCUMENT.splitlines() if line.startswith(row(name))]
    assert len(lines) == 1, f"core-1-stream.md needs the line: {row(name)} <meaning> |"


def test_no_other_header_field_is_documented():
    section = DOCUMENT[DOCUMENT.index("## F 4. ") : DOCUMENT.index("## F 5. ")]
    keys = [int(key) for key in re.findall(r"^\| (\d+) \|", section, re.MULTILINE)]
    assert keys == [declared.key for declared in HEADER_FIELDS.values()]


def test_declarations_are_documented():
    document = (SPEC / "extension-attributes.md").read_text()
    fields = fields_of(Declaration)
    keys = re.findall(r"^\| (\d+) \|", document, re.MULTILINE)
    assert [int(key) for key in keys] == [declared.key for declared in fields.values()]
    for name in fields:
        assert row(name, Declaration) in document


def test_the_papers_entry_is_documented():
    document = (SPEC / "extension-paper.md").read_text()
    rows = re.findall(
        r"^\| (\w+) \| ([\d^-]+)\.\.([\d^-]+) \| ([\d^-]+) \|", document, re.MULTILINE
    )
    stated = {
        name: [math.pow(*map(float, f"{text}^1".split("^")[:2])) for text in texts]
        for name, *texts in rows
    }
    assert {name: default for name, (_, _, default) in stated.items()} == PAPER
    for name, (low, high, _) in stated.items():
        beyond = (low / 2, high * 2) if name == "shift" else (low - 1, high + 1)
        for value, refused in (low, False), (high, False), (beyond[0], True), (beyond[1], True):
            paper = replace(Constants(bits=12), **{name: value})
            header = write_header(replace(SMALL_HEADER, paper=paper.entry(LAW)))
            with pytest.raises(
                CorruptError, match="legal" if refused else "unexpected section type 15"
            ):
                info_of(stream_of([(FrameType.HEADER, header)]))


def test_frame_types_are_documented():
    section = DOCUMENT[DOCUMENT.index("**3.4**") : DOCUMENT.index("**3.5**")]
    types = [(int(key), name) for key, name in re.findall(r"\b(\d+) ([A-Z]{3,}) ", section)]
    assert sorted(types) == sorted((item.value, item.name) for item in FrameType)
    assert f"{SKIPPABLE_TYPES[0]} to {SKIPPABLE_TYPES[-1]} are skippable" in section


def test_checksums_are_documented():
    for size in (2, 4):
        assert f"0x{int.from_bytes(checksum(size, b'123456789'), 'little'):X}" in DOCUMENT
    assert f"payloads of fewer than {SHORT} bytes" in DOCUMENT
