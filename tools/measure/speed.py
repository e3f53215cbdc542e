"""When fewer bytes that take longer to decode are there first, and what decoding takes.

    python -m tools.measure speed MESH [--repeat 3]
    python -m tools.measure speed MESH --decoders [--repeat 20]

`LINK`: the bandwidth below which the smallest file of ours that keeps 7 degrees is there and decoded before Draco's
(level 10). `--decoders`: least times of bsmdec in C over Draco's (level 10, 11 bits), by turns, on one thread, and of
two threads over one where the process may use two cores: measure under load with `chrt -r 1`, not with `taskset`.
"""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.metrics import Reference
from bsm.codec.static.encoder import Encoder
from bsm.codec.static.options import EncodeOptions
from bsm.codec.static.targets import Target
from bsm.codec.threads import available_threads
from bsm.console import Console
from bsm.decoding import decode
from bsm.evaluation.bench import least_time
from bsm.evaluation.curve import decode_draco, encode_draco, positions_in_order
from bsm.files.mesh import read_mesh
from tools.command import run_command

THETA = 7.0


@dataclass(frozen=True)
class Delivery:
    """A file, the mean angle that it keeps, and the seconds to decode it with all threads."""

    size: int
    theta_deg: float
    seconds: float


def break_even(ours: Delivery, theirs: Delivery) -> float:
    """Megabits per second below which `ours` is there and decoded first; infinite where it always is, 0 where never."""
    saved, spent = 8 * (theirs.size - ours.size), ours.seconds - theirs.seconds
    if saved <= 0:
        return 0.0 if spent >= 0 else math.nan
    return saved / spent / 1e6 if spent > 0 else math.inf


def deliveries(mesh: TriangleMesh, repeats: int) -> tuple[Delivery, Delivery]:
    """The smallest file of ours, and of Draco, that keeps the angle."""
    encoder = Encoder(mesh, EncodeOptions(contract=None, target=Target("theta_deg", THETA)))
    ours = encoder.encode()
    found = Reference(mesh.positions[encoder.vertex_order], decode(ours).faces).theta(decode(ours).positions)
    reference, bits, theirs, kept = Reference(mesh.positions, mesh.faces), 5, b"", math.inf
    while kept > THETA:
        bits += 1
        theirs = encode_draco(mesh, bits, 10)
        kept = reference.theta(positions_in_order(mesh, decode_draco(theirs), bits))
    times = (
        least_time(work, repeats + 1, time.perf_counter)
        for work in (lambda: decode(ours), lambda: decode_draco(theirs))
    )
    return Delivery(len(ours), found, next(times)), Delivery(len(theirs), kept, next(times))


def decoders(mesh: TriangleMesh, repeats: int) -> str:
    """Times of the decoder in C, by turns with Draco's."""
    from tests.engine.decoding import Parallel, build
    from tests.engine.decoding import decode as decode_in_c

    library = build("-O3", "-fno-math-errno")
    ours, theirs = Encoder(mesh, EncodeOptions()).encode(), encode_draco(mesh, 11, 10)
    ways: list[Callable[[], object]] = [lambda: decode_draco(theirs), lambda: decode_in_c(library, ours)]
    if available_threads() > 1:
        ways.append(lambda: decode_in_c(library, ours, parallel=Parallel(2)))
    least = [math.inf] * len(ways)
    for _ in range(repeats + 1):
        for way, call in enumerate(ways):
            start = time.perf_counter()
            call()
            least[way] = min(least[way], time.perf_counter() - start)
    draco, alone, *pair = least
    threads = f"two threads {pair[0] / alone:.2f}" if pair else "two threads not measured: pinned to one core"
    return f"C {1e3 * alone:.1f} ms, Draco {1e3 * draco:.2f} ms: {alone / draco:.2f} x; {threads}"


def work(args: argparse.Namespace, console: Console) -> None:
    """Print links, or times of decoders."""
    for path in args.meshes:
        mesh = read_mesh(path).mesh.bare.without_isolated_vertices()[0]
        if args.decoders:
            print(f"{Path(path).stem}: {decoders(mesh, args.repeat)}", flush=True)
            continue
        ours, theirs = deliveries(mesh, args.repeat)
        print(f"{Path(path).stem}: {ours}, Draco {theirs}; LINK {break_even(ours, theirs):.1f} Mbit/s", flush=True)


def main() -> None:
    """Run the command."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("meshes", metavar="MESH", nargs="+", help="mesh file")
    parser.add_argument("--decoders", action="store_true", help="print times of decoding in C, over Draco's")
    parser.add_argument("--repeat", type=int, default=3, metavar="N", help="runs, the fastest counts (3)")
    run_command(parser, work)
