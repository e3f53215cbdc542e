"""Lengths with units: `0.05mm`, `0.1%`, `0.001`."""

import re
from collections.abc import Mapping
from numbers import Real
from typing import Any

from bsm.bitstream.errors import ArgumentError, OptionError

NUMBER = r"((?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?)"
LENGTH = re.compile(NUMBER + r" *(%|[a-zA-Zµ]*)")
"""A number and its unit: % of the diagonal, or the mesh's unit; without a unit, a fraction of the diagonal."""
IN_METRES = {
    **dict.fromkeys(("m", "meter", "metre"), 1.0),
    **dict.fromkeys(("dm", "decimeter", "decimetre"), 0.1),
    **dict.fromkeys(("cm", "centimeter", "centimetre"), 0.01),
    **dict.fromkeys(("mm", "millimeter", "millimetre"), 0.001),
    **dict.fromkeys(("um", "µm", "micron", "micrometer", "micrometre"), 1e-6),
    **dict.fromkeys(("km", "kilometer", "kilometre"), 1000.0),
    **dict.fromkeys(("in", "inch", "inche"), 0.0254),
    **dict.fromkeys(("ft", "foot", "feet"), 0.3048),
}
"""Known units, in the singular."""


def parse_length(name: str, value: Any) -> tuple[float, bool]:
    number, unit = _parts(name, value)
    return (number / 100.0, False) if unit == "%" else (number, bool(unit))


BYTES = re.compile(NUMBER + r" *(?:([kMG])(i?))?B?")
"""A number of bytes, with kB, MB, GB (thousands), or KiB, MiB, GiB (1,024)."""


def parse_bytes(name: str, value: Any) -> float:
    if isinstance(value, Real) and not isinstance(value, bool):
        return float(value)
    found = BYTES.fullmatch(value.strip().replace("K", "k")) if isinstance(value, str) else None
    if found is None:
        raise ArgumentError(f"{name} must be a number of bytes, such as 20000 or 20kB, not {value!r}")
    return float(found[1]) * float((1024 if found[3] else 1000) ** " kMG".index(found[2] or " "))


def in_own_unit(options: Mapping[str, Any], metadata: Mapping[str, Any]) -> dict[str, Any]:
    """Return the options that are lengths in another unit than the mesh's, converted to that."""
    value, own = options.get("max_error"), unit_of(metadata)
    number, unit = _parts("max_error", value) if isinstance(value, str) else (0.0, "")
    if unit in ("", "%"):
        return {}
    if not own:
        raise OptionError(
            f"max_error is in {unit}, but the mesh has no unit: add unit={unit} to its metadata "
            f"(--meta unit={unit}) if that is right, or give max_error in percent of the diagonal, such as 0.1%"
        )
    size, other = metres(own), metres(unit)
    if size is None or other is None or other == size:
        return {}
    return {"max_error": f"{number * other / size:.12g}{own.strip()}"}


def _parts(name: str, value: Any) -> tuple[float, str]:
    if isinstance(value, Real) and not isinstance(value, bool):
        return float(value), ""
    found = LENGTH.fullmatch(value.strip()) if isinstance(value, str) else None
    if found is None:
        raise ArgumentError(f"{name} must be a number, or one with a unit like 0.05mm or 0.1%, not {value!r}")
    return float(found[1]), found[2]


def metres(unit: str) -> float | None:
    name = unit.strip().lower()
    return IN_METRES.get(name, IN_METRES.get(name.removesuffix("s")))


def unit_of(metadata: Mapping[str, Any]) -> str:
    unit = metadata.get("unit")
    return unit if isinstance(unit, str) else ""


def length(value: float, unit: str) -> str:
    return f"{value:.2g} {unit}".rstrip()
