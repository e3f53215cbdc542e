"""Events that the decoders of meshes and sequences report."""

from dataclasses import dataclass, field
from enum import Enum
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from bsm.bitstream.container.header import Header
from bsm.bitstream.errors import BsmError, counted, public
from bsm.codec.arrays import Faces, Indices, Mask, Positions
from bsm.codec.geometry.attributes import Attribute, Domain, Semantic


@public
class Signal(Enum):
    """The result of `next_event` without an event.

    Examples
    --------
    >>> import bsm
    >>> with bsm.Decoder() as decoder:
    ...     decoder.next_event() is bsm.NEED_DATA
    True
    """

    NEED_DATA = "give more bytes to receive_data, or call receive_eof"
    END_OF_STREAM = "END was read and nothing follows"


NEED_DATA = Signal.NEED_DATA
END_OF_STREAM = Signal.END_OF_STREAM


@public
@dataclass(frozen=True)
class HeaderEvent:
    """The header has arrived.

    Parameters
    ----------
    header : Header
        `vertices`, `scale` and all other fields of the specification, under the same names.

    Examples
    --------
    >>> import bsm
    >>> event = next(bsm.Decoder().events([bsm.encode("bunny.ply")]))
    >>> isinstance(event, bsm.HeaderEvent), event.header.vertices > 0
    (True, True)
    """

    header: Header

    def __repr__(self) -> str:
        header = self.header
        frames = {"frames": header.frames} if header.sequence else {}
        return f"HeaderEvent({counted(vertices=header.vertices, faces=header.faces, **frames)})"


# Three arrays and not a list of vertices: an event of a large mesh has thousands.
@dataclass(frozen=True, eq=False)
class Changes:
    """Changed vertices, their positions in the mesh's unit, and which of them are final."""

    vertices: Indices
    positions: Positions
    final: Mask

    def __repr__(self) -> str:
        return (
            f"{type(self).__name__}({len(self.vertices)} vertices, {int(self.final.sum())} final)"
        )


@public
@dataclass(frozen=True, eq=False)
class ConnectivityEvent:
    """The faces have arrived, and everything else that precedes positions.

    If the stream stores the order of the mesh, faces and all vertex indices are in this order.

    Parameters
    ----------
    faces : int32 array, shape (m, 3)
    vertices : int
        Number of vertices; if the stream stores the vertices of the input, more than were coded.
    loose : Changes
        Vertices that no face uses; they are final.

    Examples
    --------
    >>> import bsm
    >>> data = bsm.encode("bunny.ply", step=0.002)
    >>> with bsm.Decoder() as decoder:
    ...     found = [it for it in decoder.events([data]) if isinstance(it, bsm.ConnectivityEvent)]
    >>> found[0]
    ConnectivityEvent(... faces, ... vertices)
    """

    faces: Faces
    vertices: int
    loose: Changes

    def __repr__(self) -> str:
        return f"ConnectivityEvent({len(self.faces)} faces, {self.vertices} vertices)"


@public
@dataclass(frozen=True, eq=False, repr=False)
class BlockEvent(Changes):
    """A block, or a chunk of a mesh on a grid, has been decoded: layer 0.

    Parameters
    ----------
    vertices : int32 array, shape (v,)
        Vertices that this block moved or finished.
    positions : float64 array, shape (v, 3)
        Their new positions, in the mesh's unit.
    final : bool array, shape (v,)
        Which of them no later block will move (the layer of refinement may).
    index : int
        Of the block or chunk.

    Examples
    --------
    >>> import bsm
    >>> data = bsm.encode("bunny.ply", step=0.002)
    >>> with bsm.Decoder() as decoder:
    ...     found = [it for it in decoder.events([data]) if isinstance(it, bsm.BlockEvent)]
    """

    layer: ClassVar[int] = 0

    index: int


@public
@dataclass(frozen=True, eq=False)
class RefinementEvent:
    """Levels of the refinement layer have been decoded. They follow all blocks.

    Parameters
    ----------
    vertices : int32 array, shape (v,)
        The vertices that moved.
    positions : float64 array, shape (v, 3)
        Their new positions, in the mesh's unit.

    Examples
    --------
    >>> import bsm
    >>> data = bsm.encode("bunny.ply", step=0.002)
    >>> with bsm.Decoder() as decoder:
    ...     found = [it for it in decoder.events([data]) if isinstance(it, bsm.RefinementEvent)]
    """

    layer: ClassVar[int] = 1

    vertices: Indices
    positions: Positions

    def __repr__(self) -> str:
        return f"RefinementEvent({len(self.vertices)} vertices)"


@public
@dataclass(frozen=True, eq=False)
class AttributeEvent:
    """Values of an attribute have been decoded.

    Parameters
    ----------
    name : str
    domain : {"vertex", "corner", "face"}
    semantic : {"generic", "color", "normal", "texcoord"}
    indices : int32 array, shape (m, 3), optional
        For corners: the index of the value of each corner.
    rows : int32 array, shape (r,)
        Indices of the values that are now available: of vertices or faces, or those that `indices` refer to.
    values : array, shape (r, c)

    Examples
    --------
    >>> import bsm
    >>> data = bsm.encode("spot.obj", step=0.002)
    >>> with bsm.Decoder() as decoder:
    ...     found = [it for it in decoder.events([data]) if isinstance(it, bsm.AttributeEvent)]
    >>> found[0].name, found[0].domain
    ('texcoord', 'corner')
    """

    name: str
    domain: Domain
    semantic: Semantic
    indices: Indices | None
    rows: Indices
    values: npt.NDArray[Any]

    def __repr__(self) -> str:
        return f"AttributeEvent({self.name!r}, {self.semantic} of each {self.domain}, {counted(values=len(self.rows))})"


@public
@dataclass(frozen=True, eq=False)
class FrameEvent:
    """A frame has been decoded.

    Parameters
    ----------
    index : int
        Its number, from 0.
    positions : float64 array, shape (n, 3)
        In the mesh's unit.
    faces : int32 array, shape (m, 3)
        Its faces; a new array only if they may have changed.
    attributes : tuple of Attribute
        Its attributes, as far as they have arrived; moving ones have the values of this frame.

    Examples
    --------
    >>> import bsm
    >>> with bsm.SequenceDecoder(start=2) as decoder, open("dance.bsm", "rb") as file:
    ...     [event.index for event in decoder.events(file) if isinstance(event, bsm.FrameEvent)]
    [2, 3, 4, 5]
    """

    index: int
    positions: Positions
    faces: Faces
    attributes: tuple[Attribute, ...] = ()

    def __repr__(self) -> str:
        return f"FrameEvent(frame {self.index}, {len(self.positions)} vertices)"


@public
@dataclass(frozen=True)
class LossEvent:
    """A tolerant decoder could not decode some data, and continues.

    Parameters
    ----------
    block : int, optional
        The lost block of a static mesh; None for bytes that belong to no known block.
    error : BsmError
        The reason, and the offset in the stream.
    frames : range
        The lost frames of a sequence; an empty range with a start if their number is unknown.

    Examples
    --------
    >>> import bsm
    >>> damaged = bytearray(bsm.encode("bunny.ply", step=0.002))
    >>> damaged[-60] ^= 1
    >>> with bsm.Decoder(tolerant=True) as decoder:
    ...     found = [it for it in decoder.events([damaged]) if isinstance(it, bsm.LossEvent)]
    >>> isinstance(found[0].error, bsm.CorruptError)
    True
    """

    block: int | None
    error: BsmError
    frames: range = range(0)

    def __post_init__(self) -> None:
        # Who keeps losses shall not keep what there was where they came to light.
        # A traceback holds the frames of all callers, and their arrays.
        self.error.__traceback__ = self.error.__context__ = self.error.__cause__ = None


@dataclass(frozen=True, eq=False)
class Losses:
    """Vertices without any copy, and vertices that lack a copy or lie in the filter's reach of one that is missing."""

    missing: Indices = field(default_factory=lambda: np.empty(0, np.int32))
    degraded: Indices = field(default_factory=lambda: np.empty(0, np.int32))

    def __repr__(self) -> str:
        return f"Losses({len(self.missing)} vertices missing, {len(self.degraded)} degraded)"


@public
@dataclass(frozen=True, eq=False)
class EndEvent:
    """The stream has ended.

    Parameters
    ----------
    losses : Losses
        Vertices that are missing or degraded. Only a tolerant decoder reports any; otherwise the checksum is verified.

    Examples
    --------
    >>> import bsm
    >>> data = bsm.encode("bunny.ply", step=0.002)
    >>> with bsm.Decoder() as decoder:
    ...     found = [it for it in decoder.events([data]) if isinstance(it, bsm.EndEvent)]
    >>> found[0].losses
    Losses(0 vertices missing, 0 degraded)
    """

    losses: Losses = field(default_factory=Losses)
