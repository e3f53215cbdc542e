"""The probability model of connectivity: which contexts predict a vertex's valence and the rarer events.

The contexts themselves are in `valence_model.h`; they look only at what a decoder knows.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from bsm.bitstream.entropy.range_coder import ONE, Bank, Coder, code_unsigned, make_bank, unsigned_span

_VALENCE_CONTEXTS = 14
_VALENCE_NODES = 16

_EVENT_CONTEXTS = 3
_EVENT_SIZE = 4096

_RARE_UNARY = 2
_RARE_SPAN = unsigned_span(_RARE_UNARY)
_RARE_KINDS = 6
RARE_HEADER = 5 * _RARE_SPAN
"""First node of the model of the counts at the start of the payload."""


class Models(NamedTuple):
    """Adaptive state of one payload."""

    valence: Bank
    event: Bank
    rare: Bank
    bits: int


def make_models(vertex_count: int) -> Models:
    """Neutral models; the tables grow with the number of vertices, which both sides know."""
    bits = min(max(int(vertex_count).bit_length() - 2, 6), 12)
    return Models(
        make_bank((_VALENCE_CONTEXTS << bits) * _VALENCE_NODES, _VALENCE_NODES, _VALENCE_CONTEXTS, 1023, 16),
        make_bank(_EVENT_CONTEXTS * _EVENT_SIZE, 1, _EVENT_CONTEXTS, 1023, 16, ONE - ONE // 500, 30),
        make_bank(_RARE_KINDS * _RARE_SPAN, _RARE_KINDS * _RARE_SPAN, 1),
        bits,
    )


def code_rare(coder: Coder, models: Models, kind: int, value: int) -> int:
    """Code an unsigned integer of a rare kind."""
    return code_unsigned(coder, models.rare, np.zeros(1, np.int64), 0, _RARE_UNARY, value, kind)
