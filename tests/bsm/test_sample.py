"""The sample of the demo, and its picture."""

import numpy as np
import pytest

from bsm.evaluation.sample import knot
from bsm.pictures import render, view_matrix


def test_the_sample_is_a_closed_oriented_torus():
    mesh = knot(2000)
    directed = np.concatenate([mesh.faces[:, [0, 1]], mesh.faces[:, [1, 2]], mesh.faces[:, [2, 0]]])
    assert len(np.unique(directed, axis=0)) == len(directed)
    assert set(map(tuple, directed)) == set(map(tuple, directed[:, ::-1]))
    assert len(mesh.positions) - len(directed) // 2 + len(mesh.faces) == 0
    corners = mesh.positions[mesh.faces]
    volume = np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6
    assert volume > 0, "the faces look outwards"


def test_the_nearest_face_is_drawn():
    far, near = [0, 0, 0], [0, 0, 1]
    positions = np.array([[-1, -1, 0], [1, -1, 0], [0, 1, 0]] * 2) + np.repeat([far, near], 3, axis=0)
    faces = np.array([[0, 1, 2], [3, 4, 5]], np.int32)
    colors = np.array([[1.0, 0, 0], [0, 0, 1.0]])
    view = view_matrix(-90, 90)
    for order in ([0, 1], [1, 0]):
        image = render(positions, faces[order], 64, view=view, colors=colors[order])
        red, green, blue = image[40, 32]
        assert blue > 0.3
        assert red == green == 0
    assert image[0, 0] == pytest.approx([1, 1, 1])
