import numpy as np
import pytest

from bsm import Encoder, OptionError
from bsm.encoding.options import encode_options
from tests.blocks import blocks_of, chain_of
from tests.shapes import torus


def test_blocks_come_in_their_order():
    chain = chain_of(blocks_of(torus(10, 8), 4, 26))
    with pytest.raises(OptionError, match="not the next"):
        chain.begin(1)


def test_positions_that_do_not_fit_are_refused():
    chain = chain_of(blocks_of(torus(10, 8), 4, 26))
    vertices = chain.begin(0)[0]
    chain.dictionary(4)
    with pytest.raises(OptionError, match="fit"):
        chain.commit(4, np.zeros((len(vertices) + 1, 3)))


def test_prediction_saves_bits_and_error():
    mesh = torus(90, 60)
    options = {
        "block_size": 250,
        "overlap": 1.0,
        "keep": 0.12,
        "key_interval": 0,
        "step": 0.004,
        "threads": 1,
    }
    held = Encoder(mesh, encode_options(**options)).result()
    loose = Encoder(mesh, encode_options(**options, predict=False)).result()
    assert held.size < 0.9 * loose.size
    assert held.comparison.nmsve < loose.comparison.nmsve
