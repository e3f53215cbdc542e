"""Mutants of the vectors by the decoder of release 1.0 and by today's, which agree. With flags: by today's alone.

python -m tools.attack.library COUNT SEED [--tolerant] [--exact] [--seconds N] [--flags="-O1 -g"]
"""

import argparse
import ctypes
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path
from random import Random

import numpy as np

from bsm.bitstream import errors
from bsm.bitstream.errors import BsmError
from tools.attack.decoding import is_sequence, piecewise, whole
from tools.attack.sweep import mutant
from tools.attack.tally import Outcome, Tally
from tools.attack.targets import vector_seeds
from tools.bsmdec import Decoded, decode, of_sequence, released
from tools.bsmenc import library

STATUS = {
    "FormatError": 3,
    "CorruptError": 4,
    "UnsupportedError": 5,
    "LimitError": 6,
    "NumericError": 7,
    "TruncatedError": 12,
}


def outcome_of(found: Decoded, stream: bytes) -> Outcome:
    """What the library makes of a stream, its errors translated."""
    if found.status:
        kind: type[BsmError] = getattr(errors, next(name for name, code in STATUS.items() if code == found.status))
        return kind(found.message)
    arrays = of_sequence(found) if is_sequence(stream) else dict(found.arrays)
    return arrays.pop("positions", np.zeros((0, 3))), arrays.pop("faces", np.zeros((0, 3), np.int32)), arrays


def loss_difference(found: Decoded, stream: bytes, *, exact: bool) -> str | None:
    """What a tolerant decoder tells beside what Python's tells: an error, how many losses, other frames."""
    expected, losses = piecewise(stream, Random(0), tolerant=True)
    outcome = outcome_of(found, stream)
    if isinstance(outcome, BsmError) or isinstance(expected, BsmError):
        return Tally().hold(stream, outcome, expected)
    if found.losses != losses:
        return f"{found.losses} losses, expected {losses}"
    if not is_sequence(stream):
        return None
    if losses:
        kept = ({name: values for name, values in each[2].items() if name == "runs"} for each in (outcome, expected))
        outcome, expected = ((*each[:2], some) for each, some in zip((outcome, expected), kept, strict=True))
    return Tally().hold(stream, outcome, expected, exact)


def compare(
    library: ctypes.CDLL, count: int, seed: str, *, exact: bool = False, tolerant: bool = False, seconds: float = np.inf
) -> tuple[Counter[str], list[str]]:
    """Count the outcomes of a number of mutants of a seed, or of those that fit into a time, and list failures."""
    end = time.monotonic() + seconds
    random, seeds = Random(seed), vector_seeds()
    tally, found = Counter[str](), list[str]()
    for number in range(count):
        if time.monotonic() > end:
            break
        stream = mutant(random, seeds)
        decoded = decode(library, stream, pieces=random.choice((0, 0, 1 + random.randrange(100))))
        tally[f"status {decoded.status}"] += 1
        if tolerant:
            lax = decode(library, stream, tolerant=True)
            tally["tolerated"] += lax.status == 0 and decoded.status != 0
            if wrong := loss_difference(lax, stream, exact=exact):
                found.append(f"mutant {number}: tolerantly {wrong}")
                Path(tempfile.gettempdir(), f"mutant-{seed}-{number}.bsm").write_bytes(stream)
        if wrong := Tally().hold(stream, outcome_of(decoded, stream), whole(stream), exact):
            found.append(f"mutant {number}: {wrong}")
            Path(tempfile.gettempdir(), f"mutant-{seed}-{number}.bsm").write_bytes(stream)
    return tally, found


def main() -> int:
    """Run the command."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("count", type=int)
    parser.add_argument("seed")
    parser.add_argument("--tolerant", action="store_true")
    parser.add_argument("--exact", action="store_true")
    parser.add_argument("--seconds", type=float, default=np.inf, help="at most")
    parser.add_argument("--flags", default="", help="of the compiler")
    args = parser.parse_args()
    wanted = {name: getattr(args, name) for name in ("exact", "tolerant", "seconds")}
    tally, found = compare(library(*args.flags.split()) if args.flags else released(), args.count, args.seed, **wanted)
    print(dict(tally), *found[:20], f"{len(found)} findings", sep="\n")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
