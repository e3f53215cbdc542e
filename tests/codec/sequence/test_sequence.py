"""Sequences: errors, sizes, memory, losses and targets; attributes that are the same in all frames cost once."""

import math
from itertools import pairwise

import numpy as np
import pytest

import bsm
from bsm import encode_sequence
from bsm.bitstream.container.packets import Gop
from bsm.bitstream.limits import NAMED_LIMITS
from bsm.codec.sequence import run_encoding
from bsm.codec.sequence.targets import compare_sequences
from tests.motion import bending, turning
from tests.shapes import patch, tetrahedron, together, torus
from tests.streams import all_events, frames_in, moving_events_of, packets_of, peak_of, without

SMALL = {"block_size": 100, "step": 0.002, "gop": 8}
WAYS: list[dict[str, int]] = [{}, {"low_delay": 1}, {"low_delay": 3}]


def options(**changes):
    return bsm.SequenceOptions(**{**SMALL, **changes})


def encoded(positions, faces, **changes):
    """The stream, and the frames in the decoder's order of vertices."""
    encoder = bsm.SequenceEncoder(faces, options(**changes), len(positions))
    data = b"".join(encoder.chunks(positions))
    return data, positions[:, encoder.vertex_order]


def diagonal(frame):
    return float(np.linalg.norm(np.ptp(frame, axis=0)))


@pytest.mark.parametrize("way", WAYS)
def test_the_error_is_within_what_quantization_allows(way):
    positions, faces = bending(20)
    data, original = encoded(positions, faces, **way)
    decoded, decoded_faces = bsm.decode_sequence(data)
    assert decoded.shape == original.shape and decoded_faces.shape == faces.shape
    error = np.linalg.norm(decoded - original)
    # Every coefficient is off by 0.6 steps at the most; a learnt basis leaves a little of the motion out as well.
    bound = 0.6 * SMALL["step"] * diagonal(positions[0]) * math.sqrt(original.size)
    assert error <= bound * (1.05 if way else 2.0)


def test_rigid_motion_costs_little_more_than_its_basis():
    positions, faces = turning(40)
    data, original = encoded(positions, faces, gop=40)
    static = len(encoded(positions[:1], faces)[0])
    assert compare_sequences(original, bsm.decode_sequence(data)[0], faces).kg < 0.2
    # 12 numbers move it, and a frame of it alone takes a thousand bytes.
    assert len(data) - static < 40 * 12 * 3


@pytest.mark.parametrize("way", [*WAYS, {"low_delay": 1, "promise": bsm.Contract(0.002)}])
def test_chunks_come_as_frames_do(way):
    positions, faces = bending(10)
    given = []

    def source():
        for frame in positions:
            given.append(frame)
            yield frame

    chunks = bsm.SequenceEncoder(faces, options(gop=4, **way)).chunks(source())
    seen = [len(given) for chunk in chunks if chunk[0] & 15 == 7]
    held = way.get("low_delay", 4)
    assert list(dict.fromkeys(seen)) == [*range(held, 10, held), 10]


@pytest.mark.parametrize("way", [{}, {"low_delay": 1}])
def test_memory_does_not_grow_with_the_number_of_frames(way):
    positions, faces = bending(8, 18, 10)

    def frames(count):
        for number in range(count):
            yield positions[number % 8]

    def encode_all(count):
        for _ in bsm.SequenceEncoder(faces, options(step=0.01, threads=1, **way)).chunks(
            frames(count)
        ):
            pass

    def decode_all(count):
        decoder = bsm.SequenceDecoder(threads=1)
        chunks = bsm.SequenceEncoder(faces, options(step=0.01, threads=1, **way)).chunks(
            frames(count)
        )
        while (event := decoder.next_event()) is not bsm.END_OF_STREAM:
            if event is bsm.NEED_DATA:
                chunk = next(chunks, b"")
                decoder.receive_data(chunk) if chunk else decoder.receive_eof()

    for work in (encode_all, decode_all):
        work(8)
        short, long = peak_of(lambda: work(16)), peak_of(lambda: work(40))  # noqa: B023  (called at once)
        assert long < short + 8 * positions[0].nbytes, "a third of what the frames would take"


@pytest.mark.parametrize("together", [1, 2])
def test_frames_that_return_cost_next_to_nothing(together):
    positions, faces = bending(12)
    data, original = encoded(
        np.concatenate([positions, positions]), faces, low_delay=together, gop=24
    )
    sizes = np.array([size for _, _, size in packets_of(data, Gop)])
    half = len(sizes) // 2
    assert sizes[half + 1 :].sum() < 0.3 * sizes[1:half].sum()
    assert np.abs(bsm.decode_sequence(data)[0] - original).max() < 0.02


@pytest.mark.parametrize("way", [{}, *WAYS])
def test_frames_that_do_not_move_cost_next_to_nothing(way):
    mesh = torus(30, 16)
    still = np.repeat(mesh.positions[None], 16, axis=0)
    data, original = encoded(still, mesh.faces, gop=16, **way)
    assert np.abs(bsm.decode_sequence(data)[0] - original).max() < 0.01
    assert len(data) - len(encoded(still[:1], mesh.faces)[0]) < 1000


@pytest.mark.parametrize(
    "mesh",
    [tetrahedron(), together(tetrahedron(), patch(5, 4), torus(12, 8)), patch(2, 2)],
    ids=["one", "many", "two"],
)
@pytest.mark.parametrize("way", WAYS)
def test_odd_meshes(mesh, way):
    positions = np.array([mesh.positions * (1 + 0.1 * t) for t in range(5)])
    data, original = encoded(positions, mesh.faces, block_size=20, **way)
    assert np.abs(bsm.decode_sequence(data)[0] - original).max() < 0.02 * diagonal(original[0])


@pytest.mark.parametrize("way", WAYS)
def test_motion_far_beyond_the_first_frame(way):
    positions, faces = bending(8)
    positions = positions + 300.0 * np.arange(8)[:, None, None]
    data, original = encoded(positions, faces, **way)
    assert np.abs(bsm.decode_sequence(data)[0] - original).max() < 0.05
    with pytest.raises(bsm.OptionError, match="too fine"):
        encode_sequence(
            positions * [1e4, 1, 1] + 1e6, faces, options(step=2e-6, first_step=0.001, **way)
        )


@pytest.mark.parametrize("how", ["removed", "changed"])
@pytest.mark.parametrize(("index", "behind"), [(0, 4), (1, 4), (3, 4), (4, 6), (5, 6)])
def test_a_lost_gop_costs_what_refers_to_it(how, index, behind):
    positions, faces = bending(45)
    data, _ = encoded(positions, faces)
    assert [gop.data[0] for gop, *_ in packets_of(data, Gop)] == [0, 3, 3, 3, 0, 3]
    events = moving_events_of(without(data, Gop, index, how), tolerant=True)
    lost = [event for event in events if isinstance(event, bsm.LossEvent)]
    missing = range(8 * index, min(8 * behind, 45))
    assert [frame for event in lost for frame in event.frames] == list(missing) and lost[
        0
    ].error.message
    assert_same(frames_in(events), bsm.decode_sequence(data)[0], set(range(45)) - set(missing))
    assert isinstance(events[-1], bsm.EndEvent)
    with pytest.raises(bsm.CorruptError):
        bsm.decode_sequence(without(data, Gop, index, how))


@pytest.mark.parametrize("how", ["removed", "changed"])
def test_a_lost_frame_costs_what_refers_to_it(how):
    positions, faces = bending(20)
    data, _ = encoded(positions, faces, low_delay=1)
    events = moving_events_of(without(data, Gop, 5, how), tolerant=True)
    # Frames 5, 6 and 7 of 8.
    assert sum(len(event.frames) for event in events if isinstance(event, bsm.LossEvent)) == 3
    assert_same(frames_in(events), bsm.decode_sequence(data)[0], set(range(20)) - {5, 6, 7})


def test_losses_at_the_end_of_a_sequence_of_unknown_length():
    positions, faces = bending(16)
    data = b"".join(bsm.SequenceEncoder(faces, options()).chunks(positions))
    events = moving_events_of(without(data, Gop, 1, "changed"), tolerant=True)
    assert [(e.frames.start, len(e.frames)) for e in events if isinstance(e, bsm.LossEvent)] == [
        (8, 0)
    ]


def test_the_beginning_must_be_whole():
    positions, faces = bending(4)
    data, _ = encoded(positions, faces)
    for offset in (40, 700, packets_of(data, Gop)[0][1] - 30):
        broken = bytearray(data)
        broken[offset] ^= 0xFF
        with pytest.raises(bsm.BsmError):
            moving_events_of(bytes(broken), tolerant=True)


def test_a_frame_of_another_shape_or_not_finite_is_named():
    positions, faces = bending(5)
    with pytest.raises(bsm.MeshError, match="frame 3 "):
        list(bsm.SequenceEncoder(faces, options()).chunks([*positions[:3], positions[3][:-1]]))
    positions[2, 7, 1] = np.nan
    with pytest.raises(bsm.MeshError, match="frame 2 "):
        encode_sequence(positions, faces, options())
    for wrong in (positions[:0], positions[0]):
        with pytest.raises(bsm.MeshError):
            encode_sequence(wrong, faces, options())
    for announced in (4, 6, 7):
        with pytest.raises(bsm.OptionError, match="announced"):
            list(bsm.SequenceEncoder(faces, options(), announced).chunks(bending(5)[0]))


@pytest.mark.parametrize(
    ("kind", "value"), [("kg", 0.2), ("theta_deg", 1.0), ("nmsve_db", -45.0), ("bpvf", 1.0)]
)
def test_targets(kind, value):
    positions, faces = bending(12)
    target = bsm.SequenceTarget(kind, value)
    encoder = bsm.SequenceEncoder(faces, options(target=target), len(positions))
    data = b"".join(encoder.chunks(positions))
    assert encoder.notes == ()
    decoded, decoded_faces = bsm.decode_sequence(data)
    comparison = compare_sequences(positions[:, encoder.vertex_order], decoded, decoded_faces)
    reached = 8 * len(data) / decoded[..., 0].size if kind == "bpvf" else getattr(comparison, kind)
    assert value - (0.2 if kind == "nmsve_db" else 0.05 * value) <= reached <= value


def test_a_target_that_cannot_be_met_is_an_error():
    positions, faces = bending(3)
    encoder = bsm.SequenceEncoder(
        faces, options(target=bsm.SequenceTarget("bpvf", 0.01)), len(positions)
    )
    with pytest.raises(
        bsm.TargetError, match=r"0\.01 bits per vertex and frame at most cannot be reached"
    ):
        list(encoder.chunks(positions))
    for kind, value in (("size", 3.0), ("kg", 0.0), ("bpvf", math.inf)):
        with pytest.raises(bsm.OptionError):
            options(target=bsm.SequenceTarget(kind, value))


def test_limits():
    positions, faces = bending(12)
    data, _ = encoded(positions, faces)
    bsm.decode_sequence(data, limits=bsm.Limits(gop_frames=8, frames=12))
    for limit in ({"gop_frames": 7}, {"frames": 11}, {"sequence_bytes": 1e5}, {"vertices": 100}):
        with pytest.raises(bsm.LimitError):
            bsm.decode_sequence(data, limits=bsm.Limits(**limit))


@pytest.mark.slow
@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("threads", [1, 3])
def test_dictionaries_without_room_are_made_for_every_gop(way, threads):
    data, _ = encoded(*bending(16, 60, 32), **way)
    ample, _ = bsm.decode_sequence(data, threads=threads)
    np.testing.assert_array_equal(
        bsm.decode_sequence(data, limits=least_memory(data), threads=threads)[0], ample
    )


def memory_of(size):
    return bsm.Limits(memory=size, memory_per_vertex=0, memory_per_byte=0)


def least_memory(data):
    """Limits of so little memory that hardly anything is kept, but the stream is decoded."""
    for size in range(4_000_000, 16_000_000, 1_000_000):
        try:
            bsm.decode_sequence(data, limits=memory_of(size))
        except bsm.LimitError as error:
            assert "memory" in str(error)
        else:
            return memory_of(size)
    raise AssertionError("everything is refused")


def test_gops_end_earlier_where_decoders_lack_the_memory(monkeypatch):
    positions, faces = bending(32, 60, 32)
    # Many components.
    positions = positions + 1e-3 * np.random.default_rng(3).normal(size=positions.shape)
    short, _ = encoded(positions, faces, gop=8, step=1e-3)
    granted = least_memory(short)
    monkeypatch.setitem(NAMED_LIMITS, "default", lambda: granted)
    data, wanted = encoded(positions, faces, gop=32, step=1e-3)
    assert 1 < len(packets_of(data, Gop)) < 32
    decoded, _ = bsm.decode_sequence(data, limits=granted)
    np.testing.assert_allclose(decoded, wanted, atol=0.05)
    monkeypatch.setitem(NAMED_LIMITS, "default", lambda: memory_of(granted.memory - 3e6))
    with pytest.raises(bsm.OptionError, match="memory"):
        encoded(positions, faces, gop=32)


def shots(frames, *changes):
    """A torus that eight smooth waves bend, and eight others from each change on."""
    mesh, random = torus(30, 16), np.random.default_rng(9)
    moved = np.repeat(mesh.positions[None], frames, axis=0)
    for first, end in pairwise((0, *changes, frames)):
        directions, amplitudes = random.normal(size=(2, 8, 3))
        paces, phases = random.uniform(0.1, 0.5, (8, 1)), random.uniform(0.0, 6.0, (8, 1))
        fields = np.sin(3.0 * directions @ mesh.positions.T)[..., None] * amplitudes[:, None]
        moved[first:end] += 0.05 * np.einsum(
            "kt,kni->tni", np.sin(paces * np.arange(end - first) + phases), fields
        )
    return moved, mesh.faces


@pytest.mark.parametrize("changes", [(), (37,), (60,)])
def test_gops_begin_where_motion_changes(changes, monkeypatch):
    positions, faces = shots(96, *changes)
    data, wanted = encoded(positions, faces, gop=None, step=0.005)
    np.testing.assert_allclose(bsm.decode_sequence(data)[0], wanted, atol=0.05)
    assert [gop.index for gop, _, _ in packets_of(data, Gop)] == [0, *changes]
    monkeypatch.setattr(run_encoding, "lengths_of", lambda *_: [96])
    whole = len(encoded(positions, faces, gop=None, step=0.005)[0])
    assert len(data) < 0.95 * whole if changes else len(data) == whole
    for longest in (48, 24):  # motion that lasts takes more in shorter groups
        assert changes or len(encoded(positions, faces, gop=longest, step=0.005)[0]) > 1.1 * len(
            data
        )


def test_a_large_basis_is_the_decoders():
    positions, faces = bending(160)
    positions = positions + 2e-3 * np.random.default_rng(1).normal(size=positions.shape)
    data, wanted = encoded(positions, faces, gop=160, step=1e-3)
    np.testing.assert_allclose(bsm.decode_sequence(data)[0], wanted, atol=0.02)


def test_frames_that_are_shown_grant_work():
    data, _ = encoded(*bending(16), gop=16)
    with bsm.SequenceDecoder(bsm.Limits(work_per_byte=0)) as decoder:
        list(all_events(decoder, [data]))
        work = decoder.work
    per_vertex = 0.3 * work / (480 * 17)
    granted = bsm.Limits(work=0.71 * work, work_per_vertex=per_vertex, work_per_byte=0)
    assert len(bsm.decode_sequence(data, limits=granted)[0]) == 16
    with pytest.raises(bsm.LimitError, match="work"):
        bsm.decode_sequence(
            data,
            limits=bsm.Limits(work=0.71 * work, work_per_vertex=per_vertex / 2, work_per_byte=0),
        )


def assert_same(found, decoded, indices):
    assert set(found) == indices
    for index in indices:
        assert np.array_equal(found[index].positions, decoded[index])


MESH = torus(24, 16)
FRAMES = np.array([MESH.positions * [1, 1, 1 + 0.1 * k] for k in range(6)])


def with_attributes() -> tuple[bsm.Attribute, ...]:
    corners = MESH.positions[MESH.faces][:, :, :2] + (MESH.positions[MESH.faces][:, :1, 2:] > 0)
    return (
        bsm.Attribute(
            "color", (127 + 100 * np.sin(MESH.positions)).astype(np.uint8), "vertex", "color"
        ),
        bsm.Attribute("uv", corners.reshape(-1, 2).astype(np.float32), "corner", "texcoord"),
        bsm.Attribute("part", np.arange(len(MESH.faces)) // 100, "face"),
    )


def test_they_come_back_before_the_second_frame():
    options = bsm.SequenceOptions(keep_order=True, attributes={"uv": "12bits"})
    stream = encode_sequence(
        FRAMES, MESH.faces, options, metadata={"name": "spin"}, mesh_attributes=with_attributes()
    )
    with bsm.SequenceDecoder() as decoder:
        order = [type(event) for event in all_events(decoder, [stream])]
        found = {attribute.name: attribute for attribute in decoder.attributes}
    assert order.count(bsm.FrameEvent) == 6 and bsm.LossEvent not in order
    assert order.index(bsm.FrameEvent) > max(
        i for i, kind in enumerate(order) if kind is bsm.AttributeEvent
    )
    color, uv, part = with_attributes()
    assert (found["color"].values == color.values).all() and (
        found["part"].values == part.values
    ).all()
    wanted = uv.values[uv.indices]
    assert (
        np.abs(found["uv"].values[found["uv"].indices] - wanted).max()
        <= 0.51 * np.ptp(wanted) / 4095
    )
    positions, faces = bsm.decode_sequence(stream)
    assert positions.shape == FRAMES.shape and (faces == MESH.faces).all()


def test_normals_cannot_be_recomputed():
    normals = bsm.Attribute("normal", np.ones((len(MESH.positions), 3)), "vertex", "normal")
    chosen = bsm.SequenceOptions(attributes={"normal": "recompute"})
    with pytest.raises(bsm.OptionError, match="recomputed"):
        encode_sequence(FRAMES, MESH.faces, chosen, mesh_attributes=(normals,))
