"""Faces, orders and parts as bytes: faces come back exactly, small and stable, and damage is safe."""

import contextlib
import dataclasses
from math import lgamma, log
from pathlib import Path
from random import Random

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bsm import (
    BsmError,
    CorruptError,
    LimitError,
    Limits,
    MeshError,
    OptionError,
    TruncatedError,
    read_mesh,
)
from bsm._core import Cut, GivenMesh
from bsm.bitstream.connectivity.faces import AS_CORNERS, EncodedConnectivity, encode_connectivity
from tests.bitstream.attributes.test_values import place_of
from tests.bitstream.fields.fields import SOUPS
from tests.blocks import graph_of
from tests.shapes import Faces, grid_faces, patch
from tools.payloads import decode_connectivity

quick = settings(max_examples=200)

# What the whole payload may cost, in bits per vertex: about a tenth over what it did when this was written, and far
# under what Draco spends (1.27, 0.99, 1.49, 2.52, 1.27, 0.76, 0.25, 2.45 for the first eight).
BUDGETS = {
    "bunny_34834": 1.03,
    "julius_36201": 0.64,
    "horse_48485": 1.29,
    "nicolo": 2.36,
    "fandisk_6475": 0.89,
    "block": 0.46,
    "twelve_dodecahedron": 0.06,
    "armadillo_12502": 2.02,
    "dragon_437645": 2.5,
    "dragon_22998": 6.0,
    "scan_angel": 1.03,
}


def compact(faces: Faces) -> tuple[Faces, int]:
    """The same faces over the vertices that they use, and how many these are."""
    used, numbers = np.unique(faces, return_inverse=True)
    return numbers.reshape(-1, 3).astype(np.int32), len(used)


def check_round_trip(
    faces: Faces, vertex_count: int, repeats: int = AS_CORNERS
) -> EncodedConnectivity:
    """Decode, compare with what was given, and encode again."""
    encoded = encode_connectivity(faces, vertex_count, repeats)
    decoded = decode_connectivity(encoded.payload, vertex_count, len(faces), repeats=repeats)
    assert decoded.dtype == np.int32
    np.testing.assert_array_equal(decoded, encoded.faces)
    np.testing.assert_array_equal(np.sort(encoded.vertex_order), np.arange(vertex_count))
    np.testing.assert_array_equal(np.sort(encoded.face_order), np.arange(len(faces)))
    original, mapped = np.asarray(faces)[encoded.face_order], encoded.vertex_order[decoded]
    same = [(np.roll(original, k, axis=1) == mapped).all(axis=1) for k in range(3)]
    assert np.logical_or.reduce(same).all()

    again = encode_connectivity(decoded, vertex_count, repeats)
    assert again.payload == encoded.payload
    np.testing.assert_array_equal(again.faces, decoded)
    np.testing.assert_array_equal(again.vertex_order, np.arange(vertex_count))
    return encoded


@pytest.mark.parametrize(
    "faces",
    [
        [[0, 1, 2]],
        [[0, 0, 0]],
        [[0, 1, 1]],
        [[0, 1, 2], [0, 1, 2]],
        [[0, 1, 2], [0, 2, 1]],
        [[0, 1, 2], [1, 0, 3], [0, 1, 4]],
        [[0, 1, 2], [0, 1, 3]],
        [[0, 1, 2], [2, 3, 4]],
        [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2], [0, 4, 5], [0, 6, 4], [4, 6, 5], [0, 5, 6]],
        [[0, 1, 2], [3, 3, 4], [2, 1, 5], [4, 6, 4]],
    ],
    ids=[
        "one",
        "point",
        "needle",
        "twice",
        "pillow",
        "book",
        "turned",
        "bowtie",
        "kissing",
        "mixed",
    ],
)
def test_closed_forms_round_trip(faces: list[list[int]]) -> None:
    check_round_trip(np.array(faces), 1 + int(np.max(faces)))


@quick
@given(SOUPS, st.randoms(use_true_random=False))
def test_any_triangles_round_trip(soup: tuple[Faces, int], random: Random) -> None:
    """At random, around a vertex, along strips, and of tori with holes, flipped and repeated faces."""
    faces = soup[0].tolist()
    random.shuffle(faces)
    if faces:
        check_round_trip(*compact(np.array(faces)))


@quick
@given(st.integers(4, 60), st.integers(0, 2**32 - 1))
def test_triangulated_spheres_round_trip(size: int, seed: int) -> None:
    """Split random faces of a tetrahedron: valences from 3 to very high."""
    rng = np.random.default_rng(seed)
    faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]
    for vertex in range(4, size):
        a, b, c = faces.pop(int(rng.integers(0, len(faces))))
        faces += [[a, b, vertex], [b, c, vertex], [c, a, vertex]]
    encoded = check_round_trip(np.array(faces)[rng.permutation(len(faces))], size)
    assert len(encoded.payload) < 8 + size


def test_regular_mesh_costs_almost_nothing() -> None:
    faces = grid_faces(100, 80, (True, True))
    assert len(check_round_trip(faces, 8000).payload) < 40


def test_many_components_and_long_fans() -> None:
    parts = np.arange(3000).reshape(-1, 3)
    assert 8 * len(check_round_trip(parts, 3000).payload) < 0.2 * 3000
    wheel = np.stack(
        [np.zeros(5000, int), 1 + np.arange(5000), 1 + (np.arange(5000) + 1) % 5000], -1
    )
    assert len(check_round_trip(wheel, 5001).payload) < 40
    book = np.stack([np.zeros(5000, int), np.ones(5000, int), 2 + np.arange(5000)], -1)
    check_round_trip(book, 5002)


@pytest.mark.parametrize(
    "sheets", ["same", "same, by pairs", "reversed", "reversed, by pairs", "three"]
)
def test_sheets_that_lie_on_each_other_stay_whole(sheets: str) -> None:
    """Cut at each edge of more than two faces, two take 52 to 59 bits a vertex."""
    one = grid_faces(30, 40)
    back = one[:, ::-1]
    faces = {
        "same": np.concatenate([one, one]),
        "same, by pairs": np.repeat(one, 2, axis=0),
        "reversed": np.concatenate([one, back]),
        "reversed, by pairs": np.stack([one, back], axis=1).reshape(-1, 3),
        "three": np.concatenate([one, back, one]),
    }[sheets]
    bits = 8 * len(check_round_trip(faces, 1200).payload) / 1200
    # The number of a vertex that comes again takes 10.2.
    assert bits < (26 if sheets == "three" else 13)


def test_orders_do_not_depend_on_numbering_beyond_the_start() -> None:
    faces = grid_faces(12, 17)
    rng = np.random.default_rng(5)
    numbers = rng.permutation(12 * 17)
    a, b = encode_connectivity(faces, 204), encode_connectivity(numbers[faces], 204)
    assert a.payload == b.payload
    np.testing.assert_array_equal(numbers[a.vertex_order], b.vertex_order)


@pytest.mark.parametrize(
    ("faces", "count", "message"),
    [
        (np.zeros((0, 3), int), 0, "shape"),
        (np.zeros((4, 4), int), 1, "shape"),
        (np.zeros((4, 3)), 1, "integers"),
        (np.array([[0, 1, 3]]), 3, "outside"),
        (np.array([[0, 1, -1]]), 3, "outside"),
        (np.array([[0, 1, 3]]), 4, "vertex 2 is in no face"),
    ],
)
def test_bad_meshes_are_refused(faces: np.ndarray, count: int, message: str) -> None:
    with pytest.raises(MeshError, match=message):
        encode_connectivity(faces, count)


def _hostile_cases() -> dict[str, tuple[Faces, int]]:
    rng = np.random.default_rng(8)
    holes = grid_faces(20, 20)
    holes = holes[rng.random(len(holes)) < 0.8]
    soup = rng.integers(0, 60, (150, 3))
    return {
        "torus": (grid_faces(15, 20, (True, True)), 300),
        "holes": compact(holes),
        "soup": compact(soup),
    }


def test_a_seam_that_repeats_a_vertex_before_there_is_one_is_harmless() -> None:
    faces = np.array([[0, 1, 2], [0, 1, 3], [0, 1, 4], [2, 2, 5]])
    payload = encode_connectivity(faces, 6).payload
    for index in range(len(payload)):
        for value in range(256):
            with contextlib.suppress(CorruptError, TruncatedError):
                decode_connectivity(payload[:index] + bytes([value]) + payload[index + 1 :], 6, 4)


@pytest.mark.parametrize("name", ["torus", "holes", "soup"])
def test_every_truncation_and_wrong_counts_are_noticed(name: str) -> None:
    faces, count = _hostile_cases()[name]
    payload = encode_connectivity(faces, count).payload
    for size in range(len(payload) - 4):
        with pytest.raises((TruncatedError, CorruptError)):
            decode_connectivity(payload[:size], count, len(faces))
    for vertices, triangles in [
        (count + 1, len(faces)),
        (count, len(faces) + 1),
        (0, 0),
        (9 * len(faces), len(faces)),
    ]:
        with pytest.raises(BsmError):
            decode_connectivity(payload, vertices, triangles)
    with pytest.raises(CorruptError, match="left over"):
        decode_connectivity(payload + bytes(5), count, len(faces))


def test_counts_over_the_limits_are_refused() -> None:
    for name, most in (("vertices", 10), ("faces", 20)):
        with pytest.raises(LimitError, match=name):
            decode_connectivity(b"", 11, 21, dataclasses.replace(Limits(), **{name: most}))


@pytest.mark.real
def test_real_meshes_round_trip_in_few_bits(meshes: Path) -> None:
    spent = {}
    for path in sorted((meshes / "static").glob("*.ply")):
        faces, count = compact(read_mesh(path).mesh.faces)
        spent[path.stem] = 8 * len(check_round_trip(faces, count).payload) / count
    over = {name: spent[name] for name, budget in BUDGETS.items() if spent[name] > budget}
    assert not over


def order_of(vertices) -> bytes:
    """The order of a strip whose vertices had these numbers, and whose faces were as the decoder suggests."""
    vertices = np.asarray(vertices, np.int32)
    strip = np.arange(len(vertices) - 2, dtype=np.int32)[:, None] + np.arange(3, dtype=np.int32)
    strip[1::2] = strip[1::2, [1, 0, 2]]
    named = vertices[strip]
    named = np.take_along_axis(named, (named.argmin(axis=1)[:, None] + np.arange(3)) % 3, axis=1)
    return place_of(named[np.lexsort(np.sort(named, axis=1).T)]).order(np.zeros((len(vertices), 3)))


def test_random_order_costs_about_its_entropy_and_runs_cost_little() -> None:
    size = 5000
    order = np.random.default_rng(0).permutation(size)
    assert 8 * len(order_of(order)) < 1.1 * lgamma(size + 1) / log(2)
    assert len(order_of(np.arange(size))) < 80
    assert len(order_of(np.arange(size)[::-1])) < 100
    assert len(order_of(np.arange(size).reshape(50, 100).T.ravel())) < 0.2 * size


@pytest.mark.parametrize(
    ("faces", "places"),
    [([[0, 1, 3]], [0, 1, 2]), ([[-1, 0, 1]], [0, 1, 2]), ([[0, 1, 2]], [0, 1, 3])],
)
def test_numbers_that_are_not_there_are_refused(faces: list[list[int]], places: list[int]) -> None:
    mesh = GivenMesh(np.array(faces, np.int32), np.array(places, np.int32))
    with pytest.raises(OptionError, match="do not fit together"):
        mesh.join(True, True)


@pytest.mark.parametrize(
    "call", ["carry", "code", "order", "join carry", "join none", "join order", "join code few"]
)
def test_what_needs_joined_and_coded_faces_is_refused_without(call: str) -> None:
    mesh = GivenMesh(np.array([[0, 1, 2]], np.int32), np.arange(3, dtype=np.int32))
    calls = {
        "join": lambda: mesh.join(True, True),
        "code": mesh.code,
        "none": lambda: mesh.code(np.zeros(0, np.int32)),
    }
    calls |= {
        "order": lambda: mesh.order(np.zeros((3, 3))),
        "few": lambda: mesh.order(np.zeros((2, 3))),
    }
    calls["carry"] = lambda: mesh.carry(True, "a", np.zeros((3, 1)), 7, 0, 0, None, 0, 0.0)
    *before, last = (calls[name] for name in call.split())
    for possible in before:
        possible()
    with pytest.raises(OptionError):
        last()


def test_compact_parts_cost_little():
    graph = graph_of(patch(60, 60))
    labels = np.add.outer(np.arange(60) // 20 * 3, np.arange(60) // 20).ravel().astype(np.int32)
    data = Cut(graph.offsets, graph.neighbors).write(labels, 9)
    assert 8 * len(data) < 0.2 * len(labels)
