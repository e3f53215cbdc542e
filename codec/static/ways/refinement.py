"""The layer of refinement: its packets."""

from __future__ import annotations

from bsm.bitstream.container import packets
from bsm.bitstream.fields.corners import FieldEncoder
from bsm.bitstream.fields.grid import levels_field
from bsm.codec.arrays import Indices, Levels

CHUNK = 1 << 15  # vertices of a frame


def encode_layer(faces: Indices, levels: Levels) -> list[packets.Refinement]:
    encoder, size = FieldEncoder(levels_field(faces, len(levels)), levels), len(levels)
    chunks = [(start, min(CHUNK, size - start)) for start in range(0, size, CHUNK)]
    return [packets.Refinement(start, count, encoder.chunk(count)) for start, count in chunks]
