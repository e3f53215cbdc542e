"""What tells whether a file, a folder or a URL is still as it was."""

from __future__ import annotations

import glob
import os
from collections.abc import Iterator

from bsm.files.remote import is_url, state_of_remote

State = list[object]
"""Name, size and version of each file, as JSON gives it back."""


def files_behind(path: str) -> Iterator[str]:
    """The files behind an input or output: itself, or what a folder or a pattern names, in order."""
    if is_url(path):
        yield path
    elif os.path.isdir(path):
        yield from sorted(entry.path for entry in os.scandir(path))
    elif glob.has_magic(path) and not os.path.exists(path):
        yield from sorted(glob.iglob(path))
    else:
        yield path


def state_of(path: str) -> State | None:
    """Sizes and times of the files behind an input or output; None where that cannot be told."""
    found: State = []
    for file in files_behind(path):
        if is_url(file):
            state = state_of_remote(file)
            if state is None or not state.version:
                return None
            found.append([file, state.size, state.version])
        elif os.path.isfile(file):
            about = os.stat(file)
            found.append([file, about.st_size, str(about.st_mtime_ns)])
    return found or None


def size_of(path: str) -> int | None:
    """Bytes of the files behind an input or output; None for a pipe, and where a server does not say."""
    if is_url(path):
        state = state_of_remote(path)
        return state.size if state else None
    sizes = [os.path.getsize(file) for file in files_behind(path) if os.path.isfile(file)]
    return sum(sizes) if sizes else None
