"""The same bits by any compiler, for any processor and host; found by pkg-config and CMake, without warnings."""

import importlib.util
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import bsm
from tests.library.conftest import linked
from tools.amalgamate import ROOT
from tools.bsmdec import WARNINGS, build, compiled, decode, of_sequence
from tools.processors.__main__ import NotHere, complaint, lines, prepare, program
from tools.release.windows import build_all, compare, find_wine
from tools.vectors.store import read_manifest

AVX2 = ("avx2", "fma")
BUILDS = [*(("gcc", wanted) for wanted in ((), AVX2, None)), ("clang", AVX2), ("clang", None)]
UNSUPPORTED = 5


def has(*wanted: str) -> bool:
    """Whether this is an x86-64 with these instructions."""
    cpu = Path("/proc/cpuinfo")
    return cpu.exists() and set(wanted) <= set(cpu.read_text().split())


@pytest.mark.slow
@pytest.mark.parametrize(("compiler", "wanted"), BUILDS)
def test_every_build_gives_the_same_bits(compiler: str, wanted: tuple[str, ...] | None) -> None:
    """For a level of x86-64, and (None) with all of them, of which the program chooses the highest when it runs.

    No flag says that nothing may be fused.
    """
    flags = (
        ["-DKERNEL_ONE_TARGET", *(f"-m{build}" for build in wanted)] if wanted is not None else []
    )
    if shutil.which(compiler) is None or not has(*(wanted or ())):
        pytest.skip(f"no {compiler} here, or a processor without {' '.join(wanted or ())}")
    library = build("-O1", *flags, compiler=compiler)
    for vector in read_manifest():
        if vector.error is not None:
            continue
        found = decode(library, vector.stream.read_bytes())
        arrays = of_sequence(found) if "-sequence" in vector.name else dict(found.arrays)
        assert vector.complaint(arrays.pop("positions"), arrays.pop("faces"), arrays) is None, (
            vector.name
        )


REFUSED = [
    ("gcc", "-ffast-math"),
    ("gcc", "-Ofast"),
    ("gcc", "-funsafe-math-optimizations"),
    ("gcc", "-mfpmath=387"),
]


@pytest.mark.parametrize(("compiler", "flag"), [*REFUSED, ("clang", "-ffast-math")])
def test_a_build_that_computes_otherwise_is_not_compiled(compiler: str, flag: str) -> None:
    if shutil.which(compiler) is None or not has("sse2"):
        pytest.skip(f"no {compiler} here, or no x86-64")
    made = compiled()
    command = [
        compiler,
        "-std=gnu11",
        flag,
        "-w",
        "-fsyntax-only",
        "-DKERNEL_ONE_TARGET",
        made / "bsmdec.c",
    ]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    assert run.returncode != 0
    assert "error" in run.stderr
    assert "compile BSM with" in run.stderr


@pytest.mark.slow
@pytest.mark.parametrize(
    "flags",
    [
        ("-ffp-contract=fast", "-mfma"),
        ("-fassociative-math", "-fno-signed-zeros", "-fno-trapping-math"),
    ],
)
def test_a_build_that_computes_otherwise_decodes_nothing(flags: tuple[str, ...]) -> None:
    """Clang's pragma gives way to a flag, and no macro tells: running shows it."""
    if shutil.which("clang") is None or not has("fma"):
        pytest.skip("no clang here, or a processor that fuses nothing")
    library = build("-O2", "-DKERNEL_ONE_TARGET", *flags, compiler="clang")
    for name in ("good-fine", "good-tetrahedron", "bad-magic"):
        found = decode(library, (ROOT / f"spec/vectors/1.0/{name}.bsm").read_bytes())
        assert found.status == UNSUPPORTED
        assert "IEEE 754" in found.message


@pytest.mark.slow
def test_the_arithmetic_of_the_host_changes_nothing(tmp_path: Path) -> None:
    """A host that rounds upward and flushes small numbers gets the same bits, and its arithmetic back."""
    made, vectors = compiled(), sorted((ROOT / "spec/vectors").glob("*/*.bsm"))
    fingerprint = linked(
        made, ROOT / "tools/processors/fingerprint.c", tmp_path / "fingerprint", "-w"
    )
    usual, unusual = (run(fingerprint, *options, *vectors) for options in ((), ("-u",)))
    assert len(usual.splitlines()) == len(vectors)
    assert unusual == usual


CRATE = Path(__file__).parents[2] / "library/rust"


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("cargo") is None, reason="no Rust here")
def test_the_crate_passes_its_tests_and_its_example_runs(tmp_path: Path) -> None:
    own = {
        "CARGO_TARGET_DIR": str(tmp_path),
        "PYTHON": sys.executable,
        "CFLAGS": "-O0 -DKERNEL_ONE_TARGET",
    }
    for command in (["test"], ["run", "--example", "encode"]):
        words = [
            "cargo",
            *command,
            "--offline",
            "--quiet",
            "--locked",
            "--manifest-path",
            CRATE / "Cargo.toml",
        ]
        done = subprocess.run(
            words, cwd=tmp_path, env=os.environ | own, capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, done.stdout + done.stderr
    assert len(bsm.load(tmp_path / "tetrahedron.bsm").faces) == 4


@pytest.mark.slow
def test_the_dll_gives_the_same_bits(tmp_path: Path) -> None:
    wine = find_wine()
    if wine is None or importlib.util.find_spec("ziglang") is None or shutil.which("cc") is None:
        pytest.skip("no Wine, Zig or C compiler here")
    subprocess.run([sys.executable, "-m", "tools.amalgamate", tmp_path], cwd=ROOT, check=True)
    (tmp_path / "inside").mkdir()
    build_all(tmp_path, tmp_path / "inside", ROOT)
    compare(tmp_path, tmp_path / "inside", ROOT, wine)


STREAM = ROOT / "spec/vectors/1.0/good-tetrahedron.bsm"
STANDARDS = [("c", "c99"), ("c", "c11"), *(("c++", f"c++{year}") for year in (11, 14, 17, 20))]
PROGRAM = """#include <stdio.h>
#include "bsmdec.h"
int main(void) { return puts(bsmdec_version()) < 0; }
"""
CONSUMER = """cmake_minimum_required(VERSION 3.20)
project(consumer C)
find_package(bsmdec {wanted} REQUIRED)
foreach(target bsmdec bsmdec_static bsm bsm_static)
  add_executable(with_${{target}} main.c)
  target_link_libraries(with_${{target}} bsmdec::${{target}})
endforeach()
"""


def run(
    *command: str | Path, folder: Path | None = None, environment: dict[str, str] | None = None
) -> str:
    done = subprocess.run(
        command, cwd=folder, capture_output=True, text=True, check=False, env=environment
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def exported(file: Path) -> set[str]:
    """Names that a file of code shows to others."""
    dynamic = ["-D"] if ".so" in file.name else []
    lines = run("nm", "-g", "--defined-only", *dynamic, file).splitlines()
    return {line.split()[2] for line in lines if len(line.split()) == 3}


@pytest.mark.parametrize("compiler", ["gcc", "clang"])
@pytest.mark.parametrize(("language", "standard"), STANDARDS)
def test_the_header_has_no_warnings(compiler: str, language: str, standard: str) -> None:
    if shutil.which(compiler) is None:
        pytest.skip(f"no {compiler} here")
    strict = [
        "-Wconversion",
        *(["-Wold-style-cast"] if language == "c++" else ["-Wstrict-prototypes"]),
    ]
    run(
        compiler,
        "-x",
        language,
        f"-std={standard}",
        *WARNINGS,
        *strict,
        "-fsyntax-only",
        ROOT / "library/bsmdec.h",
    )


def test_nothing_else_is_exported() -> None:
    names = exported(compiled() / "bsmdec.so")
    assert {"bsmdec_open", "bsmdec_decode"} <= names
    assert not [name for name in names if not name.startswith("bsmdec_")]


@pytest.mark.slow
def test_clang_has_no_warnings(tmp_path: Path) -> None:
    if shutil.which("clang") is None:
        pytest.skip("no clang here")
    made = compiled()
    run(
        "clang",
        "-std=gnu11",
        "-ffp-contract=off",
        *WARNINGS,
        "-c",
        made / "bsmdec.c",
        "-o",
        tmp_path / "bsmdec.o",
    )
    assert not [name for name in exported(tmp_path / "bsmdec.o") if not name.startswith("bsmdec_")]


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Version 1.1 of what an archive has, by the command of its README, and moved behind that."""
    folder = tmp_path_factory.mktemp("archive")
    subprocess.run([sys.executable, "-m", "tools.amalgamate", folder], cwd=ROOT, check=True)
    for example in ("dec.c", "enc.c"):
        shutil.copy(ROOT / "library/examples" / example, folder)
    lists = (ROOT / "library/CMakeLists.txt").read_text()
    (folder / "CMakeLists.txt").write_text(lists.replace("VERSION 1.0.0", "VERSION 1.1.0"))
    quickly = "-DCMAKE_C_FLAGS=-O0 -DKERNEL_ONE_TARGET -Werror"
    options = ["-DCMAKE_BUILD_TYPE=None", quickly, "-DCMAKE_DISABLE_FIND_PACKAGE_Python3=ON"]
    run("cmake", "-S", ".", "-B", "build", *options, folder=folder)
    run("cmake", "--build", "build", folder=folder)
    run("cmake", "--install", "build", "--prefix", folder / "first", folder=folder)
    (folder / "first").rename(folder / "prefix")
    (folder / "main.c").write_text(PROGRAM)
    return folder


@pytest.mark.slow
def test_installed_libraries_export_nothing_else(installed: Path) -> None:
    objects = [*installed.rglob("*bsm*.c.o"), *installed.glob("prefix/lib/libbsm*.*")]
    assert {file.suffix for file in objects} >= {".o", ".a", ".so"}
    for file in objects:
        names = exported(file)
        assert "bsmdec_open" in names and ("bsmenc_encode" in names) == ("bsmdec" not in file.name)
        assert not [name for name in names if not name.startswith(("bsmdec_", "bsmenc_"))]


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("pkg-config") is None, reason="no pkg-config here")
def test_pkg_config_finds_it_wherever_it_is(installed: Path) -> None:
    prefix = installed / "prefix"
    path = {"PKG_CONFIG_PATH": str(prefix / "lib/pkgconfig"), "PATH": "/usr/bin:/bin"}
    for name, source in (("bsmdec", "main.c"), ("bsm", "enc.c")):
        flags = run("pkg-config", "--cflags", "--libs", f"{name} >= 1.0", environment=path).split()
        assert [Path(flag[2:]).resolve() for flag in flags[:2]] == [
            prefix / "include",
            prefix / "lib",
        ]
        run("cc", installed / source, *flags, f"-Wl,-rpath,{prefix}/lib", "-o", installed / name)
    assert run(installed / "bsmdec").strip() == "1.0.0"


@pytest.mark.slow
def test_cmake_finds_a_later_minor_version(installed: Path) -> None:
    prefix = f"-DCMAKE_PREFIX_PATH={installed / 'prefix'}"
    lists = installed / "consumer/CMakeLists.txt"
    lists.parent.mkdir()
    shutil.copy(installed / "main.c", lists.parent)
    for wanted, found in (("2.0", False), ("1.2", False), ("1.1", True), ("1.0", True)):
        lists.write_text(CONSUMER.format(wanted=wanted))
        build = lists.parent / f"build-{wanted}"
        done = subprocess.run(
            ["cmake", "-S", lists.parent, "-B", build, prefix],
            capture_output=True,
            text=True,
            check=False,
        )
        assert (done.returncode == 0) is found, done.stderr
    run("cmake", "--build", lists.parent / "build-1.0")
    for target in ("bsmdec", "bsmdec_static", "bsm", "bsm_static"):
        assert run(lists.parent / f"build-1.0/with_{target}").strip() == "1.0.0"


@pytest.mark.slow
def test_a_checkout_is_built_by_the_same_command(tmp_path: Path) -> None:
    quickly = ["-DCMAKE_BUILD_TYPE=None", "-DCMAKE_C_FLAGS=-O0 -DKERNEL_ONE_TARGET -Werror"]
    run("cmake", "-S", ROOT / "library", "-B", tmp_path / "b", *quickly)
    run("cmake", "--build", tmp_path / "b")
    run("cmake", "--install", tmp_path / "b", "--prefix", tmp_path / "p")
    run(tmp_path / "p/bin/bsmdec", STREAM, tmp_path / "a.obj")
    run(tmp_path / "p/bin/bsmenc", tmp_path / "a.obj", tmp_path / "a.bsm")
    assert len(bsm.decode(tmp_path / "a.bsm").faces) == 4


@pytest.mark.slow
def test_other_processors_decode_the_same() -> None:
    """Large numbers first and products fused; `python -m tools.processors` takes all processors and vectors.

    Zig compiles the C library of each processor anew, which takes longer than everything else here.
    """
    folder, streams = (
        ROOT / ".cache/processors",
        sorted((ROOT / "spec/vectors").glob("*/*.bsm"))[::8],
    )
    prepare(folder)
    here = program(folder, "here", ["cc", "-O1"])
    assert isinstance(here, Path)
    expected = lines([str(here)], folder, streams)
    assert len(expected) == len(streams)
    try:
        assert complaint(folder, "s390x", expected, streams, "-O1") is None
    except NotHere as error:
        pytest.skip(str(error))
