"""Denoising measured: answers first, then times.

    python -m tools.measure denoise MESHES [TABLE ...] [--full] [--json FILE]

MESHES is the folder of real meshes, with `static/`, `assets/`, `noisy/` and `dynamic/`. Without further words every
table is printed, on a few small meshes; `--full` takes more of them. A table whose answers are outside their
tolerances ends the program with exit code 1, before any time is printed. `--json` writes the figures of the tables
that the README shows.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np

from bsm.codec.arrays import Faces, Positions
from bsm.codec.denoise.automatic import denoise_automatically
from bsm.codec.denoise.coarse import CoarseFilter
from bsm.codec.denoise.filters.fine import FINE_STEPS
from bsm.codec.denoise.filters.guided import GuidedFilter, guided_normal_filtering, guided_results
from bsm.codec.denoise.filters.topology import Topology
from bsm.codec.denoise.handover import HAND_OVERS
from bsm.codec.geometry.metrics import Reference, compare, theta
from bsm.files.formats.npz import read_arrays
from bsm.files.mesh import read_mesh
from tools.measure.denoise_trials import TRIALS
from tools.paper.sequences import noisy_frames, time_sequence

# Theta after 20 iterations and seconds of the guided filter's authors' own C++ program (bldeng/GuidedDenoising).
AUTHORS = {
    "fandisk 0.3": (2.93, 0.52),
    "fandisk 0.7": (8.41, 0.52),
    "twelve": (3.84, None),
    "julius": (7.97, 3.8),
}
PARTNERS = {
    "fandisk 0.3": ("fandisk_6475", "fandisk_0.3_noisy"),
    "fandisk 0.7": ("fandisk_6475", "fandisk_0.7_noisy"),
    "twelve": ("twelve_dodecahedron", "twelve_dodecahedron_noisy"),
    "julius": ("julius_36201", "julius_36201_noisy"),
    "bunny": ("bunny_34834", "bunny_34834_noisy"),
    "armadillo": ("armadillo_12502", "armadillo_12502_0.2_noisy"),
    "block": ("block", "block_noisy"),
    "nicolo": ("nicolo", "nicolo_noisy"),
    "casting": ("fr_casting", "fr_casting_0.2_noisy"),
    "chinese lion": ("fr_chinese_lion", "fr_chinese_lion_0.2_noisy"),
}
Case = tuple[Positions, Positions, Faces]


class WrongAnswerError(Exception):
    """A result is outside its tolerance."""


def read_case(folder: Path, name: str) -> Case:
    """Clean positions, noisy positions and faces."""
    clean, noisy = PARTNERS[name]
    mesh = read_mesh(folder / "noisy" / f"{noisy}.ply").mesh
    return read_mesh(folder / "static" / f"{clean}.ply").mesh.positions, mesh.positions, mesh.faces


def expect(what: str, good: bool) -> None:
    """Stop where an answer is wrong."""
    if not good:
        raise WrongAnswerError(what)


def fastest(work: Callable[[], object], repeats: int = 3) -> float:
    """Seconds of the fastest of several runs, after one to warm up."""
    work()
    seconds = []
    for _ in range(repeats):
        start = time.perf_counter()
        work()
        seconds.append(time.perf_counter() - start)
    return min(seconds)


def guided_table(folder: Path) -> None:
    """The guided filter against its authors' program."""
    print("guided normal filtering, 20 x 10     theta   authors        s   authors")
    cases = {name: read_case(folder, name) for name in AUTHORS}
    angles = {}
    for name, (clean, noisy, faces) in cases.items():
        angles[name] = theta(clean, guided_normal_filtering(noisy, faces, 20), faces)
        expect(f"theta on {name}", abs(angles[name] / AUTHORS[name][0] - 1.0) < 0.03)
    for name, (_, noisy, faces) in cases.items():
        angle, seconds = AUTHORS[name]
        own = fastest(partial(guided_normal_filtering, noisy, faces, 20))
        theirs = "" if seconds is None else f"{seconds:9.2f}"
        print(f"{name:33s} {angles[name]:8.2f} {angle:9.2f} {own:8.3f} {theirs}")
    _, noisy, faces = cases["julius"]
    topology = Topology(faces, len(noisy))
    filter_ = GuidedFilter(noisy, topology)
    print(f"one iteration on julius ({len(faces)} faces): {fastest(lambda: filter_.step(noisy), 5):.3f} s")


def companions_table(folder: Path) -> None:
    """Every fine step alone and behind the coarse step."""
    for name in ("fandisk 0.7", "twelve"):
        clean, noisy, faces = read_case(folder, name)
        coarse = CoarseFilter(faces, len(noisy), block=len(noisy) // 10)(noisy)
        print(f"{name}: noisy {theta(clean, noisy, faces):.2f}, coarse {theta(clean, coarse, faces):.2f}")
        print("  fine step             alone   after the coarse step        s")
        for step_name, step in FINE_STEPS.items():
            alone = theta(clean, step(noisy, faces), faces)
            after = theta(clean, step(coarse, faces), faces)
            if name == "fandisk 0.7":
                expect(f"{step_name} gains from the coarse step under heavy noise", after < alone)
            seconds = fastest(partial(step, noisy, faces), 2)
            print(f"  {step_name:18s} {alone:8.2f} {after:23.2f} {seconds:8.3f}")


def handover_table(folder: Path) -> None:
    """Theta after some guided iterations for every hand-over."""
    counts = (1, 2, 4, 10, 20)
    print("theta after guided iterations     " + "".join(f"{count:8d}" for count in counts))
    for name in ("fandisk 0.3", "fandisk 0.7", "twelve", "julius"):
        clean, noisy, faces = read_case(folder, name)
        topology = Topology(faces, len(noisy))
        reference = Reference(clean, faces)
        coarse = CoarseFilter(faces, len(noisy))(noisy)
        for hand_over, start in HAND_OVERS.items():
            angles = [
                reference.theta(positions) for positions in guided_results(start(noisy, coarse, topology), topology, 20)
            ]
            print(f"{name:16s} {hand_over:16s} " + "".join(f"{angles[count]:8.2f}" for count in counts))


def automatic_table(folder: Path) -> dict[str, list[float]]:
    """The automatic mode against the better of two schemes that an oracle stops at their best iteration."""
    print("theta             guided alone    coarse to fine   automatic    ratio        s   chosen")
    rows = {}
    for name in PARTNERS:
        clean, noisy, faces = read_case(folder, name)
        topology = Topology(faces, len(noisy))
        reference = Reference(clean, faces)
        coarse = CoarseFilter(faces, len(noisy))(noisy)
        alone = [reference.theta(positions) for positions in guided_results(noisy, topology, 40)]
        after = [reference.theta(positions) for positions in guided_results(coarse, topology, 40)]
        start = time.perf_counter()
        denoised, choice = denoise_automatically(noisy, faces)
        seconds = time.perf_counter() - start
        angle = reference.theta(denoised)
        rows[name] = [reference.theta(noisy), min(*alone, *after), angle]
        chosen = "; ".join(
            f"{step.recipe.hand_over} {step.recipe.keep} {step.recipe.guide} {step.recipe.sigma_r} x {step.iterations}"
            for step in choice.steps
        )
        oracles = "".join(f"{min(run):10.2f} @{int(np.argmin(run)):3d}" for run in (alone, after))
        ratio = angle / rows[name][1]
        print(f"{name:14s} {oracles} {angle:12.2f} {ratio:8.3f} {seconds:8.1f}   {chosen or 'nothing'}", flush=True)
    ratios = [angle / best for _, best, angle in rows.values()]
    print(f"better than the oracle on {sum(ratio < 1.0 for ratio in ratios)} of {len(ratios)}, worst {max(ratios):.3f}")
    expect("the automatic mode stays within 5 % of the oracle", max(ratios) < 1.05)
    expect("the automatic mode is better on at least half", sum(ratio < 1.0 for ratio in ratios) * 2 >= len(ratios))
    return rows


def metrics_table(folder: Path) -> None:
    """Time of one comparison."""
    clean, noisy, faces = read_case(folder, "bunny")
    reference = Reference(clean, faces)
    expect("a prepared reference gives the same comparison", reference.compare(noisy) == compare(clean, noisy, faces))
    print(f"compare, bunny: {fastest(lambda: compare(clean, noisy, faces), 10) * 1e3:.1f} ms")
    print(f"compare, bunny, prepared reference: {fastest(lambda: reference.compare(noisy), 10) * 1e3:.1f} ms")


def sequences_table(folder: Path) -> None:
    """One dictionary for all frames against one for each."""
    print("coarse step, ms a frame    shared   one by one   iterations anew   dictionaries anew   all anew   less by")
    for name in ("samba", "dance", "horse_gallop"):
        positions, faces = read_arrays(folder / "dynamic" / f"{name}.npz", "positions", "faces")
        faces = faces.astype(np.int32)
        times, _ = time_sequence(noisy_frames(positions[:48].astype(np.float64), faces), faces, 5)
        expect(f"frames of {name} in one product agree with single ones to 1e-10", times.difference < 1e-10)
        seconds = (times.shared, times.single, times.iterations, times.remade, times.whole)
        cells = "".join(f"{1e3 * value:{width}.2f}" for value, width in zip(seconds, (10, 13, 18, 20, 11)))
        print(f"{name:23s} {cells} {times.remade / times.shared:12.0f}")


TABLES: dict[str, Callable[[Path], object]] = {
    "guided": guided_table,
    "companions": companions_table,
    "handover": handover_table,
    "automatic": automatic_table,
    "metrics": metrics_table,
    "sequences": sequences_table,
}


def main(arguments: list[str] | None = None) -> int:
    """Print the tables that were asked for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("meshes", type=Path, help="folder with static/, assets/, noisy/ and dynamic/")
    parser.add_argument("tables", nargs="*", metavar="TABLE", help=", ".join((*TABLES, *TRIALS)))
    parser.add_argument("--full", action="store_true", help="more meshes and levels (an hour)")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write figures of the tables here")
    chosen = parser.parse_args(arguments)
    unknown = sorted(set(chosen.tables) - {*TABLES, *TRIALS})
    if unknown:
        parser.error(f"there is no table {', '.join(unknown)}; choose among {', '.join((*TABLES, *TRIALS))}")
    figures: dict[str, object] = {}
    try:
        for name in chosen.tables or (*TABLES, *TRIALS):
            if name in TRIALS:
                figures[name] = TRIALS[name](chosen.meshes, chosen.full).values
            else:
                figures[name] = TABLES[name](chosen.meshes)
            print()
    except WrongAnswerError as error:
        print(f"wrong answer: {error}", file=sys.stderr)
        return 1
    if chosen.json:
        known = {name: value for name, value in figures.items() if value is not None}
        chosen.json.write_text(json.dumps(known, indent=1) + "\n", encoding="utf-8")
    return 0
