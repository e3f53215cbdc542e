"""What the extension of a wheel for another system asks that system for: Python's stable ABI and the C library."""

import importlib
import re
import subprocess
import tempfile
import zipfile
from pathlib import Path

from tools.release.cross import Target, of_stable_abi

# macOS looks names of no library up when it loads the file.
PYTHON = ("python3.dll", "flat-namespace")
SYSTEM = ("kernel32.dll", "api-ms-win-crt-", "libSystem")


def check_imports(wheel: Path, target: Target) -> None:
    """Refuse names that no Python or no system of this kind has."""
    with tempfile.TemporaryDirectory() as folder:
        zipfile.ZipFile(wheel).extractall(folder)
        (file,) = Path(folder, "bsm").glob("_core.*")
        found = _of_windows(file) if target.system == "Windows" else _of_macos(file, target)
    stable = {name.partition(" ")[0] for name in of_stable_abi()}
    of_python = {name for library, name in found if library in PYTHON}
    strange = {library for library, _ in found if not library.startswith((*PYTHON, *SYSTEM))} | (
        of_python - stable
    )
    if strange or not of_python:
        raise SystemExit(
            f"{wheel.name} asks for what may not be there: {', '.join(sorted(strange)) or 'no Python'}"
        )


def _of_windows(file: Path) -> list[tuple[str, str]]:
    """Libraries and names that a DLL imports."""
    tables = importlib.import_module("pefile").PE(str(file)).DIRECTORY_ENTRY_IMPORT
    return [
        (table.dll.decode().lower(), entry.name.decode())
        for table in tables
        for entry in table.imports
    ]


def _of_macos(file: Path, target: Target) -> list[tuple[str, str]]:
    """Libraries and names that a dynamic library binds."""
    words: list[str | Path] = [
        "llvm-objdump",
        "--macho",
        "--private-headers",
        "--bind",
        "--lazy-bind",
        file,
    ]
    shown = subprocess.run(words, capture_output=True, text=True, check=True).stdout
    lowest = target.zig.rpartition("macos.")[2]
    signed = "LC_CODE_SIGNATURE" in shown or target.processor != "aarch64"
    if f"minos {lowest}\n" not in shown or not signed:
        raise SystemExit(f"{file.name} is not signed, or not for macOS {lowest}")
    return re.findall(r"^__DATA.*\s(\S+)\s+_?(\w+)$", shown, flags=re.MULTILINE)
