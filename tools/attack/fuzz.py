"""Coverage-guided fuzzing with atheris: `python -m tools.attack fuzz --seconds N`; exit code 1 if a target falls.

Compiled kernels are instrumented, too: libFuzzer follows their coverage, and AddressSanitizer and traps turn a read or
write outside an array, and undefined behavior, into a finding. `python -m tools.attack.fuzz TARGET [options]` is one
target in one process, with options of libFuzzer.
"""

import argparse
import logging
import os
import re
import resource
import shlex
import shutil
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from types import FunctionType, ModuleType

try:
    import atheris
except ImportError:
    raise SystemExit("fuzzing needs atheris, of the extra fuzz: pip install '.[fuzz]'") from None

from tools.attack.mutate import mutate_stream
from tools.attack.targets import MESH_FILE, SLOW, TARGETS, Finding, Target, run, seeds
from tools.copies import refuse_other_kernels

ROOT = Path(__file__).parents[2]
FUZZED = ROOT / "build" / "fuzzed"
MEMORY_MIB = 2048
"""Of a whole process, the interpreter, the sanitizer and the corpus included."""
_OPTIONS = "-DBSM_FUZZ=ON -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++"
HANG_SECONDS = 120
"""After which libFuzzer ends a process; the second that an execution may take is watched by the worker."""


@dataclass(frozen=True)
class Outcome:
    """What became of one target."""

    target: str
    executions: int
    coverage: int
    seconds: float
    found: tuple[Path, ...]
    log: str


def main() -> int:
    """Run the command."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=120.0, help="for all targets together (default: %(default)s)")
    parser.add_argument(
        "--targets", nargs="+", choices=TARGETS, default=list(TARGETS), metavar="NAME", help=", ".join(TARGETS)
    )
    parser.add_argument(
        "--corpus", type=Path, default=Path(".cache/fuzz"), help="inputs are kept here (default: %(default)s)"
    )
    args = parser.parse_args()
    shares = {name: 2.0 if name in SLOW else 1.0 for name in args.targets}
    outcomes = []
    sources, corpus = instrumented(), args.corpus.resolve()
    for name, share in shares.items():
        outcome = attack(name, args.seconds * share / sum(shares.values()), corpus, sources)
        outcomes.append(outcome)
        found = f", FOUND {', '.join(map(str, outcome.found))}" if outcome.found else ""
        print(
            f"{name:20} {outcome.executions:10} executions {outcome.seconds:7.0f} s {outcome.coverage:6} edges{found}",
            flush=True,
        )
        if outcome.found:
            print(trouble(outcome.log))
    total = sum(outcome.executions for outcome in outcomes)
    bad = sum(len(outcome.found) for outcome in outcomes)
    seconds = sum(outcome.seconds for outcome in outcomes)
    print(f"{'all':20} {total:10} executions {seconds:7.0f} s, {bad} findings")
    return 1 if bad else 0


def attack(name: str, seconds: float, corpus: Path, sources: Path) -> Outcome:
    """Run one worker; at least one pass over its seeds."""
    kept, findings = corpus / name, corpus / f"{name}-findings"
    for folder in (kept, findings):
        folder.mkdir(parents=True, exist_ok=True)
    for number, data in enumerate(seeds(name)):
        (kept / f"seed-{number:03}").write_bytes(data)
    before = set(findings.iterdir())
    command = [
        *(sys.executable, "-m", "tools.attack.fuzz", name, str(kept)),
        *(f"-max_total_time={max(1, round(seconds))}", f"-timeout={HANG_SECONDS}", f"-rss_limit_mb={MEMORY_MIB}"),
        # These are by the clock, which a busy machine stretches; workers count processor time.
        f"-report_slow_units={HANG_SECONDS}",
        *(f"-artifact_prefix={findings}/", "-print_final_stats=1", "-max_len=65535", "-verbosity=1"),
    ]
    begin = time.monotonic()
    done = subprocess.run(
        command, cwd=sources, capture_output=True, text=True, errors="replace", env=environment(), check=False
    )
    new = tuple(sorted(set(findings.iterdir()) - before))
    log = done.stdout + done.stderr
    if done.returncode and not new:
        raise SystemExit(f"the worker of {name} failed:\n{log[-3000:]}")
    executions = max(map(int, re.findall(r"^#(\d+)", log, re.MULTILINE)), default=0)
    coverage = max(map(int, re.findall(r"cov: (\d+)", log)), default=0)
    return Outcome(name, executions, coverage, time.monotonic() - begin, new, log)


def trouble(log: str) -> str:
    """The part of a log that says what happened: a Python traceback, or else libFuzzer's own end."""
    begin = log.find("=== Uncaught Python exception")
    return log[begin : begin + 3000] if begin >= 0 else log[-3000:]


def instrumented() -> Path:
    """A copy of the sources with kernels that report coverage and check themselves; needs clang."""
    if not shutil.which("clang") or not shutil.which("clang++"):
        raise SystemExit("fuzzing compiles the kernels with clang, which is not here: install it (apt install clang)")
    script = f"set -e; python={shlex.quote(sys.executable)}; . tools/checking_copy.sh; checking_copy fuzzed {_OPTIONS}"
    subprocess.run(["bash", "-c", script], cwd=ROOT, check=True)
    return FUZZED


def environment() -> dict[str, str]:
    """The sanitizer with libFuzzer that atheris brings, loaded before everything else; one thread for BLAS."""
    standard = subprocess.run(
        ["clang++", "-print-file-name=libstdc++.so.6"], capture_output=True, text=True, check=True
    ).stdout.strip()
    return {
        **os.environ,
        "LD_PRELOAD": f"{Path(atheris.path()) / 'asan_with_fuzzer.so'} {standard}",
        "ASAN_OPTIONS": "detect_leaks=0",
        "PYTHONPATH": f"{FUZZED}:{FUZZED}/src",
        "OMP_NUM_THREADS": "1",
        "OPENBLAS_NUM_THREADS": "1",
    }


SLOWEST = 3.0
"""That one execution may take; instrumented kernels are about three times slower than others."""
SMALL = 1 << 16
GUIDING = ("bsm.bitstream.", "bsm.codec.", "bsm.files.")
"""Whose functions' coverage guides the fuzzer, beside that of the kernels."""
MEMORY = 256 << 20
"""Bytes that one execution may add to the highest memory use so far."""


def work() -> None:
    """Fuzz until libFuzzer's options say stop; the process ends inside."""
    refuse_other_kernels()
    name = sys.argv[1]
    target = TARGETS[name]
    for data in seeds(name):  # so that nothing is imported while the fuzzer counts
        run(target, data)
    instrument()

    def path(data: bytes) -> None:
        before = _peak()
        seconds = _seconds(target, data)
        if _peak() - before > MEMORY:
            raise Finding(f"{(_peak() - before) >> 20} MiB for {len(data)} bytes")
        # What had to be loaded on the way is not slow the second time.
        if seconds > SLOWEST and len(data) < SMALL and (seconds := _seconds(target, data)) > SLOWEST:
            raise Finding(f"{seconds:.1f} s for {len(data)} bytes")

    def mutate(data: bytes, max_size: int, seed: int) -> bytes:
        return mutate_stream(data, max_size, seed, atheris.Mutate)

    options = {"custom_mutator": mutate} if name != MESH_FILE else {}
    atheris.Setup([sys.argv[0], *sys.argv[2:]], path, **options)
    atheris.Fuzz()


def instrument() -> None:
    """Follow the coverage of every Python function of the decoders; the kernels report theirs themselves."""
    logging.disable(logging.WARNING)
    followed = sum(
        _instrument_module(module) for name, module in sorted(sys.modules.items()) if name.startswith(GUIDING)
    )
    if not followed:
        raise SystemExit(f"no function of {', '.join(GUIDING)} is followed: nothing would guide the fuzzer but kernels")


def _instrument_module(module: ModuleType) -> int:
    """Follow the functions of a module, and say how many there are."""
    followed = 0
    for item in vars(module).values():
        members = vars(item).values() if isinstance(item, type) else [item]
        for function in members:
            plain = function.fget if isinstance(function, property) else getattr(function, "__func__", function)
            if isinstance(plain, FunctionType) and plain.__module__ == module.__name__:
                atheris.instrument_func(plain)
                followed += 1
    return followed


def _seconds(target: Target, data: bytes) -> float:
    """Processor time of all threads."""
    begin = time.process_time()
    run(target, data)
    return time.process_time() - begin


def _peak() -> int:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024


if __name__ == "__main__":
    work()
