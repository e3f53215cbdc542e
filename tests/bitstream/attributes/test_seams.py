"""Seams of attributes to bytes and back, and the corners that share a value."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bsm import CorruptError, TruncatedError
from bsm.bitstream.attributes.seams import NO_SEAM, Joins, encode_seams, find_seams
from bsm.bitstream.fields.corners import corners_of
from tools.payloads import decode_seams

FAN = np.array([[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]])


def brute_joins(corners, values):
    """Classes of corners, by spreading over edges across which values agree at both ends."""
    faces = corners.faces
    parent = {k: k for k in range(faces.size)}

    def root(k):
        while parent[k] != k:
            k = parent[k]
        return k

    flat, vertex = np.asarray(values).ravel(), faces.ravel()
    for k in range(faces.size):
        beyond = corners.opposite[k]
        if beyond < 0:
            continue
        here = [3 * (k // 3) + (k + i) % 3 for i in (1, 2)]
        there = [3 * (beyond // 3) + (beyond + i) % 3 for i in (1, 2)]
        pairs = [(a, b) for a in here for b in there if vertex[a] == vertex[b]]
        if all(flat[a] == flat[b] for a, b in pairs):
            for a, b in pairs:
                parent[max(root(a), root(b))] = min(root(a), root(b))
    roots = [root(k) for k in range(faces.size)]
    numbers = {r: i for i, r in enumerate(sorted(set(roots)))}
    return np.array([numbers[r] for r in roots]).reshape(-1, 3)


meshes = st.integers(1, 9).flatmap(
    lambda n: st.lists(st.lists(st.integers(0, n - 1), min_size=3, max_size=3), min_size=1, max_size=14)
)


@given(meshes, st.integers(0, 2**32 - 1), st.integers(1, 4))
def test_any_triangles_come_back(triangles, seed, most):
    faces = np.array(triangles)
    corners = corners_of(faces, int(faces.max()) + 1)
    random = np.random.default_rng(seed)
    values = random.integers(0, most, faces.shape)
    earlier = tuple(find_seams(corners, random.integers(0, 2, faces.shape)) for _ in range(seed % 4))
    seams = find_seams(corners, values)
    assert (decode_seams(encode_seams(corners, seams, earlier), corners, earlier) == seams).all()
    joins = Joins(corners, seams)
    assert (joins.faces == brute_joins(corners, values)).all()
    assert (np.diff(joins.first) > 0).all()
    assert (joins.vertices == corners.faces.ravel()[joins.first]).all()


def test_seams_of_an_attribute_before_cost_next_to_nothing():
    random = np.random.default_rng(3)
    faces = np.array([[i, i + 1, i + 2] for i in range(2000)])
    corners = corners_of(faces, 2002)
    seams = find_seams(corners, random.integers(0, 2, faces.shape))
    alone, known = encode_seams(corners, seams), encode_seams(corners, seams, (seams,))
    assert len(known) < len(alone) / 8


def test_payloads_of_other_seams_are_refused():
    corners = corners_of(FAN, 5)
    seams = find_seams(corners, np.arange(12).reshape(4, 3))
    payload = encode_seams(corners, seams)
    with pytest.raises(CorruptError):
        decode_seams(payload + bytes(9), corners)
    with pytest.raises(TruncatedError):
        strip = corners_of(np.array([[i, i + 1, i + 2] for i in range(2000)]), 2002)
        torn = find_seams(strip, np.random.default_rng(0).integers(0, 2, (2000, 3)))
        decode_seams(encode_seams(strip, torn)[:40], strip)
    assert (seams != NO_SEAM).all()
