"""A wheel as a newcomer meets it: no compiler, no checkout; both commands of README."""

import os
import shlex
import shutil
import subprocess
import tempfile
from pathlib import Path

from tools.release.cross import clean

DEVELOP = "tools/develop.sh"
"""The script by which README installs a checkout."""
COMPILERS = ("cc", "gcc", "clang", "c++", "cmake", "ninja")


def try_wheel(wheel: Path, python: Path, sources: Path, tests: list[str]) -> None:
    """Install a wheel where there is no compiler, and run both commands of README with it."""
    first, second = readme_commands(sources)
    with tempfile.TemporaryDirectory() as folder:
        environment = without_compilers(Path(folder))
        subprocess.run([python, "-m", "venv", Path(folder, ".venv")], check=True)
        code = "import bsm; print(bsm.__file__)"
        _run(
            f"{_from_wheel(first, wheel)} && .venv/bin/bsm verify out/bsm_demo.bsm",
            folder,
            environment,
        )
        command: list[str | Path] = [Path(folder, ".venv/bin/python"), "-c", code]
        where = subprocess.run(
            command, cwd=folder, env=environment, capture_output=True, text=True, check=True
        )
        if "site-packages" not in where.stdout:
            raise SystemExit(f"bsm is {where.stdout.strip()}, not what {wheel.name} installed")
        program, _, options = _from_wheel(second, wheel).rpartition("-m pytest")
        line = f"{program}-m pytest{options} -p no:cacheprovider {shlex.join(tests)}"
        _run(
            f"cd {shlex.quote(str(sources))} && {line.replace('.venv/', f'{folder}/.venv/')}",
            folder,
            environment,
        )


def try_newcomer(package: Path, text: str, stream: Path, python: Path | None = None) -> None:
    """From the file of a release to a mesh in an empty folder, by the two commands that a README says."""
    lines = [line.strip() for line in text.splitlines()]
    last = next(
        place
        for place, line in enumerate(lines)
        if line.endswith("mesh.obj") and "mesh.bsm" in line
    )
    with tempfile.TemporaryDirectory() as folder:
        shutil.copy(package, folder)
        shutil.copy(stream, Path(folder, "mesh.bsm"))
        commands = "\n".join(lines[last - 1 : last + 1]).replace(
            "python3", str(python or "python3")
        )
        _run(commands, folder, clean())
        if Path(folder, "mesh.obj").read_text().count("\nf ") != 4:
            raise SystemExit(f"two commands do not decode a tetrahedron with {package.name}")


def readme_commands(sources: Path) -> list[str]:
    """README's two commands, without the environment that they make."""
    done = subprocess.run(
        [sources / ".ci" / "run", "--list"], capture_output=True, text=True, check=True
    )
    return [line.partition(" && ")[2] for line in done.stdout.splitlines()]


def _from_wheel(command: str, wheel: Path) -> str:
    """A command that installs the wheel where README's installs the checkout; no dependency is compiled."""
    if DEVELOP in command:
        lines = (Path(__file__).parents[2] / DEVELOP).read_text("utf-8").splitlines()
        install = next(line for line in lines if "-e '.[" in line)
        command = command.replace(DEVELOP, install.replace("--no-build-isolation ", ""))
    without = command.replace("-q -e '.[", "-q '.[")
    if "-q '.[" not in without:
        raise SystemExit(f"README's command does not install the checkout: {command}")
    # Some extras have no wheels for some Pythons; they are what tests skip.
    named = without.replace(
        "-q '.[", f"-q --disable-pip-version-check --only-binary :all: '{wheel}["
    )
    return named


def _run(command: str, folder: str, environment: dict[str, str]) -> None:
    subprocess.run(["bash", "-ec", command], cwd=folder, env=environment, check=True)


def without_compilers(folder: Path) -> dict[str, str]:
    """The environment with a PATH of all programs but compilers."""
    programs = folder / "programs"
    programs.mkdir()
    for path in os.environ["PATH"].split(os.pathsep):
        if Path(path) in (Path("/bin"), Path("/usr/bin")):
            for program in Path(path).iterdir():
                link = programs / program.name
                if not any(name in program.name for name in COMPILERS) and not link.exists():
                    link.symlink_to(program)
    return clean() | {"PATH": str(programs), "CC": "/nonexistent", "CXX": "/nonexistent"}
