"""What is attacked. A target takes bytes; anything it raises but `BsmError` is a finding."""

import tempfile
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import numpy as np

from bsm.bitstream.errors import BsmError
from bsm.bitstream.limits import Limits
from bsm.codec.decoding import Decoder, SequenceDecoder, decode
from bsm.codec.events import END_OF_STREAM, BlockEvent, FrameEvent
from bsm.files.inspection import inspect_stream
from bsm.files.mesh import read_mesh, written_mesh
from bsm.files.table import MESH_FORMATS
from tools.vectors.good_attributes import charts, colors, groups, with_attributes
from tools.vectors.meshes import patch

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


def inspection(data: bytes) -> None:
    """The report of `bsm info`, of a stream in two pieces."""
    inspect_stream([data[: len(data) // 2], data[len(data) // 2 :]], LIMITS)


def stream(data: bytes) -> None:
    """A whole static stream."""
    mesh = decode(data, LIMITS, threads=1)
    _expect(bool(np.isfinite(mesh.positions).all()), "positions that are not finite")
    for attribute in mesh.attributes:
        floats = attribute.values.dtype.kind == "f"
        _expect(
            not floats or bool(np.isfinite(attribute.values).all()),
            "an attribute that is not finite",
        )


def stream_threads(data: bytes) -> None:
    """A whole static stream by events, on two threads."""
    _events(Decoder(LIMITS, threads=2), data)


def damaged(data: bytes) -> None:
    """A static stream in tolerant mode."""
    _events(Decoder(LIMITS, threads=1, tolerant=True), data)


def sequence(data: bytes) -> None:
    """A whole sequence, in tolerant mode if its length is odd."""
    _events(SequenceDecoder(LIMITS, threads=1, tolerant=len(data) % 2 == 1), data)


def _events(decoder: Decoder | SequenceDecoder, data: bytes) -> None:
    with decoder:
        decoder.receive_data(data)
        decoder.receive_eof()
        while (event := decoder.next_event()) is not END_OF_STREAM:
            if isinstance(event, BlockEvent | FrameEvent):
                _expect(bool(np.isfinite(event.positions).all()), "positions that are not finite")


def mesh_file(data: bytes) -> None:
    """A mesh file; its first byte tells the format that its name has."""
    folder = Path("/dev/shm") if Path("/dev/shm").is_dir() else Path(tempfile.gettempdir())
    with tempfile.NamedTemporaryFile(
        dir=folder, suffix="." + MESH_FORMATS[data[0] % len(MESH_FORMATS)]
    ) as file:
        file.write(data[1:])
        file.flush()
        mesh = read_mesh(file.name, limits=LIMITS).mesh
    _expect(bool(np.isfinite(mesh.positions).all()), "positions that are not finite")
    _expect(
        bool((mesh.faces < len(mesh.positions)).all() and (mesh.faces >= 0).all()),
        "faces out of range",
    )


TARGETS: dict[str, Target] = {
    item.__name__: item
    for item in (inspection, stream, stream_threads, damaged, sequence, mesh_file)
}
MESH_FILE = "mesh_file"
"""The target that takes no streams; the others are given mutations that keep checksums right."""
LARGEST_SEED = 4096
"""Larger vectors are not mutated: they probe size, and cost time."""


def seeds(name: str) -> list[bytes]:
    """Return the inputs that a target starts from: streams, or mesh files after a byte for their format."""
    if name == MESH_FILE:
        mesh = with_attributes(patch(4, 3), colors, charts, groups)
        mesh = replace(mesh, metadata={"name": "patch", "material.1.Kd": "1 0 0"})
        return [bytes([k]) + written_mesh(mesh, kind).data for k, kind in enumerate(MESH_FORMATS)]
    return vector_seeds()


def vector_seeds() -> list[bytes]:
    """The vectors, those that are to be refused too."""
    return [
        path.read_bytes()
        for path in sorted(VECTORS.glob("*/*.bsm"))
        if path.stat().st_size < LARGEST_SEED
    ]


def run(target: Target, data: bytes) -> None:
    """Run a target; an expected refusal is not a finding."""
    if target is mesh_file and not data:
        return  # it reads its own first byte
    with suppress(BsmError):
        target(data)
