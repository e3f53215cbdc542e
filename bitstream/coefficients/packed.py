"""Coefficients, method 0: every value in the same number of bits, then zstd."""

from typing import Any

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import OptionError, imported

_MAGIC = b"\x28\xb5\x2f\xfd"
_LEVEL = 19


def compress(data: bytes) -> bytes:
    """`data` as a zstd frame without its magic number, or as it is where that is not shorter."""
    compressor = _zstandard().ZstdCompressor(level=_LEVEL, write_checksum=False, write_content_size=True)
    frame: bytes = compressor.compress(data)[len(_MAGIC) :]
    return frame if len(frame) < len(data) else data


def _zstandard() -> Any:
    """The library, loaded when a stream needs it: only coefficients of a fixed number of bits do, the paper's mode."""
    why = "coefficients of a fixed number of bits are packed by zstd, which is not installed"
    return imported("zstandard", why, "paper")


MAX_BITS = 32


def pack_coefficients(values: npt.NDArray[Any], bits: int) -> bytes:
    """Bytes of unsigned integers below ``2**bits``, most significant bit first, and compressed."""
    flat = np.asarray(values).ravel()
    if not 1 <= bits <= MAX_BITS:
        raise OptionError(f"{bits} bits for a coefficient; 1 to {MAX_BITS} are possible")
    if flat.dtype.kind not in "iu":
        raise OptionError(f"packed coefficients must be integers, not {flat.dtype}")
    if flat.size and not (flat.min() >= 0 and int(flat.max()) < 1 << bits):
        raise OptionError(f"coefficients {flat.min()}..{flat.max()} do not fit {bits} bits")
    digits = np.unpackbits(flat.astype(">u4").view(np.uint8).reshape(-1, 4), axis=1)
    return compress(np.packbits(digits[:, MAX_BITS - bits :]).tobytes())
