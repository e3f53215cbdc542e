"""Streams that come to the bounds of V 5 to V 11 and of C 4.3, which no mesh of the world does."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
import numpy.typing as npt

from bsm.bitstream.connectivity.faces import encode_connectivity
from bsm.bitstream.container.header import LAW
from bsm.bitstream.container.packets import Refinement
from bsm.bitstream.container.wire import MAGIC, VERSION, FrameType, write_frame, write_map, write_varint
from bsm.codec.blocks.overlap import derive_partition, grow_blocks
from bsm.codec.geometry.graph import graph_of_faces
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.signal.chain import Chain
from bsm.codec.static.coding import rules_of
from bsm.codec.static.encoder import encode
from bsm.codec.static.options import changed
from bsm.codec.static.ways.grid import levels_field
from tools.attack.streams import entangled, one_block
from tools.gridded import gridded
from tools.payloads import Speller, law
from tools.surgery import frames_of, header_frame, stream_of, with_header, write_stream
from tools.vectors.good import BASE, PAPER, Good
from tools.vectors.good_fields import base
from tools.vectors.meshes import patch, shuffled, tent, tetrahedron, together, torus, triangle

MOST = (1 << 20) - 1
TILTED = "700302200031320344"
"""Which of its three values are the largest and not 0, of each vertex of a tent, so that V 9.3 comes beyond 2^26."""


@dataclass(frozen=True)
class Bad:
    """A stream to be refused with an error of the class `error`; `make` is called only when vectors are written."""

    probes: str
    error: str
    make: Callable[[], bytes]


def _gridded(faces: npt.ArrayLike, values: npt.NDArray[Any], **header: Any) -> bytes:
    coded = encode_connectivity(np.asarray(faces, np.int32), len(values))
    return stream_of(gridded(coded, values.astype(np.int32), [len(values)], **header))


def _any(mesh: TriangleMesh, most: int) -> bytes:
    """Values that know nothing of each other."""
    return _gridded(mesh.faces, np.random.default_rng(1).integers(0, most, mesh.positions.shape))


def _knot(seed: int, vertices: int, count: int) -> bytes:
    """Faces of any three vertices: each has many fans."""
    random = np.random.default_rng(seed)
    faces = random.integers(0, vertices, (3 * count, 3))
    faces = faces[np.all(faces != np.roll(faces, 1, 1), axis=1)][:count]
    used, faces = np.unique(faces, return_inverse=True)
    return _gridded(faces.reshape(-1, 3), random.integers(0, 10, (len(used), 3)))


def _nested() -> bytes:
    """Triangles that are cut in three, the first of them more often: vertices of high valence side by side."""
    random, faces = np.random.default_rng(2), [[0, 1, 2], [0, 2, 1]]
    for v in range(3, 150):
        chosen = int(random.integers(len(faces))) if random.random() < 0.5 else int(np.argmin([sum(f) for f in faces]))
        a, b, c = faces.pop(chosen)
        faces += [[a, b, v], [b, c, v], [c, a, v]]
    return _gridded(faces, random.integers(0, 10, (150, 3)))


def _tetrahedra() -> bytes:
    """Their last vertices are near where the other three say."""
    random = np.random.default_rng(1)
    values = random.integers(0, 30, (48, 3))
    values[3::4] = values[0::4] + values[1::4] - values[2::4] + random.integers(0, 3, (12, 3))
    return _gridded(together(*[tetrahedron()] * 12).faces, abs(values))


def _header(**values: Any) -> bytes:
    """A header, and nothing behind it."""
    return MAGIC + bytes([VERSION]) + write_frame(*header_frame(**values))


def _tilted() -> bytes:
    """Ends of the largest grid, whose last vertices are far from the planes of eight flaps, and were so before."""
    ends = np.array([[int(d) >> 2 & 1, int(d) >> 1 & 1, int(d) & 1] for d in 8 * TILTED], np.int32)
    return _gridded(together(*[tent(4)] * 8).faces, MOST * ends, grid=[MOST, MOST, MOST])


def _grown(growth: int) -> bytes:
    """Return separate triangles whose second levels are a multiple of the first."""
    made = base(together(*[triangle()] * 24))
    levels = np.tile([[300] * 3, [300 * growth] * 3, [150 * growth * (1 + growth)] * 3], (24, 1)).astype(np.int32)
    data = levels_field(made.prepared.mesh.faces, levels).write(72)[0]
    header = replace(made.draft.header, refinement=(2.0**-20, 3.0))
    return write_stream([header, *made.draft.body, Refinement(0, 72, data)])


def _ordered_twice() -> bytes:
    frames = frames_of(encode(shuffled(patch(5, 5)), changed(BASE, keep_order=True)))
    place = next(i for i, (kind, _) in enumerate(frames) if kind == FrameType.ORDER)
    return stream_of([*frames[: place + 1], *frames[place:]])


def _given(copies: int, loose: int) -> bytes:
    """Return an ORDER of 25 vertices that claims copies and loose vertices."""
    frames = frames_of(encode(shuffled(patch(5, 5)), changed(BASE, keep_order=True)))
    claimed = write_varint(copies) + write_varint(loose)
    return stream_of([(k, claimed + p[2:] if k == FrameType.ORDER else p) for k, p in frames])


def _padded() -> bytes:
    """Zeros behind the faces, as many as are taken."""
    frames = frames_of(_any(triangle(), 3))
    return stream_of([frames[0], (FrameType.CONNECTIVITY, frames[1][1] + bytes(3)), *frames[2:]])


def _metadata() -> bytes:
    header, *others = frames_of(_any(triangle(), 3))
    return stream_of([header, (FrameType.METADATA, write_map([(f"{i:02x}", i) for i in range(256)])), *others])


def _counts(faces: int, degenerate: int, lonely: int, fans: int, dummies: int) -> bytes:
    """Faces that end behind their counts."""
    vertices = min(3 * faces, fans + lonely)
    counts = (degenerate, lonely, fans + lonely - vertices, dummies)
    speller, rare = Speller(outcome for count in counts for outcome in _outcomes(count)), law.Model(inputs=1)
    assert [law.read_unsigned(speller, rare, (0,), 2, law.COUNTS) for _ in counts] == [*counts]
    header = header_frame(vertices=vertices, faces=faces, grid=[1, 1, 1])
    return stream_of([header, (FrameType.CONNECTIVITY, speller.payload_of_all())])


def _outcomes(count: int) -> list[int]:
    """The decisions of an unsigned integer of unary length 2 (C 3.1)."""
    if count < 2:
        return [1] * count + [0]
    rest, size = count - 1, (count - 1).bit_length() - 1
    low = rest & (1 << max(size - 1, 0)) - 1
    below = [low >> 16, low & 65535] if size > 17 else [low] * (size > 1)
    return [1, 1, *[1] * size, *[0] * (size < 23), *[rest >> size - 1 & 1] * (size > 0), *below]


def _expected(first: int) -> bytes:
    """One block, whose first x is this, zeros far behind it: 20 makes y's expected magnitude the least of a context."""
    header, faces, (kind, block) = frames_of(encode(torus(10, 8), changed(BASE, block_size=80)))
    levels, state = np.zeros((60, 3)), 0
    levels[0], levels[40:55:3] = (first, 9, -5), (1, -2, 0)
    for place, level in enumerate(levels.ravel().astype(int).tolist()):  # M 9.11
        levels.flat[place] -= 0.5 * (state & 1) * np.sign(level)
        state = state << 1 & 7 | (state ^ state >> 1 ^ state >> 2 ^ level) & 1
    graph = graph_of_faces(torus(10, 8).faces, 80)
    chain = Chain(rules_of(LAW), grow_blocks(graph, derive_partition(graph, 1), 80), 60)
    prediction = chain.begin(0)[1]
    chain.dictionary(60)
    data = chain.write(prediction, levels, 1.0, True)[1]
    return with_header(stream_of([header, faces, (kind, block[:1] + bytes([60]) + data)]), coefficients=60)


BLOCKS = {"vertices": 1 << 24, "faces": 1 << 25, "blocks": 1 << 12, "block_size": 8192, "coefficients": 4096}
GRID = {"vertices": 3, "faces": 1}
LEGAL: dict[str, dict[str, Any]] = {
    "limits": BLOCKS,
    "blocks": BLOCKS | {"blocks": 1 << 17, "block_size": 2048, "coefficients": 2048},
    "parts": {"vertices": 4, "faces": 4, "blocks": 4, "block_size": 4, "coefficients": 4},
    "step": BLOCKS | {"step": 2.0**-40},
    "refinement": BLOCKS | {"refinement": [2.0**-40, 1 / 16]},
    "refinement-largest": BLOCKS | {"refinement": [1.0, 64.0]},
    "one": {"vertices": 4, "faces": 4, "blocks": 1, "block_size": 4, "coefficients": 4},
    "rows": {"vertices": 4096, "faces": 4096, "blocks": 64, "block_size": 2048, "coefficients": 1},
    "lattice": GRID | {"grid": [5, 5, 5], "lattice": [5, 5]},
    "scale": GRID | {"grid": [1, 1, 1], "scale": 1e-300},
    "corner": GRID | {"grid": [(1 << 20) - 1] * 3, "corner": [-(2**31), 2**31 - 1, 0]},
    "center": GRID | {"grid": [1, 1, 1], "center": [1e300, -1e300, 0.0], "scale": 1e300},
}
ILLEGAL: dict[str, tuple[str, dict[str, Any]]] = {
    "vertices": ("limit", GRID | {"vertices": (1 << 24) + 1, "faces": 1 << 25, "grid": [1, 1, 1]}),
    "faces": ("limit", GRID | {"faces": (1 << 25) + 1, "grid": [1, 1, 1]}),
    "count-limit": ("limit", GRID | {"faces": 2**31 - 1, "grid": [1, 1, 1]}),
    "count": ("corrupt", GRID | {"faces": 2**31, "grid": [1, 1, 1]}),
    "blocks": ("limit", BLOCKS | {"blocks": (1 << 17) + 1, "block_size": 2047, "coefficients": 2047}),
    "block-size": ("limit", BLOCKS | {"block_size": 8193}),
    "coefficients": ("limit", BLOCKS | {"coefficients": 4097}),
    "grid": ("corrupt", GRID | {"grid": [1 << 20, 1, 1]}),
    "corner-low": ("corrupt", GRID | {"grid": [1, 1, 1], "corner": [-(2**31) - 1, 0, 0]}),
    "corner-high": ("corrupt", GRID | {"grid": [1, 1, 1], "corner": [0, 2**31, 0]}),
    "center": ("corrupt", GRID | {"grid": [1, 1, 1], "center": [1.01e300, 0.0, 0.0]}),
    "center-long": ("corrupt", GRID | {"grid": [1, 1, 1], "center": [1.0] * 4}),
    "center-low": ("corrupt", GRID | {"grid": [1, 1, 1], "center": [-1.01e300, 0.0, 0.0]}),
    "scale": ("corrupt", GRID | {"grid": [1, 1, 1], "scale": 1.01e300}),
    "step": ("corrupt", BLOCKS | {"step": 2.0**20 + 1}),
    "refinement": ("corrupt", BLOCKS | {"refinement": [2.0**-41, 1 / 16]}),
    "refinement-ratio": ("corrupt", BLOCKS | {"refinement": [2.0**-40, 1 / 17]}),
}
BOUNDS: dict[str, Good] = {
    "good-grid-tilted": Good("a vertex farther from a plane than terms may be (V 6.1)", _tilted),
    "good-grid-knot": Good("any faces of 24 vertices (C 7)", lambda: _knot(8, 24, 90)),
    "good-grid-knot-small": Good("any faces of 10 vertices", lambda: _knot(1, 10, 60)),
    "good-grid-knot-first": Good("a neighbor that is fan 0 (C 7.4)", lambda: _knot(3, 5, 6)),
    "good-expected": Good("zeros behind the first 32 rows of a first block (M 9.1, M 9.4)", lambda: _expected(20)),
    "good-expected-most": Good("a level of 23 bits, which are the most (M 9.6)", lambda: _expected((1 << 23) - 1)),
    "good-grid-nested": Good("high valences side by side (C 5.4)", _nested),
    "good-grid-tetrahedra": Good("flaps beside the vertex in question (V 8.3)", _tetrahedra),
    "good-grid-noise": Good("contexts that are met more than 400 times (V 4.5)", lambda: _any(torus(40, 40), 40)),
    "good-grid-sparse": Good(
        "values at the ends of where they are looked for (V 8.7)", lambda: _any(torus(22, 22), 112_000)
    ),
    "good-faces-padded": Good("zeros behind the faces, all of which are taken (C 1.5)", _padded),
    "good-metadata-most": Good("256 entries, as many as may be", _metadata),
    "good-refined-grown": Good("weights at their upper bound (V 6.2)", lambda: _grown(20)),
    "good-refined-grown-turned": Good("weights at their lower bound", lambda: _grown(-20)),
}
BOUNDS_BAD: dict[str, Bad] = {
    "bad-counts-most": Bad(
        "more fans and loops than vertices may be", "limit", lambda: _counts(1 << 24, 0, 0, 9, 1 << 24)
    ),
    "bad-order-copies": Bad(
        "more given vertices than may be, copies (F 9.1)", "limit", lambda: _given((1 << 24) - 24, 0)
    ),
    "bad-order-loose": Bad("more of them than may be, loose ones", "limit", lambda: _given(0, (1 << 24) - 24)),
    "bad-order-loose-most": Bad("2^24 given vertices, one too many", "corrupt", lambda: _given(0, (1 << 24) - 25)),
    "bad-limit-repeats": Bad(
        "columns that are made orthonormal one by one, again and again (M 14.3)",
        "limit",
        lambda: one_block(22, 22, 484, power=4, shift=2.0**-30),
    ),
    "bad-limit-entangled": Bad(
        "a block whose factorization costs too much (M 14.4)", "limit", lambda: entangled(700, 900)
    ),
    "bad-onorm-adaptive": Bad(
        "Onorm after several solutions, without packed coefficients (F 10.2)",
        "corrupt",
        lambda: with_header(encode(torus(12, 10), BASE), onorm=2),
    ),
    "bad-onorm-more": Bad(
        "65 solutions before Onorm",
        "corrupt",
        lambda: with_header(encode(torus(12, 10), changed(BASE, **PAPER, power=2)), onorm=65),
    ),
    "bad-onorm-zero": Bad(
        "an Onorm that is stored although it is the default",
        "corrupt",
        lambda: with_header(encode(torus(12, 10), changed(BASE, **PAPER, power=2)), onorm=0),
    ),
    "bad-onorm-method": Bad(
        "an Onorm that is not a whole number",
        "corrupt",
        lambda: with_header(encode(torus(12, 10), changed(BASE, **PAPER, power=2)), onorm=2.0),
    ),
    "bad-order-twice": Bad("ORDER, and ORDER again", "corrupt", _ordered_twice),
    "unsupported-version-alone": Bad("a later version, in five bytes", "unsupported", lambda: MAGIC + b"\x20"),
    **{
        f"bad-header-{name}": Bad(
            "a header that is legal to the last bit, alone", "truncated", partial(_header, **values)
        )
        for name, values in LEGAL.items()
    },
    **{
        f"bad-header-{name}-more": Bad("one more than is legal", error, partial(_header, **values))
        for name, (error, values) in ILLEGAL.items()
    },
}
