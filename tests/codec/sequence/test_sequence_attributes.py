"""Attributes that are the same in all frames cost once, and survive."""

import numpy as np
import pytest

import bsm
from bsm.api import encode_sequence
from tests.shapes import torus
from tests.streams import all_events

MESH = torus(24, 16)
FRAMES = np.array([MESH.positions * [1, 1, 1 + 0.1 * k] for k in range(6)])


def with_attributes() -> tuple[bsm.Attribute, ...]:
    corners = MESH.positions[MESH.faces][:, :, :2] + (MESH.positions[MESH.faces][:, :1, 2:] > 0)
    return (
        bsm.Attribute("color", (127 + 100 * np.sin(MESH.positions)).astype(np.uint8), "vertex", "color"),
        bsm.Attribute("uv", corners.reshape(-1, 2).astype(np.float32), "corner", "texcoord"),
        bsm.Attribute("part", np.arange(len(MESH.faces)) // 100, "face"),
    )


def test_they_come_back_before_the_second_frame():
    options = bsm.SequenceOptions(keep_order=True, attributes={"uv": "12bits"})
    stream = encode_sequence(FRAMES, MESH.faces, options, metadata={"name": "spin"}, mesh_attributes=with_attributes())
    with bsm.SequenceDecoder() as decoder:
        order = [type(event) for event in all_events(decoder, [stream])]
        found = {attribute.name: attribute for attribute in decoder.attributes}
    assert order.count(bsm.FrameEvent) == 6 and bsm.LossEvent not in order
    assert order.index(bsm.FrameEvent) > max(i for i, kind in enumerate(order) if kind is bsm.AttributeEvent)
    color, uv, part = with_attributes()
    assert (found["color"].values == color.values).all() and (found["part"].values == part.values).all()
    wanted = uv.values[uv.indices]
    assert np.abs(found["uv"].values[found["uv"].indices] - wanted).max() <= 0.51 * np.ptp(wanted) / 4095
    positions, faces = bsm.decode_sequence(stream)
    assert positions.shape == FRAMES.shape and (faces == MESH.faces).all()


def test_normals_cannot_be_recomputed():
    normals = bsm.Attribute("normal", np.ones((len(MESH.positions), 3)), "vertex", "normal")
    with pytest.raises(bsm.OptionError, match="recomputed"):
        encode_sequence(
            FRAMES, MESH.faces, bsm.SequenceOptions(attributes={"normal": "recompute"}), mesh_attributes=(normals,)
        )
