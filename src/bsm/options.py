"""Options by keyword: `bsm.encode(mesh, theta=5)` and `bsm encode mesh.ply --theta 5` come through here alike."""

from __future__ import annotations

import math
import types
from collections.abc import Callable, Iterable, Mapping
from dataclasses import fields, replace
from typing import TYPE_CHECKING, Any, NoReturn

from bsm.bitstream.errors import ArgumentError, OptionError
from bsm.codec.choices import checked, named, suggestion
from bsm.lengths import parse_bytes, parse_length

if TYPE_CHECKING:
    from bsm.codec.denoise import DenoiseOptions
    from bsm.codec.sequence.options import SequenceOptions
    from bsm.codec.static.options import EncodeOptions
    from bsm.codec.static.targets import Target

TARGETS = {"nmsve_db": "nmsve_db", "theta": "theta_deg", "bpv": "bpv", "size": "size"}
"""Keyword of each target of a mesh, and its kind, see `codec.static.targets`."""

BOUNDS = ("look", "max_error")  # keywords of bounds of a mesh; they apply together

SEQUENCE_TARGETS = {"kg": "kg", "bpvf": "bpvf", "theta": "theta_deg", "nmsve_db": "nmsve_db"}  # the same for sequences

SEQUENCE_STEPS = {"small": 0.006, "balanced": 0.002, "fine": 0.0007, "near-lossless": 0.0001}
"""The presets of sequences that are sent frame by frame, which promise nothing."""


def encode_options(*, preset: str | None = None, **keywords: Any) -> EncodeOptions:
    from bsm.codec.static.options import CODING, PRESETS, EncodeOptions, changed
    from bsm.codec.static.targets import Target

    base: EncodeOptions = EncodeOptions() if preset is None else named("preset", PRESETS, preset)
    asked = [name for name, value in keywords.items() if value is not None]
    bounds = [name for name in asked if name in (*BOUNDS, *TARGETS, "contract", "target")]
    grids, coding = ([name for name in names if name in asked] for names in (("grid", "grid_cell"), CODING))
    if base.is_grid and (excluded := [*bounds, *grids, *coding]):
        raise OptionError(f"preset {preset} fixes all positions and cannot be combined with {' and '.join(excluded)}")
    if base.sets_coding and (excluded := [*(name for name in bounds if name in (*BOUNDS, "contract")), *grids]):
        raise OptionError(f"preset {preset} fixes the coding and cannot be combined with {' and '.join(excluded)}")
    fixed = [*grids, *coding]
    excluded = [name for name in bounds if name in (*BOUNDS, "contract")]
    if grids and preset is not None and base.contract is not None:
        excluded.insert(0, f"the preset {preset}")
    if fixed and excluded:
        raise OptionError(f"{fixed[0]} fixes the output and cannot be combined with {' and '.join(excluded)}")
    given = _fields("a mesh", EncodeOptions, _with_bounds(base, preset is not None, keywords), TARGETS, Target)
    return changed(base, **given)


def _with_bounds(base: EncodeOptions, named: bool, keywords: Mapping[str, Any]) -> dict[str, Any]:
    """Keywords, `max_error` and `look` among them as the contract that they are beside that of a preset."""
    from bsm.codec.static.targets import WIDEST, Contract

    given = dict(keywords)
    farthest, look = given.pop("max_error", None), given.pop("look", None)
    if farthest is None and look is None:
        return given
    if given.get("contract") is not None:
        raise OptionError("a contract says all that is promised: look and max_error are its bounds")
    contract = base.contract or Contract(WIDEST)
    if farthest is not None:
        number, absolute = parse_length("max_error", farthest)
        if named and not absolute:
            number = min(number, contract.farthest)
        contract = replace(contract, farthest=number, absolute=absolute)
    if look is not None:
        look = checked("look", look, float)
        contract = replace(contract, look=min(contract.look, look) if named else look)
    given["contract"] = contract
    return given


def sequence_options(*, preset: str | None = None, low_delay: int = 0, **keywords: Any) -> SequenceOptions:
    from bsm.codec.sequence.options import PROMISES, SequenceOptions
    from bsm.codec.static.targets import Contract, Target

    name = "balanced" if preset is None else preset
    if name in ("none", "lossless", "grid14", "paper"):
        raise OptionError(f"a sequence cannot have preset {name}: GOPs round frames together; try near-lossless")
    effort = keywords.pop("effort", "normal")
    bounds = {bound: keywords.pop(bound) for bound in ("look", "max_error") if keywords.get(bound) is not None}
    given = _fields("a sequence", SequenceOptions, keywords, SEQUENCE_TARGETS, Target)
    together = checked("low_delay", low_delay, int)
    base = SequenceOptions(step=named("preset", SEQUENCE_STEPS, name), low_delay=together)
    quick = named("effort", {"quick": True, "normal": False, "best": False}, effort)
    if quick and (bounds or given.get("target") is not None):
        raise OptionError("effort quick does not search for a step; it excludes bounds and targets")
    if preset is not None and (given.get("target") is not None or given.get("step") is not None):
        raise OptionError(f"a target or a step of a sequence replaces the preset {preset}: give one of both")
    if bounds:
        if given.get("target") is not None or given.get("step") is not None:
            raise OptionError(f"{' and '.join(bounds)} of a sequence cannot be combined with a target or a step")
        farthest, absolute = parse_length("max_error", bounds.get("max_error", PROMISES[name].farthest))
        look = checked("look", bounds.get("look", math.inf if together else PROMISES[name].look), float)
        given["promise"] = Contract(farthest, look=look, absolute=absolute)
    elif not (together or quick or {"target", "step", "promise"} & {key for key in given if given[key] is not None}):
        given["promise"] = PROMISES[name]
    return replace(base, **given)


def denoise_options(**keywords: Any) -> DenoiseOptions | None:
    """The options for denoising that keywords ask for; None without any: everything is chosen by the data."""
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
    from bsm.codec.static.options import EncodeOptions, Paper

    known = [item.name for kind in (options, *([Paper] if options is EncodeOptions else [])) for item in fields(kind)]
    given: dict[str, Any] = {}
    wanted = []
    for name, value in keywords.items():
        if name in known:
            given[name] = value
        elif name in targets and target is not None:
            if value is not None:
                wanted.append(name)
                number = parse_bytes(name, value) if name == "size" else checked(name, value, float)
                given["target"] = target(targets[name], number)
        else:
            more = (*(BOUNDS if targets is TARGETS else ()), *(("preset",) if targets else ()))
            _refuse(name, what, (*known, *targets, *more))
    if keywords.get("target") is not None:
        wanted.append("target")
    if len(wanted) > 1:
        raise OptionError(f"give one target only, not {' and '.join(wanted)}")
    return given


def _refuse(name: str, what: str, known: Iterable[str]) -> NoReturn:
    from bsm.codec.sequence.options import SequenceOptions
    from bsm.codec.static.options import EncodeOptions, Paper

    of_meshes = {*(field.name for field in (*fields(EncodeOptions), *fields(Paper))), *TARGETS, *BOUNDS, "simplify"}
    of_sequences = {*(field.name for field in fields(SequenceOptions)), *SEQUENCE_TARGETS}
    for others, names in (("single meshes", of_meshes), ("sequences", of_sequences)):
        if name in names and what in ("a mesh", "a sequence"):
            raise ArgumentError(f"{name} is for {others}, not for {what}")
    known = sorted(known)
    advice = suggestion(name, known) or f"; there are {', '.join(known)}"
    raise ArgumentError(f"unknown option {name} for {what}{advice}")
