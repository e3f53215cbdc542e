"""An adaptive binary arithmetic coder with logistic mixing of several context models, in integers only.

One function serves both directions. A `Coder` either writes or reads, and that is data inside it: a kernel that
models symbols calls ``bit = code_mixed_bit(coder, bank, contexts, node, selector, bit)`` and takes the returned bit;
when the coder reads, the argument ``bit`` is ignored. So encoder and decoder cannot drift apart.

How to use it, in a compiled kernel (``@njit(cache=True, nogil=True)``)::

    bank = make_bank(slots=..., selectors=..., inputs=3)       # Python: all adaptive state, starts neutral
    coder = start_writing(capacity) / start_reading(payload)   # Python

    contexts = np.empty(3, np.int64)                           # in the kernel, one array reused for all symbols
    contexts[0] = base0 + span * first_context                 # where the slots of this context begin
    contexts[1] = base1 + span * second_context
    contexts[2] = base2
    value = code_unsigned(coder, bank, contexts, selector, unary, value)

    payload = finish_writing(coder) / finish_reading(coder)    # Python

- A *slot* is one adaptive probability. A *context* is the index of the first of a span of slots; the decision number
  `node` of a binarised symbol uses slot ``context + node`` of every context. `code_unsigned` uses
  ``unsigned_span(unary)`` nodes, `code_signed` two more, `code_mixed_bit` the one node it is given.
- A *selector* chooses the set of mixing weights; decision `node` uses set ``selector + node``, so a symbol needs as
  many sets as nodes. Selectors should be few: each set has to learn.
- The caller keeps every index inside the bank (compiled code does not check), also on hostile data: derive
  contexts from clamped values.
- Bank and coder are separate: several payloads, each with its own coder, may go on learning in one bank;
  `reset_bank` forgets, `copy_bank` takes a snapshot.
- Reading past the end yields zeros; `finish_reading` and `overran` tell. A kernel that loops over hostile data
  checks ``overran(coder)`` now and then and stops.

Everything is integer arithmetic with defined rounding (shifts round down), so all machines agree to the bit.

References
----------
M. Mahoney, "Adaptive weighing of context models for lossless data compression", Florida Tech CS-2005-16 (logistic
mixing); the byte-wise range coder follows G. N. N. Martin, "Range encoding", 1979, with carries resolved in the buffer.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
from numba import njit

from bitstream.errors import CorruptError, OptionError, TruncatedError

ONE = 1 << 16
"""Probabilities that are coded are integers in 1 .. ONE - 1."""

_LEAF_OPTIONS: dict[str, Any] = {"cache": True, "nogil": True, "_nrt": False}
leaf: Any = njit(**_LEAF_OPTIONS)
"""Compiles a function that allocates nothing, without reference counts: five times faster to call with a `Bank`."""

_LOW, _RANGE, _POSITION, _READING, _FULL = range(5)
_TOP = 1 << 24
_REACH = 2880  # log-odds are in units of 1/256 nat, within -_REACH .. _REACH - 1
_STRETCH_BITS = 12
_COUNT_BITS = 10
_PROBABILITY_BITS = 22
_MAX_COUNT = (1 << _COUNT_BITS) - 1
_SUFFIX_NODES = 24


def _squash_table() -> npt.NDArray[np.int32]:
    """ONE / (1 + exp(-x / 256)) for x = -_REACH .. _REACH - 1, rounded, by exact integers: the same everywhere."""
    scale = 1 << 128
    step, term = scale, scale  # exp(1/256) by its series
    for k in range(1, 20):
        term //= 256 * k
        step += term
    powers = [scale]  # exp(x / 256)
    for _ in range(_REACH):
        powers.append(powers[-1] * step // scale)
    upper = [(2 * ONE * power + power + scale) // (2 * (power + scale)) for power in powers]
    table = [ONE - upper[x] for x in range(_REACH, 0, -1)] + upper[:_REACH]
    return np.clip(np.array(table, dtype=np.int32), 1, ONE - 1)


def _stretch_table(squash: npt.NDArray[np.int32]) -> npt.NDArray[np.int32]:
    """The least log-odds whose probability reaches the middle of each of 2**_STRETCH_BITS equal cells, made odd."""
    half = 1 << (_STRETCH_BITS - 1)
    width = ONE >> _STRETCH_BITS
    centres = (np.arange(half, 2 * half) * width) + width // 2
    upper = np.searchsorted(squash, centres, side="left").astype(np.int32) - _REACH
    return np.concatenate([-upper[::-1], upper])


_SQUASH = _squash_table()
_STRETCH = _stretch_table(_SQUASH)
_RECIPROCAL = np.array([2 * ONE // (2 * n + 3) for n in range(_MAX_COUNT + 1)], dtype=np.int32)


class Coder(NamedTuple):
    """A range coder over a buffer; made by `start_writing` or `start_reading`.

    Attributes
    ----------
    state : int64 array
        Low end (writing) or code minus low end (reading), range, position, direction, overflow.
    data : uint8 array
        What is written or read.
    """

    state: npt.NDArray[np.int64]
    data: npt.NDArray[np.uint8]


class Bank(NamedTuple):
    """The adaptive state of a model; made by `make_bank`.

    Attributes
    ----------
    slots : uint32 array
        Probability of a one (upper 22 bits) and how often the slot was used (lower 10 bits, saturating).
    weights : int32 array, shape (selectors, inputs)
        Mixing weights, 1.0 = 65536.
    inputs : int64 array
        Scratch.
    settings : int64 array
        Largest count, learning rate of the mixer, initial weight, initial slot.
    """

    slots: npt.NDArray[np.uint32]
    weights: npt.NDArray[np.int32]
    inputs: npt.NDArray[np.int64]
    settings: npt.NDArray[np.int64]


def make_bank(
    slots: int,
    selectors: int,
    inputs: int,
    limit: int = 255,
    rate: int = 14,
    probability: int = ONE // 2,
    trust: int = 0,
) -> Bank:
    """Make a neutral bank.

    Parameters
    ----------
    slots : int
        Number of adaptive probabilities.
    selectors : int
        Number of weight sets.
    inputs : int
        Number of contexts mixed in each decision.
    limit : int
        A slot adapts with rate 1/(n + 1.5) until it was used `limit` times (at most 1023), then with a constant rate.
    rate : int
        Learning rate of the mixing weights, 2 (slow) to 20 (fast).
    probability, trust : int
        What a slot predicts before it was used, out of `ONE`, and after how many uses it would have learnt that.
    """
    if not (slots > 0 and selectors > 0 and inputs > 0 and 0 < limit <= _MAX_COUNT and rate > 0):
        raise OptionError("a bank needs slots, selectors, inputs and rate > 0, and limit in 1..1023")
    if not (0 < probability < ONE and 0 <= trust <= limit):
        raise OptionError(f"the first probability must be in 1..{ONE - 1}, and trust in 0..limit")
    initial = ONE // inputs if inputs < 3 else ONE * 5 // (4 * inputs)
    bank = Bank(
        np.empty(slots, np.uint32),
        np.empty((selectors, inputs), np.int32),
        np.zeros(inputs, np.int64),
        np.array([limit, rate, initial, probability << 16 | trust], np.int64),
    )
    reset_bank(bank)
    return bank


def reset_bank(bank: Bank) -> None:
    """Forget everything that `bank` has learnt, in place."""
    bank.slots[:] = bank.settings[3]
    bank.weights[:] = bank.settings[2]


def copy_bank(bank: Bank) -> Bank:
    """Return an independent snapshot of `bank`."""
    return Bank(bank.slots.copy(), bank.weights.copy(), bank.inputs.copy(), bank.settings.copy())


def start_writing(capacity: int) -> Coder:
    """Make a coder that writes at most `capacity` bytes; one coded bit takes two bytes at the very most."""
    return Coder(np.array([0, (1 << 32) - 1, 0, 0, 0], np.int64), np.empty(capacity + 8, np.uint8))


def make_room(coder: Coder, capacity: int) -> Coder:
    """Return a coder that continues `coder` and reads, or can write at least `capacity` bytes more."""
    if has_room(coder, capacity):
        return coder
    written = int(coder.state[_POSITION])
    data = np.empty(written + capacity + 8, np.uint8)
    data[:written] = coder.data[:written]
    return Coder(coder.state, data)


def is_reading(coder: Coder) -> bool:
    """Whether the coder reads."""
    return bool(coder.state[_READING])


@leaf
def has_room(coder: Coder, capacity: int) -> bool:
    """Whether the coder reads, or can write at least `capacity` bytes more."""
    return coder.state[_READING] != 0 or coder.state[_POSITION] + capacity < coder.data.size


def start_reading(payload: bytes) -> Coder:
    """Make a coder that reads `payload`.

    Raises
    ------
    CorruptError
        If it begins with four bytes of 255, where the low end and the range cannot be.
    """
    data = np.frombuffer(payload, np.uint8).copy()
    code, width = int.from_bytes(payload[:4].ljust(4, b"\0"), "big"), (1 << 32) - 1
    if code >= width:
        raise CorruptError("an entropy-coded payload cannot begin with ff ff ff ff")
    return Coder(np.array([code, width, 4, 1, 0], np.int64), data)


def finish_writing(coder: Coder) -> bytes:
    """Return the payload: everything written, and the fewest bytes that still tell the last decision.

    Raises
    ------
    OptionError
        If the capacity given to `start_writing` was too small.
    """
    low, width, position = (int(x) for x in coder.state[:3])
    if coder.state[_FULL]:
        raise OptionError(f"the payload needs more than the {len(coder.data) - 8} bytes of capacity given")
    written = int.from_bytes(coder.data[:position].tobytes(), "big")
    for kept in range(5):
        unit = 1 << (32 - 8 * kept)
        value = -(-low // unit) * unit
        if value < low + width:
            break
    total = (written << 32) + value
    return total.to_bytes(position + 4, "big")[: position + kept]


def finish_reading(coder: Coder) -> None:
    """Check that a payload was read exactly to its end.

    Raises
    ------
    TruncatedError
        If more was read than there is.
    CorruptError
        If bytes are left over.
    """
    position, size = int(coder.state[_POSITION]), len(coder.data)
    if position > size + 4:
        raise TruncatedError(f"an entropy-coded payload of {size} bytes ends before its last symbol")
    if position < size:
        raise CorruptError(f"{size - position} bytes are left over after the last symbol of a payload")


@leaf
def overran(coder: Coder) -> bool:
    """Whether more was read than any complete payload of this length can hold."""
    return coder.state[_READING] != 0 and coder.state[_POSITION] > coder.data.size + 4


@leaf
def _renormalise(coder: Coder) -> None:
    """Shift bytes out of (or into) the range until it is at least _TOP: at most two of them after one decision."""
    state, data = coder
    low, width, position = state[_LOW], state[_RANGE], state[_POSITION]
    while width < _TOP:
        width <<= 8
        if state[_READING] != 0:
            low <<= 8
            if position < data.size:
                low |= np.int64(data[position])
        else:
            if position + 1 < data.size:
                data[position] = low >> 24
            else:
                state[_FULL] = 1
                position -= 1
            low = (low & (_TOP - 1)) << 8
        position += 1
    state[_LOW], state[_RANGE], state[_POSITION] = low, width, position


@leaf
def _carry(coder: Coder) -> None:
    """Add the carry of the low end to the bytes already written."""
    state, data = coder
    state[_LOW] -= 1 << 32
    k = state[_POSITION] - 1
    while k > 0 and data[k] == 255:
        data[k] = 0
        k -= 1
    data[k] += 1


@leaf
def code_bit(coder: Coder, probability: int, bit: int) -> int:
    """Code one decision.

    Parameters
    ----------
    coder : Coder
        Writes `bit`, or reads and ignores it.
    probability : int
        Of a one, in 1 .. ONE - 1; the reader must know the same.
    bit : int
        0 or 1.

    Returns
    -------
    int
        The decision, 0 or 1.
    """
    state = coder.state
    bound = (state[_RANGE] * probability) >> 16
    if state[_READING] != 0:
        bit = 1 if state[_LOW] < bound else 0
        if bit == 0:
            state[_LOW] -= bound
    elif bit == 0:
        state[_LOW] += bound
        if state[_LOW] >> 32 != 0:
            _carry(coder)
    if bit != 0:
        state[_RANGE] = bound
    else:
        state[_RANGE] -= bound
    if state[_RANGE] < _TOP:
        _renormalise(coder)
    return bit


@leaf
def code_uniform(coder: Coder, value: int, count: int) -> int:
    """Code an integer in 0 .. count - 1, all equally likely; `count` in 1 .. 2**32.

    What hostile data has beyond is read as count - 1.
    """
    if count <= ONE:
        return _code_uniform_16(coder, value, count)
    high = _code_uniform_16(coder, value >> 16, ((count - 1) >> 16) + 1)
    return min((high << 16) | _code_uniform_16(coder, value & (ONE - 1), ONE), count - 1)


@leaf
def _code_uniform_16(coder: Coder, value: int, count: int) -> int:
    """Code an integer in 0 .. count - 1, all equally likely; `count` at most 65536."""
    state = coder.state
    unit = state[_RANGE] // count
    if state[_READING] != 0:
        value = min(state[_LOW] // unit, count - 1)
        state[_LOW] -= value * unit
    else:
        state[_LOW] += value * unit
        if state[_LOW] >> 32 != 0:
            _carry(coder)
    # The last value takes what the division leaves over.
    state[_RANGE] = unit if value < count - 1 else state[_RANGE] - value * unit
    if state[_RANGE] < _TOP:
        _renormalise(coder)
    return value


@leaf
def code_mixed_bit(
    coder: Coder, bank: Bank, contexts: npt.NDArray[np.int64], node: int, selector: int, bit: int
) -> int:
    """Predict a decision from all contexts, code it, and learn from it.

    Parameters
    ----------
    coder, bank : Coder, Bank
        Where to, and by which model.
    contexts : int64 array, shape (inputs,)
        First slot of each context; the decision uses the slots ``contexts + node``.
    node, selector : int
        Number of the decision within its symbol; first of the symbol's weight sets.
    bit : int
        0 or 1, ignored when reading.
    """
    slots, weights, inputs, settings = bank
    row = selector + node
    size = inputs.size
    probability = mixed_probability(bank, contexts, node, selector)
    bit = code_bit(coder, probability, bit)

    error = ((bit << 16) - probability) * settings[1]
    target = bit * ((1 << _PROBABILITY_BITS) - 1)
    limit = settings[0]
    for i in range(size):
        weights[row, i] += (inputs[i] * error + (1 << 19)) >> 20
        slot = np.int64(slots[contexts[i] + node])
        value, count = slot >> _COUNT_BITS, slot & _MAX_COUNT
        value += ((target - value) * np.int64(_RECIPROCAL[count])) >> 16
        count += 1 if count < limit else 0
        slots[contexts[i] + node] = (value << _COUNT_BITS) | count
    return bit


@leaf
def mixed_probability(bank: Bank, contexts: npt.NDArray[np.int64], node: int, selector: int) -> Any:
    """Probability of a one, in 1 .. ONE - 1, with which `code_mixed_bit` would code this decision."""
    slots, weights, inputs, _ = bank
    row = selector + node
    total = np.int64(0)
    for i in range(inputs.size):
        stretched = np.int64(_STRETCH[slots[contexts[i] + node] >> (32 - _STRETCH_BITS)])
        inputs[i] = stretched
        total += stretched * np.int64(weights[row, i])
    return _squash(total >> 16)


@leaf
def _squash(odds: Any) -> Any:
    return np.int64(_SQUASH[min(max(odds, -_REACH), _REACH - 1) + _REACH])


def unsigned_span(unary: int) -> int:
    """Number of nodes (slots per context, and selectors) that `code_unsigned` uses."""
    return unary + _SUFFIX_NODES + 2


def signed_span(unary: int) -> int:
    """Number of nodes that `code_signed` uses."""
    return unsigned_span(unary) + 2


@leaf
def code_unsigned(
    coder: Coder, bank: Bank, contexts: npt.NDArray[np.int64], selector: int, unary: int, value: int, node: int = 0
) -> int:
    """Code an integer in 0 .. 2**24 - 2 + unary: a unary prefix, then an Exp-Golomb escape.

    Parameters
    ----------
    coder, bank, contexts, selector
        As for `code_mixed_bit`; each context, and the selector, owns `unsigned_span(unary)` slots from `node` on.
    unary : int
        Values below are coded by value + 1 mixed decisions.
    value : int
        Ignored when reading.
    node : int
        Number of the first decision.
    """
    for k in range(unary):
        if code_mixed_bit(coder, bank, contexts, node + k, selector, 1 if value > k else 0) == 0:
            return k
    rest = value - unary + 1
    size = 0
    while size < _SUFFIX_NODES - 1:
        more = code_mixed_bit(coder, bank, contexts, node + unary + size, selector, 1 if rest >> (size + 1) > 0 else 0)
        if more == 0:
            break
        size += 1
    result = 1
    if size > 0:  # the leading bit below the first is worth modelling, the others are noise
        leading = code_mixed_bit(
            coder, bank, contexts, node + unary + _SUFFIX_NODES, selector, (rest >> (size - 1)) & 1
        )
        result = 2 | leading
        if size > 1:
            result = (result << (size - 1)) | code_uniform(coder, rest & ((1 << (size - 1)) - 1), 1 << (size - 1))
    return unary + result - 1


@leaf
def code_signed(
    coder: Coder, bank: Bank, contexts: npt.NDArray[np.int64], selector: int, unary: int, value: int
) -> int:
    """Code a signed integer of magnitude below 2**24, zero, sign, then the rest; takes `signed_span(unary)` nodes."""
    if code_mixed_bit(coder, bank, contexts, 0, selector, 1 if value != 0 else 0) == 0:
        return 0
    negative = code_mixed_bit(coder, bank, contexts, 1, selector, 1 if value < 0 else 0)
    magnitude = 1 + code_unsigned(coder, bank, contexts, selector, unary, abs(value) - 1, 2)
    return -magnitude if negative != 0 else magnitude
