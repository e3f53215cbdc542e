"""Payloads to numbers, by the kernels that the decoder reads them with: for tests and vectors."""

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from bsm._core import Decoder
from bsm._core import bitstream as _kernels
from bsm.bitstream.coefficients.adaptive import CoefficientModel
from bsm.bitstream.container.packets import Connectivity, Grid, Header, Packet, Writer
from bsm.bitstream.entropy.range_coder import Bank, Coder, bank_of, finish_writing, start_writing
from bsm.bitstream.errors import CorruptError, TruncatedError
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits
from bsm.codec.decoding import CONNECTIVITY, NEED
from tools.surgery import Cursor

Ints = npt.NDArray[np.int32]
Lead: TypeAlias = tuple[int, int]
"""Columns coded of the first row, and more of each next one; without a lead all, after a half those with any."""
POSITION = _kernels.constant("CODER_POSITION")
AHEAD = 4  # bytes that a reader holds besides those that a writer is done with


def start_reading(payload: bytes) -> Coder:
    """Make a coder that reads `payload`."""
    data = np.frombuffer(payload, np.uint8).copy()
    code, width = int.from_bytes(payload[:4].ljust(4, b"\0"), "big"), (1 << 32) - 1
    if code >= width:
        raise CorruptError("an entropy-coded payload cannot begin with ff ff ff ff")
    return Coder(np.array([code, width, AHEAD, 1, 0], np.int64), data)


def finish_reading(coder: Coder) -> None:
    """Check that a payload was read exactly to its end."""
    taken, size = int(coder.state[POSITION]), len(coder.data)
    if taken > size + AHEAD:
        raise TruncatedError(f"an entropy-coded payload of {size} bytes ends before its last symbol")
    if taken < size:
        raise CorruptError(f"{size - taken} bytes are left over after the last symbol of a payload")


def decode_connectivity(payload: bytes, vertices: int, faces: int, limits: Limits = DEFAULT_LIMITS) -> Ints:
    """Return the faces, shape (m, 3), that the decoder makes of a connectivity payload."""
    decoder, writer = Decoder(limits, 1), Writer()
    header = Header(vertices=vertices, faces=faces, grid=(1, 1, 1))
    # What follows tells the decoder that no order comes, which would change the faces.
    packets: list[Packet] = [header, Connectivity(payload), Grid(0, vertices, b"")]
    stream = b"".join([writer.start(), *map(writer.write, packets)])
    decoder.push(np.frombuffer(stream, np.uint8))
    decoder.next(1 << NEED | 1 << CONNECTIVITY)
    return decoder.faces(faces)


def decode_coefficients(model: CoefficientModel, payload: bytes, count: int) -> Ints:
    """Return the levels of a block, shape (count, 3)."""
    if count > model.width:
        raise CorruptError(f"{count} coefficients where at most {model.width} are announced")
    levels, coder = np.zeros((count, 3), np.int32), start_reading(payload)
    _kernels.code_block(coder, model.bank, model.past, model.expectations, levels)
    finish_reading(coder)
    return levels


def make_level_bank() -> Bank:
    """The adaptive state of a coder of levels, neutral; one for all payloads that learn from each other."""
    return bank_of("code_matrix")


def extent_of(matrix: Ints, lead: Lead | None) -> tuple[int, int, int, int]:
    """A lead, the row from which on few columns are coded, and how many; of known levels, or zeros to be read."""
    rows, columns = matrix.shape
    if lead is not None:
        return min(lead[0], columns), min(lead[1], columns), rows, columns
    turn = -(-rows // 2)
    used = np.flatnonzero(matrix[turn:].any(axis=0))
    return columns, 0, turn, int(used[-1]) + 1 if len(used) else 0


def encode_levels(
    bank: Bank, matrices: Sequence[Ints], references: Sequence[Ints], leads: Sequence[Lead | None] | None = None
) -> bytes:
    """Code matrices one after the other."""
    coder = start_writing(sum(16 * matrix.size + 64 for matrix in matrices))
    for matrix, reference, lead in zip(matrices, references, leads or [None] * len(matrices), strict=True):
        occupied = np.flatnonzero(matrix.any(axis=1))
        rows, slow = int(occupied[-1]) + 1 if len(occupied) else 0, np.empty(matrix.shape[1], np.int64)
        _kernels.code_matrix(coder, bank, matrix, reference, rows, *extent_of(matrix, lead), slow)
    return finish_writing(coder)


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
