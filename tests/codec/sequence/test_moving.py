"""Attributes that move: every value in every frame is as near as is asked, whatever the way of the frames."""

from collections.abc import Sequence
from dataclasses import replace
from operator import attrgetter

import numpy as np
import pytest

from bsm import (
    Attribute,
    CorruptError,
    FrameEvent,
    MeshError,
    OptionError,
    SequenceEncoder,
    SequenceOptions,
    TriangleMesh,
)
from bsm.bitstream.container import packets
from tests.shapes import torus
from tests.streams import frames_in, moving_events_of, packets_of, without

MESH = torus(24, 12)
kind_of = attrgetter("values.dtype", "domain", "semantic")


def with_attributes(t: int, mesh: TriangleMesh = MESH) -> TriangleMesh:
    positions = mesh.positions * [1, 1, 1 + 0.1 * np.sin(0.5 * t)]
    color = (128 + 120 * np.sin(2 * mesh.positions + 0.4 * t)).astype(np.uint8)
    velocity = np.stack([np.cos(0.3 * t) * mesh.positions[:, 0], mesh.positions[:, 1]], axis=1)
    attributes = (
        Attribute("color", color, "vertex", "color"),
        Attribute("part", np.arange(len(mesh.positions)) // 40),
        Attribute("heat", 300.0 + np.sin(2 * mesh.positions[:, 0] + 0.2 * t)),
        Attribute("velocity", velocity.astype(np.float32)),
    )
    return TriangleMesh(positions, mesh.faces, attributes)


FRAMES = [with_attributes(t) for t in range(9)]


def extent(name: str) -> float:
    """The range of an attribute's values in all frames."""
    values = np.concatenate(
        [a.values for frame in FRAMES for a in frame.attributes if a.name == name]
    )
    return float(np.ptp(values.astype(float), axis=0).max())


def encoded(frames: Sequence[TriangleMesh], **options: object) -> tuple[bytes, SequenceEncoder]:
    chosen = SequenceOptions(**{"step": 0.01, "threads": 1, "block_size": 100, **options})
    encoder = SequenceEncoder(frames[0].faces, chosen, len(frames))
    return b"".join(encoder.chunks(frames)), encoder


def decoded(data: bytes, **options: object) -> list[FrameEvent]:
    return list(frames_in(moving_events_of(data, **options)).values())


def errors(
    frames: Sequence[TriangleMesh], encoder: SequenceEncoder, found: Sequence[FrameEvent]
) -> dict[str, float]:
    """How far any value is off, by attribute."""
    assert len(frames) == len(found)
    worst: dict[str, float] = {}
    for given, event in zip(frames, found, strict=True):
        own = {attribute.name: attribute for attribute in event.attributes}
        assert set(own) == {attribute.name for attribute in given.attributes}
        for attribute in given.attributes:
            back = own[attribute.name]
            assert kind_of(back) == kind_of(attribute)
            wanted = attribute.values[encoder.vertex_order].astype(float)
            off = np.abs(back.values - wanted)
            worst[attribute.name] = max(worst.get(attribute.name, 0.0), float(off.max()))
            mean = f"{attribute.name} rms"
            worst[mean] = max(worst.get(mean, 0.0), float(np.sqrt(np.square(off).mean())))
    return worst


@pytest.mark.parametrize(
    "options",
    [
        {},
        {"gop": 4},
        {"low_delay": 1, "gop": 5},
        {"low_delay": 3},
        {"keep_order": True},
        {"gop": 1},
        {"runs": True},
    ],
    ids=str,
)
def test_values_keep_their_bounds(options: dict[str, object]) -> None:
    data, encoder = encoded(FRAMES, **options)
    off = errors(FRAMES, encoder, decoded(data))
    assert off["part"] == 0.0
    assert off["color rms"] <= 0.01 * extent("color") and off["color"] <= 0.1 * extent("color")
    assert max(off[f"{name} rms"] / extent(name) for name in ("heat", "velocity")) <= 0.0025
    assert any(note.startswith("color: per vertex, moves, within") for note in encoder.notes)


def test_values_are_as_near_as_is_asked() -> None:
    asked = {"color": "exact", "heat": "0.001", "velocity": "10bits", "part": "1%rms"}
    data, encoder = encoded(FRAMES, attributes=asked)
    off = errors(FRAMES, encoder, decoded(data))
    assert (
        off["color"] == 0.0
        and off["heat"] <= 0.001
        and off["velocity"] <= extent("velocity") / 1023 / 2
    )
    assert len(data) > len(encoded(FRAMES)[0])


def test_what_stays_costs_next_to_nothing() -> None:
    still = [replace(frame, attributes=FRAMES[0].attributes) for frame in FRAMES]
    bare = [replace(frame, attributes=()) for frame in FRAMES]
    for options in ({}, {"gop": 3}, {"low_delay": 1}):
        few, many = (encoded(still[:count], **options)[0] for count in (4, 9))
        less, more = (encoded(bare[:count], **options)[0] for count in (4, 9))
        assert abs((len(many) - len(more)) - (len(few) - len(less))) <= 8
        data, encoder = encoded(still, **options)
        assert errors(still, encoder, decoded(data))["color"] == 0.0


@pytest.mark.parametrize("options", [{"gop": 3}, {"low_delay": 1}], ids=str)
def test_an_attribute_may_begin_to_move_later_and_stop(options: dict[str, object]) -> None:
    shown = [0, 0, 0, 0, 4, 5, 6, 6, 6, 6]
    frames = [
        replace(with_attributes(t), attributes=with_attributes(k).attributes)
        for t, k in enumerate(shown)
    ]
    data, encoder = encoded(frames, **options)
    off = errors(frames, encoder, decoded(data))
    assert off["color rms"] <= 0.01 * extent("color") and off["heat rms"] <= 0.0025 * extent("heat")


def test_frames_can_be_had_from_any_on() -> None:
    for options in ({"gop": 3}, {"low_delay": 1, "gop": 4}):
        data, _ = encoded(FRAMES, **options)
        every, some = decoded(data), decoded(data, start=5)
        assert [event.index for event in some] == [5, 6, 7, 8]
        for frame, other in zip(every[5:], some, strict=True):
            for own, same in zip(frame.attributes, other.attributes, strict=True):
                np.testing.assert_array_equal(own.values, same.values)


@pytest.mark.parametrize("kind", [packets.Values, packets.Declared])
def test_a_lost_attribute_costs_those_behind_it(kind: type) -> None:
    data, _ = encoded(FRAMES, gop=4)
    broken = without(data, kind, 1, "changed")
    whole, found = decoded(data), decoded(broken, tolerant=True)
    assert len(found) == len(whole)
    for frame, other in zip(whole, found, strict=True):
        np.testing.assert_array_equal(frame.positions, other.positions)
        own = {each.name: each.values for each in frame.attributes}
        assert [each.name for each in other.attributes] == ["color"]
        for each in other.attributes:
            np.testing.assert_array_equal(each.values, own[each.name])
    with pytest.raises(CorruptError):
        decoded(broken)


def test_runs_have_attributes_that_move() -> None:
    other = torus(18, 10)
    frames = [with_attributes(t, other if t in (2, 3) else MESH) for t in range(7)]
    data, encoder = encoded(frames, runs=True)
    found = decoded(data)
    assert encoder.run_starts == [0, 2, 4] and len(found) == 7
    for given, event in zip(frames, found, strict=True):
        color, own = given.attributes[0].values, event.attributes[0].values
        # No farther than in any other order.
        off = np.sort(color, axis=0).astype(float) - np.sort(own, axis=0)
        assert np.sqrt(np.square(off).mean()) <= 0.01 * extent("color")
    declared = packets_of(data, packets.Declared)
    assert len(declared) == 8  # the first mesh returns


def test_a_mesh_of_one_face_and_a_mesh_of_many_components() -> None:
    corner = TriangleMesh(np.eye(3), np.array([[0, 1, 2]]))
    # Where 31 meet, one counts.
    far = np.concatenate([corner.positions + 3 * k for k in (*range(20), *[9] * 30)])
    many = TriangleMesh(far, np.arange(len(far), dtype=np.int32).reshape(-1, 3))
    for mesh in (corner, many):
        heat = (mesh.positions @ (1, 2, 4)).astype(np.float32)
        frames = [replace(mesh, attributes=(Attribute("heat", t * heat),)) for t in range(4)]
        data, encoder = encoded(frames, keep_order=True)
        assert errors(frames, encoder, decoded(data))["heat"] <= 0.025 * 3 * np.ptp(heat)


def test_what_cannot_be_promised_is_refused() -> None:
    with pytest.raises(OptionError, match="cannot be kept exact: ask for a bound"):
        encoded(FRAMES, attributes={"heat": "exact"})
    late = [
        replace(with_attributes(t), attributes=with_attributes(max(0, t - 4)).attributes)
        for t in range(9)
    ]
    with pytest.raises(OptionError, match="floats that do cannot be exact"):
        encoded(late, gop=3, attributes={"heat": "exact"})
    vast = [
        replace(MESH, attributes=(Attribute("vast", np.full(len(MESH.positions), 1e200 * t)),))
        for t in range(3)
    ]
    with pytest.raises(OptionError, match="beyond 1e\\+100 cannot"):
        encoded(vast)
    with pytest.raises(MeshError, match="not finite"):
        Attribute("heat", np.array([np.nan, 1.0]))
