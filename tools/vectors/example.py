"""The worked example of the specification: one vector, byte for byte, and the numbers on the way to its positions."""

from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

from bsm.bitstream.container.header import HEADER_FIELDS
from bsm.bitstream.container.packets import Header
from bsm.bitstream.container.wire import (
    FrameType,
    write_frame,
    write_map,
    write_preamble,
    write_varint,
)
from bsm.codec.blocks.overlap import derive_partition, grow_blocks
from bsm.codec.decoding import decode
from bsm.codec.geometry.graph import graph_of_faces
from bsm.codec.signal.chain import Chain
from bsm.codec.static.coding import rules_of
from tools.surgery import frames_of, header_entries, scan
from tools.vectors.store import FOLDER

NAME = "good-tetrahedron"


def example() -> str:
    """Text of the section, as it must stand in the document."""
    stream = (FOLDER / f"{NAME}.bsm").read_bytes()
    lines = [f"    {data.hex(' '):30}  {meaning}" for data, meaning in _bytes(stream)]
    return "\n".join(
        [
            f"`vectors/{FOLDER.name}/{NAME}.bsm`, {len(stream)} bytes:",
            "",
            *lines,
            "",
            *_numbers(stream),
        ]
    )


def _bytes(stream: bytes) -> Iterator[tuple[bytes, str]]:
    yield write_preamble(), "magic, version 1.0"
    frames = frames_of(stream)
    for number, (kind, payload) in enumerate(frames):
        frame = write_frame(kind, payload)
        tag = write_varint(len(payload) << 4 | kind)
        yield tag, f"frame {number}: {FrameType(kind).name}, {len(payload)} bytes"
        if kind == FrameType.HEADER:
            yield from _header(payload)
        elif kind == FrameType.BLOCK:
            yield payload[:1], f"block {payload[0]}"
            yield payload[1:2], f"c_i = {payload[1]}"
            yield payload[2:], "coded levels"
        else:
            yield payload, "coded faces"
        yield frame[len(tag) + len(payload) :], "CRC-16"
    start = len(stream) - 13
    yield stream[start : start + 2], "END, 9 bytes"
    yield stream[start + 2 : start + 3], f"{stream[start + 2]} frames before it"
    yield stream[start + 3 : start + 7], "CRC-32 of all bytes before END"
    yield stream[start + 7 : start + 11], "CRC-32 of positions"
    yield stream[start + 11 :], "CRC-16"


def _header(payload: bytes) -> Iterator[tuple[bytes, str]]:
    names = {field.key: name for name, field in HEADER_FIELDS.items()}
    entries = header_entries(payload)
    yield payload[:1], f"a map of {len(entries)} entries"
    for key, value in entries.items():
        packed = write_map([(key, value)])[1:]
        if isinstance(value, list) and len(value) > 1:
            yield packed[:2], f"{names[key]}, {len(value)} floats"
            for item in value:
                yield write_map([(0, item)])[2:], f"{item:.9g}"
        else:
            yield packed, f"{names[key]} = {value[0] if isinstance(value, list) else value:.9g}"


def _numbers(stream: bytes) -> list[str]:
    header, _ = next(scan(stream))
    assert isinstance(header, Header)
    mesh = decode(stream)
    graph = graph_of_faces(mesh.faces, header.vertices)
    blocks = grow_blocks(graph, derive_partition(graph, header.blocks), header.block_size)
    payload = frames_of(stream)[2][1]
    chain = Chain(rules_of(header.constants, header.key_interval), blocks)
    vertices = chain.begin(0)[0]
    subspace = chain.dictionary(payload[1])
    places = (mesh.positions[vertices] - header.center) / header.scale
    # In half steps, since U is orthonormal.
    points = np.rint(2.0 * subspace.T @ places / header.step).astype(int)
    levels, coefficients = np.sign(points) * ((np.abs(points) + 1) // 2), 0.5 * header.step * points
    return [
        "The faces are " + ", ".join(f"({a} {b} {c})" for a, b, c in mesh.faces.tolist()) + ".",
        "The rows of the only block are the vertices "
        + " ".join(map(str, vertices.tolist()))
        + ".",
        "Its levels, and their coefficients:",
        "",
        *(f"    {_row(a, '4d')}    {_row(b, '9.6f')}" for a, b in zip(levels, coefficients)),
        "",
        "The block is the first of its chain, so its extension is 0. Its dictionary U, and U times the coefficients:",
        "",
        *(
            f"    {_row(a, '9.6f')}    {_row(b, '9.6f')}"
            for a, b in zip(subspace, subspace @ coefficients)
        ),
        "",
        "In the unit of the mesh, vertex after vertex:",
        "",
        *(f"    {_row(position, '9.6f')}" for position in mesh.positions),
        "",
    ]


def _row(values: npt.NDArray[np.generic], form: str) -> str:
    return " ".join(
        format(value + 0 if abs(value) > 5e-7 else abs(value), form) for value in values.tolist()
    )
