"""What a vector is made of: a stream that every decoder must decode, or must refuse."""

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Good:
    """A stream to be decoded; `make` is called only when vectors are written."""

    probes: str
    make: Callable[[], bytes]


@dataclass(frozen=True)
class Bad:
    """A stream to be refused with an error of the class `error`; `make` is called only when vectors are written."""

    probes: str
    error: str
    make: Callable[[], bytes]
