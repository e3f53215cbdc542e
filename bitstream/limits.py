"""How much memory and work a caller grants to a decoder."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, fields
from functools import wraps
from typing import Any

from bsm.bitstream import errors
from bsm.bitstream.errors import ArgumentError, BsmError, Kind, LimitError, OptionError, public


def _with_known_names(kind: Kind) -> Kind:
    """Let a dataclass refuse the names of fields that it does not have, and suggest one that it has."""
    make: Callable[..., None] = kind.__init__  # type: ignore[misc]
    known = [item.name for item in fields(kind)]

    @wraps(make)
    def check_names(self: Any, *values: Any, **named: Any) -> None:
        unknown = next((name for name in named if name not in known), None)
        if unknown is not None:
            alike = [name for name in known if name in unknown or unknown in name]
            advice = f"did you mean {alike[0]}?" if alike else f"its limits are {', '.join(known)}"
            raise ArgumentError(f"{kind.__name__} has no limit {unknown}; {advice}")
        make(self, *values, **named)

    kind.__init__ = check_names  # type: ignore[misc]
    return kind


@public
@_with_known_names
@dataclass(frozen=True)
class Limits:
    """Upper bounds that a decoder checks before it allocates or computes. `dataclasses.replace` changes them.

    The defaults allow a mesh of sixteen million vertices, but refuse a stream that only claims to contain one: memory
    and work are bounded by the vertices that its faces really use, and by the bytes received.

    Parameters
    ----------
    vertices, faces, blocks : int
        Largest numbers for a mesh, or for every frame of a sequence.
    block_size : int
        Largest number of vertices of a block.
    coefficients : int
        Largest number for a block and coordinate.
    frames : int
        Largest number for a sequence.
    gop_frames : int
        Largest number of frames that depend on each other.
    frame_bytes : int
        Largest section of the stream.
    metadata_bytes : int
        Largest metadata, names and values, without binary values such as images.
    work, work_per_vertex, work_per_byte : float
        Nanoseconds of a processor core, by the estimates of the specification: a constant, and more for each vertex
        and each byte that have arrived.
    most_work : float
        Bound for any stream.
    memory, memory_per_vertex, memory_per_byte : float
        Bytes, in the same way.
    most_memory : float
        Bound for any stream.
    sequence_bytes : float
        Memory for the dictionaries of a sequence, and for the coefficients of a GOP.
    field_bytes : float
        Memory for decoding a grid or a layer of refinement, or the values of an attribute.
    attributes : int
        Of a mesh.
    attribute_values : int
        Numbers of all attributes of a mesh: values times their components.

    Raises
    ------
    ArgumentError
        If a limit is not a number.
    OptionError
        If a limit is negative or NaN.

    Examples
    --------
    >>> import bsm
    >>> mesh = bsm.decode("bunny.bsm", limits=bsm.Limits.service())
    >>> small = bsm.Limits(vertices=100_000, faces=200_000)
    >>> small
    Limits(vertices=100000, faces=200000)
    """

    vertices: int = 1 << 24
    faces: int = 1 << 25
    blocks: int = 1 << 17
    block_size: int = 8192
    coefficients: int = 4096
    frames: int = 1 << 20
    gop_frames: int = 1024
    frame_bytes: int = 1 << 28
    metadata_bytes: int = 1 << 23
    # A constant, because an empty mesh costs something, too; then in proportion to what has arrived. A short stream
    # cannot claim much, and a long one has paid for it.
    work: float = 8e8
    work_per_vertex: float = 3.2e4
    work_per_byte: float = 1.6e4
    most_work: float = math.inf
    memory: float = 1 << 26
    memory_per_vertex: float = 1 << 10
    memory_per_byte: float = 64
    most_memory: float = math.inf
    sequence_bytes: float = 1 << 31
    field_bytes: float = 1 << 32
    attributes: int = 255
    attribute_values: int = 1 << 28

    def __repr__(self) -> str:
        # Twenty numbers would hide the one that differs.
        own = [
            (f.name, getattr(self, f.name))
            for f in fields(self)
            if getattr(self, f.name) != f.default
        ]
        return f"Limits({', '.join(f'{name}={value!r}' for name, value in own)})"

    def __post_init__(self) -> None:
        """Raises `ArgumentError` for values that are not numbers, `OptionError` for negative ones and NaN."""
        for name in (field.name for field in fields(self)):
            value = getattr(self, name)
            # A bool is an int in Python, and Limits(faces=True) would refuse every mesh but a triangle.
            if isinstance(value, bool) or not isinstance(value, (int, float)):
                raise ArgumentError(f"the limit {name} must be a number, not {value!r}")
            # Not `value < 0`, which NaN passes: every comparison with it is false, and nothing would be limited.
            if not value >= 0:
                raise OptionError(f"the limit {name} must be 0 or above, not {value}")

    @classmethod
    def service(cls) -> Limits:
        """Limits for untrusted streams: 1 GiB of memory and 10 s of one core for any stream.

        Meshes of up to a million vertices that were encoded with any preset are within them.
        """
        return cls(
            vertices=1 << 20,
            faces=1 << 22,
            frame_bytes=1 << 26,
            most_work=8e9,
            most_memory=800 << 20,
            sequence_bytes=400 << 20,
        )

    @classmethod
    def wide(cls) -> Limits:
        """Limits for your own streams only: dictionaries as wide and as exact as options allow."""
        return cls(
            work=1e12,
            work_per_vertex=1e8,
            memory=1 << 34,
            memory_per_vertex=1 << 16,
            sequence_bytes=1 << 36,
        )

    def check(self, name: str, value: float) -> None:
        """Raise `LimitError` if `value` exceeds the limit called `name`."""
        bound = getattr(self, name)
        if value > bound:
            raise LimitError(
                f"{name} = {_worded(value)} is over the limit of {_worded(bound)}; "
                + _cure(name, lambda limits: value <= getattr(limits, name))
            )

    def check_work(self, value: float, vertices: int, received: int = 0) -> None:
        """Raise `LimitError` if a stream of these vertices and received bytes takes more work."""
        self._check_sum("work", value, lambda limits: limits.work_for(vertices, received))

    def work_for(self, vertices: int, received: int) -> float:
        """Return the nanoseconds of work that a stream of these vertices and received bytes may take."""
        # A service needs a bound that no stream can raise by being long.
        return min(
            self.work + self.work_per_vertex * vertices + self.work_per_byte * received,
            self.most_work,
        )

    def check_memory(self, value: float, vertices: int, received: int = 0) -> None:
        """Raise `LimitError` if a stream of these vertices and received bytes needs more memory."""
        self._check_sum("memory", value, lambda limits: limits.memory_for(vertices, received))

    def memory_for(self, vertices: int, received: int) -> float:
        """Return the bytes of memory that a stream of these vertices and received bytes may take."""
        granted = self.memory + self.memory_per_vertex * vertices + self.memory_per_byte * received
        return min(granted, self.most_memory)

    def _check_sum(self, name: str, value: float, granted: Callable[[Limits], float]) -> None:
        if value > granted(self):
            raise LimitError(
                f"{name} = {_worded(value)} is over the limit of {granted(self):g} for what the stream holds; "
                + _cure(name, lambda limits: value <= granted(limits))
            )


def as_limits(limits: Limits | str) -> Limits:
    """Return limits that are given as they are or by their name; raise `ArgumentError` for anything else."""
    if isinstance(limits, Limits):
        return limits
    if not isinstance(limits, str) or limits not in NAMED_LIMITS:
        names = ", ".join(map(repr, NAMED_LIMITS))
        raise ArgumentError(f"limits must be bsm.Limits, or one of {names}, not {limits!r}")
    return NAMED_LIMITS[limits]()


def _cure(name: str, enough: Callable[[Limits], bool]) -> str:
    """What allows more, on the command line and in Python."""
    # Advice must help: only sets of limits that would really let this stream pass are named.
    named = next((word for word, make in NAMED_LIMITS.items() if enough(make())), None)
    if named is None:
        return f"if you trust the source, decode it in Python with a higher Limits.{name}"
    call = "Limits()" if named == "default" else f"Limits.{named}()"
    return f"if you trust the source, allow more: --limits {named} (commands that decode), in Python {call}"


def _worded(value: float) -> str:
    return f"{value:,}" if isinstance(value, int) else f"{value:g}"


DEFAULT_LIMITS = Limits()
NAMED_LIMITS = {"default": Limits, "service": Limits.service, "wide": Limits.wide}
"""Sets of limits that a command line can name."""


_REFUSALS: dict[int, type[BsmError]] = {
    **{
        2: OptionError,
        3: errors.FormatError,
        4: errors.CorruptError,
        5: errors.UnsupportedError,
        6: LimitError,
    },
    **{7: errors.NumericError, 10: errors.TargetError, 12: errors.TruncatedError},
}


def decoder_error(
    status: int,
    message: str,
    offset: int,
    frame: int,
    block: int,
    limit: str,
    value: float,
    limits: Limits,
    state: Any,
) -> Exception:
    """The error that the decoder in C reports, as an exception; places of -1 and an empty `limit` are not known."""
    # Everything else that C reports is memory that the system did not give.
    if status not in _REFUSALS:
        return MemoryError(message)
    error = _REFUSALS[status](message)
    # A tolerant decoder reports the same as damage, and damage is not cured by limits.
    if limit and isinstance(error, LimitError):  # or damage, to those who tolerate it
        error = LimitError(f"{message}; {_cure_of(limit, value, state)}")
    places = {"offset": offset, "frame": frame, "block": block}
    return error.located(**{name: place for name, place in places.items() if place >= 0})


def _cure_of(name: str, value: float, state: Any) -> str:
    def enough(limits: Limits) -> bool:
        if name == "work":
            return value <= limits.work_for(state.shown, 0)
        if name == "memory":
            return value <= limits.memory_for(state.present, int(state.received))
        return bool(value <= getattr(limits, name, 0))

    return _cure(name, enough)
