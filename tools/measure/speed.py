"""Time and memory per vertex as a mesh grows, and when fewer bytes that take longer to decode are there first.

    python -m tools.measure speed MESH [--largest 2500000] [--repeat 3]

Each mesh is subdivided again and again; encoding and decoding run in processes of their own. `LINK`: the bandwidth
below which the smallest file of ours that keeps 7 degrees is there and decoded before Draco's (level 10).
"""

from __future__ import annotations

import argparse
import json
import math
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.metrics import Reference
from bsm.codec.static.decoder import decode
from bsm.codec.static.encoder import Encoder, encode
from bsm.codec.static.options import EncodeOptions
from bsm.codec.static.targets import Target
from bsm.console import Console
from bsm.evaluation.bench import least_time
from bsm.evaluation.curve import decode_draco, encode_draco, positions_in_order
from bsm.evaluation.sample import knot
from bsm.files.mesh import format_mesh, read_mesh
from bsm.files.stream import inspect_stream
from tools.command import run_command

THETA = 7.0
Taken = dict[str, float]


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


def subdivide(mesh: TriangleMesh) -> TriangleMesh:
    """Cut every face into four at the middles of its edges."""
    count, faces = len(mesh.positions), mesh.faces
    ends = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    keys, edge_of = np.unique(ends[:, 0].astype(np.int64) * count + ends[:, 1], return_inverse=True)
    middles = (mesh.positions[keys // count] + mesh.positions[keys % count]) / 2
    ab, bc, ca = (count + edge_of).reshape(3, -1)
    a, b, c = faces.T
    parts = [np.stack(corners, axis=1) for corners in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))]
    return TriangleMesh(np.concatenate([mesh.positions, middles]), np.concatenate(parts).astype(np.int32))


def measure_resources(mesh_path: Path, repeats: int = 1) -> dict[str, Taken]:
    """What ``encode`` and ``decode`` of a mesh file take, each in a process of its own."""
    with tempfile.TemporaryDirectory() as folder:
        stream, found = str(Path(folder, "mesh.bsm")), {}
        for what, inputs in (("encode", (str(mesh_path), stream)), ("decode", (stream,))):
            command = [sys.executable, "-m", "tools.measure.speed", str(repeats), *inputs]
            found[what] = json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)
        return found


def _encode_or_decode(repeats: int, path: str, stream: str = "") -> Taken:
    """Encode a mesh into a stream, or decode a stream where there is no more."""
    decode(encode(knot(2_000)))  # loads the compiled kernels, so that the time is that of the work
    if stream:
        mesh = read_mesh(path).mesh.bare
        vertices, work = len(mesh.positions), (lambda: Path(stream).write_bytes(encode(mesh)))
    else:
        data = Path(path).read_bytes()
        vertices, work = inspect_stream(iter([data])).header.vertices, (lambda: len(decode(data).positions))
    return {"vertices": vertices, **_repeated(work, repeats, vertices), "peak_mib": peak_memory() / 2**20}


def _repeated(work: Callable[[], object], repeats: int, vertices: int) -> Taken:
    seconds = cpu_seconds = math.inf
    for _ in range(max(1, repeats)):
        start, cpu_start = time.perf_counter(), time.process_time()
        work()
        seconds = min(seconds, time.perf_counter() - start)
        cpu_seconds = min(cpu_seconds, time.process_time() - cpu_start)
    per_vertex = 1e6 * cpu_seconds / vertices
    return {"seconds": seconds, "cpu_seconds": cpu_seconds, "cpu_microseconds_per_vertex": per_vertex}


def peak_memory() -> int:
    """Largest resident memory of this process so far, in bytes."""
    line = next(line for line in Path("/proc/self/status").read_text().splitlines() if line.startswith("VmHWM:"))
    return 1024 * int(line.split()[1])


def work(args: argparse.Namespace, console: Console) -> None:
    """Print how a mesh grows, and its link."""
    for path in args.meshes:
        mesh = read_mesh(path).mesh.bare.without_isolated_vertices()[0]
        ours, theirs = deliveries(mesh, args.repeat)
        print(f"{Path(path).stem}: {ours}, Draco {theirs}; LINK {break_even(ours, theirs):.1f} Mbit/s", flush=True)
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder, "mesh.ply")
            while len(mesh.positions) <= args.largest:
                file.write_bytes(format_mesh(mesh, "ply"))
                print(f"{len(mesh.positions)} vertices: {worded(measure_resources(file, args.repeat))}", flush=True)
                mesh = subdivide(mesh)


def worded(found: dict[str, Taken]) -> str:
    """Processor time of all threads, and peak memory of the process, per vertex."""
    return "; ".join(
        f"{what} {taken['cpu_microseconds_per_vertex']:.2f} us, {2**20 * taken['peak_mib'] / taken['vertices']:.0f} B"
        for what, taken in found.items()
    )


def main() -> None:
    """Run the command."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("meshes", metavar="MESH", nargs="+", help="mesh file")
    parser.add_argument("--largest", type=int, default=2_500_000, metavar="N", help="subdivide up to N vertices")
    parser.add_argument("--repeat", type=int, default=3, metavar="N", help="runs, the fastest counts (3)")
    run_command(parser, work)


if __name__ == "__main__":
    print(json.dumps(_encode_or_decode(int(sys.argv[1]), *sys.argv[2:])))
