"""Integers on meshes to bytes and back, of all kinds: exact for any faces and values, safe on damage."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bsm import BsmError, CorruptError, NumericError, TruncatedError
from bsm.bitstream.connectivity.faces import encode_connectivity
from bsm.bitstream.container.header import MOST_GRID
from tests.bitstream.fields.fields import (
    COLUMNS,
    KINDS,
    NAMES,
    SOUPS,
    decode,
    encode,
    field_of,
    offered,
    size_of,
    values,
)
from tests.shapes import grid_faces
from tools.measure.grids import encode as encode_stream
from tools.measure.grids import welded

SEEDS = st.integers(0, 2**32 - 1)
TORUS = grid_faces(12, 9, (True, True))
TRIANGLE, NOTHING = [[0, 1, 2]], np.empty((0, 3), np.int32)
K = np.arange(108)
BUMPS = np.stack(
    [100 * (K // 9) + (K % 9) ** 2, 90 * (K % 9), 500 + (K // 9 - 6) ** 3 + (K % 9 * 37) % 11],
    axis=1,
)
"""Places of the vertices of the torus, in integers alone."""
named = pytest.mark.parametrize("name", NAMES)


def largest_of(name: str, draw) -> list[int]:
    """Largest values that the field with this name may have."""
    most = st.sampled_from([0, 1, 2, 63, 64, 1000, MOST_GRID])
    if name.startswith("normal"):
        return [2 * draw(st.sampled_from([1, 2, 127, 32767]))] * 2
    return [draw(most) for _ in range(COLUMNS.get(name) or draw(st.integers(1, 4)))]


@named
@given(
    SOUPS,
    st.sampled_from([0, 9, 2**31 - 1]),
    KINDS,
    SEEDS,
    st.sampled_from([1, 3, 20, 1000]),
    st.data(),
)
def test_values_come_back(name, mesh, reach, kind, seed, chunk, data):
    faces, vertices = mesh
    if vertices == 0 or (name == "faces" and len(faces) == 0):
        return
    rng = np.random.default_rng(seed)
    at = None if reach == 0 else rng.integers(-reach, reach + 1, (vertices, 3))
    field = field_of(
        name,
        faces,
        vertices,
        largest := largest_of(name, data.draw),
        at,
        rng.integers(0, 9, vertices) % vertices,
    )
    given = offered(name, len(faces) if name == "faces" else vertices, largest, kind, seed)
    np.testing.assert_array_equal(decode(field, encode(field, given, chunk)), given)


@named
def test_what_was_learnt_goes_on_over_chunks(name):
    largest = [254, 254] if name.startswith("normal") else [999] * COLUMNS.get(name, 3)
    field = field_of(name, TORUS, 108, largest, BUMPS)
    given = offered(name, len(TORUS) if name == "faces" else 108, largest, "smooth", 1)
    whole, parts = size_of(field, given), encode(field, given, 54)
    assert whole <= sum(len(payload) for payload, _ in parts) <= whole + 5 * len(parts)


@named
def test_bytes_missing_or_left_over(name):
    largest = [254, 254] if name.startswith("normal") else [99] * COLUMNS.get(name, 3)
    field = field_of(name, TORUS, 108, largest, BUMPS)
    ((payload, rows),) = encode(
        field, offered(name, len(TORUS) if name == "faces" else 108, largest, "noise", 5)
    )
    for length in range(0, len(payload) - 8, 5):
        with pytest.raises((TruncatedError, CorruptError)):
            field.start().read(payload[:length], rows)
    reader = field.start()
    with pytest.raises(CorruptError):
        reader.read(payload + b"\1" * 5, rows)
    with pytest.raises(ValueError, match="not left"):  # nothing can be read after an error
        reader.read(payload, rows)
    with pytest.raises(CorruptError):
        field.start().read(b"\xff" * 8, rows)


@pytest.mark.parametrize(
    ("name", "values", "largest"),
    [
        ("grid", [[0, 0, 2]] * 3, (1, 1, 1)),
        ("light", [[0, 0, -1]] * 3, (1, 1, 1)),
        ("levels", [[(1 << 20) + 1] * 3] * 3, ()),
        ("plain", [[2]] * 3, (1,)),
        ("faces", [[2]], (1,)),
    ],
)
def test_values_out_of_range_are_refused(name, values, largest):
    with pytest.raises(NumericError, match="out of its range"):
        field_of(name, TRIANGLE, 3, largest).start(values)


@pytest.mark.parametrize(
    ("values", "largest"), [([[0, 0]] * 3, (1, 1, 1)), ([[0, 0, 0]] * 3, (1, 1)), ([0, 0, 0], (1,))]
)
def test_a_grid_has_three_axes(values, largest):
    with pytest.raises((ValueError, TypeError)):
        field_of("grid", TRIANGLE, 3, largest).start(values)


@pytest.mark.parametrize("name", ["grid", "light", "levels"])
@pytest.mark.parametrize("faces", [[[0, 1, 3]], [[0, 1, -2]]])
def test_faces_are_checked(name, faces):
    with pytest.raises(BsmError):
        field_of(name, faces, 3, [2] * COLUMNS[name]).start()


def test_counts_are_checked():
    field = field_of("levels", TRIANGLE, 3).start()
    for count in (0, -1, 4):
        with pytest.raises(ValueError, match="not left"):
            field.write(count)
    field.write(3)
    with pytest.raises(ValueError, match="not left"):
        field.write(1)


@settings(max_examples=100)
@given(st.integers(3, 60), st.integers(0, 200), SEEDS)
def test_extremes_stay_within_their_types(vertices: int, count: int, seed: int):
    """Every value at one end of the largest range, around one vertex: sums and normals at their greatest."""
    faces = np.random.default_rng(seed).integers(0, vertices, (count, 3))
    faces[:, 0] = vertices - 1
    field = field_of("light", faces, vertices, (MOST_GRID,) * 3)
    positions = values(vertices, (0, 0, 0), (MOST_GRID,) * 3, "extremes", seed)
    np.testing.assert_array_equal(decode(field, encode(field, positions)), positions)


def test_what_is_known_helps():
    patch = grid_faces(20, 20)
    at = 60 * np.stack([*np.divmod(np.arange(400), 20), np.zeros(400, int)], axis=1)
    at[:, :2] += values(400, [0, 0], [40, 40], "noise", 7)
    blind = size_of(field_of("texcoord", patch, 400, (1999, 1999)), at[:, :2])
    assert size_of(field_of("texcoord", patch, 400, (1999, 1999), at), at[:, :2]) < 0.6 * blind
    twice = np.concatenate([TORUS, TORUS + 108])
    noise = np.tile(values(108, [0], [255], "noise", 3), (2, 1))
    alone = size_of(field_of("plain", twice, 216, (255,)), noise)
    assert size_of(field_of("plain", twice, 216, (255,), None, np.tile(K, 2)), noise) < 0.7 * alone


@pytest.mark.real
@pytest.mark.parametrize(
    ("name", "bits", "most"), [("nicolo", 12, 14.4), ("fandisk_6475", 11, 7.5)]
)
def test_grids_of_real_meshes_are_small(meshes: Path, name: str, bits: int, most: float):
    positions, faces = welded(str(meshes / "static" / f"{name}.ply"))
    stream, _ = encode_stream(positions, faces, bits)  # decodes and compares
    connectivity = len(encode_connectivity(faces, len(positions)).payload)
    assert 8 * (len(stream) - connectivity) / len(positions) < most
