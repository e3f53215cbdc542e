"""The stream header: every field is declared once, with its key, its legal range and its default."""

from __future__ import annotations

import operator
from dataclasses import MISSING, dataclass, field, fields
from itertools import accumulate, pairwise
from typing import Any, TypeAlias, TypeVar

from bsm.bitstream.errors import CorruptError, OptionError, UnsupportedError

FIRST_IGNORABLE_KEY = 64
COUNT = 2**31 - 1
METHODS = 255
Kind: TypeAlias = type[Any]
Record = TypeVar("Record")
MOST_GRID = 2**20 - 1
MOST_COPIES, FREE_COPIES = 16, 1 << 16
"""Rows of all blocks together, at most: so many for each vertex, and so many more."""
MOST_ATTRIBUTES = 255
MOST_SECTIONS = 8


@dataclass(frozen=True)
class Field:
    """How one header field is stored: its msgpack key, its type and the closed range of its legal values."""

    key: int
    type: type
    low: float
    high: float
    reserved: float = 0
    lengths: tuple[int, int] = (0, 0)
    item: Kind = float

    def normalise(self, value: Any) -> Any:
        """`value` as a plain int, float or tuple of these; `TypeError` or `ValueError` if it is none."""
        if self.type is tuple:
            return tuple(_plain(self.item, item) for item in value)
        return _plain(self.type, value)

    def problem(self, value: Any) -> str | None:
        """What is wrong with a normalised value, or None."""
        items = value if self.type is tuple else (value,)
        if self.type is str:
            items = (len(value.encode() if isinstance(value, str) else value),)
        least, most = self.lengths
        if self.type is tuple and not least <= len(items) <= most:
            return f"has {len(items)} entries, legal are {least} to {most}"
        if not all(self.low <= item <= self.high for item in items):
            return f"= {value} is outside its legal range {self.low:g}..{self.high:g}"
        return None

    def accepts(self, value: Any) -> bool:
        """Whether a value read from msgpack has the right type."""
        if self.type is tuple:
            return type(value) is list and all(type(item) is self.item for item in value)
        return type(value) is self.type


def _plain(kind: Kind, value: Any) -> Any:
    if kind is str:
        if type(value) is not kind:
            raise TypeError(f"it must be of type {kind.__name__}")
        return value
    return operator.index(value) if kind is int else float(value)


def integer(key: int, low: int, high: int, default: Any = MISSING) -> Any:
    """Declare an integer field."""
    return field(default=default, metadata={"wire": Field(key, int, low, high)})


def method(key: int, known: int, default: int = 0) -> Any:
    """Declare a choice among `known` methods, numbered from 0."""
    return field(default=default, metadata={"wire": Field(key, int, 0, known - 1, reserved=METHODS)})


def real(key: int, low: float, high: float, default: Any = MISSING) -> Any:
    """Declare a float field."""
    return field(default=default, metadata={"wire": Field(key, float, low, high)})


def reals(key: int, low: float, high: float, lengths: tuple[int, int], default: tuple[float, ...]) -> Any:
    """Declare a field that is a list of floats."""
    return field(default=default, metadata={"wire": Field(key, tuple, low, high, lengths=lengths)})


def integers(key: int, low: int, high: int, lengths: tuple[int, int], default: tuple[int, ...]) -> Any:
    """Declare a field that is a list of integers."""
    return field(default=default, metadata={"wire": Field(key, tuple, low, high, lengths=lengths, item=int)})


def text(key: int, low: int, high: int) -> Any:
    """Declare a text of so many bytes of UTF-8."""
    return field(metadata={"wire": Field(key, str, low, high)})


@dataclass(frozen=True)
class Layer:
    """A layer of refinement: lengths in BSM units of a level along the normal, and times `ratio` along two tangents."""

    step: float
    ratio: float

    @property
    def axes(self) -> int:
        """Levels per vertex."""
        return 3 if self.ratio else 1


@dataclass(frozen=True)
class Span:
    """A section of a mesh: the numbers of the faces and of the blocks that come with it."""

    faces: range
    blocks: range


@dataclass(frozen=True, kw_only=True)
class Header:
    """What a decoder must know before anything else; a header with illegal or contradictory values cannot be made."""

    vertices: int = integer(1, 1, COUNT)
    faces: int = integer(2, 1, COUNT)
    blocks: int = integer(3, 0, COUNT, default=0)
    """0: positions on a grid, there are no blocks."""
    block_size: int = integer(4, 0, COUNT, default=0)
    """Vertices of the largest block, n_d."""
    coefficients: int = integer(5, 0, COUNT, default=0)
    """Columns of the largest dictionary: the largest c_i."""
    key_interval: int = integer(8, 0, COUNT, default=0)
    """Every so many blocks one does not depend on others; 0: only the first."""
    power: int = integer(9, 1, 64, default=3)
    """The exponent z of one orthogonal iteration."""
    iterations: int = integer(10, 1, 1024, default=1)
    """Orthogonal iterations per block, t."""
    key_iterations: int = integer(11, 1, 1024, default=4)
    """Orthogonal iterations of a key block."""
    shift: float = real(12, 2.0**-30, 2.0**30, default=0.0078125)
    """What is added to the Laplacian's diagonal, delta."""
    coding: int = method(14, known=2, default=1)
    """Coefficients: 0: packed and zstd; 1: adaptive."""
    bits: int = integer(15, 1, 32, default=12)
    """Bits of a packed coefficient, q_c."""
    step: float = real(16, 2.0**-40, 2.0**20, default=2.0**-8)
    """Quantisation step of a coefficient, in BSM units."""
    center: tuple[float, ...] = reals(17, -1e300, 1e300, (3, 3), default=(0.0, 0.0, 0.0))
    """The origin of BSM units, in the mesh's unit."""
    scale: float = real(18, 1e-300, 1e300, default=1.0)
    """One BSM unit in the mesh's unit: the diagonal of the bounding box."""
    stiffness: float = real(19, 0.0, 65536.0, default=8.0)
    """Of the springs on which a block hangs, the prediction between blocks; 0: there are none."""
    smoothing: float = real(20, 0.0, 1e6, default=0.0)
    """Amount of smoothing after reconstruction, alpha."""
    frames: int = integer(21, 0, COUNT, default=0)
    """Frames of a sequence; 0: a static mesh, or a sequence whose end was not known when it began."""
    gop_frames: int = integer(23, 0, COUNT, default=0)
    """Frames of the longest GOP; 0: a static mesh."""
    detail_step: float = real(25, 0.0, 2.0**20, default=0.0)
    """Quantization step of the detail layer, in BSM units; 0: there is none."""
    details: int = integer(26, 0, COUNT, default=0)
    """Coefficients of the largest detail layer of a block."""
    coarser: int = integer(27, 0, 30, default=0)
    """Packed coefficients: those of the lowest frequency are in units of 2^coarser steps."""
    grid: tuple[int, ...] = integers(28, 0, MOST_GRID, (0, 3), default=())
    """Largest coded value of each axis of a grid; empty: there is none."""
    lattice: tuple[int, ...] = integers(29, 1, 2**31 - 1, (0, 2), default=())
    """(cells, points): the coded value k stands for k * cells / points, rounded; empty: for itself."""
    refinements: tuple[float, ...] = reals(30, 0.0, 64.0, (0, 8), default=())
    """Step and ratio of each layer of refinement, one pair after another; see `layers`."""
    key_seed: int = method(31, known=2)
    """Block without predecessor: 0: `key_iterations` from cosines; 1: exact eigenbasis."""
    borders: int = method(32, known=2)
    """1: in the last layer of refinement only vertices of borders have levels."""
    attributes: int = integer(33, 0, MOST_ATTRIBUTES, default=0)
    """How many attributes the mesh has."""
    corner: tuple[int, ...] = integers(40, -(2**31), COUNT, (0, 3), default=())
    """First cell of a grid on each axis, counted from the origin of the mesh's unit; empty: `center` says it."""
    sections: tuple[int, ...] = integers(41, 1, COUNT, (0, 2 * (MOST_SECTIONS - 1)), default=())
    """Faces and blocks of each section but the last, one pair after another; see `spans`."""
    light: int = method(42, known=3)
    """1: the values of a grid are quick to decode, and some more bytes; 2: floats in their cells follow the values."""
    run: int = integer(43, 0, COUNT, default=0)
    """Number of the run of a sequence that begins here."""
    again: int = integer(44, 0, COUNT, default=0)
    """0: the run brings a mesh of its own; k + 1: it has that of run k again."""

    def __post_init__(self) -> None:
        normalise_fields(self, "header")
        problem = contradiction(self)
        if problem:
            raise OptionError(f"header contradicts itself: {problem}")

    @property
    def layers(self) -> tuple[Layer, ...]:
        """The layers of refinement."""
        return tuple(map(Layer, self.refinements[::2], self.refinements[1::2]))

    @property
    def spans(self) -> tuple[Span, ...]:
        """The sections that the mesh comes in; one, unless `sections` says otherwise."""
        faces = accumulate((*self.sections[::2], self.faces - sum(self.sections[::2])), initial=0)
        blocks = accumulate((*self.sections[1::2], self.blocks - sum(self.sections[1::2])), initial=0)
        pairs = zip(pairwise(faces), pairwise(blocks), strict=True)
        return tuple(Span(range(*some), range(*others)) for some, others in pairs)


def fields_of(kind: Kind) -> dict[str, Field]:
    """The declared fields of a class, by name."""
    return {item.name: item.metadata["wire"] for item in fields(kind)}


def defaults_of(kind: Kind) -> dict[str, Any]:
    """The defaults of those that have one."""
    return {item.name: item.default for item in fields(kind) if item.default is not MISSING}


HEADER_FIELDS: dict[str, Field] = fields_of(Header)
HEADER_DEFAULTS: dict[str, Any] = defaults_of(Header)


def normalise_fields(record: Any, what: str) -> None:
    """Make the values of a record's fields plain, in place; raise `OptionError` for one that is not legal."""
    for name, declared in fields_of(type(record)).items():
        given = getattr(record, name)
        try:
            value = declared.normalise(given)
        except (TypeError, ValueError, OverflowError) as error:
            raise OptionError(f"{what} field {name} cannot be {given!r}: {error}") from error
        problem = declared.problem(value)
        if problem:
            raise OptionError(f"{what} field {name} {problem}")
        object.__setattr__(record, name, value)


def contradiction(header: Header) -> str | None:
    """Which two fields of a header exclude each other, or None."""
    rules = _grid_rules(header) if header.grid else _again_rules(header) if header.again else _block_rules(header)
    return next((problem for problem, broken in rules.items() if broken), None)


EXACT = 2
"""`light`: floats in the cells of a grid follow its values."""


def _grid_rules(header: Header) -> dict[str, bool]:
    cells, points = header.lattice if len(header.lattice) == 2 else (0, 0)
    return {
        "more vertices than the corners of its faces": header.vertices > 3 * header.faces,
        "a grid of other than three axes": len(header.grid) != 3,
        "a lattice that is not cells and points": bool(header.lattice) and not points,
        "a lattice with fewer points than the grid has values": 0 < points < max(header.grid),
        "a lattice of more points than cells": points > cells,
        "a corner that is not one of three axes": len(header.corner) not in (0, 3),
        "a corner and a center": bool(header.corner) and any(header.center),
        "floats in the cells of a lattice, or of cells that are counted": header.light == EXACT
        and bool(header.lattice or header.corner),
    } | {
        f"a grid, and {name}": getattr(header, name) != default
        for name, default in HEADER_DEFAULTS.items()
        if name not in ("grid", "lattice", "center", "scale", "attributes", "corner", "light")
    }


def _again_rules(header: Header) -> dict[str, bool]:
    return {
        "more vertices than the corners of its faces": header.vertices > 3 * header.faces,
        "the mesh of a run that has not been": header.again > header.run,
        "no length for GOPs": header.gop_frames == 0,
    } | {
        f"the mesh of another run, and {name}": getattr(header, name) != default
        for name, default in HEADER_DEFAULTS.items()
        if name not in ("frames", "gop_frames", "run", "again")
    }


def _block_rules(header: Header) -> dict[str, bool]:
    return {
        "neither blocks nor a grid": not (header.blocks and header.block_size and header.coefficients),
        "a lattice without a grid": bool(header.lattice),
        "a corner without a grid": bool(header.corner),
        "light values without a grid": bool(header.light),
        "more vertices than the corners of its faces": header.vertices > 3 * header.faces,
        "more blocks than vertices": header.blocks > header.vertices,
        "blocks larger than the mesh": header.block_size > header.vertices,
        "blocks too small to cover the mesh": header.blocks * header.block_size < header.vertices,
        "blocks that overlap too much": header.blocks * header.block_size > MOST_COPIES * header.vertices + FREE_COPIES,
        "more coefficients than a block has vertices": header.coefficients > header.block_size,
        "more details than a block has vertices": header.details > header.block_size,
        "details without a step, or a step without details": (header.details > 0) != (header.detail_step > 0),
        "frames without a length for GOPs": header.frames > 0 and header.gop_frames == 0,
        "a run of a static mesh": header.run > 0 and header.gop_frames == 0,
        "refinements that are not pairs of step and ratio": len(header.refinements) % 2 == 1,
        "a step of a refinement that is not in 2^-40..1": not all(2.0**-40 <= x.step <= 1 for x in header.layers),
        "a ratio of a refinement that is neither 0 nor in 1/16..64": not all(
            x.ratio == 0 or x.ratio >= 1 / 16 for x in header.layers
        ),
        "borders without refinements": bool(header.borders) and not header.refinements,
        "sections that are not pairs of faces and blocks": len(header.sections) % 2 == 1,
        "no faces for the last section": sum(header.sections[::2]) >= header.faces,
        "no blocks for the last section": sum(header.sections[1::2]) >= header.blocks,
        "sections of a sequence": bool(header.sections) and header.gop_frames > 0,
        "refinements of a sequence": bool(header.refinements) and header.gop_frames > 0,
    }


def header_to_entries(header: Header) -> list[tuple[int, Any]]:
    """(key, value) of every field that is not at its default, keys ascending."""
    return entries_of(header)


def header_from_entries(entries: list[tuple[Any, Any]]) -> Header:
    """The header that `header_to_entries` came from; raises as `record_of`."""
    return record_of(Header, "header", entries)


def entries_of(record: Any) -> list[tuple[int, Any]]:
    """(key, value) of every field that is not at its default, keys ascending."""
    defaults = defaults_of(type(record))
    entries = [
        (declared.key, getattr(record, name))
        for name, declared in fields_of(type(record)).items()
        if name not in defaults or getattr(record, name) != defaults[name]
    ]
    return sorted(entries)


def record_of(kind: type[Record], what: str, entries: list[tuple[Any, Any]]) -> Record:
    """The record that `entries_of` came from; keys from 64 on are ignored."""
    declarations, defaults = fields_of(kind), defaults_of(kind)
    names = {declared.key: name for name, declared in declarations.items()}
    _refuse_unknown(entries, names, declarations, what)
    values: dict[str, Any] = {}
    for key, value in entries:
        if key >= FIRST_IGNORABLE_KEY:
            continue
        name, declared = names[key], declarations[names[key]]
        if not declared.accepts(value):
            raise CorruptError(f"{what} field {name} has type {type(value).__name__}")
        values[name] = declared.normalise(value)
        if name in defaults and values[name] == defaults[name]:
            raise CorruptError(f"{what} field {name} is stored although it has its default value")
    missing = [name for name in declarations if name not in defaults and name not in values]
    if missing:
        raise CorruptError(f"{what} lacks {', '.join(missing)}")
    try:
        return kind(**values)
    except OptionError as error:
        raise CorruptError(error.message) from error


def _refuse_unknown(
    entries: list[tuple[Any, Any]], names: dict[int, str], declarations: dict[str, Any], what: str
) -> None:
    """What is of a later version is told as that, whatever else may seem to be wrong with it."""
    for key, value in entries:
        if type(key) is not int or key < 0:
            raise CorruptError(f"{what} key {key!r} is not an unsigned integer")
        if key not in names:
            if key < FIRST_IGNORABLE_KEY:
                raise UnsupportedError(
                    f"{what} key {key} is unknown to this decoder, and the stream cannot do without it"
                )
            continue
        declared = declarations[names[key]]
        if declared.type is int and declared.accepts(value) and declared.high < value <= declared.reserved:
            raise UnsupportedError(f"{what} field {names[key]} names method {value}, unknown to this decoder")
