"""Time and memory of one mesh, and links."""

import numpy as np
import pytest

from bsm.codec.geometry.graph import graph_of_faces
from tests.shapes import tetrahedron, torus
from tools.measure.speed import Delivery, break_even, subdivide


def test_subdividing_keeps_the_surface_and_its_topology():
    for mesh in (tetrahedron(), torus()):
        fine = subdivide(mesh)
        edges = len(mesh.faces) * 3 // 2
        assert len(fine.positions) == len(mesh.positions) + edges and len(fine.faces) == 4 * len(mesh.faces)
        assert len(graph_of_faces(fine.faces, len(fine.positions)).neighbours) == 2 * (2 * edges + 3 * len(mesh.faces))

        def areas(m):
            a, b, c = (m.positions[m.faces[:, i]] for i in range(3))
            return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2

        assert np.isclose(areas(fine), areas(mesh))


def test_the_link_on_which_both_are_as_quick():
    ours, theirs = Delivery(1_000, 7.0, 0.05), Delivery(11_000, 6.9, 0.01)
    assert break_even(ours, theirs) == pytest.approx(2.0)  # 80,000 bits in 40 ms
    assert break_even(Delivery(1_000, 7.0, 0.01), theirs) == float("inf")
    assert break_even(Delivery(11_000, 7.0, 0.05), theirs) == 0.0
