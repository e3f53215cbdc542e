"""The DLL for Windows gives the bits of the library for Linux, under Wine."""

import importlib.util
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tools.amalgamate import ROOT
from tools.release.windows import build_dll, compare, find_wine


@pytest.mark.slow
def test_the_dll_gives_the_same_bits(tmp_path: Path) -> None:
    wine = find_wine()
    if wine is None or importlib.util.find_spec("ziglang") is None or shutil.which("cc") is None:
        pytest.skip("no Wine, Zig or C compiler here")
    subprocess.run([sys.executable, "-m", "tools.amalgamate", tmp_path], cwd=ROOT, check=True)
    (tmp_path / "inside").mkdir()
    build_dll(tmp_path, tmp_path / "inside/bsmdec.dll")
    compare(tmp_path, tmp_path / "inside", ROOT, wine)
