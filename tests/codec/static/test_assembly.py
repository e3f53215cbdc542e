"""Blocks put together: averages of their copies."""

from __future__ import annotations

import numpy as np

from bsm.codec.static.ways.block_coder import DecodedBlock, blended


def block(index: int, vertices: list[int], x: list[float], weights: list[float]) -> DecodedBlock:
    positions = np.stack([np.array(x), np.zeros(len(x)), np.ones(len(x))], axis=1)
    return DecodedBlock(index, np.array(vertices, np.int32), positions, np.array(weights, np.float64))


FIRST, SECOND = block(0, [0, 1, 2], [0, 1, 2], [1, 1, 3]), block(1, [2, 3, 4], [6, 3, 4], [1, 2, 1])


def test_copies_are_averaged_by_their_weights() -> None:
    assert blended(5, [FIRST, SECOND])[:, 0].tolist() == [0, 1, 3, 3, 4]
