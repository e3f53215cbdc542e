"""Streams with positions on a grid, with a layer of refinement, and with given vertices that were made one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from bsm.bitstream.connectivity.faces import encode_connectivity
from bsm.bitstream.container.header import Header, Layer
from bsm.bitstream.container.packets import Grid, Packet, Refinement
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.static.choice.blocks import InBlocks, RefinementBase
from bsm.codec.static.encoder import Encoder, encode
from bsm.codec.static.options import EncodeOptions
from bsm.codec.static.ways.grid import grid_field, levels_field
from tools.gridded import gridded, latticed
from tools.surgery import scan, stream_of, with_header, write_stream
from tools.vectors.good import BASE, Good
from tools.vectors.meshes import hub, patch, shuffled, tangled, tent, tetrahedron, together, torus, triangle


def soup(mesh: TriangleMesh) -> TriangleMesh:
    """Every face with vertices of its own, and one vertex in no face."""
    corners = mesh.positions[mesh.faces].reshape(-1, 3)
    numbers = np.arange(len(corners)).reshape(-1, 3)
    split = np.where(numbers < 30, numbers, numbers + 1)
    return TriangleMesh(np.insert(corners, 30, [7.5, -1.25, 0.1], axis=0), split)


def seamed() -> TriangleMesh:
    """Two given vertices at each position of one side, in disorder."""
    mesh = shuffled(torus(9, 8))
    faces, extra = mesh.faces.copy(), np.flatnonzero(mesh.positions[:, 0] > 0)
    copies = np.full(len(mesh.positions), -1)
    copies[extra] = len(mesh.positions) + np.arange(len(extra))[::-1]
    turned = copies[faces[::2]]
    faces[::2] = np.where(turned >= 0, turned, faces[::2])
    return TriangleMesh(np.concatenate([mesh.positions, mesh.positions[extra[::-1]]]), faces)


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
    levels, first = made.wanted(made.expected_steps(layer))[0], 0
    coder = levels_field(made.prepared.mesh.faces, levels)
    for count in counts:
        packets.append(Refinement(first, count, coder.write(count)[0]))
        first += count
    return write_stream(packets)


def _small() -> TriangleMesh:
    return torus(12, 10)


def _lattice() -> TriangleMesh:
    """Every coordinate a whole multiple of a seventh of the extent."""
    mesh = torus(10, 8)
    low, extent = mesh.positions.min(axis=0), np.ptp(mesh.positions, axis=0).max()
    places = np.rint((mesh.positions - low) / extent * 7)
    places[0], places[1] = 0, 7
    return TriangleMesh(places / 7.0 + np.array([0.0, 0.0, -1e-3]) * np.arange(len(places))[:, None], mesh.faces)


def exact_lattice() -> bytes:
    mesh = _lattice()
    mesh = TriangleMesh(np.rint(mesh.positions * 7 + 1e-6) * 0.5, mesh.faces)
    return latticed(encode(mesh, EncodeOptions(grid=10)), 1023, 8)


def header_of(stream: bytes) -> Header:
    """The header of a stream."""
    header, _ = next(scan(stream))
    assert isinstance(header, Header)
    return header


LAYER = Layer(2.0**-9, 3.0)


def _large() -> bytes:
    """A regular mesh of 17,161 vertices, all at one place, and one of no order behind it."""
    mesh = together(torus(131, 131), tangled())
    coded = encode_connectivity(mesh.faces, len(mesh.positions))
    return stream_of(
        gridded(coded, np.zeros((len(mesh.positions), 3), np.int32), [len(mesh.positions)], grid=[0, 0, 0])
    )


FIELDS: dict[str, Good] = {
    "good-grid": Good("positions on a grid of 11 bits", lambda: encode(_small(), EncodeOptions(grid=11))),
    "good-grid-tetrahedron": Good("four vertices on a grid of one bit", lambda: encode(tetrahedron())),
    "good-grid-fine": Good("a grid of 20 bits", lambda: encode(_small(), EncodeOptions(grid=20))),
    "good-grid-lattice": Good("a lattice under a grid", exact_lattice),
    "good-grid-corner": Good(
        "a grid that begins at given cells",
        lambda: with_header(on_grid(_small(), counts=(120,)), center=None, corner=[1, -70000, 0]),
    ),
    "good-grid-corner-lattice": Good(
        "a lattice under a grid that begins at given cells",
        lambda: with_header(exact_lattice(), center=None, corner=[-1, 2, 300]),
    ),
    "good-grid-chunks": Good("a grid in chunks", lambda: on_grid(_small(), counts=(1, 70, 49))),
    "good-grid-tangled": Good(
        "non-manifold, repeated, turned and degenerate faces on a grid",
        lambda: encode(tangled(), EncodeOptions(grid=9)),
    ),
    "good-grid-hub": Good("a vertex with very many neighbors on a grid", lambda: encode(hub(), EncodeOptions(grid=9))),
    "good-grid-tent": Good(
        "more neighbors and flaps than are looked at, known when their vertex comes",
        lambda: encode(tent(), EncodeOptions(grid=9)),
    ),
    "good-grid-components": Good(
        "many components on a grid, as the encoder chooses it",
        lambda: encode(together(*(torus(5, 4) for _ in range(6)), patch(4, 4), triangle())),
    ),
    "good-grid-ordered": Good(
        "ORDER on a grid", lambda: encode(shuffled(_small()), EncodeOptions(grid=8, keep_order=True))
    ),
    "good-splits": Good(
        "ORDER with copies: faces with vertices of their own, and one in no face",
        lambda: encode(soup(torus(7, 6)), EncodeOptions(grid=8, keep_order=True)),
    ),
    "good-splits-seams": Good(
        "ORDER with copies: a seam, in blocks", lambda: encode(seamed(), replace(BASE, keep_order=True))
    ),
    "good-refined": Good("a layer of refinement", lambda: refined(_small(), LAYER, (120,))),
    "good-layer-chunks": Good("a layer in chunks", lambda: refined(_small(), LAYER, (50, 70))),
    "good-layer-early": Good("a layer that ends early", lambda: refined(_small(), LAYER, (40, 30))),
    "good-layer-none": Good("a layer of which nothing comes", lambda: refined(_small(), LAYER, ())),
    "good-layer-coarse": Good(
        "a layer at its bounds: the widest step and the least ratio",
        lambda: refined(_small(), Layer(1.0, 1 / 16), (120,)),
    ),
    "good-refined-tangled": Good(
        "refinement where faces have no area", lambda: refined(tangled(), LAYER, (len(tangled().positions),))
    ),
    "good-refined-deep": Good(
        "levels of many bits, of a vertex with many neighbors",
        lambda: refined(hub(), Layer(2.0**-20, 3.0), (len(hub().positions),)),
    ),
    "good-refined-large": Good(
        "refinement of more vertices than are looked back on", lambda: refined(torus(30, 24), LAYER, (720,))
    ),
    "good-grid-large": Good("more faces than counts and hashes have room for", _large),
    "good-refined-boundary": Good("refinement of a disc", lambda: refined(patch(12, 9), LAYER, (108,))),
    "good-refined-flat": Good(
        "a surface that looks away from the pole of frames",
        lambda: refined(
            TriangleMesh(patch(9, 8).positions * (1, 1, 0) @ _looking_away(), patch(9, 8).faces), LAYER, (72,)
        ),
    ),
}


def _looking_away() -> np.ndarray:
    """Turns the z axis opposite to the pole."""
    pole = np.array([0.48, 0.6, 0.64])
    first = np.cross(pole, [1.0, 0.0, 0.0])
    first /= np.linalg.norm(first)
    return np.array([first, np.cross(-pole, first), -pole])
