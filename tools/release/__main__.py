"""Make and check all that a release consists of, from the last commit: wheels, sources, npm, C, crate, suite.

    python -m tools.release                   all of it, into dist/
    python -m tools.release --only sdist npm  parts of it
    python -m tools.release --tests tests     with the whole test suite from each wheel, README's second command

Needs the extra `release`, Linux on x86-64, Python 3.11 and a later one, npm, cargo and CMake. Nothing is
published. Checks: versions agree; the source distribution builds where there is nothing but Python and a compiler;
wheels hold one name and no sources, are what auditwheel calls manylinux, satisfy twine, and run both commands of README
where no compiler is; npm takes the package, and Node decodes with it; the C archive decodes by one command and
installed by CMake; the DLL for Windows decodes all vectors to the same bits, where Wine is installed (apt: wine64);
cargo builds the crate that it packed. With them go a list of what a wheel brings along (SBOM,
CycloneDX), and digests.
"""

import argparse
import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from tools.pythons import pythons
from tools.release.cross import FOREIGN, LINUX, STABLE, clean
from tools.release.library import STREAM, make_archive, make_crate, make_suite
from tools.release.npm import make_npm
from tools.release.trial import try_newcomer, try_wheel
from tools.release.versions import address, check_versions, notes, with_absolute_links
from tools.release.wheels import make_sdist, make_wheel
from tools.release.windows import make_windows

ROOT = Path(__file__).parents[2]
PARTS = ("sdist", "wheels", "arm64", "others", "npm", "library")
RELEASED = (
    "bsm_codec-*",
    "bsm-decoder-*",
    "bsmdec-*",
    "bsm-conformance-*",
    "SHA256SUMS",
    "NOTES.md",
)
"""What a release consists of, and what an earlier one has left."""


def main() -> None:
    """Make and check."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "-o", "--output", type=Path, default=ROOT / "dist", help="folder (default: dist)"
    )
    parser.add_argument(
        "--only", nargs="+", choices=PARTS, default=PARTS, help="parts of it (default: all)"
    )
    parser.add_argument(
        "--tests", nargs="+", default=["tests/bsm/test_api.py"], help="tests to run from the wheels"
    )
    args = parser.parse_args()
    version = check_versions(ROOT)
    output = args.output.resolve()
    output.mkdir(parents=True, exist_ok=True)
    if set(args.only) == set(PARTS):
        for pattern in RELEASED:
            for old in output.glob(pattern):
                old.unlink()
    commit = git("log", "-1", "--format=%H %ct").split()
    made = make(output, version, commit, args.only, args.tests)
    (output / "SHA256SUMS").write_text("".join(f"{digest(path)}  {path.name}\n" for path in made))
    (output / "NOTES.md").write_text(notes(ROOT, version))
    for path in made:
        print(f"{path.stat().st_size / 1e6:7.2f} MB  {path.name}")


def make(
    output: Path, version: str, commit: Sequence[str], only: Sequence[str], tests: Sequence[str]
) -> list[Path]:
    """Make the parts, of a commit and in its time, and try the wheels."""
    name, os.environ["SOURCE_DATE_EPOCH"] = commit
    with tempfile.TemporaryDirectory() as folder:
        sources = exported(name, Path(folder))
        readme, source = sources / "README.md", address(sources)
        readme.write_text(with_absolute_links(readme.read_text(), source))
        if ".invalid/" in source:
            say(
                f"note: name the repository in pyproject.toml before you publish; {source} is a placeholder"
            )
        made = []
        if set(only) & {"sdist", "wheels", "arm64", "others"}:
            made.append(make_sdist(sources, output))
        found = pythons()
        builders = [
            found[version] for version in sorted({min(found), min(v for v in found if v >= STABLE)})
        ]
        for target, part in zip(LINUX, ("wheels", "arm64"), strict=True):
            if part in only:
                made += [make_wheel(made[0], python, target, output) for python in builders]
        if "others" in only:
            made += [make_wheel(made[0], builders[-1], target, output) for target in FOREIGN]
        if made:
            subprocess.run([sys.executable, "-m", "twine", "check", "--strict", *made], check=True)
        if "wheels" in only:
            for number, python in found.items():
                say(f"trying Python {number[0]}.{number[1]}")
                wheel = next(path for path in made if fits(path, number))
                try_wheel(wheel, python, sources, list(tests))
                try_newcomer(
                    wheel, (sources / "docs/install.md").read_text(), sources / STREAM, python
                )
            made.append(make_list(made[1], builders[0], output))
        if "npm" in only:
            made.append(make_npm(sources, ROOT, output))
        if "library" in only:
            made += [
                part(sources, version, output)
                for part in (make_archive, make_windows, make_crate, make_suite)
            ]
    return made


def make_list(wheel: Path, python: Path, output: Path) -> Path:
    """What the wheel brings along when it is installed (CycloneDX)."""
    target = output / f"{wheel.name.partition('-cp')[0]}.cdx.json"
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([python, "-m", "venv", folder], check=True, env=clean())
        installed = Path(folder, "bin/python")
        install: list[str | Path] = [
            installed,
            "-m",
            "pip",
            "install",
            "-q",
            "--disable-pip-version-check",
            wheel,
        ]
        subprocess.run(install, check=True, env=clean())
        options: list[str | Path] = ["--output-reproducible", "-o", target, installed]
        subprocess.run(
            [sys.executable, "-m", "cyclonedx_py", "environment", *options], check=True, env=clean()
        )
    return target


def digest(path: Path) -> str:
    """SHA-256 of a file."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


def git(*command: str) -> str:
    """What git says of the checkout."""
    return subprocess.run(
        ["git", *command], cwd=ROOT, capture_output=True, text=True, check=True
    ).stdout


def exported(commit: str, folder: Path) -> Path:
    """A commit's files, in a folder of their own."""
    if git("status", "--porcelain"):
        say("note: what is not committed is left out")
    sources = folder / "sources"
    sources.mkdir()
    archive = folder / "sources.tar"
    git("archive", "-o", str(archive), commit)
    shutil.unpack_archive(archive, sources, filter="tar")
    return sources


def fits(wheel: Path, version: tuple[int, int]) -> bool:
    """Whether a wheel is for this processor and Python."""
    tag = "abi3-many" if version >= STABLE else f"cp{version[0]}{version[1]}-cp"
    return "x86_64" in wheel.name and tag in wheel.name


def say(text: str) -> None:
    """Say what goes on."""
    print(text, file=sys.stderr, flush=True)


if __name__ == "__main__":
    main()
