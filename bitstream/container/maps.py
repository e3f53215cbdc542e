"""Bounded msgpack maps in canonical form: one map has one encoding, and nothing else is accepted."""

from __future__ import annotations

import math
import struct
from collections.abc import Iterable
from itertools import pairwise
from typing import Any

import msgpack

from bsm.bitstream.errors import CorruptError

MAX_ENTRIES = 256
_MAP, _ARRAY = (0x80, 0xDE), (0x90, 0xDC)
"""First bytes: with their number of entries in the lower four bits, or in two bytes behind."""
_SIZES = {0xCA: 4, 0xCB: 8, **{0xCC + i: 1 << i for i in range(4)}, **{0xD0 + i: 1 << i for i in range(4)}}
"""First bytes of numbers, and how many follow."""
_LENGTHS = {0xC4: 1, 0xC5: 2, 0xC6: 4, 0xD9: 1, 0xDA: 2, 0xDB: 4}
"""First bytes of binary and text, and how many bytes their length has."""
_FLOAT32_MAX = struct.unpack(">f", b"\x7f\x7f\xff\xff")[0]


def write_map(entries: Iterable[tuple[Any, Any]]) -> bytes:
    """A msgpack map of (key, value) pairs in the order given; every value in its shortest exact form."""
    pairs = list(entries)
    packed = b"".join(_pack(key) + _pack(value) for key, value in pairs)
    return bytes(msgpack.Packer().pack_map_header(len(pairs))) + packed


def parse_map(payload: bytes) -> list[tuple[Any, Any]]:
    """The pairs of a canonical msgpack map, keys strictly ascending (strings by their UTF-8 bytes)."""
    _scan(payload)
    try:
        pairs = msgpack.unpackb(
            payload,
            raw=False,
            strict_map_key=False,
            object_pairs_hook=tuple,
            max_map_len=MAX_ENTRIES,
            max_array_len=MAX_ENTRIES,
            max_str_len=len(payload),
            max_bin_len=len(payload),
            max_ext_len=0,
        )
    except (ValueError, TypeError, OverflowError, msgpack.UnpackException) as error:
        raise CorruptError(f"map is not readable msgpack: {error}") from error
    if type(pairs) is not tuple:
        raise CorruptError(f"expected a map, found {type(pairs).__name__}")
    keys = [key.encode() if isinstance(key, str) else key for key, _ in pairs]
    if len({type(key) for key, _ in pairs}) > 1 or not all(type(key) in (int, str) for key, _ in pairs):
        raise CorruptError("the keys of a map must be all integers or all strings")
    if any(second <= first for first, second in pairwise(keys)):
        raise CorruptError("the keys of a map must ascend and may not repeat")
    for _, value in pairs:
        _check(value, nested=False)
    if write_map(pairs) != payload:
        raise CorruptError("map is not in its shortest form")
    return list(pairs)


def _scan(payload: bytes) -> None:
    """Refuse, before anything is made of it, what has too many entries, or is nested deeper than a list in a map."""
    entries, start = _many(payload, 0, *_MAP)
    left = MAX_ENTRIES
    for place in range(2 * entries):
        items, inside = _many(payload, start, *_ARRAY) if place % 2 else (-1, start)
        left -= max(items, 0)
        if left < 0:
            raise CorruptError(f"the arrays of a map have more than {MAX_ENTRIES} entries")
        for _ in range(items):
            inside = _after(payload, inside)
        start = inside if items >= 0 else _after(payload, start)
    if start != len(payload):
        raise CorruptError("bytes behind a map, or a map that ends too early")


def _many(payload: bytes, start: int, short: int, long: int) -> tuple[int, int]:
    """How many entries the map or array at `start` has, and where they begin; -1 if there is none."""
    first = payload[start] if start < len(payload) else 0
    if first & 0xF0 == short:
        return first & 15, start + 1
    if first != long:
        if short == _MAP[0]:
            raise CorruptError("expected a map of few entries")
        return -1, start
    count = int.from_bytes(payload[start + 1 : start + 3], "big")
    if count > MAX_ENTRIES:
        raise CorruptError(f"{count} entries of a map or an array are more than {MAX_ENTRIES}")
    return count, start + 3


def _after(payload: bytes, start: int) -> int:
    """Where the value at `start`, which holds no other, ends."""
    if start >= len(payload):
        raise CorruptError("a map ends too early")
    first = payload[start]
    if first < 0x80 or first >= 0xE0:
        return start + 1
    if 0xA0 <= first < 0xC0:
        return start + 1 + (first & 31)
    if first in _SIZES:
        return start + 1 + _SIZES[first]
    width = _LENGTHS.get(first)
    if width is None:
        raise CorruptError(f"a map may not hold what begins with the byte {first} here")
    return start + 1 + width + int.from_bytes(payload[start + 1 : start + 1 + width], "big")


def _pack(value: Any) -> bytes:
    if isinstance(value, float):
        return _pack_float(value)
    if isinstance(value, list | tuple):
        return bytes(msgpack.Packer().pack_array_header(len(value))) + b"".join(map(_pack, value))
    return bytes(msgpack.packb(value))


def _pack_float(value: float) -> bytes:
    """Single precision where that is exact, double otherwise."""
    if abs(value) <= _FLOAT32_MAX:
        single = struct.pack(">f", value)
        if struct.unpack(">f", single)[0] == value:
            return b"\xca" + single
    return b"\xcb" + struct.pack(">d", value)


def _check(value: Any, nested: bool) -> None:
    if type(value) is list and not nested:
        for item in value:
            _check(item, nested=True)
    elif type(value) not in (int, float, str, bytes):
        raise CorruptError(f"a map may not hold a value of type {type(value).__name__}")
    elif type(value) is float and not math.isfinite(value):
        raise CorruptError("a map may not hold a number that is not finite")
