"""Streams on a grid that are put together without the encoder."""

import numpy as np
import pytest

from bsm import decode
from bsm.bitstream.connectivity.faces import encode_connectivity
from bsm.bitstream.container.header import HEADER_FIELDS
from bsm.bitstream.container.wire import FrameType
from tools.gridded import gridded
from tools.surgery import first_entries, frames_of, stream_of
from tools.vectors.meshes import torus

LIGHT = HEADER_FIELDS["light"].key


@pytest.mark.parametrize("light", [0, 1])
def test_what_is_put_together_decodes_to_the_values_that_were_given(light):
    faces = torus(6, 5).faces
    coded = encode_connectivity(faces, 30)
    values = np.random.default_rng(1).integers(0, 50, (30, 3), np.int32)
    stream = stream_of(gridded(coded, values, [10, 20], light=light))
    assert first_entries(stream).get(LIGHT, 0) == light
    assert [kind for kind, _ in frames_of(stream)].count(FrameType.GRID) == 2
    mesh = decode(stream)
    assert np.array_equal(mesh.faces, coded.faces)
    assert np.array_equal(mesh.positions, values)
