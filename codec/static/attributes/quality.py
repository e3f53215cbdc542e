"""The quality of attributes: options of the user, and defaults."""

import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import ArgumentError, OptionError
from bsm.codec.arrays import distinct
from bsm.codec.geometry.attributes import Attribute

Way = Literal["exact", "bits", "bound", "share", "rms", "angle", "recompute", "none"]
Grade = Literal["small", "balanced", "fine"]

# The mantissa of single precision.
MOST_BITS = 24  # of a float; who wants more wants it exact
LEAST_NORMAL_BITS, MOST_NORMAL_BITS = 2, 16

_FORMS: tuple[tuple[str, Way], ...] = (
    (r"(\d+) ?bits?", "bits"),
    (r"([\d.eE+-]+) ?deg(?:rees)?", "angle"),
    (r"([\d.eE+-]+) ?%", "share"),
    (r"([\d.eE+-]+) ?% ?rms", "rms"),
    (r"([\d.eE+-]+)", "bound"),
)
_PLAIN: tuple[Way, ...] = ("exact", "recompute", "none")
# Without a look that decides. Ten bits on an octahedron are about a tenth of a degree.
NORMAL_BITS: dict[Grade, int] = {"small": 8, "balanced": 10, "fine": 12}
COLOR_BITS: dict[Grade, int] = {"small": 8, "balanced": 8, "fine": 16}
TEXCOORD_BITS: dict[Grade, int] = {"small": 12, "balanced": 12, "fine": 14}
GENERIC_BITS: dict[Grade, int] = {"small": 16, "balanced": 16, "fine": 20}
# Whole numbers that floats hold, and how many of them are labels.
MOST_LABEL, MOST_LABELS = 1 << 24, 1 << 16
MOVING = {"color": 1.0, "generic": 0.25}
"""Percent of its range that an attribute which changes from frame to frame may be off, see "rms" of `Quality`."""


@dataclass(frozen=True)
class Quality:
    """The requested quality of an attribute."""

    way: Way
    amount: float = 0.0

    def __post_init__(self) -> None:
        # Infinity and NaN pass float(), and would promise nothing.
        if self.way in ("bound", "share", "rms", "angle") and not 0.0 < self.amount < float("inf"):
            raise OptionError(f"the quality of an attribute must be above 0, not {self.amount:g}")
        if self.way == "bits" and not 1 <= self.amount <= 32:
            raise OptionError(f"an attribute can have 1 to 32 bits, not {self.amount:g}")

    def __str__(self) -> str:
        if self.way in _PLAIN:
            return self.way
        units = {"bits": " bits", "share": " %", "rms": " % rms", "angle": " degrees"}
        unit = units.get(self.way, "")
        return f"{self.amount:g}{unit}"


def parse_quality(text: str) -> Quality:
    """The quality that a user means: "exact", "12bits", "0.01", "1%", "1%rms", "2deg", "recompute" or "none"."""
    for plain in _PLAIN:
        if text == plain:
            return Quality(plain)
    for form, way in _FORMS:
        match = re.fullmatch(form, text.strip())
        if match:
            try:
                return Quality(way, float(match[1]))
            except ValueError:
                break
    raise OptionError(
        "the quality of an attribute is exact, 12bits, 0.01 (a bound), 1%, 1%rms, 2deg, recompute or none, "
        f"not {text!r}"
    )


def checked_qualities(
    choices: Mapping[str, str] | tuple[tuple[str, str], ...],
) -> tuple[tuple[str, str], ...]:
    """Return the qualities of attributes by name, as pairs; raise `OptionError` for unknown ones."""
    try:
        # Sorted pairs can be compared and hashed, which a frozen class needs.
        pairs = tuple(sorted((str(name), str(quality)) for name, quality in dict(choices).items()))
    except (TypeError, ValueError):
        raise ArgumentError(
            f"attributes must be a mapping from names to qualities, not {choices!r}"
        ) from None
    for _, text in pairs:
        parse_quality(text)
    return pairs


def _are_few_and_whole(values: npt.NDArray[Any]) -> bool:
    """Whether floats are labels or ids: whole numbers, and few of them."""
    is_whole = (
        values.dtype.kind == "f"
        and (np.abs(values) <= MOST_LABEL).all()
        and (values == np.rint(values)).all()
    )
    # Labels that are off by one are wrong, not near. Formats without integers store them as floats.
    return bool(is_whole) and len(distinct(values)) <= MOST_LABELS


def qualities(
    attributes: Sequence[Attribute],
    asked: Mapping[str, str],
    grade: Grade,
    normals: str = "keep",
    moving: Collection[str] = (),
) -> list[tuple[Attribute, Quality]]:
    """Return attributes with their qualities, without omitted ones; `moving` change from frame to frame."""
    # A misspelled name would otherwise leave an attribute at its default, without a word.
    unknown = sorted(set(asked) - {attribute.name for attribute in attributes} - {"*"})
    if unknown:
        there = ", ".join(attribute.name for attribute in attributes) or "none"
        raise OptionError(f"the mesh has no attribute {unknown[0]!r}; there are: {there}")

    def choose_quality(attribute: Attribute) -> Quality:
        if attribute.name in asked:
            return parse_quality(asked[attribute.name])
        floats = attribute.values.dtype.kind == "f" and attribute.components == 3
        # Only floats of three components can be computed; others mean something else.
        if normals == "recompute" and attribute.semantic == "normal" and floats:
            return Quality("recompute")
        if "*" in asked:
            return parse_quality(asked["*"])
        if attribute.name in moving:
            return Quality("rms", MOVING[attribute.semantic])
        return _usual_quality(attribute, grade)

    pairs = []
    for attribute in attributes:
        quality = choose_quality(attribute)
        if quality.way == "rms" and attribute.name not in moving:
            quality = Quality("share", quality.amount)
        if quality.way != "none":
            pairs.append((attribute, quality))
    return pairs


def _usual_quality(attribute: Attribute, grade: Grade) -> Quality:
    """The quality of an attribute without a request."""
    if attribute.values.dtype.kind != "f":
        return Quality("exact")
    if attribute.semantic == "generic" and _are_few_and_whole(attribute.values):
        return Quality("exact")
    bits = {
        "normal": NORMAL_BITS,
        "color": COLOR_BITS,
        "texcoord": TEXCOORD_BITS,
        "generic": GENERIC_BITS,
    }
    return Quality("bits", bits[attribute.semantic][grade])
