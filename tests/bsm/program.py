"""The program: in this process, or as a user runs it, in one of its own."""

import io
import json
import subprocess
import sys
from contextlib import redirect_stderr, redirect_stdout
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
        try:
            code = main(words)
        except SystemExit as ended:
            code = ended.code
    found = [stream.buffer.getvalue() for stream in (out, err)]
    return subprocess.CompletedProcess(words, code, *([line.decode() for line in found] if text else found))


def run(*arguments):
    """The exit code of `bsm` in this process; what it prints stays for `capsys`."""
    return main(list(map(str, arguments)))


def python(*words, timeout=120, **keywords):
    """A Python in a process of its own."""
    command = [sys.executable, *map(str, words)]
    return subprocess.run(command, capture_output=True, timeout=timeout, cwd=ROOT, check=False, **keywords)


def process(*arguments, **keywords):
    """The program in a process of its own."""
    return python("-m", "bsm", *arguments, **keywords)


def contents(folder):
    """The bytes of the files in a folder, by name."""
    return {path.name: path.read_bytes() for path in Path(folder).iterdir()}


def run_json(*arguments):
    """The JSON that a command prints, which ends well."""
    done = bsm(*arguments, "--json")
    assert done.returncode == 0, done.stderr.decode()
    return json.loads(done.stdout)
