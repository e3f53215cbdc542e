"""The extension modules have stubs that say what they hold."""

import importlib.util
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
PACKAGES = ("bsm", "bsm.bitstream", "bsm.codec")


@pytest.mark.skipif(importlib.util.find_spec("nanobind") is None, reason="stubs are written by nanobind")
@pytest.mark.parametrize("package", PACKAGES)
def test_stubs_are_fresh(package, tmp_path):
    stub = tmp_path / "stub.pyi"
    command = [sys.executable, "-m", "nanobind.stubgen", "-q", "-m", f"{package}._kernels", "-o", str(stub)]
    subprocess.run(command, cwd=ROOT, check=True)
    ours = ROOT.joinpath("src", *package.split("."), "_kernels.pyi")
    assert stub.read_text() == ours.read_text(), "run tools/build_kernels.sh"
