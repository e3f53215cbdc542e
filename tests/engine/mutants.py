"""Mutants of the vectors by the decoder in C, with sanitizers if asked, and by Python: they agree.

python -m tests.engine.mutants COUNT SEED [--tolerant] [--exact] [--flags="-O1 -fsanitize=address,undefined"]
"""

from __future__ import annotations

import argparse
import ctypes
import sys
import tempfile
from collections import Counter
from pathlib import Path
from random import Random

import numpy as np

from bsm.bitstream.errors import BsmError
from tests.engine.decoding import Decoded, build, decode
from tools.attack.decoding import is_sequence, piecewise, whole
from tools.attack.inputs import mutant, vector_seeds

STATUS = {
    "FormatError": 3,
    "CorruptError": 4,
    "UnsupportedError": 5,
    "LimitError": 6,
    "NumericError": 7,
    "TruncatedError": 12,
}
SEQUENCES = False
"""Whether the library decodes them."""


def difference(found: Decoded, stream: bytes, *, exact: bool) -> str | None:
    """What the library makes of a stream beside what Python makes of it; None: the same."""
    outcome = whole(stream)
    if isinstance(outcome, BsmError):
        expected = STATUS[type(outcome).__name__]
        return None if found.status == expected else f"{found.status} {found.message!r}, expected {expected} {outcome}"
    if found.status:
        return f"{found.status} {found.message!r}, expected a mesh"
    positions, faces, attributes = outcome
    arrays = {"positions": positions, "faces": faces, **attributes}
    if set(arrays) != set(found.arrays):
        return f"{sorted(found.arrays)}, expected {sorted(arrays)}"
    for name, expected_values in arrays.items():
        own = found.arrays[name]
        if own.shape != expected_values.shape or not _alike(own, expected_values, exact=exact):
            return f"{name} differs"
    return None


def loss_difference(found: Decoded, stream: bytes) -> str | None:
    """What a tolerant decoder tells beside what Python's tells: an error, or how many losses."""
    outcome, losses = piecewise(stream, Random(0), tolerant=True)
    expected = STATUS[type(outcome).__name__] if isinstance(outcome, BsmError) else 0
    if found.status == expected and (expected or found.losses == losses):
        return None
    return f"tolerantly {found.status} {found.message!r} and {found.losses} losses, expected {expected} and {losses}"


def _alike(one: np.ndarray, other: np.ndarray, *, exact: bool) -> bool:
    if exact or one.dtype.kind != "f":
        return np.array_equal(one, other)
    size = float(np.abs(other).max(initial=1.0))
    return bool(np.allclose(one, other, rtol=1e-5, atol=1e-5 * size))


def compare(
    library: ctypes.CDLL, count: int, seed: str, *, exact: bool = False, tolerant: bool = False
) -> tuple[Counter[str], list[str]]:
    """How so many mutants of a seed went, and what went wrong."""
    random, seeds = Random(seed), vector_seeds()
    if not SEQUENCES:
        seeds = [one for one in seeds if not is_sequence(one)]
    tally, found = Counter[str](), list[str]()
    for number in range(count):
        stream = mutant(random, seeds)
        if is_sequence(stream) and not SEQUENCES:
            continue
        decoded = decode(library, stream, pieces=random.choice((0, 0, 1 + random.randrange(100))))
        tally[f"status {decoded.status}"] += 1
        if tolerant:
            lax = decode(library, stream, tolerant=True)
            tally["borne"] += lax.status == 0 and decoded.status != 0
            if wrong := loss_difference(lax, stream):
                found.append(f"mutant {number}: {wrong}")
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
    parser.add_argument("--flags", default="", help="of the compiler")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        library = build(Path(folder), "-w", *args.flags.split())
        tally, found = compare(library, args.count, args.seed, exact=args.exact, tolerant=args.tolerant)
    print(dict(tally), *found[:20], f"{len(found)} findings", sep="\n")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
