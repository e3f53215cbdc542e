"""Normals as levels, rings of vertices at one place, the cost of seams, and how small values of real meshes are."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bsm._core import GivenMesh
from bsm.bitstream.container.header import CORNER, FACE, GENERIC, NORMAL, Declaration, values_of
from bsm.codec.static.attributes.encoding import WAYS
from tests.bitstream.fields.fields import decode, encode, field_of, unfolded
from tools.measure.grids import welded


def place_of(faces):
    """The mesh of these faces, in the order of coding."""
    mesh = GivenMesh(faces, np.arange(int(faces.max()) + 1, dtype=np.int32))
    mesh.join(True, False)
    mesh.code()
    return mesh


def carried(normals, bits):
    """The levels of normals, and the decoded ones."""
    faces = np.arange(3 * len(normals), dtype=np.int32).reshape(-1, 3)
    way = WAYS.index("bits")
    return place_of(faces).carry(
        True, "normals", np.asarray(normals), 7, FACE, NORMAL, None, way, bits
    )[2:4]


@given(
    st.lists(st.tuples(*[st.floats(-1e300, 1e300)] * 3), min_size=1, max_size=40),
    st.sampled_from([2, 8, 16]),
)
def test_levels_of_normals(normals, bits):
    vectors = np.array(
        [normal for normal in normals if np.abs(normal).max() > 1e-290] or [(0.0, 0.0, 1.0)]
    )
    size = 2 ** (bits - 1) - 1
    unit = vectors / np.abs(vectors).max(axis=1, keepdims=True)
    unit /= np.linalg.norm(unit, axis=1, keepdims=True)
    levels, decoded = carried(vectors, bits)
    assert (levels >= 0).all() and (levels <= 2 * size).all()
    points = unfolded(levels.astype(np.int64), size)
    np.testing.assert_array_equal(
        decoded, points / np.sqrt(np.square(points).sum(axis=1, keepdims=True))
    )
    np.testing.assert_array_equal(carried(decoded, bits)[0], levels)
    assert (np.linalg.norm(np.cross(unit, decoded), axis=1) < 2.2 / size).all()


@pytest.mark.real
@pytest.mark.parametrize(("name", "most"), [("bunny_34834", 3.1), ("fandisk_6475", 1.4)])
def test_normals_of_real_meshes_are_small(meshes: Path, name: str, most: float):
    positions, faces = welded(str(meshes / "static" / f"{name}.ply"))
    edge = np.linalg.norm(positions[faces[:, 0]] - positions[faces[:, 1]], axis=1).mean()
    across = np.cross(
        positions[faces[:, 1]] - positions[faces[:, 0]],
        positions[faces[:, 2]] - positions[faces[:, 0]],
    )
    normals = np.zeros((len(positions), 3))
    for corner in range(3):
        np.add.at(normals, faces[:, corner], across)
    normals[np.abs(normals).max(axis=1) == 0] = 1
    levels = carried(normals, 8)[0].astype(np.int32)
    at = np.rint(positions / edge * 32).astype(np.int32)
    field = field_of("normal", faces, len(levels), (254, 254), at)
    chunks = encode(field, levels)
    np.testing.assert_array_equal(decode(field, chunks), levels)
    assert 8 * len(chunks[0][0]) / len(levels) < most


def test_seams_of_an_attribute_before_cost_next_to_nothing():
    random = np.random.default_rng(3)
    faces = np.array([[i, i + 1, i + 2] for i in range(2000)], np.int32)
    place, values = place_of(faces), np.arange(2, dtype=np.uint8)[:, None]
    indices = random.integers(0, 2, faces.shape, np.int32)

    def seams(first, indices):
        found = place.carry(
            first, "a", values, 0, CORNER, GENERIC, indices, WAYS.index("exact"), 0.0
        )
        return values_of(Declaration, found[0])["seams_of"], found[1]

    whose, alone = seams(True, indices)
    assert whose == 0 and seams(False, indices) == (1, b"")
    indices[1000, 0] ^= 1
    whose, known = seams(False, indices)
    assert whose == 0 and len(known) < len(alone) / 8
