"""Arrays that all modules share."""

import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from bsm.codec.arrays import distinct


@given(arrays(np.int32, st.integers(0, 40), elements=st.integers(-4, 4)))
def test_distinct_values_are_those_of_numpy(values):
    assert distinct(values).tolist() == np.unique(values).tolist()


@pytest.mark.parametrize("command", ["encode", "decode"])
def test_commands_load_no_masked_arrays(tmp_path, command):
    mesh = tmp_path / "mesh.obj"
    mesh.write_text(
        "o a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 3 4\no b\nf 1 4 2\nf 2 4 3\n"
    )
    stream, decoded = tmp_path / "mesh.bsm", tmp_path / "decoded.ply"
    words = {"encode": [mesh, "-o", stream, "-f"], "decode": [stream, "-o", decoded]}
    subprocess.run([sys.executable, "-m", "bsm", "encode", *words["encode"]], check=True)
    run = [sys.executable, "-X", "importtime", "-m", "bsm", command, *words[command]]
    loaded = subprocess.run(run, check=True, capture_output=True, text=True).stderr
    assert "numpy._core.multiarray" in loaded and "numpy.ma" not in loaded.replace(
        "numpy.matrixlib", ""
    )
