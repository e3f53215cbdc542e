"""The product and the decoder of swift attributes that was written from the law treat the same payloads alike."""

import importlib
import sys
from itertools import permutations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import bsm
from bsm._core import turned_tangents
from bsm.bitstream.container.header import MOST_GRID, TANGENTS
from spec import reference_integers
from tests.bitstream.fields.fields import KINDS, SOUPS, SWIFT, encode, field_of, offered
from tests.spec.test_reference_payloads import CHUNKS, SEEDS, damaged, product, quick, read
from tools.vectors.store import read_manifest
from tools.vectors.swift_rows import rows_of

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
    broken = [
        *chunks[:which],
        (damaged(chunks[which][0], data), chunks[which][1]),
        *chunks[which + 1 :],
    ]
    for payloads in (chunks, broken):
        geometry = None if at is None else at.tolist()
        rows = reference.Rows(faces.tolist(), vertices, largest, swift, normals, geometry)
        assert read(expected(rows), payloads) == read(product(field), payloads)


@quick
@given(
    SOUPS, st.sampled_from([0, 1, 9, MOST_GRID]), st.sampled_from([1, 3, 1 << 20]), SEEDS, st.data()
)
def test_tangents(mesh, reach, most, seed, data):
    faces = np.array(mesh[0], np.int32).reshape(-1, 3)
    if not len(faces):
        return
    random = np.random.default_rng(seed)
    rows, faces = np.unique(faces, return_inverse=True)  # each row has a corner
    faces = faces.reshape(-1, 3).astype(np.int32)
    bases = [random.integers(0, len(rows), faces.shape).astype(np.int32) for _ in range(2)]
    at = random.integers(0, reach + 1, (len(rows), 3)).astype(np.int32)
    coordinates = random.integers(0, most, (len(rows), 2)).astype(np.int32)
    normals = random.normal(size=(len(rows), 3))
    whole = np.rint(normals)
    whole[:, 2] += 0.5
    normals = np.where(random.random((len(rows), 1)) < 0.3, whole, normals)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    size = data.draw(st.sampled_from([1, 2, 256, 32768]))
    words = np.column_stack(
        [random.integers(0, 4 * size + 1, len(rows)), random.integers(0, 2, len(rows))]
    )

    def tangents(turns):
        surface = (
            faces.tolist(),
            [base.tolist() for base in bases],
            at.tolist(),
            coordinates.tolist(),
        )
        return reference.tangents(*surface, normals.tolist(), 4 * size, np.asarray(turns).tolist())

    wanted = np.array(tangents(words))
    vertices = np.arange(len(rows), dtype=np.int32)
    own = faces.reshape(-1).copy()
    found, values, error = turned_tangents(
        faces, *bases, at, coordinates, vertices, own, normals, wanted, size
    )
    assert error < 1e-5  # degrees: the tangents are those of some turns
    assert values.tolist() == tangents(found)
    other = wanted * [1.0, 1.0, 1.0, -1.0] + np.cross(wanted[:, :3], normals) @ np.eye(3, 4) * 9.0
    other[:, :3] /= np.linalg.norm(other[:, :3], axis=1, keepdims=True)
    near = turned_tangents(faces, *bases, at, coordinates, vertices, own, normals, other, size)
    assert near is None or near[1].tolist() == tangents(near[0])


@pytest.mark.parametrize("effort", ["quick", "normal"])
def test_split_rows(effort):
    """Edges of more than two faces: corners of rows are partners by the rows, whatever those of the mesh are."""
    random = np.random.default_rng(6)
    faces = np.array(list(permutations(range(6), 3)))
    values, indices = (
        random.random((2, 2)).astype(np.float32),
        random.integers(0, 2, faces.shape).astype(np.int32),
    )
    coordinates = bsm.Attribute("uv", values, "corner", "texcoord", indices)
    mesh = bsm.TriangleMesh(random.random((6, 3)), faces, (coordinates,))
    stream = bsm.encode(mesh, grid=9, effort=effort, attributes={"uv": "9bits"})
    rows = rows_of(stream)[0]
    declared = rows.declaration
    words = np.array(rows.read(reference))
    numbers = np.array(declared.offset) + np.array(declared.step) * words
    assert rows.attribute.values.tolist() == numbers.astype(np.float32).tolist()


STREAMS = [
    v
    for v in read_manifest()
    if v.error is None and "good-swift" in v.name and "order" not in v.name
]


@pytest.mark.parametrize("vector", STREAMS, ids=lambda vector: vector.name)
def test_streams(vector):
    attributes = rows_of(vector.stream.read_bytes())
    words = {
        index: rows.read(reference) for index, rows in attributes.items() if rows.declaration.rows
    }
    assert all(len(words[index]) == rows.declaration.rows for index, rows in attributes.items())
    for index, rows in attributes.items():
        if rows.declaration.coding != TANGENTS:
            continue
        normals, coordinates = (attributes[base - 1] for base in rows.declaration.bases)
        values = normals.attribute.values.astype(np.float64).tolist()
        faces = (
            rows.faces,
            (normals.faces, coordinates.faces),
            rows.places,
            words[rows.declaration.bases[1] - 1],
        )
        tangents = reference.tangents(*faces, values, rows.declaration.largest[0], words[index])
        np.testing.assert_array_equal(np.float32(tangents), rows.attribute.values)
