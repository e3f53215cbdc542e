"""A process that forks while its threads decode: the child decodes as well, and ends."""

import os
import subprocess
import sys

import pytest

from tests.bsm.program import ROOT

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


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork here")
def test_children_that_are_forked_while_threads_decode_decode_and_end():
    command = [sys.executable, "-W", "ignore::DeprecationWarning", "-c", PROGRAM]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=CHILDREN * SECONDS)
    assert done.returncode == 0, done.stdout + done.stderr
