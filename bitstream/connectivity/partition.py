"""Partition, method 0: the part of each vertex, coded from the parts of the neighbours that are known already.

Vertices are visited in their order. Most of them lie where their known neighbours do; the label of the neighbour last
coded, then other labels around, are asked for one by one, then the next label that was never used, then any.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from numba import njit

from bitstream.entropy.range_coder import (
    code_mixed_bit,
    code_uniform,
    finish_reading,
    finish_writing,
    make_bank,
    overran,
    start_reading,
    start_writing,
)
from bitstream.errors import CorruptError

Indices = npt.NDArray[np.int32]

_CANDIDATES = 4
_INPUTS = 3
_CONTEXTS = 16 * (_CANDIDATES + 1)


def encode_labels(offsets: Indices, neighbours: Indices, labels: Indices, parts: int) -> bytes:
    """Code `labels`, numbered by first appearance, over the graph (CSR) that the decoder will have."""
    coder = start_writing(8 * len(labels) + 64)
    bank = make_bank(_INPUTS * _CONTEXTS, _CANDIDATES + 1, _INPUTS)
    _code_labels(coder, bank, offsets, neighbours, labels.astype(np.int32), parts)
    return finish_writing(coder)


def decode_labels(data: bytes, offsets: Indices, neighbours: Indices, parts: int) -> Indices:
    """Twin of `encode_labels`.

    Raises
    ------
    CorruptError, TruncatedError
        If `data` is not a partition of the graph into exactly `parts` parts.
    """
    labels = np.zeros(len(offsets) - 1, np.int32)
    coder = start_reading(data)
    bank = make_bank(_INPUTS * _CONTEXTS, _CANDIDATES + 1, _INPUTS)
    used = _code_labels(coder, bank, offsets, neighbours, labels, parts)
    finish_reading(coder)
    if used != parts:
        raise CorruptError(f"the partition has {used} parts where the header has {parts}")
    return labels


@njit(cache=True, nogil=True)
def _code_labels(coder, bank, offsets, neighbours, labels, parts):  # type: ignore[no-untyped-def]
    """Code all labels in place; returns how many distinct ones there are, or -1 where the data is beyond its end."""
    n = len(labels)
    used = 0
    candidates = np.empty(_CANDIDATES, np.int32)
    votes = np.empty(_CANDIDATES, np.int32)
    contexts = np.empty(_INPUTS, np.int64)
    for v in range(n):
        if overran(coder):
            return -1
        found = 0
        known = 0
        for i in range(offsets[v + 1] - 1, offsets[v] - 1, -1):
            w = neighbours[i]
            if w >= v:
                continue
            known += 1
            k = 0
            while k < found and candidates[k] != labels[w]:
                k += 1
            if k < found:
                votes[k] += 1
            elif found < _CANDIDATES:
                candidates[found] = labels[w]
                votes[found] = 1
                found += 1
        # Most votes first; the later neighbour first on a draw.
        for a in range(1, found):
            b = a
            while b > 0 and votes[b] > votes[b - 1]:
                votes[b], votes[b - 1] = votes[b - 1], votes[b]
                candidates[b], candidates[b - 1] = candidates[b - 1], candidates[b]
                b -= 1
        label = -1
        for k in range(found):
            base = 16 * k
            contexts[0] = base + min(known, 15)
            contexts[1] = _CONTEXTS + base + min(votes[k], 7) + (8 if found > k + 1 else 0)
            contexts[2] = 2 * _CONTEXTS + base + min(3, known - votes[k]) + 4 * min(3, found - 1)
            if code_mixed_bit(coder, bank, contexts, 0, k, 1 if labels[v] == candidates[k] else 0) != 0:
                label = candidates[k]
                break
        if label == -1:
            contexts[0] = 16 * _CANDIDATES
            contexts[1] = _CONTEXTS + 16 * _CANDIDATES + min(found, 4)
            contexts[2] = 2 * _CONTEXTS + 16 * _CANDIDATES + (1 if used < parts else 0)
            fresh = code_mixed_bit(coder, bank, contexts, 0, _CANDIDATES, 1 if labels[v] == used else 0)
            if fresh != 0 or used == 0:
                label = used
                used += 1
                if used > parts:
                    return -1
            else:
                label = code_uniform(coder, labels[v], used)
        labels[v] = label
    return used
