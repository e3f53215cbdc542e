"""Tolerant decoders: what damage costs, and what is never paid twice."""

import ctypes
from ctypes import byref
from time import process_time

from tests.engine.decoding import Event, Limits, Options, decode
from tools.amalgamate import ROOT

NEED_DATA, MOST_WORK, SECOND_BLOCK = 0, 16, 72
FEW_BYTES = bytes.fromhex(
    "8942534d10f1028501ce0002014e02ce0004029c03ce00020000040805019c7bb301a709b6b2f3bd670685dec1877c5f02dd9792d28e08"
)
"""131,406 vertices in 131,072 blocks, none of which comes."""


def test_many_losses_take_no_more_time_than_vertices_may(library: ctypes.CDLL) -> None:
    start = process_time()
    found = decode(library, FEW_BYTES, tolerant=True)
    assert found.losses == 131_072
    assert process_time() - start < 1 + 40e-6 * len(found.arrays["positions"])


def test_looking_at_a_place_again_costs_nothing(library: ctypes.CDLL) -> None:
    """Behind a damaged BLOCK of 1 byte stands a tag of one of 320, for whose rest the search waits."""
    stream = (ROOT / "spec/vectors/1.0/good-keys.bsm").read_bytes()[:SECOND_BLOCK] + b"\x16\x86\x28\0\x80\0"
    limits, event = Limits(), Event()
    library.bsmdec_default_limits(byref(limits), ctypes.sizeof(limits))
    limits.bounds[MOST_WORK] = 1e9
    decoder = library.bsmdec_open(byref(Options(ctypes.addressof(limits), tolerant=True)))
    library.bsmdec_push(decoder, stream, len(stream))
    while library.bsmdec_next(decoder, byref(event)) == 0 and event.type != NEED_DATA:
        pass
    assert {library.bsmdec_next(decoder, byref(event)) for _ in range(1000)} == {0}
    assert event.type == NEED_DATA
    library.bsmdec_close(decoder)
