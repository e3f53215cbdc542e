"""Choices that go by a name, and options with a range."""

from collections.abc import Mapping
from dataclasses import fields
from typing import Any, TypeVar

import numpy as np

from bsm.bitstream.errors import ArgumentError, OptionError

Choice = TypeVar("Choice")


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


def check_mapping(what: str, given: object) -> None:
    """Raise `ArgumentError` unless the value is a mapping."""
    if not isinstance(given, Mapping):
        raise ArgumentError(f"{what} must be a mapping from names, not {type(given).__name__}")
