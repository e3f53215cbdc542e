"""Coefficients, method 0: every value in the same number of bits, then zstd."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from bsm.bitstream.entropy.zstd import compress, decompress
from bsm.bitstream.errors import CorruptError, OptionError

MAX_BITS = 32


def pack_coefficients(values: npt.NDArray[Any], bits: int) -> bytes:
    """Bytes of unsigned integers below ``2**bits``, most significant bit first, and compressed."""
    flat = np.asarray(values).ravel()
    _check_bits(bits)
    if flat.dtype.kind not in "iu":
        raise OptionError(f"packed coefficients must be integers, not {flat.dtype}")
    if flat.size and not (flat.min() >= 0 and int(flat.max()) < 1 << bits):
        raise OptionError(f"coefficients {flat.min()}..{flat.max()} do not fit {bits} bits")
    digits = np.unpackbits(flat.astype(">u4").view(np.uint8).reshape(-1, 4), axis=1)
    return compress(np.packbits(digits[:, MAX_BITS - bits :]).tobytes())


def unpack_coefficients(data: bytes, count: int, bits: int) -> npt.NDArray[np.uint32]:
    """Inverse of `pack_coefficients`."""
    _check_bits(bits)
    packed = np.frombuffer(decompress(data, (count * bits + 7) // 8), dtype=np.uint8)
    digits = np.unpackbits(packed)
    if digits[count * bits :].any():
        raise CorruptError("the bits behind the last packed coefficient are not 0")
    padded = np.zeros((count, MAX_BITS), dtype=np.uint8)
    padded[:, MAX_BITS - bits :] = digits[: count * bits].reshape(count, bits)
    return np.packbits(padded, axis=1).view(">u4").astype(np.uint32).ravel()


def _check_bits(bits: int) -> None:
    if not 1 <= bits <= MAX_BITS:
        raise OptionError(f"{bits} bits for a coefficient; 1 to {MAX_BITS} are possible")
