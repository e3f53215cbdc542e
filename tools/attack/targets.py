"""What is attacked. A target takes bytes; anything it raises but `BsmError` is a finding."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import numpy as np

from bsm.bitstream.container.packets import PARSERS
from bsm.bitstream.container.scanner import Scanner
from bsm.bitstream.container.wire import FrameType
from bsm.bitstream.errors import BsmError
from bsm.bitstream.limits import Limits
from bsm.codec.decoding import Decoder, SequenceDecoder, decode
from bsm.codec.events import END_OF_STREAM, BlockEvent, FrameEvent
from bsm.files.mesh import MESH_FORMATS, read_mesh
from tools.surgery import frames_of, scan

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
    PARSERS[kinds[data[0] % len(kinds)]](data[1:])


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
    item.__name__: item for item in (scanner, payloads, stream, stream_threads, damaged, sequence, mesh_file)
}
WHOLE_STREAMS = ("scanner", "stream", "stream_threads", "damaged", "sequence")
"""Targets that take streams, and are given mutations that keep checksums right."""
LARGEST_SEED = 4096
SLOW = ("stream", "stream_threads", "damaged", "sequence", "mesh_file")


def seeds(name: str, vectors: Path) -> list[bytes]:
    """What a target starts from: streams, or the payloads in them, behind the bytes the target reads first."""
    streams = [path.read_bytes() for path in sorted(vectors.glob("*/*.bsm")) if path.stat().st_size < LARGEST_SEED]
    if name in WHOLE_STREAMS:
        return streams
    if name == "mesh_file":
        return _mesh_seeds()
    kinds = list(PARSERS)
    good = (frames_of(path.read_bytes()) for path in sorted(vectors.glob("*/good-*.bsm")))
    payloads = ((kinds.index(FrameType(kind)), payload) for frames in good for kind, payload in frames if kind in kinds)
    return sorted({bytes([kind]) + payload for kind, payload in payloads})


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
    if target in (payloads, mesh_file) and not data:
        return  # they read their own first byte
    with suppress(BsmError):
        target(data)
