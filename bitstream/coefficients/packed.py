"""Coefficients, method 0: every value in the same number of bits, then zstd."""

from typing import Any

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import CorruptError, imported

_MAGIC = b"\x28\xb5\x2f\xfd"
# The highest level that needs no extra memory in decoders.
_LEVEL = 19


def compress(data: bytes) -> bytes:
    """`data` as a zstd frame without its magic number, or as it is where that is not shorter."""
    compressor = _zstandard().ZstdCompressor(
        level=_LEVEL, write_checksum=False, write_content_size=True
    )
    # Four bytes that are always the same, in each of hundreds of blocks.
    frame: bytes = compressor.compress(data)[len(_MAGIC) :]
    return frame if len(frame) < len(data) else data


def _zstandard() -> Any:
    """The library, loaded when a stream needs it: only coefficients of a fixed number of bits do, the paper's mode."""
    why = "coefficients of a fixed number of bits are packed by zstd, which is not installed"
    return imported("zstandard", why, "paper")


def pack_coefficients(values: npt.NDArray[Any], bits: int) -> bytes:
    """Bytes of unsigned integers below ``2**bits``, most significant bit first, and compressed."""
    # Big-endian, so that the bits of a value follow each other in the order of the law.
    digits = np.unpackbits(values.astype(">u4").view(np.uint8).reshape(-1, 4), axis=1)
    return compress(np.packbits(digits[:, 32 - bits :]).tobytes())


def unpack_coefficients(data: bytes, bits: int, count: int) -> npt.NDArray[np.int64]:
    """Twin of `pack_coefficients`, of `count` integers."""
    size, library = -(-count * bits // 8), _zstandard()
    try:
        # The size in the frame is checked first: a few bytes of zstd can expand to gigabytes.
        if len(data) != size and library.frame_content_size(_MAGIC + data) == size:
            data = library.ZstdDecompressor().decompress(_MAGIC + data, allow_extra_data=False)
    except library.ZstdError:
        data = b""
    if len(data) != size:
        raise CorruptError(f"packed coefficients do not come to {size} bytes")
    digits = np.unpackbits(np.frombuffer(data, np.uint8), count=count * bits).reshape(count, bits)
    return np.asarray(digits @ (1 << np.arange(bits - 1, -1, -1, dtype=np.int64)))
