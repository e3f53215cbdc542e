"""Scans on cells: what the encoder takes, what events bring, and what damage spoils."""

from functools import cache

import numpy as np
import pytest

from bsm import (
    BlockEvent,
    Decoder,
    EndEvent,
    Limits,
    LossEvent,
    RefinementEvent,
    TriangleMesh,
    decode,
    encode,
)
from bsm._core import Decoder as Engine
from bsm.bitstream.container.wire import FrameType
from bsm.codec.decoding import BLOCK, REFINEMENT, Event, mask_of
from tests.shapes import torus
from tests.streams import info_of
from tools.surgery import Cursor, spans_of, with_header

KINDS = FrameType.BLOCK, FrameType.REFINEMENT


@cache
def scan() -> TriangleMesh:
    """Smooth waves, and some noise."""
    mesh = torus(150, 110)
    noise = np.random.default_rng(2).normal(scale=1e-3, size=mesh.positions.shape)
    return TriangleMesh(mesh.positions + noise, mesh.faces)


@cache
def stream() -> bytes:
    return encode(scan(), threads=1)


def events_of(data: bytes, **options: bool) -> list[Event]:
    with Decoder(threads=1, **options) as decoder:
        return list(decoder.events([data]))


def test_a_scan_is_on_cells_and_shown_as_a_whole_early() -> None:
    events, whole = events_of(stream()), decode(stream(), threads=1)
    header = events[0].header
    assert stream()[4] == 0x12 and header.base[1:3] == (2, 8) and header.blocks > 1
    shown = np.full(whole.positions.shape, np.nan)
    for event in events:
        if isinstance(event, BlockEvent | RefinementEvent):
            shown[event.vertices] = event.positions
        if isinstance(event, BlockEvent) and event.index == header.blocks - 1:
            assert event.final.all() and len(event.vertices) == len(shown)
            assert np.abs(shown - whole.positions).max() < 0.1
    assert np.array_equal(shown, whole.positions)
    base = events_of(stream(), layers=1)
    assert isinstance(base[-1], EndEvent) and not any(
        isinstance(event, RefinementEvent) for event in base
    )


def test_some_vertices_come_where_all_are_that_blocks_bring() -> None:
    """What is asked of a block is spread to the vertices that have come alone."""
    engine, counts = Engine(Limits()), []
    engine.push(np.frombuffer(stream(), np.uint8))
    engine.finish()
    while engine.next(mask_of(BLOCK, REFINEMENT))[0] == BLOCK:
        vertices, places, _ = engine.changes()
        counts.append(len(vertices))
        assert np.array_equal(places, engine.positions(len(scan().positions))[vertices])
    assert 0 < counts[0] < counts[-1] == len(scan().positions)


@pytest.mark.parametrize(
    "asked",
    [{"power": 2, "iterations": 2}, {"block_size": 200}, {"overlap": 1.2}, {"key_interval": 2}],
)
def test_blocks_that_are_asked_for_are_on_the_mesh(asked: dict[str, float]) -> None:
    header = events_of(encode(scan(), threads=1, **asked))[0].header
    assert header.base == () and bool(header.paper) == ("power" in asked)


@pytest.mark.parametrize(("kind", "which"), [(kind, which) for kind in KINDS for which in (0, -1)])
def test_damage_is_bounded_and_named(kind: FrameType, which: int) -> None:
    span = [span for span in spans_of(stream()) if span.type == kind][which]
    damaged = bytearray(stream())
    damaged[span.offset + span.length // 2] ^= 255
    whole, shown, lost = (
        decode(stream(), threads=1),
        np.full((len(scan().positions), 3), np.nan),
        [],
    )
    for event in events_of(bytes(damaged), tolerant=True):
        if isinstance(event, BlockEvent | RefinementEvent):
            shown[event.vertices] = event.positions
        if isinstance(event, LossEvent):
            lost.append(event)
    assert isinstance(event, EndEvent) and event.losses is not None and lost
    missing = np.isnan(shown).any(axis=1)
    assert sorted(event.losses.missing) == np.flatnonzero(missing).tolist()
    right = np.ones(len(shown), bool)
    right[event.losses.missing] = right[event.losses.degraded] = False
    assert np.abs(shown - whole.positions)[right].max(initial=0.0) < 1e-3
    assert missing.any() == (kind == FrameType.BLOCK)
    assert np.abs(shown - whole.positions)[~missing].max(initial=0.0) < 1.0  # of 2.7


def test_a_lost_block_loses_no_more_than_its_chain() -> None:
    bare = torus(260, 200)
    noise = np.random.default_rng(2).normal(scale=1e-3, size=bare.positions.shape)
    data = encode(TriangleMesh(bare.positions + noise, bare.faces), threads=1)
    first = next(span for span in spans_of(data) if span.type == FrameType.BLOCK)
    damaged = bytearray(data)
    damaged[first.offset + first.length // 2] ^= 255
    events = events_of(bytes(damaged), tolerant=True)
    header, end = events[0].header, events[-1]
    assert header.blocks > 12 and header.key_interval <= 4
    assert 0 < len(end.losses.missing) < 0.4 * header.vertices


def test_another_number_of_cells_is_refused() -> None:
    base = events_of(stream())[0].header.base
    with pytest.raises(ValueError, match="cells where the header has"):
        decode(with_header(stream(), base=[base[0] - 1, *base[1:]]))


def test_positions_are_counted_by_blocks_levels_of_cells_and_levels_of_vertices() -> None:
    """Against a walk over the frames: every frame of both kinds begins with two numbers, and data follow."""
    info = info_of(stream())
    expected = dict.fromkeys(("blocks", "levels_of_cells", "levels_of_vertices"), 0)
    for span in spans_of(stream()):
        if span.type not in KINDS:
            continue
        cursor = Cursor(span.payload)
        first, _ = cursor.varint(), cursor.varint()
        levels = "levels_of_cells" if first < info.header.base[0] else "levels_of_vertices"
        expected["blocks" if span.type == FrameType.BLOCK else levels] += len(cursor.rest())
    assert min(expected.values()) > 0
    assert {kind: size for kind, size in info.positions.items() if size} == expected
    assert sum(info.positions.values()) == info.sizes["coefficients"]
