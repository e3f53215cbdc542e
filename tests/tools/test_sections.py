"""Streams in sections that are put together without the encoder."""

from random import Random

import numpy as np
import pytest

from bsm.bitstream.connectivity.faces import encode_connectivity
from bsm.bitstream.container.wire import FrameType
from bsm.codec.static.decoder import decode
from tools.attack.decoding import whole
from tools.attack.shard import reference, steady
from tools.attack.tally import Tally
from tools.sections import random_sections
from tools.surgery import first_entries, frames_of, stream_of
from tools.vectors.good_sections import small_sections, uneven
from tools.vectors.meshes import tangled, torus

SECTIONS = 41
"""Header key."""


def test_what_is_put_together_decodes_to_the_faces_that_were_given():
    faces = uneven()
    stream = stream_of(small_sections(faces, [40, 100], [2, 1, 2], block_size=60))
    assert first_entries(stream)[SECTIONS] == [40, 2, 60, 1]
    assert [kind for kind, _ in frames_of(stream)].count(FrameType.CONNECTIVITY) == 3
    assert np.array_equal(decode(stream).faces, encode_connectivity(faces, 108).faces)


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_random_streams_follow_from_their_seed_and_mean_the_same_to_both_decoders():
    decoded = 0
    for seed in range(12):
        stream = random_sections(Random(seed), torus(9, 7))
        assert stream == random_sections(Random(seed), torus(9, 7))
        if stream is not None:
            outcome = whole(stream)
            assert Tally().hold(stream, outcome, reference(stream)) is None or not steady(stream)
            decoded += not isinstance(outcome, Exception)
    assert decoded > 5


def test_a_mesh_that_is_sewn_together_cannot_be_cut():
    assert random_sections(Random(1), tangled()) is None
