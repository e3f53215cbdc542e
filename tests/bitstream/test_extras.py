"""What to type for a missing library: a command with no path in it, which fetches the package from nowhere."""

import subprocess
import sys

import pytest

from bsm import DependencyError
from bsm.bitstream.errors import how_to_install, imported


def test_an_error_names_the_extra_and_no_path():
    with pytest.raises(DependencyError, match=r"^x is missing; run: pip install 'bsm-codec\[eval\]'$"):
        imported("no_such_module", "x is missing", "eval")


@pytest.mark.slow
def test_the_command_is_content_with_the_package_that_is_installed():
    if subprocess.run([sys.executable, "-m", "pip", "--version"], capture_output=True, check=False).returncode:
        pytest.skip("there is no pip here")
    words = how_to_install("progress").replace("'", "").split()[1:]
    command = [sys.executable, "-m", "pip", *words, "--no-index", "--dry-run"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0 and "already satisfied: bsm-codec" in done.stdout, done.stdout + done.stderr
