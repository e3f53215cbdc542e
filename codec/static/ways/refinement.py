"""The layer of refinement: vertices are raised along normals as levels come, and moved aside when all have."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from bsm.bitstream.container import packets
from bsm.bitstream.container.header import Layer
from bsm.bitstream.container.wire import FrameType
from bsm.bitstream.errors import CorruptError
from bsm.bitstream.fields.corners import FieldDecoder, FieldEncoder
from bsm.bitstream.fields.grid import AXES, levels_field
from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Indices, Levels, Mask, Matrix
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.signal.smooth import lift, local_frames, raised, slide, tangent_steps
from bsm.codec.static.assembly import Assembly
from bsm.codec.static.attributes.decoding import BodyStage
from bsm.codec.static.attributes.surface import Solid
from bsm.codec.static.events import Losses, RefinementEvent
from bsm.codec.static.preamble_decoding import Structure
from bsm.codec.static.stages import Arrival, Stage
from bsm.codec.static.work import chunk_cost, layer_cost, layer_memory
from bsm.codec.threads import Lanes, Pending

CHUNK = 1 << 15  # vertices of a frame
BENT_BY = 2  # how many rings of vertices a step along the surface follows from


def encode_layer(faces: Indices, levels: Levels) -> list[packets.Refinement]:
    encoder, size = FieldEncoder(levels_field(faces, len(levels)), levels), len(levels)
    chunks = [(start, min(CHUNK, size - start)) for start in range(0, size, CHUNK)]
    return [packets.Refinement(start, count, encoder.chunk(count)) for start, count in chunks]


@dataclass(frozen=True, eq=False)
class PendingLevels:
    """Levels of some vertices that are being decoded, and what they will refine."""

    pending: Pending[tuple[Indices, Levels]]
    refined: Refined


class RefinementStage(BodyStage):
    """All blocks are there, or known to be lost; levels come."""

    def __init__(self, assembly: Assembly, structure: Structure, lanes: Lanes, tolerant: bool) -> None:
        self._lanes = lanes
        self._refined = Refined(assembly, structure)
        super().__init__(self._refined, structure, tolerant)
        self._decoder = LayerDecoder(structure)

    def accept(self, arrival: Arrival, queue: deque[Any]) -> Stage[Any]:
        if not isinstance(arrival, packets.Refinement):
            return super().accept(arrival, queue)
        decode = partial(self._decoder.decode, arrival)
        queue.append(PendingLevels(self._lanes.submit(-1, decode), self._refined))
        return self

    def _lose(self, damaged: packets.Damaged, queue: deque[Any]) -> None:
        if damaged.type is not FrameType.VALUES:
            self._refined.lose()
        super()._lose(damaged, queue)


class LayerDecoder:
    """Decodes the packets of the layer, in their order."""

    def __init__(self, structure: Structure) -> None:
        self._structure = structure

    def decode(self, packet: packets.Refinement) -> tuple[Indices, Levels]:
        """Vertices, shape (k,), and their levels, shape (k, 3)."""
        self._structure.allowance.spend(chunk_cost(len(packet.data)), len(packet.data))
        following = self._decoder.coded
        if packet.first != following:
            raise CorruptError(f"the layer lacks the vertices before {packet.first}: the rest is lost")
        return self._decoder.chunk(packet.data, packet.count)

    @cached_property
    def _decoder(self) -> FieldDecoder:
        structure, allowance = self._structure, self._structure.allowance
        vertices, faces = structure.header.vertices, structure.faces
        allowance.keep(layer_memory(vertices, len(faces)))
        allowance.spend(layer_cost(vertices, len(faces), AXES))
        return FieldDecoder(levels_field(faces, vertices), allowance.limits)


class Refined:
    """The blocks of a mesh, put together, and what the layer has added so far."""

    def __init__(self, assembly: Assembly, structure: Structure) -> None:
        self._assembly = assembly
        self._structure = structure
        self._lossy = self._begun = False
        self._reached = np.zeros(structure.header.vertices, np.bool_)
        self._levels = np.zeros((structure.header.vertices, AXES), np.int32)

    def add(self, vertices: Indices, levels: Levels) -> Indices:
        """Add the levels, shape (k, 3), of successive vertices, shape (k,): heights at once, slides with the last"""
        base, layer = self._base, self._layer
        rows, size = slice(int(vertices[0]), int(vertices[-1]) + 1), len(base.whole)
        whole, self._begun = base.whole[rows], True
        lift(self._positions[rows], base.frames[rows], levels * whole[:, None], layer.step)
        self._levels[rows] = levels
        return self._slid() if rows.stop == size else vertices[whole]

    def _slid(self) -> Indices:
        """Move vertices along the surface, as far as their steps are known: those around them must have heights."""
        base, layer = self._base, self._layer
        faces, fit = self._structure.faces, base.whole
        for _ in range(0 if fit.all() else BENT_BY):
            fit = fit.copy()
            fit[faces[~fit[faces].all(axis=1)]] = False
        upright = raised(base.positions, base.frames, self._levels, layer.step)
        steps = tangent_steps(upright, faces, layer.step, layer.ratio)
        slide(self._positions, base.frames, self._levels * fit[:, None], steps)
        self._reached = fit
        return np.flatnonzero(base.whole).astype(np.int32)

    @property
    def _layer(self) -> Layer:
        layer = self._structure.header.layer
        assert layer is not None
        return layer

    def event(self, vertices: Indices) -> RefinementEvent:
        """Say where vertices, shape (k,), are now."""
        numbers, rows = self._structure.numbering.spread(vertices)
        positions = self._structure.units.back(self._positions[vertices])
        return RefinementEvent(numbers, positions[rows])

    def mesh(self, checksum: int | None = None) -> TriangleMesh:
        decoded = self._structure.units.back(self._positions)
        return self._structure.numbering.mesh(decoded, checksum if self._whole else None)

    def lose(self) -> None:
        self._lossy = True

    def solid(self) -> Solid | None:
        """Decoded positions; None if any of it is missing."""
        return Solid(self._positions) if self._whole else None

    @property
    def _whole(self) -> bool:
        return self._assembly.whole and not self._lossy

    def losses(self) -> Losses:
        """What is missing or less good: also what the layer has begun to refine and not reached."""
        lost = self._assembly.losses()
        unrefined = np.flatnonzero(self._begun & ~self._reached).astype(np.int32)
        behind = np.setdiff1d(self._structure.numbering.of(unrefined), lost.missing)
        return Losses(lost.missing, np.union1d(lost.degraded, behind).astype(np.int32))

    @cached_property
    def _positions(self) -> Matrix:
        return self._base.positions.copy()

    @cached_property
    def _base(self) -> Standing:
        positions, whole = self._assembly.base()
        return Standing(positions, local_frames(positions, self._structure.faces), whole)


@dataclass(frozen=True, eq=False)
class Standing:
    """What the layer refines."""

    positions: Matrix
    frames: Matrix
    whole: Mask
