"""`python -m tools.attack threads COUNT`: damaged streams by one thread and by four, strict and tolerant.

Half of the streams have refinement levels that are cut at random places, also across cells and vertices, with chunks
that are missing, repeated, exchanged or filled with other bytes. The others are mutants of the vectors that threads
decode ahead. All checksums are right. Every event, error and number must be the same.
"""

from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from functools import cache
from random import Random
from typing import Any

import numpy as np

from bsm.bitstream.container.wire import FrameType, write_varint
from bsm.bitstream.errors import BsmError
from bsm.codec.arrays import Faces, Levels
from bsm.codec.blocks.cells import cells_of
from bsm.codec.decoding import Decoder, SequenceDecoder
from bsm.codec.static.preamble_encoding import Parts, join, prepare
from bsm.codec.static.ways.grid import levels_field
from bsm.codec.static.ways.in_cells import Spread
from tools.attack.decoding import is_sequence
from tools.attack.mutate import mutate_stream
from tools.attack.sweep import mutate
from tools.attack.taken import report
from tools.command import parser_of
from tools.surgery import Frames, frames_of, stream_of
from tools.vectors.good_base import draft
from tools.vectors.meshes import patch
from tools.vectors.store import FOLDER

MANY = 4
SIDES = (16, 17, 18)
AHEAD = (
    "good-base-*",
    "good-refined-*",
    "good-layer-*",
    "good-keys",
    "good-independent-*",
    "good-chain*",
)
"""Vectors with chains or with levels."""
_MOST_BYTES = 1 << 13
Part = tuple[Faces, Levels]


def main() -> int:
    """Run the command."""
    parser = parser_of(__doc__)
    parser.add_argument("count", type=int, help="streams")
    parser.add_argument("--seed", type=int, default=0, help="default: %(default)s")
    args = parser.parse_args()
    differences = ((stream, difference(stream)) for stream in streams(args.count, args.seed))
    return report(
        (f"{problem}: {stream.hex()}" for stream, problem in differences if problem),
        f"{args.count} streams",
    )


def difference(stream: bytes) -> str:
    """Return how one thread and several differ for a stream; "" if they do not."""
    for tolerant in (False, True):
        one, many = (decoded(stream, threads, tolerant) for threads in (1, MANY))
        for place, (event, other_event) in enumerate(zip(one, many)):
            if event != other_event:
                return f"{'tolerant' if tolerant else 'strict'}, event {place}: {event[:80]!r} and {other_event[:80]!r}"
        if len(one) != len(many):
            return f"{len(one)} and {len(many)} events"
    return ""


def decoded(stream: bytes, threads: int, tolerant: bool) -> list[bytes]:
    """Return all events of a stream with all their numbers, and the error that ends it."""
    kind = SequenceDecoder if is_sequence(stream) else Decoder
    events = list[bytes]()
    try:
        with kind(threads=threads, tolerant=tolerant) as decoder:
            events.extend(map(plain, decoder.events([stream])))
    except BsmError as error:
        events.append(f"{type(error).__name__}: {error}".encode())
    return events


def plain(value: Any) -> bytes:
    """Return an event with all that it holds as bytes."""
    if isinstance(value, np.ndarray):
        return value.tobytes()
    if is_dataclass(value):
        parts = (plain(getattr(value, field.name)) for field in fields(value))
        return type(value).__name__.encode() + b" ".join(parts)
    return str(value).encode()


def streams(count: int, seed: int) -> Iterator[bytes]:
    """Yield so many damaged streams."""
    random = Random(seed)
    vectors = [
        path.read_bytes() for name in AHEAD for path in sorted(FOLDER.parent.glob(f"*/{name}.bsm"))
    ]
    for number in range(count):
        if number % 2:
            yield mutate_stream(
                random.choice(vectors), _MOST_BYTES, random.randrange(1 << 30), _mutate_with(random)
            )
        else:
            yield cut_levels(random)


def _mutate_with(random: Random) -> Any:
    def change(data: bytes, most: int) -> bytes:
        return mutate(random, data)[:most]

    return change


def cut_levels(random: Random) -> bytes:
    """A stream whose refinement levels are in random chunks, some of them wrong."""
    frames, parts = levels_of(random.choice(SIDES))
    chunks = list[tuple[int, int, bytes]]()
    first = 0
    for faces, levels in parts:
        field, remaining = levels_field(faces, levels), len(levels)
        while remaining:
            size = random.choice(
                (
                    min(remaining, random.randint(1, 6)),
                    remaining,
                    random.randint(1, remaining),
                    max(remaining - 1, 1),
                )
            )
            chunks.append((first, size, b"".join(field.write(size))))
            first, remaining = first + size, remaining - size
    for _ in range(random.choice((0, 1, 1, 2, 3))):
        _spoil(chunks, random, len(parts[0][1]), first)
    written = (
        (FrameType.REFINEMENT, write_varint(at) + write_varint(size) + data)
        for at, size, data in chunks
    )
    return stream_of([*frames, *written])


def _spoil(chunks: list[tuple[int, int, bytes]], random: Random, cells: int, end: int) -> None:
    """Make one chunk wrong; `cells` and `end` are where the levels of cells and all levels end."""
    place = random.randrange(len(chunks)) if chunks else 0
    wrong_bytes = bytes(random.randrange(256) for _ in range(random.randrange(9)))
    first, size, data = chunks[place] if chunks else (0, 1, wrong_bytes)
    choice = random.randrange(6)
    if choice == 0 and chunks:
        del chunks[place]
    elif choice == 1:
        chunks.insert(random.randint(0, len(chunks)), (first, size, data))
    elif choice == 2 and chunks:
        chunks[place] = (first, size, wrong_bytes)
    # The last chunk of cells goes on among the vertices, and another chunk follows it to the end.
    elif choice == 3:
        of_cells = [number for number, chunk in enumerate(chunks) if chunk[0] < cells]
        last = of_cells[-1] if of_cells else 0
        begin = chunks[last][0] if of_cells else 0
        rest = random.choice((random.randint(1, 8), random.randint(1, end - cells - 1)))
        into = end - cells - rest
        across = [
            (begin, cells + into - begin, data),
            (cells + into, rest, random.choice((b"", wrong_bytes))),
        ]
        chunks[last : last + 1] = across
    elif choice == 4:
        chunks.append((cells, random.randint(1, end - cells), random.choice((data, wrong_bytes))))
    elif chunks:
        chunks[place] = (max(first + random.choice((-1, 1, -size, size)), 0), size, data)


@cache
def levels_of(side: int) -> tuple[Frames, tuple[Part, Part]]:
    """The frames of a mesh before its levels; and the faces and levels of its cells, all zero, and of its vertices."""
    mesh = patch(side, 14)
    stream_draft, faces, levels = draft(mesh, Spread(2, 1), 0.004)
    prepared = prepare(join(mesh, keep=False), Parts(256, 1.0), keep_order=False)
    cells = cells_of(prepared.graph, prepared.mesh.faces, 2)
    flat = np.zeros((stream_draft.header.base[0], 3), np.int32)
    frames = [
        frame
        for frame in frames_of(b"".join(stream_draft.frames))
        if frame[0] not in (FrameType.REFINEMENT, FrameType.END)
    ]
    return frames, ((cells.faces, flat), (faces, levels))
