"""Permutations and corner rotations to bytes and back, for who wants a mesh in exactly the order it had.

Each entry is coded by how many entries not used yet lie between it and the one that follows the entry before, so a
permutation that keeps runs or even steps is cheap, and one without any order costs about its entropy.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from bitstream.entropy.range_coder import (
    Bank,
    Coder,
    code_mixed_bit,
    code_signed,
    finish_reading,
    finish_writing,
    is_reading,
    leaf,
    make_bank,
    make_room,
    overran,
    signed_span,
    start_reading,
    start_writing,
)
from bitstream.errors import CorruptError, OptionError, TruncatedError

Ints = npt.NDArray[np.int32]

_UNARY = 6
_SAME = signed_span(_UNARY)
_SPAN = _SAME + 1
_INPUTS = 4
_CLASSES = 32
_STEP_BYTES = 128  # more than one entry can take


def encode_permutation(order: npt.ArrayLike) -> bytes:
    """Encode a permutation of 0 .. n - 1, n below 2**24.

    Raises
    ------
    OptionError
        If it is none.
    """
    values = np.array(order, np.int32)
    coder = start_writing(0)
    return finish_writing(code_permutation(coder, values))


def decode_permutation(payload: bytes, size: int) -> Ints:
    """Decode a permutation of `size` entries.

    Raises
    ------
    CorruptError, TruncatedError
        If the payload is not one.
    """
    values = np.zeros(size, np.int32)
    finish_reading(code_permutation(start_reading(payload), values))
    return values


def encode_rotations(rotations: npt.ArrayLike) -> bytes:
    """Encode integers 0, 1 and 2; raises `OptionError` on others."""
    values = np.array(rotations, np.int32)
    return finish_writing(code_rotations(start_writing(0), values))


def decode_rotations(payload: bytes, size: int) -> Ints:
    """Twin of `encode_rotations`; raises `CorruptError` or `TruncatedError`."""
    values = np.zeros(size, np.int32)
    finish_reading(code_rotations(start_reading(payload), values))
    return values


def code_permutation(coder: Coder, values: Ints) -> Coder:
    """Write the permutation `values`, or read it into `values`; return the coder to go on with.

    Raises
    ------
    OptionError
        If what is to be written is not a permutation of fewer than 2**24 entries.
    CorruptError, TruncatedError
        If what is read is none.
    """
    size = len(values)
    if not is_reading(coder):
        if values.ndim != 1 or size >> 24 or not _is_permutation(values):
            raise OptionError("not a permutation of fewer than 2**24 entries, counted from 0")
        coder = make_room(coder, _STEP_BYTES * size)
    bank = make_bank((1 + _CLASSES + 2 * _CLASSES * _CLASSES) * _SPAN, _SPAN, _INPUTS)
    legal = _code_steps(coder, bank, np.empty(_INPUTS, np.int64), values, _full_tree(size))
    return _checked(coder, legal, f"a permutation of {size} entries")


def code_rotations(coder: Coder, values: Ints) -> Coder:
    """Write integers 0, 1 and 2, or read them into `values`; as `code_permutation`."""
    if not is_reading(coder):
        if values.ndim != 1 or (len(values) and (values.min() < 0 or values.max() > 2)):
            raise OptionError("rotations of a triangle's corners are 0, 1 or 2")
        coder = make_room(coder, 4 * len(values))
    bank = make_bank(3 * (9 + 27), 2, 2)
    legal = _code_rotations(coder, bank, np.empty(2, np.int64), values)
    return _checked(coder, legal, f"{len(values)} rotations")


def _checked(coder: Coder, legal: bool, what: str) -> Coder:
    if overran(coder):
        raise TruncatedError(f"the payload of {what} ends too early")
    if not legal:
        raise CorruptError(f"the payload is not {what}")
    return coder


def _is_permutation(values: Ints) -> bool:
    size = len(values)
    if size and (values.min() < 0 or values.max() >= size):
        return False
    return bool((np.bincount(values, minlength=size) == 1).all())


def _full_tree(size: int) -> Ints:
    """A Fenwick tree of ones: entry k counts what is left of the last (k & -k) positions up to k."""
    k = np.arange(size + 1, dtype=np.int32)
    return k & -k


@leaf
def _count_before(tree: Ints, position: int) -> int:
    """How many of the positions before `position` are left."""
    total = 0
    while position > 0:
        total += tree[position]
        position &= position - 1
    return total


@leaf
def _take(tree: Ints, rank: int) -> int:
    """Find the position that has `rank` others left before it, and use it up."""
    size = len(tree) - 1
    step = 1
    while 2 * step <= size:
        step *= 2
    position, rest = 0, rank
    while step > 0:
        if position + step <= size and tree[position + step] <= rest:
            position += step
            rest -= tree[position]
        step >>= 1
    k = position + 1
    while k <= size:
        tree[k] -= 1
        k += k & -k
    return position


@leaf
def _class(step: int) -> int:
    """Sign and magnitude of a step, coarsely: 0 .. 31."""
    magnitude, size = abs(step), 0
    while magnitude > 0 and size < 15:
        magnitude >>= 1
        size += 1
    return size if step >= 0 else 16 + size


@leaf
def _code_steps(coder: Coder, bank: Bank, contexts: npt.NDArray[np.int64], values: Ints, tree: Ints) -> bool:
    size = len(values)
    expected, repeated = 0, 0
    last, older, oldest = 0, 0, 0
    for i in range(size):
        if overran(coder):
            return False
        rank = _count_before(tree, expected)
        contexts[0] = 0
        contexts[1] = _SPAN * (1 + last)
        contexts[2] = _SPAN * (1 + _CLASSES + _CLASSES * older + last)
        contexts[3] = _SPAN * (1 + _CLASSES + _CLASSES * _CLASSES + _CLASSES * oldest + older)
        step = _count_before(tree, values[i]) - rank
        if code_mixed_bit(coder, bank, contexts, _SAME, 0, 1 if step == repeated else 0) != 0:
            step = repeated
        else:
            step = code_signed(coder, bank, contexts, 0, _UNARY, step)
        if rank + step < 0 or rank + step >= size - i:
            return False
        values[i] = _take(tree, rank + step)
        expected = values[i] + 1
        last, older, oldest = _class(step), last, older
        repeated = step
    return True


@leaf
def _code_rotations(coder: Coder, bank: Bank, contexts: npt.NDArray[np.int64], values: Ints) -> bool:
    history = 0
    for i in range(len(values)):
        if overran(coder):
            return False
        contexts[0] = 3 * (history % 9)
        contexts[1] = 3 * (9 + history)
        value = code_mixed_bit(coder, bank, contexts, 0, 0, 1 if values[i] > 0 else 0)
        if value != 0:
            value += code_mixed_bit(coder, bank, contexts, 1, 0, 1 if values[i] > 1 else 0)
        values[i] = value
        history = (history * 3 + value) % 27
    return True
