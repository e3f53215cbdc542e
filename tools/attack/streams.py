"""The bombs: sound in every checksum, and as expensive as the format lets a few bytes be."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import numpy.typing as npt

from bsm._core import Cut, GivenMesh
from bsm.bitstream.coefficients.packed import pack_coefficients
from bsm.bitstream.connectivity.faces import (
    AS_CORNERS,
    ON_EDGES,
    EncodedConnectivity,
    encode_connectivity,
)
from bsm.bitstream.container import packets
from bsm.bitstream.container.gop import METHODS, RUNS, GopBody, GopField, GopMethod, write_gop_body
from bsm.bitstream.container.header import (
    AS_CODED,
    FACE,
    HEADER_FIELDS,
    OCTAHEDRAL,
    OTHERWISE,
    RECOMPUTED,
    Declaration,
)
from bsm.bitstream.container.packets import WRITERS
from bsm.bitstream.container.wire import FrameType, write_frame, write_map, write_varint
from bsm.codec.blocks.overlap import partition_of_labels
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.graph import graph_of_faces
from bsm.codec.static.attributes.encoding import Surface, carry, field_of, write_values
from bsm.codec.static.attributes.quality import Quality
from bsm.codec.static.ways.grid import levels_field
from bsm.codec.static.ways.in_cells import Spread
from tools.gridded import gridded
from tools.payloads import still_levels
from tools.surgery import (
    Frames,
    first_entries,
    frames_of,
    header_entries,
    header_frame,
    stream_of,
    with_header,
)
from tools.vectors.good_base import based
from tools.vectors.meshes import torus

Faces = npt.NDArray[np.int32]


# What streams are made of.


@cache
def _coded(name: str, *arguments: int) -> EncodedConnectivity:
    """The connectivity of one of `SHAPES`."""
    if name == "glued":
        return _glued(*arguments)
    faces = SHAPES[name](*arguments)
    return encode_connectivity(
        faces, int(faces.max()) + 1, ON_EDGES if name == "edges" else AS_CORNERS
    )


def _glued(rows: int, columns: int) -> EncodedConnectivity:
    """A torus whose vertices are three, again and again, as no encoder would code it."""
    place = np.arange(rows * columns, dtype=np.int32)
    colors = ((place // columns + place % columns) % 3).astype(np.int32)
    mesh = GivenMesh(torus(rows, columns).faces, place)
    mesh.join(True, True)
    return EncodedConnectivity(*mesh.code(colors))


def _wheels(hubs: int, rim: int) -> Faces:
    """As many hubs as come in pairs, each beside all vertices of one rim."""
    around = np.arange(rim, dtype=np.int32)
    after = (around + 1) % rim
    fans = [
        np.stack([np.full(rim, rim + hub), *((around, after) if hub % 2 else (after, around))], 1)
        for hub in range(hubs)
    ]
    return np.concatenate(fans).astype(np.int32)


def _soup(vertices: int, faces: int) -> Faces:
    """Triangles between any vertices: nothing separates a part of them from the rest."""
    random = np.random.default_rng(5)
    triangles = random.integers(0, vertices, (faces, 3))
    triangles[: vertices // 3, :] = np.arange(vertices // 3 * 3).reshape(-1, 3)
    proper = (
        (triangles[:, 0] != triangles[:, 1])
        & (triangles[:, 1] != triangles[:, 2])
        & (triangles[:, 2] != triangles[:, 0])
    )
    return np.asarray(triangles[proper], np.int32)


def _repeated(times: int) -> Faces:
    """One tetrahedron, many times over."""
    return np.tile(np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]], np.int32), (times, 1))


def _pieces(count: int) -> Faces:
    """Triangles that have nothing to do with each other."""
    return np.arange(3 * count, dtype=np.int32).reshape(-1, 3)


def _heap(rows: int, columns: int, count: int) -> Faces:
    """A torus, and one of its faces again and again."""
    faces = torus(rows, columns).faces
    return np.concatenate([faces, np.tile(faces[0], (count, 1))])


def _edges(rows: int, columns: int, count: int) -> Faces:
    """A torus, and faces that repeat a corner, all on the edge of the latest vertices."""
    faces = torus(rows, columns).faces
    coded = encode_connectivity(faces, rows * columns)
    ends = np.sort(coded.faces, axis=1)[:, 1:]
    low, high = coded.vertex_order[ends[np.lexsort(ends.T[::-1])[-1]]]
    return np.concatenate(
        [faces, np.tile(np.array([low, low, high], np.int32), (count, 1))]
    ).astype(np.int32)


SHAPES: dict[str, Callable[..., Faces]] = {
    "torus": lambda rows, columns: torus(rows, columns).faces,
    "wheels": _wheels,
    "heap": _heap,
    "edges": _edges,
    "soup": _soup,
    "repeated": _repeated,
    "pieces": _pieces,
}


def _header(coded: EncodedConnectivity, **fields: Any) -> tuple[int, bytes]:
    """A header frame of any fields, unchecked."""
    own = {"vertices": len(coded.vertex_order), "faces": len(coded.faces), "repeats": coded.repeats}
    return header_frame(**own | fields)


def _faces(coded: EncodedConnectivity) -> tuple[int, bytes]:
    return FrameType.CONNECTIVITY, coded.payload


def _blocks(count: int, columns: int) -> Iterator[tuple[int, bytes]]:
    """Packed blocks of one bit a coefficient, all zero."""
    zeros = pack_coefficients(np.ones(3 * columns, np.int64), 1)
    for index in range(count):
        yield FrameType.BLOCK, write_varint(index) + write_varint(columns) + zeros


PACKED = {"bits": 1, "springs": 0}


def _blocky(
    shape: tuple[Any, ...],
    *before: tuple[int, bytes],
    declared_count: int | None = None,
    columns: int = 1,
    **fields: Any,
) -> bytes:
    """Blocks, the first of them at least, all alike."""
    coded, count = _coded(*shape), fields["blocks"]
    fields = PACKED | {"coefficients": columns} | fields
    count = count if declared_count is None else declared_count
    return stream_of([_header(coded, **fields), _faces(coded), *before, *_blocks(count, columns)])


def _scattered(shape: tuple[Any, ...], parts: int) -> tuple[int, bytes]:
    """Labels by which every part is all over the mesh."""
    coded = _coded(*shape)
    graph = graph_of_faces(coded.faces, len(coded.vertex_order))
    labels = partition_of_labels(np.arange(graph.size, dtype=np.int32) % parts).labels
    return FrameType.PARTITION, Cut(graph.offsets, graph.neighbors).write(labels, parts)


def _tiny_blocks(shape: tuple[Any, ...], size: int, **fields: Any) -> bytes:
    """As many blocks as there may be."""
    vertices = len(_coded(*shape).vertex_order)
    blocks = min(vertices, (16 * vertices + 65536) // size, 1 << 17)
    return _blocky(shape, blocks=blocks, block_size=size, **fields)


def _grid(shape: tuple[Any, ...], chunk: int, **fields: Any) -> bytes:
    coded = _coded(*shape)
    size = len(coded.vertex_order)
    counts = [min(chunk, size - first) for first in range(0, size, chunk)]
    return stream_of(
        gridded(coded, np.zeros((size, 3), np.int32), counts, **{"grid": (1, 1, 1)} | fields)
    )


STAYING = np.array([[48, 0, *[1 << 3] * 3, *[12] * 3]] * 16, np.int32)
"""Transforms that leave everything where it is."""


def _apart(shape: tuple[Any, ...], side: int) -> bytes:
    """Images that are sought all over memory, among all vertices that eight of `side`^3 cells have, and never found.

    The vertices of the first half fill the cells but for their corners, which those of the others have for images.
    """
    coded, largest = _coded(*shape), (16 * side,) * 3
    size, numbers = len(coded.vertex_order), np.random.default_rng(1)
    values = 16 * numbers.integers(0, side, (size, 3)) + numbers.integers(2, 15, (size, 3))
    values[size // 2 :] = [32, 16, 16] * (
        numbers.integers(side // 4, side // 2, (size - size // 2, 3)) // [2, 1, 1]
    )
    shifts = [[32 * (place % 4) + 16, 16 * (place // 4), 0] for place in range(16)]
    rows = np.zeros((16, 8), np.int32)
    rows[:, 5:] = np.array(shifts) + largest
    counts = [min(1 << 15, size - first) for first in range(0, size, 1 << 15)]
    return stream_of(gridded(coded, values.astype(np.int32), counts, rows, grid=largest))


def _layers(rows: int, columns: int, chunk: int) -> bytes:
    coded = _coded("torus", rows, columns)
    size = len(coded.vertex_order)
    blocks = -(-size // 4000)
    frames: Frames = [
        _header(
            coded,
            **PACKED,
            blocks=blocks,
            block_size=min(size, 8000),
            coefficients=1,
            power=1,
            refinement=(1.0, 1.0),
        ),
        _faces(coded),
        *_blocks(blocks, 1),
    ]
    encoder = levels_field(coded.faces, np.zeros((size, 3), np.int32))
    for first in range(0, size, chunk):
        count = min(chunk, size - first)
        place = write_varint(first) + write_varint(count)
        frames.append((FrameType.REFINEMENT, place + encoder.write(count)[0]))
    return stream_of(frames)


def _cells(rows: int, columns: int, reach: int) -> bytes:
    """A layer on cells, whose places are spread as often as they may be."""
    stream = based(torus(rows, columns), Spread(reach), 0.01)
    cells, _, _, halvings = first_entries(stream)[HEADER_FIELDS["base"].key]
    return with_header(stream, base=[cells, reach, 64, halvings])


def _copies(rows: int, columns: int, count: int) -> bytes:
    """So many copies of one vertex, in as many blocks as there may be."""
    shape, size = ("heap", rows, columns, count), rows * columns
    faces = _heap(rows, columns, count)
    places = np.append(np.arange(size, dtype=np.int32), faces[-count:, 0])
    faces[-count:, 0] = size + np.arange(count)
    return _blocky(
        shape, _order(faces, places), blocks=size // 4, block_size=min(size, 64), power=1
    )


def _order(faces: Faces, places: npt.NDArray[np.int32]) -> tuple[int, bytes]:
    """The order of faces whose vertices are at some places."""
    mesh = GivenMesh(faces, places)
    mesh.join(True, True)
    mesh.code()
    return FrameType.ORDER, mesh.order(np.zeros((len(places), 3)))


def _sequence(
    rows: int, columns: int, gops: Iterable[GopBody], *, width: int, part: int = 400, **fields: Any
) -> bytes:
    coded = _coded("torus", rows, columns)
    size = len(coded.vertex_order)
    blocks = max(1, size // part)
    parts = min(size, part + part // 10 + 2)
    values = {
        **PACKED,
        "blocks": blocks,
        "block_size": parts,
        "coefficients": min(width, parts),
        "gop_frames": 1024,
        **fields,
    }
    frames: Frames = [_header(coded, **values), _faces(coded), *_blocks(blocks, 1)]
    first = 0
    for gop in gops:
        frames.append((FrameType.GOP, write_varint(first) + write_gop_body(gop)))
        first += gop.frames
    return stream_of(frames)


def _joined(
    streams: Iterable[bytes], agains: Iterable[int] = (), gop: GopBody | None = None
) -> bytes:
    """Sequences of one frame each as the runs of one, and behind them runs that have the meshes of some again."""
    frames: Frames = []
    run = 0
    for stream in streams:
        for kind, payload in frames_of(stream):
            if kind == FrameType.HEADER:
                entries = header_entries(payload) | (
                    {HEADER_FIELDS["run"].key: [run]} if run else {}
                )
                payload = write_map(sorted(entries.items()))
            if kind == FrameType.GOP:
                payload = (
                    write_varint(run) + bytes([payload[1] + METHODS * (run % RUNS)]) + payload[2:]
                )
            frames.append((kind, payload))
        run += 1
    meshes = [header_entries(payload) for kind, payload in frames if kind == FrameType.HEADER]
    for mesh in agains:
        sizes = {name: meshes[mesh][HEADER_FIELDS[name].key] for name in ("vertices", "faces")}
        assert gop is not None
        frames.append(header_frame(**sizes, gop_frames=1024, run=(run, mesh)))
        frames.append((FrameType.GOP, write_varint(run) + write_gop_body(gop, run)))
        run += 1
    return stream_of(frames)


def _still(rows: int, columns: int, part: int = 400) -> bytes:
    """Levels of a GOP in which nothing happens, of a torus in parts."""
    return still_levels(max(1, len(_coded("torus", rows, columns).vertex_order) // part))


def _learnt_gop(frames: int, components: int, levels: bytes = b"", attributes: int = 0) -> GopBody:
    """A GOP whose temporal bases are nothing but zeros, which take next to no bytes; optionally with attributes."""
    exponents = np.zeros(components, np.int32)
    fields = [
        GopField(width, 1.0, components, exponents, still_levels(width), levels) for width in (3, 4)
    ]
    return GopBody(GopMethod.LEARNT, frames, (fields[0], *fields[1:] * attributes))


def _key_gops(count: int, levels: bytes, *attributes: bytes) -> list[GopBody]:
    """Frames one by one; of positions, and of attributes of four numbers."""
    fields = [
        GopField(width, 1.0, width, np.empty(0, np.int32), b"", attribute_levels)
        for width, attribute_levels in zip((3, *[4] * len(attributes)), (levels, *attributes))
    ]
    return [GopBody(GopMethod.KEY_FRAME, 1, tuple(fields))] * count


def _next_gops(count: int, levels: bytes) -> list[GopBody]:
    (key,) = _key_gops(1, levels)
    behind = GopBody(GopMethod.NEXT_FRAME, 1, (replace(key.fields[0], back=1),))
    return [key, *[behind] * count]


def _followed(count: int, gop: GopBody) -> list[GopBody]:
    """Return a GOP, and a number of GOPs that refer to the one before."""
    return [gop, *[replace(gop, method=GopMethod.LEARNT_NEXT)] * count]


def _run(*before: tuple[int, bytes], behind: Frames = (), **fields: Any) -> bytes:  # type: ignore[assignment]
    """A sequence of nine vertices and one frame, with frames before its blocks and behind them."""
    frames = frames_of(_sequence(3, 3, [NOTHING], width=1, **ONCE | fields))
    blocks = [frame for frame in frames if frame[0] == FrameType.BLOCK]
    return stream_of([*frames[:2], *before, *blocks, *behind, frames[-1]])


def _attributed_run(count: int) -> bytes:
    """One with attributes."""
    declared, chunks = _attributes(3, 3, count, 9, 9, moves=1)
    return _run(*declared, behind=chunks, attributes=count)


def _before_faces(frames: Frames) -> bytes:
    """A small mesh with frames behind its header."""
    small = frames_of(one_block(3, 3, 1))
    return stream_of([small[0], *frames, *small[1:]])


def _metadata(entries: int) -> bytes:
    coded = _coded("torus", 12, 12)
    payload = write_map([(f"{number:04}", number) for number in range(entries)])
    blocks = {**PACKED, "blocks": 1, "block_size": 144, "coefficients": 1}
    frames: Frames = [_header(coded, **blocks), (FrameType.METADATA, payload), _faces(coded)]
    skippable: Frames = [(8, b"")] * 100_000
    return stream_of([*frames, *skippable, *_blocks(1, 1)])


def _long_metadata(entries: int, length: int) -> bytes:
    """As many bytes of metadata as there may be."""
    payload = write_map([(f"{number:0250}", "x" * length) for number in range(entries)])
    coded = _coded("torus", 12, 12)
    blocks = {**PACKED, "blocks": 1, "block_size": 144, "coefficients": 1}
    return stream_of(
        [_header(coded, **blocks), (FrameType.METADATA, payload), _faces(coded), *_blocks(1, 1)]
    )


def _valued(
    rows: int,
    columns: int,
    count: int,
    chunk: int,
    *,
    coded: int | None = None,
    swift: int = 0,
    **fields: Any,
) -> bytes:
    """Return a mesh with a number of equal, empty attributes."""
    blocks = {
        "blocks": 1 + rows * columns // 4000,
        "block_size": min(rows * columns, 8000),
        "power": 1,
    }
    frames = frames_of(_blocky(("torus", rows, columns), attributes=count, swift=swift, **blocks))
    size = rows * columns if coded is None else coded
    fields_of_values = {"origin": OTHERWISE, **fields}
    declared, chunks = _attributes(
        rows, columns, count, chunk, size, swift=swift, **fields_of_values
    )
    return stream_of([*frames[:2], *declared, *frames[2:], *chunks])


def _attributes(
    rows: int, columns: int, count: int, chunk: int, size: int, swift: int = 0, **fields: Any
) -> tuple[Frames, Frames]:
    """Return declarations of a number of attributes, and values that are all 0, or all one direction."""
    shape = _coded("torus", rows, columns)
    values = {"rows": size, "largest": (1,) * 4, "kind": 7, "components": 4, **fields}
    declared: Frames = []
    chunks: Frames = []
    for index in range(count):
        declaration = Declaration(name=f"{index}", **values)
        declared.append(_written(packets.Declared(index, declaration, b"")))
        if declaration.rows == 0:
            continue
        vertices = 0 if declaration.domain == FACE else rows * columns
        surface = Surface(shape.faces, np.arange(vertices, dtype=np.int32))
        level = declaration.largest[0] // 2 if declaration.coding == OCTAHEDRAL else 0
        levels = np.full((size, len(declaration.largest)), level, np.int32)
        encoder = field_of(declaration, surface, levels, None, swift)
        for first in range(0, size, chunk):
            rows_of_chunk = min(chunk, size - first)
            chunks.append(
                _written(
                    packets.Values(
                        index, first, rows_of_chunk, write_values(encoder, rows_of_chunk)
                    )
                )
            )
    return declared, chunks


def _moving(
    rows: int,
    columns: int,
    count: int,
    gops: Iterable[GopBody],
    *,
    part: int = 400,
    width: int = 10,
) -> bytes:
    """Return a sequence with a number of moving attributes of four doubles; GOPs code as many as they have fields."""
    frames = frames_of(
        _sequence(rows, columns, (), width=width, part=part, power=1, attributes=count)
    )
    declared, chunks = _attributes(rows, columns, count, 1 << 15, rows * columns, moves=1)
    first = 0
    bodies: Frames = []
    for gop in gops:
        data = write_gop_body(gop, numbers=range(len(gop.fields) - 1))
        bodies.append((FrameType.GOP, write_varint(first) + data))
        first += gop.frames
    return stream_of([*frames[:2], *declared, *frames[2:], *chunks, *bodies])


def _seamed(rows: int, columns: int, count: int) -> bytes:
    """Return a number of attributes of corners, each with seams of its own around a corner, and no values."""
    size = rows * columns
    blocks = {"blocks": 1 + size // 4000, "block_size": min(size, 8000), "power": 1}
    frames = frames_of(_blocky(("torus", rows, columns), attributes=count, **blocks))
    faces = _coded("torus", rows, columns).faces
    place = GivenMesh(torus(rows, columns).faces, np.arange(size, dtype=np.int32))
    place.join(True, False)
    place.code()
    values, exact = np.arange(2, dtype=np.uint8)[:, None], Quality("exact")
    seams = [
        (np.arange(faces.size, dtype=np.int32) == corner).reshape(-1, 3).astype(np.int32)
        for corner in range(3)
    ]
    coded_attributes = [(Attribute("0", values, "corner", indices=at), exact) for at in seams]
    # Three in turn, of which each follows the other two.
    turns = [
        carry(place, faces, coded_attributes[turn:] + coded_attributes[:turn], 0)
        for turn in range(3)
    ]
    carried = [*turns[0], *(turns[(index + 1) % 3][2] for index in range(3, count))][:count]
    declared = [
        _written(packets.Declared(index, replace(one.declaration, name=f"{index}"), one.seams))
        for index, one in enumerate(carried)
    ]
    return stream_of([*frames[:2], *declared, *frames[2:]])


def _nested(kind: FrameType, size: int) -> bytes:
    """Return a map of `size` bytes, arrays in arrays, in place of a header, an attribute or metadata."""
    inside = b"\x91" * 400 + b"\x01"
    payload = (
        b"\x81\xcc\x80\xdd"
        + (size // len(inside)).to_bytes(4, "big")
        + inside * (size // len(inside))
    )
    if kind == FrameType.HEADER:
        return stream_of([(kind, payload)])
    frames = frames_of(one_block(20, 20, 4))
    if kind == FrameType.METADATA:
        return stream_of([frames[0], (kind, payload), *frames[1:]])
    coded = _coded("torus", 20, 20)
    header = _header(coded, **PACKED, blocks=1, block_size=400, coefficients=4, attributes=1)
    return stream_of(
        [
            header,
            frames[1],
            (kind, write_varint(0) + write_varint(len(payload)) + payload),
            *frames[2:],
        ]
    )


def _written(packet: packets.Packet) -> tuple[int, bytes]:
    kind, write = WRITERS[type(packet)]
    return kind, write(packet)


def _torn(stream: bytes, rubbish: bytes) -> bytes:
    """The stream with rubbish before its END, as a tolerant decoder may be sent."""
    last = len(stream_of([])) - len(stream_of([])[:5])
    return stream[:-last] + rubbish + stream[-last:]


def _rubbish(size: int) -> bytes:
    """Bytes that seem to begin a long frame at every other place."""
    tag = write_frame(FrameType.BLOCK, bytes(60_000))[:3]
    return (tag * (size // len(tag) + 1))[:size]


def _worthless(rows: int, columns: int, count: int, size: int) -> bytes:
    """Blocks that end too early, one as the other, but are chains of their own."""
    coded = _coded("torus", rows, columns)
    header = _header(coded, blocks=count, block_size=size, coefficients=64, key_interval=1)
    blocks = [(FrameType.BLOCK, write_varint(index) + write_varint(64)) for index in range(count)]
    return stream_of([header, _faces(coded), *blocks])


def one_block(rows: int, columns: int, width: int, **fields: Any) -> bytes:
    return _blocky(
        ("torus", rows, columns), columns=width, blocks=1, block_size=rows * columns, **fields
    )


def ring(rows: int, columns: int) -> tuple[str, int, int]:
    """The shape of a torus."""
    return "torus", rows, columns


ONCE = {"power": 1, "key_iterations": 1}
NOTHING = _learnt_gop(1, 0)
BACK_AND_FORTH = np.arange(1024) % 2
BOMBS: dict[str, Callable[[], bytes]] = {
    # Blocks that overlap as much as they may.
    "members": lambda: _tiny_blocks(ring(256, 256), 4096, declared_count=0),
    "members-illegal": lambda: _blocky(
        ring(256, 256), declared_count=0, blocks=65536, block_size=4096
    ),  # 65,536 blocks of 4,096
    # One column, power 64, 1,024 iterations.
    "narrow": lambda: one_block(91, 90, 1, power=64, key_iterations=1024),
    # The same in tiny blocks
    "narrow-small": lambda: _blocky(
        ring(36, 36), blocks=100, block_size=14, power=64, iterations=1024, key_iterations=1024
    ),
    "wide": lambda: one_block(64, 64, 4096, power=1),  # as many columns as rows
    "wide-exact": lambda: one_block(64, 64, 4096, exact=1),  # the same, exact
    # 1,024 columns, two iterations.
    "wide-1024": lambda: one_block(64, 64, 1024, power=1, key_iterations=2),
    # Exact chains of one block each
    "svd-keys": lambda: _blocky(
        ring(100, 100), columns=100, blocks=50, block_size=250, exact=1, key_interval=1
    ),
    # Columns that one solution loses
    "careful": lambda: one_block(40, 40, 400, power=64, shift=2.0 ** (-30), key_iterations=16),
    "tiny": lambda: _tiny_blocks(ring(64, 64), 4, **ONCE),  # blocks of one vertex
    # Parts that are all over the mesh
    "scattered": lambda: _blocky(
        ring(256, 256),
        _scattered(ring(256, 256), 4096),
        blocks=4096,
        block_size=256,
        key_interval=2,
        springs=1,
        power=1,
    ),
    # One block without separators
    "expander": lambda: _blocky(("soup", 3000, 9000), blocks=1, block_size=3000, columns=100),
    # Hubs that every block grows over
    "hubs": lambda: _blocky(("wheels", 200, 8000), blocks=32, block_size=4096, **ONCE),
    # The same with small blocks
    "hubs-small": lambda: _blocky(("wheels", 60, 2000), blocks=16, block_size=2060, **ONCE),
    # Smoothing where everything is near everything
    "rings": lambda: _blocky(
        ("wheels", 2, 20000), blocks=1600, block_size=200, smoothing=1.0, **ONCE
    ),
    # A million faces of four vertices.
    "faces": lambda: _blocky(("repeated", 250000), blocks=1, block_size=4),
    # Two million faces of three vertices.
    "glued": lambda: _blocky(("glued", 999, 999), blocks=1, block_size=3),
    # Triangles apart.
    "pieces": lambda: _blocky(("pieces", 100000), blocks=2000, block_size=160, smoothing=1.0),
    "mesh": lambda: _blocky(
        ring(1024, 1024), declared_count=0, blocks=160, block_size=8192
    ),  # a million vertices and no block
    # A million vertices in large blocks
    "mesh-blocks": lambda: _blocky(
        ring(1024, 1024), blocks=160, block_size=8192, power=2, columns=8
    ),
    "copies": lambda: _copies(64, 64, 20_000),  # copies of one vertex in many blocks
    "grid": lambda: _grid(ring(1024, 1024), 1 << 15),  # a grid of a million vertices
    "grid-chunks": lambda: _grid(ring(100, 100), 1),  # a grid, vertex by vertex
    # Images of everything.
    "congruent": lambda: _grid(ring(1024, 1024), 1 << 15, transforms=STAYING),
    "congruent-apart": lambda: _apart(ring(400, 400), 25),  # images that are sought everywhere
    "congruent-chunks": lambda: _grid(ring(100, 100), 1, transforms=STAYING),
    # The small model on a million vertices.
    "light": lambda: _grid(ring(1024, 1024), 1 << 15, light=1),
    "light-chunks": lambda: _grid(ring(100, 100), 1, light=1),  # the same, vertex by vertex
    # Hubs beside everything, by the small model.
    "light-hubs": lambda: _grid(("wheels", 20, 4000), 1 << 15, light=1),
    # Vertices with very many corners, by the small model
    "light-repeated": lambda: _grid(("repeated", 15000), 1, light=1),
    "layers": lambda: _layers(512, 512, 1 << 15),  # a layer
    # A layer on nearly as many cells as there may be, spread 64 times.
    "cells": lambda: _cells(400, 400, 1),
    "cells-far": lambda: _cells(400, 400, 8),  # the same on few cells
    "layers-chunks": lambda: _layers(50, 50, 1),  # the same, vertex by vertex
    "metadata": lambda: _metadata(256),  # 256 names and 100,000 frames to skip
    "metadata-long": lambda: _long_metadata(256, 32000),  # eight MiB of metadata
    "values": lambda: _valued(60, 60, 75, 1 << 15),  # 75 attributes of four doubles
    "values-corners": lambda: _valued(500, 500, 5, 1 << 15),  # fewer on more corners
    # Attributes, value by value
    "values-chunks": lambda: _valued(
        60, 60, 3, 1, kind=0, components=1, largest=(1,), origin=AS_CODED
    ),
    # Six times normals that are never sent
    "values-normals": lambda: _valued(
        400, 400, 6, 1, kind=6, components=3, semantic=2, coding=RECOMPUTED, coded=0, largest=()
    ),
    # Attributes of faces
    "values-faces": lambda: _valued(
        100, 100, 20, 1 << 15, domain=FACE, origin=AS_CODED, coded=20000
    ),
    # Values that are quick to decode: plain, mixed, one number each, value by value, and normals
    "swift-plain": lambda: _valued(500, 500, 4, 1 << 15, swift=1),
    "swift": lambda: _valued(500, 500, 4, 1 << 15, swift=2),
    "swift-numbers": lambda: _valued(
        500, 500, 9, 1 << 15, swift=2, kind=0, components=1, largest=(1,)
    ),
    "swift-chunks": lambda: _valued(
        60, 60, 3, 1, swift=2, kind=0, components=1, largest=(1,), origin=AS_CODED
    ),
    "swift-normals": lambda: _valued(
        500, 500, 4, 1 << 15, swift=2, kind=6, components=3, coding=OCTAHEDRAL, largest=(1022, 1022)
    ),
    "swift-small": lambda: _valued(3, 3, 255, 9, swift=2),  # 255 attributes of nine vertices
    # Edges of a million vertices, the last of which has all faces that repeat a corner
    "edges": lambda: _grid(("edges", 1000, 1000, 1), 1 << 15, light=1),
    "edges-many": lambda: _grid(("edges", 20, 20, 600000), 1 << 15, light=1),
    # 60 attributes with seams of their own on a million vertices.
    "seams": lambda: _seamed(1024, 1024, 60),
    "seams-many": lambda: _seamed(256, 256, 255),  # 255 of them on fewer
    "skippable": lambda: _before_faces([(8, b"")] * 4000000),  # frames of nothing
    "skippable-long": lambda: _before_faces([(8, bytes(1 << 25))]),  # one of much
    "nested-header": lambda: _nested(FrameType.HEADER, 1 << 24),  # arrays in arrays as a header
    "nested-attribute": lambda: _nested(FrameType.ATTRIBUTE, 1 << 24),  # the same as a declaration
    "nested-metadata": lambda: _nested(FrameType.METADATA, 8000000),  # the same as metadata
    # A megabyte of rubbish behind the blocks.
    "torn": lambda: _torn(one_block(20, 20, 4), _rubbish(1 << 20)),
    "torn-chunks": lambda: _grid(ring(100, 100), 1)[: 9 * 4000],  # half of a stream of tiny frames
    "worthless": lambda: _worthless(64, 64, 1000, 100),  # blocks that end too early
    "sequence": lambda: _sequence(200, 200, [NOTHING], width=440),  # dictionaries of all columns
    # The same by iterations without end
    "sequence-power": lambda: _sequence(40, 40, [NOTHING], width=8, power=64, key_iterations=1024),
    # Runs of small meshes
    "sequence-runs": lambda: _joined(
        _sequence(4, 4 + k % 9, [NOTHING], width=4, power=1) for k in range(3000)
    ),
    # More large meshes than are kept
    "sequence-runs-kept": lambda: _joined(
        _sequence(100, 100 + k, [_learnt_gop(1, 0, _still(100, 100 + k))], width=440, power=1)
        for k in range(20)
    ),
    # Two large meshes in turn, whose dictionaries are made again for each frame
    "sequence-runs-again": lambda: _joined(
        [
            _sequence(
                100,
                100,
                [_learnt_gop(1, 0, _still(100, 100))],
                width=440,
                power=2,
                key_iterations=2,
            )
        ]
        * 2,
        [k % 2 for k in range(100)],
        _learnt_gop(1, 0, _still(100, 100)),
    ),
    # More dictionaries than there is room for, frame after frame
    "sequence-again": lambda: _sequence(
        250, 200, _key_gops(40, _still(250, 200)), width=440, power=2, key_iterations=2
    ),
    # Many components of one part
    "gop-part": lambda: _sequence(
        70, 70, [_learnt_gop(300, 160, _still(70, 70, 4900))], width=4, part=4900, power=1
    ),
    # As many components as there is room for
    "gop-components": lambda: _sequence(
        250, 200, [_learnt_gop(64, 75, _still(250, 200))] * 3, width=20
    ),
    # A GOP of 1,024 frames and 3,072 components
    "gop-wide": lambda: _sequence(20, 20, [_learnt_gop(1024, 3072, _still(20, 20))], width=50),
    # 1,024 frames of nothing, again and again
    "gop-still": lambda: _sequence(
        100, 100, [_learnt_gop(1024, 0, _still(100, 100))] * 20, width=10
    ),
    # 1,024 frames of 300 components
    "gop-300": lambda: _sequence(50, 50, [_learnt_gop(1024, 300, _still(50, 50))] * 2, width=400),
    # Frames that refer to many
    "gop-next": lambda: _sequence(100, 80, _next_gops(1000, _still(100, 80)), width=400),
    # 60 attributes of four doubles that move
    "moving": lambda: _moving(60, 60, 60, [_learnt_gop(100, 4, _still(60, 60), 60)]),
    # 255 attributes in parts of eight vertices, coded in every GOP
    "moving-most": lambda: _moving(
        20, 20, 255, [_learnt_gop(1, 1, _still(20, 20, 8), 255)] * 20, part=8, width=8
    ),
    # The same, frame by frame
    "moving-keys": lambda: _moving(
        20, 20, 255, _key_gops(20, _still(20, 20, 8), *[_still(20, 20, 8)] * 255), part=8, width=8
    ),
    # 255 attributes of nine vertices, in 200 frames of nothing
    "moving-frames": lambda: _moving(3, 3, 255, [_learnt_gop(200, 0, _still(3, 3))]),
    # As many components of attributes as there is room for
    "moving-components": lambda: _moving(
        200, 200, 2, [_learnt_gop(8, 12, _still(200, 200), 2)] * 3, width=20
    ),
    # Many small ones of all that there can be many of
    "runs": lambda: _joined([_run()] * 300),
    "runs-again": lambda: _joined([_run()], [0] * 1500, NOTHING),
    "runs-parts": lambda: _joined([_run(_scattered(ring(3, 3), 3), part=3)] * 200),
    "runs-order": lambda: _joined(
        [_run(_order(torus(3, 3).faces, np.arange(9, dtype=np.int32)))] * 300
    ),
    "runs-attributes": lambda: _joined([_attributed_run(10)] * 50),
    "metadata-entries": lambda: _before_faces(
        [
            (FrameType.METADATA, write_map([(f"{k:04}{entry:03}", 1) for entry in range(256)]))
            for k in range(300)
        ]
    ),
    "gops": lambda: _sequence(3, 3, [NOTHING] * 2000, width=1, **ONCE),
    "gops-learned": lambda: _sequence(
        3, 3, [_learnt_gop(1, 3, _still(3, 3))] * 1500, width=4, **ONCE
    ),
    "gops-parts": lambda: _sequence(
        20, 20, [_learnt_gop(1, 3, _still(20, 20, 8))] * 80, width=8, part=8, power=1
    ),
    "gops-following": lambda: _sequence(
        3, 3, _followed(1500, _learnt_gop(1, 3, _still(3, 3))), width=4, power=1
    ),
    "gops-following-large": lambda: _sequence(
        100, 100, _followed(3, _learnt_gop(64, 75, _still(100, 100))), width=20
    ),
    "gops-stretches": lambda: _sequence(
        3, 3, [replace(_learnt_gop(1024, 0), shown=BACK_AND_FORTH)] * 20, width=1
    ),
    "gops-keys": lambda: _sequence(3, 3, _key_gops(1500, _still(3, 3)), width=4, power=1),
    "gops-next": lambda: _sequence(3, 3, _next_gops(1500, _still(3, 3)), width=4, power=1),
    "moving-gops": lambda: _moving(3, 3, 100, [NOTHING] * 100),
    "moving-parts": lambda: _moving(
        20, 20, 60, [_learnt_gop(1, 1, _still(20, 20, 8), 60)] * 5, part=8, width=8
    ),
    "sequence-parts": lambda: _sequence(50, 50, [NOTHING], width=8, part=1, power=1),
    "attributes-small": lambda: _valued(3, 3, 255, 9),
    # Small ones of a large mesh
    "values-chunks-large": lambda: _valued(
        400, 400, 1, 80, kind=0, components=1, largest=(1,), origin=AS_CODED
    ),
}
"""What each is called, and what makes it; beside it what it is that costs."""
