"""Streams that come to the bounds of V 5 to V 11 and of C 4.3, which no mesh of the world does."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from bsm.bitstream.connectivity.faces import RARE_HEADER, code_rare, encode_connectivity, make_models
from bsm.bitstream.container.packets import Packet, Refinement
from bsm.bitstream.container.wire import FrameType
from bsm.bitstream.container.writer import write_stream
from bsm.bitstream.entropy import range_coder as entropy
from bsm.bitstream.fields.corners import FieldEncoder
from bsm.bitstream.fields.grid import levels_field
from bsm.codec.geometry.mesh import TriangleMesh
from tools.gridded import gridded
from tools.surgery import header_frame, stream_of
from tools.vectors.bad import Bad
from tools.vectors.good import Good
from tools.vectors.good_fields import base
from tools.vectors.meshes import hub, patch, tangled, tent, together, torus, triangle

ASKED = 73786976294838435356
"""Bits behind the first: predictions that hit or miss, after which the chance of a hit is 699050 of 2^22, no more."""
MOST = (1 << 20) - 1
TILTED = "700302200031320344"
"""Which of its three values are the largest and not 0, of each vertex of a tent, so that V 9.3 comes beyond 2^26."""


def _asked() -> bytes:
    """Vertices without neighbours, each at the place of the one before or at another."""
    hits = [int(bit) for bit in f"{ASKED:b}"[1:]]
    values = np.random.default_rng(5).integers(0, 10, (len(hits) + 12, 3)).astype(np.int32)
    values[0] = 0
    for v, hit in enumerate(hits, 1):
        values[v, 0] = values[v - 1, 0] if hit else (values[v - 1, 0] + 1) % 10
    values[len(hits) + 1 :, 0] = values[len(hits), 0]
    faces = np.repeat(np.arange(len(values)), 3).reshape(-1, 3)
    return stream_of(gridded(encode_connectivity(faces, len(values)), values, [len(values)], grid=[9, 9, 9]))


def _noise(mesh: TriangleMesh, seed: int) -> bytes:
    """Any place on the largest grid for each vertex, its ends more often than others."""
    random, size = np.random.default_rng(seed), len(mesh.positions)
    any_ = random.integers(0, MOST + 1, (size, 3))
    values = np.where(random.random((size, 1)) < 0.6, random.choice([0, MOST], (size, 3)), any_).astype(np.int32)
    return stream_of(gridded(encode_connectivity(mesh.faces, size), values, [size], grid=[MOST, MOST, MOST]))


def _scales(mesh: TriangleMesh, seed: int) -> bytes:
    """From vertices that hardly differ to ones that have nothing in common."""
    random, size = np.random.default_rng(seed), len(mesh.positions)
    near = np.exp2(np.linspace(0, 20, size))[:, None] * random.normal(0, 0.3, (size, 3))
    values = np.clip(np.rint(near + MOST / 2), 0, MOST).astype(np.int32)
    return stream_of(gridded(encode_connectivity(mesh.faces, size), values, [size], grid=[MOST, MOST, MOST]))


def _levels(mesh: TriangleMesh, seed: int, growth: int) -> bytes:
    """Levels up to the largest: some multiple of what the first neighbour has, as long as there is room, or any."""
    made = base(mesh)
    faces, random, size = made.prepared.mesh.faces, np.random.default_rng(seed), len(mesh.positions)
    first = np.arange(size)
    for face in faces:
        first[face] = np.minimum(first[face], face.min())
    levels = random.integers(-(1 << 20), (1 << 20) + 1, (size, 3))
    if growth:
        for v in range(size):
            grown = growth * levels[first[v]]
            levels[v] = np.where(abs(grown) <= 1 << 20, grown, levels[v] >> 15) if first[v] < v else levels[v] >> 15
    levels = levels.astype(np.int32)
    data = FieldEncoder(levels_field(faces, size), levels).chunk(size)
    header = replace(made.draft.header, refinement=(2.0**-20, 3.0))
    packets: list[Packet] = [header, *made.draft.body, Refinement(0, size, data)]
    return write_stream(packets)


def _tilted() -> bytes:
    """Ends of the largest grid, whose last vertices are far from the planes of eight flaps, and were so before."""
    coded = encode_connectivity(together(*[tent(4)] * 8).faces, 8 * 18)
    ends = np.array([[int(d) >> 2 & 1, int(d) >> 1 & 1, int(d) & 1] for d in 8 * TILTED], np.int32)
    return stream_of(gridded(coded, MOST * ends, [len(ends)], grid=[MOST, MOST, MOST]))


def _grown(growth: int) -> bytes:
    """Triangles on their own, whose second levels are so many times the first."""
    mesh = together(*[triangle()] * 24)
    made = base(mesh)
    levels = np.tile([[300] * 3, [300 * growth] * 3, [150 * growth * (1 + growth)] * 3], (24, 1)).astype(np.int32)
    data = FieldEncoder(levels_field(made.prepared.mesh.faces, 72), levels).chunk(72)
    header = replace(made.draft.header, refinement=(2.0**-20, 3.0))
    return write_stream([header, *made.draft.body, Refinement(0, 72, data)])


def _counts(faces: int, degenerate: int, lonely: int, fans: int, dummies: int) -> bytes:
    """Faces that end behind their counts."""
    vertices = min(3 * faces, fans + lonely)
    regular = vertices - lonely
    coder, models = entropy.start_writing(64), make_models(vertices)
    for count in (degenerate, lonely, fans - regular, dummies):
        code_rare(coder, models, RARE_HEADER, count)
    payload = entropy.finish_writing(coder)
    header = header_frame(vertices=vertices, faces=faces, grid=[1, 1, 1])
    return stream_of([header, (FrameType.CONNECTIVITY, payload)])


BOUNDS: dict[str, Good] = {
    "good-grid-asks": Good("a question whose chance is the least that is asked (V 5.4)", _asked),
    "good-grid-bounds": Good("any values on the largest grid", lambda: _noise(together(torus(16, 12), hub()), 1)),
    "good-grid-bounds-tangled": Good(
        "any values on the largest grid, of a mesh with boundary and without order",
        lambda: _noise(together(patch(9, 8), tangled(), hub()), 2),
    ),
    "good-grid-scales": Good("differences of 1 to 2^20", lambda: _scales(together(torus(24, 16), hub()), 6)),
    "good-refined-bounds": Good(
        "any levels up to 2^20", lambda: _levels(together(torus(10, 8), hub(), patch(6, 5)), 3, 0)
    ),
    "good-refined-steep": Good(
        "levels that grow eightfold from neighbour to neighbour: weights at their bounds",
        lambda: _levels(torus(24, 16), 4, 8),
    ),
    "good-refined-steep-turned": Good(
        "levels that grow so and change their sign", lambda: _levels(torus(24, 16), 5, -8)
    ),
    "good-grid-tilted": Good("a vertex farther from a plane than terms may be (V 6.1)", _tilted),
    "good-refined-grown": Good("weights at their upper bound (V 6.2)", lambda: _grown(20)),
    "good-refined-grown-turned": Good("weights at their lower bound", lambda: _grown(-20)),
}
BOUNDS_BAD: dict[str, Bad] = {
    "bad-counts-lonely": Bad(
        "more vertices of degenerate faces alone than these have corners, and no face behind the counts",
        "corrupt",
        lambda: _counts(2000, 100, 301, 1000, 0),
    ),
    "bad-counts-fans": Bad(
        "more fans than corners, and no face behind the counts", "corrupt", lambda: _counts(2000, 0, 0, 6001, 0)
    ),
    "bad-counts-dummies": Bad(
        "more loops than corners, and no face behind the counts", "corrupt", lambda: _counts(2000, 0, 0, 1000, 6001)
    ),
}
