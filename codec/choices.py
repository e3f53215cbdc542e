"""Choices that go by a name, and options with a range."""

from collections.abc import Mapping
from dataclasses import fields
from numbers import Integral
from typing import Any, TypeVar

import numpy as np

from bsm.bitstream.errors import ArgumentError, OptionError

Choice = TypeVar("Choice")
Entry = TypeVar("Entry")


def named(kind: str, choices: Mapping[str, Choice], name: str) -> Choice:
    """The choice called `name`."""
    try:
        return choices[name]
    except (KeyError, TypeError):
        raise OptionError(f"there is no {kind} {name!r}; choose one of {', '.join(choices)}") from None


def check_options(
    options: Any, choices: Mapping[str, tuple[str, ...]], ranges: Mapping[str, tuple[float, float]]
) -> None:
    """Check the fields of a dataclass that have a list of choices or a closed range by name; None is always legal."""
    for item in fields(options):
        name, value = item.name, getattr(options, item.name)
        if isinstance(item.default, bool) and not isinstance(value, (bool, np.bool_)):
            raise ArgumentError(f"{name} must be True or False, not {value!r}")
        if value is None:
            continue
        if name in choices and not (isinstance(value, str) and value in choices[name]):
            raise OptionError(f"{name} must be one of {', '.join(choices[name])}, not {value!r}")
        if name in ranges:
            low, high = ranges[name]
            if isinstance(value, bool) or not isinstance(value, (int, float, np.number)):
                raise ArgumentError(f"{name} must be a number, not {value!r}")
            if not low <= value <= high:
                raise OptionError(f"{name} = {value:g} is outside {low:.7g}..{high:.7g}")


def checked_whole(name: str, value: Any, least: int) -> int:
    """Return a whole number of 64 bits."""
    if isinstance(value, bool) or not isinstance(value, Integral):
        raise ArgumentError(f"{name} must be a whole number, not {value!r}")
    if not least <= (number := int(value)) < 1 << 63:
        raise OptionError(f"{name} must be {least} or above, and below 2^63, not {value}")
    return number


def checked_metadata(given: Mapping[str, Entry] | None) -> Mapping[str, Entry]:
    """Return metadata, none for None; raise `ArgumentError` unless they are a mapping."""
    if given is not None and not isinstance(given, Mapping):
        raise ArgumentError(f"metadata must be a mapping from names, not {type(given).__name__}")
    return given or {}
