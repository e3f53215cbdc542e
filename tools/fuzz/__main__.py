"""`python -m tools.fuzz --seconds N`: attack every target for its share of N seconds; exit code 1 if one falls."""

from __future__ import annotations

import argparse
import os
import re
import shlex
import shutil
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

import atheris

from tools.fuzz.targets import SLOW, TARGETS, VECTORS, seeds

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
    parser = argparse.ArgumentParser(prog="python -m tools.fuzz", description=__doc__)
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
    for number, data in enumerate(seeds(name, VECTORS)):
        (kept / f"seed-{number:03}").write_bytes(data)
    before = set(findings.iterdir())
    command = [
        *(sys.executable, "-m", "tools.fuzz.worker", name, str(kept)),
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


if __name__ == "__main__":
    sys.exit(main())
