"""Meshes and values that the tests of fields share."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from hypothesis import strategies as st

from bsm.bitstream.fields.corners import FieldDecoder, FieldEncoder
from tests.shapes import Faces, grid_faces

Ints = npt.NDArray[np.int32]
Chunks = list[tuple[bytes, int]]


def random_faces(vertices: int, count: int, kind: str, seed: int) -> Faces:
    """Faces at random, around one vertex, along a strip, or of a torus with flipped and repeated faces."""
    rng = np.random.default_rng(seed)
    if vertices == 0:
        return np.empty((0, 3), np.int32)
    faces = rng.integers(0, vertices, (count, 3))
    if kind == "wheel":
        faces[:, 0] = 0
    if kind == "strip":
        faces = (np.arange(count)[:, None] + np.arange(3)) % vertices
    if kind == "torus":
        faces = grid_faces(7, 6, close_rows=True, close_columns=True)
        faces = faces[rng.random(len(faces)) < 0.9]
        turned = rng.random(len(faces)) < 0.1
        faces[turned] = faces[turned][:, ::-1]
        faces = np.concatenate([faces, faces[:3]]) % vertices
    return faces.astype(np.int32)


SOUPS = st.integers(0, 60).flatmap(
    lambda n: st.tuples(
        st.builds(
            random_faces,
            st.just(n),
            st.integers(0, 120),
            st.sampled_from(["soup", "wheel", "strip", "torus"]),
            st.integers(0, 2**32 - 1),
        ),
        st.just(n),
    )
)
"""Any faces, and how many vertices there are, some of them in no face."""

KINDS = st.sampled_from(["noise", "extremes", "constant", "smooth", "few"])


def values(rows: int, low: npt.ArrayLike, high: npt.ArrayLike, kind: str, seed: int) -> Ints:
    """Integers of each column from `low` to `high`."""
    rng = np.random.default_rng(seed)
    low, high = np.asarray(low), np.asarray(high)
    shape = (rows, len(low))
    if kind == "noise":
        drawn = rng.integers(low, high + 1, shape)
    elif kind == "extremes":
        drawn = np.where(rng.random(shape) < 0.5, low, high)
    elif kind == "constant":
        drawn = np.broadcast_to((low + high) // 2, shape)
    elif kind == "few":
        drawn = np.where(rng.random(shape) < 0.9, (low + high) // 2, rng.integers(low, high + 1, shape))
    else:
        drawn = low + (high - low) * np.arange(rows)[:, None] // max(rows, 1) + rng.integers(0, 2, shape)
    return np.clip(drawn, low, high).astype(np.int32)


def sizes(total: int, chunk: int) -> list[int]:
    """Chunks of `chunk` vertices, the last one of what is left."""
    return [min(chunk, total - first) for first in range(0, total, chunk)]


def encode(encoder: FieldEncoder, vertices: int, chunk: int) -> Chunks:
    """All payloads, and of how many vertices or faces each is."""
    return [(encoder.chunk(count), count) for count in sizes(vertices, chunk)]


def decode(decoder: FieldDecoder, vertices: int, axes: int, chunks: Chunks) -> Ints:
    """What payloads say; -1 where they say nothing."""
    found = np.full((vertices, axes), -1, np.int32)
    for payload, count in chunks:
        which, said = decoder.chunk(payload, count)
        found[which] = said
    return found
