"""The law of the bytes (spec/core-1-stream.md, and the extensions' tables) must say what the code does."""

import math
import re
from pathlib import Path

import pytest

from bsm.bitstream.container.header import HEADER_FIELDS, Declaration, Header, Paper, defaults_of, fields_of
from bsm.bitstream.container.wire import SHORT, SKIPPABLE_TYPES, FrameType, checksum

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
    kind = {int: "method" if declared.is_method else "int", float: "float", tuple: "floats", str: "text"}[declared.type]
    if declared.type is tuple:
        kind = "ints" if declared.item is int else kind
        kind += f" [{least}]" if least == most else f" [{least} to {most}]"
    default = defaults_of(record).get(name)
    if isinstance(default, tuple):
        shown = f"[{', '.join(map(number, default))}]"
    else:
        shown = "none" if default in (None, b"") else number(default)
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
    for name, declared in fields_of(Paper).items():
        low, high = (
            f"2^{round(math.log2(end))}" if declared.type is float else end for end in (declared.low, declared.high)
        )
        default = getattr(Paper(), name)
        assert f"| {name} | {low}..{high} | {'2^-7' if default == 2.0**-7 else default} |" in document
    assert re.findall(r"^\| (\w+) \| [\d^-]+\.\.", document, re.MULTILINE) == list(fields_of(Paper))


def test_frame_types_are_documented():
    section = DOCUMENT[DOCUMENT.index("**3.4**") : DOCUMENT.index("**3.5**")]
    types = [(int(key), name) for key, name in re.findall(r"\b(\d+) ([A-Z]{3,}) ", section)]
    assert sorted(types) == sorted((item.value, item.name) for item in FrameType)
    assert f"{SKIPPABLE_TYPES[0]} to {SKIPPABLE_TYPES[-1]} are skippable" in section


def test_checksums_are_documented():
    for size in (2, 4):
        assert f"0x{int.from_bytes(checksum(size, b'123456789'), 'little'):X}" in DOCUMENT
    assert f"payloads of fewer than {SHORT} bytes" in DOCUMENT
