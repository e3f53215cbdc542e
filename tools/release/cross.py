"""Zig as the compiler for other systems and processors, and the environment in which Python's tools build for these."""

import importlib
import os
import shutil
import stat
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

STABLE = (3, 12)
"""From this Python on one wheel is enough: it asks for names that are in all of them."""
PYCONFIG = """/* What PC/pyconfig.h of CPython says to extensions of the stable ABI on Windows with 64 bits. */
#define MS_WINDOWS
#define MS_WIN64
#define HAVE_DECLSPEC_DLL
#define Py_ENABLE_SHARED 1
#define HAVE_WCHAR_H 1
#define SIZEOF_SHORT 2
#define SIZEOF_INT 4
#define SIZEOF_LONG 4
#define SIZEOF_LONG_LONG 8
#define SIZEOF_VOID_P 8
#define SIZEOF_SIZE_T 8
#define SIZEOF_WCHAR_T 2
"""


@dataclass(frozen=True)
class Target:
    """A system and a processor: what Zig, CMake and wheels call them. Without Zig it is this machine."""

    platform: str
    zig: str = ""
    system: str = "Linux"

    @property
    def processor(self) -> str:
        """The processor's name for CMake."""
        return self.zig.partition("-")[0]

    @property
    def tag(self) -> str:
        """The end of the names of wheels."""
        return self.platform.replace("-", "_").replace(".", "_")


LINUX = Target("linux-x86_64"), Target("linux-aarch64", "aarch64-linux-gnu.2.17")
FOREIGN = (
    Target("win-amd64", "x86_64-windows-gnu", "Windows"),
    Target("win-arm64", "aarch64-windows-gnu", "Windows"),
    Target("macosx-11.0-arm64", "aarch64-macos.11.0", "Darwin"),
    Target("macosx-11.0-x86_64", "x86_64-macos.11.0", "Darwin"),
)


def clean() -> dict[str, str]:
    """The environment without what points to this checkout."""
    return {
        name: value
        for name, value in os.environ.items()
        if name not in ("PYTHONPATH", "VIRTUAL_ENV")
    }


def zig(folder: Path, *words: str) -> None:
    """Run Zig in a folder."""
    subprocess.run(
        [sys.executable, "-I", "-m", "ziglang", *words], cwd=folder, check=True, env=clean()
    )


def compilers(folder: Path, target: Target, python: Path) -> dict[str, str]:
    """Compilers for a target, and what makes Python's tools believe in it."""
    code = "import sysconfig; print(sysconfig.get_config_var('EXT_SUFFIX'), sysconfig.get_path('include'))"
    run = subprocess.run(
        [python, "-c", code], capture_output=True, text=True, check=True, env=clean()
    )
    suffix, include = run.stdout.split()
    flags = [f"-DCMAKE_SYSTEM_NAME={target.system}", f"-DCMAKE_SYSTEM_PROCESSOR={target.processor}"]
    # This machine's programs do not know such files; CMake has no names to change in them.
    flags += ["-DCMAKE_STRIP=true", "-DCMAKE_INSTALL_NAME_TOOL=true"]
    if target.system == "Windows":
        flags += _python_for_windows(folder, target, Path(include))
    # Zig's headers for C++ do not bring stdio.h along, as GNU's do.
    compiled = f"-target {target.zig} -include stdio.h"
    programs = {
        "C_COMPILER": f"cc {compiled}",
        "CXX_COMPILER": f"c++ {compiled}",
        "AR": "ar",
        "RANLIB": "ranlib",
    }
    for name, program in programs.items():
        path = folder / f"zig-{name.lower()}"
        # -I: pip's isolation hides this environment's libraries from programs of the same Python.
        path.write_text(
            f'#!/bin/sh\n{_FOR_MACOS}exec "{sys.executable}" -I -m ziglang {program} "$@"\n'
        )
        path.chmod(path.stat().st_mode | stat.S_IXUSR)
        flags.append(f"-DCMAKE_{name}={path}")
    return {
        "CMAKE_ARGS": " ".join(flags),
        "CMAKE_GENERATOR": "Ninja",
        "_PYTHON_HOST_PLATFORM": target.platform,
        "SETUPTOOLS_EXT_SUFFIX": suffix.replace("x86_64", target.processor),
    }


_FOR_MACOS = """# Zig links no bundles for macOS, and takes no lists of the names that Python defines.
for word; do
  shift
  case "$word" in
    -bundle) set -- "$@" -shared -undefined dynamic_lookup ;;
    -Wl,@*) ;;
    *) set -- "$@" "$word" ;;
  esac
done
"""


def of_stable_abi() -> list[str]:
    """The names in CPython's stable ABI, those of data marked as for a definition file."""
    abi3info: Any = importlib.import_module("abi3info")
    named = ((abi3info.FUNCTIONS, ""), (abi3info.DATAS, " DATA"))
    items = [(item, end) for table, end in named for item in table.values()]
    return sorted(
        f"{item.symbol.name}{end}"
        for item, end in items
        if (item.added.major, item.added.minor) <= STABLE
    )


def _python_for_windows(folder: Path, target: Target, include: Path) -> list[str]:
    """Headers, and import libraries of the stable ABI from its list: this Python's own are for Linux."""
    headers = shutil.copytree(include, folder / "include")
    (headers / "pyconfig.h").write_text(PYCONFIG)
    (folder / "python3.def").write_text(
        "\n".join(["LIBRARY python3.dll", "EXPORTS", *of_stable_abi(), ""])
    )
    machine = {"x86_64": "i386:x86-64", "aarch64": "arm64"}[target.processor]
    zig(folder, "dlltool", "-m", machine, "-d", "python3.def", "-l", "python3.lib")
    usual = shutil.copy(folder / "python3.lib", folder / f"{include.name.replace('.', '')}.lib")
    found = {"INCLUDE_DIR": headers, "LIBRARY": usual, "SABI_LIBRARY": folder / "python3.lib"}
    return [f"-DPython_{name}={path}" for name, path in found.items()]
