"""Denoising measured: answers first, then times; rivals are stopped at their best iteration by an oracle.

    python -m tools.measure denoise MESHES [TABLE ...] [--json FILE]
    python -m tools.measure tables

MESHES is the folder of real meshes, with `static/`, `assets/`, `noisy/` and `dynamic/`. Without further words every
table is printed, on a few small meshes. A table whose answers are outside their tolerances ends the program with exit
code 1. `--json` writes the figures that docs/measured.md shows, and `tables` writes them there between the two marks.
"""

from __future__ import annotations

import argparse
import json
import sys
import textwrap
import time
from collections.abc import Callable, Iterator
from functools import partial
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from bsm.bitstream.errors import BsmError
from bsm.codec.arrays import Faces, Positions
from bsm.codec.denoise import FrameDenoiser
from bsm.codec.denoise.automatic import denoise_automatically
from bsm.codec.denoise.coarse import CoarseFilter
from bsm.codec.denoise.normals import GuidedFilter
from bsm.codec.denoise.recipe import Recipe, Treatments
from bsm.codec.denoise.surface import Topology
from bsm.codec.geometry.metrics import Reference, mean_edge_length, theta
from bsm.files.formats.npz import read_arrays
from bsm.files.mesh import read_mesh
from tools.made_shapes import made_shape
from tools.noise import (
    correlated_along_normals,
    gaussian_along_axis,
    gaussian_along_normals,
    gaussian_in_part,
    gaussian_isotropic,
    gaussian_with_range,
    impulsive,
    ripples_along_normals,
    rounded,
    uniform_along_normals,
)
from tools.scans import CAMERAS, Scan, fused, view

Kind = Callable[[Positions, Faces, float], Positions]
SEED = 11
KINDS: dict[str, Kind] = {
    "white": lambda positions, faces, sigma: gaussian_along_normals(positions, faces, sigma, SEED),
    "isotropic": lambda positions, faces, sigma: gaussian_isotropic(positions, faces, sigma, SEED),
    "uniform": lambda positions, faces, sigma: uniform_along_normals(positions, faces, sigma, SEED),
    "impulses": lambda positions, faces, sigma: impulsive(positions, faces, sigma, 0.5, SEED),
    "few impulses": lambda positions, faces, sigma: impulsive(positions, faces, sigma, 0.1, SEED),
    "one axis": lambda positions, faces, sigma: gaussian_along_axis(positions, faces, sigma, SEED),
    "correlated": lambda positions, faces, sigma: correlated_along_normals(positions, faces, sigma, SEED),
    "ripples": lambda positions, faces, sigma: ripples_along_normals(positions, faces, sigma, SEED, 4.0),
    "range": lambda positions, faces, sigma: gaussian_with_range(positions, faces, sigma, SEED),
    "rounded": lambda positions, faces, sigma: rounded(positions, faces, 0.5 * sigma, SEED),
    "half clean": lambda positions, faces, sigma: gaussian_in_part(positions, faces, sigma, 0.5, SEED),
}
GUIDED = Recipe("none", 0.1, "patches", 0.35)
BILATERAL = Recipe("none", 0.1, "local", 0.35)
PAPER = Recipe("positions", 0.1, "patches", 0.35)
RIVALS = {"guided": GUIDED, "bilateral normal": BILATERAL, "paper": PAPER}
FIXED_ITERATIONS = {"guided": (5, 20), "bilateral normal": (10,), "paper": (5, 20)}
MOST, PATIENCE = 60, 5
CLEAN_FOLDERS = ("static", "assets", "hostile")
CLEAN_SHAPES, CLEAN_CELLS = 50, 36
"""None of them is one that the learnt candidate has seen (`tools.train_denoiser.FIRST_SHAPE`)."""
FAR = 0.5
"""Degrees."""

HARD = (
    ("fandisk_6475", 0.6, 1.0),
    ("fertility", 0.3, 1.0),
    ("trim_star", 0.3, 1.0),
    ("nicolo", 0.6, 0.5),
    ("armadillo_12502", 0.05, 1.0),
)
"""Name, level, and share of the vertices that move."""
NAMES, LEVELS = ("fandisk_6475", "gargoyle_10002", "trim_star"), (0.05, 0.2)


def clean_trials(folder: Path) -> dict[str, float]:
    """Meshes without noise that was put there: how far their normals are turned, and how many come back untouched."""
    print("clean inputs                     vertices   turned by   untouched        s   note")
    turned, untouched = [], 0
    for name, positions, faces in clean_meshes(folder):
        start = time.perf_counter()
        result, choice = denoise_automatically(positions, faces)
        seconds = time.perf_counter() - start
        same = bool((result == positions).all())
        turned.append(theta(positions, result, faces))
        untouched += same
        print(
            f"{name:30s} {len(positions):10d} {turned[-1]:11.2f} {'yes' if same else 'no':>11s} {seconds:8.1f}   "
            f"{choice.reason}",
            flush=True,
        )
    far = sum(angle > FAR for angle in turned)
    print(
        f"{untouched} of {len(turned)} untouched, {far} turned by more than {FAR} degrees, "
        f"by {max(turned):.2f} degrees at most"
    )
    return {"untouched": untouched, "of": len(turned), "far": far, "largest": max(turned)}


def clean_meshes(folder: Path) -> Iterator[tuple[str, Positions, Faces]]:
    """What can be read of static/, assets/ and hostile/, small files, and shapes that are made here."""
    for path in (path for name in CLEAN_FOLDERS for path in sorted((folder / name).iterdir())):
        if path.stat().st_size > 1_000_000:
            continue
        try:
            mesh = read_mesh(path).mesh
        except BsmError:
            continue
        yield path.name, mesh.positions, mesh.faces
    for seed in range(CLEAN_SHAPES):
        yield f"made shape {seed}", *made_shape(seed, CLEAN_CELLS)


def kind_trials(folder: Path) -> dict[str, float]:
    """Kinds and levels of noise: against the input, and against the best of the fixed recipes."""
    print("kind           mesh               edges       in      out   best fixed   ratio       s   found")
    worse, count = 0, 0
    ratios: dict[str, list[float]] = {kind: [] for kind in KINDS}
    for name in NAMES:
        clean, faces = _static(folder, name)
        reference = Reference(clean, faces)
        for kind, make in KINDS.items():
            for level in LEVELS:
                noisy = make(clean, faces, level)
                before = reference.theta(noisy)
                start = time.perf_counter()
                result, choice = denoise_automatically(noisy, faces)
                seconds = time.perf_counter() - start
                after = reference.theta(result)
                count, worse = count + 1, worse + (after > before)
                fixed = min(best_fixed(noisy, faces, reference), before)
                if 0.1 <= level <= 0.5:
                    ratios[kind].append(after / fixed)
                print(
                    f"{kind:14s} {name:18s} {level:5.2f} {before:8.2f} {after:8.2f} {fixed:12.2f} "
                    f"{after / fixed:7.2f} {seconds:7.1f}   {choice.kind}{' WORSE' if after > before else ''}",
                    flush=True,
                )
    print(f"{worse} of {count} worse than their input")
    means = {kind: float(np.exp(np.mean(np.log(found)))) for kind, found in ratios.items() if found}
    print("mean ratio, 0.1 to 0.5 edges: " + ", ".join(f"{kind} {value:.2f}" for kind, value in means.items()))
    return {"worse": worse, "of": count, **means}


def gaussian_trials(folder: Path) -> dict[str, float]:
    """White noise of 0.2 edges against three rivals with an oracle each."""
    print("mesh                     in   guided   bilateral   paper      out   ratio       s")
    ratios = []
    for name in NAMES:
        clean, faces = _static(folder, name)
        reference = Reference(clean, faces)
        noisy = gaussian_along_normals(clean, faces, 0.2, SEED)
        rivals = oracle(noisy, faces, reference)
        start = time.perf_counter()
        result, _ = denoise_automatically(noisy, faces)
        seconds = time.perf_counter() - start
        after = reference.theta(result)
        ratios.append(after / min(rivals.values()))
        cells = "".join(f"{value:{width}.2f}" for value, width in zip(rivals.values(), (9, 12, 8), strict=True))
        print(
            f"{name:18s} {reference.theta(noisy):8.2f}{cells} {after:8.2f} {ratios[-1]:7.2f} {seconds:7.1f}", flush=True
        )
    mean = float(np.mean(ratios))
    print(f"mean {mean:.3f}, worst {max(ratios):.3f}")
    return {"mean": mean, "worst": max(ratios)}


def hard_trials(folder: Path) -> dict[str, float]:
    """Cases with published rivals, and one with hardly any noise; those of meshes that are there."""
    values: dict[str, float] = {}
    print("case                          in      out       s")
    for name, level, share in HARD:
        if not (folder / "static" / f"{name}.ply").exists():
            continue
        clean, faces = _static(folder, name)
        noisy = gaussian_along_normals(clean, faces, level, SEED)
        if share < 1.0:
            noisy = impulsive(clean, faces, level, share, SEED)
        start = time.perf_counter()
        result, _ = denoise_automatically(noisy, faces)
        seconds = time.perf_counter() - start
        after = theta(clean, result, faces)
        values[f"{name} {level}"] = after
        print(f"{name:16s} {level:5.2f} {theta(clean, noisy, faces):8.2f} {after:8.2f} {seconds:7.1f}", flush=True)
    return values


def sequence_trials(folder: Path) -> dict[str, float]:
    """A noisy sequence against its frames one by one: theta, vertex error, flicker."""
    print("sequence         frames    way               theta   vertex error   flicker")
    positions, faces = read_arrays(folder / "dynamic" / "dance.npz", "positions", "faces")
    faces = faces.astype(np.int32)
    clean = positions[:24].astype(np.float64)
    noisy = np.stack([gaussian_along_normals(frame, faces, 0.2, seed) for seed, frame in enumerate(clean)])
    alone = np.stack([denoise_automatically(frame, faces)[0] for frame in noisy])
    together = np.stack(list(FrameDenoiser(noisy[0], faces)(noisy)))
    rows = {
        way: (
            float(np.mean([theta(a, b, faces) for a, b in zip(clean, frames, strict=True)])),
            vertex_error(clean, frames, faces),
            flicker(clean, frames, faces),
        )
        for way, frames in (("noisy", noisy), ("frame by frame", alone), ("sequence", together))
    }
    for way, row in rows.items():
        print(f"dance {len(clean):16d}    {way:14s} {row[0]:8.2f} {row[1]:14.3f} {row[2]:9.3f}", flush=True)
    over = [ours / theirs for ours, theirs in zip(rows["sequence"], rows["frame by frame"], strict=True)]
    means = dict(zip(("theta", "vertex error", "flicker"), over, strict=True))
    print("over frame by frame: " + ", ".join(f"{measure} {value:.2f}" for measure, value in means.items()))
    return means


def vertex_error(clean: np.ndarray, frames: np.ndarray, faces: Faces) -> float:
    """Root mean square distance of the vertices of all frames, in mean edges of the first."""
    distance = np.sqrt(np.square(clean - frames).sum(axis=2).mean())
    return float(distance) / mean_edge_length(clean[0], faces)


def flicker(clean: np.ndarray, frames: np.ndarray, faces: Faces) -> float:
    """Mean length of the second difference in time of what differs from the clean frames, in mean edges."""
    error = frames - clean
    trembling = error[2:] - 2.0 * error[1:-1] + error[:-2]
    return float(np.sqrt(np.square(trembling).sum(axis=2)).mean()) / mean_edge_length(clean[0], faces)


def oracle(noisy: Positions, faces: Faces, reference: Reference) -> dict[str, float]:
    """Theta of every rival at its best iteration."""
    treatments = _treatments(noisy, faces)
    return {name: _best(treatments.iterates(rival), reference.theta) for name, rival in RIVALS.items()}


def best_fixed(noisy: Positions, faces: Faces, reference: Reference) -> float:
    """Theta of the best of the rivals with numbers of iterations that a user might ask for."""
    treatments = _treatments(noisy, faces)
    found = []
    for name, rival in RIVALS.items():
        run = treatments.iterates(rival)
        done = -1
        for count in FIXED_ITERATIONS[name]:
            # The local filter counts in twos.
            count = count // 2 if rival.guide == "local" else count
            found.append(reference.theta(next(islice(run, count - done - 1, None))))
            done = count
    return min(found)


def _treatments(noisy: Positions, faces: Faces) -> Treatments:
    coarse = CoarseFilter(faces, len(noisy))
    return Treatments(noisy, partial(coarse, noisy), Topology(faces, len(noisy)))


def _best(run: Iterator[Positions], angle_of: Callable[[Positions], float]) -> float:
    best, at = np.inf, 0
    for count, positions in enumerate(islice(run, MOST + 1)):
        angle = angle_of(positions)
        if angle < best:
            best, at = angle, count
        elif count >= at + PATIENCE:
            break
    return float(best)


def _static(folder: Path, name: str) -> tuple[Positions, Faces]:
    mesh = read_mesh(folder / "static" / f"{name}.ply").mesh
    return mesh.positions, mesh.faces


ROOT = Path(__file__).parents[2]
FIGURES = ROOT / "tools" / "measure" / "denoising.json"
PAGE = ROOT / "docs" / "measured.md"
BEGIN, END = "<!-- denoising: made by tools.measure tables -->", "<!-- denoising: end -->"


SCANS = {"scans": "Scans", "fused": "Twelve views fused on a grid, scans"}


def scans(means: dict[str, list[float]]) -> str:
    return ", ".join(f"{camera} {mean:.2f} ({worst:.2f} at worst)" for camera, (mean, worst) in means.items())


def denoising_tables(figures: dict[str, Any]) -> str:
    """Markdown of the tables."""
    cases = figures["automatic"]
    rows = (("noisy", 0), ("automatic", 2), ("best fixed scheme", 1))
    lines = ["| | " + " | ".join(cases) + " |", "|---|" + "---:|" * len(cases)]
    lines += [f"| {name} | " + " | ".join(f"{values[at]:.2f}" for values in cases.values()) + " |" for name, at in rows]
    clean, kinds, gaussian = figures["clean"], figures["kinds"], figures["gaussian"]
    ratios = {kind: f"{value:.2f}" for kind, value in kinds.items() if kind not in ("worse", "of")}
    sequences = [f"{measure} {value:.2f}" for measure, value in figures["flicker"].items()]
    hard = [f"{case} edges {value:.2f}" for case, value in figures["hard"].items()]
    lines += [
        "",
        "Mean ratio of the automatic error to that of the best fixed scheme, for each kind of noise:",
        "",
        f"| {' | '.join(ratios)} |",
        "|" + "---:|" * len(ratios),
        f"| {' | '.join(ratios.values())} |",
        "",
        f"- Clean meshes: {clean['untouched']} of {clean['of']} come back bit for bit. The normals of the others "
        f"turn by at most {clean['largest']:.2f} degrees.",
        f"- {kinds['worse']} of {kinds['of']} noisy meshes (eleven kinds of noise, two levels) are worse than their "
        "input.",
        f"- White noise: {gaussian['mean']:.2f} of the best, {gaussian['worst']:.2f} at worst, of guided filtering, "
        "bilateral normal filtering and the paper's scheme. An oracle stops each of the three.",
        f"- Sequences against their frames one by one: {', '.join(sequences)}.",
        *(f"- {kind} of depth cameras over the same: {scans(figures[key])}." for key, kind in SCANS.items()),
        f"- {'; '.join(hard)} (degrees).",
    ]
    return "\n".join(textwrap.fill(line, 120, subsequent_indent="  ") if line[:1] == "-" else line for line in lines)


def put_in(text: str, tables: str) -> str:
    """The text with the tables between its marks."""
    before, rest = text.split(BEGIN)
    _, after = rest.split(END)
    return f"{before}{BEGIN}\n\n{tables}\n\n{END}{after}"


def write_tables() -> None:
    """Put the figures into the document."""
    tables = denoising_tables(json.loads(FIGURES.read_text(encoding="utf-8")))
    PAGE.write_text(put_in(PAGE.read_text(encoding="utf-8"), tables), encoding="utf-8")


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


def automatic_table(folder: Path) -> dict[str, list[float]]:
    """The automatic mode against the better of two schemes that an oracle stops at their best iteration."""
    print("theta             guided alone    coarse to fine   automatic    ratio        s   chosen")
    rows = {}
    for name in PARTNERS:
        clean, noisy, faces = read_case(folder, name)
        topology = Topology(faces, len(noisy))
        reference = Reference(clean, faces)
        coarse = CoarseFilter(faces, len(noisy))(noisy)
        alone = [reference.theta(positions) for positions in islice(GuidedFilter(noisy, topology).iterates(), 41)]
        after = [reference.theta(positions) for positions in islice(GuidedFilter(coarse, topology).iterates(), 41)]
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


SCANNED = ("fandisk_6475", "trim_star", "block", "fr_casting", "nicolo", "armadillo_12502")


def scan_trials(folder: Path, scanned: Callable[..., Scan] = view) -> dict[str, list[float]]:
    """Scans of two depth cameras: angle and position against the best of the rivals that an oracle stops."""
    print("scan               camera                 in   oracle      out   ratio     off over        s   found")
    rows: dict[str, list[float]] = {camera: [] for camera in CAMERAS}
    for name in SCANNED:
        for camera, model in CAMERAS.items():
            scan = scanned(*_static(folder, name), model, SEED)
            treatments = _treatments(scan.positions, scan.faces)
            best = min(_best(treatments.iterates(rival), scan.angle) for rival in RIVALS.values())
            start = time.process_time()
            result, choice = denoise_automatically(scan.positions, scan.faces)
            seconds = time.process_time() - start
            ratio, left = scan.angle(result) / best, scan.rms(result) / scan.rms(scan.positions)
            rows[camera].append(ratio)
            print(
                f"{name:18s} {camera:16s} {scan.angle(scan.positions):8.2f} {best:8.2f} {scan.angle(result):8.2f} "
                f"{ratio:7.2f} {left:10.2f} {seconds:8.1f}   {choice.kind}",
                flush=True,
            )
    means = {camera: [float(np.exp(np.mean(np.log(found)))), max(found)] for camera, found in rows.items()}
    print("mean and worst ratio: " + ", ".join(f"{camera} {a:.2f}, {b:.2f}" for camera, (a, b) in means.items()))
    return means


TABLES: dict[str, Callable[[Path], object]] = {
    "automatic": automatic_table,
    "clean": clean_trials,
    "kinds": kind_trials,
    "gaussian": gaussian_trials,
    "hard": hard_trials,
    "flicker": sequence_trials,
    "scans": scan_trials,
    "fused": lambda folder: scan_trials(folder, fused),
}


def main(arguments: list[str] | None = None) -> int:
    """Print the tables that were asked for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("meshes", type=Path, help="folder with static/, assets/, noisy/ and dynamic/")
    parser.add_argument("tables", nargs="*", metavar="TABLE", help=", ".join(TABLES))
    parser.add_argument("--json", type=Path, metavar="FILE", help="write figures of the tables here")
    chosen = parser.parse_args(arguments)
    unknown = sorted(set(chosen.tables) - set(TABLES))
    if unknown:
        parser.error(f"there is no table {', '.join(unknown)}; choose among {', '.join(TABLES)}")
    figures: dict[str, object] = {}
    try:
        for name in chosen.tables or TABLES:
            figures[name] = TABLES[name](chosen.meshes)
            print()
    except WrongAnswerError as error:
        print(f"wrong answer: {error}", file=sys.stderr)
        return 1
    if chosen.json:
        chosen.json.write_text(json.dumps(figures, indent=1) + "\n", encoding="utf-8")
    return 0
