"""Choices that go by a name, and options with a range."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import Any, TypeVar

from bsm.bitstream.errors import OptionError

Choice = TypeVar("Choice")


def named(kind: str, choices: Mapping[str, Choice], name: str) -> Choice:
    """The choice called `name`.

    Raises
    ------
    OptionError
        If there is none of that name; the message lists those there are.
    """
    try:
        return choices[name]
    except KeyError:
        raise OptionError(f"there is no {kind} {name!r}; choose one of {', '.join(choices)}") from None


def check_options(
    options: Any, choices: Mapping[str, tuple[str, ...]], ranges: Mapping[str, tuple[float, float]]
) -> None:
    """Check the fields of a dataclass that have a list of choices or a closed range by name; None is always legal.

    Raises
    ------
    OptionError
        If a value is none of them.
    """
    for name in (item.name for item in fields(options)):
        value = getattr(options, name)
        if value is None:
            continue
        if name in choices and value not in choices[name]:
            raise OptionError(f"{name} must be one of {', '.join(choices[name])}, not {value!r}")
        if name in ranges:
            low, high = ranges[name]
            if not low <= value <= high:
                raise OptionError(f"{name} = {value:g} is outside {low:.7g}..{high:.7g}")
