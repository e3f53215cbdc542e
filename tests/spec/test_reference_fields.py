"""The product and the decoder written from the law treat the same payloads alike, damaged ones too."""

from __future__ import annotations

import hashlib
import importlib
import struct
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bsm.bitstream.errors import BsmError
from bsm.bitstream.fields.corners import MOST_LARGEST, FieldDecoder
from bsm.bitstream.fields.grid import grid_field, spread
from bsm.bitstream.fields.levels import MOST_LEVEL, levels_field
from tests.bitstream.fields.fields import KINDS, SOUPS, Chunks, encode, values
from tools import field_tables
from tools.measure.grids import rounded, welded

SPEC = Path(__file__).parents[2] / "spec"
DOCUMENT = (SPEC / "core-4-fields.md").read_text()
quick = settings(max_examples=40)
CHUNKS = st.sampled_from([1, 7, 100])
SEEDS = st.integers(0, 2**32 - 1)


@pytest.fixture(scope="module")
def reference():
    sys.path.insert(0, str(SPEC))
    yield importlib.import_module("reference_integers")
    sys.path.remove(str(SPEC))


def outcome(read: Callable[[bytes, int], Any], chunks: Chunks) -> list[Any]:
    """What each payload gives, up to the first error, and the name of that."""
    found: list[Any] = []
    for payload, count in chunks:
        try:
            found.append(read(payload, count))
        except Exception as error:
            if not isinstance(error, BsmError) and "reference" not in type(error).__module__:
                raise
            return [*found, type(error).__name__]
    return found


def product(decoder: FieldDecoder) -> Callable[[bytes, int], Any]:
    return lambda payload, count: [array.tolist() for array in decoder.chunk(payload, count)]


def plain(reader: Any) -> Callable[[bytes, int], Any]:
    def read(payload: bytes, count: int) -> Any:
        vertices = reader.read(payload, count)
        return [vertices, [list(reader.x[v]) for v in vertices]]

    return read


def damaged(chunks: Chunks, data: st.DataObject) -> Chunks:
    """One payload cut, lengthened, changed, or at random."""
    which = data.draw(st.integers(0, len(chunks) - 1))
    payload, count = chunks[which]
    changed = bytearray(payload)
    kind = data.draw(st.sampled_from(["cut", "longer", "changed", "random"]))
    if kind == "cut":
        changed = changed[: data.draw(st.integers(0, len(payload)))]
    elif kind == "longer":
        changed += data.draw(st.binary(min_size=1, max_size=5))
    elif kind == "random":
        changed = bytearray(data.draw(st.binary(max_size=60)))
    elif changed:
        changed[data.draw(st.integers(0, len(changed) - 1))] ^= data.draw(st.integers(1, 255))
    return [*chunks[:which], (bytes(changed), count), *chunks[which + 1 :]]


@quick
@given(SOUPS, st.tuples(*[st.sampled_from([0, 1, 100, MOST_LARGEST])] * 3), KINDS, SEEDS, CHUNKS, st.data())
def test_grids(reference, mesh, largest, kind, seed, chunk, data):
    faces, vertices = mesh
    if not vertices:
        return
    positions = values(vertices, (0, 0, 0), largest, kind, seed)
    field = grid_field(faces, vertices, largest)
    chunks = encode(field, positions, chunk)
    assert reference.Mesh(faces.tolist(), vertices, True).order == FieldDecoder(field).order.tolist()
    for payloads in (chunks, damaged(chunks, data)):
        expected = outcome(product(FieldDecoder(field)), payloads)
        assert outcome(plain(reference.GridReader(faces.tolist(), vertices, list(largest))), payloads) == expected


@quick
@given(SOUPS, st.sampled_from([1, 9, MOST_LEVEL]), KINDS, SEEDS, CHUNKS, st.data())
def test_levels(reference, mesh, most, kind, seed, chunk, data):
    faces, vertices = mesh
    if not vertices:
        return
    field = levels_field(faces, vertices)
    chunks = encode(field, values(vertices, [-most] * 3, [most] * 3, kind, seed), chunk)
    for payloads in (chunks, damaged(chunks, data)):
        expected = outcome(product(FieldDecoder(field)), payloads)
        assert outcome(plain(reference.LevelsReader(faces.tolist(), vertices)), payloads) == expected


@pytest.mark.slow
@pytest.mark.real
@pytest.mark.parametrize(("name", "bits"), [("twelve_dodecahedron", 14), ("c3d_spot", 12)])
def test_real_meshes(reference, meshes: Path, name: str, bits: int):
    positions, faces = welded(str(meshes / "static" / f"{name}.ply"))
    grid = rounded(positions, bits)
    largest = grid.max(axis=0).tolist()
    field = grid_field(faces, len(grid), largest)
    chunks = encode(field, grid, 700)[:2]
    expected = outcome(product(FieldDecoder(field)), chunks)
    assert outcome(plain(reference.GridReader(faces.tolist(), len(grid), largest)), chunks) == expected
    levels = (grid - rounded(positions * np.float32(0.999), bits)) % 5 - 2
    chunks = encode(levels_field(faces, len(grid)), levels, 700)[:2]
    expected = outcome(product(FieldDecoder(levels_field(faces, len(grid)))), chunks)
    assert outcome(plain(reference.LevelsReader(faces.tolist(), len(grid))), chunks) == expected


def test_positions_of_a_lattice(reference):
    points = np.arange(30, dtype=np.int32).reshape(10, 3)
    header = {"lattice": [4095, 29], "center": [0.5, -1.0, 2.0], "scale": 0.25, "corner": []}
    said = [reference.place(row, header) for row in points.tolist()]
    assert said == (np.array([0.5, -1.0, 2.0]) + 0.25 * spread(points, (4095, 29))).tolist()
    header = {"lattice": [], "center": [0.0, 0.0, 0.0], "scale": 0.1, "corner": []}
    assert reference.place([1, 2, 3], header) == [0.1, 0.2, 0.1 * 3]
    assert reference.place([1, 2, 3], header | {"corner": [-3, 5, 70000]}) == [0.1 * -2, 0.1 * 7, 0.1 * 70003]


def test_the_tables_are_those_of_the_document(reference):
    odds, less = field_tables.odds_tables()
    table = field_tables.survival_table() + odds + less
    assert table == reference.SURVIVAL + reference.ODDS + reference.LESS
    digest = hashlib.sha256(struct.pack(f"<{len(table)}i", *table)).hexdigest()
    assert digest in DOCUMENT
