"""Grids and levels to bytes and back: exact for any faces and values, the same bytes for ever, safe on damage."""

from __future__ import annotations

import contextlib
import tracemalloc
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bsm.bitstream.connectivity.faces import encode_connectivity
from bsm.bitstream.errors import CorruptError, LimitError, MeshError, OptionError, TruncatedError
from bsm.bitstream.fields.corners import corners_of, traverse
from bsm.bitstream.fields.grid import MOST_LARGEST, GridDecoder, GridEncoder, find_lattice, grid_charge, spread
from bsm.bitstream.fields.levels import MOST_LEVEL, LevelsDecoder, LevelsEncoder, levels_charge
from bsm.bitstream.limits import DEFAULT_LIMITS
from tests.bitstream.fields.fields import KINDS, SOUPS, decode, encode, values
from tests.shapes import Faces, grid_faces
from tools import field_tables
from tools.measure.grids import encode as encode_stream
from tools.measure.grids import welded

quick = settings(max_examples=150)

LARGEST = st.tuples(*[st.sampled_from([0, 1, 2, 63, 64, 1000, MOST_LARGEST])] * 3)
CHUNKS = st.sampled_from([1, 3, 20, 1000])
SEEDS = st.integers(0, 2**32 - 1)
TORUS = grid_faces(12, 9, close_rows=True, close_columns=True)


@quick
@given(SOUPS, LARGEST, KINDS, SEEDS, CHUNKS)
def test_grids_come_back(mesh, largest, kind, seed, chunk):
    faces, vertices = mesh
    positions = values(vertices, (0, 0, 0), largest, kind, seed)
    chunks = encode(GridEncoder(faces, positions, largest), vertices, chunk)
    found = decode(GridDecoder(faces, vertices, largest), vertices, 3, chunks)
    np.testing.assert_array_equal(found, positions)


@quick
@given(SOUPS, st.sampled_from([0, 1, 5, 300, MOST_LEVEL]), KINDS, SEEDS, CHUNKS)
def test_levels_come_back(mesh, most, kind, seed, chunk):
    faces, vertices = mesh
    levels = values(vertices, [-most] * 3, [most] * 3, kind, seed)
    chunks = encode(LevelsEncoder(faces, levels), vertices, chunk)
    found = decode(LevelsDecoder(faces, vertices), vertices, 3, chunks)
    np.testing.assert_array_equal(found, levels)


def position_of(k: np.ndarray) -> np.ndarray:
    """A bumpy place of vertex k of the torus, in integers alone."""
    row, column = k // 9, k % 9
    return np.stack([100 * row + column * column, 90 * column, 500 + (row - 6) ** 3 + (column * 37) % 11], axis=1)


def test_golden_bytes():
    k = np.arange(108)
    grid = encode(GridEncoder(TORUS, position_of(k), (2047, 2047, 1023)), 108, 60)
    assert [payload.hex() for payload, _ in grid] == GOLDEN_GRID
    levels = encode(LevelsEncoder(TORUS, np.stack([k * k % 7 - 3, k % 5 - 2, k // 40], axis=1) // 2), 108, 60)
    assert [payload.hex() for payload, _ in levels] == GOLDEN_LEVELS


GOLDEN_GRID = [
    "66e1662ed92eef99f60000000005f0ecc731ee6c0000000000143ea7558279b4ce8d7d770ce094de778f76dc42cbb27bf7911e1a7c0791ae2678b1cdb94a90a97aac95da51af5be42917334c57c9061851432a6ec84596fb167cb11ff9377e9100ce388d597da3",
    "01518fc240acbf8258caa412ae3a4ab286ad6ae31ab7338918894937819632f2ab8d539a6a",
]
GOLDEN_LEVELS = [
    "683c19c3a81c45b178a76ce2b7ed6e65e1ddd2cbaac017",
    "8908cd41a1d486293156d4577de8390a",
]


def test_tables_are_what_their_tool_writes():
    assert field_tables.PATH.read_text() == field_tables.source()


def test_few_vertices():
    one = encode(GridEncoder(np.empty((0, 3), np.int32), [[5, 6, 7]], (9, 9, 9)), 1, 1)
    assert decode(GridDecoder(np.empty((0, 3), np.int32), 1, (9, 9, 9)), 1, 3, one).tolist() == [[5, 6, 7]]
    assert encode(GridEncoder(np.empty((0, 3), np.int32), np.empty((0, 3), np.int32), (9, 9, 9)), 0, 1) == []


def test_corners_of_two_triangles():
    corners = corners_of([[0, 1, 2], [2, 1, 3]], 5)
    assert corners.starts.tolist() == [0, 1, 3, 5, 6, 6]
    assert corners.corners.tolist() == [0, 1, 4, 2, 3, 5]
    assert corners.opposite.tolist() == [5, -1, -1, -1, -1, 0]
    assert traverse(corners).tolist() == [0, 1, 2, 3, 4]


def test_the_order_prefers_complete_neighbourhoods():
    order = traverse(corners_of(TORUS, 108))
    assert sorted(order.tolist()) == list(range(108))
    rank = np.argsort(order)
    near = [sum(rank[u] < rank[v] for u in set(TORUS[(v == TORUS).any(axis=1)].ravel()) - {v}) for v in order]
    assert near[0] == 0 and np.mean(near[10:]) >= 2.5


def test_what_was_learnt_goes_on_over_chunks():
    positions = values(108, (0, 0, 0), (999, 999, 999), "smooth", 1)
    parts = encode(GridEncoder(TORUS, positions, (999, 999, 999)), 108, 54)
    apart = sum(len(GridEncoder(TORUS, positions, (999, 999, 999)).chunk(54)) for _ in range(2))
    assert sum(len(payload) for payload, _ in parts) < apart
    whole = GridEncoder(TORUS, positions, (999, 999, 999)).chunk(108)
    assert len(whole) <= sum(len(payload) for payload, _ in parts) <= len(whole) + 5


@pytest.mark.parametrize(
    ("make", "error"),
    [
        (lambda: GridEncoder([[0, 1, 2]], [[0, 0, 0]] * 3, (1, 1)), OptionError),
        (lambda: GridEncoder([[0, 1, 2]], [[0, 0, 0]] * 3, (1, 1, 1 << 20)), OptionError),
        (lambda: GridEncoder([[0, 1, 2]], [[0, 0, 0]] * 3, (1, 1, -1)), OptionError),
        (lambda: GridEncoder([[0, 1, 2]], [[0, 0, 2]] * 3, (1, 1, 1)), MeshError),
        (lambda: GridEncoder([[0, 1, 2]], [[0, 0, -1]] * 3, (1, 1, 1)), MeshError),
        (lambda: GridEncoder([[0, 1, 2]], [[0.5, 0, 0]] * 3, (1, 1, 1)), MeshError),
        (lambda: GridEncoder([[0, 1, 3]], [[0, 0, 0]] * 3, (1, 1, 1)), MeshError),
        (lambda: GridEncoder([[0, 1, -1]], [[0, 0, 0]] * 3, (1, 1, 1)), MeshError),
        (lambda: GridEncoder([0, 1, 2], [[0, 0, 0]] * 3, (1, 1, 1)), MeshError),
        (lambda: LevelsEncoder([[0, 1, 2]], [[0, 0]] * 3), MeshError),
        (lambda: LevelsEncoder([[0, 1, 2]], [[MOST_LEVEL + 1] * 3] * 3), MeshError),
        (lambda: LevelsEncoder([[0, 1, 2]], [0, 0, 0]), MeshError),
        (lambda: LevelsDecoder([[0, 1, 2]], 2), MeshError),
    ],
)
def test_what_cannot_be_coded_is_said(make: Callable[[], object], error: type[Exception]):
    with pytest.raises(error):
        make()


def test_counts_are_checked():
    encoder = LevelsEncoder([[0, 1, 2]], [[0, 0, 0]] * 3)
    for count in (0, -1, 4):
        with pytest.raises(OptionError):
            encoder.chunk(count)
    encoder.chunk(3)
    with pytest.raises(OptionError):
        encoder.chunk(1)


@pytest.mark.parametrize("axes", [0, 3])
def test_bytes_missing_or_left_over(axes: int):
    if axes:
        field = values(108, [-9] * axes, [9] * axes, "noise", 5)
        payload = LevelsEncoder(TORUS, field).chunk(108)
    else:
        payload = GridEncoder(TORUS, values(108, (0, 0, 0), (99, 99, 99), "noise", 5), (99, 99, 99)).chunk(108)

    def fresh() -> GridDecoder | LevelsDecoder:
        return LevelsDecoder(TORUS, 108) if axes else GridDecoder(TORUS, 108, (99, 99, 99))

    for length in range(0, len(payload) - 8, 5):
        with pytest.raises((TruncatedError, CorruptError)):
            fresh().chunk(payload[:length], 108)
    with pytest.raises(TruncatedError):
        fresh().chunk(b"", 108)
    decoder = fresh()
    with pytest.raises(CorruptError):
        decoder.chunk(payload + b"\1" * 5, 108)
    with pytest.raises(OptionError):  # nothing can be read behind an error
        decoder.chunk(payload, 108)
    with pytest.raises(CorruptError):
        fresh().chunk(b"\xff" * 8, 108)


@quick
@given(SOUPS, st.binary(max_size=300), st.sampled_from([0, 3]))
def test_noise_is_a_typed_error_or_values_in_range(mesh, payload, axes):
    faces, vertices = mesh
    if not vertices:
        return
    with contextlib.suppress(CorruptError, TruncatedError):
        if axes:
            assert abs(LevelsDecoder(faces, vertices).chunk(payload, vertices)[1]).max() <= MOST_LEVEL
        else:
            found = GridDecoder(faces, vertices, (5, 1000, MOST_LARGEST)).chunk(payload, vertices)[1]
            assert (found >= 0).all() and (found <= [5, 1000, MOST_LARGEST]).all()


@pytest.mark.parametrize("rows", [3, 200])
def test_charges_hold(rows: int):
    faces = grid_faces(rows, 200)
    vertices = 200 * rows
    for charge, make in (
        (grid_charge(vertices, len(faces)), lambda: GridDecoder(faces, vertices, (MOST_LARGEST,) * 3)),
        (levels_charge(vertices, len(faces)), lambda: LevelsDecoder(faces, vertices)),
    ):
        tracemalloc.start()
        make()
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        assert 0.5 * charge < peak <= charge


def test_limits_come_before_allocation():
    tight = replace(DEFAULT_LIMITS, field_bytes=1 << 20)
    for make in (
        lambda: GridDecoder(TORUS, 1 << 29, (1, 1, 1), tight),
        lambda: LevelsDecoder(TORUS, 1 << 29, tight),
    ):
        with pytest.raises(LimitError):
            make()


@given(st.integers(1, 300), st.integers(2, 2000), SEEDS)
def test_lattices(count: int, cells: int, seed: int):
    if count > cells // 2:
        return
    points = np.random.default_rng(seed).integers(0, count + 1, (50, 3)).astype(np.int32)
    on_grid = spread(points, (cells, count))
    found, lattice = find_lattice(on_grid, cells)
    np.testing.assert_array_equal(spread(found, lattice), on_grid)
    assert lattice == () or lattice[1] <= count


def test_no_lattice():
    found, lattice = find_lattice(np.arange(100), 99)
    assert lattice == () and found.tolist() == list(range(100))
    assert find_lattice(np.zeros((4, 3), int), 4095)[1] == (4095, 1)


def real_mesh(meshes: Path, name: str) -> tuple[np.ndarray, Faces]:
    return welded(str(meshes / "static" / f"{name}.ply"))


@pytest.mark.real
@pytest.mark.parametrize(("name", "bits", "most"), [("nicolo", 12, 14.4), ("fandisk_6475", 11, 7.5)])
def test_real_meshes_are_small(meshes: Path, name: str, bits: int, most: float):
    positions, faces = real_mesh(meshes, name)
    stream, _ = encode_stream(positions, faces, bits)  # decodes and compares
    connectivity = len(encode_connectivity(faces, len(positions)).payload)
    assert 8 * (len(stream) - connectivity) / len(positions) < most
