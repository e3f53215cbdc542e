"""The same positions to the last bit, whatever compiler made the decoder, and for whatever processor."""

import shutil
from pathlib import Path

import pytest

from tests.engine.decoding import build, decode, of_sequence
from tools.vectors.store import read_manifest

AVX2 = ("avx2", "fma")
BUILDS = [*(("gcc", wanted) for wanted in ((), AVX2, None)), ("clang", None)]


@pytest.mark.slow
@pytest.mark.parametrize(("compiler", "wanted"), BUILDS)
def test_every_build_gives_the_same_bits(compiler: str, wanted: tuple[str, ...] | None) -> None:
    """For a level of x86-64, and (None) with all of them, of which the program chooses the highest when it runs."""
    flags = ["-DKERNEL_ONE_TARGET", *(f"-m{one}" for one in wanted)] if wanted is not None else []
    cpu = Path("/proc/cpuinfo")
    if shutil.which(compiler) is None or not (cpu.exists() and set(wanted or ()) <= set(cpu.read_text().split())):
        pytest.skip(f"no {compiler} here, or a processor without {' '.join(wanted or ())}")
    library = build("-O1", *flags, compiler=compiler)
    for vector in read_manifest():
        if vector.error is not None:
            continue
        found = decode(library, vector.stream.read_bytes())
        arrays = of_sequence(found) if "-sequence" in vector.name else dict(found.arrays)
        assert vector.complaint(arrays.pop("positions"), arrays.pop("faces"), arrays) is None, vector.name
