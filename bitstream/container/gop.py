"""The data of a GOP, between the frame that carries it and the entropy coder."""

import math
import struct
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from enum import IntEnum
from types import MappingProxyType

import numpy as np
import numpy.typing as npt

from bsm.bitstream.container.wire import Cursor, write_varint
from bsm.bitstream.errors import CorruptError, OptionError

WAYS = (1, 0, -1)  # from frame to frame of a stretch: as they were sent, standing still, backwards


def write_stretches(shown: npt.NDArray[np.int64] | None) -> bytes:
    """The frame that is shown at each time, shape (T,); None: each once, in order."""
    if shown is None:
        return write_varint(0)
    parts = []
    at, due = 0, 0
    while at < len(shown):
        changes = np.diff(shown[at:])
        way = int(changes[0]) if len(changes) and changes[0] in WAYS else WAYS[0]
        others = np.flatnonzero(changes != way)
        count = int(others[0]) + 1 if len(others) else len(shown) - at
        beyond = int(shown[at]) - due
        parts += [3 * (2 * beyond if beyond >= 0 else -2 * beyond - 1) + WAYS.index(way), count]
        at += count
        due = int(shown[at - 1]) + 1
    return b"".join(map(write_varint, [len(parts) // 2, *parts]))


def parse_stretches(cursor: Cursor, frames: int) -> npt.NDArray[np.int64] | None:
    """Inverse of `write_stretches` for so many frames: an array of shape (T,), or None."""
    count = cursor.varint()
    if not count:
        return None
    shown = np.empty(frames, np.int64)
    at, due = 0, 0
    for _ in range(count):
        beyond, way = divmod(cursor.varint(), 3)
        length = cursor.varint()
        first = due + (beyond // 2 if beyond % 2 == 0 else -(beyond + 1) // 2)
        last = first + WAYS[way] * (length - 1)
        if not (0 < length <= frames - at and 0 <= min(first, last) <= max(first, last) < frames):
            raise CorruptError(f"a stretch of {length} frames from frame {first} on, of a GOP of {frames}")
        shown[at : at + length] = first + WAYS[way] * np.arange(length)
        at, due = at + length, last + 1
    if at < frames:
        raise CorruptError(f"stretches of {at} frames in a GOP of {frames}")
    return shown


MAX_EXPONENT = 400
METHODS, RUNS = 8, 32  # the first byte is the method, and so many times the number of the run, counted modulo `RUNS`
WITH_ATTRIBUTES = 4  # added to the method where there are attributes


class GopMethod(IntEnum):
    """How the frames of a GOP were predicted."""

    LEARNT = 0  # temporal basis learnt from the frames, and sent
    KEY_FRAME = 1  # cosines over time, predicted from the sequence's first frame
    NEXT_FRAME = 2  # cosines over time, predicted from frames before as well
    LEARNT_NEXT = 3  # as `LEARNT`, predicted from the components of the GOP before as well

    @property
    def has_basis(self) -> bool:
        return self in (GopMethod.LEARNT, GopMethod.LEARNT_NEXT)

    @property
    def begins(self) -> bool:
        """Whether the GOP needs none before it."""
        return self in (GopMethod.LEARNT, GopMethod.KEY_FRAME)


@dataclass(frozen=True, eq=False)
class GopField:
    """What a GOP tells of one field: of positions, or of an attribute that moves."""

    width: int
    step: float
    components: int
    exponents: npt.NDArray[np.int32]
    basis: bytes
    levels: bytes
    back: int = 0

    @property
    def size(self) -> int:
        return len(self.basis) + len(self.levels)


@dataclass(frozen=True, eq=False)
class GopBody:
    method: GopMethod
    frames: int
    fields: tuple[GopField, ...]
    shown: npt.NDArray[np.int64] | None = None

    @property
    def coded(self) -> int:
        """How many frames are coded; others show these again."""
        return self.frames if self.shown is None else int(self.shown.max()) + 1

    @property
    def places(self) -> npt.NDArray[np.int64]:
        """Which coded frame each frame shows, shape (T,): `shown`, or all in their order."""
        return np.arange(self.frames) if self.shown is None else self.shown


def still(width: int) -> GopField:
    """A field of so many columns that is not coded."""
    return GopField(width, 0.0, 0, np.empty(0, np.int32), b"", b"")


def write_gop_body(body: GopBody, run: int = 0, numbers: Sequence[int] = ()) -> bytes:
    """Method and run (a byte), T, with a learnt basis the stretches, attributes, positions."""
    positions, *attributes = (_write_field(field, body.method) for field in body.fields)
    if not positions:
        raise OptionError("a GOP needs positions")
    moved = [(number, data) for number, data in zip(numbers, attributes, strict=True) if data]
    first = body.method + (WITH_ATTRIBUTES if moved else 0) + METHODS * (run % RUNS)
    parts = [bytes([first]), write_varint(body.frames)]
    if body.method.has_basis:
        parts.append(write_stretches(body.shown))
    if moved:
        parts.append(write_varint(len(moved)))
        for number, data in moved:
            parts += [write_varint(number), write_varint(len(data)), data]
    return b"".join([*parts, positions])


def _write_field(field: GopField, method: GopMethod) -> bytes:
    if field.step == 0.0:
        return b""
    if not (0 < field.step < math.inf and float(np.float32(field.step)) == field.step):
        raise OptionError(f"a GOP cannot have the step {field.step}")
    parts = [struct.pack("<f", field.step)]
    if method.has_basis:
        parts.append(write_varint(field.components))
        differences = np.diff(field.exponents, prepend=0).tolist()
        parts += [write_varint(2 * d if d >= 0 else -2 * d - 1) for d in differences]
        parts += [write_varint(len(field.basis)), field.basis]
    elif method is GopMethod.NEXT_FRAME:
        parts.append(write_varint(field.back))
    return b"".join([*parts, field.levels])


def parse_gop_body(
    data: bytes, longest: int, run: int = 0, widths: Mapping[int, int] = MappingProxyType({}), *, tolerant: bool = False
) -> GopBody:
    cursor = Cursor(data)
    method, frames, with_attributes = _parse_beginning(cursor, longest, run)
    shown = parse_stretches(cursor, frames) if method.has_basis else None
    body = GopBody(method, frames, (), shown)
    count = cursor.varint() if with_attributes else 0
    if with_attributes and not count:
        raise CorruptError("a GOP with attributes that has none")
    fields = {number: still(width) for number, width in widths.items()}
    before = -1
    for _ in range(count):
        number, part = cursor.varint(), cursor.take(cursor.varint())
        if number <= before or not (tolerant or number in widths):
            raise CorruptError(f"a GOP has attribute {number}, which does not move, or is not the next one")
        before = number
        if number in widths:
            fields[number] = _parse_field(part, body, widths[number])
    return replace(body, fields=(_parse_field(cursor.rest(), body, 3), *fields.values()))


def method_of(first: int) -> GopMethod:
    return GopMethod(first % WITH_ATTRIBUTES)


def frames_of_gop(data: bytes, longest: int, run: int = 0) -> int:
    """How many frames a GOP has; errors as of `parse_gop_body`."""
    return _parse_beginning(Cursor(data), longest, run)[1]


def _parse_beginning(cursor: Cursor, longest: int, run: int) -> tuple[GopMethod, int, bool]:
    """Method, frames, and whether there are attributes."""
    of_run, kind = divmod(cursor.take(1)[0], METHODS)
    if of_run != run % RUNS:
        raise CorruptError(f"a GOP of another run than run {run}")
    method, frames = method_of(kind), cursor.varint()
    if not 1 <= frames <= longest:
        raise CorruptError(f"a GOP of {frames} frames where 1 to {longest} are legal")
    return method, frames, kind >= WITH_ATTRIBUTES


def _parse_field(data: bytes, body: GopBody, width: int) -> GopField:
    cursor = Cursor(data)
    step = float(struct.unpack("<f", cursor.take(4))[0])
    if not 0.0 < step < math.inf:
        raise CorruptError(f"a GOP with the step {step}")
    if not body.method.has_basis:
        back = cursor.varint() if body.method is GopMethod.NEXT_FRAME else 0
        if 0 < back < body.frames:
            raise CorruptError(f"{body.frames} frames that start from those {back} before them")
        return GopField(width, step, width * body.frames, np.empty(0, np.int32), b"", cursor.rest(), back)
    components = cursor.varint()
    if components > width * body.coded:
        raise CorruptError(f"{components} components for {body.coded} frames")
    codes = np.array([cursor.varint() for _ in range(components)], np.int64)
    exponents = np.cumsum(np.where(codes % 2 == 0, codes // 2, -(codes + 1) // 2))
    if len(exponents) and not 0 <= exponents.min() <= exponents.max() <= MAX_EXPONENT:
        raise CorruptError(f"a basis with step exponents outside 0..{MAX_EXPONENT}")
    exponents = exponents.astype(np.int32)
    basis = cursor.take(cursor.varint())
    return GopField(width, step, components, exponents, basis, cursor.rest())
