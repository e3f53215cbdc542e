"""What others compile or hold against their decoder: the C archive, the crate, the conformance suite."""

import gzip
import io
import json
import os
import shutil
import subprocess
import sys
import tarfile
import tempfile
from collections.abc import Iterable
from pathlib import Path

from tools.release.cross import clean
from tools.release.trial import try_newcomer

STREAM = "spec/vectors/1.0/good-tetrahedron.bsm"
EXAMPLES = ("dec.c", "enc.c", "frames.cpp", "threads.c")
README = """# bsmdec: decoder and encoder for BSM streams of triangle meshes, decoder of mesh sequences

From the archive to a mesh:

    tar xf bsmdec-*.tar.gz
    cc -O3 bsmdec-*/dec.c bsmdec-*/bsmdec.c -lm -o bsmdec && ./bsmdec mesh.bsm mesh.obj

`bsmdec.h` documents the whole interface. `bsm.c` also encodes (`bsmenc.h`), and `enc.c` writes a stream of an OBJ:
`bsmenc mesh.obj mesh.bsm`. The library needs GCC or Clang and nothing else. To install it:

    cmake -S . -B build && cmake --build build && cmake --install build --prefix PREFIX

CMake finds it by `find_package(bsmdec 1.0)`; the targets are `bsmdec::bsmdec` and `bsmdec::bsmdec_static`, and
with the encoder `bsmdec::bsm` and `bsmdec::bsm_static`. pkg-config finds them as `bsmdec` and `bsm`.
"""


def make_archive(sources: Path, version: str, output: Path) -> Path:
    """The decoder as one file of C with its header; compiled and installed."""
    with tempfile.TemporaryDirectory() as folder:
        inside = Path(folder, f"bsmdec-{version}")
        inside.mkdir()
        _amalgamate(sources, inside)
        for name in ("CMakeLists.txt", *(f"examples/{example}" for example in EXAMPLES)):
            shutil.copy(sources / "library" / name, inside)
        shutil.copy(sources / "LICENSE", inside)
        (inside / "README.md").write_text(README)
        path = archive(
            output / f"{inside.name}.tar.gz",
            [(f"{inside.name}/{f.name}", f) for f in inside.iterdir()],
        )
        _try_archive(inside, sources / STREAM)
    try_newcomer(path, README, sources / STREAM)
    return path


def make_crate(sources: Path, version: str, output: Path) -> Path:
    """The crate, with the file of C inside, as cargo packs it and builds it from what is packed."""
    crate = sources / "library/rust"
    _amalgamate(sources, crate)
    _run(["cargo", "package", "--offline", "--allow-dirty", "--quiet"], crate)
    made = shutil.copy(crate / f"target/package/bsmdec-{version}.crate", output)
    try_newcomer(Path(made), (crate / "README.md").read_text(), sources / STREAM)
    return Path(made)


def make_suite(sources: Path, version: str, output: Path) -> Path:
    """All vectors, their list and what it means, by which any decoder can be judged."""
    vectors = sources / "spec/vectors"
    listed = [
        vector
        for each in vectors.glob("*/manifest.json")
        for vector in json.loads(each.read_text())["vectors"]
    ]
    names = [str(path.relative_to(vectors)) for path in vectors.rglob("*") if path.is_file()]
    if len(listed) != sum(name.endswith(".bsm") for name in names):
        raise SystemExit("the lists of vectors do not name all streams")
    inside = f"bsm-conformance-{version}"
    return archive(
        output / f"{inside}.tar.gz", [(f"{inside}/{name}", vectors / name) for name in names]
    )


def archive(path: Path, files: Iterable[tuple[str, Path]]) -> Path:
    """A tar.gz that is the same whenever it is made of the same files."""
    plain = io.BytesIO()
    with tarfile.open(fileobj=plain, mode="w", format=tarfile.PAX_FORMAT) as tar:
        for name, file in sorted(files):
            entry = tarfile.TarInfo(name)
            entry.size, entry.mtime = (
                file.stat().st_size,
                int(os.environ.get("SOURCE_DATE_EPOCH", "0")),
            )
            with file.open("rb") as content:
                tar.addfile(entry, content)
    path.write_bytes(gzip.compress(plain.getvalue(), mtime=0))
    return path


def _amalgamate(sources: Path, folder: Path) -> None:
    subprocess.run([sys.executable, "-m", "tools.amalgamate", folder], cwd=sources, check=True)


def _try_archive(inside: Path, stream: Path) -> None:
    """With one command of the compiler, and installed; tests of the library find it by CMake and pkg-config."""
    made = inside.parent / "made"
    made.mkdir()
    prefix, build = made / "prefix", made / "build"
    _run(["cc", "-O3", "dec.c", "bsmdec.c", "-lm", "-o", made / "alone"], inside)
    _run(["cmake", "-S", inside, "-B", build], made)
    _run(["cmake", "--build", build], made)
    _run(["cmake", "--install", build, "--prefix", prefix], made)
    _run([made / "alone", stream, "alone.obj"], made)
    _run([prefix / "bin/bsmdec", stream, "installed.obj"], made)
    _run([prefix / "bin/bsmenc", "alone.obj", "again.bsm", "0"], made)
    _run([made / "alone", "again.bsm", "again.obj"], made)
    alone, installed, again = (
        (made / f"{name}.obj").read_bytes() for name in ("alone", "installed", "again")
    )
    if alone != installed or again.count(b"\nf ") != 4:
        raise SystemExit("the library does not decode a tetrahedron alike alone and installed")


def _run(command: list[str | Path], folder: Path) -> None:
    subprocess.run(command, cwd=folder, check=True, env=clean(), stdout=subprocess.DEVNULL)
