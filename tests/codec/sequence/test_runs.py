"""Sequences whose faces change: runs."""

from dataclasses import replace

import numpy as np
import pytest

import bsm
from bsm.bitstream.container.header import Header
from bsm.bitstream.container.packets import Connectivity, Gop
from bsm.bitstream.container.wire import FrameType, write_preamble
from tests.motion import capture as meshes
from tests.streams import frames_in, moving_events_of, packets_of
from tools.surgery import frames_of, spans_of

WAYS = [{"gop": 4}, {"low_delay": 1, "gop": 3}]
PIECES = ((10, 5), (7, 3), (10, 4), (5, 1), (7, 2))


def encoder_of(frames, **options):
    chosen = bsm.SequenceOptions(
        **{"step": 0.003, "block_size": 30, "threads": 1, "runs": True, **options}
    )
    return bsm.SequenceEncoder(frames[0].faces, chosen, len(frames))


def encoded(frames, **options):
    return b"".join(encoder_of(frames, **options).chunks(frames))


def restored(frames, **options):
    """What comes back of each frame as it is decoded, and its distance to the original."""
    encoder, found = encoder_of(frames, **options), []
    with bsm.SequenceDecoder(threads=1) as decoder:
        for chunk in encoder.chunks(frames):
            decoder.receive_data(chunk)
            while not isinstance(event := decoder.next_event(), bsm.Signal):
                if isinstance(event, bsm.FrameEvent):
                    own = frames[event.index]
                    faces = own.faces[encoder.face_order]
                    assert np.array_equal(
                        np.sort(encoder.vertex_order[event.faces]), np.sort(faces)
                    )
                    found.append(
                        np.abs(event.positions - own.positions[encoder.vertex_order]).max()
                    )
    return encoder, found


@pytest.mark.parametrize("way", WAYS)
def test_faces_change_and_return(way):
    frames = meshes(*PIECES)
    encoder, errors = restored(frames, **way)
    assert len(errors) == len(frames) and 0 < max(errors) < 0.1
    assert encoder.run_starts == [0, 5, 8, 12, 13]
    assert encoder.samples == sum(len(frame.positions) for frame in frames)


@pytest.mark.parametrize("way", WAYS)
def test_a_mesh_that_returns_is_not_sent_again(way):
    data = encoded(meshes(*PIECES), **way)
    headers = [packet for packet, *_ in packets_of(data, Header)]
    assert [header.run_number for header in headers] == [0, 1, 2, 3, 4]
    assert [header.mesh_of for header in headers] == [None, None, 0, None, 1]
    assert len(packets_of(data, Connectivity)) == 3
    assert all(header.frames == 15 for header in headers)
    gops = [packet.index for packet, *_ in packets_of(data, Gop)]
    assert gops[0] == 0 and sorted(gops) == gops and {5, 8, 12, 13} <= set(gops)


def test_a_promise_holds_in_every_run():
    frames = meshes((10, 3), (7, 2), (10, 2))
    _, errors = restored(frames, promise=bsm.Contract(0.004), gop=4)
    for error, frame in zip(errors, frames, strict=True):
        first = next(mesh for mesh in frames if len(mesh.positions) == len(frame.positions))
        assert error <= 0.004 * np.linalg.norm(np.ptp(first.positions, axis=0))


def test_a_target_is_for_frames_that_share_their_faces():
    with pytest.raises(bsm.OptionError, match="the faces change at frame 3"):
        encoded(meshes((10, 3), (7, 2)), target=bsm.SequenceTarget("kg", 0.5))
    same = meshes((10, 3))
    assert frames_in(moving_events_of(encoded(same, target=bsm.SequenceTarget("kg", 5.0))))
    faces, positions = (
        same[0].faces.copy(),
        np.concatenate([same[0].positions, same[0].positions[:10]]),
    )
    ours = faces[::2]  # a seam of joined vertices, which parts
    ours[ours < 10] += len(same[0].positions)
    apart = positions + 0.1 * (np.arange(len(positions)) >= len(same[0].positions))[:, None]
    parting = [bsm.TriangleMesh(places, faces) for places in (positions, positions, apart, apart)]
    with pytest.raises(bsm.MeshError, match="part at frame 2"):
        encoded(parting, target=bsm.SequenceTarget("kg", 0.5), gop=2)


# ---------------------------------------------------------------------------------------------------- loss and joining


def damaged(data, number):
    """The stream with a byte of a frame changed, and not of how long it is, which may lead to the end of any other."""
    span = list(spans_of(data))[number]
    last = span.offset + span.length - 1
    return data[:last] + bytes([data[last] ^ 0x55]) + data[last + 1 :]


@pytest.mark.parametrize("way", WAYS)
def test_loss_of_any_frame_stays_within_the_runs_of_one_mesh(way):
    data = encoded(meshes(*PIECES), **way)
    whole = frames_in(moving_events_of(data))
    mesh_of = [size for size, count in PIECES for _ in range(count)]
    frames = frames_of(data)
    runs = np.cumsum([kind == FrameType.HEADER for kind, _ in frames]) - 1
    for number in range(1, len(frames)):
        events = moving_events_of(damaged(data, number), tolerant=True)
        found = frames_in(events)
        lost = {
            k
            for event in events
            if isinstance(event, bsm.LossEvent) and event.frames
            for k in event.frames
        }
        assert found.keys() | lost == set(range(15)) and not found.keys() & lost
        assert all(np.array_equal(found[k].positions, whole[k].positions) for k in found)
        assert all(np.array_equal(found[k].faces, whole[k].faces) for k in found)
        assert {mesh_of[k] for k in lost} <= {PIECES[runs[number]][0]}, number
        if frames[number][0] == FrameType.GOP:
            assert len(lost) <= 5


def test_a_first_run_that_is_lost_is_an_error_only_if_it_is_all():
    frames = meshes((10, 3), (7, 2))
    data = encoded(frames)
    found = frames_in(moving_events_of(damaged(data, 1), tolerant=True))
    assert list(found) == [3, 4]
    alone = encoded(frames[:3])
    with pytest.raises(bsm.CorruptError):
        moving_events_of(damaged(alone, 1), tolerant=True)


def test_late_joiners_begin_at_a_run_with_a_mesh():
    data = encoded(meshes(*PIECES), gop=4)
    whole = frames_in(moving_events_of(data))
    headers = [offset for packet, offset, _ in packets_of(data) if isinstance(packet, Header)]
    later = write_preamble() + data[headers[1] :]
    with pytest.raises(bsm.CorruptError, match="begins within a sequence"):
        moving_events_of(later)
    events = moving_events_of(later, tolerant=True)
    found = frames_in(events)
    assert list(found) == [5, 6, 7, 12, 13, 14]  # frames 8 to 11 have the mesh of run 0
    assert all(np.array_equal(found[k].positions, whole[k].positions) for k in found)
    lost = [event.frames for event in events if isinstance(event, bsm.LossEvent)]
    assert lost == [range(0, 5), range(8, 12)]


# ------------------------------------------------------------------------------------------------------------- charges


def test_what_meshes_take_does_not_grow_with_their_number():
    def kept(count):
        frames = meshes(*((3 + k % 40, 1) for k in range(count)))
        decoder = bsm.SequenceDecoder(threads=1)
        decoder.receive_data(encoded(frames, step=0.02))
        while not isinstance(decoder.next_event(), bsm.Signal):
            pass
        state = decoder._open.state()
        return state.memory, state.present

    (few, those), (many, these) = kept(40), kept(70)
    assert many < 1.5 * few and these < 1.5 * those


# --------------------------------------------------------------------------------------------------- any kind of frame


def test_unwelded_frames_of_many_components_and_flat_ones():
    rng = np.random.default_rng(3)
    soup = np.arange(60, dtype=np.int32).reshape(20, 3)
    points = rng.normal(size=(60, 3))
    tetra = bsm.TriangleMesh(rng.normal(size=(4, 3)), [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]])
    flat = replace(tetra, positions=np.zeros((4, 3)))
    twice = bsm.TriangleMesh(rng.normal(size=(5, 3)), [[0, 1, 2], [0, 1, 2], [2, 1, 0], [0, 0, 3]])
    frames = [
        bsm.TriangleMesh(points, soup),
        bsm.TriangleMesh(points * 1.1, soup),
        tetra,
        flat,
        twice,
        replace(twice, positions=twice.positions + 5.0),
        bsm.TriangleMesh(points[::-1], soup),
    ]
    encoder, errors = restored(frames)
    assert len(errors) == len(frames) and max(errors) < 0.1
    assert encoder.run_starts == [0, 2, 4, 6]


def test_attributes_of_faces_that_change_in_a_run_are_reported() -> None:
    frames = meshes((10, 4))
    heats = [np.float32(t // 2) + np.zeros(len(frames[0].faces), np.float32) for t in range(4)]
    hot = [
        replace(f, attributes=(bsm.Attribute("heat", heat, "face"),))
        for f, heat in zip(frames, heats, strict=True)
    ]
    steady = [
        replace(frame, attributes=(bsm.Attribute("heat", heats[0], "face"),)) for frame in frames
    ]
    options = bsm.SequenceOptions(step=0.003, block_size=30, threads=1, runs=True)
    for given, notes in ((hot, ["heat changes at frame 2, but stays as before"]), (steady, [])):
        encoder = bsm.SequenceEncoder(frames[0].faces, options, 4, attributes=given[0].attributes)
        assert b"".join(encoder.chunks(given))
        assert [note for note in encoder.notes if "changes" in note] == notes


@pytest.mark.parametrize(
    ("far", "said"), [(np.nan, "a number that is not finite"), (1e7, "diagonals from the first")]
)
def test_a_vertex_that_flies_off_is_named(far: float, said: str) -> None:
    frames = meshes((7, 4))
    positions = frames[2].positions.copy()
    positions[5, 1] = far
    given = [frame.positions for frame in frames]
    given[2] = positions
    with pytest.raises(bsm.MeshError, match=f"vertex 5 of frame 2 .*{said}"):
        bsm.encode_sequence(given, frames[0].faces, threads=1)


@pytest.mark.parametrize("name", ["none", "lossless", "grid14", "paper"])
def test_presets_that_sequences_lack_are_refused_with_the_reason(name: str) -> None:
    frames = meshes((7, 2))
    with pytest.raises(bsm.OptionError, match=f"cannot have preset {name}: .* try near-lossless"):
        bsm.encode_sequence([frame.positions for frame in frames], frames[0].faces, preset=name)
