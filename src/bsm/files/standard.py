"""Standard input and output as bytes; a shell may have closed them (`<&-`, `>&-`)."""

from __future__ import annotations

import errno
import sys
from typing import BinaryIO


def standard_input() -> BinaryIO:
    """Raises `OSError` if it is closed."""
    if sys.stdin is None:
        raise OSError(errno.EBADF, "standard input is closed")
    return sys.stdin.buffer


def standard_output() -> BinaryIO:
    """Raises `OSError` if it is closed."""
    if sys.stdout is None:
        raise OSError(errno.EBADF, "standard output is closed")
    return sys.stdout.buffer
