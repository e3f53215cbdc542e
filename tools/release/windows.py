"""The library for Windows, a DLL and two programs cross-compiled by Zig: the bits of the one for Linux under Wine."""

import shutil
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

from tools.processors.__main__ import lines
from tools.release.cross import zig

FLAGS = ("-target", "x86_64-windows-gnu", "-std=gnu11", "-O3", "-ffp-contract=off")
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
    zig(
        folder,
        "cc",
        *options,
        "bsm.c",
        f"-Wl,--out-implib,{inside / 'bsmdec.lib'}",
        "-o",
        str(inside / "bsmdec.dll"),
    )
    for name, library in (("dec", "bsmdec.c"), ("enc", "bsm.c")):
        program = str(sources / "library/examples" / f"{name}.c")
        zig(
            folder,
            "cc",
            *FLAGS,
            "-s",
            "-I.",
            program,
            library,
            "-o",
            str(inside / f"bsm{name}.exe"),
        )


def compare(folder: Path, inside: Path, sources: Path, wine: str) -> None:
    """Decode all vectors and encode them again with the DLL of a folder under Wine, and with the library here."""
    streams = sorted((sources / "spec/vectors").glob("*/*.bsm"))
    program = [
        "-w",
        "-include",
        "bsmenc.h",
        "-I.",
        f"-I{sources}",
        str(sources / "tools/processors/fingerprint.c"),
    ]
    subprocess.run(
        ["cc", *FLAGS[2:], *program, "bsm.c", "-lm", "-o", "native"], cwd=folder, check=True
    )
    zig(
        folder,
        "cc",
        *FLAGS,
        "-DBSMDEC_SHARED",
        *program,
        str(inside / "bsmdec.lib"),
        "-o",
        "fingerprint.exe",
    )
    shutil.copy(inside / "bsmdec.dll", folder)
    quiet = ["env", f"WINEPREFIX={folder}/wine", "WINEDEBUG=-all", f"HOME={folder}", wine]
    found = lines([*quiet, str(folder / "fingerprint.exe")], folder, streams)
    expected = lines([str(folder / "native")], folder, streams)
    stream = f"Z:{sources / 'spec/vectors/1.0/good-tetrahedron.bsm'}"
    for end, given, written in (
        ("dec", stream, "a.obj"),
        ("enc", "a.obj", "a.bsm"),
        ("dec", "a.bsm", "b.obj"),
    ):
        subprocess.run(
            [*quiet, str(inside / f"bsm{end}.exe"), given, written], cwd=folder, check=True
        )
    if (folder / "b.obj").read_text().count("\nf ") != 4:
        raise SystemExit("bsmenc.exe and bsmdec.exe do not bring a tetrahedron back")
    differ = [
        stream.name
        for stream, own, wanted in zip(streams, found, expected, strict=True)
        if own != wanted
    ]
    if differ or len(expected) < 500:
        raise SystemExit(
            f"the DLL takes {', '.join(differ) or 'too few vectors'} otherwise than the library for Linux"
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
