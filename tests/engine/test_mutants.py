"""A few mutants by the decoder of release 1.0 and by today's; `python -m tests.engine.mutants` takes any number."""

from tests.engine.decoding import released
from tests.engine.mutants import compare


def test_the_decoder_of_1_0_and_todays_agree_on_mutants() -> None:
    tally, found = compare(released(), 150, "test", tolerant=True)
    assert not found
    assert tally["status 4"] > 50
    assert tally["status 0"] > 0
