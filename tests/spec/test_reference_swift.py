"""The product and the decoder of swift attributes that was written from the law treat the same payloads alike."""

import importlib
import sys

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bsm.bitstream.container.header import MOST_GRID
from spec import reference_integers
from tests.bitstream.fields.fields import KINDS, SOUPS, SWIFT, encode, field_of, offered
from tests.spec.test_reference_payloads import CHUNKS, SEEDS, damaged, product, quick, read

sys.modules.setdefault("reference_integers", reference_integers)  # as scripts in spec/ import it
reference = importlib.import_module("spec.reference_swift")


def expected(reader):
    """The rows of a payload and their values, as the product has them."""
    first = 0

    def chunk(payload: bytes, count: int):
        nonlocal first
        rows = range(first, first + count)
        values = reader.read(payload, count)
        first += count
        return [[*rows], [values[row] for row in rows]]

    return chunk


@pytest.mark.parametrize("name", SWIFT)
@quick
@given(SOUPS, st.sampled_from([0, 9, MOST_GRID]), KINDS, SEEDS, CHUNKS, st.data())
def test_rows(name, mesh, reach, kind, seed, chunk, data):
    faces, vertices = mesh
    if not vertices:
        return
    normals, swift = name.startswith("normal"), int(name[-1])
    most = st.sampled_from([0, 1, 63, 1000, MOST_GRID])
    largest = [data.draw(most) for _ in range(data.draw(st.integers(1, 4)))]
    if normals:
        largest = [2 * data.draw(st.sampled_from([1, 2, 127, 32767]))] * 2
    if name.startswith("texcoord"):
        largest = [data.draw(most), data.draw(most)]
    at = np.random.default_rng(seed).integers(0, reach + 1, (vertices, 3)) if reach else None
    field = field_of(name, faces, vertices, largest, at)
    chunks = encode(field, offered(name, vertices, largest, kind, seed), chunk)
    which = data.draw(st.integers(0, len(chunks) - 1))
    broken = [*chunks[:which], (damaged(chunks[which][0], data), chunks[which][1]), *chunks[which + 1 :]]
    for payloads in (chunks, broken):
        geometry = None if at is None else at.tolist()
        rows = reference.Rows(faces.tolist(), vertices, largest, swift, normals, geometry)
        assert read(expected(rows), payloads) == read(product(field), payloads)
