"""The program: in this process, or as a user runs it, in one of its own."""

import importlib
import io
import json
import subprocess
import sys
import tomllib
from contextlib import redirect_stderr, redirect_stdout
from functools import partial
from importlib.metadata import entry_points
from pathlib import Path

import pytest

from bsm.cli import main

ROOT = Path(__file__).parents[2]


def bsm(*arguments, input=b"", text=False):
    """What came of `bsm` with these words; bytes, or with `text=True` strings. In this process: starting one costs
    more than most of what is tested."""
    words = list(map(str, arguments))
    out, err = (io.TextIOWrapper(io.BytesIO(), "utf-8", write_through=True) for _ in range(2))
    with pytest.MonkeyPatch.context() as patch, redirect_stdout(out), redirect_stderr(err):
        patch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(input)))
        code = run(*words)
    found = [stream.buffer.getvalue() for stream in (out, err)]
    return subprocess.CompletedProcess(
        words, code, *([line.decode() for line in found] if text else found)
    )


def run(*arguments):
    """The exit code of `bsm` in this process; what it prints stays for `capsys`."""
    try:
        return main(list(map(str, arguments)))
    except SystemExit as ended:
        return ended.code


def python(*words, timeout=120, **keywords):
    """A Python in a process of its own."""
    command = [sys.executable, *map(str, words)]
    return subprocess.run(
        command, capture_output=True, timeout=timeout, cwd=ROOT, check=False, **keywords
    )


def process(*arguments, **keywords):
    """The program in a process of its own."""
    return python("-m", "bsm", *arguments, **keywords)


def bound(name, most):
    """What bounds a process that is started."""
    resource = importlib.import_module("resource")
    return partial(resource.setrlimit, getattr(resource, name), (most, most))


def contents(folder):
    """The bytes of the files in a folder, by name."""
    return {path.name: path.read_bytes() for path in Path(folder).iterdir()}


def run_json(*arguments):
    """The JSON that a command prints, which ends well."""
    done = bsm(*arguments, "--json")
    assert done.returncode == 0, done.stderr.decode()
    return json.loads(done.stdout)


def declare_entry_points(folder: Path) -> Path:
    """Make a folder that declares the entry points of pyproject.toml once it is on the path, if nothing else does."""
    folder.mkdir(parents=True, exist_ok=True)
    if entry_points(group="pyvista.readers", name=".bsm"):
        return folder
    declared = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["entry-points"]
    info = folder / "bsm_codec_here-0.1.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: bsm-codec-here\nVersion: 0.1\n")
    lines = [
        f"[{group}]\n" + "".join(f"{k} = {v}\n" for k, v in points.items())
        for group, points in declared.items()
    ]
    (info / "entry_points.txt").write_text("\n".join(lines))
    return folder
