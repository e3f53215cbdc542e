"""The library for Windows, a DLL and two programs cross-compiled by Zig: the bits of the one for Linux under Wine."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

from tools.release.wheels import clean

TARGET = "x86_64-windows-gnu"
FLAGS = ("-std=gnu11", "-O3", "-ffp-contract=off")
README = """# bsmdec for Windows on x86-64

Decoder and encoder of BSM streams as a DLL for any compiler and engine, MSVC included. It needs Windows 10 or later.

- `bsmdec.h` and `bsmenc.h` are the interface: define BSMDEC_SHARED before you include them.
- Link `bsmdec.lib`, and put `bsmdec.dll` beside your program. In Unity, `Assets/Plugins` is the place.
- In a command prompt, `bsmdec mesh.bsm mesh.obj` decodes the shape of a stream, and `bsmenc mesh.obj mesh.bsm` encodes
  that of an OBJ on a grid of 14 bits (`bsmenc mesh.obj mesh.bsm 16`: of 16, `0`: exactly in single precision).
"""


def make_windows(sources: Path, version: str, output: Path) -> Path:
    """The DLL with its header, import library and licence; compared over all vectors where Wine is."""
    with tempfile.TemporaryDirectory() as folder:
        inside = Path(folder, "inside")
        inside.mkdir()
        subprocess.run([sys.executable, "-m", "tools.amalgamate", folder], cwd=sources, check=True)
        build_all(Path(folder), inside, sources)
        for name in (sources / "LICENSE", Path(folder, "bsmdec.h"), Path(folder, "bsmenc.h")):
            shutil.copy(name, inside)
        (inside / "README.md").write_text(README)
        wine = find_wine()
        if wine is None:
            print("note: the DLL was not run, since there is no Wine", file=sys.stderr)
        else:
            compare(Path(folder), inside, sources, wine)
        return zipped(output / f"bsmdec-{version}-windows-x86_64.zip", inside)


def find_wine() -> str | None:
    """Find Wine, also where Debian puts it without a link."""
    return shutil.which("wine64") or shutil.which("wine") or shutil.which("/usr/lib/wine/wine64")


def build_all(folder: Path, inside: Path, sources: Path) -> None:
    """Compile bsm.c of a folder to a DLL with its import library, and the programs."""
    options = [*FLAGS, "-DBSMDEC_EXPORT", "-shared", "-s"]
    zig(folder, *options, "bsm.c", f"-Wl,--out-implib,{inside / 'bsmdec.lib'}", "-o", str(inside / "bsmdec.dll"))
    for name, library in (("dec", "bsmdec.c"), ("enc", "bsm.c")):
        program = str(sources / "library/examples" / f"{name}.c")
        zig(folder, *FLAGS, "-s", "-I.", program, library, "-o", str(inside / f"bsm{name}.exe"))


def zig(folder: Path, *words: str) -> None:
    """Run Zig's C compiler for Windows in a folder."""
    caches = {f"ZIG_{kind}_CACHE_DIR": str(folder / "cache") for kind in ("GLOBAL", "LOCAL")}
    command = [sys.executable, "-I", "-m", "ziglang", "cc", "-target", TARGET, *words]
    subprocess.run(command, cwd=folder, check=True, env=clean() | caches)


def compare(folder: Path, dll: Path, sources: Path, wine: str) -> None:
    """Decode all vectors with the DLL of a folder under Wine, and with the library for this machine; encode one."""
    program = str(sources / "tools/release/digests.c")
    streams = sorted(map(str, (sources / "spec/vectors").glob("*/*.bsm")))
    subprocess.run(["cc", *FLAGS, "-I.", program, "bsmdec.c", "-lm", "-o", "native"], cwd=folder, check=True)
    zig(folder, "-O1", "-DBSMDEC_SHARED", "-I.", program, str(dll / "bsmdec.lib"), "-o", "digests.exe")
    shutil.copy(dll / "bsmdec.dll", folder)
    quiet = clean() | {"WINEPREFIX": str(folder / "wine"), "WINEDEBUG": "-all", "HOME": str(folder)}
    found = _output([wine, "digests.exe", *(f"Z:{stream}" for stream in streams)], folder, quiet)
    expected = _output([str(folder / "native"), *streams], folder, clean())
    stream = f"Z:{sources / 'spec/vectors/1.0/good-tetrahedron.bsm'}"
    for end, given, written in (("dec", stream, "a.obj"), ("enc", "a.obj", "a.bsm"), ("dec", "a.bsm", "b.obj")):
        _output([wine, str(dll / f"bsm{end}.exe"), given, written], folder, quiet)
    if (folder / "b.obj").read_text().count("\nf ") != 4:
        raise SystemExit("bsmenc.exe and bsmdec.exe do not bring a tetrahedron back")
    differ = [name for name, own, wanted in zip(streams, found, expected, strict=True) if own != wanted]
    if differ or len(expected) < 500:
        raise SystemExit(
            f"the DLL decodes {', '.join(differ) or 'too few vectors'} otherwise than the library for Linux"
        )


def zipped(path: Path, folder: Path) -> Path:
    """A zip that is the same whenever it is made of the same files."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for file in [*sorted(folder.glob("bsm*.*")), folder / "LICENSE", folder / "README.md"]:
            if file.suffix != ".pdb":
                entry = zipfile.ZipInfo(file.name)
                entry.compress_type = zipfile.ZIP_DEFLATED
                archive.writestr(entry, file.read_bytes())
    return path


def _output(command: list[str], folder: Path, environment: dict[str, str]) -> list[str]:
    done = subprocess.run(command, cwd=folder, env=os.environ | environment, check=True, capture_output=True, text=True)
    return done.stdout.splitlines()
