"""The part of each vertex, asked for among those of its neighbors, then one that is new, then any (C 10)."""

import numpy as np
import numpy.typing as npt

from bsm._core import bitstream as _kernels
from bsm.bitstream.entropy.range_coder import bank_of, finish_writing, start_writing

Indices = npt.NDArray[np.int32]


def encode_labels(offsets: Indices, neighbors: Indices, labels: Indices, parts: int) -> bytes:
    """Code `labels`, shape (n,), numbered by first appearance, over the graph that the decoder will have."""
    coder = start_writing(8 * len(labels) + 64)
    own = np.array(labels, np.int32, order="C")
    _kernels.code_labels(coder, bank_of("code_labels"), offsets, neighbors, own, parts)
    return finish_writing(coder)
