"""`python -m tools.attack sweep --seconds N`: every target on its seeds and mutations; encoders on bad meshes.

Always the same inputs in the same order, without coverage and without atheris: for builds of the kernels that check
themselves, see `tools/sanitize.sh`. What goes wrong there ends the process with a report.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Iterator
from random import Random

import numpy as np
import numpy.typing as npt

from bsm.bitstream.coefficients.adaptive import (
    CoefficientModel,
    choose_levels,
    decode_coefficients,
    encode_coefficients,
)
from bsm.bitstream.coefficients.matrices import decode_levels, encode_levels, make_level_bank
from bsm.bitstream.connectivity.faces import decode_connectivity, encode_connectivity
from bsm.bitstream.connectivity.partition import decode_labels, encode_labels
from bsm.bitstream.container.splits import decode_order, encode_order
from bsm.bitstream.limits import DEFAULT_LIMITS
from bsm.codec.geometry.graph import graph_of_faces
from tools.attack.mutate import mutate_stream
from tools.attack.targets import TARGETS, VECTORS, WHOLE_STREAMS, Finding, run, seeds
from tools.copies import refuse_other_kernels

Ints = npt.NDArray[np.int32]


def main() -> int:
    """Run the command."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--seconds", type=float, default=60.0, help="for all targets together (default: %(default)s)")
    parser.add_argument("--targets", nargs="+", choices=TARGETS, default=list(TARGETS), metavar="NAME")
    args = parser.parse_args()
    refuse_other_kernels()
    for name in args.targets:
        print(f"{name:20} {attack(name, args.seconds / len(args.targets)):8} inputs", flush=True)
    print(f"{'encoders':20} {sum(1 for faces in _bad_faces() if round_trip(faces)):8} meshes")
    return 0


def attack(name: str, seconds: float) -> int:
    """Every seed, and mutations of them for so many seconds; how many inputs there were."""
    random = Random(name)
    found = seeds(name, VECTORS)
    count = 0
    begin = time.monotonic()
    for data in found:
        run(TARGETS[name], data)
        count += 1
    while time.monotonic() - begin < seconds:
        data = random.choice(found)
        if name in WHOLE_STREAMS:
            data = mutate_stream(data, 65535, random.randrange(1 << 30), lambda part, size: mutate(random, part)[:size])
        else:
            data = mutate(random, data)
        run(TARGETS[name], data)
        count += 1
    return count


def mutate(random: Random, data: bytes) -> bytes:
    """Change, cut, repeat or insert a few bytes."""
    changed = bytearray(data)
    for _ in range(random.choice((1, 1, 2, 4))):
        place = random.randrange(len(changed) + 1)
        choice = random.randrange(5)
        if choice == 0:
            del changed[place:]
        elif choice == 1:
            changed[place:place] = random.randbytes(random.randrange(1, 9))
        elif choice == 2:
            changed[place : place + random.randrange(1, 9)] = b""
        elif place < len(changed):
            changed[place] = random.randrange(256)
    return bytes(changed)


def _bad_faces() -> Iterator[Ints]:
    """Triangles of no order at all."""
    random = np.random.default_rng(0)
    for size in range(3, 90):
        yield random.integers(0, size, (2 * size, 3), dtype=np.int32)


def round_trip(faces: Ints) -> bool:
    """Encode faces, their order, a partition, and numbers for coefficients; decode them, and compare."""
    if len(faces) == 0:
        return False
    given = np.unique(faces, return_inverse=True)[1].reshape(-1, 3).astype(np.int32)
    vertices = int(given.max()) + 1
    encoded = encode_connectivity(given, vertices)
    decoded = decode_connectivity(encoded.payload, vertices, len(given))
    order, _ = decode_order(encode_order(given, encoded), decoded, vertices, DEFAULT_LIMITS)
    graph = graph_of_faces(decoded, vertices)
    labels = (np.arange(vertices) // 16).astype(np.int32)
    parts = int(labels[-1]) + 1
    coded = encode_labels(graph.offsets, graph.neighbours, labels, parts)
    writer, reader = CoefficientModel(vertices), CoefficientModel(vertices)
    targets = (given[: min(vertices, len(given))].astype(np.int64) - vertices // 2) * 999
    levels = choose_levels(writer, targets, 0.1).levels
    matrix = np.zeros_like(levels)
    decode_levels(make_level_bank(), encode_levels(make_level_bank(), [levels], [levels]), [matrix], [levels])
    same = (
        (order.faces == given).all()
        and (decode_labels(coded, graph.offsets, graph.neighbours, parts) == labels).all()
        and (decode_coefficients(reader, encode_coefficients(writer, levels), len(levels)) == levels).all()
        and (matrix == levels).all()
    )
    if not same:
        raise Finding("a mesh did not come back")
    return True


if __name__ == "__main__":
    sys.exit(main())
