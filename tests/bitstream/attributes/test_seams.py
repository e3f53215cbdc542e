"""Seams of attributes: what they cost."""

import numpy as np

from bsm.bitstream.attributes.seams import encode_seams, find_seams
from bsm.bitstream.fields.corners import corners_of


def test_seams_of_an_attribute_before_cost_next_to_nothing():
    random = np.random.default_rng(3)
    faces = np.array([[i, i + 1, i + 2] for i in range(2000)])
    corners = corners_of(faces, 2002)
    seams = find_seams(corners, random.integers(0, 2, faces.shape))
    alone, known = encode_seams(corners, seams), encode_seams(corners, seams, (seams,))
    assert len(known) < len(alone) / 8
