"""Hold the decoders against each other and against everything that can be thrown at them; exit code 1 on any finding.

    python -m tools.attack proof              the whole proof: a million mutants, three thousand streams everywhere
    python -m tools.attack proof --short      a minute of it, for every change
    python -m tools.attack proof --only mutants --seed 1

| suite | what it does |
|---|---|
| mutants | streams of all kinds with something changed behind right checksums: strict, in pieces, tolerant |
| browser | mutants by the browser's decoder, in Node |
| differential | mutants and random streams by today's decoder and that of release 1.0 |
| encodes | random meshes and sequences with random options: threads, pieces, tolerance, every kind of processor |
| surroundings | the same in environments of every kind |

Work is cut into shards, each a process of its own that follows from the seed alone. Streams that led to findings are
kept under `.cache/proof`.
"""

import argparse
import json
import os
import subprocess
import sys
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass
from pathlib import Path

from tools.attack.places import ROOT, build_processors, environments
from tools.attack.tally import Tally
from tools.command import parser_of

SHARD_SECONDS = 1800
INPUTS = {
    "mutants": (4000, 1_000_000, 4000),
    "browser": (4000, 1_000_000, 4000),
    "differential": (1000, 20_000, 500),
    "encodes": (50, 3000, 50),
}
"""Of each suite: inputs of one shard, in all, and in short."""
SURROUNDINGS = 12


@dataclass(frozen=True)
class Part:
    """One shard, and what came of it."""

    suite: str
    number: int
    size: int

    @property
    def name(self) -> str:
        """Name of its file."""
        return f"{self.suite}-{self.number}-{self.size}"


def main() -> int:
    """Run the command."""
    parser = parser_of(__doc__)
    parser.add_argument(
        "--short", action="store_true", help="a minute of everything, on two processors"
    )
    parser.add_argument("--only", nargs="+", metavar="SUITE", help="these suites alone")
    parser.add_argument("--seed", default="0", help="default: %(default)s")
    parser.add_argument(
        "-j",
        "--jobs",
        type=int,
        default=os.cpu_count() or 1,
        help="shards at a time (one per core)",
    )
    parser.add_argument(
        "--folder", type=Path, default=Path(".cache/proof"), help="default: %(default)s"
    )
    args = parser.parse_args()
    begin = time.monotonic()
    parts = [part for part in plan(args) if not args.only or part.suite in args.only]
    findings = args.folder.resolve() / args.seed
    print(f"seed {args.seed}, {len(parts)} shards, findings are kept in {findings}", flush=True)
    if any(part.suite == "encodes" for part in parts):
        build_processors(args.short)
    tallies: dict[str, Tally] = {part.suite: Tally() for part in parts}
    with ThreadPoolExecutor(args.jobs) as pool:
        waiting = {pool.submit(run, part, args, findings): part for part in parts}
        for future in as_completed(waiting):
            tally = future.result()
            tallies[waiting[future].suite].add(tally)
            for finding in tally.findings:
                print(f"FOUND in {waiting[future].name}: {finding}", flush=True)
    print("\n".join(table(tallies)))
    print(f"{time.monotonic() - begin:.0f} s, seed {args.seed}")
    return 1 if any(tally.findings or tally.escapes for tally in tallies.values()) else 0


def plan(args: argparse.Namespace) -> list[Part]:
    """All shards, the suites in turn, so that a run that is stopped has done a little of everything."""
    places = range(0, len(environments()), 8 if args.short else 1)
    queues = [
        *(
            [Part(name, *cut) for cut in cuts(sizes[args.short], shard)]
            for name, (shard, *sizes) in INPUTS.items()
        ),
        [Part("surroundings", number, SURROUNDINGS) for number in places],
    ]
    shares = [(place / len(queue), part) for queue in queues for place, part in enumerate(queue)]
    return [part for _, part in sorted(shares, key=lambda share: share[0])]


def cuts(count: int, size: int) -> Iterator[tuple[int, int]]:
    """Return numbers and sizes of the shards of a number of inputs."""
    for number, first in enumerate(range(0, count, size)):
        yield number, min(size, count - first)


def run(part: Part, args: argparse.Namespace, findings: Path) -> Tally:
    """Run a shard; one that dies is run again, with every input written down before it is tried."""
    command = [
        *(sys.executable, "-X", "faulthandler", "-m", "tools.attack.shard", part.suite),
        *(
            str(part.number),
            str(part.size),
            "--seed",
            args.seed,
            *(["--short"] if args.short else []),
        ),
        *("--findings", str(findings)),
    ]
    try:
        process = subprocess.run(
            command, cwd=ROOT, capture_output=True, text=True, check=False, timeout=SHARD_SECONDS
        )
        if process.returncode == 0:
            return Tally(**json.loads(process.stdout.splitlines()[-1]))
        careful = [*command[:-1], str(findings / part.name), "--careful"]
        subprocess.run(careful, cwd=ROOT, capture_output=True, check=False, timeout=SHARD_SECONDS)
        problem = f"code {process.returncode}, the input is in {findings / part.name}: {process.stderr[-2000:]}"
    except subprocess.TimeoutExpired:
        problem = f"did not end within {SHARD_SECONDS} s"
    return Tally(escapes=1, findings=[problem])


def table(tallies: dict[str, Tally]) -> Iterator[str]:
    """What every suite saw, in lines."""
    columns = ("inputs", "decoded", "refused", "skipped", "otherwise", "differing", "escapes")
    heads = ("inputs", "decoded", "refused", "skipped", "otherwise", "other bits", "escapes")
    yield " ".join([f"{'suite':14}", *(f"{head:>10}" for head in heads), f"{'findings':>9}"])
    total = Tally()
    for name, tally in tallies.items():
        yield _line(name, tally, columns)
        total.add(tally)
    yield _line("all", total, columns)


def _line(name: str, tally: Tally, columns: tuple[str, ...]) -> str:
    counts = [f"{getattr(tally, column):>10,}" for column in columns]
    return " ".join([f"{name:14}", *counts, f"{len(tally.findings):>9,}"])
