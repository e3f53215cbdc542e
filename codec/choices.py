"""Choices that go by a name, and options with a range."""

import types
from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import fields
from functools import cache
from numbers import Integral, Real
from typing import Any, TypeVar, Union, get_args, get_origin, get_type_hints

from bsm.bitstream.errors import ArgumentError, OptionError

Choice = TypeVar("Choice")
Entry = TypeVar("Entry")


def named(kind: str, choices: Mapping[str, Choice], name: str) -> Choice:
    """The choice called `name`."""
    if not isinstance(name, str) or name not in choices:
        raise OptionError(
            f"unknown {kind} {name!r}{suggestion(str(name), choices)} ({', '.join(choices)})"
        )
    return choices[name]


LIKENESS = 0.6
"""How alike two words must be, so that one is suggested for the other."""
_BEGINNING = 4  # letters that tell a name apart


def suggestion(word: str, known: Iterable[str], *, likeness: float = LIKENESS) -> str:
    """Return a question that suggests a similar name, or ""."""
    names = list(known)
    # The beginning of a single name is meant, even if another name is more alike by letters.
    begun = [name for name in names if name.startswith(word)]
    import difflib  # for errors only

    found = (
        begun if len(begun) == 1 else difflib.get_close_matches(word, names, n=1, cutoff=likeness)
    )
    # "coefs" is meant for coefficients, although most of its letters are missing.
    alike = [name for name in names if name.startswith(word[:_BEGINNING])]
    if not found and len(alike) == 1 and len(word) >= _BEGINNING and likeness == LIKENESS:
        found = alike
    return f"; did you mean {found[0]}?" if found else ""


def check_options(
    options: Any, choices: Mapping[str, tuple[str, ...]], ranges: Mapping[str, tuple[float, float]]
) -> None:
    """Give the fields of a dataclass their types, and check those with choices or a closed range; None is legal."""
    # Types are checked at run time, since most callers have no type checker, and a kernel in C would take anything.
    kind: type = type(options)
    hints = _hints_of(kind)
    for name in (item.name for item in fields(options)):
        value = checked(name, getattr(options, name), hints[name])
        object.__setattr__(options, name, value)
        if value is None:
            continue
        if name in choices and value not in choices[name]:
            raise OptionError(f"{name} must be one of {', '.join(choices[name])}, not {value!r}")
        if name in ranges and not ranges[name][0] <= value <= ranges[name][1]:
            raise OptionError(
                f"{name} = {value!r:.20} is outside {ranges[name][0]:.7g}..{ranges[name][1]:.7g}"
            )


@cache
def _hints_of(kind: type) -> dict[str, Any]:
    """Return the types of the fields of a class, whose annotations may be text."""
    return get_type_hints(kind)


def checked(name: str, value: Any, hint: Any) -> Any:
    """Return a value as the type that a field has; raise `ArgumentError` if it is of another."""
    kinds = get_args(hint) if get_origin(hint) in (Union, types.UnionType) else (hint,)
    for kind in kinds:
        with suppress(TypeError, OverflowError):
            return _as(kind, value)
    words = {
        float: "a number",
        int: "a whole number",
        str: "a string",
        bool: "True or False",
        types.NoneType: "None",
    }
    expected = " or ".join(words.get(kind, getattr(kind, "__name__", str(kind))) for kind in kinds)
    raise ArgumentError(f"{name} must be {expected}, not {value!r}")


def _as(kind: Any, value: Any) -> Any:
    """Return a value as one type; raise `TypeError` if it is of another."""
    import numpy as np  # not for the errors of usage of the command line

    origin, parts = get_origin(kind), get_args(kind)
    # numpy's numbers are registered as these. Fractions and Decimals count as numbers as well.
    usual = {float: Real, int: Integral, bool: (bool, np.bool_), tuple: (tuple, list)}
    expected: Any = usual.get(origin or kind, origin or kind)
    # Python takes True for 1, but a caller who passes True does not mean 1.
    if not isinstance(value, expected) or (kind in (float, int) and isinstance(value, bool)):
        raise TypeError
    if origin is not tuple:
        return kind(value) if kind in (float, int, bool) else value
    if parts[-1] is Ellipsis:
        return tuple(value)
    if len(value) != len(parts):
        raise TypeError
    return tuple(map(_as, parts, value))


def checked_whole(name: str, value: Any, least: int) -> int:
    """Return a whole number of 64 bits."""
    number: int = checked(name, value, int)
    if not least <= number < 1 << 63:
        raise OptionError(f"{name} must be {least} or above, and below 2^63, not {value}")
    return number


def checked_metadata(given: Mapping[str, Entry] | None) -> Mapping[str, Entry]:
    """Return metadata, none for None; raise `ArgumentError` unless they are a mapping."""
    if given is not None and not isinstance(given, Mapping):
        raise ArgumentError(f"metadata must be a mapping from names, not {type(given).__name__}")
    return given or {}
