"""One run: stages, results and report."""

from __future__ import annotations

import datetime
import json
import os
import platform
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

from tools.replicate import report
from tools.replicate.ablation import ablate_mesh
from tools.replicate.fetch import Source, fetch_meshes, meshopt_package
from tools.replicate.motion import measure_motion, sequences
from tools.replicate.rates import Row, measure_mesh, time_mesh
from tools.replicate.stages import run_stage

ABLATED, SIZES = 30, (500, 4000)
"""Meshes of the ablation, and of how many vertices."""
TIMED = 24
DRAWN = ("head", "cow", "homer")
"""Meshes of the paper's figures."""


def note(text: str) -> None:
    print(text, flush=True)


def spread_over(sources: list[Source], count: int) -> list[Source]:
    """`count` of them, evenly over their sizes."""
    return sources[:: max(1, len(sources) // count)][:count]


def shuffled(sources: list[Source]) -> list[Source]:
    """In an order in which the first few, wherever a run is cut, are spread over all sizes: by bits, the last first."""
    return [sources[at] for at in sorted(range(len(sources)), key=lambda at: f"{at:012b}"[::-1])]


def measure_all(folder: Path, minutes: dict[str, float], *, quick: bool, docs: bool) -> None:
    """Run the stages that are asked for, and write down what came of all that were run in this folder."""
    os.environ["OMP_NUM_THREADS"] = "1"
    begin = time.monotonic()
    sources = fetch_meshes(folder / "meshes", note)
    workers = max(1, len(os.sched_getaffinity(0)))
    if "rates" in minutes:
        package = meshopt_package(folder / "meshes", note)
        run_stage(measure_mesh, shuffled(sources), folder / "rates", minutes["rates"], note, package, workers=workers)
    if "ablation" in minutes:
        some = [s for s in sources if s.group == "unseen" and SIZES[0] <= s.vertices <= SIZES[1]]
        chosen = spread_over(some, ABLATED)
        run_stage(ablate_mesh, shuffled(chosen), folder / "ablation", minutes["ablation"], note, workers=workers)
    if "times" in minutes:
        run_stage(time_mesh, shuffled(spread_over(sources, TIMED)), folder / "times", minutes["times"], note, workers=1)
    if "motion" in minutes:
        measure_sequences(sources, folder / "motion", minutes["motion"], quick)
    if "paper" in minutes:
        paper(sources, folder, minutes["paper"], quick)
    results = read(folder)
    facts = describe(time.monotonic() - begin)
    (folder / "results.json").write_text(json.dumps({**facts, **results}, indent=1), encoding="utf-8")
    report.write(results, folder, note)
    if docs:
        report.write_page(results, facts)


def measure_sequences(sources: list[Source], folder: Path, minutes: float, quick: bool) -> None:
    folder.mkdir(exist_ok=True)
    deadline = time.monotonic() + 60 * minutes
    for name, frames, faces in sequences(sources, quick):
        path = folder / f"{name.replace(', ', '_').replace(' ', '_')}.json"
        if time.monotonic() > deadline:
            note(f"motion: no time was left for {name}")
        elif not path.exists():
            path.write_text(json.dumps(measure_motion(name, frames, faces)), encoding="utf-8")
            note(f"motion: {name}")


def paper(sources: list[Source], folder: Path, minutes: float, quick: bool) -> None:
    """The paper's tables beside its numbers and its figures, by their own commands; BSM_MESHES holds its models."""
    meshes = os.environ.get("BSM_MESHES")
    tables = [sys.executable, "-m", "tools.measure", "paper", *(["--meshes", meshes] if meshes else [])]
    tables += ["--quick"] if quick or not meshes else ["--only", "rates,dynamic,powers"]
    drawn = [str(source.path) for source in sources if source.name in DRAWN[: 1 if quick else None]]
    curves = [sys.executable, "-m", "bsm", "curve", *drawn, "--codecs", "paper", "-o", str(folder / "paper"), "--pdf"]
    for words, name in ((tables, "paper.md"), (curves, "paper-curves.md")):
        try:
            done = subprocess.run(words, capture_output=True, text=True, timeout=30 * minutes, check=True)
        except subprocess.SubprocessError as error:
            note(f"paper: {error}")
            continue
        (folder / name).write_text(done.stdout, encoding="utf-8")


def read(folder: Path) -> dict[str, list[Row]]:
    """Every row of every stage."""
    stages = ("rates", "times", "ablation", "motion")
    return {
        stage: [json.loads(path.read_text(encoding="utf-8")) for path in sorted((folder / stage).glob("*.json"))]
        for stage in stages
    }


def describe(seconds: float) -> dict[str, Any]:
    """The commit, the processor, the date and how long it took."""
    commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], capture_output=True, text=True).stdout.strip()
    lines = Path("/proc/cpuinfo").read_text().splitlines() if Path("/proc/cpuinfo").exists() else []
    name = next((line.split(":")[1].strip() for line in lines if line.startswith("model name")), platform.processor())
    cores = len(os.sched_getaffinity(0))
    date = datetime.date.today().isoformat()
    return {"commit": commit, "processor": f"{name}, {cores} cores", "date": date, "minutes": round(seconds / 60, 1)}
