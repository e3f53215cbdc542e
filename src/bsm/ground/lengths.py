"""Lengths with units: `0.05mm`, `0.1%`, `0.001`."""

import re
from collections.abc import Mapping
from numbers import Real
from typing import Any

from bsm.bitstream.errors import ArgumentError, OptionError
from bsm.codec.geometry.mesh import TriangleMesh

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


_MANY = re.compile(rf"(?:{NUMBER} *\*? *)?([a-zµ]+)")
BYTES = re.compile(NUMBER + r" *(?:([kMG])(i?))?B?")
"""A number of bytes, with kB, MB, GB (thousands), or KiB, MiB, GiB (1,024)."""


def parse_bytes(name: str, value: Any) -> float:
    if isinstance(value, Real) and not isinstance(value, bool):
        return float(value)
    found = BYTES.fullmatch(value.strip().replace("K", "k")) if isinstance(value, str) else None
    if found is None:
        raise ArgumentError(f"{name} must be a number of bytes, such as 20000 or 20kB, not {value!r}")
    return float(found[1]) * float((1024 if found[3] else 1000) ** " kMG".index(found[2] or " "))


class UnitError(OptionError):
    """The unit of a mesh is needed, and the mesh does not say it."""


DOUBTFUL = 0.02  # of the diagonal: a bare number from here on may be meant as a length


def in_own_unit(
    options: Mapping[str, Any], metadata: Mapping[str, Any], mesh: TriangleMesh | None = None
) -> dict[str, Any]:
    """Convert options that are lengths to the unit of the mesh; `OptionError` if either has no unit."""
    value, own, mesh = options.get("max_error"), unit_of(metadata), mesh and mesh.without_isolated_vertices()[0]
    number, unit = (0.0, "") if value is None else _parts("max_error", value)
    if unit == "" and number >= DOUBTFUL:
        here = f", {number * mesh.diagonal:.3g} {own}".rstrip() + " here" if mesh else ""
        raise OptionError(
            f"max_error: {number:g} is {100 * number:.3g} % of the diagonal{here}; for that write {100 * number:.3g}%, "
            f"for a length {number:g}{own or 'mm'}"
        )
    if unit in ("", "%"):
        return {}
    if not own:
        other = "mm" if unit in ("m", "meter", "meters") else "m"
        long = float((mesh.positions.max(axis=0) - mesh.positions.min(axis=0)).max()) if mesh else 0.0
        asked = f"is it {long:.3g} {other} or {long:.3g} {unit} long?" if long else "which is it?"
        raise UnitError(
            f"max_error is in {unit}, but the mesh has no unit: {asked} Give it, --meta unit={other} or --meta "
            f"unit={unit} (in Python, metadata={{'unit': '{unit}'}}), or give max_error in percent of the diagonal, "
            "such as 0.1%"
        )
    size, asked_for = metres(own), metres(unit)
    if size is None or asked_for is None or asked_for == size:
        return {}
    return {"max_error": f"{number * asked_for / size:.12g}{own.strip()}"}


def asked_unit(options: Mapping[str, Any], metadata: Mapping[str, Any]) -> tuple[str, float]:
    """Return the unit for errors, and how many of it are one of the mesh's: that of `max_error`, or the mesh's own."""
    value, own = options.get("max_error"), unit_of(metadata)
    unit = "" if value is None else _parts("max_error", value)[1].strip("%")
    size, other = metres(own), metres(unit)
    return (own, 1.0) if not unit or size is None or other is None else (unit, size / other)


def _parts(name: str, value: Any) -> tuple[float, str]:
    if isinstance(value, Real) and not isinstance(value, bool):
        return float(value), ""
    found = LENGTH.fullmatch(value.strip()) if isinstance(value, str) else None
    if found is None:
        raise ArgumentError(f"{name} must be a number, or one with a unit like 0.05mm or 0.1%, not {value!r}")
    return float(found[1]), found[2]


def metres(unit: str) -> float | None:
    """Return the meters of a unit, such as mm, or of a number of units, such as 0.5 m; None: it is unknown."""
    found = _MANY.fullmatch(unit.strip().lower())
    name = found[2] if found else ""
    size = IN_METRES.get(name, IN_METRES.get(name.removesuffix("s")))
    return None if found is None or size is None else float(found[1] or 1.0) * size or None


def unit_of(metadata: Mapping[str, Any]) -> str:
    unit = metadata.get("unit")
    return unit if isinstance(unit, str) else ""


def length(value: float, unit: str) -> str:
    return f"{value:.2g} {unit}".rstrip()
