"""Tolerant decoders: what damage costs, and what is never paid twice."""

import ctypes
from time import process_time

from tests.engine.decoding import decode

FEW_BYTES = bytes.fromhex(
    "8942534d10f1028501ce0002014e02ce0004029c03ce00020000040805019c7bb301a709b6b2f3bd670685dec1877c5f02dd9792d28e08"
)
"""131,406 vertices in 131,072 blocks, none of which comes."""


def test_many_losses_take_no_more_time_than_vertices_may(library: ctypes.CDLL) -> None:
    start = process_time()
    found = decode(library, FEW_BYTES, tolerant=True)
    assert found.losses == 131_072
    assert process_time() - start < 1 + 40e-6 * len(found.arrays["positions"])
