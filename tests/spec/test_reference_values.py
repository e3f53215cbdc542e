"""The product and the decoder written from the law treat the same payloads alike, damaged ones too."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bsm.bitstream.attributes.values import canonical_levels, face_values_field, values_field
from bsm.bitstream.fields.corners import MOST_LARGEST, FieldDecoder
from tests.bitstream.fields.fields import KINDS, SOUPS, encode, values
from tests.spec.test_reference_fields import damaged, outcome, plain, product
from tools.measure.grids import rounded, welded

SPEC = Path(__file__).parents[2] / "spec"
quick = settings(max_examples=60)
CHUNKS = st.sampled_from([1, 7, 100])
SEEDS = st.integers(0, 2**32 - 1)
SHAPES = st.sampled_from(["none", "flat", "small", "large"])


@pytest.fixture(scope="module")
def reference():
    sys.path.insert(0, str(SPEC))
    yield importlib.import_module("reference_values")
    sys.path.remove(str(SPEC))


def lists_of(decoder: FieldDecoder) -> Callable[[bytes, int], Any]:
    return lambda payload, count: decoder.chunk(payload, count)[1].tolist()


def rows_of(reader: Any) -> Callable[[bytes, int], Any]:
    return lambda payload, count: [list(reader.x[f]) for f in reader.read(payload, count)]


def geometry(vertices: int, shape: str, seed: int) -> np.ndarray | None:
    """Places of vertices, some of them the same."""
    rng = np.random.default_rng(seed)
    if shape == "none":
        return None
    reach = {"flat": 1, "small": 40, "large": 2**31 - 1}[shape]
    points = rng.integers(-reach, reach + 1, (vertices, 3))
    if shape == "flat":
        points = np.stack([np.arange(vertices) * 30, points[:, 0] * 20, points[:, 1] * 0], axis=1)
    return points.astype(np.int32)


@quick
@given(SOUPS, st.sampled_from(["plain", "color", "texcoord", "normal"]), SHAPES, st.data(), KINDS, SEEDS, CHUNKS)
def test_values(reference, mesh, kind, shape, data, values_kind, seed, chunk):
    faces, vertices = mesh
    if not vertices:
        return
    components = data.draw(st.integers(1, 4)) if kind in ("plain", "color") else 2
    most = data.draw(st.sampled_from([2, 254, 4094, MOST_LARGEST - 1]))
    largest = (most,) * components
    if kind != "normal":
        largest = tuple(data.draw(st.sampled_from([most, most, 0, 1])) for _ in largest)
    given_values = values(vertices, [0] * components, largest, values_kind, seed)
    if kind == "normal":
        given_values = canonical_levels(given_values, most // 2)
    places = np.random.default_rng(seed).integers(0, data.draw(st.sampled_from([1, vertices, 3 * vertices])), vertices)
    at = geometry(vertices, shape, seed)
    field = values_field(faces, vertices, largest, kind, at, places)
    chunks = encode(field, given_values, chunk)
    for payloads in (chunks, damaged(chunks, data)):
        expected = outcome(product(FieldDecoder(field)), payloads)
        reader = reference.ValueReader(
            faces.tolist(), vertices, list(largest), kind, None if at is None else at.tolist(), places.tolist()
        )
        assert outcome(plain(reader), payloads) == expected


@quick
@given(SOUPS, st.integers(1, 4), st.sampled_from([1, 7, 255, MOST_LARGEST]), KINDS, SEEDS, CHUNKS, st.data())
def test_values_of_faces(reference, mesh, components, most, kind, seed, chunk, data):
    faces, _ = mesh
    if not len(faces):
        return
    largest = (most,) * components
    field = face_values_field(faces, largest)
    chunks = encode(field, values(len(faces), [0] * components, largest, kind, seed), chunk)
    for payloads in (chunks, damaged(chunks, data)):
        expected = outcome(lists_of(FieldDecoder(field)), payloads)
        assert outcome(rows_of(reference.FaceReader(faces.tolist(), list(largest))), payloads) == expected


@pytest.mark.slow
@pytest.mark.real
@pytest.mark.parametrize("kind", ["color", "texcoord", "normal"])
def test_a_real_mesh(reference, meshes: Path, kind: str):
    positions, faces = welded(str(meshes / "static" / "c3d_spot.ply"))
    at = rounded(positions, 12)
    components = 3 if kind == "color" else 2
    most = {"color": 255, "texcoord": 4095, "normal": 254}[kind]
    given_values = (rounded(positions, 8)[:, :components] * (most // 256 or 1)).clip(0, most)
    given_values = canonical_levels(given_values, 127) if kind == "normal" else given_values
    places = np.arange(len(at))
    field = values_field(faces, len(at), (most,) * components, kind, at, places)
    chunks = encode(field, given_values, 700)[:2]
    expected = outcome(product(FieldDecoder(field)), chunks)
    reader = reference.ValueReader(faces.tolist(), len(at), [most] * components, kind, at.tolist(), places.tolist())
    assert outcome(plain(reader), chunks) == expected
