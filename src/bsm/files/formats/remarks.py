"""Metadata in files that have no place for it but comments: lines "meta name: value", the value as JSON."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable

from bsm.bitstream.container.maps import MAX_ENTRIES
from bsm.codec.geometry.mesh import Metadata

MOST_BYTES = 1 << 15
"""Of the remarks of one file."""
MOST_ENTRIES = MAX_ENTRIES - 16
"""That are taken from a file: some may be added."""
_ENTRY_BYTES = 16
_REMARK = re.compile(r"meta ([\w.-]{1,255}): (.+)")


def remarks(metadata: Metadata, written: Iterable[str] = ()) -> tuple[list[str], tuple[str, ...]]:
    """The lines that hold metadata, and the names of what they cannot hold."""
    lines: list[str] = []
    left_out: list[str] = []
    room = MOST_BYTES
    elsewhere = set(written)
    for name, value in metadata.items():
        line = "" if isinstance(value, bytes) else f"meta {name}: {json.dumps(value)}"
        size = len(line.encode(errors="replace")) + _ENTRY_BYTES
        if name in elsewhere:
            continue
        if size > room or not _REMARK.fullmatch(line):
            left_out.append(name)
        else:
            room -= size
            lines.append(line)
    return lines, tuple(left_out)


def parse_remarks(lines: Iterable[str]) -> dict[str, str | int | float | bytes]:
    """The metadata that comments hold."""
    matches = filter(None, (_REMARK.fullmatch(line.strip()) for line in lines))
    values = ((match[1], _value(match[2])) for match in matches)
    return {name: value for name, value in values if value is not None}


def _value(text: str) -> str | int | float | None:
    """What JSON says, if it is a string or a number."""
    try:
        value = json.loads(text)
        if isinstance(value, str):
            value.encode()  # a half of a surrogate pair is no text
            return value
    except (ValueError, RecursionError):
        return None
    number = isinstance(value, int | float) and not isinstance(value, bool)
    return value if number and abs(value) < 1 << 63 else None


def fitting(metadata: Metadata, limit: int) -> tuple[dict[str, str | int | float | bytes], dict[str, str]]:
    """The metadata without the largest entries, so that it fits into so many bytes; and why those are left out."""
    sizes = {name: _size(name, value) for name, value in metadata.items()}
    total = sum(sizes.values())
    refused: dict[str, str] = {}
    for name in list(sizes)[MOST_ENTRIES:]:
        total -= sizes.pop(name)
    if len(sizes) < len(metadata):
        refused[f"{len(metadata) - len(sizes)} entries of metadata"] = f"there can be {MAX_ENTRIES}"
    for name in sorted(sizes, key=lambda name: -sizes[name]):
        if total <= limit:
            break
        total -= sizes[name]
        refused[name] = f"with its {sizes[name]} bytes the metadata would take more than {limit}"
    return {name: metadata[name] for name in sizes if name not in refused}, refused


def _size(name: str, value: str | int | float | bytes) -> int:
    content = value.encode(errors="replace") if isinstance(value, str) else value if isinstance(value, bytes) else b""
    return len(name.encode(errors="replace")) + len(content) + _ENTRY_BYTES
