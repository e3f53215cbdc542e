"""Sequences of triangles that have vertices of their own."""

import numpy as np
import pytest

from bsm import (
    Attribute,
    AttributeEvent,
    HeaderEvent,
    MeshError,
    SequenceEncoder,
    SequenceOptions,
    decode_sequence,
)
from tests.streams import frames_in, moving_events_of
from tools.vectors.meshes import torus

FACES = torus(8, 6).faces
WAYS = [{"gop": 4}, {"low_delay": 1, "gop": 4}]


def moving(frames):
    return np.array(
        [torus(8, 6, phase=0.15 * t).positions * (1.0 + 0.01 * t) for t in range(frames)]
    )


def soup(frames):
    """With three vertices for each triangle."""
    return frames[:, FACES].reshape(len(frames), -1, 3)


OWN = np.arange(FACES.size).reshape(-1, 3)


def encoded(frames, faces, **options):
    chosen = SequenceOptions(**{"step": 0.003, "block_size": 30, "threads": 1, **options})
    encoder = SequenceEncoder(faces, chosen, len(frames))
    return encoder, b"".join(encoder.chunks(frames))


def runs_of(data):
    return [
        event.header.run_number
        for event in moving_events_of(data)
        if isinstance(event, HeaderEvent)
    ]


@pytest.mark.parametrize("way", WAYS)
def test_triangles_with_their_own_vertices_cost_what_joined_ones_do(way):
    frames = moving(6)
    encoder, data = encoded(soup(frames), OWN, **way)
    _, joined = encoded(frames, FACES, **way)
    assert len(data) == len(joined)
    assert any("merged" in note for note in encoder.notes)
    positions, faces = decode_sequence(data)
    assert np.abs(positions - soup(frames)[:, encoder.vertex_order]).max() < 0.05
    given = soup(frames)[0][OWN[encoder.face_order]].mean(axis=1)
    assert np.abs(positions[0][faces].mean(axis=1) - given).max() < 0.05


@pytest.mark.parametrize("way", WAYS)
def test_where_the_order_is_kept_they_come_back(way):
    mixed = np.random.default_rng(1).permutation(FACES.size)
    frames, own = soup(moving(6))[:, np.argsort(mixed)], mixed[OWN][::-1]
    encoder, data = encoded(frames, own, keep_order=True, **way)
    positions, faces = decode_sequence(data)
    assert np.array_equal(faces, own) and np.abs(positions - frames).max() < 0.05
    assert np.array_equal(encoder.vertex_order, np.arange(len(frames[0])))
    positions = positions[:, mixed]
    corners = positions[0][OWN].reshape(-1, 3)
    for vertex in range(FACES.max() + 1):
        assert len(np.unique(corners[FACES.reshape(-1) == vertex], axis=0)) == 1


def test_vertices_that_part_within_a_gop_are_never_one():
    frames = soup(moving(4))
    frames[2:, :3] += 0.4
    _, data = encoded(frames, OWN, gop=4, keep_order=True)
    assert runs_of(data) == [0]
    assert np.abs(decode_sequence(data)[0] - frames).max() < 0.05


@pytest.mark.parametrize("way", WAYS)
def test_where_vertices_part_later_another_run_begins(way):
    frames = soup(moving(8))
    frames[5:, :3] += 0.4
    _, data = encoded(frames, OWN, keep_order=True, **way)
    assert runs_of(data) == [0, 1]
    positions, faces = decode_sequence(data)
    assert np.array_equal(faces, OWN) and np.abs(positions - frames).max() < 0.05
    _, data = encoded(frames, OWN, runs=True, **way)
    found = frames_in(moving_events_of(data))
    assert [len(found[t].positions) for t in (4, 5)] == [48, 51]


@pytest.mark.parametrize("way", WAYS)
def test_where_faces_may_not_change_that_is_an_error_that_says_so(way):
    frames = soup(moving(8))
    frames[5:, :3] += 0.4
    with pytest.raises(MeshError, match=r"vertices \d+ and \d+ part at frame 5; with keep_order"):
        encoded(frames, OWN, **way)


def test_vertices_that_meet_in_the_first_frame_alone_are_several():
    frames = moving(3)
    frames[0, 1] = frames[0, 0]
    encoder, data = encoded(frames, FACES)
    positions, _ = decode_sequence(data)
    assert positions.shape == frames.shape
    assert np.abs(positions - frames[:, encoder.vertex_order]).max() < 0.05


def test_vertices_in_no_face_are_left_out_of_an_order_that_is_kept():
    frames = np.concatenate([soup(moving(3)), np.full((3, 2, 3), 0.25)], axis=1)
    encoder, data = encoded(frames, OWN, keep_order=True)
    assert decode_sequence(data)[0].shape == (3, FACES.size, 3)
    assert "left out 2 vertices that no face uses" in encoder.notes


def test_colors_of_copies_differ():
    frames = soup(moving(2))
    colors = np.repeat(np.arange(len(FACES), dtype=np.uint8), 3)[:, None] * np.array(
        [1, 2, 3], np.uint8
    )
    chosen = SequenceOptions(step=0.003, threads=1, keep_order=True, attributes={"colors": "exact"})
    carried = [Attribute("colors", colors, semantic="color")]
    encoder = SequenceEncoder(OWN, chosen, 2, attributes=carried)
    data = b"".join(encoder.chunks(frames))
    (event,) = [event for event in moving_events_of(data) if isinstance(event, AttributeEvent)]
    assert np.array_equal(event.values, colors)
