"""What is attacked. A target takes bytes; anything it raises but `BsmError` is a finding."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np

from bsm.bitstream.attributes.seams import Joins, decode_seams
from bsm.bitstream.attributes.values import Kind, face_values_field, values_field
from bsm.bitstream.coefficients.adaptive import CoefficientModel, decode_coefficients
from bsm.bitstream.coefficients.matrices import decode_levels, make_level_bank
from bsm.bitstream.coefficients.packed import unpack_coefficients
from bsm.bitstream.connectivity.faces import decode_connectivity
from bsm.bitstream.connectivity.order import code_permutation, code_rotations
from bsm.bitstream.connectivity.partition import decode_labels
from bsm.bitstream.container.gop import parse_gop_body
from bsm.bitstream.container.packets import PARSERS
from bsm.bitstream.container.scanner import Scanner, scan
from bsm.bitstream.container.splits import decode_order
from bsm.bitstream.container.wire import FrameType
from bsm.bitstream.entropy.range_coder import finish_reading, start_reading
from bsm.bitstream.errors import BsmError
from bsm.bitstream.fields.corners import Field, FieldDecoder, FieldEncoder, corners_of
from bsm.bitstream.fields.grid import grid_field, levels_field, light_field
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits
from bsm.codec.geometry.graph import graph_of_faces
from bsm.codec.sequence.temporal import basis_leads
from bsm.decoding import Decoder, SequenceDecoder, decode
from bsm.events import END_OF_STREAM, BlockEvent, FrameEvent
from bsm.files.mesh import MESH_FORMATS, read_mesh

Target = Callable[[bytes], None]

VECTORS = Path(__file__).parents[2] / "spec" / "vectors"

LIMITS = Limits(
    vertices=1 << 13,
    faces=1 << 14,
    blocks=1 << 10,
    block_size=1 << 10,
    coefficients=1 << 9,
    frames=1 << 10,
    gop_frames=64,
    frame_bytes=1 << 20,
    work=1e9,
    sequence_bytes=1 << 26,
    field_bytes=1 << 26,
    attribute_values=1 << 16,
)
"""What a caller would grant who wants an answer within a second."""


class Finding(Exception):
    """A result that is wrong though no error was raised."""


def _expect(right: bool, problem: str) -> None:
    if not right:
        raise Finding(problem)


def scanner(data: bytes) -> None:
    """Frames and their payloads."""
    list(scan([data[: len(data) // 2], data[len(data) // 2 :]], Scanner(LIMITS)))


def payloads(data: bytes) -> None:
    """The payload of each frame type, without frame and checksum."""
    kinds = list(PARSERS)
    PARSERS[kinds[data[0] % len(kinds)]](data[1:], LIMITS)


def coefficients(data: bytes) -> None:
    """Adaptive coefficients: two blocks of one chain, then several in one payload."""
    model = CoefficientModel(1 + data[0])
    decode_coefficients(model, data[2:], 1 + data[1] % (data[0] + 1))
    decode_coefficients(model, data[2:], model.width)


def packed(data: bytes) -> None:
    """Packed coefficients, zstd included."""
    count = 1 + data[1] % 96
    _expect(len(unpack_coefficients(data[2:], count, 1 + data[0] % 32)) == count, "a wrong number of coefficients")


def connectivity(data: bytes) -> None:
    """Faces: indices in range, every vertex used."""
    vertices, faces = int.from_bytes(data[:2], "little") % 2000, int.from_bytes(data[2:4], "little") % 4000
    decoded = decode_connectivity(data[4:], vertices, faces, LIMITS)
    _expect(decoded.shape == (faces, 3), "a wrong number of faces")
    _expect(bool((np.bincount(decoded.ravel(), minlength=vertices) > 0).all()), "a vertex without face")
    _expect(len(np.bincount(decoded.ravel())) == vertices, "a vertex beyond the last")


_FAN = np.array([[0, k, k + 1] for k in range(1, 40)], np.int32)
_FAN_GRAPH = graph_of_faces(_FAN, 41)


def arrangement(data: bytes) -> None:
    """An order of vertices and faces."""
    decoded, _ = decode_order(data, _FAN, 41, DEFAULT_LIMITS)
    _expect(bool((np.sort(decoded.vertex_order) == np.arange(41)).all()), "no permutation of vertices")
    _expect(bool((np.sort(decoded.face_order) == np.arange(len(_FAN))).all()), "no permutation of faces")


def permutation(data: bytes) -> None:
    """A permutation or rotations."""
    values = np.zeros(data[1], np.int32)
    finish_reading((code_permutation if data[0] % 2 else code_rotations)(start_reading(data[2:]), values))
    if data[0] % 2:
        _expect(bool((np.sort(values) == np.arange(len(values))).all()), "no permutation")
    else:
        _expect(bool((values <= 2).all()), "a rotation over 2")


def labels(data: bytes) -> None:
    """Parts of vertices."""
    parts = 1 + data[0] % 41
    decoded = decode_labels(data[1:], _FAN_GRAPH.offsets, _FAN_GRAPH.neighbours, parts)
    _expect(bool((np.unique(decoded) == np.arange(parts)).all()), "labels that are not all parts")


_SOUP = np.concatenate([_FAN, [[0, 0, 7], [3, 3, 3], [1, 2, 0], [2, 1, 5], [44, 41, 43], [41, 43, 42]]]).astype(
    np.int32
)
_KINDS: tuple[Kind, ...] = ("plain", "color", "texcoord", "normal")
_LARGEST = (1000, 3, (1 << 20) - 1)


def grid(data: bytes) -> None:
    """Positions on a grid, in chunks; the first two bytes tell their lengths."""
    _in_two_chunks(data, grid_field(_SOUP, 46, _LARGEST))


def light(data: bytes) -> None:
    """Attack the decoder of light grids."""
    _in_two_chunks(data, light_field(_SOUP, 46, _LARGEST))


def levels(data: bytes) -> None:
    """Levels of a refinement, in chunks; the first two bytes tell their number and lengths."""
    _in_two_chunks(data, levels_field(_SOUP, 46))


def _in_two_chunks(data: bytes, field: Field) -> None:
    decoder, size = FieldDecoder(field), 1 + data[0] % 46
    for chunk, count in ((data[2 : 2 + data[1]], size), (data[2 + data[1] :], 46 - size)):
        if count:
            _, found = decoder.chunk(chunk, count)
            _expect(bool(((found >= field.low) & (found <= field.high)).all()), "values out of range")


def seams(data: bytes) -> None:
    """Seams of an attribute, and the corners that they part."""
    corners = corners_of(_SOUP, 46)
    joins = Joins(corners, decode_seams(data, corners))
    _expect(bool((joins.vertices[joins.faces] == corners.faces).all()), "corners of two vertices share a value")


def attribute_values(data: bytes) -> None:
    """Values of vertices or faces, in chunks; the first two bytes tell their kind and length."""
    size, half = 1 + data[1] % 45, 2 + (len(data) - 2) // 2
    chunks = data[2:half], data[half:]
    if data[0] % 5 == 4:
        of_faces = FieldDecoder(face_values_field(_SOUP, (1000, 3)), LIMITS)
        for chunk, count in zip(chunks, (size // 2 + 1, len(_SOUP) - size // 2 - 1), strict=True):
            _expect(bool((of_faces.chunk(chunk, count)[1] <= (1000, 3)).all()), "values above their largest")
        return
    kind = _KINDS[data[0] % 5]
    largest = (126, 126) if kind in ("texcoord", "normal") else (1000, 3)
    geometry = None if data[1] > 127 else np.arange(138, dtype=np.int32).reshape(46, 3) ** 2 % 977
    places = np.arange(46) // 2
    decoder = FieldDecoder(values_field(_SOUP, 46, largest, kind, geometry, places), LIMITS)
    for chunk, count in zip(chunks, (size, 46 - size), strict=True):
        _, values = decoder.chunk(chunk, count)
        _expect(bool(((values >= 0) & (values <= largest)).all()), "values above their largest")


def gops(data: bytes) -> None:
    """The data of a GOP, and the levels in it."""
    body = parse_gop_body(data[1:], 64, widths={0: 1, 2: 4}, tolerant=data[:1] > b"\x7f")
    for field in body.fields:
        if body.method.has_basis:
            levels = np.zeros((field.width, body.coded, field.components), np.int32)
            leads = basis_leads(field.width)
            decode_levels(make_level_bank(), field.basis, list(levels), [levels[0], *levels[:-1]], leads)
        levels = np.zeros((2, 10, field.components), np.int32)
        decode_levels(make_level_bank(), field.levels, list(levels), [levels[0], *levels[:-1]])


def stream(data: bytes) -> None:
    """A whole static stream."""
    mesh = decode(data, LIMITS, threads=1)
    _expect(bool(np.isfinite(mesh.positions).all()), "positions that are not finite")
    for attribute in mesh.attributes:
        floats = attribute.values.dtype.kind == "f"
        _expect(not floats or bool(np.isfinite(attribute.values).all()), "an attribute that is not finite")


def stream_threads(data: bytes) -> None:
    """A whole static stream by events, on two threads."""
    with Decoder(LIMITS, threads=2) as decoder:
        _events(decoder, data)


def damaged(data: bytes) -> None:
    """A static stream in tolerant mode."""
    with Decoder(LIMITS, threads=1, tolerant=True) as decoder:
        _events(decoder, data)


def _events(decoder: Decoder, data: bytes) -> None:
    decoder.receive_data(data)
    decoder.receive_eof()
    while (event := decoder.next_event()) is not END_OF_STREAM:
        if isinstance(event, BlockEvent):
            _expect(bool(np.isfinite(event.positions).all()), "positions that are not finite")


def sequence(data: bytes) -> None:
    """A whole sequence; the first byte says whether in tolerant mode, and from which frame on."""
    decoder = SequenceDecoder(LIMITS, threads=1, tolerant=len(data) % 2 == 1)
    decoder.receive_data(data)
    decoder.receive_eof()
    while (event := decoder.next_event()) is not END_OF_STREAM:
        if isinstance(event, FrameEvent):
            _expect(bool(np.isfinite(event.positions).all()), "positions that are not finite")


def mesh_file(data: bytes) -> None:
    """A mesh file; its first byte tells the format that its name has."""
    folder = Path("/dev/shm") if Path("/dev/shm").is_dir() else Path(tempfile.gettempdir())
    with tempfile.NamedTemporaryFile(dir=folder, suffix="." + MESH_FORMATS[data[0] % len(MESH_FORMATS)]) as file:
        file.write(data[1:])
        file.flush()
        mesh = read_mesh(file.name, limits=LIMITS).mesh
    _expect(bool(np.isfinite(mesh.positions).all()), "positions that are not finite")
    _expect(bool((mesh.faces < len(mesh.positions)).all() and (mesh.faces >= 0).all()), "faces out of range")


TARGETS: dict[str, Target] = {
    item.__name__: item
    for item in (
        scanner,
        payloads,
        coefficients,
        packed,
        connectivity,
        arrangement,
        permutation,
        labels,
        grid,
        light,
        levels,
        seams,
        attribute_values,
        gops,
        stream,
        stream_threads,
        damaged,
        sequence,
        mesh_file,
    )
}
WHOLE_STREAMS = ("scanner", "stream", "stream_threads", "damaged", "sequence")
"""Targets that take streams, and are given mutations that keep checksums right."""
LARGEST_SEED = 4096
SLOW = ("stream", "stream_threads", "damaged", "sequence", "mesh_file")


def seeds(name: str, vectors: Path) -> list[bytes]:
    """What a target starts from: streams, or the payloads in them, behind the bytes the target reads first."""
    from tools.surgery import frames_of

    streams = [path.read_bytes() for path in sorted(vectors.glob("*/*.bsm")) if path.stat().st_size < LARGEST_SEED]
    good = [path.read_bytes() for path in sorted(vectors.glob("*/good-*.bsm"))]
    if name in WHOLE_STREAMS:
        return streams
    if name == "mesh_file":
        return _mesh_seeds()
    if name in ("grid", "light", "levels"):
        return _field_seeds(name)
    found: list[bytes] = []
    for data in good:
        frames = frames_of(data)
        header = PARSERS[FrameType.HEADER](frames[0][1], Limits())
        found += [_seed(name, kind, payload, header) for kind, payload in frames]
    return sorted(set(found) - {b""}) or [bytes(8)]


def _seed(name: str, kind: int, payload: bytes, header: object) -> bytes:
    """The input of a target that a frame makes, if any."""
    kinds = list(PARSERS)
    if name == "payloads" and kind in kinds:
        return bytes([kinds.index(FrameType(kind))]) + payload
    if name == "connectivity" and kind == FrameType.CONNECTIVITY:
        counts = (getattr(header, "vertices"), getattr(header, "faces"))  # noqa: B009
        return b"".join(count.to_bytes(2, "little") for count in counts) + payload
    if name in ("coefficients", "packed") and kind == FrameType.BLOCK:
        return bytes([min(255, getattr(header, "coefficients") - 1), payload[1] - 1]) + payload[2:]  # noqa: B009
    if name in ("arrangement", "permutation") and kind == FrameType.ORDER:
        return payload
    if name == "labels" and kind == FrameType.PARTITION:
        return payload
    if name == "seams" and kind == FrameType.ATTRIBUTE:
        return PARSERS[FrameType.ATTRIBUTE](payload, Limits()).seams  # type: ignore[union-attr]
    if name == "attribute_values" and kind == FrameType.VALUES:
        return payload
    if name == "gops" and kind == FrameType.GOP:
        return payload
    return b""


def _field_seeds(name: str) -> list[bytes]:
    found = []
    for size, spread in ((1, 2), (23, 9), (46, 1000)):
        values = np.arange(46 * 3).reshape(46, 3) * 7 % spread
        if name == "levels":
            encoder = FieldEncoder(levels_field(_SOUP, 46), values - spread // 2)
        else:
            field = light_field if name == "light" else grid_field
            encoder = FieldEncoder(field(_SOUP, 46, _LARGEST), np.minimum(values, _LARGEST))
        chunks = [encoder.chunk(count) for count in (size, 46 - size) if count]
        found.append(bytes([size - 1, len(chunks[0])]) + b"".join(chunks))
    return found


def _mesh_seeds() -> list[bytes]:
    from bsm.codec.geometry.attributes import Attribute
    from bsm.codec.geometry.mesh import TriangleMesh
    from bsm.files.mesh import format_mesh
    from tools.vectors.meshes import patch

    bare = patch(4, 3)
    vertices, faces = len(bare.positions), len(bare.faces)
    attributes = (
        Attribute("color", np.arange(3 * vertices, dtype=np.uint8).reshape(-1, 3), semantic="color"),
        Attribute("texcoord", np.arange(6 * faces, dtype=np.float32).reshape(-1, 2), "corner", "texcoord"),
        Attribute("material", np.arange(faces) % 2, "face"),
    )
    mesh = TriangleMesh(bare.positions, bare.faces, attributes, {"name": "patch", "material.1.Kd": "1 0 0"})
    return [bytes([k]) + format_mesh(mesh, kind) for k, kind in enumerate(MESH_FORMATS)]


def run(target: Target, data: bytes) -> None:
    """Run a target; what it refuses as it should is no finding."""
    try:
        target(data)
    except BsmError:
        return
    except IndexError:
        if len(data) < 4:  # too short for the target's own first bytes
            return
        raise
