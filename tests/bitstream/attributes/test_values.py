"""Values of attributes to bytes and back: exact for any mesh and values, the same bytes for ever, safe on damage."""

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

from bsm.bitstream.attributes.values import (
    MOST_LARGEST,
    FaceValueDecoder,
    FaceValueEncoder,
    Kind,
    ValueDecoder,
    ValueEncoder,
    canonical_levels,
    face_values_charge,
    octahedral_levels,
    octahedral_normals,
    ring_of_twins,
    values_charge,
)
from bsm.bitstream.errors import CorruptError, LimitError, MeshError, OptionError, TruncatedError
from bsm.bitstream.limits import DEFAULT_LIMITS
from tests.bitstream.fields.fields import KINDS, SOUPS, decode, encode, values
from tests.shapes import grid_faces
from tools.measure.grids import rounded, welded

quick = settings(max_examples=100)
CHUNKS = st.sampled_from([1, 3, 20, 1000])
SEEDS = st.integers(0, 2**32 - 1)
TORUS = grid_faces(12, 9, close_rows=True, close_columns=True)
OCTAHEDRA = st.sampled_from([1, 2, 127, MOST_LARGEST // 2])


def bumps() -> np.ndarray:
    """Places of the vertices of the torus, in integers alone."""
    row, column = np.arange(108) // 9, np.arange(108) % 9
    return np.stack([100 * row + column * column, 90 * column, 500 + (row - 6) ** 3 + (column * 37) % 11], axis=1)


@quick
@given(SOUPS, st.integers(1, 4), st.data(), KINDS, SEEDS, CHUNKS)
def test_numbers_come_back(mesh, components, data, kind, seed, chunk):
    faces, vertices = mesh
    largest = tuple(data.draw(st.sampled_from([0, 1, 63, 64, 255, MOST_LARGEST])) for _ in range(components))
    places = np.random.default_rng(seed).integers(0, vertices or 1, vertices)
    offered = values(vertices, [0] * components, largest, kind, seed)
    chunks = encode(ValueEncoder(faces, offered, largest, "color", None, places), vertices, chunk)
    found = decode(ValueDecoder(faces, vertices, largest, "color", None, places), vertices, components, chunks)
    np.testing.assert_array_equal(found, offered)


@quick
@given(SOUPS, st.sampled_from([0, 1, 4095, MOST_LARGEST]), st.sampled_from([0, 9, 2**31 - 1]), KINDS, SEEDS, CHUNKS)
def test_texture_coordinates_come_back(mesh, most, reach, kind, seed, chunk):
    faces, vertices = mesh
    at = np.random.default_rng(seed).integers(-reach, reach + 1, (vertices, 3))
    offered = values(vertices, [0, 0], [most, most], kind, seed)
    chunks = encode(ValueEncoder(faces, offered, (most, most), "texcoord", at), vertices, chunk)
    found = decode(ValueDecoder(faces, vertices, (most, most), "texcoord", at), vertices, 2, chunks)
    np.testing.assert_array_equal(found, offered)


@quick
@given(SOUPS, OCTAHEDRA, st.sampled_from([0, 9, 2**31 - 1]), KINDS, SEEDS, CHUNKS)
def test_normals_come_back(mesh, size, reach, kind, seed, chunk):
    faces, vertices = mesh
    at = np.random.default_rng(seed).integers(-reach, reach + 1, (vertices, 3))
    offered = canonical_levels(values(vertices, [0, 0], [2 * size] * 2, kind, seed), size)
    chunks = encode(ValueEncoder(faces, offered, [2 * size] * 2, "normal", at), vertices, chunk)
    found = decode(ValueDecoder(faces, vertices, [2 * size] * 2, "normal", at), vertices, 2, chunks)
    np.testing.assert_array_equal(found, offered)


@quick
@given(SOUPS, st.integers(1, 4), st.sampled_from([0, 5, 255, MOST_LARGEST]), KINDS, SEEDS, CHUNKS)
def test_values_of_faces_come_back(mesh, components, most, kind, seed, chunk):
    faces, _ = mesh
    offered = values(len(faces), [0] * components, [most] * components, kind, seed)
    chunks = encode(FaceValueEncoder(faces, offered, [most] * components), len(faces), chunk)
    found = decode(FaceValueDecoder(faces, [most] * components), len(faces), components, chunks)
    np.testing.assert_array_equal(found, offered)


def test_golden_bytes():
    k = np.arange(108)
    at = bumps()
    texture = at[:, :2] // 2 + (k * k % 3)[:, None]
    assert ValueEncoder(TORUS, texture, (1023, 1023), "texcoord", at).chunk(108).hex() == GOLDEN["texcoord"]
    normals = octahedral_levels(at - at.mean(axis=0).astype(int), 127)
    assert ValueEncoder(TORUS, normals, (254, 254), "normal", at).chunk(108).hex() == GOLDEN["normal"]
    colours = np.stack([k % 50 + 100, k % 50 + 90, k * 2], axis=1)
    assert ValueEncoder(TORUS, colours, (255, 255, 255), "color").chunk(108).hex() == GOLDEN["color"]
    groups = (np.arange(len(TORUS)) // 20)[:, None]
    assert FaceValueEncoder(TORUS, groups, (20,)).chunk(len(TORUS)).hex() == GOLDEN["face"]


GOLDEN = {
    "texcoord": (
        "66ed32e9d5ee9900000011f9ba4193d0dc71481a4a0f4ac26089e45e07ad90b173e6055afa07e2e1873c33a695737799dcac"
        "fc17ac41b537d7365d84f0455030e42a88b1366cbc71187a38b75794b1c6d305751d"
    ),
    "normal": (
        "c8ec01318ee4bedfe292a44fba1fb9157758b3004622b6b4ef1275414f5373a7354803cf0287f4d2c84e703ae4a2a3be8150"
        "587ca31d01994123f4b7ec5f188db61bea4f0f7d316b7f887eede8f4c3f5498eb63f110c4822afde10a28584da0876e24852"
        "aca8ff94047e90dc83d18215bf4ed149a54972e1e9266bd0cb1f4e2200cac755590ea9d1391d5cccfe57fc10aab401a006f8"
        "7b76fe3d0491d4f630d949853d23d3ee8e0bfdc7be54189f577d2e40b1212e393d05"
    ),
    "color": (
        "fca75cb3133ffd95406686a00e7e86d7c15e3158852f4becc680625cc303353e72e5ccd124816920c3030b1fa61772621fae"
        "113c101d83837e9fe122c70efe8e"
    ),
    "face": ("6a7dcf26ba12de206610d998c83a519e"),
}


def test_what_is_known_helps():
    patch = grid_faces(20, 20)
    at = 60 * np.stack([*np.divmod(np.arange(400), 20), np.zeros(400, int)], axis=1)
    at[:, :2] += values(400, [0, 0], [40, 40], "noise", 7)
    texture = at[:, :2]
    blind = len(ValueEncoder(patch, texture, (1999, 1999), "texcoord").chunk(400))
    assert len(ValueEncoder(patch, texture, (1999, 1999), "texcoord", at).chunk(400)) < 0.6 * blind
    twice = np.concatenate([TORUS, TORUS + 108])
    noise = np.tile(values(108, [0], [255], "noise", 3), (2, 1))
    alone = len(ValueEncoder(twice, noise, (255,)).chunk(216))
    assert len(ValueEncoder(twice, noise, (255,), "plain", None, np.tile(np.arange(108), 2)).chunk(216)) < 0.7 * alone


def test_constant_values_cost_nothing():
    colours = np.tile([[192, 192, 192, 255]], (108, 1))
    assert len(ValueEncoder(TORUS, colours, (192, 192, 192, 255), "color").chunk(108)) < 24
    assert len(FaceValueEncoder(TORUS, np.ones((len(TORUS), 1), int), (1,)).chunk(len(TORUS))) < 12


def test_what_was_learnt_goes_on_over_chunks():
    colours = values(108, [0] * 3, [99] * 3, "smooth", 1)
    parts = encode(ValueEncoder(TORUS, colours, (99, 99, 99)), 108, 54)
    whole = len(ValueEncoder(TORUS, colours, (99, 99, 99)).chunk(108))
    assert whole <= sum(len(payload) for payload, _ in parts) <= whole + 5


@pytest.mark.parametrize(
    ("make", "error"),
    [
        (lambda: ValueEncoder([[0, 1, 2]], [[0]] * 3, (1, 1)), MeshError),
        (lambda: ValueEncoder([[0, 1, 2]], [[0]] * 3, (1 << 20,)), OptionError),
        (lambda: ValueEncoder([[0, 1, 2]], [[0]] * 3, (-1,)), OptionError),
        (lambda: ValueEncoder([[0, 1, 2]], np.zeros((3, 5), int), (1,) * 5), OptionError),
        (lambda: ValueEncoder([[0, 1, 2]], [[2]] * 3, (1,)), MeshError),
        (lambda: ValueEncoder([[0, 1, 2]], [[-1]] * 3, (1,)), MeshError),
        (lambda: ValueEncoder([[0, 1, 2]], [[0.5]] * 3, (1,)), MeshError),
        (lambda: ValueEncoder([[0, 1, 3]], [[0]] * 3, (1,)), MeshError),
        (lambda: ValueEncoder([[0, 1, 2]], [[0]] * 3, (1,), "texcoord"), OptionError),
        (lambda: ValueEncoder([[0, 1, 2]], [[0]] * 3, (1,), "taste"), OptionError),
        (lambda: ValueEncoder([[0, 1, 2]], [[0, 0]] * 3, (2, 4), "normal"), OptionError),
        (lambda: ValueEncoder([[0, 1, 2]], [[0, 0]] * 3, (3, 3), "normal"), OptionError),
        (lambda: ValueEncoder([[0, 1, 2]], [[0, 0]] * 3, (2, 2), "normal"), MeshError),
        (lambda: ValueEncoder([[0, 1, 2]], [[0]] * 3, (1,), "plain", [[0, 0, 0]] * 2), MeshError),
        (lambda: ValueEncoder([[0, 1, 2]], [[0]] * 3, (1,), "plain", [[0, 0, 1 << 31]] * 3), MeshError),
        (lambda: ValueEncoder([[0, 1, 2]], [[0]] * 3, (1,), "plain", None, [0, 1]), MeshError),
        (lambda: ValueDecoder([[0, 1, 2]], 2, (1,)), MeshError),
        (lambda: FaceValueEncoder([[0, 1, 2]], [[0]] * 3, (1,)), MeshError),
        (lambda: FaceValueEncoder([[0, 1, 2]], [[2]], (1,)), MeshError),
        (lambda: FaceValueDecoder([[0, 1, -2]], (1,)), MeshError),
        (lambda: FaceValueDecoder([[0, 1, 2]], ()), OptionError),
    ],
)
def test_what_cannot_be_coded_is_said(make: Callable[[], object], error: type[Exception]):
    with pytest.raises(error):
        make()


KIND_CASES = [("plain", 3, 99), ("texcoord", 2, 99), ("normal", 2, 254)]


@pytest.mark.parametrize(("kind", "components", "most"), KIND_CASES)
def test_bytes_missing_or_left_over(kind: Kind, components: int, most: int):
    largest = [most] * components
    offered = values(108, [0] * components, largest, "noise", 5)
    offered = canonical_levels(offered, 127) if kind == "normal" else offered
    payload = ValueEncoder(TORUS, offered, largest, kind, bumps()).chunk(108)

    def fresh() -> ValueDecoder:
        return ValueDecoder(TORUS, 108, largest, kind, bumps())

    for length in range(0, len(payload) - 8, 5):
        with pytest.raises((TruncatedError, CorruptError)):
            fresh().chunk(payload[:length], 108)
    decoder = fresh()
    with pytest.raises(CorruptError):
        decoder.chunk(payload + b"\1" * 5, 108)
    with pytest.raises(OptionError):  # nothing can be read behind an error
        decoder.chunk(payload, 108)


@quick
@given(SOUPS, st.binary(max_size=300), st.sampled_from(KIND_CASES), st.sampled_from([0, 9, 2**31 - 1]), SEEDS)
def test_noise_is_a_typed_error_or_values_in_range(mesh, payload, case, reach, seed):
    faces, vertices = mesh
    kind, components, most = case
    if not vertices or not len(faces):
        return
    at = np.random.default_rng(seed).integers(-reach, reach + 1, (vertices, 3))
    with contextlib.suppress(CorruptError, TruncatedError):
        found = ValueDecoder(faces, vertices, [most] * components, kind, at).chunk(payload, vertices)[1]
        assert found.min() >= 0 and found.max() <= most
        assert kind != "normal" or (canonical_levels(found, most // 2) == found).all()
    with contextlib.suppress(CorruptError, TruncatedError):
        found = FaceValueDecoder(faces, [most] * components).chunk(payload, len(faces))[1]
        assert found.min() >= 0 and found.max() <= most


@pytest.mark.parametrize("rows", [3, 200])
def test_charges_hold(rows: int):
    faces = grid_faces(rows, 200)
    vertices = 200 * rows
    at, places = np.zeros((vertices, 3), np.int32), np.arange(vertices, dtype=np.int32)
    top = [MOST_LARGEST] * 4
    for charge, make in (
        (
            values_charge(vertices, len(faces), 4, "plain"),
            lambda: ValueDecoder(faces, vertices, top, "plain", at, places),
        ),
        (
            values_charge(vertices, len(faces), 2, "normal"),
            lambda: ValueDecoder(faces, vertices, [254] * 2, "normal", at, places),
        ),
        (face_values_charge(len(faces), 4), lambda: FaceValueDecoder(faces, top)),
    ):
        tracemalloc.start()
        make()
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        assert 0.4 * charge < peak <= charge


def test_limits_come_before_allocation():
    tight = replace(DEFAULT_LIMITS, field_bytes=1 << 20)
    with pytest.raises(LimitError):
        ValueDecoder(TORUS, 1 << 29, (1,), limits=tight)
    with pytest.raises(LimitError):
        FaceValueDecoder(TORUS, (1,), replace(tight, field_bytes=1 << 10))


@given(st.lists(st.tuples(*[st.floats(-1e300, 1e300)] * 3), min_size=1, max_size=40), OCTAHEDRA)
def test_levels_of_normals(normals, size):
    vectors = np.array([normal for normal in normals if np.abs(normal).max() > 1e-290]).reshape(-1, 3)
    levels = octahedral_levels(vectors, size)
    assert (levels >= 0).all() and (levels <= 2 * size).all()
    np.testing.assert_array_equal(canonical_levels(levels, size), levels)
    np.testing.assert_array_equal(octahedral_levels(octahedral_normals(levels, size), size), levels)
    unit = vectors / np.abs(vectors).max(axis=1, keepdims=True)
    unit /= np.linalg.norm(unit, axis=1, keepdims=True)
    assert (np.linalg.norm(np.cross(unit, octahedral_normals(levels, size)), axis=1) < 2.2 / size).all()


def test_levels_of_no_normal():
    with pytest.raises(MeshError):
        octahedral_levels([[0.0, 0.0, 0.0]], 127)
    with pytest.raises(MeshError):
        octahedral_levels([[np.nan, 0.0, 1.0]], 127)
    with pytest.raises(OptionError):
        octahedral_levels([[0.0, 0.0, 1.0]], 0)


def test_rings():
    assert ring_of_twins([5, 3, 5, 5, 9, 3], 6).tolist() == [2, 5, 3, 0, 4, 1]
    assert ring_of_twins(None, 3).tolist() == [0, 1, 2]
    assert ring_of_twins(np.empty(0, int), 0).tolist() == []


@pytest.mark.real
@pytest.mark.parametrize(("name", "most"), [("bunny_34834", 3.1), ("fandisk_6475", 1.4)])
def test_normals_of_real_meshes_are_small(meshes: Path, name: str, most: float):
    positions, faces = welded(str(meshes / "static" / f"{name}.ply"))
    edge = np.linalg.norm(positions[faces[:, 0]] - positions[faces[:, 1]], axis=1).mean()
    across = np.cross(positions[faces[:, 1]] - positions[faces[:, 0]], positions[faces[:, 2]] - positions[faces[:, 0]])
    normals = np.zeros((len(positions), 3))
    for corner in range(3):
        np.add.at(normals, faces[:, corner], across)
    normals[np.abs(normals).max(axis=1) == 0] = 1
    levels = octahedral_levels(normals, 127)
    at = np.rint(positions / edge * 32).astype(np.int32)
    payload = ValueEncoder(faces, levels, (254, 254), "normal", at).chunk(len(levels))
    vertices, found = ValueDecoder(faces, len(levels), (254, 254), "normal", at).chunk(payload, len(levels))
    np.testing.assert_array_equal(found, levels[vertices])
    assert 8 * len(payload) / len(levels) < most


@pytest.mark.real
def test_smooth_numbers_of_a_real_mesh_are_small(meshes: Path):
    positions, faces = welded(str(meshes / "static" / "bunny_34834.ply"))
    heights = rounded(positions, 8)[:, :1]
    payload = ValueEncoder(faces, heights, (255,)).chunk(len(heights))
    assert 8 * len(payload) / len(heights) < 1.2
