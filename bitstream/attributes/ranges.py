"""How many numbers a value has, and how large they may be."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import MeshError, OptionError

Ints = npt.NDArray[np.int32]

MOST_COMPONENTS = 4
MOST_LARGEST = (1 << 20) - 1
"""Values are 0 to at most this."""


def checked_largest(largest: npt.ArrayLike) -> Ints:
    """`largest`, shape (c,), as int32; raises `OptionError`."""
    top = np.array(largest, np.int64)
    if top.ndim != 1 or not 1 <= len(top) <= MOST_COMPONENTS or top.min() < 0 or top.max() > MOST_LARGEST:
        raise OptionError(
            f"{top.tolist()}: the largest values must be 1 to {MOST_COMPONENTS}, from 0 to {MOST_LARGEST}"
        )
    return top.astype(np.int32)


def checked_values(values: npt.ArrayLike, largest: Ints) -> npt.NDArray[np.integer]:
    """`values` as an array of integers, shape (n, c), from 0 to `largest`, shape (c,); raises `MeshError`."""
    given = np.asarray(values)
    if given.ndim != 2 or given.shape[1] != len(largest) or given.dtype.kind not in "iu":
        raise MeshError(f"values must be integers of shape (n, {len(largest)}), not {given.dtype} of {given.shape}")
    if ((given < 0) | (given > largest)).any():
        raise MeshError(f"values are outside their range, 0 to {largest}")
    return given
