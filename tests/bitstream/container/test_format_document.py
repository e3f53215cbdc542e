"""spec/format.md must say what the code does."""

import math
import re
from pathlib import Path

import pytest

from bsm.bitstream.container.declaration import Declaration
from bsm.bitstream.container.header import HEADER_FIELDS, Header, defaults_of, fields_of
from bsm.bitstream.container.wire import SHORT, SKIPPABLE_TYPES, FrameType, checksum
from tests.bitstream.streams import BARE, encoded, read_all

DOCUMENT = (Path(__file__).parents[3] / "spec" / "format.md").read_text()


def number(value) -> str:
    """A number as the document writes it: extreme powers of two as such."""
    if value in (2**20 - 1, 2**31 - 1, 2**32 - 1):
        return f"2^{int(value).bit_length()} - 1"
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
        int: "method" if declared.reserved else "int",
        float: "float",
        tuple: "floats",
        str: "text",
    }[declared.type]
    if declared.type is tuple:
        kind = "ints" if declared.item is int else kind
        kind += f" [{least}]" if least == most else f" [{least} to {most}]"
    default = defaults_of(record).get(name)
    if isinstance(default, tuple):
        shown = f"[{', '.join(map(number, default))}]"
    else:
        shown = "none" if default in (None, b"") else number(default)
    return f"| {declared.key} | {name} | {kind} | {number(declared.low)} to {number(declared.high)} | {shown} |"


@pytest.mark.parametrize("name", HEADER_FIELDS)
def test_header_field_is_documented(name):
    lines = [line for line in DOCUMENT.splitlines() if line.startswith(row(name))]
    assert len(lines) == 1, f"spec/format.md needs the line: {row(name)} <meaning> |"


def test_declarations_are_documented():
    document = (Path(__file__).parents[3] / "spec" / "declarations.md").read_text()
    fields = fields_of(Declaration)
    keys = re.findall(r"^\| (\d+) \|", document, re.MULTILINE)
    assert [int(key) for key in keys] == [declared.key for declared in fields.values()]
    for name in fields:
        assert row(name, Declaration) in document


def test_no_other_header_field_is_documented():
    section = DOCUMENT[DOCUMENT.index("## 4. ") : DOCUMENT.index("## 5. ")]
    assert [int(key) for key in re.findall(r"^\| (\d+) \|", section, re.MULTILINE)] == [
        declared.key for declared in HEADER_FIELDS.values()
    ]


def test_frame_types_are_documented():
    section = DOCUMENT[DOCUMENT.index("## 3. ") : DOCUMENT.index("## 4. ")]
    assert re.findall(r"^\| (\d+) \| (\w+) \|", section, re.MULTILINE) == [
        (str(item.value), item.name) for item in FrameType
    ]
    assert f"{SKIPPABLE_TYPES[0]} to {SKIPPABLE_TYPES[-1]} | skippable" in section


def test_checksums_are_documented():
    for size in (2, 4):
        assert f"0x{int.from_bytes(checksum(size, b'123456789'), 'little'):X}" in DOCUMENT
    assert f"payloads of fewer than {SHORT} bytes" in DOCUMENT


def test_example():
    section = DOCUMENT[DOCUMENT.index("## 7. ") : DOCUMENT.index("## 8. ")]
    data = bytes.fromhex("".join(re.findall(r"^    ([0-9a-f ]+?) +\(", section, re.MULTILINE)))
    assert data == encoded("bare")
    assert read_all(data)[:-1] == BARE
