"""What decoding by bsmdec takes, over Draco's: `python -m tools.measure speed MESH [--repeat 20]`.

Least times in C over Draco's (level 10, 11 bits), by turns, on one thread, and of two threads over one where the
process may use two cores: measure under load with `chrt -r 1`, not with `taskset`.
"""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Callable
from pathlib import Path

from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.static.encoder import Encoder
from bsm.codec.static.options import EncodeOptions
from bsm.codec.threads import available_threads
from bsm.console import Console
from bsm.evaluation.curve import decode_draco, encode_draco
from bsm.files.mesh import read_mesh
from tools.command import run_command


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


def work(args: argparse.Namespace, _: Console) -> None:
    """Print times of decoders."""
    for path in args.meshes:
        mesh = read_mesh(path).mesh.bare.without_isolated_vertices()[0]
        print(f"{Path(path).stem}: {decoders(mesh, args.repeat)}", flush=True)


def main() -> None:
    """Run the command."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("meshes", metavar="MESH", nargs="+", help="mesh file")
    parser.add_argument("--repeat", type=int, default=20, metavar="N", help="runs, the fastest counts (20)")
    run_command(parser, work)
