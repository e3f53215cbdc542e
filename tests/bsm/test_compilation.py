import subprocess
import sys
from pathlib import Path

from numba import njit

from bsm.compilation import NOTICE, announced_compilation

ROOT = Path(__file__).parents[2]


def test_compiling_is_announced_once_and_only_if_it_happens():
    said = []
    kernel = njit(lambda x: x + 1)
    with announced_compilation(said.append):
        assert not said
        assert kernel(1) == 2 and kernel(1.0) == 2.0
    assert said == [NOTICE]
    with announced_compilation(said.append):
        kernel(3)
    assert said == [NOTICE]


def test_nothing_is_compiled_in_a_second_process():
    """Every kernel of a round trip must come from the cache; one whose key varies would be compiled for ever."""
    program = (
        "import sys\n"
        "import numpy as np\n"
        "from codec import EncodeOptions, TriangleMesh, decode, encode\n"
        "from bsm.compilation import announced_compilation\n"
        "faces = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]], np.int32)\n"
        "mesh = TriangleMesh(np.eye(4, 3), faces)\n"
        "with announced_compilation(lambda text: sys.exit(text)):\n"
        "    decode(encode(mesh))\n"
    )
    first = "\n".join(line.replace("lambda text: sys.exit(text)", "print") for line in program.splitlines())
    for source in (first, program):
        done = subprocess.run([sys.executable, "-c", source], cwd=ROOT, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
