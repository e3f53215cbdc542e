"""How true the time left is that the bar shows: at a quarter, half and three quarters of ten long jobs.

    python -m tools.measure bar MESHES [JOB ...] [--json FILE]

Each job runs with `--json`. The time left of its lines is compared with the time that the job then took; the factor is
the larger of the two over the smaller, `inf` where no time was shown. The clock is the CPU time of the job, so that
other work on the machine does not count; that of jobs in several processes is the wall. `back` is how far the bar went
back at most.
"""

from __future__ import annotations

import argparse
import json
import math
import subprocess
import sys
import tempfile
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import numpy as np

from bsm.bitstream.errors import OptionError
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.console import Console
from bsm.files.mesh import read_mesh, write_mesh
from tools.command import run_command
from tools.noise import gaussian_along_normals

PROGRAM = """
import json, sys, time, types
import bsm.console
from bsm.cli import main
clock = getattr(time, sys.argv[1])
bsm.console.time = types.SimpleNamespace(monotonic=clock)
begin = clock()
code = main(sys.argv[2:])
print(json.dumps({"total": clock() - begin}), file=sys.stderr)
sys.exit(code)
"""
MOMENTS = (0.25, 0.5, 0.75)
STATIC = ("bunny_34834", "horse_48485", "gargoyle_10002", "fandisk_6475", "julius_36201", "dragon_22998")


def subdivided(mesh: TriangleMesh, times: int) -> TriangleMesh:
    """Each triangle in four, again and again; vertices move along a wave, so that there is detail."""
    positions, faces = mesh.positions, mesh.faces.astype(np.int64)
    for _ in range(times):
        edges = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        pairs, numbers = np.unique(edges, axis=0, return_inverse=True)
        a, b, c = (len(positions) + numbers.reshape(-1, 3)).T
        x, y, z = faces.T
        positions = np.concatenate([positions, positions[pairs].mean(axis=1)])
        faces = np.concatenate([np.stack(rows, 1) for rows in ((x, a, c), (a, y, b), (c, b, z), (a, b, c))])
    wave = 2e-4 * mesh.diagonal * np.sin(positions @ (np.ones((3, 3)) * 700 / mesh.diagonal))
    return TriangleMesh(positions + wave, faces.astype(np.int32))


def frames(source: Path, count: int, target: Path) -> str:
    """The first frames of a sequence."""
    with np.load(source) as given:
        arrays = {name: given[name][:count] if given[name].ndim == 3 else given[name] for name in given.files}
    np.savez(target, **arrays)
    return str(target)


def jobs(meshes: Path, away: Path) -> dict[str, Callable[[], list[str]]]:
    """What each job's command is, behind `bsm`; its inputs are made when it is asked for."""
    static, moving = meshes / "static", meshes / "dynamic"

    def made(name: str, times: int) -> str:
        path = away / f"{name}_{times}.ply"
        if not path.is_file():
            write_mesh(path, subdivided(read_mesh(static / f"{name}.ply").mesh, times))
        return str(path)

    def noisy(name: str) -> str:
        mesh, path = read_mesh(static / f"{name}.ply").mesh, away / f"{name}_noisy.ply"
        write_mesh(path, mesh.moved(gaussian_along_normals(mesh.positions, mesh.faces, 0.2, 1))[0])
        return str(path)

    def corpus() -> list[str]:
        return [str(static / f"{name}.ply") for name in STATIC]

    def cut(name: str, count: int) -> str:
        return frames(moving / f"{name}.npz", count, away / f"{name}_{count}.npz")

    out = str(away / "out.bsm")
    many = ["-f", "-o", str(away / "many") + "/"]
    return {
        "sequence": lambda: ["encode", cut("samba", 48), "-f", "-o", out],
        "long sequence": lambda: ["encode", str(moving / "dance.npz"), "-f", "-o", out],
        "short sequence": lambda: ["encode", str(moving / "horse_gallop.npz"), "-f", "-o", out],
        "huge mesh": lambda: ["encode", made("bunny_34834", 2), "-f", "-o", out],
        "lossless": lambda: ["encode", made("bunny_34834", 2), "--preset", "lossless", "-f", "-o", out],
        "batch": lambda: ["encode", *corpus(), *many],
        "mixed batch": lambda: ["encode", "-j", "2", cut("dance", 60), *corpus(), made("fandisk_6475", 2), *many],
        "tiles": lambda: ["tile", made("bunny_34834", 2), "--triangles", "65536", "-f", "-o", str(away / "tiles")],
        "denoise": lambda: ["denoise", noisy("horse_48485"), "-o", str(away / "clean.ply"), "-f"],
        "denoised sequence": lambda: ["denoise", cut("dance", 40), "-o", str(away / "clean.npz"), "-f"],
    }


def measured(arguments: list[str]) -> tuple[float, list[tuple[float, float | None, float]]]:
    """How long a command takes; and of each of its lines when it came, the time left, and the share that is done."""
    clock = "monotonic" if "-j" in arguments else "process_time"
    command, total = [sys.executable, "-c", PROGRAM, clock, *arguments, "--json"], 0.0
    found = list[tuple[float, float | None, float]]()
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr is not None
        for line in process.stderr:
            told = json.loads(line)
            if "seconds_left" in told:
                found.append((told["seconds"], told["seconds_left"], told["share"]))
            total = told.get("total", 0.0)
    if process.returncode:
        raise OptionError(f"{' '.join(command)} failed with exit code {process.returncode}")
    return total, found


def factors(seconds: float, told: list[tuple[float, float | None, float]]) -> list[float]:
    """The larger over the smaller of the time left that was shown and the true one, at each moment."""
    found = []
    for moment in MOMENTS:
        at, left, _ = max((one for one in told if one[0] <= moment * seconds), default=(0.0, None, 0.0))
        true = seconds - at
        found.append(max(left / true, true / left) if left else math.inf)
    return found


def work(args: argparse.Namespace, console: Console) -> None:
    """Run the jobs and print a row of each."""
    rows, worst = {}, 0.0
    print(f"{'job':18} {'seconds':>8} {'lines':>6}  factor at 1/4, 1/2, 3/4   back")
    with tempfile.TemporaryDirectory() as folder:
        known = jobs(Path(args.meshes), Path(folder))
        for name in args.jobs or known:
            seconds, told = measured(known[name]())
            found = factors(seconds, told)
            shares = [share for _, _, share in told]
            back = max((before - after for before, after in pairwise(shares)), default=0.0)
            print(f"{name:18} {seconds:8.1f} {len(told):6}  {' '.join(f'{it:7.2f}' for it in found)}  {back:6.3f}")
            rows[name] = {"seconds": seconds, "factors": found, "told": told}
            worst = max(worst, *found)
            sys.stdout.flush()
    print(f"worst {worst:.2f}")
    if args.json:
        Path(args.json).write_text(json.dumps(rows, default=str))


def main() -> None:
    """Run the command."""
    parser = argparse.ArgumentParser(prog="python -m tools.measure bar", description=__doc__)
    parser.add_argument("meshes", help="the folder of real meshes")
    parser.add_argument("jobs", nargs="*", metavar="JOB", help="some of the jobs (default: all)")
    parser.add_argument("--json", metavar="FILE", help="write every line there, too")
    run_command(parser, work)
