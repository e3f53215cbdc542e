"""The Pythons of this machine, and a short trial of the package on the oldest and the newest of them.

    python3 -m tools.pythons          which there are
    python3 -m tools.pythons --try    oldest Python with the oldest numpy, newest with the newest: install, demo, tests
    python3 -m tools.pythons --try --within ENV    the oldest as it is installed in an environment, if that has it

Knows the standard library alone: it runs before anything is installed.
"""

import argparse
import os
import platform
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[1]
TESTS = ("tests/spec/test_vectors.py", "tests/bsm/test_import.py")
CHOSEN = "(test_vectors and good and not command_lines and not wrong_decoder) or test_import"
"""Streams that are whole, and what says what is installed."""


def main() -> None:
    """List, or try."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--try", dest="tried", action="store_true", help="install and test on the oldest and newest"
    )
    parser.add_argument(
        "--within",
        type=Path,
        metavar="ENV",
        help="where the package is installed already; its numpy goes",
    )
    args = parser.parse_args()
    found = pythons()
    if not found:
        raise SystemExit("there is no Python 3.11 or later here")
    if not args.tried:
        for version, python in found.items():
            print(f"{_text(version)} {python}")
        return
    oldest, newest, old = min(found), max(found), f"numpy=={lowest('numpy')}.*"
    own = args.within and args.within.resolve() / "bin" / "python"
    if own and _version(own) == oldest:
        trial(own, old)
    else:
        attempt(found[oldest], old)
    attempt(found[newest], "numpy")


def pythons() -> dict[tuple[int, int], Path]:
    """Every Python from the oldest that is allowed on, by version: on PATH, and those of pyenv."""
    found: dict[tuple[int, int], Path] = {}
    for path in _candidates():
        version = _version(path)
        if version and version >= tuple(map(int, required().split("."))):
            found.setdefault(version, path)
    return dict(sorted(found.items()))


def _version(python: Path) -> tuple[int, int] | None:
    """Major and minor version of a Python, if it runs."""
    code = "import sys; print(*sys.version_info[:2])"
    done = subprocess.run([python, "-c", code], capture_output=True, text=True, check=False)
    if done.returncode:
        return None
    major, minor = map(int, done.stdout.split())
    return major, minor


def _candidates() -> Iterator[Path]:
    yield Path(sys.executable)
    for minor in range(11, 30):
        if program := shutil.which(f"python3.{minor}"):
            yield Path(program)
    yield from sorted(
        Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv")).glob("versions/*/bin/python")
    )


def required() -> str:
    """The oldest Python that pyproject.toml allows."""
    return _project(r'requires-python = ">=([\d.]+)"')


def lowest(package: str) -> str:
    """The oldest version of a dependency that pyproject.toml allows."""
    return _project(rf'"{package}>=([\d.]+)"')


def _project(pattern: str) -> str:
    match = re.search(pattern, (ROOT / "pyproject.toml").read_text())
    if match is None:
        raise SystemExit(f"pyproject.toml says nothing of {pattern}")
    return match.group(1)


def attempt(python: Path, numpy: str) -> None:
    """Install the package beside one numpy in an environment of its own, and try it."""
    with tempfile.TemporaryDirectory() as folder:
        environment = Path(folder, "venv")
        subprocess.run([python, "-m", "venv", environment], check=True)
        trial(environment / "bin" / "python", f"{ROOT}[eval]", numpy)


def trial(own: Path, *packages: str) -> None:
    """Install what is missing, run the demonstration and a few tests."""
    clean = {
        name: value
        for name, value in os.environ.items()
        if name not in ("PYTHONPATH", "VIRTUAL_ENV")
    }
    if platform.machine() in ("x86_64", "AMD64"):
        # Kernels for one level of processors compile in half the time.
        clean["CMAKE_ARGS"] = "-DBSM_LEVEL=1"
    pip: list[str | Path] = [own, "-m", "pip", "install", "-q", "--disable-pip-version-check"]
    subprocess.run([*pip, *packages, "pytest", "zstandard"], check=True, env=clean)
    code = "import sys, numpy; print(f'Python {sys.version.split()[0]}, numpy {numpy.__version__}')"
    subprocess.run([own, "-c", code], check=True, env=clean)
    bsm = own.parent / "bsm"
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(
            [bsm, "demo", "-q", "-o", "plain", "--vertices", "2000"],
            check=True,
            env=clean,
            cwd=folder,
        )
        subprocess.run([bsm, "verify", "plain/bsm_demo.bsm"], check=True, env=clean, cwd=folder)
    tests: list[str | Path] = [
        own,
        "-m",
        "pytest",
        "-q",
        "-x",
        "-p",
        "no:cacheprovider",
        "-k",
        CHOSEN,
        *TESTS,
    ]
    subprocess.run(tests, check=True, env=clean, cwd=ROOT)


def _text(version: tuple[int, int]) -> str:
    return ".".join(map(str, version))


if __name__ == "__main__":
    main()
