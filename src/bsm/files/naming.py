"""Names of outputs that the user did not name."""

from __future__ import annotations

import glob
from pathlib import Path

from bsm.bitstream.errors import OptionError
from bsm.files.remote import beside, inside, is_url, name_in
from bsm.files.standard import standard_output


def default_output(path: str, suffix: str) -> str:
    """`path` with another suffix; "-" (a pipe) stays."""
    if path == "-":
        return "-"
    if is_url(path):
        url = beside(path, _with_suffix(path, suffix).name)
        if url == path:
            raise OptionError(f"the output would replace the input {path}; name another with -o")
        return url
    output = _with_suffix(path, suffix)
    if output == Path(path):
        raise OptionError(f"the output would replace the input {path}; name another with -o")
    return str(output)


def output_inside(folder: str, path: str, suffix: str) -> str:
    """The name that the output of `path` has in a folder."""
    name = _with_suffix(path, suffix).name
    return inside(folder, name) if is_url(folder) else str(Path(folder, name))


def _with_suffix(path: str, suffix: str) -> Path:
    if is_url(path):
        if not name_in(path):
            raise OptionError(f"{path} gives the output no name; name it with -o")
        return Path(name_in(path)).with_suffix(suffix)
    if glob.has_magic(path) and not Path(path).exists():
        raise OptionError(f"{path} names many files; name the output with -o")
    name = Path(path).name
    if name in ("", "-", "..") or path.startswith("/dev/"):
        raise OptionError(f"{path} gives the output no name; name it with -o")
    return Path(path).with_suffix(suffix)


def refuse_terminal(path: str) -> None:
    """Raise `OptionError` if "-" is a terminal: binary data would only garble it."""
    if path == "-" and standard_output().isatty():
        raise OptionError("binary data is not written to a terminal; redirect it, or name a file with -o")
