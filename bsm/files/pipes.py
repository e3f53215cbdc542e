"""Input from files and pipes."""

from __future__ import annotations

import io
import os
import sys
from collections.abc import Iterator
from typing import cast

_CHUNK = 1 << 18


def read_chunks(path: str | os.PathLike[str]) -> Iterator[bytes]:
    """The bytes of a file, or of standard input for "-", as they come."""
    if os.fspath(path) == "-":
        while chunk := cast(io.BufferedReader, sys.stdin.buffer).read1(_CHUNK):
            yield chunk
        return
    with open(path, "rb") as file:
        while chunk := file.read(_CHUNK):
            yield chunk
