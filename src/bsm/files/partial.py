"""Streams decoded in part: their first blocks, or what damage has left of them."""

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from bsm.bitstream.errors import MeshError, OptionError
from bsm.bitstream.limits import Limits
from bsm.codec.arrays import Faces
from bsm.codec.decoding import Decoder
from bsm.codec.events import BlockEvent, ConnectivityEvent, EndEvent, HeaderEvent, LossEvent, RefinementEvent
from bsm.codec.geometry.mesh import TriangleMesh

Progress = Callable[[int, int], None]


def decode_blocks(chunks: Iterator[bytes], count: int, progress: Progress, limits: Limits) -> TriangleMesh:
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


def decode_what_is_left(chunks: Iterator[bytes], report: Callable[[str], None], limits: Limits) -> TriangleMesh:
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
    faces: Faces = np.empty((0, 3), np.int32)
    positions, known = np.empty((0, 3)), np.empty(0, np.bool_)
    with decoder:
        for event in decoder.events(chunks):
            match event:
                case ConnectivityEvent(faces, vertices):
                    positions, known = np.zeros((vertices, 3)), np.zeros(vertices, np.bool_)
                case BlockEvent() | RefinementEvent():
                    positions[event.vertices] = event.positions
                    known[event.vertices] = True
            if enough(event):
                break
        # Faces at the edge of what has come would reach to the origin, where vertices lie that have not.
        complete = np.flatnonzero(known[faces].all(axis=1))
        if len(complete) == 0:
            raise MeshError("no face is complete in the blocks that are there")
        taken = tuple(attribute.taken(np.arange(len(known)), complete) for attribute in decoder.attributes)
        return TriangleMesh(positions, faces[complete], taken, decoder.metadata).without_isolated_vertices()[0]
