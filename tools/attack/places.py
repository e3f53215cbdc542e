"""Where decoders run: processors of other kinds, and environments of every kind.

Of a processor, a copy of the sources has the kernels of one level of x86-64 alone, however much the processor at hand
has; numpy and the library behind it are configured for the same.
"""

import os
import shlex
import shutil
import subprocess
import sys
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

import numpy as np

ROOT = Path(__file__).parents[2]
BUILD = ROOT / "build"


@dataclass(frozen=True)
class Place:
    """Where a process runs."""

    name: str
    sources: Path = ROOT
    variables: dict[str, str] = field(default_factory=dict)
    wrapper: tuple[str, ...] = ()
    flags: tuple[str, ...] = ()

    def run(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        """Run a module there: `python -m ARGUMENTS`."""
        command = [*self.wrapper, sys.executable, *self.flags, "-m", *arguments]
        path = f"{self.sources}{os.pathsep}{self.sources / 'src'}"
        there = {**os.environ, "PYTHONPATH": path, **self.variables}
        return subprocess.run(
            command,
            cwd=self.sources,
            env=there,
            capture_output=True,
            text=True,
            errors="replace",
            check=False,
        )


def processors(short: bool = False) -> tuple[Place, ...]:
    """Processors that the one at hand can stand in for: a level of x86-64, and what OpenBLAS calls one of it.

    `short` leaves the least alone: the greatest is what the kernels of a checkout run.
    """
    needs = {
        1: set(),
        2: {"sse4_2", "ssse3"},
        3: {"avx2", "fma", "bmi2"},
        4: {"avx512f", "avx512vl", "avx512dq"},
    }
    names = {1: "Prescott", 2: "Nehalem", 3: "Haswell", 4: "SkylakeX"}
    places = [
        _processor(level, names[level]) for level, needed in needs.items() if needed <= _flags()
    ]
    return tuple(places[:1] if short else places)


def _processor(level: int, blas: str) -> Place:
    return Place(
        f"x86-64-v{level}, {blas}",
        BUILD / f"level{level}",
        {
            "OPENBLAS_CORETYPE": blas,
            "OMP_NUM_THREADS": "1",
            "NPY_DISABLE_CPU_FEATURES": " ".join(_beyond(level)),
        },
    )


@cache
def _flags() -> frozenset[str]:
    """What the processor at hand has, as Linux calls it."""
    lines = Path("/proc/cpuinfo").read_text().splitlines()
    return frozenset(word for line in lines if line.startswith("flags") for word in line.split())


def _beyond(level: int) -> list[str]:
    """What numpy has code for and a processor of this level has not."""
    umath = np._core._multiarray_umath  # type: ignore[attr-defined]
    return [
        name
        for name in umath.__cpu_dispatch__
        if umath.__cpu_features__[name] and _level_of(name) > level
    ]


def _level_of(feature: str) -> int:
    if feature.startswith("X86_V"):
        return int(feature[-1])
    if feature.startswith("AVX512"):
        return 4 if feature in ("AVX512F", "AVX512CD", "AVX512_SKX") else 5
    return 2 if feature.startswith(("SSE", "POPCNT")) else 3


def build_processors(short: bool) -> None:
    """Make their copies of the sources; what has not changed is not compiled again."""
    for place in processors(short):
        name, python = place.sources.name, shlex.quote(sys.executable)
        script = f"set -e; python={python}; . tools/checking_copy.sh; checking_copy {name} -DBSM_LEVEL={name[-1]}"
        subprocess.run(["bash", "-c", script], cwd=ROOT, check=True)


def environments() -> tuple[Place, ...]:
    """What services, shells and other libraries do to a process."""
    variables = (
        {"LC_ALL": "C"},
        {"LC_ALL": "tr_TR.UTF-8", "LANG": "tr_TR.UTF-8"},
        {"PYTHONUTF8": "0", "LC_ALL": "POSIX"},
        {"PYTHONHASHSEED": "0"},
        {"PYTHONHASHSEED": "4294967295"},
        {"PYTHONMALLOC": "debug"},
        {"PYTHONMALLOC": "malloc", "MALLOC_PERTURB_": "165"},
        {"PYTHONMALLOC": "malloc", "MALLOC_PERTURB_": "90"},
        {"MALLOC_ARENA_MAX": "1"},
        {"PYTHONDEVMODE": "1"},
        {"PYTHONDONTWRITEBYTECODE": "1", "PYTHONNOUSERSITE": "1"},
        {"PYTHONINTMAXSTRDIGITS": "640"},
        {"OMP_NUM_THREADS": "1"},
        {"OMP_NUM_THREADS": "64"},
        {"OPENBLAS_NUM_THREADS": "3", "OMP_DYNAMIC": "TRUE"},
        {"MKL_NUM_THREADS": "7", "GOMP_CPU_AFFINITY": "0"},
        {"HOME": "/nonexistent", "XDG_CACHE_HOME": "/nonexistent"},
        {"TZ": "Asia/Kathmandu", "COLUMNS": "1", "TERM": "dumb"},
        {"NPY_DISABLE_CPU_FEATURES": " ".join(_beyond(2))},
        {"OPENBLAS_CORETYPE": "Prescott"},
        {"PATH": "/nonexistent"},
        {"LD_BIND_NOW": "1"},
        {"PYTHONWARNINGS": "error"},
    )
    places = [
        Place(" ".join(f"{key}={value}" for key, value in values.items()), variables=values)
        for values in variables
    ]
    places += [
        Place(f"python {' '.join(flags)}", flags=flags)
        for flags in (("-O",), ("-OO",), ("-B", "-s"), ("-X", "dev"))
    ]
    limits = (
        "ulimit -n 24",
        "ulimit -s 512",
        "ulimit -c 0; umask 777",
        "ulimit -f 4096",
        "exec 0<&-",
        "exec 2>&-",
    )
    places += [
        Place(limit, wrapper=("bash", "-c", f'{limit}; exec "$@"', "bash")) for limit in limits
    ]
    if shutil.which("taskset"):
        places.append(Place("one core", wrapper=("taskset", "-c", "0")))
    if shutil.which("setsid"):
        places.append(Place("no terminal", wrapper=("setsid", "-w")))
    if shutil.which("gcc"):
        places.append(
            Place(
                "a library that flushes small numbers to zero",
                variables={"LD_PRELOAD": str(_flushing())},
            )
        )
    return tuple(places)


@cache
def _flushing() -> Path:
    """A library that sets the processor's bits FTZ and DAZ when it is loaded, as anything built by -ffast-math does."""
    library = BUILD / "flushing.so"
    BUILD.mkdir(exist_ok=True)
    source = "__attribute__((constructor)) static void on(void) { __builtin_ia32_ldmxcsr(0x9fc0); }"
    command = ["gcc", "-shared", "-fPIC", "-xc", "-", "-o", str(library)]
    subprocess.run(command, input=source, text=True, check=True)
    return library
