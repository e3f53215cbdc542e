"""Vertices at one position become one, and come back where their order is kept."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from bsm import EncodeOptions, Encoder, TriangleMesh, decode
from bsm.codec.geometry.graph import edges_of
from bsm.codec.static.preamble_encoding import join
from tests.shapes import boxes, patch, soup, together, torus


def test_soup_becomes_the_surface_that_it_is() -> None:
    mesh = torus(20, 12)
    encoder = Encoder(soup(mesh))
    assert len(encoder.mesh.positions) == len(mesh.positions)
    assert encoder.notes == ("merged 1200 vertices with others at the same position",)
    assert len(encoder.encode()) < 1.2 * len(Encoder(mesh).encode())


def test_every_given_vertex_is_reported_its_decoded_one() -> None:
    mesh = soup(patch(9, 7))
    given = TriangleMesh(np.concatenate([[[5.0, 5.0, 5.0]], mesh.positions]), mesh.faces + 1)
    encoder = Encoder(given, EncodeOptions(grid=20))
    decoded = decode(encoder.encode())
    index = encoder.vertex_index
    assert index[0] == -1
    assert np.abs(decoded.positions[index[1:]] - given.positions[1:]).max() < 1e-5
    rows = np.sort(decoded.faces, axis=1)
    assert np.array_equal(rows, np.sort(index[given.faces[encoder.face_order]], axis=1))
    assert np.abs(given.positions[encoder.vertex_order] - decoded.positions).max() < 1e-5


def test_negative_zero_is_zero() -> None:
    corners = [(0.0, 0, 0), (1, 0, 0), (0, 1, 0), (-0.0, 0, 0), (1, -0.0, 0), (1, 1, 0)]
    assert len(join(TriangleMesh(corners, [(0, 1, 2), (3, 4, 5)]), keep=False).mesh.positions) == 4


def test_faces_that_lose_their_area_are_left_out_unless_none_would_be_left() -> None:
    corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 0)]
    joined = join(TriangleMesh(corners, [(0, 1, 2), (0, 3, 1)]), keep=False)
    assert len(joined.mesh.faces) == 1
    assert joined.notes[1] == "left out 1 face without area"
    assert len(join(TriangleMesh(corners, [(0, 3, 1)]), keep=False).mesh.faces) == 1
    assert len(join(TriangleMesh(corners, [(0, 1, 2), (0, 3, 1)]), keep=True).mesh.faces) == 2


def test_bodies_that_touch_stay_bodies_unless_they_share_a_vertex() -> None:
    four, two = boxes(*np.ndindex(1, 2, 2)), soup(boxes((0, 0, 0), (1, 1, 0)))
    mixed, apart = (
        TriangleMesh(m.positions, np.random.default_rng(1).permutation(m.faces))
        for m in (four, two)
    )
    assert len(join(apart, keep=False).mesh.positions) == 16
    flap = TriangleMesh([(0, 0, 0), (1, 0, 0), (0, -1, -1)], [(0, 1, 2)])
    for mesh in (four, mixed, together(four, flap), soup(four), together(soup(four), patch(2, 2))):
        faces = join(mesh, keep=False).mesh.faces[:48]
        assert faces.max() == 31 and (edges_of(faces)[2] == 2).all()
    # At one place.
    sharing = TriangleMesh(four.positions, np.where(four.faces == 12, 5, four.faces))
    assert len(join(sharing, keep=False).mesh.positions) == 12 + 2 * 8


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=40)
def test_a_kept_order_gives_back_the_given_mesh(seed: int) -> None:
    random = np.random.default_rng(seed)
    size = int(random.integers(3, 40))
    places = random.integers(0, 3, (size, 3)).astype(float)  # many at one position
    mesh = TriangleMesh(places, random.integers(0, size, (int(random.integers(1, 40)), 3)))
    decoded = decode(Encoder(mesh, EncodeOptions(grid=2, keep_order=True)).encode())
    assert np.array_equal(decoded.faces, mesh.faces)
    assert decoded.positions.shape == mesh.positions.shape
    used = np.zeros(size, bool)
    used[mesh.faces] = True
    low, extent = places[used].min(axis=0), np.ptp(places[used], axis=0).max() or 1.0
    assert np.abs(decoded.positions[used] - places[used]).max() <= extent / 3 * 0.5 + 1e-6
    assert np.array_equal(decoded.positions[~used], places[~used]), low
