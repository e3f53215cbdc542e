"""Small meshes on grids take one frame, if the stream may be of 1.1."""

from dataclasses import replace

import numpy as np
import pytest

from bsm import Decoder, EncodeOptions, decode, encode
from bsm.bitstream.container.header import Header
from bsm.bitstream.container.packets import Connectivity, Grid, write_brief
from tests.refined import header_of
from tools.surgery import frames_of, is_brief, stream_of
from tools.vectors.good_attributes import charts, with_attributes
from tools.vectors.meshes import torus

MESH = torus(12, 9)


def test_a_small_mesh_takes_one_frame():
    small, usual = encode(MESH), encode(MESH, EncodeOptions(congruence=False))
    assert is_brief(small) and small[4] == 0x11
    assert header_of(small).congruence > 0, "congruent parts do not keep it from that"
    assert not is_brief(usual) and usual[4] == 0x10
    framing = len(small) - sum(len(payload) for _, payload in frames_of(small)[1:])
    assert framing <= 41, "two varints of GRID are counted with the payloads"


@pytest.mark.parametrize(
    ("mesh", "options"),
    [
        (with_attributes(MESH, charts), EncodeOptions()),
        (replace(MESH, metadata={"photograph": bytes(70_000)}), EncodeOptions()),
        (replace(MESH, metadata={f"tag {k}": k for k in range(257)}), EncodeOptions()),
        (MESH, EncodeOptions(keep_order=True)),
        (MESH, EncodeOptions(exact=True)),
        (MESH, EncodeOptions(grid=10)),
        (MESH, EncodeOptions(effort="quick")),
    ],
    ids=["attributes", "image", "tags", "order", "exact", "grid", "quick"],
)
def test_other_streams_keep_their_frames(mesh, options):
    assert not is_brief(encode(mesh, options))


def test_its_metadata_are_in_the_frame():
    metadata = {"author": "A. Bee", "icon": bytes(range(256)), "part": 7, "weight": 0.3}
    plain, named = encode(MESH), encode(replace(MESH, metadata=metadata))
    assert is_brief(named) and decode(named).metadata == metadata
    assert [kind for kind, _ in frames_of(named)] == [1, 2, 3, 12], "as long streams have them"
    data = sum(len(name) + 1 for name in metadata) + 7 + (256 + 3) + 1 + 9
    assert len(named) - len(plain) <= data + 8
    with Decoder() as decoder:
        for k in range(len(named)):
            decoder.receive_data(named[k : k + 1])
        assert decoder.decode_rest().metadata == metadata


def test_it_decodes_to_the_same_as_the_frames_for_which_it_stands():
    data = encode(MESH)
    one, other = decode(data), decode(stream_of(frames_of(data)))
    assert np.array_equal(one.positions, other.positions) and np.array_equal(one.faces, other.faces)


def test_doubles_and_long_payloads_need_frames():
    header = Header(vertices=3, faces=1, grid=(1, 1, 1), scale=0.5)
    body = (Connectivity(b"abc"), Grid(0, 3, b"d"))
    assert write_brief(header, body) is not None
    assert write_brief(replace(header, scale=0.1), body) is None
    assert write_brief(replace(header, center=(0.0, 1e200, 0.0)), body) is None
    assert write_brief(header, (body[0], Grid(0, 2, b"d"), Grid(2, 1, b"e"))) is None
    assert write_brief(header, (Connectivity(bytes(60_000)), body[1])) is None
