"""Lengths with units: `0.05mm`, `0.1%`, `0.001`; and the one table of units."""

import re
from collections.abc import Mapping
from numbers import Real
from typing import Any, NamedTuple

from bsm.bitstream.errors import ArgumentError, OptionError
from bsm.codec.choices import suggestion
from bsm.codec.geometry.mesh import TriangleMesh

NUMBER = r"((?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?)"
LENGTH = re.compile(NUMBER + r" *(%|[a-zA-Zµμ]*)")
"""A number and its unit: % of the diagonal, or the mesh's unit; without a unit, a fraction of the diagonal."""
# One table for readers, writers, options and the plug-ins. A unit that one place did not know was once taken for the
# mesh's own, and a bound of 0.05 mm became 2 mm.
UNITS = {
    "nm nanometers nanometer nanometre": 1e-9,
    "um micrometers micrometer micrometre micron µm": 1e-6,
    "mm millimeters millimeter millimetre": 0.001,
    "cm centimeters centimeter centimetre": 0.01,
    "dm decimeters decimeter decimetre": 0.1,
    "m meters meter metre": 1.0,
    "km kilometers kilometer kilometre": 1000.0,
    "mil thou": 2.54e-5,
    "in inches inch": 0.0254,
    "ft feet foot": 0.3048,
    "yd yards yard": 0.9144,
    "mi miles mile": 1609.344,
}
"""Each known unit: as it is typed, as metadata have it, other names in the singular; and its meters."""
IN_METRES = {name: size for names, size in UNITS.items() for name in names.split()}
_SHORT = ", ".join(names.split()[0] for names in UNITS)


class Length(NamedTuple):
    """A length: in the unit of the mesh, or as a fraction of the diagonal."""

    value: float
    absolute: bool


def parse_length(name: str, value: Any) -> Length:
    """Return a length that needs no unit of a mesh; of others `in_own_unit` has made a `Length`."""
    if isinstance(value, Length):
        return value
    number, unit = _parts(name, value)
    # Only a mesh tells how long a millimeter is in its own unit. Here none is at hand.
    if unit not in ("", "%"):
        raise UnitError(f"{name} is in {unit}, which needs a mesh with a unit: {value!r}")
    if unit:
        number /= 100.0
    return Length(number, False)


_MANY = re.compile(rf"(?:{NUMBER} *\*? *)?([a-zµ]+)")
BYTES = re.compile(NUMBER + r" *(?:([kMG])(i?))?B?")
"""A number of bytes, with kB, MB, GB (thousands), or KiB, MiB, GiB (1,024)."""


def parse_bytes(name: str, value: Any) -> float:
    if isinstance(value, Real) and not isinstance(value, bool):
        return float(value)
    found = None
    # Kilobytes are written with either letter; there is no other meaning of K here.
    if isinstance(value, str):
        found = BYTES.fullmatch(value.strip().replace("K", "k"))
    if found is None:
        raise ArgumentError(
            f"{name} must be a number of bytes, such as 20000 or 20kB, not {value!r}"
        )
    thousand = 1024 if found[3] else 1000
    return float(found[1]) * float(thousand ** " kMG".index(found[2] or " "))


class UnitError(OptionError):
    """A unit is needed and not given, or not known."""


# Hardly anyone wants vertices off by 2 % of a mesh. A user who writes 0.5 means half a millimeter, and would get a
# ruin.
DOUBTFUL = 0.02  # of the diagonal: a bare number from here on may be meant as a length


def in_own_unit(
    options: Mapping[str, Any], metadata: Mapping[str, Any], mesh: TriangleMesh | None = None
) -> dict[str, Any]:
    """Return options with lengths in the unit of the mesh; `UnitError` if a unit is not known, or the mesh has none."""
    value, own, mesh = (
        options.get("max_error"),
        unit_of(metadata),
        mesh and mesh.without_isolated_vertices()[0],
    )
    if value is None or isinstance(value, Length):
        return dict(options)
    number, unit = _parts("max_error", value)
    # Refused rather than guessed: both meanings are legal, and they differ by orders of magnitude.
    if unit == "" and number >= DOUBTFUL:
        here = ""
        if mesh:
            here = f", {number * mesh.diagonal:.3g} {own}".rstrip() + " here"
        raise OptionError(
            f"max_error: {number:g} is {100 * number:.3g} % of the diagonal{here}; for that write {100 * number:.3g}%, "
            f"for a length {number:g}{own or 'mm'}"
        )
    if unit in ("", "%"):
        return {**options, "max_error": parse_length("max_error", value)}
    asked = known_unit(unit, "max_error")
    if not own:
        # The question offers two units that make the size of the mesh plausible or absurd, so that the user sees which
        # is right.
        other = "mm" if asked == 1.0 else "m"
        long = 0.0
        if mesh:
            long = float((mesh.positions.max(axis=0) - mesh.positions.min(axis=0)).max())
        which = "which is it?"
        if long:
            which = f"is it {long:.3g} {other} or {long:.3g} {unit} long?"
        raise UnitError(
            f"max_error is in {unit}, but the mesh has no unit: {which} Give it, --meta unit={other} or --meta "
            f"unit={unit} (in Python, metadata={{'unit': '{unit}'}}), or give max_error in percent of the diagonal, "
            "such as 0.1%"
        )
    size = known_unit(own, "the mesh")
    # Equal units need no arithmetic. Else twelve digits, so that 1 inch in a mesh of inches is exactly 1.
    if asked != size:
        number = float(f"{number * asked / size:.12g}")
    return {**options, "max_error": Length(number, True)}


def as_said(options: Mapping[str, Any]) -> dict[str, Any]:
    """Return options with lengths as if the mesh were in their unit, to check what can be checked without a mesh."""
    value = options.get("max_error")
    if value is None or isinstance(value, Length):
        return dict(options)
    number, unit = _parts("max_error", value)
    if unit in ("", "%"):
        return {**options, "max_error": parse_length("max_error", value)}
    known_unit(unit, "max_error")
    return {**options, "max_error": Length(number, True)}


def known_unit(unit: object, where: str) -> float:
    """Return the meters of a unit that is known; `UnitError` suggests a similar one."""
    if isinstance(unit, str) and (size := metres(unit)):
        return size
    word = _MANY.fullmatch(str(unit).strip().lower())
    advice = ""
    if word:
        advice = suggestion(word[2], IN_METRES)
    if not advice:
        advice = f"; known are {_SHORT}"
    raise UnitError(f"{where}: unknown unit {unit!r}{advice}")


def asked_unit(options: Mapping[str, Any], metadata: Mapping[str, Any]) -> tuple[str, float]:
    """Return the unit for errors, and how many of it are one of the mesh's: that of `max_error`, or the mesh's own."""
    value, own = options.get("max_error"), unit_of(metadata)
    if value is None:
        return own, 1.0
    unit = _parts("max_error", value)[1].strip("%")
    size, other = metres(own), metres(unit)
    if not unit or size is None or other is None:
        return own, 1.0
    return unit, size / other


def _parts(name: str, value: Any) -> tuple[float, str]:
    if isinstance(value, Real) and not isinstance(value, bool):
        return float(value), ""
    found = None
    if isinstance(value, str):
        found = LENGTH.fullmatch(value.strip())
    if found is None:
        raise ArgumentError(
            f"{name} must be a number, or one with a unit like 0.05mm or 0.1%, not {value!r}"
        )
    return float(found[1]), found[2]


def metres(unit: str) -> float | None:
    """Return the meters of a unit, such as mm, or of a number of units, such as 0.5 m; None: it is unknown."""
    # Unicode has two letters for micro, and keyboards give either.
    # Mu, and the sign for a millionth.
    found = _MANY.fullmatch(unit.strip().lower().replace("μ", "µ"))
    if found is None:
        return None
    size = IN_METRES.get(found[2], IN_METRES.get(found[2].removesuffix("s")))
    if size is None:
        return None
    return float(found[1] or 1.0) * size or None


def unit_named(size: float) -> str:
    """Return the name of a unit of so many meters, as in metadata."""
    # Sizes in files are often single precision: 0.0254 comes as 0.025400000065.
    names = next(
        (names.split()[1] for names, meters in UNITS.items() if abs(meters - size) < 1e-7 * meters),
        "",
    )
    return names or f"{size:.9g} meters"


def unit_of(metadata: Mapping[str, Any]) -> str:
    unit = metadata.get("unit")
    if not isinstance(unit, str):
        return ""
    return unit


def length(value: float, unit: str) -> str:
    return f"{value:.2g} {unit}".rstrip()
