"""Grey pictures as PNG files."""

from __future__ import annotations

import struct
import zlib

import numpy as np
import numpy.typing as npt

Picture = npt.NDArray[np.float32]
_LOUDER = 4.0
"""How much larger a difference is drawn than it is."""
_BITS, _GREY = 8, 0


def side_by_side(first: Picture, second: Picture) -> Picture:
    """Two pictures and, from white to black, four times their difference."""
    return np.hstack([first, second, 1.0 - np.minimum(_LOUDER * np.abs(first - second), 1.0)])


def png(picture: Picture) -> bytes:
    """A file of a picture of shades from 0 to 1, shape (height, width)."""
    height, width = picture.shape
    shades = np.zeros((height, 1 + width), np.uint8)  # before each row: it is predicted from nothing
    shades[:, 1:] = np.rint(255 * picture.clip(0.0, 1.0))
    head = struct.pack(">IIBBBBB", width, height, _BITS, _GREY, 0, 0, 0)
    chunks = ((b"IHDR", head), (b"IDAT", zlib.compress(shades.tobytes(), 9)), (b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(_chunk(name, data) for name, data in chunks)


def _chunk(name: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
