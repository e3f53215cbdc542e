"""Meshes, values and all kinds of fields, for the tests of these."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from hypothesis import strategies as st

from bsm._core import Field
from bsm.bitstream.container.header import (
    COLOR,
    FACE,
    GENERIC,
    LEVELS,
    NORMAL,
    OCTAHEDRAL,
    TEXCOORD,
    VERTEX,
    Declaration,
)
from bsm.codec.static.attributes.encoding import Surface
from bsm.codec.static.attributes.encoding import field_of as attribute_field
from bsm.codec.static.ways.grid import grid_field, levels_field
from tests.shapes import Faces, grid_faces

Ints = npt.NDArray[np.int32]
Chunks = list[tuple[bytes, int]]

SWIFT = ("plain 1", "texcoord 1", "normal 1", "plain 2", "texcoord 2", "normal 2")
"""Kinds of attributes, with what the header's `swift` is."""
NAMES = ("grid", "light", "levels", "plain", "color", "texcoord", "normal", "faces", *SWIFT)
COLUMNS = {"grid": 3, "light": 3, "levels": 3} | {
    name: 2 for name in NAMES if name.startswith(("tex", "normal"))
}
"""Columns of kinds with a fixed number."""


def unfolded(levels: npt.NDArray[np.int64], size: int) -> npt.NDArray[np.int64]:
    """The points of levels on an octahedron of this size (Meyer et al., EGSR 2010)."""
    flat = levels - size
    height = size - np.abs(flat).sum(axis=1, keepdims=True)
    inside = np.where(flat < 0, -1, 1) * (size - np.abs(flat[:, ::-1]))
    return np.hstack([np.where(height < 0, inside, flat), height])


def canonical_levels(levels: Ints, size: int) -> Ints:
    """The pairs, shape (n, 2), that a decoder gives for the directions of `levels`, shape (n, 2)."""
    points = unfolded(np.asarray(levels, np.int64), size)
    flat = points[:, :2]
    outside = np.where(flat < 0, -1, 1) * (size - np.abs(flat[:, ::-1]))
    return (np.where(points[:, 2:] < 0, outside, flat) + size).astype(np.int32)


@dataclass(frozen=True)
class Kind:
    """A kind of field on a mesh, and how it begins."""

    make: Callable[[Ints], Field]
    rows: int
    columns: int

    def start(self, given: npt.ArrayLike | None = None) -> Field:
        """The field of values that are written, or of those that will be read."""
        return self.make(
            np.zeros((self.rows, self.columns), np.int32)
            if given is None
            else np.array(given, np.int32)
        )

    def order(self) -> Ints:
        order = self.start().order
        return np.arange(self.rows, dtype=np.int32) if order is None else order

    def reader(self) -> Callable[[bytes, int], tuple[Ints, Ints]]:
        """What reads payloads: the rows of each, and their values."""
        field, order, first = self.start(), self.order(), 0

        def read(payload: bytes, count: int) -> tuple[Ints, Ints]:
            nonlocal first
            known, which = field.read(payload, count), order[first : first + count]
            first += count
            return which, known[which]

        return read


SEMANTICS = {
    "plain": GENERIC,
    "faces": GENERIC,
    "color": COLOR,
    "texcoord": TEXCOORD,
    "normal": NORMAL,
}


def field_of(
    name: str, faces: npt.ArrayLike, vertices: int, largest=(), at=None, places=None
) -> Kind:
    """The field with this name; vertices at equal `places` are one."""
    table = np.array(faces, np.int32)
    if name == "levels":
        return Kind(lambda given: levels_field(table, given), vertices, 3)
    if name in ("grid", "light"):
        return Kind(
            lambda given: grid_field(table, largest, given, int(name == "light")), vertices, 3
        )
    kind, _, swift = name.partition(" ")
    of_faces, normal = kind == "faces", kind == "normal"
    rows = len(table) if of_faces else vertices
    declaration = Declaration(
        name=name,
        domain=FACE if of_faces else VERTEX,
        semantic=SEMANTICS[kind],
        coding=OCTAHEDRAL if normal else LEVELS,
        kind=6 if normal else 5,
        components=3 if normal else len(largest),
        rows=rows,
        largest=tuple(map(int, largest)),
    )
    numbers = np.arange(rows) if places is None else np.asarray(places)
    surface = Surface(table, np.array([] if of_faces else numbers, np.int32))
    geometry = None if at is None or of_faces else np.array(at, np.int32)
    return Kind(
        lambda given: attribute_field(declaration, surface, given, geometry, int(swift or 0)),
        rows,
        len(largest),
    )


def offered(name: str, rows: int, largest, kind: str, seed: int) -> Ints:
    """Values for the field with this name."""
    drawn = values(rows, [-most * (name == "levels") for most in largest], largest, kind, seed)
    return canonical_levels(drawn, largest[0] // 2) if name.startswith("normal") else drawn


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
        faces = grid_faces(7, 6, (True, True))
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
        drawn = np.where(
            rng.random(shape) < 0.9, (low + high) // 2, rng.integers(low, high + 1, shape)
        )
    else:
        drawn = (
            low
            + (high - low) * np.arange(rows)[:, None] // max(rows, 1)
            + rng.integers(0, 2, shape)
        )
    return np.clip(drawn, low, high).astype(np.int32)


def encode(kind: Kind, given: npt.ArrayLike, chunk: int = 1 << 30) -> Chunks:
    """All payloads, of `chunk` rows but for the last one, and of how many each is."""
    field, size = kind.start(given), kind.rows
    counts = [min(chunk, size - first) for first in range(0, size, chunk)]
    return [(*field.write(count), count) for count in counts]


def decode(kind: Kind, chunks: Chunks) -> Ints:
    """What payloads say; -1 where they say nothing."""
    read = kind.reader()
    found = np.full((kind.rows, kind.columns), -1, np.int32)
    for payload, count in chunks:
        which, decoded = read(payload, count)
        found[which] = decoded
    return found


def size_of(kind: Kind, given: npt.ArrayLike) -> int:
    """Bytes of all values."""
    return sum(len(payload) for payload, _ in encode(kind, given))
