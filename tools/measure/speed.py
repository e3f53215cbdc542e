"""What encoding and decoding take, over Draco's (level 10, 11 bits): `python -m tools.measure speed`.

Without files: two made meshes, twelve fetched ones, half of them those whose names have the least hashes in the list of
`tools.replicate`, and eleven sequences of 12 to 2,000 frames, in CPU time of one thread; least of five turns, in each
of which both codecs encode and decode. The exit code is 1 if a ratio is above 1.3 of that in speed.json (`--most`),
also when it is measured once more. `--write` makes that file. `--made` fetches nothing.

With files: least times of bsmdec in C over Draco's, by turns, on one thread, and of two threads over one where the
process may use two cores: measure under load with `chrt -r 1`, not with `taskset`.
"""

import argparse
import hashlib
import json
import math
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from statistics import median
from typing import Any, TypeAlias

import numpy as np

import bsm
from bsm.codec.arrays import Faces, Positions
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.static.encoder import Encoder
from bsm.codec.static.options import EncodeOptions
from bsm.codec.threads import available_threads
from bsm.evaluation.curve import decode_draco, encode_draco
from bsm.evaluation.sample import knot
from bsm.files.mesh import read_mesh
from bsm.ground.console import Console
from tools.command import run_command
from tools.replicate.fetch import fetch_meshes
from tools.replicate.made_motion import MADE, limbs
from tools.replicate.motion import bent

BITS, LEVEL, TURNS, MOST = 11, 10, 5, 1.3
NAMED = ("pipe", "pig", "knot", "fandisk", "lion", "bunny00")
BENT = {"pig": 12, "mushroom": 32, "cow": 96}  # meshes that bend, and their numbers of frames
FIGURES = Path(__file__).with_suffix(".json")
Works: TypeAlias = tuple[Callable[[], Any], Callable[[], Any], Callable[[], Any], Callable[[], Any]]
"""Encoding by us and by Draco, and decoding."""


def chosen(names: list[str]) -> list[str]:
    """The named meshes, and as many others, by a hash of their names."""
    others = sorted(
        set(names) - {*NAMED}, key=lambda name: hashlib.sha256(name.encode()).hexdigest()
    )
    return [*NAMED, *others[: len(NAMED)]]


def made() -> Iterator[tuple[str, Works]]:
    """What needs no fetching: a smooth mesh, and one of two congruent halves."""
    rope = knot(2000)
    yield "made rope", works_of_mesh(rope)
    halves = np.concatenate(
        [rope.positions, rope.positions * (-1.0, 1.0, 1.0) + (rope.diagonal, 0.0, 0.0)]
    )
    faces = np.concatenate([rope.faces, rope.faces[:, ::-1] + len(rope.positions)])
    yield "made pair", works_of_mesh(TriangleMesh(halves, faces))
    yield "made limbs, 60 frames", works_of_sequence(limbs(rope, 60), rope.faces)


def made_sequences() -> Iterator[tuple[str, Positions, Faces]]:
    """Many frames, few, a loop, clips one after the other, and jumps between them."""
    small, middle = knot(800), knot(3000)
    long = limbs(middle, 400)
    yield "made limbs, 400 frames", long, middle.faces
    yield "made limbs, 2,000 frames", limbs(small, 2000), small.faces
    yield "made loop", np.tile(long[:50], (6, 1, 1)), middle.faces
    yield (
        "made clips",
        np.concatenate([limbs(middle, 100, bones, bones) for bones in (4, 9, 16)]),
        middle.faces,
    )
    yield (
        "made jumps",
        long[:250].reshape(10, 25, -1, 3)[[3, 9, 0, 5, 1, 8, 2, 7, 4, 6]].reshape(250, -1, 3),
        middle.faces,
    )
    for name, make in MADE.items():
        yield name, *make()


def cases(folder: Path, note: Callable[[str], None]) -> Iterator[tuple[str, Works]]:
    """What is measured, as far as it can be fetched."""
    yield from made()
    sources = fetch_meshes(folder, note)
    wanted = chosen([source.name for source in sources])
    for source in sources:
        if source.name in wanted:
            yield source.name, works_of_mesh(source.mesh())
    for source in sources:
        if source.name in BENT:
            mesh = source.mesh()
            yield (
                f"{source.name}, bent",
                works_of_sequence(bent(mesh, BENT[source.name]), mesh.faces),
            )
    for name, frames, faces in made_sequences():
        yield name, works_of_sequence(frames, faces)


def works_of_mesh(mesh: TriangleMesh) -> Works:
    ours, theirs = bsm.encode(mesh, threads=1), encode_draco(mesh, BITS, LEVEL)
    return (
        lambda: bsm.encode(mesh, threads=1),
        lambda: encode_draco(mesh, BITS, LEVEL),
        lambda: bsm.decode(ours, threads=1),
        lambda: decode_draco(theirs),
    )


def works_of_sequence(frames: Positions, faces: Faces) -> Works:
    meshes = [TriangleMesh(frame, faces) for frame in frames]
    ours, theirs = (
        bsm.encode_sequence(frames, faces, threads=1),
        [encode_draco(mesh, BITS, LEVEL) for mesh in meshes],
    )
    return (
        lambda: bsm.encode_sequence(frames, faces, threads=1),
        lambda: [encode_draco(mesh, BITS, LEVEL) for mesh in meshes],
        lambda: bsm.decode_sequence(ours, threads=1),
        lambda: [decode_draco(data) for data in theirs],
    )


def ratios(works: Works) -> tuple[float, float]:
    """Least times of encoding and of decoding over Draco's."""
    from threadpoolctl import threadpool_limits

    least = [math.inf] * len(works)
    for turn in range(TURNS * len(works)):
        at = turn % len(works)
        # Threads of BLAS that wait for each other take time from this one.
        with threadpool_limits(1):
            begin = time.thread_time()
            works[at]()
            least[at] = min(least[at], time.thread_time() - begin)
    return least[0] / least[1], least[2] / least[3]


def guard(args: argparse.Namespace) -> None:
    """Compare all ratios with those of the file."""
    measured = (
        made() if args.made else cases(args.folder, lambda text: print(text, file=sys.stderr))
    )
    compare(measured, args, FIGURES)


def compare(measured: Iterator[tuple[str, Works]], args: argparse.Namespace, figures: Path) -> None:
    """Compare ratios with those of a file, or write it; exit with 1 where one is above the file's."""
    known = json.loads(figures.read_text()) if figures.exists() else {}
    found, slower = dict[str, tuple[float, float]](), list[str]()
    for name, works in measured:
        now, before = ratios(works), known.get(name, (math.inf, math.inf))
        if any(new > args.most * old for new, old in zip(now, before, strict=True)):
            again = ratios(works)  # something else may have run beside it
            now = min(now[0], again[0]), min(now[1], again[1])
        worse = max(new / old for new, old in zip(now, before, strict=True))
        slower += [name] if worse > args.most and not args.write else []
        found[name] = round(now[0], 2), round(now[1], 2)
        print(
            f"{name:28} encoding {now[0]:7.1f}, decoding {now[1]:6.1f}; over the file {worse:.2f}",
            flush=True,
        )
    for what, at in (("encoding", 0), ("decoding", 1)) if found else ():
        values = [ratio[at] for ratio in found.values()]
        print(f"{what}: median {median(values):.1f}, worst {max(values):.1f} times Draco")
    if args.write:
        figures.write_text(json.dumps(found, indent=1) + "\n")
    if slower or (len(found) < len(known) / 2 and not args.made):
        print(
            f"slower by more than {args.most:g}: {', '.join(slower)}"
            if slower
            else "too few meshes were fetched"
        )
        sys.exit(1)


def decoders(mesh: TriangleMesh, repeats: int) -> str:
    """Times of the decoder in C, by turns with Draco's."""
    from tools.bsmdec import Parallel, build
    from tools.bsmdec import decode as decode_in_c

    library = build("-O3", "-fno-math-errno")
    ours, theirs = Encoder(mesh, EncodeOptions()).encode(), encode_draco(mesh, 11, 10)
    ways: list[Callable[[], object]] = [
        lambda: decode_draco(theirs),
        lambda: decode_in_c(library, ours),
    ]
    if available_threads() > 1:
        ways.append(lambda: decode_in_c(library, ours, parallel=Parallel(2)))
    least = [math.inf] * len(ways)
    for _ in range(repeats + 1):
        for way, call in enumerate(ways):
            start = time.perf_counter()
            call()
            least[way] = min(least[way], time.perf_counter() - start)
    draco, alone, *pair = least
    threads = (
        f"two threads {pair[0] / alone:.2f}"
        if pair
        else "two threads not measured: pinned to one core"
    )
    return f"C {1e3 * alone:.1f} ms, Draco {1e3 * draco:.2f} ms: {alone / draco:.2f} x; {threads}"


def work(args: argparse.Namespace, _: Console) -> None:
    """Compare with the file, or print times of decoders."""
    if not args.meshes:
        guard(args)
    for path in args.meshes:
        mesh = read_mesh(path).mesh.bare.without_isolated_vertices()[0]
        print(f"{Path(path).stem}: {decoders(mesh, args.repeat)}", flush=True)


def main() -> None:
    """Run the command."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("meshes", metavar="MESH", nargs="*", help="mesh file, for times of bsmdec")
    parser.add_argument(
        "--repeat",
        type=int,
        default=20,
        metavar="N",
        help="runs of bsmdec, the fastest counts (20)",
    )
    parser.add_argument(
        "--folder",
        type=Path,
        default=Path("replicate/meshes"),
        help="where fetched packages are kept",
    )
    parser.add_argument("--made", action="store_true", help="measure only what needs no fetching")
    parser.add_argument(
        "--most", type=float, default=MOST, metavar="X", help="largest ratio over speed.json (1.3)"
    )
    parser.add_argument(
        "--write", action="store_true", help="write speed.json, which later runs are compared with"
    )
    run_command(parser, work)
