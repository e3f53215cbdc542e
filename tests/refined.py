"""Streams with positions on a grid, with a layer of refinement, and with given vertices that were made one."""

from dataclasses import replace

import numpy as np

from bsm import EncodeOptions, Encoder, TriangleMesh
from bsm.bitstream.container.header import Header, Layer
from bsm.bitstream.container.packets import Grid, Packet, Refinement
from bsm.codec.static.ways.grid import grid_field, levels_field
from bsm.codec.static.ways.in_blocks import InBlocks, RefinementBase
from tests.streams import write_stream
from tools.surgery import scan

BASE = EncodeOptions(block_size=30, keep=0.3, step=1 / 256, smoothing=0.0, threads=1)


def soup(mesh: TriangleMesh) -> TriangleMesh:
    """Every face with vertices of its own, and one vertex in no face."""
    corners = mesh.positions[mesh.faces].reshape(-1, 3)
    numbers = np.arange(len(corners)).reshape(-1, 3)
    split = np.where(numbers < 30, numbers, numbers + 1)
    return TriangleMesh(np.insert(corners, 30, [7.5, -1.25, 0.1], axis=0), split)


def on_grid(mesh: TriangleMesh, *, counts: tuple[int, ...], cells: int = 255) -> bytes:
    """Return positions on a grid, in chunks of this many vertices."""
    draft = Encoder(mesh, EncodeOptions(grid=8)).draft()
    header = draft.header
    places = np.rint((draft.decoded - np.array(header.center)) / header.scale).astype(np.int32)
    connectivity = draft.body[0]
    prepared = Encoder(mesh, EncodeOptions(grid=8))
    coder = grid_field(prepared.mesh.faces, (cells, cells, cells), places)
    packets: list[Packet] = [replace(header, grid=(cells, cells, cells)), connectivity]
    first = 0
    for count in counts:
        packets.append(Grid(first, count, coder.write(count)[0]))
        first += count
    return write_stream(packets)


def base(mesh: TriangleMesh) -> RefinementBase:
    """Blocks to be refined."""
    encoder = Encoder(mesh, BASE)
    return InBlocks(encoder._input.prepared, BASE).base(BASE.first_step)


def refined(mesh: TriangleMesh, layer: Layer, counts: tuple[int, ...]) -> bytes:
    """Blocks with a layer of the nearest levels, in chunks of this many vertices; it may end early."""
    made = base(mesh)
    header = replace(made.draft.header, refinement=(layer.step, layer.ratio))
    packets: list[Packet] = [header, *made.draft.body]
    levels, first = made.best_levels(made.expected_steps(layer))[0], 0
    coder = levels_field(made.prepared.mesh.faces, levels)
    for count in counts:
        packets.append(Refinement(first, count, coder.write(count)[0]))
        first += count
    return write_stream(packets)


def header_of(stream: bytes) -> Header:
    """The header of a stream."""
    header, _ = next(scan(stream))
    assert isinstance(header, Header)
    return header


LAYER = Layer(2.0**-9, 3.0)
