"""Connectivity, method 0: differences of indices, byte planes, zstd. Large, but it keeps every order as it is."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from bitstream.compress import compress, decompress
from bitstream.errors import CorruptError

Faces = npt.NDArray[np.int32]


def encode_plain_faces(faces: Faces) -> bytes:
    """Bytes of faces, shape (m, 3)."""
    differences = np.diff(faces.ravel(), prepend=np.int32(0)).astype("<i4")
    zigzag = ((differences << 1) ^ (differences >> 31)).astype("<u4")
    return compress(np.ascontiguousarray(zigzag.view(np.uint8).reshape(-1, 4).T).tobytes())


def decode_plain_faces(data: bytes, vertices: int, faces: int) -> Faces:
    """Twin of `encode_plain_faces`.

    Raises
    ------
    CorruptError
        If `data` does not hold `faces` triangles with indices below `vertices`.
    """
    planes = np.frombuffer(decompress(data, 12 * faces), np.uint8).reshape(4, -1)
    zigzag = np.ascontiguousarray(planes.T).view("<u4").ravel().astype(np.int64)
    indices = np.cumsum((zigzag >> 1) ^ -(zigzag & 1))
    if indices.min() < 0 or indices.max() >= vertices:
        raise CorruptError(f"the connectivity names a vertex outside 0..{vertices - 1}")
    return indices.astype(np.int32).reshape(-1, 3)
