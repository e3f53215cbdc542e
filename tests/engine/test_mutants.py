"""A few mutants by the decoder in C and by Python's; `python -m tests.engine.mutants` takes any number."""

import ctypes

from tests.engine.mutants import compare


def test_both_decoders_agree_on_mutants(library: ctypes.CDLL) -> None:
    tally, found = compare(library, 150, "test", tolerant=True)
    assert not found
    assert tally["status 4"] > 50
    assert tally["status 0"] > 0
