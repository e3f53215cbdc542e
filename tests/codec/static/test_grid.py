"""Positions on a grid, frame by frame."""

import pytest

import bsm
from bsm.codec.static.ways.grid import CHUNK, FIRST
from tests.shapes import torus


@pytest.mark.parametrize("rows, sizes", [(40, [960]), (200, [FIRST, 704]), (600, [FIRST, CHUNK, 2112])])
def test_frames_are_small_the_first_most_of_all(rows: int, sizes: list[int]) -> None:
    decoder, found = bsm.Decoder(), []
    decoder.receive_data(bsm.encode(torus(rows), preset="grid14"))
    while isinstance(event := decoder.next_event(), bsm.HeaderEvent | bsm.ConnectivityEvent | bsm.BlockEvent):
        if isinstance(event, bsm.BlockEvent):
            found.append(len(event.vertices))
    assert found == sizes
