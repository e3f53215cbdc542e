"""Streams that the tests of the framing share."""

from dataclasses import replace

from bsm.bitstream.container.packets import (
    Block,
    Connectivity,
    Gop,
    Grid,
    Header,
    Metadata,
    Order,
    Packet,
    Partition,
    Refinement,
)
from tools.surgery import scan, write_stream

SMALL_HEADER = Header(vertices=100, faces=190, blocks=3, block_size=60, coefficients=10)

STATIC: list[Packet] = [
    Header(vertices=100, faces=190, blocks=3, block_size=60, coefficients=10, center=(0.1, -2.0, 3.0), step=0.01),
    Metadata({"creator": "test", "count": -3, "ratio": 0.5, "thumbnail": b"\x00\xff"}),
    Connectivity(b"faces" * 7),
    Partition(b""),
    Order(b"order"),
    Block(0, 10, bytes(range(70))),
    Block(1, 0, b""),
    Block(2, 7, b"coefficients"),
]
BARE: list[Packet] = [SMALL_HEADER, Connectivity(b"\0\x01")]
ANIMATED: list[Packet] = [
    Header(vertices=4, faces=4, blocks=1, block_size=4, coefficients=2, sequence=(50, 8)),
    Connectivity(b"x"),
    Gop(0, b"first"),
    Gop(1, b"second"),
]
GRID: list[Packet] = [
    Header(vertices=100, faces=190, grid=(1023, 7, 500), scale=0.25),
    Connectivity(b"faces"),
    Order(b"order"),
    Grid(0, 60, b"positions"),
    Grid(60, 40, b""),
]
REFINED: list[Packet] = [
    replace(SMALL_HEADER, refinement=(0.001, 6.0)),
    Connectivity(b"faces"),
    Block(0, 10, b"coefficients"),
    Refinement(0, 60, b"levels"),
    Refinement(60, 40, b"more"),
]
STREAMS = {"static": STATIC, "bare": BARE, "animated": ANIMATED, "grid": GRID, "refined": REFINED}


def encoded(name: str) -> bytes:
    return write_stream(STREAMS[name])


def frame_ends(data: bytes) -> list[int]:
    """Offsets behind the preamble and behind every frame."""
    return [5, *(span.offset + span.length for _, span in scan(data))]
