"""Meshes that come in sections: the first blocks are there before all faces, and the end is as it was."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
import pytest
from scipy.spatial import Delaunay

from bsm.bitstream.connectivity.faces import Cut, encode_connectivity
from bsm.bitstream.container.header import Header
from bsm.bitstream.container.packets import Block, Connectivity
from bsm.bitstream.container.reader import END_OF_STREAM, NEED_DATA, Reader, Signal
from bsm.bitstream.container.wire import FrameType, write_varint
from bsm.bitstream.errors import BsmError, CorruptError, LimitError, OptionError
from bsm.bitstream.limits import Limits
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.static.contract import Contract
from bsm.codec.static.decoder import Decoder, decode
from bsm.codec.static.encoder import Encoder, encode
from bsm.codec.static.events import BlockEvent, ConnectivityEvent, EndEvent, HeaderEvent, LossEvent, RefinementEvent
from bsm.codec.static.options import PRESETS, EncodeOptions
from bsm.codec.static.sections import MANY_VERTICES, choose_cuts, possible_cuts
from bsm.files.mesh import read_mesh
from tests.shapes import patch, tetrahedron, together, torus
from tools.surgery import frames_of, stream_of, with_header

SMALL = {"block_size": 150, "keep": 0.2, "step": 0.004, "threads": 1}
MESH = torus(48, 40)
OPTIONS = [
    {},
    {"key_interval": 2},
    {"smoothing": 2.0},
    {"key_interval": 1, "smoothing": 1.0},
    {"bits": 12, "step": None},
]
REFINED = {"step": None, "keep": None, "contract": Contract(0.002, 3.0), "block_size": 250}
FINE = torus(80, 60)
"""With `REFINED`, blocks and a layer of refinement."""


def encoded(mesh: TriangleMesh = MESH, sections: int = 2, **options: object) -> bytes:
    return encode(mesh, EncodeOptions(**{**SMALL, "sections": sections, **options}))


def irregular(vertices: int) -> TriangleMesh:
    """A wavy sheet of random triangles."""
    flat = np.random.default_rng(3).random((vertices, 2))
    heights = np.sin(6 * flat[:, :1]) * np.cos(5 * flat[:, 1:]) / 5
    return TriangleMesh(np.hstack([flat, heights]), Delaunay(flat).simplices.astype(np.int32))


def header_of(data: bytes) -> Header:
    reader = Reader()
    reader.receive_data(data)
    header = reader.next_packet()
    assert isinstance(header, Header)
    return header


def events_of(data: bytes, step: int | None = None, threads: int = 1, tolerant: bool = False) -> list:
    """All events, the bytes given in pieces of `step`."""

    def drain(decoder: Decoder) -> Iterator[object]:
        while (event := decoder.next_event()) is not NEED_DATA and event is not END_OF_STREAM:
            yield event

    events: list = []
    with Decoder(threads=threads, tolerant=tolerant) as decoder:
        for start in range(0, len(data), step or len(data)):
            decoder.receive_data(data[start : start + (step or len(data))])
            events.extend(drain(decoder))
        decoder.receive_eof()
        events.extend(drain(decoder))
    return events


def ends_of(data: bytes) -> list[tuple[object, int]]:
    """Each packet, and where its frame ends."""
    reader = Reader()
    reader.receive_data(data)
    found = []
    while not isinstance(packet := reader.next_packet(), Signal):
        found.append((packet, reader.last_frame.offset + reader.last_frame.length))
    return found


def damaged(data: bytes, number: int, how: str) -> bytes:
    """The stream with one frame removed or changed; frame 0 is the header."""
    ends = [5, *(end for _, end in ends_of(data))]
    start, end = ends[number : number + 2]
    if how == "removed":
        return data[:start] + data[end:]
    broken = bytearray(data)
    broken[(start + end) // 2] ^= 0xFF
    return bytes(broken)


def frame_numbers(data: bytes, kind: type) -> list[int]:
    return [number for number, (packet, _) in enumerate(ends_of(data)) if isinstance(packet, kind)]


# ------------------------------------------------------------------------------------------------------- round trips


@pytest.mark.parametrize("sections", [2, 3, 5])
@pytest.mark.parametrize(("mesh", "options"), [*((MESH, options) for options in OPTIONS), (FINE, REFINED)], ids=str)
def test_a_mesh_in_sections_comes_back(sections, mesh, options):
    given = EncodeOptions(**{**SMALL, "sections": sections, **options})
    encoder = Encoder(mesh, given)
    draft = encoder.draft()
    data = b"".join(draft.frames)
    decoded = decode(data, threads=1)
    assert len(header_of(data).spans) == sections
    assert np.array_equal(decoded.faces, encoder.mesh.faces)
    assert np.abs(decoded.positions - draft.decoded).max() < 1e-9 * draft.header.scale
    assert np.abs(decoded.positions - encoder.mesh.positions).max() < 0.05 * encoder.mesh.diagonal


@pytest.mark.parametrize(("mesh", "options"), [*((MESH, options) for options in OPTIONS), (FINE, REFINED)], ids=str)
def test_events_tell_of_all_faces_and_vertices_and_end_as_the_whole(mesh, options):
    data = encoded(mesh, sections=3, **options)
    decoded = decode(data, threads=1)
    faces, positions, final = np.empty((0, 3), np.int32), np.empty((0, 3)), np.empty(0, bool)
    numbers = []
    for event in events_of(data):
        match event:
            case ConnectivityEvent():
                numbers.append((event.section, event.sections, event.last))
                faces = np.concatenate([faces, event.faces])
                more = event.vertices - len(positions)
                positions = np.concatenate([positions, np.full((more, 3), np.nan)])
                final = np.concatenate([final, np.zeros(more, bool)])
                assert faces.max() < event.vertices and len(event.loose.vertices) == 0
            case BlockEvent():
                assert not final[event.vertices].any()
                assert len(np.unique(event.vertices)) == len(event.vertices)
                assert numbers[-1][2] or not event.final.any()
                positions[event.vertices] = event.positions
                final[event.vertices[event.final]] = True
            case RefinementEvent():
                positions[event.vertices] = event.positions
    assert (mesh is FINE) == any(isinstance(event, RefinementEvent) for event in events_of(data))
    assert numbers == [(0, 3, False), (1, 3, False), (2, 3, True)]
    assert np.array_equal(faces, decoded.faces)
    assert final.all()
    assert np.array_equal(positions, decoded.positions)


@pytest.mark.parametrize("threads", [1, 3])
@pytest.mark.parametrize("options", [{"smoothing": 2.0}, {"key_interval": 2}], ids=str)
def test_events_do_not_depend_on_how_the_bytes_come(threads, options):
    data = encoded(sections=3, **options)
    whole = events_of(data)
    for step in (1, 7, 1000):
        events = events_of(data, step, threads)
        assert [type(event) for event in events] == [type(event) for event in whole]
        for one, other in zip(whole, events, strict=True):
            if isinstance(one, ConnectivityEvent):
                assert (one.section, one.sections, one.vertices) == (other.section, other.sections, other.vertices)
                assert np.array_equal(one.faces, other.faces)
            if isinstance(one, BlockEvent):
                assert one.index == other.index
                assert np.array_equal(one.vertices, other.vertices) and np.array_equal(one.final, other.final)
                assert np.array_equal(one.positions, other.positions)


def test_one_section_is_what_it_was():
    events = events_of(encoded(sections=1))
    assert [type(event) for event in events[:3]] == [HeaderEvent, ConnectivityEvent, BlockEvent]
    assert (events[1].section, events[1].sections, events[1].last) == (0, 1, True)
    assert header_of(encoded(sections=1)).sections == ()


def test_the_first_block_comes_with_its_own_faces_alone():
    data = encoded(sections=2)
    ends = ends_of(data)
    first = next(end for packet, end in ends if isinstance(packet, Block))
    second = [end for packet, end in ends if isinstance(packet, Connectivity)][1]
    assert first < second
    with Decoder(threads=1) as decoder:
        decoder.receive_data(data[:first])
        events = [decoder.next_event() for _ in range(4)]
    assert [type(event) for event in events[:3]] == [HeaderEvent, ConnectivityEvent, BlockEvent]
    assert events[3] is NEED_DATA
    assert len(events[1].faces) == header_of(data).sections[0]
    assert len(events[2].vertices) >= 100


def test_attributes_and_refinement_come_with_sections():
    colours = np.random.default_rng(1).integers(0, 255, (len(MESH.positions), 3)).astype(np.uint8)
    shades = np.arange(len(MESH.faces), dtype=np.uint16)[:, None]
    attributes = (Attribute("color", colours, "vertex", "color"), Attribute("shade", shades, "face"))
    mesh = TriangleMesh(MESH.positions, MESH.faces, attributes, metadata={"author": "test"})
    options = EncodeOptions(block_size=150, sections=2, contract=Contract(0.005, 3.0), threads=1)
    encoder = Encoder(mesh, options)
    decoded = decode(encoder.encode(), threads=1)
    assert decoded.metadata == {"author": "test"}
    assert np.array_equal(decoded.attributes[0].values, colours[encoder.vertex_order])
    assert np.array_equal(decoded.attributes[1].values, shades[encoder.face_order])


def test_an_encoder_is_told_where_a_section_ends_in_the_middle_of_nowhere():
    """Vertices of a section may have no face in it yet, and a mesh of several components may be cut inside one."""
    mesh = together(patch(20, 20), torus(24, 16), patch(9, 30), torus(20, 20))
    for sections in (2, 4, 8):
        decoded = decode(encoded(mesh, sections, block_size=60), threads=1)
        assert len(decoded.positions) == len(mesh.positions)


# ---------------------------------------------------------------------------------------------------------- choosing


def test_places_to_cut_at():
    assert possible_cuts(1000, 500, 1) == ()
    assert possible_cuts(1000, MANY_VERTICES - 1, None) == ()
    assert possible_cuts(4, 4, 2) == (2,)
    assert possible_cuts(1, 3, 2) == ()
    halves = possible_cuts(100_000, MANY_VERTICES, None)
    assert halves == possible_cuts(100_000, 50_000, 2)
    assert (len(halves), halves[0], halves[-1]) == (24, 42_500, 51_500)
    assert len(possible_cuts(100_000, 50_000, 3)) == 48


PLACES = [Cut(faces, faces // 2 + 1, faces // 8) for faces in range(256, 1 << 16, 256)]


def test_sections_have_as_many_blocks():
    vertices = 1 << 15
    assert choose_cuts(PLACES, vertices, 44, 1 << 13, 1) == ()
    (cut,) = choose_cuts(PLACES, vertices, 44, 1 << 13, 2)
    assert abs(cut.vertices - vertices / 2) <= 64
    cuts = choose_cuts(PLACES, vertices, 45, 1 << 13, 4)
    assert [round(45 * cut.vertices / vertices) for cut in cuts] == [11, 22, 33]


def test_two_sections_of_what_is_large():
    assert len(choose_cuts(PLACES, MANY_VERTICES, 32, 2048, None)) == 1
    assert choose_cuts(PLACES, MANY_VERTICES - 1, 32, 2048, None) == ()
    assert choose_cuts(PLACES, MANY_VERTICES, 32, 2047, None) == ()
    assert choose_cuts(PLACES, MANY_VERTICES, 1, 2048, None) == ()
    assert choose_cuts([], MANY_VERTICES, 32, 2048, None) == ()


@pytest.mark.parametrize("options", [{"keep_order": True}, {"partition": "metis"}, {"grid": 12}, {"grid_cell": 0.1}])
def test_options_that_exclude_sections(options):
    with pytest.raises(OptionError, match="sections"):
        EncodeOptions(sections=2, **options)
    EncodeOptions(sections=1, **options)
    EncodeOptions(**options)


@pytest.mark.parametrize("sections", [0, 9])
def test_how_many_sections_there_can_be(sections):
    with pytest.raises(OptionError):
        EncodeOptions(sections=sections)


def test_a_mesh_that_cannot_come_in_sections():
    touching = TriangleMesh(
        np.random.default_rng(0).random((7, 3)), np.array([[0, 1, 2], [0, 3, 4], [0, 5, 6]], np.int32)
    )
    with pytest.raises(OptionError, match="several surfaces meet"):
        encoded(together(*[touching] * 20), 2, block_size=8, keep=1.0)
    with pytest.raises(OptionError, match="fewer sections"):
        encoded(tetrahedron(), 2)


def test_large_meshes_come_in_two_sections_unless_something_is_asked_for_that_excludes_it():
    mesh = irregular(MANY_VERTICES)
    plain = {"step": 0.02, "keep": 0.02, "threads": 1}
    assert len(header_of(encode(mesh, EncodeOptions(**plain))).spans) == 2
    assert header_of(encode(mesh, EncodeOptions(**plain, sections=1))).sections == ()
    assert header_of(encode(mesh, EncodeOptions(bits=12, keep=0.02, threads=1))).sections == ()
    assert header_of(encode(mesh, EncodeOptions(**plain, keep_order=True))).sections == ()


# ------------------------------------------------------------------------------------------------------------ hostile


def refused(data: bytes, match: str | None = None) -> None:
    """Whole, and in small pieces."""
    with pytest.raises(CorruptError, match=match):
        decode(data, threads=1)
    with pytest.raises(CorruptError, match=match):
        events_of(data, 5)


def test_sections_whose_numbers_are_wrong():
    mesh = irregular(2000)
    data = encoded(mesh)
    faces, blocks = header_of(data).sections
    other = [[changed, blocks] for changed in (faces - 200, faces + 200, 1, len(mesh.faces) - 1)]
    for sections in (*other, [faces, blocks, 100, 1], None):
        with pytest.raises(BsmError):
            decode(with_header(data, sections=sections))
    refused(with_header(data, sections=[faces, blocks + 1]), "begins behind")
    refused(with_header(data, sections=[faces, blocks - 1]), "block")
    refused(with_header(data, sections=[faces, blocks, 100]), "pairs")


def test_streams_without_all_their_faces():
    data = encoded(sections=3)
    frames = frames_of(data)
    second = [number for number, (kind, _) in enumerate(frames) if kind == FrameType.CONNECTIVITY][1]
    refused(stream_of(frames[:second]), "before section 1")
    refused(stream_of(frames[:second] + frames[second + 1 :]), "block")
    refused(stream_of(frames[: second + 1]), "before section 2")
    refused(stream_of([*frames[: second + 1], *frames[second:]]))


def test_a_piece_that_is_too_long_or_too_short():
    data = encoded(sections=2)
    frames = frames_of(data)
    kind, payload = frames[1]
    assert kind == FrameType.CONNECTIVITY
    for other in (payload + b"\0", payload[:-1], payload[:-9], payload[:1]):
        with pytest.raises(BsmError):
            decode(stream_of([frames[0], (kind, other), *frames[2:]]))


def test_a_section_with_fewer_vertices_than_blocks():
    encoded_faces = encode_connectivity(MESH.faces, len(MESH.positions), [2])
    (cut,) = encoded_faces.cuts
    first, second = encoded_faces.pieces([cut])
    header = with_header(encoded(sections=2), sections=[2, 9])
    blocks = [(FrameType.BLOCK, write_varint(index) + write_varint(1)) for index in range(9)]
    shape = [(FrameType.CONNECTIVITY, piece) for piece in (first, second)]
    assert cut.vertices < 9
    refused(stream_of([frames_of(header)[0], shape[0], *blocks, shape[1]]), "9 blocks in section 0")


def test_blocks_of_a_section_do_not_overlap_more_than_those_of_a_mesh():
    """A header that claims many vertices grants a first section of few of them no more rows than it has."""
    mesh = torus(100, 100)
    encoded_faces = encode_connectivity(mesh.faces, 10000, [300])
    (cut,) = encoded_faces.cuts
    pieces = [(FrameType.CONNECTIVITY, piece) for piece in encoded_faces.pieces([cut])]
    header = with_header(encode(mesh, EncodeOptions(block_size=1000, sections=1, keep=0.01, step=0.02)), blocks=100)
    size = header_of(header).block_size
    assert 90 * size > 16 * cut.vertices + 65536
    stream = with_header(header, sections=[cut.faces, 90])
    block = (FrameType.BLOCK, write_varint(0) + write_varint(1))
    refused(stream_of([frames_of(stream)[0], pieces[0], block]), "rows at section 0")


def test_sections_of_a_surface_that_is_sewn_together():
    data = encoded(sections=2)
    touching = encode_connectivity(np.array([[0, 1, 2], [0, 3, 4], [0, 5, 6]], np.int32), 7)
    small = {"blocks": 2, "block_size": 7, "coefficients": 1, "details": None, "detail_step": None}
    frames = frames_of(with_header(data, vertices=7, faces=3, sections=[1, 1], **small))
    block = (FrameType.BLOCK, write_varint(0) + write_varint(1))
    refused(stream_of([frames[0], (FrameType.CONNECTIVITY, touching.payload), block]), "pieces")


def test_memory_is_granted_for_vertices_that_have_come():
    data = encoded(sections=2)
    claims = with_header(data, vertices=3 * len(MESH.faces))
    with pytest.raises(BsmError):
        decode(claims)
    limits = Limits(memory=0, memory_per_byte=0, memory_per_vertex=300)
    with pytest.raises(LimitError, match="memory"):
        decode(data, limits)


# ----------------------------------------------------------------------------------------------------------- tolerant


@pytest.mark.parametrize("how", ["removed", "changed"])
def test_a_lost_block_costs_its_chain_and_no_other_section(how):
    data = encoded(sections=2, key_interval=4)
    first = header_of(data).sections[1]
    whole = decode(data, threads=1)
    blocks = frame_numbers(data, Block)
    for lost in (0, first - 1, first, len(blocks) - 1):
        if (lost, how) == (first - 1, "removed"):
            continue  # nothing says then that the section is not whole but the next one's faces, which come too early
        events = events_of(damaged(data, blocks[lost], how), tolerant=True)
        assert isinstance(events[-1], EndEvent)
        local = lost if lost < first else lost - first
        stop = min(local // 4 * 4 + 4, first if lost < first else len(blocks) - first) + (lost - local)
        found = {event.block for event in events if isinstance(event, LossEvent)} - {None}
        assert found == set(range(lost, stop))
        positions, vertices, final = np.full_like(whole.positions, np.nan), 0, np.zeros(len(whole.positions), bool)
        for event in events:
            if isinstance(event, BlockEvent):
                positions[event.vertices] = event.positions
                final[event.vertices[event.final]] = True
            if isinstance(event, ConnectivityEvent):
                vertices = event.vertices
        assert vertices == len(positions)
        losses = events[-1].losses
        assert np.isnan(positions[losses.missing]).all() and len(losses.degraded)
        sound = np.setdiff1d(np.arange(len(positions)), np.concatenate([losses.missing, losses.degraded]))
        assert np.array_equal(positions[sound], whole.positions[sound])
        assert final[sound].all()


@pytest.mark.parametrize("how", ["removed", "changed"])
@pytest.mark.parametrize("section", [0, 1, 2])
def test_faces_that_are_missing_cannot_be_recovered_from(section, how):
    data = encoded(sections=3)
    broken = damaged(data, frame_numbers(data, Connectivity)[section], how)
    for step in (None, 11):
        with pytest.raises(CorruptError):
            events_of(broken, step, tolerant=True)


def test_a_stream_cut_off_shows_what_has_come():
    data = encoded(sections=2)
    ends = ends_of(data)
    second = [end for packet, end in ends if isinstance(packet, Connectivity)][1]
    last = [end for packet, end in ends if isinstance(packet, Block)][-2]
    with pytest.raises(CorruptError, match="missing"):
        events_of(data[: second - 20], tolerant=True)
    events = events_of(data[:last], tolerant=True)
    assert isinstance(events[-1], EndEvent) and len(events[-1].losses.missing)


@pytest.mark.parametrize("number", range(6))
def test_any_damage_is_a_typed_error_or_told(number):
    data = encoded(sections=2)
    random = np.random.default_rng(number)
    for _ in range(12):
        broken = bytearray(data)
        for place in random.integers(5, len(data), random.integers(1, 4)):
            broken[place] ^= int(random.integers(1, 256))
        for act in (lambda d: decode(d, threads=1), lambda d: events_of(d, 997, tolerant=True)):
            ends_well(lambda act=act, broken=broken: act(bytes(broken)))


def ends_well(act: Callable[[], object]) -> None:
    try:
        act()
    except BsmError as error:
        assert str(error)


# --------------------------------------------------------------------------------------------------------- real meshes


@pytest.mark.real
@pytest.mark.parametrize("preset", ["small", "balanced", "fine"])
def test_the_bunny_is_seen_within_two_fifths_of_its_bytes(meshes, preset):
    mesh = read_mesh(meshes / "static" / "bunny_34834.ply").mesh
    promises = {"small": Contract(0.02, 12.0), "balanced": Contract(0.01, 8.0), "fine": Contract(0.005, 3.0)}
    options = {"contract": promises[preset], "block_size": PRESETS[preset].block_size}
    options |= {"overlap": PRESETS[preset].overlap, "key_interval": PRESETS[preset].key_interval}
    data = encode(mesh, EncodeOptions(**options))
    whole = encode(mesh, EncodeOptions(**options, sections=1))
    first = next(end for packet, end in ends_of(data) if isinstance(packet, Block))
    assert first < (0.45 if preset == "small" else 0.4) * len(data)  # faces cost the same in all
    assert len(data) < 1.015 * len(whole)
    assert len(decode(data).positions) == len(mesh.positions)
