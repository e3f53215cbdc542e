"""Every stream is decoded before it is handed out: a writer that is broken, in any of its parts, is caught."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import bsm
from bsm.bitstream.container import packets
from bsm.bitstream.container.header import Header
from bsm.bitstream.container.packets import SectionWriter
from tests.shapes import curved, torus

MESH = curved(torus(24, 20))
SHADES = (np.arange(3 * len(MESH.positions)) % 251).astype(np.uint8).reshape(-1, 3)
COLORS = bsm.Attribute("color", SHADES, semantic="color")
PAINTED = bsm.TriangleMesh(MESH.positions, MESH.faces, [COLORS], {"unit": "mm"})
FRAMES = np.array([MESH.positions * (1 + 0.02 * np.sin(t)) for t in range(4)])

Change = Callable[[Any], Any]


def flipped(data: bytes) -> bytes:
    """Change one bit of the last third: checksums are made behind this."""
    place = 2 * len(data) // 3
    return data[:place] + bytes([data[place] ^ 4]) + data[place + 1 :]


def blocks() -> bytes:
    return bsm.encode(MESH, step=0.004)


def refined() -> bytes:
    return bsm.encode(MESH, congruence=False)  # a grid would be smaller


def on_a_grid() -> bytes:
    return bsm.encode(MESH, grid=12)


def painted() -> bytes:
    return bsm.encode(PAINTED, grid=12)


def ordered() -> bytes:
    return bsm.encode(MESH, grid=12, keep_order=True)


def moving() -> bytes:
    return bsm.encode_sequence(FRAMES, MESH.faces, metadata={"unit": "mm"})


BROKEN: dict[str, tuple[Callable[[], bytes], type, Change]] = {
    "step": (blocks, Header, lambda header: replace(header, step=2 * header.step)),
    "center": (blocks, Header, lambda header: replace(header, center=(0.5, *header.center[1:]))),
    "scale": (on_a_grid, Header, lambda header: replace(header, scale=1.25 * header.scale)),
    "faces": (
        blocks,
        packets.Connectivity,
        lambda packet: replace(packet, data=flipped(packet.data)),
    ),
    "refinement": (
        refined,
        packets.Refinement,
        lambda packet: replace(packet, data=flipped(packet.data)),
    ),
    "coefficients": (
        blocks,
        packets.Coefficients,
        lambda packet: replace(packet, data=flipped(packet.data)),
    ),
    "grid": (on_a_grid, packets.Grid, lambda packet: replace(packet, data=flipped(packet.data))),
    "order": (ordered, packets.Order, lambda packet: replace(packet, data=flipped(packet.data))),
    "values": (painted, packets.Values, lambda packet: replace(packet, data=flipped(packet.data))),
    "name": (
        painted,
        packets.Declared,
        lambda packet: replace(packet, declaration=replace(packet.declaration, name="shade")),
    ),
    "metadata": (painted, packets.Metadata, lambda packet: replace(packet, entries={"unit": "cm"})),
    "frames": (moving, packets.Gop, lambda packet: replace(packet, data=flipped(packet.data))),
    "metadata of frames": (
        moving,
        packets.Metadata,
        lambda packet: replace(packet, entries={"unit": "cm"}),
    ),
}


@pytest.mark.parametrize("name", BROKEN)
@pytest.mark.parametrize("checksum", [True, False], ids=["with", "without"])
def test_a_broken_writer_is_caught(
    name: str, checksum: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also without the checksum of positions in the stream, which tells decoders most of it."""
    make, kind, change = BROKEN[name]
    write = SectionWriter.write
    touched = []

    def broken(writer: SectionWriter, packet: packets.Packet) -> bytes:
        if type(packet) is kind:
            touched.append(packet)
            packet = change(packet)
        if isinstance(packet, packets.End) and not checksum:
            packet = replace(packet, positions=None)
        return write(writer, packet)

    make()
    monkeypatch.setattr(SectionWriter, "write", broken)
    # What no longer decodes is refused by a limit where it claims too much.
    with pytest.raises((bsm.VerificationError, bsm.LimitError)):
        make()
    assert touched
