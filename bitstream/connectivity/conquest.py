"""The conquest: triangle by triangle over a closed surface, the same walk for encoder and decoder.

After the first triangle of a component the front is that triangle's border. A node without free edges is closed by the
triangle to its neighbours, which costs nothing; else the triangle beyond the gate of the first node is added, and its
third vertex is told: a new vertex (with its valence, by which the decoder knows when to close it), the dummy vertex of
a boundary loop not met before, or a node already on the front (which splits one polygon of it or joins two).

References
----------
C. Touma, C. Gotsman, "Triangle mesh compression", Graphics Interface 1998; P. Alliez, M. Desbrun, "Valence-driven
connectivity encoding for 3D meshes", Eurographics 2001.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from bitstream.connectivity.front import (
    ALIVE,
    APEX,
    DEAD,
    FREE,
    GATE,
    MADE,
    NEXT,
    PREVIOUS,
    VERTEX,
    Front,
    add_node,
    enlarge_front,
    first_node,
    link_nodes,
    make_front,
    set_free,
)
from bitstream.connectivity.halfedges import Surface, next_halfedge, previous_halfedge
from bitstream.connectivity.valence_model import (
    LABEL,
    RANK,
    RARE_DUMMY,
    RARE_LOOP,
    RARE_STEPS,
    RARE_WAY,
    SUM,
    VERTEX_COLUMNS,
    Models,
    code_rare,
    code_rare_bit,
    code_usual,
    code_valence,
    label_of,
    look_around,
    look_nowhere,
)
from bitstream.entropy.range_coder import Coder, code_uniform, has_room, leaf, overran

Ints = npt.NDArray[np.int32]

DONE, NONSENSE, NO_ROOM = range(3)
"""How a call of `conquer` ends; without room, make some and call again."""

VERTICES, REAL, FACES, DUMMIES, TURNS, STEPS, START, LATEST = range(8)
"""Tallies of a conquest: vertices, real vertices and faces so far; dummies, triangles and steps along the front still
allowed; first face that the encoder may have left; label of the latest real vertex."""

TURN_BYTES = 1024
"""More than one triangle can take."""

REACH = 4096
"""A node further along the front than this is named by its number instead."""


class Guide(NamedTuple):
    """What only the encoder knows; a decoder has empty arrays.

    Attributes
    ----------
    surface : Surface
        The surface to conquer.
    conquered : uint8 array
        Which of its faces are behind the front.
    node : int32 array
        Node whose gate a half-edge is.
    number : int32 array
        Number of each fan and dummy in the order of conquest, or -1.
    fans : int32 array
        Fan of each real vertex in the order of conquest.
    faces : int32 array
        Face of the surface of each emitted face.
    """

    surface: Surface
    conquered: npt.NDArray[np.uint8]
    node: Ints
    number: Ints
    fans: Ints
    faces: Ints


class Conquest(NamedTuple):
    """What both sides know.

    Attributes
    ----------
    front : Front
        Border of the conquered part.
    vertices : int32 array, shape (fans + dummies, 4)
        Columns as in the model.
    faces : int32 array, shape (m, 3)
        Emitted faces.
    tallies : int64 array
        Counters.
    """

    front: Front
    vertices: Ints
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


def no_guide() -> Guide:
    """For decoding."""
    nothing = np.empty(0, np.int32)
    return make_guide(Surface(nothing, nothing, nothing, nothing), 0)


def make_conquest(face_count: int, fans: int, dummies: int) -> Conquest:
    """The state before the first triangle."""
    tallies = np.zeros(LATEST + 1, np.int64)
    tallies[DUMMIES] = dummies
    tallies[TURNS] = 4 * face_count  # each real face has at most three dummy neighbours
    tallies[STEPS] = 65536 + 16 * face_count
    vertices = np.empty((fans + dummies, VERTEX_COLUMNS), np.int32)
    return Conquest(make_front(fans + 16), vertices, np.empty((face_count, 3), np.int32), tallies)


def enlarge_conquest(conquest: Conquest) -> Conquest:
    """The same state with room for more nodes."""
    return conquest._replace(front=enlarge_front(conquest.front))


@leaf
def conquer(coder: Coder, models: Models, guide: Guide, conquest: Conquest) -> int:
    """Code the surface, from where the last call ran out of room.

    The encoder's guide tells each third vertex; without one, the coder's payload does.
    """
    front, vertices, faces, tallies = conquest
    while front.heads[ALIVE] > 0 or tallies[FACES] < len(faces):
        if front.heads[MADE] + 3 > len(front.nodes) or not has_room(coder, TURN_BYTES):
            return NO_ROOM
        tallies[TURNS] -= 1
        if tallies[TURNS] < 0 or overran(coder):
            return NONSENSE
        f = first_node(front)
        if f < 0:
            legal = _start_component(coder, models, guide, conquest)
        elif front.nodes[f, FREE] == 0:
            legal = _close_node(guide, conquest, f)
        else:
            legal = _pass_gate(coder, models, guide, conquest, f)
        if not legal:
            return NONSENSE
    return DONE if tallies[VERTICES] == len(vertices) else NONSENSE


@leaf
def _start_component(coder: Coder, models: Models, guide: Guide, conquest: Conquest) -> bool:
    """Make the border of the first face that is left, of three new vertices, the front."""
    front, vertices, _, tallies = conquest
    first, node, start = tallies[VERTICES], front.heads[MADE], tallies[START]
    if guide.conquered.size > 0:
        while guide.conquered[start] != 0:
            start += 1
        tallies[START] = start
    look_nowhere(models)
    for k in range(3):
        fan = guide.surface.corner[3 * start + k] if guide.conquered.size > 0 else 0
        valence = _add_vertex(coder, models, guide, conquest, fan, False)
        if valence < 0:
            return False
        add_node(front, first + k, valence - 2)
    for k in range(3):
        link_nodes(front, node + k, node + (k + 1) % 3)
        _meet(vertices, first + k, first + (k + 1) % 3)
        _set_gate(guide, front, node + k, first + (k + 2) % 3, 3 * start + k)
    return _emit(guide, conquest, first, first + 1, first + 2, start)


@leaf
def _close_node(guide: Guide, conquest: Conquest, f: int) -> bool:
    """Add the triangle of a node without free edges and its neighbours p and n, which makes an edge from p to n."""
    front, vertices = conquest.front, conquest.vertices
    nodes = front.nodes
    p, n, gate = nodes[f, PREVIOUS], nodes[f, NEXT], nodes[f, GATE]
    vf, vn, vp = nodes[f, VERTEX], nodes[n, VERTEX], nodes[p, VERTEX]
    if p == n or not _emit(guide, conquest, vn, vf, vp, gate // 3):
        return False
    set_free(front, f, DEAD)
    if nodes[n, NEXT] == p and nodes[p, FREE] == 0 and nodes[n, FREE] == 0:
        set_free(front, n, DEAD)
        set_free(front, p, DEAD)
        return True
    if nodes[p, FREE] == 0 or nodes[n, FREE] == 0:
        return False
    link_nodes(front, p, n)
    _set_gate(guide, front, p, vf, previous_halfedge(gate))
    _meet(vertices, vp, vn)
    set_free(front, n, nodes[n, FREE] - 1)
    set_free(front, p, nodes[p, FREE] - 1)
    return True


@leaf
def _pass_gate(coder: Coder, models: Models, guide: Guide, conquest: Conquest, f: int) -> bool:
    """Add the triangle beyond the edge from f to n, the next node; all nodes have free edges."""
    front, vertices, _, tallies = conquest
    nodes = front.nodes
    n, gate = nodes[f, NEXT], nodes[f, GATE]
    vf, vn = nodes[f, VERTEX], nodes[n, VERTEX]
    node, free, fan = -1, 0, 0  # the node to split at, its free edges on f's side, or else the new vertex
    usual = 1
    if guide.conquered.size > 0:
        fan = guide.surface.corner[previous_halfedge(gate)]
        if guide.number[fan] >= 0:
            node, free = _find_node(guide, front, gate)
        usual = 1 if node < 0 and fan < len(guide.fans) else 0

    look_around(models, front, vertices, tallies[LATEST], f)
    usual = code_usual(coder, models, usual)
    loop = 0
    if usual == 0 and tallies[DUMMIES] > 0:
        loop = code_rare_bit(coder, models, RARE_DUMMY, 1 if node < 0 else 0)
    if usual == 0 and loop == 0:
        node = _code_node(coder, models, conquest, guide.conquered.size > 0, f, node)
        if node < 0 or nodes[node, FREE] < 2:
            return False
        free = code_uniform(coder, free, nodes[node, FREE] - 1)
        vertex, before = nodes[node, VERTEX], nodes[node, PREVIOUS]
        other = add_node(front, vertex, nodes[node, FREE] - 2 - free)
        set_free(front, node, free)
        link_nodes(front, before, other)
    else:
        vertex = tallies[VERTICES]
        valence = _add_vertex(coder, models, guide, conquest, fan, loop != 0)
        if valence < 0:
            return False
        other = node = add_node(front, vertex, valence - 2)
    if not _emit(guide, conquest, vn, vf, vertex, gate // 3):
        return False
    link_nodes(front, f, node)
    link_nodes(front, other, n)
    _set_gate(guide, front, f, vn, next_halfedge(gate))
    _set_gate(guide, front, other, vf, previous_halfedge(gate))
    _meet(vertices, vertex, vf)
    _meet(vertices, vertex, vn)
    set_free(front, n, nodes[n, FREE] - 1)
    set_free(front, f, nodes[f, FREE] - 1)
    return True


@leaf
def _add_vertex(coder: Coder, models: Models, guide: Guide, conquest: Conquest, fan: int, dummy: bool) -> int:
    """Code the valence of a new vertex and enter it in the table; -1 if there are too many."""
    vertices, tallies = conquest.vertices, conquest.tallies
    vertex = tallies[VERTICES]
    valence = 2
    if guide.conquered.size > 0:
        valence = guide.surface.valence[fan]
        guide.number[fan] = vertex
    if vertex == len(vertices):
        return -1
    vertices[vertex, SUM] = 0
    if dummy:
        valence = 2 + code_rare(coder, models, RARE_LOOP, valence - 2)
        vertices[vertex, LABEL] = 0
        vertices[vertex, RANK] = -1
        tallies[DUMMIES] -= 1
    else:
        if vertex + tallies[DUMMIES] >= len(vertices):
            return -1
        valence = code_valence(coder, models, valence)
        vertices[vertex, LABEL] = label_of(valence)
        vertices[vertex, RANK] = tallies[REAL]
        if guide.conquered.size > 0:
            guide.fans[tallies[REAL]] = fan
        tallies[REAL] += 1
        tallies[LATEST] = label_of(valence)
    tallies[VERTICES] += 1
    return valence


@leaf
def _code_node(coder: Coder, models: Models, conquest: Conquest, writing: bool, f: int, node: int) -> int:
    """Code the node where a split happens: how many candidates along the front away, or else its number.

    Candidates have two free edges. All steps together are bounded, so that work is, too. Returns -1 for nonsense.
    """
    front, tallies = conquest.front, conquest.tallies
    reach = min(REACH, tallies[STEPS])
    way, count = 2, 0
    if writing:
        way, count = _search(front, f, node, reach)
    if code_rare_bit(coder, models, RARE_WAY, way >> 1) != 0:
        tallies[STEPS] -= reach
        return code_uniform(coder, node, front.heads[MADE])
    way = code_rare_bit(coder, models, RARE_WAY + 1, way)
    count = code_rare(coder, models, RARE_STEPS, count)
    a = f if way != 0 else front.nodes[f, NEXT]
    for _ in range(reach):
        a = front.nodes[a, NEXT + way]
        tallies[STEPS] -= 1
        if front.nodes[a, FREE] >= 2:
            count -= 1
            if count < 0:
                return a
    return -1


@leaf
def _search(front: Front, f: int, node: int, reach: int) -> tuple[int, int]:
    """Find a node on the polygon of f: 0 and the candidates passed going forward from the node after f, or 1 and those
    going backward from f, whichever is nearer; 2 if it is not within reach."""
    nodes = front.nodes
    a, b = nodes[f, NEXT], f
    forward, backward = 0, 0
    for _ in range(reach):
        a = nodes[a, NEXT]
        if a == node:
            return 0, forward
        b = nodes[b, PREVIOUS]
        if b == node:
            return 1, backward
        if a == f:
            break
        forward += 1 if nodes[a, FREE] >= 2 else 0
        backward += 1 if nodes[b, FREE] >= 2 else 0
    return 2, 0


@leaf
def _find_node(guide: Guide, front: Front, gate: int) -> tuple[int, int]:
    """Node at the third vertex of the triangle at `gate`, and its free edges between that triangle and its own gate.

    Turns around the vertex both ways at once until one side is conquered: a hub is not searched again and again.
    """
    twin, conquered = guide.surface.twin, guide.conquered
    inward, outward = next_halfedge(gate), previous_halfedge(gate)
    turns = -1
    while True:
        if conquered[twin[inward] // 3] != 0:
            return guide.node[inward], turns
        if conquered[twin[outward] // 3] != 0:
            node = front.nodes[guide.node[outward], NEXT]
            return node, front.nodes[node, FREE] - 2 - turns
        inward, outward = previous_halfedge(twin[inward]), next_halfedge(twin[outward])
        turns += 1


@leaf
def _emit(guide: Guide, conquest: Conquest, a: int, b: int, c: int, face: int) -> bool:
    """Add triangle (a, b, c) to what is conquered, and to the faces unless it is a dummy."""
    vertices, faces, tallies = conquest.vertices, conquest.faces, conquest.tallies
    if guide.conquered.size > 0:
        guide.conquered[face] = 1
    rank_a, rank_b, rank_c = vertices[a, RANK], vertices[b, RANK], vertices[c, RANK]
    if a == b or b == c or c == a:
        return False
    if rank_a < 0 or rank_b < 0 or rank_c < 0:
        return True
    number = tallies[FACES]
    if number == len(faces):
        return False
    faces[number, 0], faces[number, 1], faces[number, 2] = rank_a, rank_b, rank_c
    if guide.conquered.size > 0:
        guide.faces[number] = face
    tallies[FACES] += 1
    return True


@leaf
def _meet(vertices: Ints, a: int, b: int) -> None:
    """Tell the contexts of a new edge."""
    if vertices[a, LABEL] != 0:
        vertices[b, SUM] += vertices[a, LABEL] - 6
    if vertices[b, LABEL] != 0:
        vertices[a, SUM] += vertices[b, LABEL] - 6


@leaf
def _set_gate(guide: Guide, front: Front, node: int, apex: int, halfedge: int) -> None:
    """The edge from `node` to its next one has become a gate, with `halfedge` on the conquered side."""
    front.nodes[node, APEX] = apex
    if guide.conquered.size > 0:
        gate = guide.surface.twin[halfedge]
        front.nodes[node, GATE] = gate
        guide.node[gate] = node
