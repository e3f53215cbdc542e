"""Vertices as graphics draw them: one call from a stream to buffers, and the calls that it is made of."""

import ctypes
from collections.abc import Iterator
from contextlib import contextmanager
from ctypes import POINTER, Structure, byref, c_char_p, c_int, c_int64, c_size_t, c_void_p
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import bsm
from tests.streams import frames_in, moving_events_of
from tools.amalgamate import ROOT
from tools.bsmdec import BLOCK, CONNECTIVITY, KINDS, SEMANTICS, Entry, Event, Failure, Options
from tools.bsmenc import Allocator

VECTORS = ROOT / "spec/vectors/1.0"
CARRYING = sorted(
    path.stem for path in VECTORS.glob("good-*attribute*.bsm") if "sequence" not in path.stem
)
MISUSED, CORRUPT, NO_MEMORY, FLOAT32, FLOAT64, POSITION, ABSENT = 2, 4, 8, 6, 7, -1, -2
UINT8, INT8, UINT16, EVER = 0, 1, 2, 1 << 60
COLOR, NORMAL, TEXCOORD = 1, 2, 3
UNITS = (255, 127, 65535, 32767, 4294967295, 2147483647, 1, 1)


class Field(Structure):
    _fields_ = [
        *(("semantic", c_int), ("name", c_char_p), ("kind", c_int)),
        *(("components", c_int), ("offset", c_size_t)),
    ]


class Mesh(Structure):
    _fields_ = [
        *(("error", POINTER(Failure)), ("decoder", c_void_p)),
        *((name, c_int64) for name in ("vertices", "faces", "frame", "frames", "losses")),
        *(("vertex_data", c_void_p), ("vertex_bytes", c_size_t), ("stride", c_size_t)),
        *(("index_data", c_void_p), ("index_size", c_size_t)),
        *(("fields", POINTER(Field)), ("attributes", POINTER(c_int)), ("field_count", c_size_t)),
    ]

    def vertex(self, field: int) -> npt.NDArray[Any]:
        """The numbers of all vertices in a field."""
        field_values = self.fields[field]
        kind = np.dtype(KINDS[field_values.kind])
        data = np.frombuffer(ctypes.string_at(self.vertex_data, self.vertex_bytes), np.uint8)
        rows = data.reshape(self.vertices, self.stride)[
            :, field_values.offset : field_values.offset + field_values.components * kind.itemsize
        ]
        return np.ascontiguousarray(rows).view(kind)

    @property
    def index(self) -> npt.NDArray[Any]:
        kind = {2: np.uint16, 4: np.uint32}[self.index_size]
        return np.frombuffer(
            ctypes.string_at(self.index_data, 3 * self.faces * self.index_size), kind
        ).reshape(-1, 3)


@pytest.fixture(scope="module")
def decoder(library: ctypes.CDLL) -> ctypes.CDLL:
    library.bsmdec_decode.argtypes = [c_char_p, c_size_t, c_void_p, POINTER(POINTER(Mesh))]
    for name in ("advance", "release"):
        getattr(library, f"bsmdec_{name}").argtypes = [POINTER(Mesh)]
    library.bsmdec_split.argtypes = [c_void_p, c_void_p, c_int, c_void_p]
    library.bsmdec_split_indices.argtypes = [c_void_p, c_size_t, c_void_p, c_size_t]
    library.bsmdec_split_values.argtypes = [
        c_void_p,
        c_int,
        c_int,
        c_int,
        c_size_t,
        c_void_p,
        c_size_t,
    ]
    library.bsmdec_metadata_find.argtypes = [c_void_p, c_char_p, POINTER(Entry)]
    return library


@contextmanager
def drawn(
    library: ctypes.CDLL,
    stream: bytes,
    options: Options | None = None,
    *fields: tuple[Any, ...],
    expected: int = 0,
) -> Iterator[Mesh]:
    mesh, wanted = POINTER(Mesh)(), (Field * len(fields))(*fields)
    if fields:
        options = options or Options(None, None, False, 0)
        options.fields, options.field_count = ctypes.addressof(wanted), len(fields)
    given = byref(options) if options else None
    status = library.bsmdec_decode(stream, len(stream), given, byref(mesh))
    assert status == expected == mesh.contents.error.contents.status, (
        mesh.contents.error.contents.message
    )
    yield mesh.contents
    library.bsmdec_release(mesh)


def of_corners(mesh: bsm.TriangleMesh, attribute: bsm.Attribute) -> npt.NDArray[Any]:
    """The values of all corners, fractions of one for integers of colors and normals."""
    index = mesh.faces if attribute.indices is None else attribute.indices
    values = np.asarray(attribute.values[index], np.float64)
    integers = attribute.semantic in ("color", "normal")
    return values / UNITS[KINDS.index(attribute.values.dtype.name)] if integers else values


@pytest.mark.parametrize("name", CARRYING)
def test_split_vertices_are_what_corners_are(decoder: ctypes.CDLL, name: str) -> None:
    stream = (VECTORS / f"{name}.bsm").read_bytes()
    expected = bsm.decode(stream)
    with drawn(decoder, stream) as mesh:
        carried = [attribute for attribute in expected.attributes if attribute.domain != "face"]
        rows = [
            expected.faces,
            *(attribute.indices for attribute in carried if attribute.indices is not None),
        ]
        distinct = len(np.unique(np.stack(rows, -1).reshape(-1, len(rows)), axis=0))
        alone = len(expected.positions) - len(np.unique(expected.faces))
        assert mesh.vertices == distinct + alone
        assert mesh.index_size == 2
        assert mesh.field_count == 1 + len(carried)
        assert np.array_equal(
            mesh.vertex(0)[: len(expected.positions)], expected.positions.astype(np.float32)
        )
        assert np.array_equal(
            mesh.vertex(0)[mesh.index], expected.positions[expected.faces].astype(np.float32)
        )
        for field, attribute in enumerate(carried, 1):
            assert SEMANTICS[mesh.fields[field].semantic] == attribute.semantic
            assert mesh.fields[field].name.decode() == attribute.name
            with np.errstate(over="ignore"):
                values = of_corners(expected, attribute).astype(np.float32)
            assert np.array_equal(
                mesh.vertex(field)[mesh.index], values.reshape(*expected.faces.shape, -1)
            )


def test_fields_are_written_where_and_as_the_caller_wants(decoder: ctypes.CDLL) -> None:
    mesh = bsm.load(VECTORS / "good-tetrahedron.bsm")
    corners = np.arange(12).reshape(4, 3)
    colors = bsm.Attribute(
        "paint", np.arange(12, dtype=np.uint8).reshape(4, 3) * 20, semantic="color"
    )
    uv = bsm.Attribute(
        "uv", np.linspace(0, 1, 24, dtype=np.float32).reshape(12, 2), "corner", "texcoord", corners
    )
    made = bsm.TriangleMesh(mesh.positions, mesh.faces, attributes=(colors, uv))
    stream = bsm.encode(
        made, bsm.EncodeOptions(effort="quick", attributes={"*": "exact"}, keep_order=True)
    )
    decoded = bsm.decode(stream)
    options = Options(None, None, False, 0)
    options.stride, options.index_size = 48, 4
    fields = (
        *(
            (TEXCOORD, None, FLOAT32, 3, 0),
            (COLOR, b"paint", UINT8, 4, 12),
            (POSITION, None, FLOAT64, 3, 16),
        ),
        *((NORMAL, None, INT8, 3, 40), (COLOR, b"other", UINT8, 1, 43)),
    )
    with drawn(decoder, stream, options, *fields) as found:
        assert (found.vertices, found.faces, found.stride, found.index_size) == (12, 4, 48, 4)
        assert [found.attributes[k] for k in range(5)] == [1, 0, POSITION, ABSENT, ABSENT]
        assert np.array_equal(found.vertex(2)[found.index], decoded.positions[decoded.faces])
        paint = found.vertex(1)[found.index]
        assert np.array_equal(paint[..., :3], decoded.attributes[0].values[decoded.faces])
        assert (paint[..., 3] == 255).all()
        texcoord = found.vertex(0)[found.index]
        assert np.array_equal(
            texcoord[..., :2], decoded.attributes[1].values[decoded.attributes[1].indices]
        )
        assert (texcoord[..., 2] == 0).all()
        assert (found.vertex(3) == 0).all() and (found.vertex(4) == 0).all()
    with drawn(decoder, stream, None, (POSITION, None, FLOAT32, 3, 0)) as found:
        assert (found.vertices, found.stride, found.index_size) == (4, 12, 2)


def test_floats_become_integers_of_normals_and_colors(decoder: ctypes.CDLL) -> None:
    mesh = bsm.load(VECTORS / "good-tetrahedron.bsm")
    shades = np.array(
        [[-0.5, 0.0, 0.5], [1.0, 2.0, 0.25], [0.998, 0.002, 1.0], [0.75, 0.1, 0.9]], np.float32
    )
    normals = np.array([[1, 0, 0], [0, -1, 0], [0.6, 0, -0.8], [0, 0, 1]], np.float32)
    carried = (
        bsm.Attribute("c", shades, semantic="color"),
        bsm.Attribute("n", normals, semantic="normal"),
    )
    made = bsm.TriangleMesh(mesh.positions, mesh.faces, attributes=carried)
    stream = bsm.encode(
        made, bsm.EncodeOptions(effort="quick", attributes={"*": "exact"}, keep_order=True)
    )
    with drawn(
        decoder, stream, None, (COLOR, None, UINT16, 3, 0), (NORMAL, None, INT8, 3, 6)
    ) as found:
        assert found.stride == 10 and found.attributes[0] == 0
        assert np.array_equal(
            found.vertex(0), np.rint(65535 * shades.clip(0, 1).astype(np.float64))
        )
        assert np.array_equal(found.vertex(1), np.rint(127 * normals.astype(np.float64)))


@pytest.mark.parametrize(
    ("change", "fields", "message"),
    [
        ({}, [(POSITION, None, UINT16, 3, 0)], "only colors and normals are converted to integers"),
        ({}, [(POSITION, None, 8, 3, 0)], "field 0: kind 8 or 3 components cannot be"),
        ({}, [(POSITION, None, FLOAT32, 5, 0)], "field 0: kind 6 or 5 components cannot be"),
        (
            {"stride": 16},
            [(POSITION, None, FLOAT32, 3, 8)],
            "field 0 ends at byte 20 of a vertex, behind the stride",
        ),
        (
            {"stride": 14},
            [(POSITION, None, FLOAT32, 3, 0)],
            "array or stride is not a multiple of 4 bytes",
        ),
        (
            {},
            [(POSITION, None, FLOAT32, 3, 2**64 - 4)],
            "field 0 ends at byte 8 of a vertex, behind the stride",
        ),
        (
            {},
            [(POSITION, None, FLOAT64, 3, 0), (NORMAL, None, INT8, 1, 2**64 - 2)],
            "field 1 ends at byte -1 of a vertex, behind the stride",
        ),
        ({"stride": 8}, [], "a vertex has 12 bytes, more than the stride"),
        ({"index_size": 3}, [], "indices have 2 or 4 bytes, not 3"),
        (
            {"size": 9},
            [],
            "options.size is not sizeof(bsmdec_options), or fields are set that this release does not know",
        ),
    ],
)
def test_wrong_options_are_named(
    decoder: ctypes.CDLL, change: dict[str, int], fields: list[tuple[Any, ...]], message: str
) -> None:
    options = Options(None, None, False, 0)
    for name, value in change.items():
        setattr(options, name, value)
    with drawn(
        decoder, (VECTORS / "good-chain.bsm").read_bytes(), options, *fields, expected=MISUSED
    ) as found:
        assert found.error.contents.message.decode() == message
        assert not found.vertex_data and not found.vertices and found.decoder


def test_what_all_leaves_out_is_no_misuse(decoder: ctypes.CDLL) -> None:
    stream, event, vertices = (
        (VECTORS / "good-attribute-uv-plain.bsm").read_bytes(),
        Event(),
        c_int64(),
    )
    own = decoder.bsmdec_open(None)
    decoder.bsmdec_push(own, stream, len(stream))
    while decoder.bsmdec_next(own, byref(event)) == 0 and event.type != CONNECTIVITY:
        pass
    assert (
        decoder.bsmdec_split(own, None, -1, byref(vertices)) == 0
        and vertices.value == event.vertices
    )
    assert decoder.bsmdec_last_misuse(own) == b""
    decoder.bsmdec_close(own)


@pytest.mark.parametrize(("name", "losses"), [("good-chain", 1), ("good-sequence-runs", 0)])
def test_bytes_behind_the_end_are_an_error_or_a_loss_of_meshes(
    decoder: ctypes.CDLL, name: str, losses: int
) -> None:
    stream = (VECTORS / f"{name}.bsm").read_bytes() + b"more"
    for options in (Options(), Options(tolerant=True)):
        mesh = POINTER(Mesh)()
        status = decoder.bsmdec_decode(stream, len(stream), byref(options), byref(mesh))
        while status == 0 and mesh.contents.frame >= 0:
            status = decoder.bsmdec_advance(mesh)
        assert (status, mesh.contents.losses) == ((0, losses) if options.tolerant else (CORRUPT, 0))
        decoder.bsmdec_release(mesh)


def test_streams_that_are_none_give_an_error_to_release(decoder: ctypes.CDLL) -> None:
    whole = (VECTORS / "good-chain.bsm").read_bytes()
    for stream, status in (
        (b"", 12),
        (b"no stream", 3),
        (whole[:-1], 12),
        (whole + b"more", CORRUPT),
    ):
        with drawn(decoder, stream, expected=status) as found:
            assert found.error.contents.message and not found.vertices
    assert decoder.bsmdec_decode(whole, len(whole), None, None) == MISUSED
    decoder.bsmdec_release(None)
    assert decoder.bsmdec_advance(None) == MISUSED


def test_a_host_without_memory_gets_an_error_wherever_that_is(decoder: ctypes.CDLL) -> None:
    stream, statuses = (VECTORS / "good-attribute-uv-plain.bsm").read_bytes(), set()
    for most in range(400):
        allocator = Allocator(range(most + 1, EVER))
        mesh = POINTER(Mesh)()
        options = Options(None, ctypes.addressof(allocator), False, 0)
        statuses.add(decoder.bsmdec_decode(stream, len(stream), byref(options), byref(mesh)))
        assert mesh.contents.error.contents.message or statuses == {0, NO_MEMORY}
        decoder.bsmdec_release(mesh)
        assert not allocator.held
    assert statuses == {0, NO_MEMORY}


def test_positions_without_memory_are_an_error(decoder: ctypes.CDLL) -> None:
    stream, allocator, event = (VECTORS / "good-keys.bsm").read_bytes(), Allocator(), Event()
    own = decoder.bsmdec_open(byref(Options(allocator=ctypes.addressof(allocator))))
    decoder.bsmdec_push(own, stream, len(stream))
    while decoder.bsmdec_next(own, byref(event)) == 0 and event.type != BLOCK:
        pass
    positions, vertices = np.zeros((event.vertices, 3)), c_int64()
    assert decoder.bsmdec_split(own, None, -1, byref(vertices)) == 0
    allocator.refused = range(EVER)
    for _ in range(2):
        assert decoder.bsmdec_positions(own, positions.ctypes.data, positions.size) == NO_MEMORY
    room = (positions.ctypes.data, positions.nbytes)
    assert decoder.bsmdec_split_values(own, POSITION, FLOAT64, 3, 24, *room) == NO_MEMORY
    assert decoder.bsmdec_last_error(own).contents.status == NO_MEMORY
    decoder.bsmdec_close(own)
    assert not allocator.held


@pytest.mark.parametrize(
    "name", ["good-sequence-moving", "good-sequence-moving-runs", "good-sequence-runs-many"]
)
def test_frames_come_one_after_the_other(decoder: ctypes.CDLL, name: str) -> None:
    stream = (VECTORS / f"{name}.bsm").read_bytes()
    expected = frames_in(moving_events_of(stream))
    with drawn(decoder, stream) as found:
        seen = []
        while found.frame >= 0:
            positions = found.vertex(0)
            assert np.isfinite(positions).all() and found.index.max() < found.vertices
            seen.append(found.frame)
            want = expected[found.frame].positions
            assert np.array_equal(positions[: len(want)], want.astype(np.float32))
            assert decoder.bsmdec_advance(byref(found)) == 0
        assert seen == list(expected)
        assert found.frames == len(seen)
        assert decoder.bsmdec_advance(byref(found)) == 0 and found.frame == -1


def test_names_of_fields_may_go_after_the_call(decoder: ctypes.CDLL) -> None:
    """The faces change, so the attribute is looked for again."""
    stream, mesh, name = (
        (VECTORS / "good-sequence-moving-runs.bsm").read_bytes(),
        POINTER(Mesh)(),
        b"velocity",
    )
    text = ctypes.create_string_buffer(name)
    field = Field(0, ctypes.cast(text, c_char_p), FLOAT32, 2, 0)
    options = Options(None, None, False, 0)
    options.fields, options.field_count = ctypes.addressof(field), 1
    assert decoder.bsmdec_decode(stream, len(stream), byref(options), byref(mesh)) == 0
    text.value = b"part"
    frames = frames_in(moving_events_of(stream))
    while (found := mesh.contents).frame >= 0:
        moving = next(a for a in frames[found.frame].attributes if a.name == "velocity")
        assert np.array_equal(
            found.vertex(0)[: len(moving.values)], moving.values.astype(np.float32)
        )
        assert found.fields[0].name == name
        assert decoder.bsmdec_advance(mesh) == 0
    decoder.bsmdec_release(mesh)


def test_a_sequence_says_how_many_frames_come(decoder: ctypes.CDLL) -> None:
    for name, frames in (
        ("good-sequence-long", None),
        ("good-sequence-unknown-end", 0),
        ("good-chain", 0),
    ):
        stream = (VECTORS / f"{name}.bsm").read_bytes()
        with drawn(decoder, stream) as found:
            assert found.frames == (
                len(bsm.decode_sequence(stream)[0]) if frames is None else frames
            )


def test_metadata_are_found_by_name(decoder: ctypes.CDLL) -> None:
    entries = {
        "unit": "mm",
        "frame_rate": 25,
        "material.0.name": "wood",
        "ratio": 0.5,
        "image.0.data": b"\0\1",
    }
    stream = bsm.encode(bsm.load(VECTORS / "good-tetrahedron.bsm"), metadata=entries)
    entry = Entry()
    with drawn(decoder, stream) as found:
        for name, value in entries.items():
            assert decoder.bsmdec_metadata_find(found.decoder, name.encode(), byref(entry)) == 0
            assert (entry.name.decode(), entry.value) == (name, value)
        known = set()
        for index in range(len(entries)):
            assert decoder.bsmdec_metadata_at(found.decoder, index, byref(entry)) == 0
            known.add(entry.name.decode())
        assert known == set(entries)
        for name in (b"", b"uni", b"unit ", b"\xff"):
            assert decoder.bsmdec_metadata_find(found.decoder, name, byref(entry)) == MISUSED
        assert decoder.bsmdec_last_misuse(found.decoder) == b"no entry of metadata has this name"


def test_kinds_and_statuses_have_sizes_and_names(decoder: ctypes.CDLL) -> None:
    decoder.bsmdec_status_name.restype = decoder.bsmdec_version.restype = c_char_p
    decoder.bsmdec_kind_size.restype = c_size_t
    assert [decoder.bsmdec_kind_size(kind) for kind in range(-1, 9)] == [
        0,
        1,
        1,
        2,
        2,
        4,
        4,
        4,
        8,
        0,
    ]
    assert (
        decoder.bsmdec_status_name(4) == b"corrupt" and decoder.bsmdec_status_name(99) == b"unknown"
    )
    assert (
        f'#define BSMDEC_VERSION "{decoder.bsmdec_version().decode()}"'
        in (ROOT / "library/bsmdec.h").read_text()
    )
