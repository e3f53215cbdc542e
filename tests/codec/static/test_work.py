"""What a decoder spends is bounded, whatever the faces are."""

import numpy as np
import pytest

from bitstream.errors import LimitError
from bitstream.limits import DEFAULT_LIMITS, Limits
from codec.geometry.mesh import TriangleMesh
from codec.static.decoder import decode
from codec.static.encoder import encode
from codec.static.options import EncodeOptions
from codec.static.work import Allowance, dictionary_work


def soup(vertices, faces):
    """Triangles between vertices at random: everything is beside everything."""
    random = np.random.default_rng(0)
    corners = random.integers(0, vertices, (faces, 3))
    corners = corners[(corners != np.roll(corners, 1, axis=1)).all(axis=1)]
    return TriangleMesh(random.normal(size=(vertices, 3)), corners).without_isolated_vertices()[0]


def test_a_soup_costs_more_than_its_header_says_and_is_refused():
    mesh = soup(250, 500)
    size = len(mesh.positions)
    stream = encode(mesh, EncodeOptions(block_size=size, overlap=1.0, coefficients=4, detail=0.0, smoothing=0.0))
    assert len(decode(stream).positions) == size
    claimed = dictionary_work(1, size, 4, 12)
    with pytest.raises(LimitError, match="work"):
        decode(stream, Limits(work=1.01 * claimed))
    with pytest.raises(LimitError, match="work"):
        decode(stream, Limits(work=0.99 * claimed))


def test_an_allowance_is_spent_by_and_by():
    allowance = Allowance(Limits(work=10.0))
    allowance.spend(6.0)
    allowance.spend(4.0)
    with pytest.raises(LimitError, match="11"):
        allowance.spend(1.0)


def test_the_default_allows_large_meshes():
    DEFAULT_LIMITS.check("work", dictionary_work(10_000, 1000, 100, 12))
