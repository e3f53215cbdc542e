"""Faces in pieces: the first of them are known with the first piece, and nothing is different from the whole."""

from __future__ import annotations

import contextlib
import dataclasses

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import Delaunay

from bsm.bitstream.connectivity.faces import (
    ConnectivityDecoder,
    EncodedConnectivity,
    Known,
    decode_connectivity,
    encode_connectivity,
)
from bsm.bitstream.errors import BsmError, CorruptError, LimitError, TruncatedError
from bsm.bitstream.limits import DEFAULT_LIMITS
from tests.bitstream.connectivity.test_faces import SOUPS, compact
from tests.shapes import Faces, grid_faces

COUNT = 240
FACES = Delaunay(np.random.default_rng(5).random((COUNT, 2))).simplices.astype(np.int32)
"""Irregular, and with a border."""


def decoded(pieces: list[bytes], vertices: int, faces: int, cuts: list[int]) -> list[Known]:
    decoder = ConnectivityDecoder(vertices, faces, cuts=cuts)
    return [decoder.take(piece) for piece in pieces]


def irregular(*cut_behind: int) -> tuple[EncodedConnectivity, list[bytes]]:
    encoded = encode_connectivity(FACES, COUNT, cut_behind)
    return encoded, list(encoded.pieces(encoded.cuts))


def check_pieces(faces: Faces, vertices: int, cut_behind: list[int]) -> None:
    """Whatever cuts there are, the pieces are the payload, and each makes the first of the faces of the whole."""
    whole = encode_connectivity(faces, vertices)
    encoded = encode_connectivity(faces, vertices, cut_behind)
    assert encoded.payload == whole.payload
    cuts = encoded.cuts
    pieces = encoded.pieces(cuts)
    assert b"".join(pieces).rstrip(b"\0") == whole.payload.rstrip(b"\0")
    known = decoded(list(pieces), vertices, len(faces), [cut.faces for cut in cuts])
    for cut, some in zip(cuts, known[:-1], strict=True):
        assert (len(some.faces), some.vertices) == (cut.faces, cut.vertices)
        np.testing.assert_array_equal(some.faces, whole.faces[: cut.faces])
        assert some.faces.max() < cut.vertices
    np.testing.assert_array_equal(known[-1].faces, whole.faces)
    assert known[-1].vertices == vertices


@settings(max_examples=60)
@given(st.lists(st.integers(1, len(FACES) - 1), min_size=1, max_size=7, unique=True).map(sorted))
def test_a_surface_in_pieces(cut_behind):
    encoded, _ = irregular(*cut_behind)
    assert [cut.faces for cut in encoded.cuts] == cut_behind
    check_pieces(FACES, COUNT, cut_behind)


@settings(max_examples=200)
@given(SOUPS, st.data())
def test_any_faces_in_pieces(soup, data):
    faces, vertices = compact(np.array(soup, np.int32))
    cuts = data.draw(st.lists(st.integers(1, len(faces)), max_size=4, unique=True).map(sorted))
    check_pieces(faces, vertices, cuts)


def test_what_is_sewn_together_comes_whole():
    fan = np.array([[0, 1, 2], [0, 3, 4], [0, 5, 6]], np.int32)  # three triangles that share a vertex
    assert encode_connectivity(fan, 7, [1, 2]).cuts == ()


def test_faces_that_repeat_a_corner_come_last():
    faces = np.array([[0, 1, 2], [2, 1, 3], [3, 3, 4]], np.int32)
    assert [cut.faces for cut in encode_connectivity(faces, 5, [1, 2]).cuts] == [1]


def test_a_piece_must_end_where_its_faces_do():
    encoded, (first, second) = irregular(200)
    cut, payload = encoded.cuts[0], encoded.payload
    for size in (cut.size - 1, cut.size + 1, cut.size + 9):
        with pytest.raises(CorruptError, match="pieces"):
            decoded([payload[:size], payload[size:]], COUNT, len(FACES), [200])
    with pytest.raises((CorruptError, TruncatedError)):
        decoded([first[:-5], second], COUNT, len(FACES), [200])
    with pytest.raises(CorruptError):
        decoded([first, second + bytes(5)], COUNT, len(FACES), [200])
    with pytest.raises((CorruptError, TruncatedError)):
        decoded([first, second[:-9]], COUNT, len(FACES), [200])
    with pytest.raises(CorruptError):
        decoded([first, second], COUNT, len(FACES), [190])


def test_a_first_piece_that_is_nothing():
    with pytest.raises(TruncatedError):
        ConnectivityDecoder(COUNT, len(FACES), cuts=[200]).take(b"")


def test_pieces_of_what_has_none():
    fan = np.array([[0, 1, 2], [0, 3, 4], [0, 5, 6]], np.int32)
    with pytest.raises(CorruptError, match="pieces"):
        ConnectivityDecoder(7, 3, cuts=[1]).take(encode_connectivity(fan, 7).payload)
    faces = np.array([[0, 1, 2], [2, 1, 3], [3, 3, 4]], np.int32)
    with pytest.raises(CorruptError, match="pieces"):
        ConnectivityDecoder(5, 3, cuts=[2]).take(encode_connectivity(faces, 5).payload)


def test_the_last_bytes_that_an_encoder_saves_are_there_for_the_piece_that_needs_them():
    """A piece ends with all that a reader has taken, which may be more than what the whole payload has."""
    faces = np.array([[0, 1, 2], [2, 1, 3]], np.int32)
    encoded = encode_connectivity(faces, 4, [1])
    first, second = encoded.pieces(encoded.cuts)
    assert len(first) == encoded.cuts[0].size >= 4
    assert len(first + second) >= len(encoded.payload)
    assert len(decoded([first, second], 4, 2, [1])[1].faces) == 2


@settings(max_examples=200)
@given(st.data())
def test_damaged_pieces_are_typed_errors(data):
    _, pieces = irregular(100, 300)
    number = data.draw(st.integers(0, 2))
    damaged = bytearray(pieces[number])
    damaged[data.draw(st.integers(0, len(damaged) - 1))] ^= data.draw(st.integers(1, 255))
    pieces[number] = bytes(damaged)
    with contextlib.suppress(BsmError):
        decoded(pieces, COUNT, len(FACES), [100, 300])


def test_limits_hold_for_what_a_piece_has():
    """A first piece of many faces on few vertices, of a stream that claims many."""
    strip = grid_faces(2, 60)
    encoded = encode_connectivity(strip, 120, [40])
    limits = dataclasses.replace(DEFAULT_LIMITS, memory=0, memory_per_byte=0, memory_per_vertex=460)
    with pytest.raises(LimitError):
        ConnectivityDecoder(120, len(strip), limits, [40]).take(encoded.pieces(encoded.cuts)[0])
    wide = dataclasses.replace(limits, memory_per_vertex=500)
    assert ConnectivityDecoder(120, len(strip), wide, [40]).take(encoded.pieces(encoded.cuts)[0]).vertices == 42
    np.testing.assert_array_equal(decode_connectivity(encoded.payload, 120, len(strip)), encoded.faces)
