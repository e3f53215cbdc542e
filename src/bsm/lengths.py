"""Lengths with units: `0.05mm`, `0.1%`, `0.001`."""

import re
from collections.abc import Mapping
from numbers import Real
from typing import Any

from bsm.bitstream.errors import ArgumentError, OptionError

LENGTH = re.compile(r"([0-9.]+(?:[eE][-+]?[0-9]+)?) *(%|[a-zA-Zµ]*)")
"""A number and its unit: % of the diagonal, or the mesh's unit; without a unit, a fraction of the diagonal."""
LENGTHS = ("max_error",)  # options that are lengths
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


BYTES = re.compile(r"([0-9.]+(?:[eE][-+]?[0-9]+)?) *(?:([kMG])(i?))?B?")
"""A number of bytes, with kB, MB, GB (thousands), or KiB, MiB, GiB (1,024)."""


def parse_bytes(name: str, value: Any) -> float:
    if isinstance(value, Real) and not isinstance(value, bool):
        return float(value)
    found = BYTES.fullmatch(value.strip().replace("K", "k")) if isinstance(value, str) else None
    try:
        assert found is not None
        factor: int = (1024 if found[3] else 1000) ** " kMG".index(found[2] or " ")
        return float(found[1]) * factor
    except (AssertionError, ValueError):
        raise ArgumentError(f"{name} must be a number of bytes, such as 20000 or 20kB, not {value!r}") from None


def in_own_unit(options: Mapping[str, Any], metadata: Mapping[str, Any]) -> dict[str, Any]:
    """Return the options that are lengths in another unit than the mesh's, converted to that.

    Raises
    ------
    OptionError
        If a length has a unit and the mesh has none.
    """
    found = {}
    own = unit_of(metadata)
    size = metres(own)
    for name in LENGTHS:
        value = options.get(name)
        number, unit = _parts(name, value) if isinstance(value, str) else (0.0, "")
        if unit in ("", "%"):
            continue
        if not own:
            raise OptionError(
                f"{name} is in {unit}, but the mesh has no unit: add unit={unit} to its metadata "
                f"(--meta unit={unit}) if that is right, or give {name} in percent of the diagonal, such as 0.1%"
            )
        other = metres(unit)
        if size is not None and other is not None and other != size:
            found[name] = f"{number * other / size:.12g}{own.strip()}"
    return found


def _parts(name: str, value: Any) -> tuple[float, str]:
    if isinstance(value, Real) and not isinstance(value, bool):
        return float(value), ""
    found = LENGTH.fullmatch(value.strip()) if isinstance(value, str) else None
    if found is None:
        raise ArgumentError(f"{name} must be a number, or one with a unit like 0.05mm or 0.1%, not {value!r}")
    try:
        return float(found[1]), found[2]
    except ValueError:
        raise ArgumentError(f"{name}: {found[1]!r} is not a number") from None


def metres(unit: str) -> float | None:
    name = unit.strip().lower()
    return IN_METRES.get(name, IN_METRES.get(name.removesuffix("s")))


def unit_of(metadata: Mapping[str, Any]) -> str:
    unit = metadata.get("unit")
    return unit if isinstance(unit, str) else ""


def length(value: float, unit: str) -> str:
    return f"{value:.2g} {unit}".rstrip()
