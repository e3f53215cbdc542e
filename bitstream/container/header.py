"""The header, and what declares an attribute: each field once, with its key, its legal range and its default."""

from __future__ import annotations

import operator
from collections.abc import Mapping
from dataclasses import MISSING, dataclass, field, fields
from typing import Any, TypeAlias

from bsm._core.bitstream import constant
from bsm.bitstream.errors import OptionError

COUNT = 2**31 - 1
Kind: TypeAlias = type[Any]
MOST_GRID = 2**20 - 1
MOST_ATTRIBUTES = 255


@dataclass(frozen=True)
class Field:
    """How one header field is stored: its msgpack key, its type and the closed range of its legal values."""

    key: int
    type: type
    low: float
    high: float
    is_method: bool = False  # later versions may have more of them
    lengths: tuple[int, int] = (0, 0)
    item: Kind = float

    def normalize(self, value: Any) -> Any:
        """`value` as a plain int, float or tuple of these; `TypeError` or `ValueError` if it is none."""
        if self.type is tuple:
            return tuple(_plain(self.item, item) for item in value)
        return _plain(self.type, value)

    def problem(self, value: Any) -> str | None:
        """Return the fault of a normalized value, or None."""
        items = value if self.type is tuple else (value,)
        if self.type is str:
            items = (len(value.encode() if isinstance(value, str) else value),)
        least, most = self.lengths
        if self.type is tuple and not least <= len(items) <= most:
            return f"has {len(items)} entries, legal are {least} to {most}"
        if not all(self.low <= item <= self.high for item in items):
            return f"= {value} is outside its legal range {self.low:g}..{self.high:g}"
        return None


def _plain(kind: Kind, value: Any) -> Any:
    if kind is str:
        if type(value) is not kind:
            raise TypeError(f"it must be of type {kind.__name__}")
        return value
    return operator.index(value) if kind is int else float(value)


def wire(key: int, kind: Kind, low: float, high: float, default: Any = MISSING, **more: Any) -> Any:
    """Declare a field by its key, type and legal range; `more` of `Field`."""
    return field(default=default, metadata={"wire": Field(key, kind, low, high, **more)})


def method(key: int, known: int, default: int = 0) -> Any:
    """Declare a choice among `known` methods, numbered from 0."""
    return wire(key, int, 0, known - 1, default, is_method=True)


@dataclass(frozen=True)
class Layer:
    """The layer of refinement: the step of a level along the normal, in BSM units, and times `ratio` along tangents."""

    step: float
    ratio: float


@dataclass(frozen=True, kw_only=True)
class Constants:
    """How blocks are coded as in the paper; the defaults are the law's constants for static meshes."""

    bits: int = wire(0, int, 0, 32, default=0)  # of a packed coefficient, q_c; 0: coefficients are adaptive
    coarser: int = wire(1, int, 0, 30, default=0)
    """Packed coefficients of the lowest frequency are in units of 2^coarser steps."""
    exact: int = wire(2, int, 0, 1, default=0)
    """1: a key block begins with the exact eigenbasis, and not with `key_iterations` from cosines."""
    power: int = wire(3, int, 1, 64, default=3)  # the exponent z of one orthogonal iteration
    iterations: int = wire(4, int, 1, 1024, default=1)  # orthogonal iterations per block, t
    key_iterations: int = wire(5, int, 1, 1024, default=2)  # orthogonal iterations of a key block
    shift: float = wire(6, float, 2.0**-30, 2.0**30, default=2.0**-7)  # added to the Laplacian's diagonal, delta
    springs: int = wire(7, int, 0, 1, default=1)  # 1: a block hangs on springs, the prediction between blocks

    def __post_init__(self) -> None:
        normalize_fields(self, "paper")

    def entry(self, law: Constants) -> tuple[float, ...]:
        """The stored numbers; empty: the values of the specification."""
        return () if self == law else tuple(float(getattr(self, name)) for name in fields_of(Constants))


def constants_of(entry: tuple[float, ...], law: Constants) -> Constants:
    """Twin of `Constants.entry`; raises `OptionError`."""
    if not entry:
        return law
    if not all(item.is_integer() for item in (*entry[:6], *entry[7:])):
        raise OptionError(f"paper = {entry} has numbers that are not whole")
    names = zip(fields_of(Constants).items(), entry, strict=True)
    return Constants(**{name: declared.type(item) for (name, declared), item in names})


@dataclass(frozen=True, kw_only=True)
class Header:
    """The parameters of a stream, which precede everything else; decoders refuse contradictory fields."""

    vertices: int = wire(1, int, 1, COUNT)
    faces: int = wire(2, int, 1, COUNT)
    blocks: int = wire(3, int, 0, COUNT, default=0)  # 0: positions on a grid
    block_size: int = wire(4, int, 0, COUNT, default=0)  # vertices of the largest block, n_d
    coefficients: int = wire(5, int, 0, COUNT, default=0)  # columns of the largest dictionary: the largest c_i
    key_interval: int = wire(6, int, 0, COUNT, default=0)
    """One block of every `key_interval` depends on no other; 0: only the first."""
    step: float = wire(7, float, 2.0**-40, 2.0**20, default=2.0**-8)  # quantization step of a coefficient, in BSM units
    center: tuple[float, ...] = wire(8, tuple, -1e300, 1e300, lengths=(3, 3), default=(0.0, 0.0, 0.0))
    """The origin of BSM units, in the mesh's unit."""
    scale: float = wire(9, float, 1e-300, 1e300, default=1.0)
    """One BSM unit in the mesh's unit: the diagonal of the bounding box."""
    smoothing: float = wire(10, float, 0.0, 1e6, default=0.0)  # amount of smoothing after reconstruction, alpha
    refinement: tuple[float, ...] = wire(11, tuple, 0.0, 64.0, lengths=(0, 2), default=())
    """Step and ratio of the layer of refinement; empty: there is none; see `layer`."""
    attributes: int = wire(12, int, 0, MOST_ATTRIBUTES, default=0)  # how many attributes the mesh has
    grid: tuple[int, ...] = wire(13, tuple, 0, MOST_GRID, item=int, lengths=(0, 3), default=())
    """Largest coded value of each axis of a grid; empty: there is none."""
    lattice: tuple[int, ...] = wire(14, tuple, 1, 2**31 - 1, item=int, lengths=(0, 2), default=())
    """(cells, points): the coded value k means k * cells / points, rounded; empty: k itself."""
    corner: tuple[int, ...] = wire(15, tuple, -(2**31), COUNT, item=int, lengths=(0, 3), default=())
    """First cell of a grid on each axis, counted from the origin of the mesh's unit; empty: `center` says it."""
    light: int = method(16, known=3)
    """1: the values of a grid are quick to decode, and some more bytes; 2: floats in their cells follow the values."""
    sequence: tuple[int, ...] = wire(17, tuple, 0, COUNT, item=int, lengths=(0, 2), default=())
    """Frames (0: not known when the stream began) and those of the longest GOP; empty: a static mesh."""
    run: tuple[int, ...] = wire(18, tuple, 0, COUNT, item=int, lengths=(0, 2), default=())
    """Number of the run of a sequence that begins here, and the run whose mesh it has, if it brings none of its own."""
    paper: tuple[float, ...] = wire(19, tuple, 0.0, 2.0**30, lengths=(0, 8), default=())
    """The numbers of `Constants`; empty: those of the law."""
    onorm: int = wire(21, int, 0, 64, default=0)
    """Onorm follows each of so many solutions of an iteration, with packed coefficients; 0: each solution."""
    congruence: int = wire(22, int, 0, 68, default=0)
    """35 plus the transforms between congruent parts of a grid, and 17 more with whole vertices; 0: coded without."""
    turn: tuple[float, ...] = wire(24, tuple, -1.0, 1.0, lengths=(3, 3), default=(0.0, 0.0, 0.0))
    """The quaternion that turns the axes of a grid to those of the mesh, less its first entry, which is 1."""

    def __post_init__(self) -> None:
        normalize_fields(self, "header")

    @property
    def transforms(self) -> int:
        """Transforms between congruent parts; -1: values of a grid are not predicted from such."""
        return (self.congruence - 35) % 17 if self.congruence else -1

    @property
    def whole(self) -> bool:
        """Whether a grid with congruent parts asks for whole vertices (V 17.11)."""
        return self.congruence >= 52

    @property
    def law(self) -> Constants:
        return LAW_OF_SEQUENCES if self.sequence else LAW

    @property
    def constants(self) -> Constants:
        return constants_of(self.paper, self.law)

    @property
    def layer(self) -> Layer | None:
        return Layer(*self.refinement) if len(self.refinement) == 2 else None

    @property
    def frames(self) -> int:
        """Frames of a sequence; 0: a static mesh, or a sequence whose end was not known when it began."""
        return self.sequence[0] if self.sequence else 0

    @property
    def gop_frames(self) -> int:
        """Frames of the longest GOP; 0: a static mesh."""
        return self.sequence[1] if len(self.sequence) == 2 else 0

    @property
    def run_number(self) -> int:
        return self.run[0] if self.run else 0

    @property
    def mesh_of(self) -> int | None:
        """The run whose mesh this one has; None: it brings a mesh of its own."""
        return self.run[1] if len(self.run) == 2 else None


def fields_of(kind: Kind) -> dict[str, Field]:
    return {item.name: item.metadata["wire"] for item in fields(kind)}


def values_of(kind: Kind, numbers: Mapping[int, list[float]]) -> dict[str, Any]:
    """The values of fields, but for texts, of their numbers by keys."""
    return {
        name: tuple(map(item.item, numbers.get(item.key, []))) if item.type is tuple else item.type(*numbers[item.key])
        for name, item in fields_of(kind).items()
        if item.type is not str
    }


def defaults_of(kind: Kind) -> dict[str, Any]:
    return {item.name: item.default for item in fields(kind) if item.default is not MISSING}


HEADER_FIELDS: dict[str, Field] = fields_of(Header)
HEADER_DEFAULTS: dict[str, Any] = defaults_of(Header)


def normalize_fields(record: Any, what: str) -> None:
    """Make the values of a record's fields plain, in place; raise `OptionError` for one that is not legal."""
    for item in fields(record):
        name, declared, given = item.name, item.metadata["wire"], getattr(record, item.name)
        if given is item.default:
            continue
        try:
            value = declared.normalize(given)
        except (TypeError, ValueError, OverflowError) as error:
            raise OptionError(f"{what} field {name} cannot be {given!r}: {error}") from error
        problem = declared.problem(value)
        if problem:
            raise OptionError(f"{what} field {name} {problem}")
        object.__setattr__(record, name, value)


LAW, LAW_OF_SEQUENCES = Constants(), Constants(iterations=2, shift=2.0**-5)
"""Constants of static meshes, and of the first frames of sequences."""


EXACT = 2  # `light`: floats in the cells of a grid follow its values


def entries_of(record: Any) -> list[tuple[int, Any]]:
    """(key, value) of every field that is not at its default, keys ascending."""
    defaults = defaults_of(type(record))
    entries = [
        (declared.key, getattr(record, name))
        for name, declared in fields_of(type(record)).items()
        if name not in defaults or getattr(record, name) != defaults[name]
    ]
    return sorted(entries)


VERTEX, CORNER, FACE = range(3)  # what has a value in the stream
AS_CODED, OTHERWISE = range(2)
"""Whether it is given back so; or coded by vertices and given by corners, or the other way round."""
LEVELS, OCTAHEDRAL, BITS, RECOMPUTED = range(4)  # codings; see A 5
GENERIC, COLOR, NORMAL, TEXCOORD = range(4)

MOST_COMPONENTS = constant("MOST_COMPONENTS")
MOST_WORDS = 2 * MOST_COMPONENTS  # numbers in a coded value: two for each component where they are doubles to the bit
MOST_LEVEL = 2**32 - 1
FLOAT32 = 6


@dataclass(frozen=True, kw_only=True)
class Declaration:
    """An attribute, but for its values; decoders refuse fields that contradict each other."""

    name: str = wire(1, str, 1, constant("MOST_NAME"))
    domain: int = method(2, known=3)  # what has a value in the stream: VERTEX, CORNER or FACE
    origin: int = method(3, known=2)  # given by AS_CODED, or OTHERWISE: VERTEX by corners, CORNER by vertices
    semantic: int = method(4, known=4)  # GENERIC, COLOR, NORMAL or TEXCOORD
    kind: int = method(5, known=8, default=FLOAT32)  # uint8, int8, uint16, int16, uint32, int32, float32 or float64
    components: int = wire(6, int, 1, MOST_COMPONENTS, default=1)
    coding: int = method(7, known=4)  # LEVELS, OCTAHEDRAL, BITS or RECOMPUTED
    rows: int = wire(8, int, 0, 2**31 - 1, default=0)  # how many values are coded
    largest: tuple[int, ...] = wire(9, tuple, 0, MOST_LEVEL, item=int, lengths=(0, MOST_WORDS), default=())
    """Largest level of each coded number."""
    offset: tuple[float, ...] = wire(10, tuple, -1e300, 1e300, lengths=(0, MOST_WORDS), default=())
    """The value of level 0 of each coded number; empty: 0."""
    step: tuple[float, ...] = wire(11, tuple, 1e-300, 1e300, lengths=(0, MOST_COMPONENTS), default=())
    """One level, of all components or of each; empty: 1."""
    leans: int = method(12, known=2)  # 1: the values are predicted from positions on a grid
    moves: int = method(13, known=2)
    """1: the values are those of the first frame of a sequence, and each GOP tells how they change."""
    seams_of: int = wire(15, int, 0, 2**16 - 1, default=0)
    """0: the seams follow; otherwise they are those of attribute `seams_of` - 1."""

    def __post_init__(self) -> None:
        normalize_fields(self, "attribute")
