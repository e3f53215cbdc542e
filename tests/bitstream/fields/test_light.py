"""Light grids: exact for any faces and values, the same bytes for ever, safe on damage, and not much larger."""

from __future__ import annotations

import contextlib
import tracemalloc
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bsm.bitstream import _kernels
from bsm.bitstream.connectivity.faces import encode_connectivity
from bsm.bitstream.entropy.range_coder import start_writing
from bsm.bitstream.errors import CorruptError, LimitError, MeshError, OptionError, TruncatedError
from bsm.bitstream.fields.grid import MOST_LARGEST, GridEncoder, LightDecoder, LightEncoder, grid_charge
from bsm.bitstream.limits import DEFAULT_LIMITS
from tests.bitstream.fields.fields import KINDS, SOUPS, decode, encode, values
from tests.shapes import grid_faces
from tools.measure.grids import rounded, welded

quick = settings(max_examples=150)

LARGEST = st.tuples(*[st.sampled_from([0, 1, 2, 63, 64, 1000, MOST_LARGEST])] * 3)
CHUNKS = st.sampled_from([1, 3, 20, 1000])
SEEDS = st.integers(0, 2**32 - 1)
TORUS = grid_faces(12, 9, close_rows=True, close_columns=True)
LIMITS = (99, 99, 99)


@quick
@given(SOUPS, LARGEST, KINDS, SEEDS, CHUNKS)
def test_light_grids_come_back(mesh, largest, kind, seed, chunk):
    faces, vertices = mesh
    positions = values(vertices, (0, 0, 0), largest, kind, seed)
    chunks = encode(LightEncoder(faces, positions, largest), vertices, chunk)
    found = decode(LightDecoder(faces, vertices, largest), vertices, 3, chunks)
    np.testing.assert_array_equal(found, positions)


def test_golden_bytes():
    k = np.arange(108)
    row, column = k // 9, k % 9
    bumpy = np.stack([100 * row + column**2, 90 * column, 500 + (row - 6) ** 3 + (column * 37) % 11], axis=1)
    chunks = encode(LightEncoder(TORUS, bumpy, (2047, 2047, 1023)), 108, 60)
    assert [payload.hex() for payload, _ in chunks] == GOLDEN


GOLDEN = [
    "302efcab4db683d760510ed75a590bf4f3d48f6f65fa3c04ac692184886267d300967ab48157c01c0601e8f574871ad02dd070da7bb1b4c08e0cab037564d7dd758a5786b9473e73681ac9c6dd6ba07cefae638b5629ef34a44e",
    "666c289387450d0f223f0cafdfc452c8465df0f700607537bd0ca1515a17b9dd41dca5413a644349b52fb25b2f8ad0778c33bde592",
]


def test_a_first_vertex_by_hand():
    """Nothing is known, the guess is 0 and all decisions are even, a one being the lower half.

    1, 0, 0: not the guess, not below, no farther (0, 0, 0: the last eighth); the guess; the guess (its first quarter).
    """
    none = np.empty((0, 3), np.int32)
    assert LightEncoder(none, [[1, 0, 0]], (9, 9, 9)).chunk(1) == b"\xe0"
    assert LightDecoder(none, 1, (9, 9, 9)).chunk(b"\xe0", 1)[1].tolist() == [[1, 0, 0]]


def test_vertices_come_as_they_are_numbered():
    assert LightDecoder(TORUS, 108, LIMITS).order.tolist() == list(range(108))


def test_what_was_learnt_goes_on_over_chunks():
    positions = values(108, (0, 0, 0), (999, 999, 999), "smooth", 1)
    parts = encode(LightEncoder(TORUS, positions, (999, 999, 999)), 108, 54)
    whole = LightEncoder(TORUS, positions, (999, 999, 999)).chunk(108)
    assert len(whole) <= sum(len(payload) for payload, _ in parts) <= len(whole) + 5


@pytest.mark.parametrize(
    ("positions", "largest", "error"),
    [([[0, 0, 10]], (9, 9, 9), MeshError), ([[0, 0, 0]], (9, 9), OptionError), ([[0.5, 0, 0]], (9, 9, 9), MeshError)],
)
def test_what_cannot_be_coded_is_said(positions, largest, error: type[Exception]):
    with pytest.raises(error):
        LightEncoder(np.empty((0, 3), np.int32), positions, largest)


def test_bytes_missing_or_left_over():
    payload = LightEncoder(TORUS, values(108, (0, 0, 0), LIMITS, "noise", 5), LIMITS).chunk(108)
    for length in range(0, len(payload) - 8, 5):
        with pytest.raises((TruncatedError, CorruptError)):
            LightDecoder(TORUS, 108, LIMITS).chunk(payload[:length], 108)
    decoder = LightDecoder(TORUS, 108, LIMITS)
    with pytest.raises(CorruptError):
        decoder.chunk(payload + b"\1" * 5, 108)
    with pytest.raises(OptionError):  # nothing can be read behind an error
        decoder.chunk(payload, 108)
    with pytest.raises(CorruptError):
        LightDecoder(TORUS, 108, LIMITS).chunk(b"\xff" * 8, 108)


@quick
@given(SOUPS, st.binary(max_size=300))
def test_noise_is_a_typed_error_or_values_in_range(mesh, payload):
    faces, vertices = mesh
    if not vertices:
        return
    with contextlib.suppress(CorruptError, TruncatedError):
        found = LightDecoder(faces, vertices, (5, 1000, MOST_LARGEST)).chunk(payload, vertices)[1]
        assert (found >= 0).all() and (found <= [5, 1000, MOST_LARGEST]).all()


@quick
@given(st.integers(3, 60), st.integers(0, 200), SEEDS)
def test_extremes_stay_within_their_types(vertices: int, count: int, seed: int):
    """Every value at one end of the largest range, around one vertex: sums and normals at their greatest."""
    faces = np.random.default_rng(seed).integers(0, vertices, (count, 3))
    faces[:, 0] = vertices - 1
    largest = (MOST_LARGEST,) * 3
    positions = values(vertices, (0, 0, 0), largest, "extremes", seed)
    payload = LightEncoder(faces, positions, largest).chunk(vertices)
    np.testing.assert_array_equal(LightDecoder(faces, vertices, largest).chunk(payload, vertices)[1], positions)


def test_arrays_that_do_not_fit_are_refused():
    encoder = LightEncoder(TORUS, np.zeros((108, 3), np.int32), LIMITS)
    with pytest.raises(ValueError, match="do not fit"):
        _kernels.code_light(*_state_of(encoder, slots=10))


def _state_of(encoder: LightEncoder, slots: int):
    cells = dict(zip(encoder._field.code.__code__.co_freevars, encoder._field.code.__closure__, strict=True))
    corners, light = cells["corners"].cell_contents, cells["light"].cell_contents
    return start_writing(100), corners, light._replace(slots=light.slots[:slots].copy()), 0, 108


@pytest.mark.parametrize("rows", [3, 200])
def test_the_charge_of_grids_is_enough(rows: int):
    faces = grid_faces(rows, 200)
    tracemalloc.start()
    LightDecoder(faces, 200 * rows, (MOST_LARGEST,) * 3)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak <= grid_charge(200 * rows, len(faces))


def test_limits_come_before_allocation():
    with pytest.raises(LimitError):
        LightDecoder(TORUS, 1 << 29, (1, 1, 1), replace(DEFAULT_LIMITS, field_bytes=1 << 20))


@pytest.mark.real
@pytest.mark.parametrize(("name", "bits", "most"), [("bunny_34834", 10, 1.13), ("fandisk_6475", 12, 1.17)])
def test_real_meshes_are_little_larger(meshes: Path, name: str, bits: int, most: float):
    positions, faces = welded(str(meshes / "static" / f"{name}.ply"))
    connectivity = encode_connectivity(faces, len(positions))
    places = rounded(positions, bits)[connectivity.vertex_order].astype(np.int32)
    largest, size = places.max(axis=0), len(places)
    payload = LightEncoder(connectivity.faces, places, largest).chunk(size)
    decoded = LightDecoder(connectivity.faces, size, largest).chunk(payload, size)[1]
    np.testing.assert_array_equal(decoded, places)
    assert len(payload) < most * len(GridEncoder(connectivity.faces, places, largest).chunk(size))
