"""What the functions give and take goes through pickles and deep copies: to processes, and to clusters."""

import copy
import multiprocessing
import pickle
from functools import cache

import numpy as np
import pytest

import bsm
from bsm import Attribute, TriangleMesh
from tests.streams import events_of
from tools.vectors.meshes import torus

TWICE = pytest.mark.parametrize("twice", [lambda value: pickle.loads(pickle.dumps(value)), copy.deepcopy])


@cache
def given():
    mesh = torus(8, 8)
    color = Attribute("color", np.arange(192, dtype=np.uint8).reshape(64, 3), "vertex", "color")
    return TriangleMesh(mesh.positions, mesh.faces, (color,), {"name": "ring", "data": b"\0"})


@cache
def stream():
    return bsm.encode(given(), preset="fine")


@TWICE
def test_a_decoded_mesh(twice):
    mesh = bsm.decode(stream())
    again = twice(mesh)
    assert np.array_equal(mesh.positions, again.positions)
    assert np.array_equal(mesh.faces, again.faces)
    assert np.array_equal(mesh.attributes[0].values, again.attributes[0].values)
    assert again.metadata == mesh.metadata
    for array in (again.positions, again.faces, again.attributes[0].values):
        assert not array.flags.writeable


@TWICE
def test_events(twice):
    assert all(type(twice(event)) is type(event) for event in events_of(stream()))


@TWICE
def test_options_comparisons_limits_and_errors(twice):
    mesh = bsm.decode(stream())
    for value in (bsm.EncodeOptions(step=0.01), bsm.compare(mesh, mesh), bsm.Limits.service()):
        assert twice(value) == value
    error = twice(bsm.CorruptError("wrong", offset=3, block=1))
    assert str(error) == "wrong [byte 3, block 1]"


def test_a_pool_decodes():
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        (mesh,) = pool.map(bsm.decode, [stream()])
    assert np.array_equal(mesh.faces, bsm.decode(stream()).faces)
