"""Attributes of a mesh: what they may be, and what becomes of them with their mesh."""

import numpy as np
import pytest

from bsm import Attribute, MeshError, TriangleMesh

SQUARE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [5, 5, 5]], float)
FACES = [[0, 1, 2], [0, 2, 3]]


@pytest.mark.parametrize(
    ("values", "stored"),
    [
        ([True, False], "uint8"),
        ([1, 2], "int32"),
        ([1, 1 << 31], "uint32"),
        ([0.5, 1], "float64"),
        (np.zeros(2, np.float16), "float32"),
        (np.zeros((2, 4), np.uint8), "uint8"),
        (np.zeros(2, ">i8"), "int32"),
        (np.zeros(2, ">f2"), "float32"),
        (np.zeros(2, ">f8"), "float64"),
    ],
)
def test_is_stored_in_the_narrowest_kind(values, stored):
    attribute = Attribute("a", values)
    assert attribute.values.dtype.name == stored
    assert attribute.values.shape == (2, attribute.components)
    with pytest.raises(ValueError, match="read-only"):
        attribute.values[0] = 0


@pytest.mark.parametrize(
    "wrong",
    [
        {"name": ""},
        {"name": "x" * 256},
        {"name": "a\0b"},
        {"name": "\ud800"},
        {"values": [[1, 2], [3]]},
        {"domain": "corner", "values": [1, 2, 3, 4]},
        {"domain": "corner", "values": [1, 2, 3], "indices": [[0, 1], [2]]},
        {"values": np.zeros((2, 5))},
        {"values": np.zeros((2, 2, 2))},
        {"values": [np.nan]},
        {"values": [-1, 1 << 31]},
        {"values": ["a"]},
        {"domain": "edge"},
        {"semantic": "smell"},
        {"indices": [[0, 0, 0]]},
        {"domain": "corner", "indices": [[0, 1, 2]], "values": [1, 2]},
        {"domain": "corner", "indices": [[0.0, 1, 2]], "values": [1, 2, 3]},
    ],
)
def test_what_it_cannot_be_is_refused(wrong):
    with pytest.raises(MeshError):
        Attribute(**{"name": "a", "values": [1.0], **wrong})


@pytest.mark.parametrize(
    "attributes",
    [
        [Attribute("a", np.zeros(4))],
        [Attribute("a", np.zeros(1), "face")],
        [Attribute("a", np.zeros(3), "corner")],
        [Attribute("a", np.zeros(5)), Attribute("a", np.zeros(2), "face")],
    ],
)
def test_must_be_of_its_mesh(attributes):
    with pytest.raises(MeshError):
        TriangleMesh(SQUARE, FACES, attributes)


def test_follows_its_mesh():
    corners = Attribute(
        "uv", [[0.0], [1], [2], [3], [9]], "corner", "texcoord", [[0, 1, 2], [0, 2, 3]]
    )
    mesh = TriangleMesh(
        SQUARE,
        FACES,
        [Attribute("v", np.arange(5)), Attribute("f", [7, 8], "face"), corners],
        {"name": "square"},
    )
    smaller, kept = mesh.without_isolated_vertices()
    assert kept.tolist() == [0, 1, 2, 3]
    assert smaller.metadata == {"name": "square"}
    vertex, face, corner = smaller.attributes
    assert vertex.values.ravel().tolist() == [0, 1, 2, 3]
    assert face.values.ravel().tolist() == [7, 8]
    assert corner.values.ravel().tolist() == [0, 1, 2, 3]
    assert corner.taken(kept, np.array([1])).values.ravel().tolist() == [0, 2, 3]
