"""The probability model of connectivity: which contexts predict a vertex's valence and the rarer events.

All functions serve both directions, by the coder they are given, and look only at what a decoder knows.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from bitstream.connectivity.front import APEX, FREE, NEXT, PREVIOUS, VERTEX, Front
from bitstream.entropy.range_coder import (
    ONE,
    Bank,
    Coder,
    code_mixed_bit,
    code_unsigned,
    leaf,
    make_bank,
    unsigned_span,
)

LABEL, SUM, RANK = range(3)
"""Columns of the table of vertices: valence as contexts see it (0 for a dummy, else 2 .. 15), sum of the known
neighbours' labels less 6 each, and number among the real vertices (-1 for a dummy)."""

VERTEX_COLUMNS = 4
VALENCE_CONTEXTS = 14
_VALENCE_NODES = 16
_LAST_UNARY = 16  # longer valences escape
_MULTIPLIER = 0x1E3779B97F4A7C15  # spreads packed features over a table, by the upper bits of the product

_EVENT_CONTEXTS = 3
_EVENT_SIZE = 4096

_RARE_UNARY = 2
_RARE_SPAN = unsigned_span(_RARE_UNARY)
RARE_LOOP, RARE_VALENCE, RARE_DUMMY, RARE_WAY, RARE_STEPS, RARE_HEADER = (k * _RARE_SPAN for k in range(6))
"""First node of the models of: length of a boundary loop, long valence, dummy or split, way and steps to the vertex
of a split, counts at the start of the payload."""


class Models(NamedTuple):
    """Adaptive state of one payload.

    Attributes
    ----------
    valence, event, rare : Bank
        For valences, for the decision whether a gate leads to a new vertex, and for everything else.
    contexts, event_contexts : int64 array
        Contexts of the valence and of the event that come next.
    zero : int64 array
        The only context of rare symbols.
    bits : int64 array
        Binary logarithm of the number of contexts in each hashed table of valences.
    """

    valence: Bank
    event: Bank
    rare: Bank
    contexts: npt.NDArray[np.int64]
    event_contexts: npt.NDArray[np.int64]
    zero: npt.NDArray[np.int64]
    bits: npt.NDArray[np.int64]


def make_models(vertex_count: int) -> Models:
    """Neutral models; the tables grow with the number of vertices, which both sides know."""
    bits = min(max(int(vertex_count).bit_length() - 2, 6), 12)
    return Models(
        make_bank((VALENCE_CONTEXTS << bits) * _VALENCE_NODES, _VALENCE_NODES, VALENCE_CONTEXTS, 1023, 16),
        make_bank(_EVENT_CONTEXTS * _EVENT_SIZE, 1, _EVENT_CONTEXTS, 1023, 16, ONE - ONE // 500, 30),
        make_bank(6 * _RARE_SPAN, 6 * _RARE_SPAN, 1),
        np.zeros(VALENCE_CONTEXTS, np.int64),
        np.zeros(_EVENT_CONTEXTS, np.int64),
        np.zeros(1, np.int64),
        np.array([bits], np.int64),
    )


@leaf
def code_rare(coder: Coder, models: Models, kind: int, value: int) -> int:
    """Code an unsigned integer of a rare kind."""
    return code_unsigned(coder, models.rare, models.zero, 0, _RARE_UNARY, value, kind)


@leaf
def code_rare_bit(coder: Coder, models: Models, kind: int, bit: int) -> int:
    """Code a decision of a rare kind."""
    return code_mixed_bit(coder, models.rare, models.zero, kind, 0, bit)


@leaf
def look_nowhere(models: Models) -> None:
    """Set the contexts for the first vertices of a component."""
    for i in range(VALENCE_CONTEXTS):
        models.contexts[i] = (i << models.bits[0]) * _VALENCE_NODES


@leaf
def _hash_contexts(models: Models) -> None:
    """Turn the packed features of each context into the place of its slots in its table."""
    bits = models.bits[0]
    for i in range(VALENCE_CONTEXTS):
        hashed = ((models.contexts[i] + 1) * _MULTIPLIER) >> (64 - bits) & ((1 << bits) - 1)
        models.contexts[i] = ((i << bits) + hashed) * _VALENCE_NODES


@leaf
def _four_bits(value: int) -> int:
    return min(max(value, 0), 15)


@leaf
def look_around(models: Models, front: Front, vertices: npt.NDArray[np.int32], latest: int, f: int) -> None:
    """Set the contexts for what lies beyond the gate of node `f`.

    The third vertex of the triangle beyond the edge from f to n, its next node, is neighbour to both; p is the node
    before f. Labels, free degrees and sums of these and of the vertices behind the adjacent edges are the evidence,
    and the label of the latest vertex.
    """
    nodes = front.nodes
    p, n = nodes[f, PREVIOUS], nodes[f, NEXT]
    pp, nn = nodes[p, PREVIOUS], nodes[n, NEXT]
    nnn = nodes[nn, NEXT]
    label_f, apex_f, free_f, sum_f = _features(front, vertices, f)
    label_n, apex_n, free_n, sum_n = _features(front, vertices, n)
    label_p, apex_p, free_p, sum_p = _features(front, vertices, p)
    label_nn, label_pp = vertices[nodes[nn, VERTEX], LABEL], vertices[nodes[pp, VERTEX], LABEL]
    label_nnn = vertices[nodes[nnn, VERTEX], LABEL]
    free_nn, free_pp = _four_bits(nodes[nn, FREE]), _four_bits(nodes[pp, FREE])
    known_f, known_n, known_p = (
        _four_bits(label_f - free_f),
        _four_bits(label_n - free_n),
        _four_bits(label_p - free_p),
    )
    loops = (label_f == 0) << 2 | (label_n == 0) << 1 | (label_p == 0)

    contexts = models.contexts
    contexts[0] = 0
    contexts[1] = label_f << 8 | label_n << 4 | apex_f
    contexts[2] = label_f << 4 | sum_f
    contexts[3] = label_f << 12 | label_n << 8 | apex_f << 4 | sum_f
    contexts[4] = label_n << 8 | apex_f << 4 | sum_n
    contexts[5] = label_p << 12 | sum_p << 8 | apex_p << 4 | free_f
    contexts[6] = free_p << 12 | free_n << 8 | label_p << 4 | free_nn
    contexts[7] = loops << 8 | free_nn << 4 | label_nn
    contexts[8] = loops << 4 | free_pp
    contexts[9] = loops << 16 | apex_p << 12 | known_f << 8 | label_p << 4 | free_n
    contexts[10] = free_f << 16 | free_p << 12 | label_f << 8 | label_n << 4 | label_p
    contexts[11] = (
        label_p << 24 | label_nn << 20 | known_p << 16 | known_n << 12 | apex_n << 8 | free_pp << 4 | label_pp
    )
    contexts[12] = apex_p << 24 | sum_n << 20 | latest << 16 | sum_f << 12 | free_f << 8 | sum_p << 4 | free_nn
    contexts[13] = loops << 24 | free_nn << 20 | apex_f << 16 | free_p << 12 | free_n << 8 | label_nnn << 4 | known_n
    _hash_contexts(models)

    events = models.event_contexts
    events[0] = free_f << 4 | free_n
    events[1] = _EVENT_SIZE + (free_f << 8 | free_p << 4 | free_n)
    events[2] = 2 * _EVENT_SIZE + loops


@leaf
def _features(front: Front, vertices: npt.NDArray[np.int32], node: int) -> tuple[int, int, int, int]:
    """Label, label of the vertex behind the gate, free degree and sum of a node, four bits each."""
    row = front.nodes[node]
    vertex = row[VERTEX]
    return (
        vertices[vertex, LABEL],
        vertices[row[APEX], LABEL],
        _four_bits(row[FREE]),
        _four_bits(vertices[vertex, SUM] + 7),
    )


@leaf
def code_usual(coder: Coder, models: Models, bit: int) -> int:
    """Code whether a gate leads to a new, real vertex."""
    return code_mixed_bit(coder, models.event, models.event_contexts, 0, 0, bit)


@leaf
def code_valence(coder: Coder, models: Models, valence: int) -> int:
    """Code a valence, at least 2: is it 6, is it less, and then one by one away from 6."""
    bank, contexts = models.valence, models.contexts
    if code_mixed_bit(coder, bank, contexts, 0, 0, 1 if valence == 6 else 0) != 0:
        return 6
    if code_mixed_bit(coder, bank, contexts, 1, 0, 1 if valence < 6 else 0) != 0:
        for k in range(3):
            if code_mixed_bit(coder, bank, contexts, 2 + k, 0, 1 if valence == 5 - k else 0) != 0:
                return 5 - k
        return 2
    for v in range(7, _LAST_UNARY + 1):
        if code_mixed_bit(coder, bank, contexts, v - 2, 0, 1 if valence == v else 0) != 0:
            return v
    return _LAST_UNARY + 1 + code_rare(coder, models, RARE_VALENCE, valence - _LAST_UNARY - 1)


@leaf
def label_of(valence: int) -> int:
    """How contexts see a valence."""
    return min(valence, 15)
