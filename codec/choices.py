"""Choices that go by a name."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeVar

from bitstream.errors import OptionError

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
