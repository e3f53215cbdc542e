"""The extension modules: stubs that say what they hold, and C that needs no C library."""

import importlib.util
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
PACKAGES = ("bitstream", "codec", "bsm")
SOURCES = sorted(path.relative_to(ROOT) for package in PACKAGES for path in (ROOT / package).rglob("*.c"))
WASM = ["--target=wasm32", "-std=gnu11", "-O2", "-msimd128", "-nostdlib", "-ffreestanding", "-ffp-contract=off"]


@pytest.mark.skipif(importlib.util.find_spec("nanobind") is None, reason="stubs are written by nanobind")
@pytest.mark.parametrize("package", PACKAGES)
def test_stubs_are_fresh(package, tmp_path):
    stub = tmp_path / "stub.pyi"
    command = [sys.executable, "-m", "nanobind.stubgen", "-q", "-m", f"{package}._kernels", "-o", str(stub)]
    subprocess.run(command, cwd=ROOT, check=True)
    assert stub.read_text() == (ROOT / package / "_kernels.pyi").read_text(), "run tools/build_kernels.sh"


@pytest.mark.skipif(shutil.which("clang") is None, reason="needs clang")
@pytest.mark.parametrize("source", [path for path in SOURCES if path.parts[0] == "bitstream"], ids=str)
def test_kernels_of_the_bitstream_compile_for_webassembly(source, tmp_path):
    target = tmp_path / "kernel.o"
    subprocess.run(["clang", *WASM, "-I", ".", "-c", source, "-o", target], cwd=ROOT, check=True)
    assert target.read_bytes()[:4] == b"\0asm"
