"""`python -m tools.attack sweep --seconds N`: every target on its seeds and mutations; encoders on bad meshes.

Always the same inputs in the same order, without guidance by coverage: for builds of the kernels that check
themselves, see `tools/sanitize.sh`. What goes wrong there ends the process with a report.
"""

import time
from collections.abc import Iterator
from contextlib import suppress
from random import Random

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import OptionError
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.static.encoder import encode
from bsm.codec.static.options import EncodeOptions
from tools.attack.mutate import mutate_stream
from tools.attack.targets import MESH_FILE, TARGETS, run, seeds
from tools.command import parser_of
from tools.copies import refuse_other_kernels

Ints = npt.NDArray[np.int32]


def main() -> int:
    """Run the command."""
    parser = parser_of(__doc__)
    parser.add_argument(
        "--seconds",
        type=float,
        default=60.0,
        help="for all targets together (default: %(default)s)",
    )
    parser.add_argument(
        "--targets", nargs="+", choices=TARGETS, default=list(TARGETS), metavar="NAME"
    )
    args = parser.parse_args()
    refuse_other_kernels()
    for name in args.targets:
        print(f"{name:20} {attack(name, args.seconds / len(args.targets)):8} inputs", flush=True)
    meshes = list(_bad_faces())
    for faces in meshes:
        encode_any(faces)
    print(f"{'encoders':20} {len(meshes):8} meshes")
    return 0


def attack(name: str, seconds: float) -> int:
    """Try every seed, then mutations of them for some seconds; return the number of inputs."""
    random = Random(name)
    inputs = seeds(name)
    count = 0
    begin = time.monotonic()
    for data in inputs:
        run(TARGETS[name], data)
        count += 1
    while time.monotonic() - begin < seconds:
        run(
            TARGETS[name],
            mutate(random, random.choice(inputs)) if name == MESH_FILE else mutant(random, inputs),
        )
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


def mutant(random: Random, seeds: list[bytes]) -> bytes:
    """A stream with something changed behind checksums that are right again."""
    seed = random.choice(seeds)
    return mutate_stream(
        seed, 1 << 16, random.randrange(1 << 30), lambda part, size: mutate(random, part)[:size]
    )


def _bad_faces() -> Iterator[Ints]:
    """Triangles of no order at all."""
    random = np.random.default_rng(0)
    for size in range(3, 90):
        yield random.integers(0, size, (2 * size, 3), dtype=np.int32)


def encode_any(faces: Ints) -> None:
    """Encode faces and their order, with blocks and on a grid; the encoder decodes and compares what it wrote."""
    positions = np.random.default_rng(len(faces)).normal(size=(int(faces.max()) + 1, 3))
    for options in (
        EncodeOptions(step=0.01, keep_order=True, threads=1),
        EncodeOptions(grid=9, threads=1),
    ):
        # Decoders would refuse blocks in which everything is beside everything.
        with suppress(OptionError):
            encode(TriangleMesh(positions, faces), options)
