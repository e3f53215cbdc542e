"""Faces to bytes: counts, the conquest of a cut surface, fans, degenerate faces; exact up to numbering."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from bsm.bitstream import _kernels
from bsm.bitstream.entropy import range_coder as entropy
from bsm.bitstream.errors import MeshError

Ints = npt.NDArray[np.int32]


class Surface(NamedTuple):
    twin: Ints
    corner: Ints
    valence: Ints
    vertex: Ints


def close_surface(faces: Ints, vertex_count: int) -> Surface:
    """Build the closed surface of faces without repeated corners, shape (m, 3), indices below `vertex_count`."""
    origin = np.ascontiguousarray(faces, np.int32).reshape(-1)
    twin = match_halfedges(origin, vertex_count)
    corner, vertex = np.empty_like(origin), np.empty_like(origin)
    vertex = vertex[: _kernels.find_fans(origin, twin, corner, vertex)].copy()
    # A dummy vertex for every boundary loop, and its faces (b, a, dummy) for each boundary half-edge (a, b).
    size = twin.size + 3 * int(np.count_nonzero(twin < 0))
    full_twin, full_corner = np.empty(size, np.int32), np.empty(size, np.int32)
    dummies = _kernels.fill_loops(twin, corner, np.empty_like(vertex), full_twin, full_corner)
    valence = np.bincount(full_corner, minlength=len(vertex) + dummies).astype(np.int32)
    return Surface(full_twin, full_corner, valence, vertex)


def match_halfedges(origin: Ints, vertex_count: int) -> Ints:
    """Twin of each half-edge, -1 unless its edge has exactly one half-edge in each direction; in linear time."""
    starts = np.empty(vertex_count + 1, np.int64)
    by_high, order, twin = (np.empty(origin.size, np.int32) for _ in range(3))
    _kernels.match_halfedges(origin, starts, by_high, order, twin)
    return twin


_NODE_COLUMNS = 8
_BUCKETS = 8
_MADE, _ALIVE, _TAILS = _BUCKETS, _BUCKETS + 1, _BUCKETS + 2


class Front(NamedTuple):
    """Polygons that bound the conquered faces."""

    nodes: Ints
    heads: Ints


_VALENCE_CONTEXTS = 14
_VALENCE_NODES = 16
_EVENT_CONTEXTS = 3
_EVENT_SIZE = 4096
_RARE_UNARY = 2
_RARE_SPAN = entropy.unsigned_span(_RARE_UNARY)
_RARE_KINDS = 6
RARE_HEADER = 5 * _RARE_SPAN  # first node of the model of the counts at the start of the payload


class Models(NamedTuple):
    """Adaptive state of one payload."""

    valence: entropy.Bank
    event: entropy.Bank
    rare: entropy.Bank
    bits: int


def make_models(vertex_count: int) -> Models:
    """Neutral models; the tables grow with the number of vertices, which both sides know."""
    bits = min(max(int(vertex_count).bit_length() - 2, 6), 12)
    return Models(
        entropy.make_bank((_VALENCE_CONTEXTS << bits) * _VALENCE_NODES, _VALENCE_NODES, _VALENCE_CONTEXTS, 1023, 16),
        entropy.make_bank(
            _EVENT_CONTEXTS * _EVENT_SIZE, 1, _EVENT_CONTEXTS, 1023, 16, entropy.ONE - entropy.ONE // 500, 30
        ),
        entropy.make_bank(_RARE_KINDS * _RARE_SPAN, _RARE_KINDS * _RARE_SPAN, 1),
        bits,
    )


def code_rare(coder: entropy.Coder, models: Models, kind: int, value: int) -> int:
    return entropy.code_unsigned(coder, models.rare, np.zeros(1, np.int64), 0, _RARE_UNARY, value, kind)


NO_ROOM = 2  # what the kernel answers where it needs more memory
_DUMMIES, _TURNS, _STEPS, _TALLIES = 3, 4, 5, 8
_TURN_BYTES = 1024  # more than one triangle can take


class Guide(NamedTuple):
    """What only the encoder knows."""

    surface: Surface
    conquered: npt.NDArray[np.uint8]
    node: Ints
    number: Ints
    fans: Ints
    faces: Ints


class Conquest(NamedTuple):
    front: Front
    vertices: npt.NDArray[np.int64]
    faces: Ints
    tallies: npt.NDArray[np.int64]


def make_guide(surface: Surface, face_count: int) -> Guide:
    """For encoding `surface`, of which the first `face_count` faces are real."""
    halfedges = len(surface.twin)
    return Guide(
        surface,
        np.zeros(halfedges // 3, np.uint8),
        np.empty(halfedges, np.int32),
        np.full(len(surface.valence), -1, np.int32),
        np.empty(len(surface.vertex), np.int32),
        np.empty(face_count, np.int32),
    )


def make_conquest(face_count: int, fans: int, dummies: int) -> Conquest:
    tallies = np.zeros(_TALLIES, np.int64)
    tallies[_DUMMIES] = dummies
    tallies[_TURNS] = 4 * face_count  # each real face has at most three dummy neighbors
    tallies[_STEPS] = 65536 + 16 * face_count
    heads = np.full(_TAILS + _BUCKETS, -1, np.int32)
    heads[_MADE] = heads[_ALIVE] = 0
    front = Front(np.empty((fans + 16, _NODE_COLUMNS), np.int32), heads)
    return Conquest(front, np.empty((fans + dummies, 2), np.int64), np.empty((face_count, 3), np.int32), tallies)


_SLOTS = 32


class Seams(NamedTuple):
    """Working memory for the vertices of fans."""

    vertex: Ints
    after: Ints
    before: Ints
    sibling: Ints
    latest: Ints


def write_seams(coder: entropy.Coder, faces: Ints, vertices: Ints) -> None:
    """Write the vertex of every fan, shape (f,)."""
    size, origin = len(vertices), faces.reshape(-1)
    border = np.flatnonzero(match_halfedges(origin, size) < 0)
    after, before = np.full((2, size), -1, np.int32)  # fans along the boundary
    after[origin[border]] = np.roll(faces, -1, axis=1).reshape(-1)[border]
    at_border = np.flatnonzero(after >= 0)
    before[after[at_border]] = at_border
    vertex, sibling, latest = np.empty((3, size), np.int32)
    seams = Seams(vertex, after, before, sibling, latest)
    _kernels.code_fans(coder, entropy.make_bank(_SLOTS, 1, 1), vertices, seams)


_FIRST_CAPACITY = 1 << 16
_BYTES_PER_FAN = 32  # more than the vertex of a fan, or a corner of a degenerate face, can take


@dataclass(frozen=True, eq=False)
class EncodedConnectivity:
    payload: bytes
    vertex_order: Ints
    face_order: Ints
    faces: Ints


def encode_connectivity(faces: npt.ArrayLike, vertex_count: int) -> EncodedConnectivity:
    given = np.asarray(faces)
    if given.ndim != 2 or given.shape[1] != 3 or len(given) == 0 or given.dtype.kind not in "iu":
        raise MeshError(f"faces must be integers of shape (m, 3), m > 0, not {given.dtype} of shape {given.shape}")
    if given.min() < 0 or given.max() >= vertex_count:
        raise MeshError(f"faces refer to vertices {given.min()} to {given.max()}, outside 0..{vertex_count - 1}")
    given = np.ascontiguousarray(given, np.int32)
    degenerate = (given[:, 0] == given[:, 1]) | (given[:, 1] == given[:, 2]) | (given[:, 2] == given[:, 0])
    proper, improper = np.flatnonzero(~degenerate), np.flatnonzero(degenerate)
    surface = close_surface(given[proper] if len(improper) else given, vertex_count)
    fans, loops = len(surface.vertex), len(surface.valence) - len(surface.vertex)
    regular = int(np.count_nonzero(np.bincount(surface.vertex, minlength=vertex_count)))

    coder, models = entropy.start_writing(_FIRST_CAPACITY), make_models(vertex_count)
    for count in (len(improper), vertex_count - regular, fans - regular, loops):
        code_rare(coder, models, RARE_HEADER, count)
    guide, conquest = make_guide(surface, len(proper)), make_conquest(len(proper), fans, loops)
    coder, conquest = conquer(coder, models, guide, conquest)

    coder = entropy.make_room(coder, _BYTES_PER_FAN * (fans + 3 * len(improper)))
    used = np.concatenate([surface.vertex[guide.fans], given[improper].reshape(-1)])
    order, number = _number_by_appearance(used, vertex_count)
    if len(order) < vertex_count:
        missing = int(np.argmin(np.isin(np.arange(vertex_count), order)))
        raise MeshError(f"vertex {missing} is in no face; remove isolated vertices first")
    vertices = number[used[:fans]]
    if fans > regular:
        write_seams(coder, conquest.faces, vertices)
    corners = number[used[fans:]]
    _kernels.code_degenerate(coder, corners, regular)
    return EncodedConnectivity(
        entropy.finish_writing(coder),
        order,
        np.concatenate([proper[guide.faces], improper]).astype(np.int32),
        np.concatenate([vertices[conquest.faces], corners.reshape(-1, 3)]),
    )


def conquer(coder: entropy.Coder, models: Models, guide: Guide, conquest: Conquest) -> tuple[entropy.Coder, Conquest]:
    """Code the surface, with more memory each time that the kernel asks for it."""
    while _kernels.conquer(coder, models, guide, conquest) == NO_ROOM:
        nodes, heads = conquest.front
        front = Front(np.concatenate([nodes, np.empty_like(nodes)]), heads)
        coder, conquest = entropy.make_room(coder, _TURN_BYTES + len(coder.data)), conquest._replace(front=front)
    return coder, conquest


def _number_by_appearance(sequence: Ints, size: int) -> tuple[Ints, Ints]:
    order, number = np.empty(size, np.int32), np.empty(size, np.int32)
    count = _kernels.number_by_appearance(sequence, order, number)
    return order[:count].copy(), number
