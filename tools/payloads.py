"""Payloads to numbers, by the decoder, and payloads that no encoder writes: for tests and vectors."""

from collections.abc import Iterable
from importlib import import_module
from typing import Any

import numpy as np
import numpy.typing as npt

from bsm._core import Decoder
from bsm.bitstream.connectivity.faces import AS_CORNERS
from bsm.bitstream.container.packets import Connectivity, Grid, Header, Packet, SectionWriter
from bsm.bitstream.errors import CorruptError
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits
from bsm.codec.decoding import CONNECTIVITY, NEED
from tools.surgery import Cursor

Ints = npt.NDArray[np.int32]
law: Any = import_module("spec.reference_integers")


class Speller(law.RangeDecoder):  # type: ignore[misc]
    """Is read from like a payload, gives the outcomes that it is told and then zeros, and writes them down (C 1)."""

    def __init__(self, outcomes: Iterable[int] = ()) -> None:
        self._outcomes = iter(outcomes)
        self.low, self.range, self.taken = 0, 2**32 - 1, 0

    def bit(self, probability: int) -> int:
        """Code a decision."""
        bound, bit = self.range * probability // 65536, next(self._outcomes, 0)
        self.low += 0 if bit else bound
        self.range = bound if bit else self.range - bound
        self.renormalize()
        return bit

    def renormalize(self) -> None:
        """Make the range large again."""
        while self.range < 1 << 24:
            self.range, self.low, self.taken = 256 * self.range, 256 * self.low, self.taken + 1

    def short_uniform(self, count: int) -> int:
        """Code a number below a count."""
        unit, value = self.range // count, next(self._outcomes, 0)
        self.low += value * unit
        self.range = unit if value < count - 1 else self.range - value * unit
        self.renormalize()
        return value

    def payload_of_all(self) -> bytes:
        """The fewest bytes that tell all outcomes."""
        size, unit = self.taken, 1 << 32
        while (value := -(-self.low // unit) * unit) >= self.low + self.range:
            size, unit = size + 1, unit >> 8
        return (value >> 8 * (self.taken + 4 - size)).to_bytes(size, "big")


def still_levels(matrices: int) -> bytes:
    """Levels of a GOP that are all zero: of each matrix only that no row has any (S 4.2)."""
    speller, model = Speller(), law.Model(inputs=6, limit=400, rate=10)
    for _ in range(matrices):
        model.bit(speller, (0,) * 6, 0)
    return speller.payload_of_all()


def decode_connectivity(
    payload: bytes,
    vertices: int,
    faces: int,
    limits: Limits = DEFAULT_LIMITS,
    repeats: int = AS_CORNERS,
) -> Ints:
    """Return the faces, shape (m, 3), that the decoder makes of a connectivity payload; `repeats` as in the header."""
    decoder, writer = Decoder(limits, 1), SectionWriter()
    header = Header(vertices=vertices, faces=faces, grid=(1, 1, 1), repeats=repeats)
    # What follows tells the decoder that no order comes, which would change the faces.
    packets: list[Packet] = [header, Connectivity(payload), Grid(0, vertices, b"")]
    stream = b"".join([writer.start(), *map(writer.write, packets)])
    decoder.push(np.frombuffer(stream, np.uint8))
    decoder.next(1 << NEED | 1 << CONNECTIVITY)
    return decoder.faces(faces)


def parse_stretches(cursor: Cursor, frames: int) -> list[int]:
    """Return the coded frame that each of a GOP's frames shows."""
    shown: list[int] = []
    due = 0
    count = cursor.varint()
    for _ in range(count):
        beyond, way = divmod(cursor.varint(), 3)
        due += beyond // 2 if beyond % 2 == 0 else -(beyond + 1) // 2
        length = cursor.varint()
        if length > frames - len(shown):
            raise CorruptError(f"stretches of more than {frames} frames")
        for _ in range(length):
            shown.append(due)
            due += (1, 0, -1)[way]
        due = shown[-1] + 1
    return shown if count else list(range(frames))
