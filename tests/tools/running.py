"""Commands of the laboratory, without a process of their own."""

import contextlib
import io
import sys
from types import SimpleNamespace
from unittest.mock import patch

from tools.measure.__main__ import main


def tool(*words):
    """What `python -m tools.measure WORDS` would give: `returncode`, `stdout` and `stderr`."""
    out, err = io.StringIO(), io.StringIO()
    with (
        patch.object(sys, "argv", ["tools.measure", *map(str, words)]),
        contextlib.redirect_stdout(out),
        contextlib.redirect_stderr(err),
    ):
        try:
            main()
            code = 0
        except SystemExit as end:
            code = end.code or 0
    return SimpleNamespace(returncode=code, stdout=out.getvalue(), stderr=err.getvalue())
