"""The data of a GOP, between the frame that carries it and the entropy coder."""

import math
import struct
from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum

import numpy as np
import numpy.typing as npt

from bsm._core.bitstream import constant
from bsm.bitstream.container.wire import write_varint
from bsm.bitstream.errors import OptionError

# Motion that is captured or keyed often stands still, or swings back. Such frames cost nothing when they are shown
# again.
WAYS = (1, 0, -1)  # from frame to frame of a stretch: as they were sent, standing still, backwards


def write_stretches(shown: npt.NDArray[np.int64] | None) -> bytes:
    """The frame that is shown at each time, shape (T,); None: each once, in order."""
    if shown is None:
        return write_varint(0)
    parts = []
    at, due = 0, 0
    while at < len(shown):
        changes = np.diff(shown[at:])
        # A jump has no inner frames. The stretch then has one frame, and the next begins after the jump.
        way = int(changes[0]) if len(changes) and changes[0] in WAYS else WAYS[0]
        others = np.flatnonzero(changes != way)
        count = int(others[0]) + 1 if len(others) else len(shown) - at
        beyond = int(shown[at]) - due
        # Signed to unsigned by turns (0, -1, 1, -2, ...), so that small numbers of both signs take one byte.
        parts += [3 * (2 * beyond if beyond >= 0 else -2 * beyond - 1) + WAYS.index(way), count]
        at += count
        due = int(shown[at - 1]) + 1
    return b"".join(map(write_varint, [len(parts) // 2, *parts]))


MAX_EXPONENT = 400
METHODS, RUNS, WITH_ATTRIBUTES = map(constant, ("METHODS", "RUNS", "WITH_ATTRIBUTES"))
"""The first byte: the method, WITH_ATTRIBUTES where there are any, METHODS times the number of the run modulo RUNS."""


class GopMethod(IntEnum):
    """How the frames of a GOP were predicted."""

    LEARNT = 0  # temporal basis learnt from the frames, and sent
    KEY_FRAME = 1  # cosines over time, predicted from the sequence's first frame
    NEXT_FRAME = 2  # cosines over time, predicted from frames before as well
    LEARNT_NEXT = 3  # as `LEARNT`, predicted from the components of the GOP before as well

    @property
    def has_basis(self) -> bool:
        return self in (GopMethod.LEARNT, GopMethod.LEARNT_NEXT)


@dataclass(frozen=True, eq=False)
class GopField:
    """The data of a GOP for one field: positions, or an attribute that moves."""

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
    def size(self) -> int:
        """Bytes of all fields."""
        return sum(field.size for field in self.fields)

    @property
    def coded(self) -> int:
        """How many frames are coded; others show these again."""
        return self.frames if self.shown is None else int(self.shown.max()) + 1

    @property
    def places(self) -> npt.NDArray[np.int64]:
        """Which coded frame each frame shows, shape (T,): `shown`, or all in their order."""
        return np.arange(self.frames) if self.shown is None else self.shown


def still(width: int) -> GopField:
    """Return a field with this many columns that is not coded."""
    return GopField(width, 0.0, 0, np.empty(0, np.int32), b"", b"")


def write_gop_body(body: GopBody, run: int = 0, numbers: Sequence[int] = ()) -> bytes:
    """Method and run (a byte), T, with a learnt basis the stretches, attributes, positions."""
    positions, *attributes = (_write_field(field, body.method) for field in body.fields)
    if not positions:
        raise OptionError("a GOP needs positions")
    moved = [(number, data) for number, data in zip(numbers, attributes, strict=True) if data]
    # The number of the run, in one byte with the method: a decoder that lost a header sees that this GOP is of another
    # mesh.
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
    # The step travels in single precision. Encoder and decoder must multiply by the same number.
    if not (0 < field.step < math.inf and float(np.float32(field.step)) == field.step):
        raise OptionError(f"a GOP cannot have the step {field.step}")
    parts = [struct.pack("<f", field.step)]
    if method.has_basis:
        parts.append(write_varint(field.components))
        # Exponents of neighboring components are alike, so their differences take a byte each.
        differences = np.diff(field.exponents, prepend=0).tolist()
        parts += [write_varint(2 * d if d >= 0 else -2 * d - 1) for d in differences]
        parts += [write_varint(len(field.basis)), field.basis]
    elif method is GopMethod.NEXT_FRAME:
        parts.append(write_varint(field.back))
    return b"".join([*parts, field.levels])
