"""The same positions to the last bit, whatever compiler made the decoder and for whatever processor, or no decoder."""

import importlib.util
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.engine.decoding import build, compiled, decode, of_sequence
from tools.amalgamate import ROOT
from tools.release.windows import build_dll, compare, find_wine
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
    flags = ["-DKERNEL_ONE_TARGET", *(f"-m{build}" for build in wanted)] if wanted is not None else []
    if shutil.which(compiler) is None or not has(*(wanted or ())):
        pytest.skip(f"no {compiler} here, or a processor without {' '.join(wanted or ())}")
    library = build("-O1", *flags, compiler=compiler)
    for vector in read_manifest():
        if vector.error is not None:
            continue
        found = decode(library, vector.stream.read_bytes())
        arrays = of_sequence(found) if "-sequence" in vector.name else dict(found.arrays)
        assert vector.complaint(arrays.pop("positions"), arrays.pop("faces"), arrays) is None, vector.name


REFUSED = [("gcc", "-ffast-math"), ("gcc", "-Ofast"), ("gcc", "-funsafe-math-optimizations"), ("gcc", "-mfpmath=387")]


@pytest.mark.parametrize(("compiler", "flag"), [*REFUSED, ("clang", "-ffast-math")])
def test_a_build_that_computes_otherwise_is_not_compiled(compiler: str, flag: str) -> None:
    if shutil.which(compiler) is None or not has("sse2"):
        pytest.skip(f"no {compiler} here, or no x86-64")
    made = compiled()
    command = [compiler, "-std=gnu11", flag, "-w", "-fsyntax-only", "-DKERNEL_ONE_TARGET", made / "bsmdec.c"]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    assert run.returncode != 0
    assert "error" in run.stderr
    assert "compile BSM with" in run.stderr


@pytest.mark.slow
@pytest.mark.parametrize(
    "flags", [("-ffp-contract=fast", "-mfma"), ("-fassociative-math", "-fno-signed-zeros", "-fno-trapping-math")]
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
    source = ROOT / "tools/processors/fingerprint.c"
    command = ["cc", "-w", f"-I{made}", f"-I{ROOT}", source, "-o", "fingerprint"]
    subprocess.run([*command, made / "bsmdec.so", "-lm", f"-Wl,-rpath,{made}"], check=True, cwd=tmp_path)
    usual, unusual = (
        subprocess.run(
            [tmp_path / "fingerprint", *options, *vectors], check=True, capture_output=True, text=True
        ).stdout
        for options in ((), ("-u",))
    )
    assert len(usual.splitlines()) == len(vectors)
    assert unusual == usual


CRATE = Path(__file__).parents[2] / "engine/rust"


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("cargo") is None, reason="no Rust here")
def test_the_crate_passes_its_tests(tmp_path: Path) -> None:
    own = {"CARGO_TARGET_DIR": str(tmp_path), "PYTHON": sys.executable, "CFLAGS": "-O1 -DKERNEL_ONE_TARGET"}
    command = ["cargo", "test", "--offline", "--quiet", "--locked"]
    done = subprocess.run(command, cwd=CRATE, env=os.environ | own, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.slow
def test_the_dll_gives_the_same_bits(tmp_path: Path) -> None:
    wine = find_wine()
    if wine is None or importlib.util.find_spec("ziglang") is None or shutil.which("cc") is None:
        pytest.skip("no Wine, Zig or C compiler here")
    subprocess.run([sys.executable, "-m", "tools.amalgamate", tmp_path], cwd=ROOT, check=True)
    (tmp_path / "inside").mkdir()
    build_dll(tmp_path, tmp_path / "inside/bsmdec.dll")
    compare(tmp_path, tmp_path / "inside", ROOT, wine)
