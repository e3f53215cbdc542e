"""Frames of the components of a field, a few at a time."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from bsm.codec import _kernels
from bsm.codec.arrays import Matrix

BATCH = 8
"""Frames that are reconstructed at a time, as many as a vector of the kernel has numbers."""


def shown_frames(field: Matrix, first: int, basis: Matrix) -> Iterator[Matrix]:
    """The frames, each of shape (n, d), of some columns of a field over a temporal basis."""
    width, frames, components = basis.shape
    for start in range(0, frames, BATCH):
        part = basis[:, start : start + BATCH]
        count = part.shape[1]
        weights = np.zeros((components, width, BATCH))
        weights[:, :, :count] = part.transpose(2, 0, 1)
        shown = np.empty((count, len(field), width))
        _kernels.show_frames(
            field, first, weights.reshape(components, width * BATCH), shown.reshape(count * len(field), width)
        )
        yield from shown
