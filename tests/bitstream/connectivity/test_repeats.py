"""Faces that repeat a corner, on the edges of others: they come back exactly, in few bytes, and damage is safe."""

import importlib
from collections.abc import Callable
from random import Random

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import bsm
from bsm import Attribute, BsmError, CorruptError, TriangleMesh
from bsm._core import GivenMesh
from bsm.bitstream.connectivity.faces import AS_CORNERS, ON_EDGES, encode_connectivity
from tests.bitstream.connectivity.test_faces import check_round_trip, compact
from tests.bitstream.fields.fields import SOUPS
from tests.shapes import Faces, grid_faces
from tools.payloads import decode_connectivity
from tools.surgery import frames_of, header_entries

reference = importlib.import_module("spec.reference_integers")
quick = settings(max_examples=200)
REPEATS = 29
"""The key of the header's field."""


def repeating(faces: Faces, count: int, vertices: int, random: Random) -> Faces:
    """Faces of each kind that repeats a corner, on edges of `faces` and between any of so many vertices."""
    made = []
    for _ in range(count):
        a, b = (random.randrange(vertices) for _ in range(2))
        if len(faces) and random.random() < 0.7:
            a, b = random.sample(faces[random.randrange(len(faces))].tolist(), 2)
        made.append(random.choice([(a, a, b), (a, b, b), (a, b, a), (a, a, a)]))
    return np.array(made, np.int32).reshape(-1, 3)


def plaited(random: Random, side: int = 16, share: float = 0.3) -> tuple[Faces, int]:
    """A grid of faces, and one that repeats a corner on an edge of each of some of them."""
    faces = grid_faces(side, side)
    chosen = faces[[random.random() < share for _ in faces]]
    needles = np.stack([chosen[:, 0], chosen[:, 0], chosen[:, 1]], 1)
    return compact(np.concatenate([faces, needles]))


@pytest.mark.parametrize(
    ("faces", "decoded"),
    [
        ([[0, 1, 2], [0, 0, 1]], [[0, 1, 2], [0, 0, 1]]),
        ([[0, 1, 2], [0, 1, 0]], [[0, 1, 2], [0, 0, 1]]),
        ([[0, 1, 2], [2, 1, 2]], [[0, 1, 2], [1, 2, 2]]),
        (
            [[0, 1, 2], [2, 2, 2], [2, 0, 0], [3, 0, 3]],
            [[0, 1, 2], [0, 0, 2], [2, 2, 2], [3, 0, 3]],
        ),
        (
            [[0, 1, 2], [1, 1, 2], [0, 2, 2], [0, 1, 1], [1, 1, 0]],
            [[0, 1, 2], [0, 1, 1], [0, 1, 1], [0, 2, 2], [1, 1, 2]],
        ),
        ([[0, 0, 1]], [[0, 0, 1]]),
        ([[0, 1, 2]], [[0, 1, 2]]),
    ],
    ids=["lower", "between", "upper", "elsewhere", "several", "none proper", "all proper"],
)
def test_known_faces_come_in_the_order_of_edges(
    faces: list[list[int]], decoded: list[list[int]]
) -> None:
    encoded = check_round_trip(np.array(faces), 1 + int(np.max(faces)), ON_EDGES)
    np.testing.assert_array_equal(encoded.faces, decoded)


@pytest.mark.parametrize(
    ("faces", "payload"),
    [
        ([[0, 1, 2], [0, 0, 1], [1, 2, 2]], "3e7dd1d658"),
        ([[0, 1, 2], [0, 0, 0], [0, 0, 3]], "3ab95919484e"),
    ],
)
def test_known_payloads(faces: list[list[int]], payload: str) -> None:
    vertices = 1 + int(np.max(faces))
    encoded = encode_connectivity(faces, vertices, ON_EDGES)
    assert encoded.payload.hex() == payload
    data = bytes.fromhex(payload)
    assert (
        reference.decode_connectivity(data, vertices, len(faces), repeats=ON_EDGES)
        == encoded.faces.tolist()
    )


@quick
@given(SOUPS, st.integers(0, 150), st.randoms(use_true_random=False))
def test_any_faces_round_trip(soup: tuple[Faces, int], count: int, random: Random) -> None:
    """Faces at random, shuffled; the product and the decoder of the law make the same of the payload."""
    own = soup[0]
    whole = np.concatenate([own, repeating(own, count, max(soup[1], 1), random)]).astype(np.int32)
    if not len(whole):
        return
    faces, vertices = compact(whole[random.sample(range(len(whole)), len(whole))])
    encoded = check_round_trip(faces, vertices, ON_EDGES)
    as_corners = check_round_trip(faces, vertices, AS_CORNERS)
    np.testing.assert_array_equal(encoded.vertex_order, as_corners.vertex_order)
    decoded = reference.decode_connectivity(encoded.payload, vertices, len(faces), repeats=ON_EDGES)
    assert decoded == encoded.faces.tolist()


def outcome(decode: Callable[[], object]) -> object:
    """Faces, or the name of the error."""
    try:
        return np.asarray(decode()).tolist()
    except Exception as error:
        if not isinstance(error, (BsmError, *reference.ERRORS)):
            raise
        return type(error).__name__


def outcome_of_both(payload: bytes, vertices: int, count: int) -> object:
    """The common outcome of the product and of the decoder of the law."""
    ours = outcome(lambda: decode_connectivity(payload, vertices, count, repeats=ON_EDGES))
    assert ours == outcome(
        lambda: reference.decode_connectivity(payload, vertices, count, repeats=ON_EDGES)
    )
    return ours


@quick
@given(st.randoms(use_true_random=False))
def test_damage_is_one_error_or_other_faces_for_both_decoders(random: Random) -> None:
    faces, vertices = plaited(random, 5, 0.5)
    payload = bytearray(encode_connectivity(faces, vertices, ON_EDGES).payload)
    for _ in range(random.randrange(1, 4)):
        payload[random.randrange(len(payload))] = random.randrange(256)
    outcome_of_both(bytes(payload), vertices, len(faces) + random.choice([0, 0, 1]))


def test_no_truncation_gives_the_faces_and_wrong_counts_are_noticed() -> None:
    faces, vertices = plaited(Random(3), 8)
    encoded = encode_connectivity(faces, vertices, ON_EDGES)
    payload, whole = encoded.payload, encoded.faces.tolist()
    for size in range(len(payload)):
        # Zeros in place of the bytes that are missing may put all faces onto earlier edges.
        assert outcome_of_both(payload[:size], vertices, len(faces)) != whole
    for counts in [
        (vertices + 1, len(faces)),
        (vertices, len(faces) + 1),
        (vertices, len(faces) - 1),
    ]:
        with pytest.raises(BsmError):
            decode_connectivity(payload, *counts, repeats=ON_EDGES)
    with pytest.raises(CorruptError, match="left over"):
        decode_connectivity(payload + bytes(5), vertices, len(faces), repeats=ON_EDGES)


def test_faces_on_edges_take_a_few_bits() -> None:
    faces, vertices = plaited(Random(1), 60)
    repeated = len(faces) - len(grid_faces(60, 60))
    sizes = [
        len(encode_connectivity(faces, vertices, repeats).payload)
        for repeats in (AS_CORNERS, ON_EDGES)
    ]
    assert 8 * sizes[AS_CORNERS] > 35 * repeated
    assert 8 * sizes[ON_EDGES] < 6 * repeated


def stream_of_plaited(
    count: int, *, keep_order: bool = False, **options: object
) -> tuple[TriangleMesh, bytes]:
    """A bent sheet with so many faces that repeat a corner."""
    faces = grid_faces(20, 20)
    needles = np.stack([faces[:count, 0], faces[:count, 1], faces[:count, 0]], 1)
    x, y = np.divmod(np.arange(400), 20)
    mesh = TriangleMesh(
        np.stack([x, y, np.sin(x / 3) + np.cos(y / 4)], 1), np.concatenate([needles, faces])
    )
    return mesh, bsm.encode(mesh, keep_order=keep_order, **options)


@pytest.mark.parametrize("keep_order", [False, True])
@pytest.mark.parametrize(
    "options", [{}, {"effort": "quick"}, {"preset": "paper"}, {"preset": "lossless"}]
)
def test_streams_declare_edges_where_these_are_smaller(
    options: dict[str, object], keep_order: bool
) -> None:
    for count, declared in [(0, False), (4, False), (300, True)]:
        mesh, stream = stream_of_plaited(count, keep_order=keep_order, **options)
        entries = header_entries(frames_of(stream)[0][1])
        assert (entries.get(REPEATS) == ON_EDGES) == declared
        decoded = bsm.decode(stream)
        assert len(decoded.faces) == len(mesh.faces)
        if keep_order:
            np.testing.assert_array_equal(decoded.faces, mesh.faces)


@pytest.mark.parametrize(("noisy", "declared"), [(False, True), (True, False)])
def test_values_of_attributes_count_for_the_choice(noisy: bool, declared: bool) -> None:
    """Values come in the order of faces: runs of equal ones are torn apart by that of edges."""
    mesh, _ = stream_of_plaited(300)
    count = len(mesh.faces)
    runs = np.arange(count) // 3 * 2654435761 % 2**32 if noisy else np.zeros(count, np.int64)
    values = Attribute("key", np.stack([runs, runs, runs, runs], 1).astype(np.uint32), "face")
    shuffled = TriangleMesh(
        mesh.positions, np.random.default_rng(1).permutation(mesh.faces), (values,)
    )
    stream = bsm.encode(shuffled, preset="grid14")
    assert (header_entries(frames_of(stream)[0][1]).get(REPEATS) == ON_EDGES) == declared


def test_sequences_declare_edges() -> None:
    mesh, _ = stream_of_plaited(300)
    frames = [mesh.positions + 0.1 * t * np.sin(mesh.positions) for t in range(4)]
    stream = bsm.encode_sequence(frames, mesh.faces)
    assert header_entries(frames_of(stream)[0][1]).get(REPEATS) == ON_EDGES
    positions, faces = bsm.decode_sequence(stream)
    assert positions.shape == (4, 400, 3) and len(faces) == len(mesh.faces)


@given(st.integers(1, 40))
@settings(max_examples=20, deadline=None)
def test_no_stream_is_larger_than_with_corners(count: int) -> None:
    """Brief streams, which cannot declare edges, included."""
    _, stream = stream_of_plaited(count)
    code = GivenMesh.code
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(
            GivenMesh,
            "code",
            lambda mesh, merged=None, repeats=AS_CORNERS: code(mesh, merged, AS_CORNERS),
        )
        assert len(stream) <= len(stream_of_plaited(count)[1])


@pytest.mark.parametrize("repeats", [AS_CORNERS, ON_EDGES])
def test_meshes_compare_with_their_streams_whichever_way_faces_are_coded(repeats: int) -> None:
    code = GivenMesh.code
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(
            GivenMesh,
            "code",
            lambda mesh, merged=None, repeats=repeats: code(mesh, merged, repeats),
        )
        mesh, stream = stream_of_plaited(300)
    decoded = bsm.decode(stream)
    assert bsm.compare(mesh, decoded).max_error < 0.1
