"""The Rust crate over the library: its own tests, which decode all vectors."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

CRATE = Path(__file__).parents[2] / "engine/rust"


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("cargo") is None, reason="no Rust here")
def test_the_crate_passes_its_tests(tmp_path: Path) -> None:
    own = {"CARGO_TARGET_DIR": str(tmp_path), "PYTHON": sys.executable, "CFLAGS": "-O1 -DKERNEL_ONE_TARGET"}
    command = ["cargo", "test", "--offline", "--quiet", "--locked"]
    done = subprocess.run(command, cwd=CRATE, env=os.environ | own, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
