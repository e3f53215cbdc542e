"""What the viewer is given: a stream, and what it may be compared with."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import DependencyError, MeshError, UnsupportedError
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.files.permutation import in_order_of
from bsm.files.pipes import Input
from bsm.files.sequence_stream import peek_header
from bsm.files.stream import decode_whole

DRACO_LEVEL = 10
DRACO_BITS = range(6, 25)


@dataclass(frozen=True)
class Rival:
    """Draco's smallest file whose normals are as good as the stream's: bytes, bits per coordinate, degrees."""

    bytes: int
    bits: int
    theta: float


@dataclass(frozen=True, eq=False)
class Content:
    """One stream of the viewer."""

    name: str
    stream: bytes
    original: npt.NDArray[np.float32] | None = None
    draco: Rival | None = None


def compared(name: str, stream: bytes, original: TriangleMesh, limits: Limits = DEFAULT_LIMITS) -> Content:
    """A stream of a mesh beside its original, and beside Draco's file of that if DracoPy is installed."""
    header, _ = peek_header(Input(stream).chunks())
    if header is not None and header.gop_frames:
        raise UnsupportedError(f"{name} is a sequence; only single meshes are compared with an original")
    decoded = decode_whole(Input(stream).chunks(), limits)
    used, kept = decoded.without_isolated_vertices()
    source = original.without_isolated_vertices()[0]
    if len(source.positions) != len(used.positions):
        from bsm.codec.static.joining import join

        source = join(source, keep=False).mesh
    positions = decoded.positions.copy()
    positions[kept] = in_order_of(used, source)
    draco = _rival(TriangleMesh(positions[kept], used.faces), used)
    return Content(name, stream, positions.astype(np.float32), draco)


def _rival(original: TriangleMesh, decoded: TriangleMesh) -> Rival | None:
    """Draco's file of `original` with normals as good as those of `decoded`."""
    from bsm.codec.geometry.metrics import Reference

    try:
        from bsm.evaluation.draco import decode_draco, encode_draco, positions_in_order
    except DependencyError:
        return None

    reference = Reference(original.positions, original.faces)
    theta = reference.theta(decoded.positions)
    for bits in DRACO_BITS:
        try:
            data = encode_draco(original, bits, DRACO_LEVEL)
            positions = positions_in_order(original, decode_draco(data), bits)
        except (DependencyError, MeshError):
            return None
        kept = reference.theta(positions)
        if kept <= theta or math.isclose(kept, theta):
            return Rival(len(data), bits, kept)
    return None
