"""Vertices at one position made one: files often give every triangle, or every seam, vertices of its own."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from bsm.codec.arrays import Faces, Indices, Order, Positions


def weld(positions: Positions, faces: Faces, *, bits: bool = False) -> tuple[Positions, Faces, Indices]:
    """Give the vertices of exactly equal positions one number."""
    values = np.ascontiguousarray(positions, dtype=np.float64)
    index = group_rows(values.view(np.int64) if bits else values)
    first = first_of(index)
    return (positions if len(first) == len(index) else positions[first]), index[faces], index


def group_rows(values: npt.NDArray[Any]) -> Indices:
    """The number, shape (n,), of what each row of `values`, shape (n, k), is equal to, in order of first appearance."""
    if values.dtype == np.float64:
        values = values + 0.0  # -0.0 + 0.0 is 0.0
    if _all_differ(values):
        return np.arange(len(values), dtype=np.int32)
    order = np.lexsort(values.T)
    ordered = values[order]
    new = np.ones(len(values), dtype=np.bool_)
    new[1:] = (ordered[1:] != ordered[:-1]).any(axis=1)
    # A stable sort leaves equal rows in ascending order, so the first of a group is its first appearance.
    first = order[new]
    rank = np.empty(len(first), dtype=np.int32)
    rank[np.argsort(first)] = np.arange(len(first), dtype=np.int32)
    index = np.empty(len(values), dtype=np.int32)
    index[order] = rank[np.cumsum(new) - 1]
    return index


def first_of(index: Indices) -> Order:
    """The first place of each number, shape (k,), in `index`, shape (n,), whose numbers appear in ascending order."""
    return np.flatnonzero(np.diff(np.maximum.accumulate(index), prepend=-1)).astype(np.int64)


def _all_differ(values: npt.NDArray[Any]) -> bool:
    """Whether no two rows can be equal: one sort of one number of each, where `group_rows` needs one of all."""
    bits = values.view(np.uint64)
    mixed = bits[:, 0] * np.uint64(0x9E3779B97F4A7C15)
    for axis in range(1, values.shape[1]):
        mixed = (mixed ^ (mixed >> np.uint64(29)) ^ bits[:, axis]) * np.uint64(0xBF58476D1CE4E5B9)
    mixed.sort()
    return bool((mixed[1:] != mixed[:-1]).all())
