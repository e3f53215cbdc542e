"""Options by keyword: `bsm.encode(mesh, theta=5)` and `bsm encode mesh.ply --theta 5` come through here alike."""

from __future__ import annotations

import difflib
import types
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from numbers import Integral, Real
from typing import TYPE_CHECKING, Any, NoReturn, Union, get_args, get_origin, get_type_hints

from bsm.bitstream.errors import ArgumentError, OptionError
from bsm.lengths import parse_length

if TYPE_CHECKING:
    from bsm.codec.denoise import DenoiseOptions
    from bsm.codec.sequence.options import SequenceOptions
    from bsm.codec.static.options import EncodeOptions
    from bsm.codec.static.targets import Target

TARGETS = {
    "nmsve_db": "nmsve_db",
    "theta": "theta_deg",
    "bpv": "bpv",
    "size": "size",
}
"""Keyword of each target of a mesh, and its kind, see `codec.static.targets`."""

SEQUENCE_TARGETS = {"kg": "kg", "bpvf": "bpvf", "theta": "theta_deg", "nmsve_db": "nmsve_db"}
"""The same for sequences."""

SEQUENCE_STEPS = {"small": 0.006, "balanced": 0.002, "fine": 0.0007}
"""The presets of sequences."""


def encode_options(*, preset: str = "balanced", **keywords: Any) -> EncodeOptions:
    """The options for a mesh that keywords ask for.

    Parameters
    ----------
    preset : str
        "small", "balanced", "fine", "near-lossless", "grid14" or "lossless": what everything has that is not given.
    **keywords
        Fields of `EncodeOptions`, and at most one of `max_error` and `TARGETS`.

    Raises
    ------
    ArgumentError
        If there is no such keyword, or its value is of the wrong type.
    OptionError
        If a value is outside its range, or options exclude each other.
    """
    from bsm.codec.static.options import CODING, PRESETS, EncodeOptions
    from bsm.codec.static.targets import Target

    base: EncodeOptions = _named("preset", PRESETS, preset)
    given = _fields("a mesh", EncodeOptions, _with_lengths(keywords), TARGETS, Target)
    others = ("target", "grid_cell", *CODING)
    if base.is_grid and any(given.get(name) is not None for name in others):
        base = EncodeOptions()  # a preset that is a grid has nothing that could be changed
    return replace(base, **given)


def _with_lengths(keywords: Mapping[str, Any]) -> dict[str, Any]:
    """Keywords, `max_error` among them as the contract that it is, and `lock_borders` as what it asks."""
    from bsm.codec.static.contract import Contract, Fit

    given = dict(keywords)
    locked = given.get("lock_borders")
    if locked is True:
        given["lock_borders"] = Fit()
    elif locked is False:
        given["lock_borders"] = None
    elif isinstance(locked, (str, Real)):
        gap, absolute = parse_length("lock_borders", locked)
        given["lock_borders"] = Fit(gap, absolute)
    if given.get("max_error") is None:
        return given
    farthest, absolute = parse_length("max_error", given["max_error"])
    del given["max_error"]
    taken = [name for name in (*TARGETS, "target", "contract") if given.get(name) is not None]
    if taken:
        raise OptionError(f"one target at a time, not max_error and {' and '.join(taken)}")
    given["contract"] = Contract(farthest, absolute=absolute)
    return given


def sequence_options(*, preset: str = "balanced", low_delay: bool = False, **keywords: Any) -> SequenceOptions:
    """The options for a sequence that keywords ask for: fields of `SequenceOptions`, at most one of `SEQUENCE_TARGETS`.

    Raises as `encode_options`.
    """
    from bsm.codec.sequence.options import SequenceOptions
    from bsm.codec.sequence.targets import SequenceTarget

    given = _fields("a sequence", SequenceOptions, keywords, SEQUENCE_TARGETS, SequenceTarget)
    mode = "low-delay" if _checked("low_delay", low_delay, bool) else "gop"
    return replace(SequenceOptions(step=_named("preset", SEQUENCE_STEPS, preset), mode=mode), **given)


def denoise_options(**keywords: Any) -> DenoiseOptions | None:
    """The options for denoising that keywords ask for; None without any: everything is chosen by the data.

    Raises as `encode_options`.
    """
    from bsm.codec.denoise import DenoiseOptions

    return DenoiseOptions(**_fields("denoising", DenoiseOptions, keywords)) if keywords else None


def _fields(
    what: str,
    options: type[Any],
    keywords: Mapping[str, Any],
    targets: Mapping[str, str] = types.MappingProxyType({}),
    target: Callable[[str, float], Target] | None = None,
) -> dict[str, Any]:
    """The fields of `options` that keywords give, the target among them."""
    hints = get_type_hints(options)
    given: dict[str, Any] = {}
    wanted = []
    for name, value in keywords.items():
        if name in hints:
            given[name] = _checked(name, value, hints[name])
        elif name in targets and target is not None:
            if value is not None:
                wanted.append(name)
                given["target"] = target(targets[name], _checked(name, value, float))
        else:
            _refuse(name, what, (*hints, *targets))
    if keywords.get("target") is not None:
        wanted.append("target")
    if len(wanted) > 1:
        raise OptionError(f"one target at a time, not {' and '.join(wanted)}")
    return given


def _checked(name: str, value: Any, hint: Any) -> Any:
    """`value` as the type that a field has; `ArgumentError` if it is of another."""
    kinds = get_args(hint) if get_origin(hint) in (Union, types.UnionType) else (hint,)
    for kind in kinds:
        number = not isinstance(value, bool)
        if kind is types.NoneType and value is None:
            return None
        if kind is float and number and isinstance(value, Real):
            return float(value)
        if kind is int and number and isinstance(value, Integral):
            return int(value)
        if get_origin(kind) is Mapping and isinstance(value, Mapping):
            return value
        if get_origin(kind) is tuple and get_args(kind)[-1] is Ellipsis and isinstance(value, (tuple, list)):
            return tuple(value)
        if get_origin(kind) is tuple and isinstance(value, (tuple, list)) and len(value) == len(get_args(kind)):
            return tuple(_checked(name, item, part) for item, part in zip(value, get_args(kind), strict=True))
        if isinstance(kind, type) and kind not in (int, float) and isinstance(value, kind):
            return value
    raise ArgumentError(f"{name} must be {_said(kinds)}, not {value!r}")


def _said(kinds: Iterable[Any]) -> str:
    """Types in words."""
    words = {float: "a number", int: "a whole number", str: "a string", bool: "True or False", types.NoneType: "None"}
    return " or ".join(words.get(kind, getattr(kind, "__name__", str(kind))) for kind in kinds)


def _named(what: str, choices: Mapping[str, Any], name: str) -> Any:
    if not isinstance(name, str) or name not in choices:
        raise OptionError(f"{what} must be one of {', '.join(choices)}, not {name!r}")
    return choices[name]


def _refuse(name: str, what: str, known: Iterable[str]) -> NoReturn:
    for others, names in (("single meshes", _names_of_meshes()), ("sequences", _names_of_sequences())):
        if name in names and what in ("a mesh", "a sequence"):
            raise ArgumentError(f"{name} is for {others}, not for {what}")
    close = difflib.get_close_matches(name, known, 1)
    advice = f"did you mean {close[0]}?" if close else f"there are {', '.join(sorted(known))}"
    raise ArgumentError(f"there is no option {name} for {what}; {advice}")


def _names_of_meshes() -> set[str]:
    from bsm.codec.static.options import EncodeOptions

    return {*get_type_hints(EncodeOptions), *TARGETS}


def _names_of_sequences() -> set[str]:
    from bsm.codec.sequence.options import SequenceOptions

    return {*get_type_hints(SequenceOptions), *SEQUENCE_TARGETS, "low_delay"}
