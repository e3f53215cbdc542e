"""What an ATTRIBUTE frame declares: how one attribute of a mesh is coded."""

import math
from dataclasses import dataclass

from bsm.bitstream.container.header import integer, integers, method, normalise_fields, reals, text
from bsm.bitstream.errors import OptionError

VERTEX, CORNER, FACE = range(3)  # what has a value in the stream
AS_CODED, OTHERWISE = range(2)
"""Whether it is given back so; or coded by vertices and given by corners, or the other way round."""
LEVELS, OCTAHEDRAL, BITS, RECOMPUTED = range(4)  # codings; see A 5
GENERIC, COLOR, NORMAL, TEXCOORD = range(4)

MOST_NAME = 255
MOST_COMPONENTS = 4
MOST_WORDS = 2 * MOST_COMPONENTS  # numbers in a coded value: two for each component where they are doubles to the bit
MOST_LEVEL = 2**32 - 1
_OCTAHEDRAL = range(2, 2**16, 2)
_INTEGERS = {0: (0, 2**8 - 1), 1: (-(2**7), 2**7 - 1), 2: (0, 2**16 - 1), 3: (-(2**15), 2**15 - 1)} | {
    4: (0, 2**32 - 1),
    5: (-(2**31), 2**31 - 1),
}
FLOAT32, FLOAT64 = 6, 7
_LARGEST_SINGLE = float.fromhex("0x1.fffffep+127")


@dataclass(frozen=True, kw_only=True)
class Declaration:
    """An attribute, but for its values; one with illegal or contradictory fields cannot be made."""

    name: str = text(1, 1, MOST_NAME)
    domain: int = method(2, known=3)  # what has a value in the stream: VERTEX, CORNER or FACE
    origin: int = method(3, known=2)  # given by AS_CODED, or OTHERWISE: VERTEX by corners, CORNER by vertices
    semantic: int = method(4, known=4)  # GENERIC, COLOR, NORMAL or TEXCOORD
    kind: int = method(5, known=8, default=FLOAT32)  # uint8, int8, uint16, int16, uint32, int32, float32 or float64
    components: int = integer(6, 1, MOST_COMPONENTS, default=1)
    coding: int = method(7, known=4)  # LEVELS, OCTAHEDRAL, BITS or RECOMPUTED
    rows: int = integer(8, 0, 2**31 - 1, default=0)  # how many values are coded
    largest: tuple[int, ...] = integers(9, 0, MOST_LEVEL, (0, MOST_WORDS), default=())
    """Largest level of each coded number."""
    offset: tuple[float, ...] = reals(10, -1e300, 1e300, (0, MOST_WORDS), default=())
    """What level 0 stands for, of each coded number; empty: 0."""
    step: tuple[float, ...] = reals(11, 1e-300, 1e300, (0, MOST_COMPONENTS), default=())
    """One level, of all components or of each; empty: 1."""
    leans: int = method(12, known=2)  # 1: the values are predicted from positions on a grid
    moves: int = method(13, known=2)
    """1: the values are those of the first frame of a sequence, and each GOP tells how they change."""
    seams_of: int = integer(15, 0, 2**16 - 1, default=0)
    """0: the seams follow; otherwise they are those of attribute `seams_of` - 1."""

    def __post_init__(self) -> None:
        normalise_fields(self, "attribute")
        problem = next((problem for problem, broken in _rules(self).items() if broken), None) or _range_problem(self)
        if problem:
            raise OptionError(f"attribute {self.name!r} contradicts itself: {problem}")

    @property
    def words(self) -> int:
        return {OCTAHEDRAL: 2, RECOMPUTED: 0, BITS: self.components * (self.kind - FLOAT32 + 1)}.get(
            self.coding, self.components
        )

    @property
    def is_float(self) -> bool:
        return self.kind >= FLOAT32

    @property
    def by_vertex(self) -> bool:
        """Whether the user is given values by vertices."""
        return (self.domain, self.origin) in ((VERTEX, AS_CODED), (CORNER, OTHERWISE))

    @property
    def offsets(self) -> tuple[float, ...]:
        """What level 0 stands for, of each coded number."""
        return self.offset or (0.0,) * self.words

    @property
    def steps(self) -> tuple[float, ...]:
        """One level of each coded number."""
        return self.step * self.words if len(self.step) == 1 else self.step or (1.0,) * self.words


def _rules(d: Declaration) -> dict[str, bool]:
    unit = d.components == 3 and d.is_float
    return {
        "faces that are given by something else": d.domain == FACE and d.origin != AS_CODED,
        "octahedral values that are not three floats": d.coding == OCTAHEDRAL and not unit,
        "recomputed values that are not three floats": d.coding == RECOMPUTED and not unit,
        "recomputed values of faces": d.coding == RECOMPUTED and d.domain == FACE,
        "bits of integers": d.coding == BITS and not d.is_float,
        "recomputed values that are coded": d.coding == RECOMPUTED and (d.rows > 0 or d.leans > 0),
        "no values": d.coding != RECOMPUTED and d.rows == 0,
        "other than a largest level for each number": len(d.largest) != d.words,
        "offsets or steps of octahedral or recomputed values": d.coding in (OCTAHEDRAL, RECOMPUTED)
        and bool(d.offset or d.step),
        "steps of bits": d.coding == BITS and bool(d.step),
        "other than an offset for each number": len(d.offset) not in (0, d.words),
        "other than a step for all or for each number": len(d.step) not in (0, 1, d.words),
        "octahedral levels that are not two of the same even number": d.coding == OCTAHEDRAL
        and not any(d.largest == (most, most) for most in d.largest[:1] if most in _OCTAHEDRAL),
        "values of faces that lean on positions": d.domain == FACE and d.leans > 0,
        "values that move and are not levels of vertices": d.moves > 0
        and (d.domain, d.origin, d.coding) != (VERTEX, AS_CODED, LEVELS),
        "seams where there are no corners": d.seams_of > 0 and d.domain != CORNER,
    }


def _range_problem(d: Declaration) -> str | None:
    """Why the values that levels stand for are none of the kind."""
    for largest, offset, step in zip(d.largest, d.offsets, d.steps, strict=True):
        last = offset + step * largest
        if d.coding == BITS and not (offset >= 0 and offset.is_integer() and last <= MOST_LEVEL):
            return f"bits from {offset} to {last}"
        if d.coding == LEVELS and d.is_float:
            most = _LARGEST_SINGLE if d.kind == FLOAT32 else 1e308
            if not (math.isfinite(last) and abs(offset) <= most and abs(last) <= most):
                return f"values from {offset} to {last}"
        if d.coding == LEVELS and not d.is_float:
            low, high = _INTEGERS[d.kind]
            if not (offset.is_integer() and step.is_integer() and offset >= low and last <= high):
                return f"values from {offset} to {last} in steps of {step}"
    return None
