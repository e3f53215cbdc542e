"""Neighborhoods and vertex updates against definitions written out."""

import numpy as np
import pytest

from bsm.codec.denoise.surface import Topology, face_geometry, follow_normals, without_first
from tests.codec.denoise.denoise_shapes import cube, grid, members


def test_patches_hold_the_faces_that_share_a_vertex() -> None:
    positions, faces = cube(3)
    topology = Topology(faces, len(positions))
    sets = [set(face) for face in faces.tolist()]
    for f in range(0, len(faces), 7):
        around = members(topology.patches, f)
        assert around[0] == f
        assert sorted(around) == [g for g in range(len(faces)) if sets[f] & sets[g]]
        assert members(without_first(topology.patches), f) == around[1:]
    expected = [(f, g) for f in range(len(faces)) for g in range(f + 1, len(faces)) if len(sets[f] & sets[g]) == 2]
    assert sorted(map(tuple, topology.pairs.tolist())) == expected


def test_the_hub_of_a_wheel_does_not_make_everybody_a_neighbor() -> None:
    spokes = np.arange(200)
    faces = np.stack([spokes, (spokes + 1) % 200, np.full(200, 200)], axis=1).astype(np.int32)
    topology = Topology(faces, 201)
    assert np.diff(topology.patches.starts).max() == 65
    assert sorted(members(topology.patches, 100)) == list(range(68, 133))
    assert {1, 199} < set(members(topology.patches, 0))


def test_vertices_follow_the_true_normals_to_the_plane() -> None:
    flat, faces = grid(10)
    noisy = flat + np.random.default_rng(0).normal(0, 0.2, flat.shape) * [0, 0, 1]
    topology = Topology(faces, len(flat))
    up = np.tile([0.0, 0.0, 1.0], (len(faces), 1))
    moved = follow_normals(noisy, topology, up, 200)
    assert np.ptp(moved[:, 2]) < 0.02 * np.ptp(noisy[:, 2])
    assert (moved[:, :2] == flat[:, :2]).all()
    # One update by hand: the mean height of the centroids around.
    once = follow_normals(noisy, topology, up, 1)
    heights = face_geometry(noisy, faces).centroids[members(topology.around, 60), 2]
    assert once[60, 2] == pytest.approx(heights.mean())
    free = ~topology.boundary
    held = follow_normals(noisy, topology, up, 3, free)
    assert (held[~free] == noisy[~free]).all() and (held[free] != noisy[free]).any(axis=1).all()
