"""Streams decoded in part: their first blocks, or what damage has left of them."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import MeshError, OptionError
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits
from bsm.codec.decoding import Decoder
from bsm.codec.events import (
    AttributeEvent,
    BlockEvent,
    ConnectivityEvent,
    EndEvent,
    HeaderEvent,
    LossEvent,
    RefinementEvent,
)
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.mesh import TriangleMesh

Progress = Callable[[int, int], None]


def decode_blocks(
    chunks: Iterator[bytes], count: int, progress: Progress, limits: Limits = DEFAULT_LIMITS
) -> TriangleMesh:
    """Decode the first `count` blocks, read no further, and return the faces whose vertices have all arrived."""
    if count < 1:
        raise OptionError("at least one block must be decoded")
    wanted, done = count, 0

    def enough(event: Any) -> bool:
        nonlocal wanted, done
        if isinstance(event, HeaderEvent):
            wanted = count if event.header.grid else min(count, event.header.blocks)
        elif isinstance(event, BlockEvent):
            done += 1
            progress(done, wanted)
        return done == wanted or isinstance(event, EndEvent)

    return _decode_until(Decoder(limits), chunks, enough)


def decode_what_is_left(
    chunks: Iterator[bytes], report: Callable[[str], None], limits: Limits = DEFAULT_LIMITS
) -> TriangleMesh:
    """Decode every block of a damaged stream that does not depend on lost data; call `report` for each loss."""

    def reported(event: Any) -> bool:
        match event:
            case LossEvent(_, error):
                report(f"lost: {error}")
            case EndEvent(losses) if len(losses.missing) or len(losses.degraded):
                report(f"{len(losses.missing)} vertices missing, {len(losses.degraded)} degraded")
        return False

    return _decode_until(Decoder(limits, tolerant=True), chunks, reported)


def _decode_until(decoder: Decoder, chunks: Iterator[bytes], enough: Callable[[Any], bool]) -> TriangleMesh:
    """Decode until an event is enough, or to the end; the faces whose vertices have all arrived."""
    part = _Part()
    with decoder:
        for event in decoder.events(chunks):
            part.take(event)
            if enough(event):
                break
        whole = decoder.attributes if part.is_whole else ()
    return replace(part.mesh(whole), metadata=decoder.metadata)


class _Part:
    """The known part of a mesh while its blocks arrive."""

    def __init__(self) -> None:
        self._faces: npt.NDArray[np.int32] = np.empty((0, 3), np.int32)
        self._positions, self._known = np.empty((0, 3)), np.empty(0, np.bool_)
        self._values: dict[str, list[AttributeEvent]] = {}
        self.is_whole = False

    def take(self, event: Any) -> None:
        match event:
            case ConnectivityEvent(faces, vertices):
                self._faces, self._positions, self._known = faces, np.zeros((vertices, 3)), np.zeros(vertices, np.bool_)
            case BlockEvent() | RefinementEvent():
                self._positions[event.vertices] = event.positions
                self._known[event.vertices] = True
            case AttributeEvent(name):
                self._values.setdefault(name, []).append(event)
            case EndEvent(losses):
                self.is_whole = not (len(losses.missing) or len(losses.degraded))

    def mesh(self, whole: Sequence[Attribute] = ()) -> TriangleMesh:
        """The faces whose vertices are known, with attributes that are `whole`, or else those that events tell of."""
        complete = np.flatnonzero(self._known[self._faces].all(axis=1))
        if len(complete) == 0:
            raise MeshError("no face is complete in the blocks that are there")
        every_vertex = np.arange(len(self._positions))
        attributes = whole or [found for found in map(self._attribute, self._values.values()) if found]
        taken = tuple(attribute.taken(every_vertex, complete) for attribute in attributes)
        return TriangleMesh(self._positions, self._faces[complete], taken).without_isolated_vertices()[0]

    def _attribute(self, events: list[AttributeEvent]) -> Attribute | None:
        """The attribute that events tell of, None if values of it are missing."""
        first = events[0]
        rows = np.concatenate([event.rows for event in events])
        sizes = {"vertex": len(self._positions), "face": len(self._faces)}
        size = sizes[first.domain] if first.indices is None else int(first.indices.max()) + 1
        if len(np.unique(rows)) < size:
            return None
        values = np.zeros((size, first.values.shape[1]), first.values.dtype)
        values[rows] = np.concatenate([event.values for event in events])
        return Attribute(first.name, values, first.domain, first.semantic, first.indices)
