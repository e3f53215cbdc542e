"""What a stream consists of, once it is no longer bytes."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TypeAlias

from bsm.bitstream.container.declaration import Declaration as Declaration
from bsm.bitstream.container.header import Header as Header
from bsm.bitstream.container.wire import FrameType
from bsm.bitstream.errors import OptionError

MetadataValue: TypeAlias = str | int | float | bytes


@dataclass(frozen=True)
class Metadata:
    """The user's own names and values; kept in the order of the names."""

    entries: Mapping[str, MetadataValue] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for name, value in self.entries.items():
            if type(name) is not str or type(value) not in (str, int, float, bytes):
                raise OptionError(f"metadata {name!r}: {value!r} must map a str to a str, int, float or bytes")
        object.__setattr__(self, "entries", dict(sorted(self.entries.items())))


@dataclass(frozen=True)
class Connectivity:
    """The coded faces."""

    data: bytes


@dataclass(frozen=True)
class Partition:
    """Which vertex belongs to which block, coded."""

    data: bytes


@dataclass(frozen=True)
class Order:
    """The order that vertices and faces had before coding, coded."""

    data: bytes


@dataclass(frozen=True)
class Block:
    """The coded coefficients of block `index`: `coefficients` (c_i) of them per coordinate."""

    index: int
    coefficients: int
    data: bytes


@dataclass(frozen=True)
class Gop:
    """The coded coefficients of a group of a sequence's frames; `index` is the number of the first of them."""

    index: int
    data: bytes


@dataclass(frozen=True)
class Grid:
    """The coded positions, on the header's grid, of `count` vertices, from number `first` of the order of coding on."""

    first: int
    count: int
    data: bytes


@dataclass(frozen=True)
class Refinement:
    """The coded levels of `count` vertices, from number `first` on, in the layer of refinement."""

    first: int
    count: int
    data: bytes


@dataclass(frozen=True)
class Attribute:
    """An attribute of the mesh, counted from 0, and its coded seams, if it has any of its own."""

    index: int
    declaration: Declaration
    seams: bytes = b""


@dataclass(frozen=True)
class Values:
    """The coded values of an attribute: `count` of them, from number `first` of the order of coding on."""

    attribute: int
    first: int
    count: int
    data: bytes


@dataclass(frozen=True)
class End:
    """The last frame: how many were before it, the CRC-32 of all bytes before it, and that of decoded positions."""

    frames: int
    crc: int
    positions: int | None = None


@dataclass(frozen=True)
class Damaged:
    """Bytes that a tolerant reader could not read and skipped."""

    type: FrameType | None
    offset: int
    length: int
    reason: str


Packet: TypeAlias = (
    Header | Metadata | Connectivity | Partition | Order | Attribute | Block | Gop | Grid | Refinement | Values | End
)
