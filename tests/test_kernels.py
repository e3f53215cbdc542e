"""The extension modules: stubs that say what they hold, and C that needs no C library."""

import importlib.util
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
PACKAGES = ("bsm", "bsm.bitstream", "bsm.codec")
WASM = [
    *("--target=wasm32", "-std=gnu11", "-O2", "-msimd128", "-mbulk-memory", "-ffreestanding", "-ffp-contract=off"),
    *("-nostdlib", "-Wl,--no-entry", "-Wl,--export-all"),
]


@pytest.mark.skipif(importlib.util.find_spec("nanobind") is None, reason="stubs are written by nanobind")
@pytest.mark.parametrize("package", PACKAGES)
def test_stubs_are_fresh(package, tmp_path):
    stub = tmp_path / "stub.pyi"
    command = [sys.executable, "-m", "nanobind.stubgen", "-q", "-m", f"{package}._kernels", "-o", str(stub)]
    subprocess.run(command, cwd=ROOT, check=True)
    ours = ROOT.joinpath("src", *package.split("."), "_kernels.pyi")
    assert stub.read_text() == ours.read_text(), "run tools/build_kernels.sh"


@pytest.mark.slow
@pytest.mark.skipif(not (shutil.which("clang") and shutil.which("wasm-ld")), reason="needs clang and lld")
def test_kernels_of_the_bitstream_are_complete_as_webassembly(tmp_path):
    """They compile, and link without any library."""
    target = tmp_path / "kernels.wasm"
    sources = sorted(path.relative_to(ROOT) for path in (ROOT / "bitstream").rglob("*.c"))
    subprocess.run(["clang", *WASM, "-I", ".", *sources, "-o", target], cwd=ROOT, check=True)
    assert target.read_bytes()[:4] == b"\0asm"
