"""Grids and refinement in the decoder: chunk by chunk, cut, damaged, stopped early."""

from typing import Any

import numpy as np
import pytest

import bsm
from bsm.bitstream.container.wire import FrameType
from tests.refined import LAYER, base, on_grid, refined, soup
from tests.streams import events_of
from tools.surgery import spans_of
from tools.vectors.meshes import torus

MESH = torus(12, 10)
REFINED = refined(MESH, LAYER, (50, 70))
GRID = on_grid(torus(8, 7), counts=(30, 20, 6))


def shown(events: list[Any]) -> bsm.TriangleMesh:
    """The mesh that events add up to."""
    mesh = next(event for event in events if isinstance(event, bsm.ConnectivityEvent))
    positions = np.full((mesh.vertices, 3), np.nan)
    positions[mesh.loose.vertices] = mesh.loose.positions
    for event in events:
        if isinstance(event, bsm.BlockEvent | bsm.RefinementEvent):
            positions[event.vertices] = event.positions
    return bsm.TriangleMesh(positions, mesh.faces)


def offset_of(data: bytes, kind: FrameType, which: int) -> int:
    """Where frame number `which` of a type begins."""
    return [span.offset for span in spans_of(data) if span.type == kind][which]


def broken(data: bytes, kind: FrameType, which: int) -> bytes:
    """With a bit of a frame's payload flipped."""
    place = offset_of(data, kind, which) + 8
    return data[:place] + bytes([data[place] ^ 4]) + data[place + 1 :]


@pytest.mark.parametrize(
    "data",
    [REFINED, GRID, bsm.encode(soup(torus(7, 6)), bsm.EncodeOptions(grid=8, keep_order=True))],
)
def test_events_add_up_to_the_mesh(data: bytes) -> None:
    whole, pieces = bsm.decode(data), shown(events_of(data))
    assert np.array_equal(whole.faces, pieces.faces)
    assert np.abs(whole.positions - pieces.positions).max() < 1e-12


def test_the_base_comes_first() -> None:
    events = events_of(REFINED)
    kinds = [type(event) for event in events]
    assert kinds.index(bsm.RefinementEvent) > max(
        i for i, kind in enumerate(kinds) if kind is bsm.BlockEvent
    )
    refinements = [event for event in events if isinstance(event, bsm.RefinementEvent)]
    assert [(event.layer, len(event.vertices)) for event in refinements] == [(1, 50), (1, 120)]
    assert all(event.layer == 0 for event in events if isinstance(event, bsm.BlockEvent))


def test_the_layer_can_be_left_out() -> None:
    blocks = base(MESH).draft.decoded
    with bsm.Decoder(layers=1) as decoder:
        decoder.receive_data(REFINED)
        assert np.abs(decoder.decode_rest().positions - blocks).max() < 1e-12
    original = base(MESH).prepared.mesh.positions
    errors = []
    for layers in (1, 2, None):
        with bsm.Decoder(layers=layers) as decoder:
            decoder.receive_data(REFINED)
            errors.append(np.abs(decoder.decode_rest().positions - original).max())
    assert errors[0] > errors[1] == errors[2]
    with pytest.raises(bsm.OptionError):
        bsm.Decoder(layers=0)


def test_a_stream_cut_behind_the_base_is_the_base_for_who_wants_no_more() -> None:
    cut = REFINED[: offset_of(REFINED, FrameType.REFINEMENT, 0)]
    with bsm.Decoder(layers=1) as decoder:
        decoder.receive_data(cut)
        assert np.abs(decoder.decode_rest().positions - base(MESH).draft.decoded).max() < 1e-12
    with pytest.raises(bsm.TruncatedError):
        bsm.decode(cut)
    tolerant = events_of(cut, tolerant=True)
    assert np.abs(shown(tolerant).positions - base(MESH).draft.decoded).max() < 1e-12
    assert isinstance(tolerant[-1], bsm.EndEvent)


@pytest.mark.parametrize(("which", "lost"), [(0, 120), (1, 120)])
def test_a_lost_refinement_costs_only_refinement(which: int, lost: int) -> None:
    events = events_of(broken(REFINED, FrameType.REFINEMENT, which), tolerant=True)
    losses = events[-1].losses
    assert any(isinstance(event, bsm.LossEvent) for event in events)
    assert len(losses.missing) == 0
    assert len(losses.degraded) in (0, lost)  # none where nothing of the layer came
    assert np.isfinite(shown(events).positions).all()


def test_a_lost_block_leaves_what_is_far_from_it_refined() -> None:
    mesh = torus(40, 24)
    data = refined(mesh, LAYER, (960,))
    events = events_of(broken(data, FrameType.BLOCK, 31), tolerant=True)
    refinement = next(event for event in events if isinstance(event, bsm.RefinementEvent))
    assert 0 < len(refinement.vertices) < 960
    whole = bsm.decode(data).positions
    assert (
        np.abs(refinement.positions - whole[refinement.vertices]).max() < 0.05 * np.abs(whole).max()
    )


def test_a_lost_chunk_of_a_grid_costs_those_behind_it() -> None:
    events = events_of(broken(GRID, FrameType.GRID, 1), tolerant=True)
    assert len(events[-1].losses.missing) == 26
    assert sum(len(event.vertices) for event in events if isinstance(event, bsm.BlockEvent)) == 30
