"""What a part of the proof has seen, and how two decodings are held against each other."""

from __future__ import annotations

from dataclasses import dataclass, field, fields

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import BsmError
from tools.vectors.store import Arrays, alike

Decoded = tuple[npt.NDArray[np.float64], npt.NDArray[np.int32], Arrays]
"""Positions, shape (n, 3) or (T, n, 3), faces, shape (m, 3), and the arrays of attributes."""
Outcome = Decoded | BsmError


@dataclass
class Tally:
    """Counts of one shard or of many."""

    inputs: int = 0
    decoded: int = 0
    refused: int = 0
    skipped: int = 0
    otherwise: int = 0
    differing: int = 0
    escapes: int = 0
    findings: list[str] = field(default_factory=list)

    def add(self, tally: Tally) -> None:
        """Take in what another has seen."""
        for item in fields(self):
            setattr(self, item.name, getattr(self, item.name) + getattr(tally, item.name))

    def saw(self, outcome: Outcome) -> None:
        """Take note of what became of an input."""
        self.inputs += 1
        if isinstance(outcome, BsmError):
            self.refused += 1
        else:
            self.decoded += 1

    def hold(
        self, stream: bytes, decoded: Outcome, expected: Outcome, exact: bool = False
    ) -> str | None:
        """Compare what a stream decoded to with what it should have; return the difference, or None.

        `exact` asks for attributes that are equal to the last bit, too.
        """
        problem = self._compared(stream, decoded, expected, exact)
        self.differing += problem is not None
        return problem

    def _compared(
        self, stream: bytes, decoded: Outcome, expected: Outcome, exact: bool
    ) -> str | None:
        if isinstance(decoded, BsmError) or isinstance(expected, BsmError):
            outcomes = [
                type(outcome).__name__.removesuffix("Error").lower()
                if isinstance(outcome, BsmError)
                else "decoded"
                for outcome in (decoded, expected)
            ]
            messages = "; ".join(
                str(outcome) for outcome in (decoded, expected) if isinstance(outcome, BsmError)
            )
            return (
                None
                if outcomes[0] == outcomes[1]
                else f"{outcomes[0]} instead of {outcomes[1]}: {messages}"
            )
        if not np.array_equal(decoded[1], expected[1]):
            return "the faces differ"
        if decoded[0].shape != expected[0].shape:
            return f"positions of shape {decoded[0].shape} instead of {expected[0].shape}"
        if problem := _other_attributes(decoded[2], expected[2], exact):
            return problem
        if np.array_equal(decoded[0], expected[0]):
            return None
        return f"positions are off by up to {np.abs(decoded[0] - expected[0]).max():.1e}"


def _other_attributes(decoded: Arrays, expected: Arrays, exact: bool) -> str | None:
    """In what attributes differ, or None; floats may by what rounding does, unless `exact`."""
    if set(decoded) != set(expected):
        return f"attributes {sorted(decoded)} instead of {sorted(expected)}"
    for name, values in expected.items():
        same = decoded[name].dtype == values.dtype and np.array_equal(decoded[name], values)
        if not (same if exact else alike(decoded[name], values)):
            return f"{name!r} differs"
    return None
