"""zstd that yields exactly as many bytes as the caller expects, or an error.

The magic number of the zstd frame is left out, its content size is not; bytes that zstd does not shorten are kept as
they are, which their length alone tells.
"""

from __future__ import annotations

from typing import Any

from bsm.bitstream.errors import CorruptError, DependencyError
from bsm.bitstream.extras import how_to_install

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
    try:
        import zstandard
    except ImportError:
        raise DependencyError(
            "coefficients of a fixed number of bits are packed by zstd, which is not installed: "
            f"{how_to_install('paper')}"
        ) from None
    return zstandard
