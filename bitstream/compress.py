"""zstd that yields exactly as many bytes as the caller expects, or an error.

The magic number of the zstd frame is left out, its content size is not; bytes that zstd does not shorten are kept as
they are, which their length alone tells.
"""

from __future__ import annotations

import zstandard

from bitstream.errors import CorruptError

_MAGIC = zstandard.FRAME_HEADER
_LEVEL = 19
_MAX_WINDOW = 1 << 23


def compress(data: bytes) -> bytes:
    """`data` as a zstd frame without its magic number, or as it is where that is not shorter."""
    compressor = zstandard.ZstdCompressor(level=_LEVEL, write_checksum=False, write_content_size=True)
    frame = compressor.compress(data)[len(_MAGIC) :]
    return frame if len(frame) < len(data) else data


def decompress(data: bytes, exact_size: int) -> bytes:
    """Inverse of `compress`; never allocates for more than `exact_size` bytes.

    Raises
    ------
    CorruptError
        If `data` does not hold exactly `exact_size` bytes.
    """
    if len(data) == exact_size:
        return data
    if len(data) > exact_size:
        raise CorruptError(f"{len(data)} compressed bytes for {exact_size} bytes of content")
    frame = _MAGIC + data
    try:
        claimed = zstandard.get_frame_parameters(frame).content_size
        if claimed != exact_size:
            raise CorruptError(f"zstd frame claims {claimed} bytes where {exact_size} belong")
        decompressor = zstandard.ZstdDecompressor(max_window_size=_MAX_WINDOW)
        content = decompressor.decompress(frame, max_output_size=exact_size, allow_extra_data=False)
    except zstandard.ZstdError as error:
        raise CorruptError(f"zstd frame is damaged: {error}") from error
    if len(content) != exact_size:
        raise CorruptError(f"zstd frame holds {len(content)} bytes where {exact_size} belong")
    return content
