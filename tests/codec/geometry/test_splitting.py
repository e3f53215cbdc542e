"""Vertices split where corners differ."""

import numpy as np

from bsm import Attribute, TriangleMesh
from bsm.codec.geometry.welding import row_numbers, split_by_attributes

SQUARE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [5, 5, 5]], float)
FACES = np.array([[0, 1, 2], [0, 2, 3]])


def test_a_seam_splits_the_vertices_on_it():
    corners = Attribute("uv", [[0, 0], [1, 0], [1, 1], [9, 9], [0, 1]], "corner", "texcoord", [[0, 1, 2], [3, 2, 4]])
    flat = Attribute("group", [7, 8], "face")
    heat = Attribute("heat", [0.0, 1.0, 2.0, 3.0, 4.0])
    mesh = split_by_attributes(TriangleMesh(SQUARE, FACES, (corners, flat, heat), {"name": "x"}))
    assert len(mesh.positions) == 6  # vertex 0 twice, and the one of no face
    uv, group, hot = mesh.attributes
    assert (uv.domain, uv.semantic, group.domain) == ("vertex", "texcoord", "face")
    assert (uv.values[mesh.faces] == corners.values[corners.indices]).all()
    assert (mesh.positions[mesh.faces] == SQUARE[FACES]).all()
    assert (hot.values[mesh.faces] == heat.values[FACES]).all()
    assert hot.values[-1] == 4.0 and (mesh.positions[-1] == 5).all()
    assert mesh.metadata == {"name": "x"}


def test_without_seams_nothing_is_split():
    corners = Attribute("uv", SQUARE[:, :2], "corner", "texcoord", FACES)
    mesh = split_by_attributes(TriangleMesh(SQUARE, FACES, (corners,)))
    assert (mesh.faces == FACES).all() and (mesh.positions == SQUARE).all()
    bare = TriangleMesh(SQUARE, FACES)
    assert split_by_attributes(bare) is bare


def test_rows_are_numbered_without_gaps():
    assert row_numbers(np.array([[1.0, 2.0], [0.0, 5.0], [1.0, 2.0], [-0.0, 5.0]])).tolist() == [1, 0, 1, 0]
    assert row_numbers(np.zeros((0, 2))).tolist() == []
