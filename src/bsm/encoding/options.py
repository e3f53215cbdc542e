"""Options by keyword: `bsm.encode(mesh, theta=5)` and `bsm encode mesh.ply --theta 5` come through here alike."""

import math
from collections.abc import Callable, Mapping
from dataclasses import fields, replace
from typing import Any, TypeVar

from bsm.bitstream.errors import ArgumentError, OptionError
from bsm.codec.choices import checked, named, suggestion
from bsm.codec.sequence.options import PROMISES, SequenceOptions
from bsm.codec.static.options import CODING, PRESETS, EncodeOptions, Paper, changed
from bsm.codec.static.presets import DEFAULT, SEQUENCE_ROWS
from bsm.codec.static.targets import WIDEST, Contract, Target
from bsm.ground.lengths import parse_bytes, parse_length
from bsm.ground.synonyms import advice_on_keyword

_Options = TypeVar("_Options")
TARGETS = {"nmsve_db": "nmsve_db", "theta": "theta_deg", "bpv": "bpv", "size": "size"}
"""Keyword of each target of a mesh, and its kind, see `codec.static.targets`."""

BOUNDS = ("look", "max_error")  # keywords of bounds of a mesh; they apply together

# The same for sequences.
SEQUENCE_TARGETS = {"kg": "kg", "bpvf": "bpvf", "theta": "theta_deg", "nmsve_db": "nmsve_db"}

SEQUENCE_STEPS = {row.name: row.frame_step for row in SEQUENCE_ROWS}
"""The presets of sequences that are sent frame by frame, which promise nothing."""


def encode_options(*, preset: str | None = None, **keywords: Any) -> EncodeOptions:
    base = EncodeOptions()
    if preset is not None:
        base = named("preset", PRESETS, preset)
    # None means "not given", in Python as on the command line, so callers can pass on what they got.
    asked = [name for name, value in keywords.items() if value is not None]
    promised = [name for name in asked if name in (*BOUNDS, "contract")]
    grids, coding = (
        [name for name in names if name in asked] for names in (("grid", "grid_cell"), CODING)
    )
    targets = [name for name in asked if name in (*TARGETS, "target")]
    if base.is_grid and (excluded := [*promised, *targets, *grids, *coding]):
        raise OptionError(
            f"preset {preset} fixes all positions and cannot be combined with {' and '.join(excluded)}"
        )
    if base.sets_coding and (excluded := [*promised, *grids]):
        raise OptionError(
            f"preset {preset} fixes the coding and cannot be combined with {' and '.join(excluded)}"
        )
    # The default preset gives way to a grid, but one that the user has named contradicts it.
    if grids and preset is not None and base.contract is not None:
        promised.insert(0, f"the preset {preset}")
    if promised and (fixed := [*grids, *coding]):
        raise OptionError(
            f"{fixed[0]} fixes the output and cannot be combined with {' and '.join(promised)}"
        )
    given = _fields("a mesh", _OF_MESHES, _with_bounds(base, preset is not None, keywords), TARGETS)
    return changed(base, **given)


def _with_bounds(base: EncodeOptions, named: bool, keywords: Mapping[str, Any]) -> dict[str, Any]:
    """Keywords, `max_error` and `look` among them as the contract that they are beside that of a preset."""
    given = dict(keywords)
    farthest, look = given.pop("max_error", None), given.pop("look", None)
    if farthest is None and look is None:
        return given
    if given.get("contract") is not None:
        raise OptionError("a contract says all that is promised: look and max_error are its bounds")
    # "none" promises nothing, and a single bound must then not bring others with it.
    contract = base.contract or Contract(WIDEST)
    if farthest is not None:
        number, absolute = parse_length("max_error", farthest)
        if named and not absolute:
            # A bound beside a named preset adds to it. It can make the promise stricter, never looser.
            number = min(number, contract.farthest)
        contract = replace(contract, farthest=number, absolute=absolute)
    if look is not None:
        look = checked("look", look, float)
        if named:
            look = min(contract.look, look)
        contract = replace(contract, look=look)
    given["contract"] = contract
    return given


def sequence_options(
    *, preset: str | None = None, low_delay: int = 0, **keywords: Any
) -> SequenceOptions:
    name = DEFAULT if preset is None else preset
    # Said by name, since these are known words for meshes, and "unknown preset" would surprise.
    if name in PRESETS and name not in SEQUENCE_STEPS:
        why = "GOPs round frames together"
        if name == "paper":
            why = "it is for static meshes only"
        raise OptionError(f"a sequence cannot have preset {name}: {why}; try near-lossless")
    effort = keywords.pop("effort", "normal")
    bounds = {bound: value for bound in BOUNDS if (value := keywords.pop(bound, None)) is not None}
    given = _fields("a sequence", _OF_SEQUENCES, keywords, SEQUENCE_TARGETS)
    together = checked("low_delay", low_delay, int)
    base = SequenceOptions(step=named("preset", SEQUENCE_STEPS, name), low_delay=together)
    quick = named("effort", {"quick": True, "normal": False, "best": False}, effort)
    if quick and (bounds or given.get("target") is not None):
        raise OptionError("effort quick does not search for a step; it excludes bounds and targets")
    if preset is not None and (given.get("target") is not None or given.get("step") is not None):
        raise OptionError(
            f"a target or a step of a sequence replaces the preset {preset}: give one of both"
        )
    if bounds:
        if given.get("target") is not None or given.get("step") is not None:
            raise OptionError(
                f"{' and '.join(bounds)} of a sequence cannot be combined with a target or a step"
            )
        farthest, absolute = parse_length(
            "max_error", bounds.get("max_error", PROMISES[name].farthest)
        )
        usual_look = PROMISES[name].look
        # With low delay, frames are sent before later ones are known; there is no search that could keep a look.
        if together:
            usual_look = math.inf
        look = checked("look", bounds.get("look", usual_look), float)
        given["promise"] = Contract(farthest, look=look, absolute=absolute)
    elif not (
        together
        or quick
        or {"target", "step", "promise"} & {key for key in given if given[key] is not None}
    ):
        given["promise"] = PROMISES[name]
    return replace(base, **given)


def denoise_options(**keywords: Any) -> Any:
    """The options for denoising that keywords ask for; None without any, or for method auto: the data choose."""
    # Imported on demand, like all that loads scipy.
    from bsm.codec.denoise import DenoiseOptions  # needs scipy

    fields_given = _fields("denoising", _names(DenoiseOptions), keywords, {})
    if fields_given.get("method") == "auto":
        del fields_given["method"]
        if fields_given:
            raise OptionError(
                f"method auto chooses {next(iter(fields_given))} itself; leave it out, or name a method"
            )
    if not fields_given:
        return None
    return DenoiseOptions(**fields_given)


def _names(*kinds: Any) -> set[str]:
    return {item.name for kind in kinds for item in fields(kind)}


_COUNTERPARTS = {
    "size": ("bpvf", "2"),
    "bpv": ("bpvf", "2"),
    "bpvf": ("bpv", "8"),
    "kg": ("nmsve_db", "-50"),
}
"""Options that a mesh or a sequence has for an option of the other, with a usual value."""
_OF_MESHES = {*_names(EncodeOptions, Paper), *TARGETS, *BOUNDS, "preset"}
_OF_SEQUENCES = {*_names(SequenceOptions), *SEQUENCE_TARGETS, "preset"}


def _advice_on(name: str, known: set[str]) -> str:
    """Say which option is meant by an unknown one: by its meaning, or else by its letters."""
    if name == "options":
        return "; EncodeOptions and its kin come without a name, after the mesh"
    if name in ("unit", "units", "up"):
        return f"; it is an entry of the metadata: metadata={{{name.rstrip('s')!r}: ...}}"
    by_meaning = advice_on_keyword(name, known)
    if by_meaning:
        return f"; instead: {by_meaning}"
    return suggestion(name, sorted(known)) or f"; there are {', '.join(sorted(known))}"


def _fields(
    what: str, known: set[str], keywords: Mapping[str, Any], targets: Mapping[str, str]
) -> dict[str, Any]:
    """The fields of options that keywords give, the target among them; `ArgumentError` if one is not known."""
    given = {name: value for name, value in keywords.items() if name not in targets}
    for name in (name for name in given if name not in known):
        # An option of the other kind is the usual mistake, and "unknown" would be wrong.
        for others, names in (
            ("single meshes", {*_OF_MESHES, "simplify"}),
            ("sequences", _OF_SEQUENCES),
        ):
            if name in names and what != "denoising":
                advice = ""
                counterpart, value = _COUNTERPARTS.get(name, ("", ""))
                if counterpart in known:
                    as_option = f"--{counterpart.replace('_', '-')} {value}"
                    advice = f"; instead: {counterpart}={value}, as an option {as_option}"
                raise ArgumentError(f"{name} is for {others}, not for {what}{advice}")
        raise ArgumentError(f"unknown option {name} for {what}{_advice_on(name, known)}")
    wanted = [
        name
        for name, value in keywords.items()
        if name in (*targets, "target") and value is not None
    ]
    if len(wanted) > 1:
        raise OptionError(f"give one target only, not {' and '.join(wanted)}")
    for name in wanted:
        if name == "target":
            continue
        if name == "size":
            number = parse_bytes(name, keywords[name])
        else:
            number = checked(name, keywords[name], float)
        given["target"] = Target(targets[name], number)
    return given


def chosen_options(
    options: _Options | None,
    kind: type[_Options],
    keywords: Mapping[str, Any],
    build: Callable[..., _Options | None],
) -> _Options | None:
    """Return options that are made, or those of keywords; `ArgumentError` for both."""
    if options is None:
        return build(**keywords)
    if not isinstance(options, kind):
        raise ArgumentError(
            f"{kind.__name__} is expected, not {type(options).__name__}; or give options by keyword"
        )
    if keywords:
        raise ArgumentError(
            f"give {kind.__name__}, or keywords such as {next(iter(keywords))}; not both"
        )
    return options
