"""One shard of a suite in a process of its own: `python -m tools.attack.shard SUITE NUMBER SIZE --seed S`.

Prints what it saw as a line of JSON. Everything follows from the arguments, so a shard that crashes can be run again:
with `--careful` each input is written to the folder of findings before it is tried.
"""

import hashlib
import json
import re
import subprocess
import time
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory

import numpy as np

from bsm.bitstream import errors
from bsm.bitstream.errors import BsmError, LimitError
from tools.attack.decoding import piecewise, whole
from tools.attack.encodes import random_streams, stored
from tools.attack.inputs import random_stream, unencoded_stream
from tools.attack.library import outcome_of
from tools.attack.places import Place, environments, processors
from tools.attack.sweep import mutant
from tools.attack.tally import Outcome, Tally
from tools.attack.targets import LIMITS, vector_seeds
from tools.bsmdec import decode, released
from tools.command import parser_of
from tools.web_constants import limits_there

WEB = Path(__file__).parents[2] / "web"
SECONDS = 3.0
"""Of processor time that one input may take under `LIMITS`."""
FRESH = 3
"""Streams of new options that each shard mutates beside the vectors."""


class Shard:
    """Where a suite takes its random numbers from, and tells what it saw."""

    def __init__(self, name: str, findings: Path, careful: bool, short: bool) -> None:
        self.random = Random(name)
        self.short = short
        self.tally = Tally()
        self._findings = findings
        self._careful = careful

    @contextmanager
    def watching(self, stream: bytes) -> Iterator[None]:
        """Record errors that are not errors of a stream, and runs that take too long."""
        if self._careful:
            self._keep(stream, "crash")
        begin = time.process_time()
        try:
            yield
        except Exception:
            self.tally.escapes += 1
            self.found(stream, traceback.format_exc(limit=-3))
        if (spent := time.process_time() - begin) > SECONDS:
            self.tally.escapes += 1
            self.found(stream, f"{spent:.1f} s of processor time for {len(stream)} bytes")

    def found(self, stream: bytes, problem: str | None) -> None:
        """Note a finding, if there is one, and keep the stream."""
        if problem:
            name = self._keep(stream, hashlib.sha256(stream).hexdigest()[:12])
            self.tally.findings.append(f"{name}: {problem}")

    def _keep(self, stream: bytes, name: str) -> Path:
        self._findings.mkdir(parents=True, exist_ok=True)
        path = self._findings / f"{name}.bsm"
        path.write_bytes(stream)
        return path

    def seeds(self) -> list[bytes]:
        """The vectors, and a few streams that are like none of them."""
        fresh = [self.fresh() for _ in range(FRESH)] + [
            unencoded_stream(self.random) for _ in range(FRESH)
        ]
        return vector_seeds() + [stream for stream in fresh if stream]

    def fresh(self) -> bytes | None:
        """A random stream, or None if the encoder refused."""
        seed = self.random.random()
        try:
            return random_stream(Random(seed))
        except BsmError:
            return None
        except Exception:
            self.tally.escapes += 1
            self.tally.findings.append(f"encoding, seed {seed}: {traceback.format_exc(limit=-4)}")
            return None


def mutants(shard: Shard, number: int, size: int) -> None:
    """Mutants of streams with right checksums: whole, in pieces on two threads, or in tolerant mode."""
    seeds = shard.seeds()
    for _ in range(size):
        stream, way = mutant(shard.random, seeds), shard.random.random()
        with shard.watching(stream):
            if way < 0.6:
                outcome = whole(stream, LIMITS)
            else:
                outcome, _ = piecewise(
                    stream, shard.random, LIMITS, threads=1 + (way < 0.7), tolerant=way > 0.8
                )
            shard.tally.saw(outcome)
            shard.found(stream, not_finite(outcome, tolerant=way > 0.8))


def browser(shard: Shard, number: int, size: int) -> None:
    """Mutants by the browser's decoder, in Node: whole, in pieces, or in tolerant mode."""
    seeds = shard.seeds()
    streams = [mutant(shard.random, seeds) for _ in range(size)]
    data = b"".join(len(stream).to_bytes(4, "little") + stream for stream in streams)
    command = ["node", str(WEB / "scripts" / "mutants.mjs"), json.dumps(limits_there(LIMITS))]
    process = subprocess.run(command, input=data, capture_output=True, check=True)
    report = json.loads(process.stdout)
    shard.tally.inputs += size
    shard.tally.decoded += (decoded := report["outcomes"].get("decoded", 0))
    shard.tally.refused += size - decoded
    for place, problem in report["problems"]:
        shard.tally.escapes += 1
        shard.found(streams[place], problem)


def differential(shard: Shard, number: int, size: int) -> None:
    """Mutants and random streams by today's decoder and that of release 1.0."""
    seeds = shard.seeds()
    for k in range(size):
        if k % 10 == 0:
            stream = shard.fresh() or seeds[0]
        elif k % 10 == 5:
            stream = unencoded_stream(shard.random) or seeds[0]
        else:
            stream = mutant(shard.random, seeds)
        with shard.watching(stream):
            ours = whole(stream, LIMITS)
        if isinstance(ours, LimitError):
            shard.tally.skipped += 1
            continue
        released = by_release(stream)
        # Release 1.0 does not know the header fields of later versions, and refuses them before anything else.
        if isinstance(released, errors.UnsupportedError) and re.search(
            r"field \d+ is unknown", str(released)
        ):
            shard.tally.skipped += 1
            continue
        # Release 1.0 compared rows of attributes with the mesh only after later sections.
        if (
            isinstance(ours, BsmError)
            and isinstance(released, BsmError)
            and "values where" in f"{ours}{released}"
        ):
            shard.tally.skipped += 1
            continue
        shard.tally.saw(ours)
        shard.found(stream, shard.tally.hold(stream, ours, released))


def encodes(shard: Shard, number: int, size: int) -> None:
    """Random streams: threads, pieces, tolerance; the same streams and positions on other processors."""
    _elsewhere(shard, size, processors(shard.short))


def surroundings(shard: Shard, number: int, size: int) -> None:
    """Encode and decode in one environment."""
    _elsewhere(shard, size, environments()[number : number + 1])


def _elsewhere(shard: Shard, size: int, places: tuple[Place, ...]) -> None:
    seed = f"{shard.random.random()}"
    with TemporaryDirectory(prefix="bsm-proof-") as folder:
        streams = _streams(shard, seed, size, Path(folder))
        for number, place in enumerate(places):
            there = Path(folder) / str(number)
            process = place.run(
                "tools.attack.encodes", seed, str(size), str(there), "--streams", folder
            )
            if process.returncode:
                shard.tally.escapes += 1
                shard.tally.findings.append(
                    f"{place.name}, seed {seed}: code {process.returncode}, {process.stderr[-600:]}"
                )
                continue
            for k, stream in streams.items():
                other_stream = (there / f"{k}.bsm").read_bytes()
                difference = shard.tally.hold(stream, _stored(there / f"{k}"), whole(stream))
                shard.found(stream, difference and f"{place.name}: {difference}")
                if other_stream != stream:
                    # An encoder may choose otherwise there; what it writes must mean the same everywhere.
                    shard.tally.otherwise += 1
                    difference = shard.tally.hold(
                        other_stream, whole(other_stream), by_release(other_stream)
                    )
                    shard.found(
                        other_stream, difference and f"encoded by {place.name}: {difference}"
                    )


def _streams(shard: Shard, seed: str, size: int, folder: Path) -> dict[int, bytes]:
    """What this processor encodes, written to a folder, and decoded in every way."""
    streams: dict[int, bytes] = {}
    for k, stream in enumerate(random_streams(seed, size)):
        if isinstance(stream, str):
            shard.tally.escapes += 1
            shard.tally.findings.append(f"encoding {seed}/{k}: {stream}")
        elif not stream:
            shard.tally.skipped += 1
        else:
            (folder / f"{k}.bsm").write_bytes(stream)
            streams[k] = stream
            outcome = whole(stream)
            shard.tally.saw(outcome)
            if isinstance(outcome, BsmError):
                shard.found(stream, f"its own encoder's stream is refused: {outcome!r}")
            agree(shard, stream, outcome)
    return streams


def _stored(path: Path) -> Outcome:
    """What `tools.attack.encodes` found."""
    if (refused := path.with_suffix(".txt")).is_file():
        name, problem = refused.read_text().split(" ", 1)
        kind: type[BsmError] = getattr(errors, name)
        return kind(problem)
    return stored(path.with_suffix(".npz"))


def agree(shard: Shard, stream: bytes, outcome: Outcome) -> None:
    """Threads, pieces and tolerance must not change what becomes of a stream."""
    shard.found(stream, shard.tally.hold(stream, whole(stream, threads=2), outcome, exact=True))
    mesh, _losses = piecewise(stream, shard.random, threads=1)
    two, _losses = piecewise(stream, shard.random, threads=2)
    shard.found(stream, shard.tally.hold(stream, mesh, outcome, exact=True))
    shard.found(stream, shard.tally.hold(stream, two, mesh, exact=True))
    if not isinstance(outcome, BsmError):
        tolerant, losses = piecewise(stream, shard.random, tolerant=True)
        shard.found(
            stream,
            shard.tally.hold(stream, tolerant, mesh, exact=True)
            or (losses and "losses in a whole stream")
            or None,
        )


def not_finite(outcome: Outcome, tolerant: bool) -> str | None:
    """Positions that are none, where they should be; what a tolerant decoder lost has none."""
    if isinstance(outcome, BsmError) or tolerant or np.isfinite(outcome[0]).all():
        return None
    return "positions that are not finite"


def by_release(stream: bytes) -> Outcome:
    """By the decoder of release 1.0, its errors translated."""
    return outcome_of(decode(released(), stream), stream)


SUITES: dict[str, Callable[[Shard, int, int], None]] = {
    suite.__name__: suite for suite in (mutants, browser, differential, encodes, surroundings)
}


def main() -> None:
    """Run the command."""
    parser = parser_of(__doc__)
    parser.add_argument("suite", choices=SUITES)
    parser.add_argument("number", type=int)
    parser.add_argument("size", type=int)
    parser.add_argument("--seed", required=True)
    parser.add_argument("--findings", type=Path, required=True)
    parser.add_argument("--careful", action="store_true")
    parser.add_argument("--short", action="store_true")
    args = parser.parse_args()
    shard = Shard(
        f"{args.seed}/{args.suite}/{args.number}", args.findings, args.careful, args.short
    )
    SUITES[args.suite](shard, args.number, args.size)
    print(json.dumps(asdict(shard.tally)))


if __name__ == "__main__":
    main()
