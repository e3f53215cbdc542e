"""Answers of processes that a hostile file has taken over: `python -m tools.attack answers --count 100000`.

Sound answers are mutated: kinds, sizes and places of rows, numbers, lists, and bytes. Whatever comes out must be a mesh
or frames that can be used, or an error of ours, in little memory.
"""

import os
import resource
import struct
from collections.abc import Iterator
from dataclasses import replace
from random import Random
from typing import Any

import numpy as np

from bsm.bitstream.errors import BsmError, FormatError, LimitError, MeshError
from bsm.bitstream.limits import Limits
from bsm.codec.geometry.attributes import Attribute
from bsm.files.answer import FRAMES, MESH, found_in, leave
from bsm.files.formats.polygons import MeshFile
from bsm.files.isolation import shared
from bsm.files.motion.frames import Frames
from tools.command import parser_of
from tools.vectors.meshes import torus

SIZE = 1 << 20  # bytes of shared memory
MOST_MEMORY = 64 << 20  # bytes that all messages together may add to this process
MOST_SHOWN, MOST_WORDS = 20, 1 << 17
_ROW = struct.Struct("<IIQQ")
_ODD = (0, 1, 2, 3, 4, 7, 8, 9, 12, 13, 255, 1 << 16, SIZE, (1 << 31) - 1, 1 << 31, (1 << 32) - 1)
_WIDE = (*_ODD, SIZE // 8, SIZE // 24, 1 << 40, (1 << 63) - 1, 1 << 63, (1 << 64) - 1)


def sound() -> list[Any]:
    """Answers of every kind."""
    bare = torus(4, 3)
    rows = np.arange(len(bare.positions))
    corners = Attribute("texcoord", np.linspace(0, 1, 10).reshape(5, 2), "corner", "texcoord", bare.faces % 5)
    attributes = (Attribute("color", rows[:, None].astype(np.uint8), semantic="color"), corners)
    mesh = replace(bare, attributes=attributes, metadata={"unit": "mm", "n": -(1 << 40), "x": 0.5, "b": b"\xff\0"})
    frames = [bare.positions + number for number in range(3)]
    meshes = [replace(mesh, positions=positions) for positions in frames]
    return [
        *(None, MeshFile(bare), MeshFile(mesh, ("a note", "\udcff"), ("lines",))),
        Frames(bare.faces, 3, iter(frames), attributes, ("a note",), 24.0, {"unit": "mm"}),
        Frames(bare.faces, 3, iter(()), attributes, (), 24.0, {}, iter(meshes), 7),
        *(FormatError("no"), LimitError("much", offset=3), MeshError("a mesh")),
    ]


def answers(random: Random, count: int) -> Iterator[bytes]:
    """Answers with something changed, once or several times."""
    with shared(b"") as memory:
        seeds = []
        for found in sound():
            leave(memory, found)
            seeds.append(os.pread(memory, 1 << 14, 0).ljust(1 << 14, b"\0"))
    for _ in range(count):
        data = bytearray(random.choice(seeds))
        for _ in range(random.choice((1, 1, 2, 4))):
            _mutate(data, random)
        yield bytes(data)


def _mutate(data: bytearray, random: Random) -> None:
    rows = min(int.from_bytes(data[:8], "little"), 200)
    place = 8 + _ROW.size * random.randrange(max(rows, 1))
    how = random.randrange(6)
    if how == 0:
        data[:8] = random.choice((rows + 1, max(rows, 1) - 1, *_WIDE)).to_bytes(8, "little")
    elif how == 1:
        data[random.randrange(len(data))] = random.randrange(256)
    elif how == 2 and rows:
        other = 8 + _ROW.size * random.randrange(rows)
        data[place : place + _ROW.size] = data[other : other + _ROW.size]
    elif how == 3 and rows:
        del data[place : place + _ROW.size]
        data[:8] = (rows - 1).to_bytes(8, "little")
    else:
        row = list(_ROW.unpack(data[place : place + _ROW.size]))
        field = random.randrange(4)
        row[field] = random.choice((random.randrange(16), *(_ODD if field < 2 else _WIDE)))
        data[place : place + _ROW.size] = _ROW.pack(*row)


def fault(memory: int, data: bytes, limits: Limits) -> str:
    """What is wrong with how an answer is taken; "" if nothing is."""
    os.pwrite(memory, data, 0)
    try:
        found = found_in(memory, 2 * SIZE, limits, (*MESH, *FRAMES))
        if isinstance(found, Frames):
            for mesh in found.meshes or found.frames:
                del mesh
    except BsmError as error:
        told = len(str(error)) < MOST_WORDS
        return "" if told else f"{type(error).__name__} of {len(str(error))} characters"
    except BaseException as error:
        return f"{type(error).__name__}: {error}"
    return ""


def main() -> int:
    """Run the command."""
    parser = parser_of(__doc__)
    parser.add_argument("--count", type=int, default=100_000, help="messages (default: %(default)s)")
    parser.add_argument("--seed", type=int, default=0)
    args = parser.parse_args()
    random, found, before = Random(args.seed), list[str](), resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    with shared(bytes(SIZE)) as memory:
        for number, data in enumerate(answers(random, args.count)):
            if problem := fault(memory, data, replace(Limits.service(), vertices=10_000)):
                found.append(f"message {number} of seed {args.seed}: {problem}")
    more = (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) << 10
    if more > MOST_MEMORY:
        found.append(f"they took {more:,} bytes of memory")
    print("\n".join(found[:MOST_SHOWN]))
    print(f"{args.count} messages, {more >> 20} MiB more, {len(found)} findings")
    return 1 if found else 0
