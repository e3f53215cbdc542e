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
_FLOAT32_MAX = struct.unpack(">f", b"\x7f\x7f\xff\xff")[0]


def write_map(entries: Iterable[tuple[Any, Any]]) -> bytes:
    """A msgpack map of (key, value) pairs in the order given; every value in its shortest exact form.

    Values are integers, finite floats, strings, bytes, or lists of these.
    """
    pairs = list(entries)
    packed = b"".join(_pack(key) + _pack(value) for key, value in pairs)
    return bytes(msgpack.Packer().pack_map_header(len(pairs))) + packed


def parse_map(payload: bytes) -> list[tuple[Any, Any]]:
    """The pairs of a canonical msgpack map, keys strictly ascending (strings by their UTF-8 bytes).

    Raises
    ------
    CorruptError
        If `payload` is anything but what `write_map` makes of ascending keys of one type.
    """
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
