"""Streams with blocks of cells: every kind of graph that cells can have, and every field out of its range."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from bsm.bitstream.container.header import Layer
from bsm.bitstream.container.packets import Packet, Refinement
from bsm.bitstream.container.wire import FrameType
from bsm.codec.arrays import Faces, Levels
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.static.options import EncodeOptions
from bsm.codec.static.preamble_encoding import Draft, Parts, join, prepare
from bsm.codec.static.ways.grid import levels_field
from bsm.codec.static.ways.in_blocks import refine_blocks
from bsm.codec.static.ways.in_cells import InCells, Spread
from tools.surgery import Frames, frames_of, stream_of, with_header
from tools.vectors.good import Bad, Good
from tools.vectors.meshes import (
    grid_faces,
    hub,
    patch,
    shuffled,
    tangled,
    tent,
    tetrahedron,
    together,
    torus,
    triangle,
)

USUAL = Spread()


class _InSmallBlocks(InCells):
    """As the encoder codes cells, but in blocks of a few."""

    parts = Parts(24, 1.3)


def draft(
    mesh: TriangleMesh,
    spread: Spread = USUAL,
    step: float = 0.004,
    *,
    ratio: float = 10.0,
    order: bool = False,
    **options: Any,
) -> tuple[Draft, Faces, Levels]:
    """A mesh in blocks of cells, with levels at a step; its faces as they are coded; and the levels of vertices."""
    prepared = prepare(join(mesh, keep=order), Parts(256, 1.0), keep_order=order)
    chosen = EncodeOptions(threads=1, **({"key_interval": 0} | options))
    in_cells = _InSmallBlocks(prepared, chosen, 0.5, *spread.smoothing)
    base = in_cells.base(in_cells.settled(next(in_cells.leveled(spread, step))))
    layer = Layer(step, ratio)
    levels, _ = base.best_levels(base.expected_steps(layer))
    known = base.known_steps(layer, levels)
    levels[:, 1:] = np.rint(base.offsets[:, 1:] / known[:, 1:])
    moved = base.moved(layer, levels, known)
    return (
        refine_blocks(base.prepared, base.draft, layer, levels, moved),
        prepared.mesh.faces,
        levels,
    )


def based(*given: Any, **options: Any) -> bytes:
    return b"".join(draft(*given, **options)[0].frames)


def _frames(*given: Any, **options: Any) -> Frames:
    return frames_of(based(*given, **options))


def _chunks(size: int) -> bytes:
    """Levels of vertices in frames of a size."""
    made, faces, levels = draft(torus(24, 16))
    cells, field = made.header.base[0], levels_field(faces, levels)

    def packets() -> Iterator[Packet]:
        yield from (
            packet
            for packet in made.body
            if not (isinstance(packet, Refinement) and packet.first >= cells)
        )
        for start in range(0, len(levels), size):
            count = min(size, len(levels) - start)
            yield Refinement(cells + start, count, *field.write(count))

    return b"".join(replace(made, body=tuple(packets())).frames)


def _without(kind: FrameType, which: slice) -> bytes:
    """Without some frames of a type."""
    frames = _frames(torus(24, 16))
    gone = [frame for frame in frames if frame[0] == kind][which]
    return stream_of([frame for frame in frames if frame not in gone])


def _refinement(change: Callable[[int, int, int], tuple[int, int]], which: int = 0) -> bytes:
    """With another first number and count in a frame of levels, by those that it has and the cells."""
    made, _, _ = draft(torus(24, 16))
    body, cells = list(made.body), made.header.base[0]
    place = [i for i, packet in enumerate(body) if isinstance(packet, Refinement)][which]
    packet = body[place]
    assert isinstance(packet, Refinement)
    first, count = change(packet.first, packet.count, cells)
    body[place] = Refinement(first, count, packet.data)
    return stream_of(frames_of(b"".join(replace(made, body=tuple(body)).frames)))


def _header(**changes: Any) -> bytes:
    return with_header(based(torus(24, 16)), **changes)


def _with_base(*changes: tuple[int, int]) -> bytes:
    """Other entries of the field, by their places."""
    stream = based(torus(24, 16))
    base = list(draft(torus(24, 16))[0].header.base)
    for place, value in changes:
        base[place] = value
    return with_header(stream, base=base)


def strip(size: int) -> TriangleMesh:
    """A strip of triangles, whose cells follow each other and have no faces."""
    k = np.arange(size)
    faces = np.stack([k[:-2], k[1:-1], k[2:]], -1).astype(np.int32)
    return TriangleMesh(
        np.stack([0.1 * (k // 2), 0.05 * (k % 2), 0.1 * np.sin(0.3 * k)], -1), faces
    )


def loose(count: int) -> TriangleMesh:
    """Triangles, each on its own."""
    return together(*[triangle()] * count)


def pages(count: int) -> TriangleMesh:
    """Sheets that share an edge of many vertices."""
    sheet, rows, columns = patch(9, 8), 9, 8
    turns = 2.0 * np.pi * np.arange(count) / count
    places, faces = [sheet.positions[:columns]], []
    for number, turn in enumerate(turns):
        x, y, z = sheet.positions[columns:].T
        places.append(
            np.stack(
                [x * np.cos(turn) - z * np.sin(turn), y, x * np.sin(turn) + z * np.cos(turn)], -1
            )
        )
        of_sheet = grid_faces(rows, columns)
        faces.append(
            np.where(of_sheet < columns, of_sheet, of_sheet + number * (rows - 1) * columns)
        )
    return TriangleMesh(np.concatenate(places), np.concatenate(faces))


def bowtie() -> TriangleMesh:
    """Two closed surfaces that share a vertex."""
    mesh = together(torus(16, 10), torus(14, 12))
    faces = np.where(mesh.faces == 160, 0, mesh.faces)
    return TriangleMesh(mesh.positions, faces)


def cylinder(sides: int) -> TriangleMesh:
    """Long faces between two rings, and fans that close them: two cells."""
    angle, k = np.linspace(0, 2 * np.pi, sides, endpoint=False), np.arange(sides)
    ring = np.stack([np.cos(angle), np.sin(angle), 0 * angle], -1)
    ends = np.array([[0, 0, 0], [0, 0, 3.0]])
    after = (k + 1) % sides
    sides_of = [[k, after, sides + after], [k, sides + after, sides + k]]
    fans = [
        [np.full(sides, 2 * sides), after, k],
        [np.full(sides, 2 * sides + 1), sides + k, sides + after],
    ]
    faces = np.concatenate([np.stack(rows, -1) for rows in [*sides_of, *fans]])
    return TriangleMesh(np.concatenate([ring, ring + np.array([0, 0, 3.0]), ends]), faces)


def flipped() -> TriangleMesh:
    """Every third face turned over, and some twice, once from each side."""
    mesh = torus(20, 14)
    faces = mesh.faces.copy()
    faces[::3] = faces[::3, ::-1]
    return TriangleMesh(mesh.positions, np.concatenate([faces, faces[::5, ::-1]]))


def needles() -> TriangleMesh:
    mesh = patch(24, 14)
    return TriangleMesh(mesh.positions * [1.0, 200.0, 1.0], mesh.faces)


BASES: dict[str, Good] = {
    f"good-base-{name}": Good(f"blocks of cells: {probes}", make)
    for name, probes, make in (
        ("plain", "a closed surface", lambda: based(torus(30, 24))),
        ("border", "a surface with a border", lambda: based(patch(24, 20))),
        ("one", "one cell, without neighbors and faces", lambda: based(hub())),
        ("two", "two cells", lambda: based(cylinder(30))),
        ("strip", "no face of cells", lambda: based(strip(90))),
        ("narrow", "few faces of cells", lambda: based(patch(70, 4))),
        ("loose", "faces each on its own", lambda: based(loose(30))),
        (
            "parts",
            "cells without neighbors",
            lambda: based(together(*[tetrahedron()] * 12, torus(12, 10))),
        ),
        (
            "tangled",
            "edges of three faces, repeated and degenerate faces",
            lambda: based(tangled()),
        ),
        ("tent", "vertices of many neighbors", lambda: based(tent())),
        ("pages", "sheets at one edge", lambda: based(pages(5))),
        ("bowtie", "two surfaces at one vertex", lambda: based(bowtie())),
        ("flipped", "faces turned over, and from both sides", lambda: based(flipped())),
        ("needles", "long thin faces", lambda: based(needles())),
        (
            "point",
            "all at one place",
            lambda: based(TriangleMesh(torus(12, 10).positions * 0.0, torus(12, 10).faces)),
        ),
        ("order", "in the order given", lambda: based(shuffled(torus(16, 12)), order=True)),
        ("reach-1", "the least reach", lambda: based(torus(20, 14), Spread(1, 3))),
        ("reach-3", "a wider reach", lambda: based(torus(24, 20), Spread(3, 14))),
        ("reach-8", "the widest reach", lambda: based(torus(24, 20), Spread(8, 20))),
        ("rounds-1", "one round of smoothing", lambda: based(torus(16, 12), Spread(2, 1))),
        ("rounds-64", "as many as there may be", lambda: based(torus(16, 12), Spread(2, 64))),
        ("coarse", "levels of cells at the widest step", lambda: based(torus(16, 12), USUAL, 0.06)),
        ("fine", "levels at fine steps", lambda: based(torus(16, 12), USUAL, 2.0**-20)),
        ("ratio", "steps aside below those along normals", lambda: based(torus(16, 12), ratio=0.5)),
        ("chains", "chains of two blocks", lambda: based(torus(24, 20), key_interval=2)),
        ("keys", "chains of one block", lambda: based(torus(24, 20), key_interval=1)),
        ("smooth", "smoothing of cells", lambda: based(torus(24, 20), smoothing=3.0)),
        ("chunks", "levels in several frames", lambda: _chunks(101)),
        ("blocks", "no levels", lambda: _without(FrameType.REFINEMENT, slice(None))),
        ("cells", "levels of cells alone", lambda: _without(FrameType.REFINEMENT, slice(1, None))),
        ("early", "levels that end early", lambda: stream_of(frames_of(_chunks(101))[:-1])),
    )
}
BASES_BAD: dict[str, Bad] = {
    f"bad-base-{name}": Bad(probes, "corrupt", make)
    for name, probes, make in (
        ("more", "more cells than there are", lambda: _with_base((0, 49))),
        ("fewer", "fewer cells than there are", lambda: _with_base((0, 40))),
        ("most", "more cells than vertices", lambda: _with_base((0, 385))),
        ("none", "no cells", lambda: _with_base((0, 0))),
        ("reach-0", "no reach", lambda: _with_base((1, 0))),
        ("reach-9", "too wide a reach", lambda: _with_base((1, 9))),
        ("rounds-0", "no rounds", lambda: _with_base((2, 0))),
        ("rounds-65", "too many rounds", lambda: _with_base((2, 65))),
        ("halvings-0", "too wide a step", lambda: _with_base((3, 0))),
        ("halvings-41", "too fine a step", lambda: _with_base((3, 41))),
        ("short", "three numbers", lambda: _header(base=[60, 2, 8])),
        ("long", "five numbers", lambda: _header(base=[60, 2, 8, 6, 1])),
        ("floats", "floats", lambda: _header(base=[60.0, 2.0, 8.0, 6.0])),
        ("unrefined", "no refinement", lambda: _header(refinement=None)),
        (
            "paper",
            "constants of the paper",
            lambda: _header(paper=[0.0, 0.0, 0.0, 4.0, 1.0, 2.0, 2.0**-7, 1.0]),
        ),
        ("sequence", "a sequence", lambda: _header(sequence=[1, 1])),
        ("grid", "a grid", lambda: _header(grid=[9, 9, 9])),
        ("blocks", "more blocks than cells", lambda: _header(blocks=100)),
        ("block-size", "blocks of more than all cells", lambda: _header(block_size=200)),
        ("partition", "a PARTITION", lambda: _partitioned()),
        (
            "both",
            "a frame of cells and vertices",
            lambda: _refinement(lambda first, count, cells: (first, cells + 1)),
        ),
        (
            "gap",
            "levels of cells that end early",
            lambda: _refinement(lambda first, count, cells: (first, cells - 1)),
        ),
        (
            "late",
            "vertices without levels of cells",
            lambda: _without(FrameType.REFINEMENT, slice(1)),
        ),
        (
            "beyond",
            "levels beyond the last vertex",
            lambda: _refinement(lambda first, count, cells: (first, count + 1), 1),
        ),
    )
}


def _partitioned() -> bytes:
    frames = _frames(torus(24, 16))
    place = [kind for kind, _ in frames].index(FrameType.CONNECTIVITY) + 1
    return stream_of([*frames[:place], (FrameType.PARTITION, b"\0" * 8), *frames[place:]])


BASES_BAD["bad-base-missing"] = Bad(
    "a BLOCK that is missing", "corrupt", lambda: _without(FrameType.BLOCK, slice(1, 2))
)
