"""Mutation of whole streams, frame by frame, checksums made right again, so that damage gets past the reader."""

from collections.abc import Callable
from dataclasses import replace
from random import Random

from bsm.bitstream.container.header import HEADER_FIELDS, Declaration, Field, fields_of
from bsm.bitstream.container.wire import FrameType, write_map, write_varint
from bsm.bitstream.errors import BsmError
from tools.surgery import Cursor, Frames, frames_of, header_entries, stream_of

Mutate = Callable[[bytes, int], bytes]
_KINDS = frozenset(map(int, FrameType))

_KEPT = {FrameType.BLOCK: 2, FrameType.GRID: 2, FrameType.REFINEMENT: 3, FrameType.VALUES: 3}
"""Bytes before coded data, where numbers are small; 1 for other types."""

_NUMBERS = (
    0,
    1,
    2,
    3,
    4,
    7,
    8,
    15,
    16,
    31,
    64,
    100,
    120,
    121,
    127,
    128,
    255,
    256,
    1000,
    4096,
    8191,
    1 << 14,
    2**31 - 1,
)
_REALS = (
    0.0,
    0.125,
    1.0,
    1e-3,
    2.0**-30,
    2.0**-40,
    2.0**20,
    2.0**30,
    65535.0,
    1e6,
    1e30,
    -1e300,
    1e300,
    1e-300,
)


def mutate_stream(data: bytes, max_size: int, seed: int, mutate: Mutate) -> bytes:
    """Another stream like `data`; bytes that are not a stream are mutated as bytes."""
    random = Random(seed)
    try:
        frames = frames_of(data)
    except (BsmError, ValueError):
        return mutate(data, max_size)
    if not frames or random.random() < 0.05:
        return mutate(data, max_size)
    for _ in range(random.choice((1, 1, 1, 2, 3))):
        _STEPS[random.randrange(len(_STEPS))](frames, random, mutate)
        if not frames:
            return mutate(data, max_size)
    changed = stream_of(frames)
    return changed if len(changed) <= max_size else data[:max_size]


def _change_payload(frames: Frames, random: Random, mutate: Mutate) -> None:
    place = random.randrange(len(frames))
    kind, payload = frames[place]
    frames[place] = (kind, mutate(payload, len(payload) + 64))


def _change_coded(frames: Frames, random: Random, mutate: Mutate) -> None:
    """Change the data behind the first bytes, which say what it is."""
    coded = [
        i
        for i, (kind, _) in enumerate(frames)
        if kind not in (FrameType.HEADER, FrameType.METADATA)
    ]
    if coded:
        place = random.choice(coded)
        kind, payload = frames[place]
        head = _KEPT.get(FrameType(kind), 1) if kind in _KINDS else 1
        frames[place] = (kind, payload[:head] + mutate(payload[head:], len(payload) + 64))


def _change_header(frames: Frames, random: Random, mutate: Mutate) -> None:
    if frames[0][0] != FrameType.HEADER:
        return
    try:
        entries = header_entries(frames[0][1])
    except (TypeError, ValueError):
        return
    declared = random.choice(list(HEADER_FIELDS.values()))
    if declared.key in entries and random.random() < 0.2:
        del entries[declared.key]
    else:
        entries[declared.key] = _value(declared, entries.get(declared.key), random)
    try:
        frames[0] = (FrameType.HEADER, write_map(sorted(entries.items())))
    except (TypeError, ValueError, OverflowError):  # keys of several types, or a number too large
        return


def _change_declaration(frames: Frames, random: Random, mutate: Mutate) -> None:
    """Another value, or none, in a field of the declaration of an attribute."""
    declared = [i for i, (kind, _) in enumerate(frames) if kind == FrameType.ATTRIBUTE]
    if not declared:
        return
    place = random.choice(declared)
    try:
        cursor = Cursor(frames[place][1])
        index, size = cursor.varint(), cursor.varint()
        entries, seams = header_entries(cursor.take(size)), cursor.rest()
    except BsmError:
        return
    item = random.choice(list(fields_of(Declaration).values()))
    if item.key in entries and random.random() < 0.2:
        del entries[item.key]
    elif item.type in (str, bytes):
        entries[item.key] = (
            mutate(b"", 8) if item.type is bytes else random.choice(("", "x", "color", "y" * 256))
        )
    elif item.type is tuple:
        had = entries.get(item.key)
        numbers = list(had) if isinstance(had, list) and had else [random.choice(_REALS)]
        part = replace(item, type=item.item)
        numbers[random.randrange(len(numbers))] = _value(part, numbers[0], random)
        entries[item.key] = numbers * random.choice((1, 1, 1, 2))
    else:
        entries[item.key] = _value(item, entries.get(item.key), random)
    try:
        packed = write_map(sorted(entries.items()))
    except (TypeError, ValueError, OverflowError):
        return
    frames[place] = (
        FrameType.ATTRIBUTE,
        write_varint(index) + write_varint(len(packed)) + packed + seams,
    )


def _value(declared: Field, old: object, random: Random) -> object:
    if declared.type is int:
        if isinstance(old, int) and random.random() < 0.5:
            return max(0, old + random.choice((-8, -2, -1, 1, 2, 8, old)))
        return random.choice(_NUMBERS)
    if declared.type is float:
        return random.choice(_REALS) if random.random() < 0.7 else random.uniform(0, 100)
    part = replace(declared, type=declared.item)
    if isinstance(old, list) and old and random.random() < 0.7:
        place, step = random.randrange(len(old)), random.choice((1, 1, 2))
        replacement = [_value(part, item, random) for item in old[place : place + step]]
        return [
            *old[:place],
            *random.choice((replacement, replacement, [], 2 * replacement)),
            *old[place + step :],
        ]
    return [
        _value(part, None, random) for _ in range(random.choice((declared.lengths[0], 1, 2, 3)))
    ]


def _change_block(frames: Frames, random: Random, mutate: Mutate) -> None:
    """Another index or another number of coefficients."""
    blocks = [i for i, (kind, _) in enumerate(frames) if kind in (FrameType.BLOCK, FrameType.GOP)]
    if blocks:
        place = random.choice(blocks)
        kind, payload = frames[place]
        numbers = [payload[0], payload[1]] if len(payload) > 1 else [0, 0]
        numbers[random.randrange(2)] = random.choice(_NUMBERS[:-1])
        frames[place] = (kind, write_varint(numbers[0]) + write_varint(numbers[1]) + payload[2:])


def _recut(frames: Frames, random: Random, mutate: Mutate) -> None:
    """Another cut between two pieces of connectivity, or one more piece."""
    places = [i for i, (kind, _) in enumerate(frames) if kind == FrameType.CONNECTIVITY]
    if not places:
        return
    which = random.randrange(len(places))
    place = places[which]
    data = frames[place][1][1:]
    if which + 1 == len(places):
        cut = random.randrange(len(data) + 1)
        behind = random.randrange(place + 1, len(frames) + 1)
        frames[place] = (FrameType.CONNECTIVITY, data[:cut])
        frames.insert(behind, (FrameType.CONNECTIVITY, data[cut:]))
        return
    next_place = places[which + 1]
    joined, cut = (
        data + frames[next_place][1][1:],
        len(data) + random.choice((-4, -1, 1, 1, 3, 4, 5, 9)),
    )
    cut = min(max(cut, 0), len(joined))
    frames[place] = (FrameType.CONNECTIVITY, joined[:cut])
    frames[next_place] = (FrameType.CONNECTIVITY, joined[cut:])


def _move(frames: Frames, random: Random, mutate: Mutate) -> None:
    """Drop, repeat, exchange or invent a frame."""
    place = random.randrange(len(frames))
    choice = random.randrange(5)
    if choice == 0:
        del frames[place]
    elif choice == 1:
        frames.insert(random.randrange(len(frames) + 1), frames[place])
    elif choice == 2:
        other_place = random.randrange(len(frames))
        frames[place], frames[other_place] = frames[other_place], frames[place]
    elif choice == 3:
        frames.insert(place, (random.randrange(16), mutate(b"", 32)))
    else:
        frames[place] = (random.randrange(16), frames[place][1])


_STEPS = (
    *(
        _change_payload,
        _change_coded,
        _change_coded,
        _change_header,
        _change_header,
        _change_block,
        _move,
    ),
    _change_declaration,
    _recut,
)
