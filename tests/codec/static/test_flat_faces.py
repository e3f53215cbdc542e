"""Faces without area are counted among small ones only."""

import numpy as np
import pytest

from bsm.codec.static.choice.bounds import FLAT, count_flat


def direct(positions, faces):
    corners = positions[faces]
    areas = (
        np.linalg.norm(
            np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
        )
        / 2.0
    )
    sides = np.square(corners - np.roll(corners, 1, axis=1)).sum(axis=2).max(axis=1)
    return int(np.count_nonzero(areas <= FLAT * sides))


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_faces_on_lines_and_at_points_are_counted(scale):
    points = np.random.default_rng(3).random((60, 3)) * scale
    points[10:20] = np.outer(np.arange(10.0), [1.0, 0.0, 0.0]) * scale  # on a line
    points[20:25] = points[20]  # at a point
    faces = np.random.default_rng(4).integers(0, 60, (3000, 3)).astype(np.int32)
    lines = np.array([[10, 11, 12], [13, 15, 19], [20, 21, 22], [0, 0, 1]], np.int32)
    assert count_flat(points, lines) == 4
    assert count_flat(points, faces) == direct(points, faces) > 4


def test_small_faces_with_area_are_not_counted():
    points = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [1e-7, 0, 0], [0, 1e-7, 0]])
    faces = np.array([[0, 1, 2], [0, 3, 4]], np.int32)
    assert count_flat(points, faces) == 0
