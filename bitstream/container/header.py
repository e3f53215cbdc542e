"""The header, and what declares an attribute: each field once; ranges and defaults come from the decoder's tables."""

from __future__ import annotations

import operator
from collections.abc import Mapping
from dataclasses import MISSING, dataclass, field, fields
from typing import Any, TypeAlias

from bsm._core.bitstream import fields as table_of

Kind: TypeAlias = type[Any]
MetadataValue: TypeAlias = str | int | float | bytes
MOST_GRID = 2**20 - 1
MOST_ATTRIBUTES = 255
# The table itself is in C, for the decoder is the judge of what a header may hold. Python reads it and has no copy.
_KINDS: tuple[tuple[Kind, Kind], ...] = (
    (int, int),
    (int, int),
    (float, float),
    (tuple, int),
    (tuple, float),
    (str, str),
)
"""Types of a field, and of items of a list, by the numbers of the decoder."""


@dataclass(frozen=True)
class Field:
    """How one field is stored, as the decoder's table says: its key, its type, the closed range of its legal values."""

    key: int
    type: Kind
    item: Kind
    is_method: bool  # later versions may have more of them
    low: float
    high: float
    lengths: tuple[int, int]
    default: Any  # MISSING: it must be stored

    def normalize(self, value: Any) -> Any:
        """`value` as a plain int, float, text or tuple of these."""
        if self.type is tuple:
            return tuple(map(self.item, value))
        # numpy's integers pass, and floats do not: int() would cut 2.5 to 2 without a word.
        return operator.index(value) if self.type is int else self.type(value)


def _fields(declares: bool) -> dict[int, Any]:
    """Fields of a dataclass, by their keys in a header or a declaration."""
    found = {}
    for key, number, low, high, least, most, fallback, required in table_of(declares):
        kind, item = _KINDS[number]
        default = (
            MISSING if required else (item(fallback),) * least if kind is tuple else kind(fallback)
        )
        end = float if item is float else int
        stored = Field(key, kind, item, number == 1, end(low), end(high), (least, most), default)
        found[key] = field(default=default, metadata={"wire": stored})
    return found


_HEADER, _DECLARATION = map(_fields, (False, True))


@dataclass(frozen=True)
class Layer:
    """The layer of refinement: the step of a level along the normal, in BSM units, and times `ratio` along tangents."""

    step: float
    ratio: float


@dataclass(frozen=True, kw_only=True)
class Constants:
    """How blocks are coded as in the paper; the defaults are the law's constants for static meshes."""

    bits: int = 0  # of a packed coefficient, q_c; 0: coefficients are adaptive
    coarser: int = 0
    """Packed coefficients of the lowest frequency are in units of 2^coarser steps."""
    exact: int = 0
    """1: a key block begins with the exact eigenbasis, and not with `key_iterations` from cosines."""
    power: int = 3  # the exponent z of one orthogonal iteration
    iterations: int = 1  # orthogonal iterations per block, t
    key_iterations: int = 2  # orthogonal iterations of a key block
    shift: float = 2.0**-7  # added to the Laplacian's diagonal, delta
    springs: int = 1  # 1: a block hangs on springs, the prediction between blocks

    def entry(self, law: Constants) -> tuple[float, ...]:
        """The stored numbers; empty: the values of the specification."""
        # Numbers of the law take no bytes: nearly all streams have them.
        return () if self == law else tuple(float(getattr(self, name)) for name in PAPER)


@dataclass(frozen=True, kw_only=True)
class Header:
    """The parameters of a stream, which precede everything else; decoders refuse contradictory fields."""

    vertices: int = _HEADER[1]
    faces: int = _HEADER[2]
    blocks: int = _HEADER[3]  # 0: positions on a grid
    block_size: int = _HEADER[4]  # vertices of the largest block, n_d
    coefficients: int = _HEADER[5]  # columns of the largest dictionary: the largest c_i
    key_interval: int = _HEADER[6]
    """One block of every `key_interval` depends on no other; 0: only the first."""
    step: float = _HEADER[7]  # quantization step of a coefficient, in BSM units
    center: tuple[float, ...] = _HEADER[8]
    """The origin of BSM units, in the mesh's unit."""
    scale: float = _HEADER[9]
    """One BSM unit in the mesh's unit: the diagonal of the bounding box."""
    smoothing: float = _HEADER[10]  # amount of smoothing after reconstruction, alpha
    refinement: tuple[float, ...] = _HEADER[11]
    """Step and ratio of the layer of refinement; empty: there is none; see `layer`."""
    attributes: int = _HEADER[12]  # how many attributes the mesh has
    grid: tuple[int, ...] = _HEADER[13]
    """Largest coded value of each axis of a grid; empty: there is none."""
    lattice: tuple[int, ...] = _HEADER[14]
    """(cells, points): the coded value k means k * cells / points, rounded; empty: k itself."""
    corner: tuple[int, ...] = _HEADER[15]
    """First cell of a grid on each axis, counted from the origin of the mesh's unit; empty: `center` says it."""
    light: int = _HEADER[16]
    """1: the values of a grid are quick to decode, and some more bytes; 2: floats in their cells follow the values."""
    sequence: tuple[int, ...] = _HEADER[17]
    """Frames (0: not known when the stream began) and those of the longest GOP; empty: a static mesh."""
    run: tuple[int, ...] = _HEADER[18]
    """Number of the run of a sequence that begins here, and the run whose mesh it has, if it brings none of its own."""
    paper: tuple[float, ...] = _HEADER[19]
    """The numbers of `Constants`; empty: those of the law."""
    onorm: int = _HEADER[21]
    """Onorm follows each of so many solutions of an iteration, with packed coefficients; 0: each solution."""
    congruence: int = _HEADER[22]
    """35 plus the transforms between congruent parts of a grid, and 17 more with whole vertices; 0: coded without."""
    turn: tuple[float, ...] = _HEADER[24]
    """The quaternion that turns the axes of a grid to those of the mesh, less its first entry, which is 1."""

    base: tuple[int, ...] = _HEADER[27]
    """Cells, their reach in edges, rounds of smoothing, and how often the step of their levels is halved from 1; empty:
    blocks are on the mesh itself."""
    swift: int = _HEADER[28]
    """1: values of attributes are quick to decode, and some more bytes; 2: less quick, and fewer bytes."""
    repeats: int = _HEADER[29]
    """1: faces that repeat a corner are counted on the edges of others; 0: they are coded by their corners."""

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
        if not self.paper:
            return self.law
        numbers = zip(PAPER.items(), self.paper, strict=True)
        # All travel as floats in one list. The defaults tell which are integers.
        return Constants(**{name: type(default)(number) for (name, default), number in numbers})

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
        name: tuple(map(item.item, numbers.get(item.key, [])))
        if item.type is tuple
        else item.type(*numbers[item.key])
        for name, item in fields_of(kind).items()
        if item.type is not str
    }


HEADER_FIELDS: dict[str, Field] = fields_of(Header)
LAW, LAW_OF_SEQUENCES = Constants(), Constants(iterations=2, shift=2.0**-5)
"""Constants of static meshes, and of the first frames of sequences."""
PAPER: dict[str, Any] = dict(vars(LAW))
"""Names of the paper's constants, in the order of their numbers, and defaults."""


EXACT = 2  # `light`: floats in the cells of a grid follow its values


def entries_of(record: Any) -> list[tuple[int, Any]]:
    """(key, value) of every field that is not at its default, keys ascending."""
    values = (
        (item, item.normalize(getattr(record, name)))
        for name, item in fields_of(type(record)).items()
    )
    # Fields at their defaults are left out, and decoders refuse streams that store them: each header has one spelling
    # only.
    return sorted((item.key, value) for item, value in values if value != item.default)


VERTEX, CORNER, FACE = range(3)  # what has a value in the stream
AS_CODED, OTHERWISE = range(2)
"""Whether it is given back so; or coded by vertices and given by corners, or the other way round."""
LEVELS, OCTAHEDRAL, BITS, RECOMPUTED = range(4)  # codings; see D 4
TANGENTS = 5  # see A 9.8
GENERIC, COLOR, NORMAL, TEXCOORD = range(4)


@dataclass(frozen=True, kw_only=True)
class Declaration:
    """An attribute, but for its values; decoders refuse fields that contradict each other."""

    name: str = _DECLARATION[1]
    domain: int = _DECLARATION[2]  # the stream has a value for each VERTEX, CORNER or FACE
    # Given by AS_CODED, or OTHERWISE: VERTEX by corners, CORNER by vertices.
    origin: int = _DECLARATION[3]
    semantic: int = _DECLARATION[4]  # GENERIC, COLOR, NORMAL or TEXCOORD
    kind: int = _DECLARATION[5]  # uint8, int8, uint16, int16, uint32, int32, float32 or float64
    components: int = _DECLARATION[6]
    coding: int = _DECLARATION[7]  # LEVELS, OCTAHEDRAL, BITS, RECOMPUTED or TANGENTS
    rows: int = _DECLARATION[8]  # how many values are coded
    largest: tuple[int, ...] = _DECLARATION[9]
    """Largest level of each coded number."""
    offset: tuple[float, ...] = _DECLARATION[10]
    """The value of level 0 of each coded number; empty: 0."""
    step: tuple[float, ...] = _DECLARATION[11]
    """One level, of all components or of each; empty: 1."""
    leans: int = _DECLARATION[12]  # 1: the values are predicted from positions on a grid
    moves: int = _DECLARATION[13]
    """1: the values are those of the first frame of a sequence, and each GOP tells how they change."""
    seams_of: int = _DECLARATION[15]
    """0: the seams follow; otherwise they are those of attribute `seams_of` - 1."""
    bases: tuple[int, ...] = _DECLARATION[16]
    """Of tangents: 1 more than the numbers of the attributes that are their normals and their texture coordinates."""
