"""Mutants of the vectors by the decoder of release 1.0 and by today's, which agree. With flags: by today's alone.

python -m tools.attack.library COUNT SEED [--tolerant] [--exact] [--seconds N] [--flags="-O1 -g"]
"""

from __future__ import annotations

import argparse
import ctypes
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path
from random import Random

import numpy as np

from bsm import BsmError
from tools.attack.decoding import is_sequence, piecewise, whole
from tools.attack.inputs import mutant, vector_seeds
from tools.attack.tally import Outcome
from tools.bsmdec import Decoded, decode, of_sequence, released
from tools.bsmenc import library
from tools.vectors.store import Arrays

STATUS = {
    "FormatError": 3,
    "CorruptError": 4,
    "UnsupportedError": 5,
    "LimitError": 6,
    "NumericError": 7,
    "TruncatedError": 12,
}


def difference(found: Decoded, stream: bytes, *, exact: bool) -> str | None:
    """What the library makes of a stream beside what Python makes of it; None: the same."""
    return unlike(found, whole(stream), in_sequence=is_sequence(stream), exact=exact)


def unlike(found: Decoded, outcome: Outcome, *, in_sequence: bool, exact: bool) -> str | None:
    """Return how what the library makes of a stream differs from an outcome in Python; None: not at all."""
    if isinstance(outcome, BsmError):
        expected = STATUS[type(outcome).__name__]
        return None if found.status == expected else f"{found.status} {found.message!r}, expected {expected} {outcome}"
    if found.status:
        return f"{found.status} {found.message!r}, expected a mesh"
    positions, faces, attributes = outcome
    arrays: Arrays = {"positions": positions, "faces": faces, **attributes}
    have = of_sequence(found) if in_sequence else found.arrays
    if set(arrays) != set(have):
        return f"{sorted(have)}, expected {sorted(arrays)}"
    for name, expected_values in arrays.items():
        own = have[name]
        if own.shape != expected_values.shape or not _alike(own, expected_values, exact=exact):
            return f"{name} differs"
    return None


def loss_difference(found: Decoded, stream: bytes, *, exact: bool) -> str | None:
    """What a tolerant decoder tells beside what Python's tells: an error, how many losses, other frames."""
    outcome, losses = piecewise(stream, Random(0), tolerant=True)
    expected = STATUS[type(outcome).__name__] if isinstance(outcome, BsmError) else 0
    if found.status != expected or (not expected and found.losses != losses):
        return f"{found.status} {found.message!r} and {found.losses} losses, expected {expected} and {losses}"
    if isinstance(outcome, BsmError) or not is_sequence(stream):
        return None
    if losses:
        outcome = (*outcome[:2], {name: values for name, values in outcome[2].items() if name == "runs"})
        found.arrays.clear()
    return unlike(found, outcome, in_sequence=True, exact=exact)


def _alike(attribute: np.ndarray, other: np.ndarray, *, exact: bool) -> bool:
    if exact or attribute.dtype.kind != "f":
        return np.array_equal(attribute, other)
    size = float(np.abs(other).max(initial=1.0))
    return bool(np.allclose(attribute, other, rtol=1e-5, atol=1e-5 * size))


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
        if wrong := difference(decoded, stream, exact=exact):
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
