"""Mutants of the vectors by a library in C, such as that of release 1.0, and by today's decoder, which agree."""

import ctypes
from collections import Counter
from random import Random

import numpy as np

from bsm.bitstream import errors
from bsm.bitstream.errors import BsmError
from tools.attack.decoding import is_sequence, piecewise, whole
from tools.attack.sweep import mutant
from tools.attack.tally import Outcome, Tally
from tools.attack.targets import vector_seeds
from tools.bsmdec import Decoded, decode, of_sequence

STATUS = {
    "FormatError": 3,
    "CorruptError": 4,
    "UnsupportedError": 5,
    "LimitError": 6,
    "NumericError": 7,
    "TruncatedError": 12,
}


def outcome_of(decoded: Decoded, stream: bytes) -> Outcome:
    """What the library makes of a stream, its errors translated."""
    if decoded.status:
        kind: type[BsmError] = getattr(
            errors, next(name for name, code in STATUS.items() if code == decoded.status)
        )
        return kind(decoded.message)
    arrays = of_sequence(decoded) if is_sequence(stream) else dict(decoded.arrays)
    return (
        arrays.pop("positions", np.zeros((0, 3))),
        arrays.pop("faces", np.zeros((0, 3), np.int32)),
        arrays,
    )


def loss_difference(decoded: Decoded, stream: bytes) -> str | None:
    """What a tolerant decoder tells beside what Python's tells: an error, how many losses, other frames."""
    expected, losses = piecewise(stream, Random(0), tolerant=True)
    outcome = outcome_of(decoded, stream)
    if isinstance(outcome, BsmError) or isinstance(expected, BsmError):
        return Tally().hold(stream, outcome, expected)
    if decoded.losses != losses:
        return f"{decoded.losses} losses, expected {losses}"
    if not is_sequence(stream):
        return None
    if losses:
        arrays = (
            {name: values for name, values in each[2].items() if name == "runs"}
            for each in (outcome, expected)
        )
        outcome, expected = (
            (*each[:2], run_arrays)
            for each, run_arrays in zip((outcome, expected), arrays, strict=True)
        )
    return Tally().hold(stream, outcome, expected)


def compare(library: ctypes.CDLL, count: int, seed: str) -> tuple[Counter[str], list[str]]:
    """Count the outcomes of a number of mutants of a seed, and list failures."""
    random, seeds = Random(seed), vector_seeds()
    tally, findings = Counter[str](), list[str]()
    for number in range(count):
        stream = mutant(random, seeds)
        decoded = decode(library, stream, pieces=random.choice((0, 0, 1 + random.randrange(100))))
        tally[f"status {decoded.status}"] += 1
        if wrong := loss_difference(decode(library, stream, tolerant=True), stream):
            findings.append(f"mutant {number}: tolerantly {wrong}")
        if wrong := Tally().hold(stream, outcome_of(decoded, stream), whole(stream)):
            findings.append(f"mutant {number}: {wrong}")
    return tally, findings
