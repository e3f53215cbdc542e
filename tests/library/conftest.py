"""The library, compiled once for all of its tests, and programs that use it."""

import ctypes
import subprocess
from pathlib import Path

import pytest

from tools.amalgamate import ROOT
from tools.bsmdec import build


@pytest.fixture(scope="session")
def library() -> ctypes.CDLL:
    return build()


def linked(made: Path, source: Path, program: Path, *flags: str, compiler: str = "cc") -> Path:
    """A program of this source and the library that was made there."""
    command = [
        compiler,
        *flags,
        f"-I{made}",
        f"-I{ROOT}",
        source,
        made / "bsmdec.so",
        f"-Wl,-rpath,{made}",
    ]
    subprocess.run([*command, "-lm", "-pthread", "-o", program], check=True)
    return program
