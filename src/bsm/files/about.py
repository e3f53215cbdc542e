"""Errors that say which file they are about."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from bsm.bitstream.errors import BsmError


@contextmanager
def about(path: str) -> Iterator[None]:
    """Put the name of the file that it is about before the message of whatever is raised inside."""
    try:
        yield
    except BsmError as error:
        error.message = f"{path}: {error.message}"
        raise
