"""Streams with attributes that every decoder must refuse."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Any

from bsm.bitstream.container.wire import FrameType, write_varint
from bsm.codec.static.encoder import encode
from tools.surgery import Cursor, frames_of, stream_of, with_declaration, with_header, with_payload
from tools.vectors.bad import Bad
from tools.vectors.good import BASE
from tools.vectors.good_attributes import (
    GRID,
    ORDERED,
    _sequence,
    _split,
    charts,
    colors,
    creases,
    groups,
    in_chunks,
    wild,
    with_attributes,
)
from tools.vectors.meshes import patch, torus

ATTRIBUTE, VALUES, ORDER, BLOCK = FrameType.ATTRIBUTE, FrameType.VALUES, FrameType.ORDER, FrameType.BLOCK


@cache
def _all() -> bytes:
    """Texture coordinates, normals, colors, groups, and floats to the bit, in two chunks each."""
    mesh = with_attributes(torus(8, 7), charts, creases, colors, groups, lambda m: wild(m, "float32"))
    return in_chunks(mesh, replace(GRID, attributes={"float32": "exact"}), 70)


@cache
def _blocks() -> bytes:
    return in_chunks(with_attributes(torus(8, 7), charts, creases), BASE, 1000)


@cache
def _unsigned() -> bytes:
    return encode(with_attributes(patch(5, 4), lambda m: wild(m, "uint32"), lambda m: wild(m, "int8", "face")), GRID)


def _declared(probes: str, index: int, error: str = "corrupt", make: Callable[[], bytes] = _all, **fields: Any) -> Bad:
    """With other fields in the declaration of an attribute."""
    return Bad(probes, error, lambda: with_declaration(make(), index, **fields))


def _frames(probes: str, change: Callable[[list[Any]], list[Any]], make: Callable[[], bytes] = _all) -> Bad:
    """With other frames."""
    return Bad(probes, "corrupt", lambda: stream_of(change(frames_of(make()))))


def _values(probes: str, change: Callable[[bytes], bytes], which: int, error: str = "corrupt") -> Bad:
    """With another payload in frame number `which` of VALUES."""

    def make() -> bytes:
        payload = [payload for kind, payload in frames_of(_all()) if kind == VALUES][which]
        return with_payload(_all(), VALUES, change(payload), which)

    return Bad(probes, error, make)


def _numbers(
    attribute: int | None = None, first: int | None = None, count: int | None = None
) -> Callable[[bytes], bytes]:
    def changed(payload: bytes) -> bytes:
        cursor = Cursor(payload)
        given = cursor.varint(), cursor.varint(), cursor.varint()
        wanted = (attribute, first, count)
        numbers = [old if new is None else new for old, new in zip(given, wanted, strict=True)]
        return b"".join(map(write_varint, numbers)) + cursor.rest()

    return changed


def _cut_seams(which: int, change: Callable[[bytes], bytes]) -> bytes:
    cursor = Cursor([payload for kind, payload in frames_of(_all()) if kind == ATTRIBUTE][which])
    head = write_varint(cursor.varint())
    entries = cursor.take(cursor.varint())
    changed = head + write_varint(len(entries)) + entries + change(cursor.rest())
    return with_payload(_all(), ATTRIBUTE, changed, which)


def _seams(change: Callable[[bytes], bytes], error: str, probes: str) -> Bad:
    return Bad(probes, error, lambda: _cut_seams(0, change))


def _without(kind: int, which: int) -> Callable[[list[Any]], list[Any]]:
    def changed(frames: list[Any]) -> list[Any]:
        place = [i for i, frame in enumerate(frames) if frame[0] == kind][which]
        return frames[:place] + frames[place + 1 :]

    return changed


def _swapped(kind: int, first: int, second: int) -> Callable[[list[Any]], list[Any]]:
    def changed(frames: list[Any]) -> list[Any]:
        places = [i for i, frame in enumerate(frames) if frame[0] == kind]
        result = list(frames)
        result[places[first]], result[places[second]] = frames[places[second]], frames[places[first]]
        return result

    return changed


def _moved(kind: int, place: int) -> Callable[[list[Any]], list[Any]]:
    """The first frame of a kind at another place."""

    def changed(frames: list[Any]) -> list[Any]:
        frame = next(frame for frame in frames if frame[0] == kind)
        rest = _without(kind, 0)(frames)
        return [*rest[:place], frame, *rest[place:]]

    return changed


BAD_ATTRIBUTES: dict[str, Bad] = {
    "unsupported-attribute": Bad(
        "ATTRIBUTE where `attributes` is 0", "unsupported", lambda: with_header(_all(), attributes=None)
    ),
    "bad-attributes-many": Bad(
        "more attributes than are declared", "corrupt", lambda: with_header(_all(), attributes=6)
    ),
    "bad-attributes-few": Bad(
        "fewer attributes than are declared", "corrupt", lambda: with_header(_all(), attributes=4)
    ),
    "bad-attributes-range": Bad("256 attributes", "corrupt", lambda: with_header(_all(), attributes=256)),
    "bad-attribute-missing": _frames("an attribute is missing", _without(ATTRIBUTE, 2)),
    "bad-attribute-order": _frames("attributes in the wrong order", _swapped(ATTRIBUTE, 0, 2)),
    "bad-attribute-early": _frames("ATTRIBUTE before CONNECTIVITY", _moved(ATTRIBUTE, 1)),
    "bad-attribute-late": _frames("ATTRIBUTE behind the positions", lambda frames: _moved(ATTRIBUTE, -2)(frames)),
    "bad-attribute-map": Bad(
        "a declaration that is longer than the frame",
        "corrupt",
        lambda: with_payload(_all(), ATTRIBUTE, b"\0\x7f\x81\x01\xa1x"),
    ),
    "bad-attribute-name": _declared("no name", 0, name=""),
    "bad-attribute-nameless": _declared("a name is missing", 0, name=None),
    "bad-attribute-name-type": _declared("a name that is no text", 0, name=b"uv"),
    "bad-attribute-name-long": _declared("a name of 256 bytes", 0, name="x" * 256),
    "bad-attribute-name-twice": _declared("two attributes of one name", 1, name="uv"),
    "unsupported-attribute-key": Bad(
        "a key that is not known", "unsupported", lambda: with_declaration(_all(), 0, key_40=1)
    ),
    "unsupported-attribute-coding": _declared("a coding that is not known", 0, "unsupported", coding=4),
    "unsupported-attribute-kind": _declared("a type that is not known", 0, "unsupported", kind=8),
    "unsupported-attribute-domain": _declared("a domain that is not known", 0, "unsupported", domain=3),
    "bad-attribute-default": _declared("a default that is stored", 0, kind=6),
    "bad-attribute-components": _declared("five components", 2, components=5),
    "bad-attribute-rows-none": _declared("no rows", 0, rows=None),
    "bad-attribute-rows-more": _declared("more rows than there are corners apart", 0, rows=200),
    "bad-attribute-rows-fewer": _declared("fewer rows than vertices", 2, rows=55),
    "bad-attribute-rows-first": Bad(
        "more rows than faces, before positions that end too early",
        "corrupt",
        lambda: with_payload(with_declaration(_all(), 3, rows=113), FrameType.GRID, b"\0\x38", 0),
    ),
    "unsupported-attribute-first": Bad(
        "an ATTRIBUTE of an unknown origin where HEADER belongs",
        "unsupported",
        lambda: stream_of(_moved(ATTRIBUTE, 0)(frames_of(with_declaration(_all(), 0, origin=64)))),
    ),
    "bad-attribute-rows-next": Bad(
        "more rows than groups of corners, before seams that end early",
        "corrupt",
        lambda: with_declaration(_cut_seams(1, lambda data: data[:2]), 0, rows=200),
    ),
    "bad-attribute-rows-faces": _declared("more rows than faces", 3, rows=113),
    "bad-attribute-rows-limit": _declared("more values than are granted", 0, "limit", rows=2**31 - 1),
    "bad-attribute-largest": _declared("a largest level too few", 0, largest=[100]),
    "bad-attribute-largest-wide": _declared("a level of 33 bits", 4, largest=[2**32]),
    "bad-attribute-step": _declared("three steps for two components", 0, step=[1.0, 1.0, 1.0]),
    "bad-attribute-step-zero": _declared("a step of 0", 0, step=[0.0]),
    "bad-attribute-offset": _declared("an offset too few", 0, offset=[1.0]),
    "bad-attribute-infinite": _declared("values beyond the type", 0, step=[1e38]),
    "bad-attribute-overflow": _declared("colors above 255", 2, offset=[100.0] * 4),
    "bad-attribute-below": _declared("colors below 0", 2, offset=[-1.0] * 4),
    "bad-attribute-fraction": _declared("whole numbers in steps that are none", 2, step=[0.5]),
    "bad-attribute-octahedron-odd": _declared("an odd octahedron", 1, largest=[127, 127]),
    "bad-attribute-octahedron-uneven": _declared("an octahedron of two sizes", 1, largest=[126, 128]),
    "bad-attribute-octahedron-large": _declared("an octahedron that is too large", 1, largest=[65536, 65536]),
    "bad-attribute-octahedron-step": _declared("an octahedron with steps", 1, step=[2.0]),
    "bad-attribute-octahedron-colors": _declared("an octahedron of whole numbers", 2, coding=1, largest=[126, 126]),
    "bad-attribute-bits-integers": _declared("bits of whole numbers", 2, coding=2),
    "bad-attribute-bits-wide": _declared("bits above 32", 4, offset=[2.0**32 - 1]),
    "bad-attribute-bits-step": _declared("bits with steps", 4, step=[2.0]),
    "bad-attribute-recomputed-rows": _declared("recomputed normals that are coded", 1, coding=3),
    "bad-attribute-recomputed-leans": Bad(
        "recomputed normals that lean",
        "corrupt",
        lambda: with_declaration(_all(), 1, coding=3, rows=None, largest=None, leans=1),
    ),
    "bad-attribute-recomputed-faces": _declared(
        "recomputed values of faces", 3, coding=3, rows=None, largest=None, kind=None, components=3, offset=None
    ),
    "bad-attribute-origin": _declared("faces that are given by something else", 3, origin=1),
    "bad-attribute-faces-lean": _declared("values of faces that lean", 3, leans=1),
    "bad-attribute-moves-mesh": _declared("an attribute of one mesh that moves", 0, moves=1),
    "bad-sequence-moves-corners": Bad(
        "values of corners that move", "corrupt", lambda: with_declaration(_sequence(), 0, domain=1, moves=1)
    ),
    "bad-attribute-leans-blocks": _declared("an attribute that leans on blocks", 0, make=_blocks, leans=1),
    "bad-attribute-seams-of-itself": _declared("seams of the attribute itself", 0, seams_of=1),
    "bad-attribute-seams-of-vertices": _declared("seams of an attribute without any", 3, seams_of=3, domain=1),
    "bad-attribute-seams-of-colors": _declared("seams where there are no corners", 2, seams_of=1),
    "bad-attribute-seams-both": _declared("seams of another attribute, and own ones", 1, seams_of=1),
    "bad-attribute-seams-short": _seams(lambda data: data[:2], "truncated", "seams that end early"),
    "bad-attribute-seams-long": _seams(lambda data: data + bytes(9), "corrupt", "bytes behind the last seam"),
    "bad-values-missing": _frames("the last chunk of an attribute is missing", _without(VALUES, 1)),
    "bad-values-none": _frames("values of the last attribute are missing", _without(VALUES, -1)),
    "bad-values-order": _frames("attributes in the wrong order", _swapped(VALUES, 0, -1)),
    "bad-values-early": _frames("VALUES before the positions", _moved(VALUES, 7)),
    "bad-values-attribute": _values("values of no attribute", _numbers(attribute=5), -1),
    "bad-values-gap": _values("values that do not follow", _numbers(first=71), 1),
    "bad-values-empty": _values("a chunk of no values", _numbers(count=0), 0),
    "bad-values-many": _values("more values than rows", _numbers(count=2000), 1),
    "bad-values-short": _values("values that end early", lambda payload: payload[:9], 0, "truncated"),
    "bad-values-long": _values("bytes behind the last value", lambda payload: payload + bytes(9), 0),
    "bad-values-outside": _declared("values above the largest", 2, largest=[3, 3, 3, 3]),
    "bad-values-faces-outside": _declared("numbers of faces above the largest", 3, largest=[1]),
    "bad-values-word": Bad(
        "a word above its largest, of two pieces",
        "corrupt",
        lambda: with_declaration(_unsigned(), 0, largest=[2**32 - 65537]),
    ),
    "bad-attribute-loose": Bad(
        "no rows for loose vertices", "corrupt", lambda: with_declaration(encode(_split(), ORDERED), 2, rows=56)
    ),
    "bad-sequence-attribute-leans": Bad(
        "an attribute of a sequence that leans", "corrupt", lambda: with_declaration(_sequence(), 0, leans=1)
    ),
    "bad-sequence-attribute-recomputed": Bad(
        "recomputed normals in a sequence",
        "corrupt",
        lambda: with_declaration(
            _sequence(), 1, coding=3, rows=None, largest=None, offset=None, kind=None, components=3
        ),
    ),
    "bad-sequence-values-late": Bad(
        "VALUES behind a GOP",
        "corrupt",
        lambda: stream_of(_moved(VALUES, len(frames_of(_sequence())) - 1)(frames_of(_sequence()))),
    ),
}
