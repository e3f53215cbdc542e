"""Make and check all that a release consists of, from the last commit: wheels, a source distribution, the npm package.

    python -m tools.release                   all of it, into dist/
    python -m tools.release --only sdist npm  parts of it
    python -m tools.release --tests tests     with the whole test suite from each wheel, README's second command

Needs the extra `release`, Linux on x86-64, Python 3.11 and a later one, and npm. Nothing is published. Checks:
versions agree; the source distribution builds where there is nothing but Python and a compiler; wheels hold one name
and no sources, are what auditwheel calls manylinux, satisfy twine, and run both commands of README where no compiler
is; npm takes the package, and Node decodes with it.
"""

from __future__ import annotations

import argparse
import hashlib
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from tools.pythons import pythons
from tools.release.npm import make_npm
from tools.release.trial import try_wheel
from tools.release.versions import check_versions, notes
from tools.release.wheels import ARM, INTEL, make_sdist, make_wheel

ROOT = Path(__file__).parents[2]
PARTS = ("sdist", "wheels", "arm64", "npm")
RELEASED = ("bsm_codec-*", "bsm-decoder-*", "SHA256SUMS", "NOTES.md")
"""What a release consists of, and what an earlier one has left."""
STABLE = (3, 12)
"""From this Python on one wheel is enough."""


def main() -> None:
    """Make and check."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "dist", help="folder (default: dist)")
    parser.add_argument("--only", nargs="+", choices=PARTS, default=PARTS, help="parts of it (default: all)")
    parser.add_argument("--tests", nargs="+", default=["tests/bsm/test_api.py"], help="tests to run from the wheels")
    args = parser.parse_args()
    version = check_versions(ROOT)
    output = args.output.resolve()
    output.mkdir(parents=True, exist_ok=True)
    if set(args.only) == set(PARTS):
        for pattern in RELEASED:
            for old in output.glob(pattern):
                old.unlink()
    with tempfile.TemporaryDirectory() as folder:
        sources = exported(Path(folder))
        made = []
        if set(args.only) & {"sdist", "wheels", "arm64"}:
            made.append(make_sdist(sources, output))
        found = pythons()
        builders = [found[version] for version in sorted({min(found), min(v for v in found if v >= STABLE)})]
        for target, part in ((INTEL, "wheels"), (ARM, "arm64")):
            if part in args.only:
                made += [make_wheel(made[0], python, target, output) for python in builders]
        if made:
            subprocess.run([sys.executable, "-m", "twine", "check", "--strict", *made], check=True)
        if "wheels" in args.only:
            for number, python in found.items():
                say(f"trying Python {number[0]}.{number[1]}")
                wheel = next(path for path in made if fits(path, number))
                try_wheel(wheel, python, sources, args.tests)
        if "npm" in args.only:
            made.append(make_npm(sources, ROOT, output))
    lines = [f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.name}" for path in made]
    (output / "SHA256SUMS").write_text("\n".join(lines) + "\n")
    (output / "NOTES.md").write_text(notes(ROOT, version))
    for path in made:
        print(f"{path.stat().st_size / 1e6:7.2f} MB  {path.name}")


def exported(folder: Path) -> Path:
    """The last commit's files, in a folder of their own."""
    if subprocess.run(["git", "status", "--porcelain"], cwd=ROOT, capture_output=True, check=True).stdout:
        say("note: what is not committed is left out")
    sources = folder / "sources"
    sources.mkdir()
    archive = folder / "sources.tar"
    subprocess.run(["git", "archive", "-o", str(archive), "HEAD"], cwd=ROOT, check=True)
    shutil.unpack_archive(archive, sources, filter="tar")
    return sources


def fits(wheel: Path, version: tuple[int, int]) -> bool:
    """Whether a wheel is for this processor and Python."""
    tag = "abi3" if version >= STABLE else f"cp{version[0]}{version[1]}-cp"
    return "x86_64" in wheel.name and tag in wheel.name


def say(text: str) -> None:
    """Say what goes on."""
    print(text, file=sys.stderr, flush=True)


if __name__ == "__main__":
    main()
