"""Faces to bytes and back: any list of triangles, exactly, up to the numbering that the decoder chooses.

A payload is one entropy-coded stream: four counts, then the conquest of the surface (cut where it is not an oriented
manifold), then which of the cut surface's fans are the same vertex, then the faces that repeat a corner.

The decoder's numbering is a fixed point: encoding decoded faces gives the same payload, and identity orders.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from bsm.bitstream import _kernels
from bsm.bitstream.connectivity.conquest import (
    NO_ROOM,
    NONSENSE,
    TURN_BYTES,
    Conquest,
    Guide,
    conquer,
    enlarge_conquest,
    make_conquest,
    make_guide,
    no_guide,
)
from bsm.bitstream.connectivity.halfedges import close_surface
from bsm.bitstream.connectivity.seams import code_degenerate, code_seams
from bsm.bitstream.connectivity.valence_model import RARE_HEADER, Models, code_rare, make_models
from bsm.bitstream.entropy.range_coder import (
    Coder,
    finish_reading,
    finish_writing,
    make_room,
    overran,
    start_reading,
    start_writing,
)
from bsm.bitstream.errors import CorruptError, MeshError, TruncatedError
from bsm.bitstream.limits import DEFAULT_LIMITS, Limits

Ints = npt.NDArray[np.int32]

_FIRST_CAPACITY = 1 << 16
_FACE_MEMORY, _VERTEX_MEMORY, _FAN_MEMORY = 100, 400, 240
"""Bytes that decoding, and the graph that follows, take at most for each; only fans count that are sewn together."""
_BYTES_PER_FAN = 32  # more than the vertex of a fan, or a corner of a degenerate face, can take


@dataclass(frozen=True, eq=False)
class EncodedConnectivity:
    """What `encode_connectivity` returns."""

    payload: bytes
    vertex_order: Ints
    face_order: Ints
    faces: Ints


def encode_connectivity(faces: npt.ArrayLike, vertex_count: int) -> EncodedConnectivity:
    """Encode triangles."""
    given = _check_faces(faces, vertex_count)
    degenerate = (given[:, 0] == given[:, 1]) | (given[:, 1] == given[:, 2]) | (given[:, 2] == given[:, 0])
    proper, improper = np.flatnonzero(~degenerate), np.flatnonzero(degenerate)
    surface = close_surface(given[proper] if len(improper) else given, vertex_count)
    fans, loops = len(surface.vertex), len(surface.valence) - len(surface.vertex)
    regular = int(np.count_nonzero(np.bincount(surface.vertex, minlength=vertex_count)))

    coder, models = start_writing(_FIRST_CAPACITY), make_models(vertex_count)
    for count in (len(improper), vertex_count - regular, fans - regular, loops):
        code_rare(coder, models, RARE_HEADER, count)
    guide, conquest = make_guide(surface, len(proper)), make_conquest(len(proper), fans, loops)
    coder, conquest = _conquer(coder, models, guide, conquest)

    coder = make_room(coder, _BYTES_PER_FAN * (fans + 3 * len(improper)))
    used = np.concatenate([surface.vertex[guide.fans], given[improper].reshape(-1)])
    order, number = _number_by_appearance(used, vertex_count)
    if len(order) < vertex_count:
        missing = int(np.argmin(np.isin(np.arange(vertex_count), order)))
        raise MeshError(f"vertex {missing} is in no face; remove isolated vertices first")
    vertices = number[used[:fans]]
    if fans > regular:
        code_seams(coder, conquest.faces, vertices)
    corners = number[used[fans:]]
    code_degenerate(coder, corners, regular)
    return EncodedConnectivity(
        finish_writing(coder),
        order,
        np.concatenate([proper[guide.faces], improper]).astype(np.int32),
        np.concatenate([vertices[conquest.faces], corners.reshape(-1, 3)]),
    )


def decode_connectivity(payload: bytes, vertex_count: int, face_count: int, limits: Limits = DEFAULT_LIMITS) -> Ints:
    """Decode what `encode_connectivity` made of `face_count` triangles of `vertex_count` vertices."""
    limits.check("vertices", vertex_count)
    limits.check("faces", face_count)
    if not 0 < vertex_count <= 3 * face_count:
        raise CorruptError(f"{face_count} triangles cannot have {vertex_count} vertices")
    coder, models = start_reading(payload), make_models(vertex_count)
    degenerate, lonely, surplus, loops = (code_rare(coder, models, RARE_HEADER, 0) for _ in range(4))
    proper, regular = face_count - degenerate, vertex_count - lonely
    fans = regular + surplus
    if proper < 0 or regular < 0 or lonely > 3 * degenerate or fans > 3 * proper or loops > 3 * proper:
        raise _nonsense(coder, "the counts at its start contradict each other")
    limits.check("vertices", fans + loops)
    limits.check_memory(_memory(face_count, vertex_count, surplus + loops), vertex_count, len(coder.data))
    coder, conquest = _conquer(coder, models, no_guide(), make_conquest(proper, fans, loops))
    faces = conquest.faces
    count = regular
    if surplus > 0:
        count, vertices = code_seams(coder, faces, np.full(fans, -1, np.int32))
        faces = vertices[faces]
    corners = np.empty(3 * degenerate, np.int32)
    if count != regular or code_degenerate(coder, corners, regular) != vertex_count:
        raise _nonsense(coder, f"it does not make {vertex_count} vertices")
    finish_reading(coder)
    return np.concatenate([faces, corners.reshape(-1, 3)]) if degenerate else faces


def _memory(faces: int, vertices: int, sewn: int) -> int:
    return _FACE_MEMORY * faces + _VERTEX_MEMORY * vertices + _FAN_MEMORY * sewn


def _conquer(coder: Coder, models: Models, guide: Guide, conquest: Conquest) -> tuple[Coder, Conquest]:
    """Run the conquest, with more memory each time it asks; so memory follows the progress, not a claim."""
    while (end := conquer(coder, models, guide, conquest)) == NO_ROOM:
        coder, conquest = make_room(coder, TURN_BYTES + len(coder.data)), enlarge_conquest(conquest)
    if end == NONSENSE:
        raise _nonsense(coder, f"it does not make {len(conquest.faces)} triangles")
    return coder, conquest


def _nonsense(coder: Coder, problem: str) -> CorruptError | TruncatedError:
    if overran(coder):
        return TruncatedError(f"a connectivity payload of {len(coder.data)} bytes ends too early")
    return CorruptError(f"a connectivity payload is damaged: {problem}")


def _check_faces(faces: npt.ArrayLike, vertex_count: int) -> Ints:
    given = np.asarray(faces)
    if given.ndim != 2 or given.shape[1] != 3 or len(given) == 0 or given.dtype.kind not in "iu":
        raise MeshError(f"faces must be integers of shape (m, 3), m > 0, not {given.dtype} of shape {given.shape}")
    if given.min() < 0 or given.max() >= vertex_count:
        raise MeshError(f"faces refer to vertices {given.min()} to {given.max()}, outside 0..{vertex_count - 1}")
    return np.ascontiguousarray(given, np.int32)


def _number_by_appearance(sequence: Ints, size: int) -> tuple[Ints, Ints]:
    order, number = np.empty(size, np.int32), np.empty(size, np.int32)
    count = _kernels.number_by_appearance(sequence, order, number)
    return order[:count].copy(), number
