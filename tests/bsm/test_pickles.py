"""What the functions give and take goes through pickles and deep copies: to processes, and to clusters."""

import copy
import multiprocessing
import os
import pickle
import subprocess
import sys
from functools import cache

import numpy as np
import pytest

import bsm
from bsm import Attribute, TriangleMesh
from tests.bsm.program import ROOT
from tests.streams import events_of
from tools.vectors.meshes import torus

TWICE = pytest.mark.parametrize(
    "twice", [lambda value: pickle.loads(pickle.dumps(value)), copy.deepcopy]
)


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


CHILDREN, SECONDS = 6, 60
PROGRAM = f"""
import os, signal, sys, threading, time
import numpy as np
import bsm
from tools.vectors.meshes import torus

stream = bsm.encode(torus(24, 24), threads=1)
wanted = bsm.decode(stream, threads=1).positions
going, rounds = True, [0] * 4

def work(number):
    while going:
        assert np.array_equal(bsm.decode(stream, threads=1 + number % 2).positions, wanted)
        rounds[number] += 1

threads = [threading.Thread(target=work, args=(number,)) for number in range(4)]
for thread in threads:
    thread.start()
while not all(rounds):
    time.sleep(0.01)
ended = []
for number in range({CHILDREN}):
    time.sleep(0.003 * number)
    child = os.fork()
    if child == 0:
        signal.alarm({SECONDS})
        same = np.array_equal(bsm.decode(stream, threads=1 + number % 2).positions, wanted)
        os._exit(0 if same else 1)
    ended.append(os.waitpid(child, 0)[1])
going = False
for thread in threads:
    thread.join()
print(ended)
sys.exit(any(ended))
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system cannot fork")
def test_children_that_are_forked_while_threads_decode_decode_and_end():
    command = [sys.executable, "-W", "ignore::DeprecationWarning", "-c", PROGRAM]
    done = subprocess.run(
        command, cwd=ROOT, capture_output=True, text=True, timeout=CHILDREN * SECONDS
    )
    assert done.returncode == 0, done.stdout + done.stderr
