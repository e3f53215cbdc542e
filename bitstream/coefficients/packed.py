"""Coefficients, method 0: every value in the same number of bits, then zstd."""

from typing import Any

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import CorruptError, OptionError, imported

_MAGIC = b"\x28\xb5\x2f\xfd"
_LEVEL = 19
MAX_WINDOW = 1 << 23


def compress(data: bytes) -> bytes:
    """`data` as a zstd frame without its magic number, or as it is where that is not shorter."""
    compressor = _zstandard().ZstdCompressor(level=_LEVEL, write_checksum=False, write_content_size=True)
    frame: bytes = compressor.compress(data)[len(_MAGIC) :]
    return frame if len(frame) < len(data) else data


def decompress(data: bytes, exact_size: int) -> bytes:
    """Inverse of `compress`; never allocates for more than `exact_size` bytes."""
    if len(data) == exact_size:
        return data
    if len(data) > exact_size:
        raise CorruptError(f"{len(data)} compressed bytes for {exact_size} bytes of content")
    frame = _MAGIC + data
    zstandard = _zstandard()
    try:
        parameters = zstandard.get_frame_parameters(frame)
        if parameters.content_size != exact_size:
            raise CorruptError(f"zstd frame claims {parameters.content_size} bytes where {exact_size} belong")
        if parameters.window_size > MAX_WINDOW:
            raise CorruptError(f"zstd frame has a window of {parameters.window_size} bytes, legal are {MAX_WINDOW}")
        if parameters.has_checksum:
            raise CorruptError("zstd frame has a checksum of its content")
        decompressor = zstandard.ZstdDecompressor()
        content: bytes = decompressor.decompress(frame, max_output_size=exact_size, allow_extra_data=False)
    except zstandard.ZstdError as error:
        raise CorruptError(f"zstd frame is damaged: {error}") from error
    if len(content) != exact_size:
        raise CorruptError(f"zstd frame holds {len(content)} bytes where {exact_size} belong")
    return content


def _zstandard() -> Any:
    """The library, loaded when a stream needs it: only coefficients of a fixed number of bits do, the paper's mode."""
    why = "coefficients of a fixed number of bits are packed by zstd, which is not installed"
    return imported("zstandard", why, "paper")


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
