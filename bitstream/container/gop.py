"""The data of a GOP, between the frame that carries it and the entropy coder."""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass
from enum import IntEnum

import numpy as np
import numpy.typing as npt

from bsm.bitstream.container.wire import Cursor, write_varint
from bsm.bitstream.errors import CorruptError, OptionError, UnsupportedError

MAX_EXPONENT = 400
METHODS, RUNS = 8, 32
"""The first byte is the method, and so many times the number of the run, counted modulo `RUNS`."""


class GopMethod(IntEnum):
    """How the frames of a GOP were predicted."""

    LEARNT = 0
    """Temporal basis learnt from the frames, and sent."""
    KEY_FRAME = 1
    """One frame, predicted from the sequence's first frame."""
    NEXT_FRAME = 2
    """One frame, predicted from the two before it as well."""


@dataclass(frozen=True, eq=False)
class GopBody:
    """The data of a GOP.

    Parameters
    ----------
    method : GopMethod
    frames : int
        Number of frames T, at least 1.
    step : float
        Quantization step in BSM units; a single-precision number above 0.
    components : int
        Columns r of the temporal basis (3 for a single frame).
    exponents : int32 array, shape (r,)
        Steps of a learnt basis, from 0 to `MAX_EXPONENT`; empty otherwise.
    basis : bytes
        Coded levels of a learnt basis; empty otherwise.
    levels : bytes
        Coded levels of all blocks.
    """

    method: GopMethod
    frames: int
    step: float
    components: int
    exponents: npt.NDArray[np.int32]
    basis: bytes
    levels: bytes


def write_gop_body(body: GopBody, run: int = 0) -> bytes:
    """Method and run (a byte), T, step (float 32), of a learnt basis r, the exponents and its coded length; all levels.

    Counts are varints; an exponent is the zigzag of its difference to the one before.
    """
    if not (0 < body.step < math.inf and float(np.float32(body.step)) == body.step):
        raise OptionError(f"a GOP cannot have the step {body.step}")
    parts = [bytes([body.method + METHODS * (run % RUNS)]), write_varint(body.frames), struct.pack("<f", body.step)]
    if body.method is GopMethod.LEARNT:
        parts.append(write_varint(body.components))
        differences = np.diff(body.exponents, prepend=0).tolist()
        parts += [write_varint(2 * d if d >= 0 else -2 * d - 1) for d in differences]
        parts += [write_varint(len(body.basis)), body.basis]
    return b"".join([*parts, body.levels])


def parse_gop_body(data: bytes, longest: int, run: int = 0) -> GopBody:
    """Inverse of `write_gop_body`; `longest` is what the header says about the frames of a GOP.

    Raises
    ------
    UnsupportedError
        For an unknown method.
    CorruptError
        For everything else that no encoder writes.
    """
    cursor = Cursor(data)
    of_run, number = divmod(cursor.take(1)[0], METHODS)
    if of_run != run % RUNS:
        raise CorruptError(f"a GOP of another run than run {run}")
    if number not in set(GopMethod):
        raise UnsupportedError(f"GOP method {number} is unknown to this decoder")
    method, frames = GopMethod(number), cursor.varint()
    most = longest if method is GopMethod.LEARNT else 1
    if not 1 <= frames <= most:
        raise CorruptError(f"a GOP of {frames} frames where 1 to {most} are legal")
    step = float(struct.unpack("<f", cursor.take(4))[0])
    if not 0.0 < step < math.inf:
        raise CorruptError(f"a GOP with the step {step}")
    components = cursor.varint() if method is GopMethod.LEARNT else 3
    if components > 3 * frames:
        raise CorruptError(f"{components} components for {frames} frames")
    exponents, basis = np.empty(0, np.int32), b""
    if method is GopMethod.LEARNT:
        exponents = _parse_exponents(cursor, components)
        basis = cursor.take(cursor.varint())
    return GopBody(method, frames, step, components, exponents, basis, cursor.rest())


def _parse_exponents(cursor: Cursor, count: int) -> npt.NDArray[np.int32]:
    codes = np.array([cursor.varint() for _ in range(count)], np.int64)
    exponents = np.cumsum(np.where(codes % 2 == 0, codes // 2, -(codes + 1) // 2))
    if len(exponents) and not 0 <= exponents.min() <= exponents.max() <= MAX_EXPONENT:
        raise CorruptError(f"a basis with step exponents outside 0..{MAX_EXPONENT}")
    return exponents.astype(np.int32)
