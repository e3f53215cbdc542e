"""One run: stages, results and report."""

import json
import os
from collections.abc import Iterable, Sequence
from pathlib import Path

from tools.replicate import quotes, report, shares
from tools.replicate.ablation import ablate_mesh
from tools.replicate.denoising import denoise_mesh, pairs
from tools.replicate.fetch import Source, fetch_meshes, meshopt_package, own_meshes, sources_of
from tools.replicate.motion import measure_motion, sequences
from tools.replicate.outside import SEEN, measure_outside
from tools.replicate.paper import TABLES, Job, make_tables
from tools.replicate.paper.models import NAMED, complete
from tools.replicate.rates import Row, measure_mesh, time_mesh
from tools.replicate.stages import run_stage
from tools.replicate.verdicts import judge_mesh, mesh_jobs, quoted, written_table

ABLATED = {(500, 4000): 30, (8000, 12_000): 4}
"""Meshes of the ablation, by how many vertices they have."""
TIMED, QUICK_SIZE = 24, 4000
COMPARING, MODELS = "coherence", 5
"""The job that compares models: it takes those of the paper beside named ones."""
STAGES = ("rates", "outside", "times", "ablation", "motion", "denoising", "paper")
NOISED, NOISY = 12, (2000, 6000)
"""Meshes that are denoised, and of how many vertices."""


def note(text: str) -> None:
    print(text, flush=True)


def spread_over(sources: list[Source], count: int) -> list[Source]:
    """`count` of them, evenly over their sizes."""
    return sources[:: max(1, len(sources) // count)][:count]


def unseen(sources: list[Source], sizes: tuple[int, int]) -> list[Source]:
    """Fetched meshes, by their numbers of vertices."""
    return [
        source
        for source in sources
        if source.group == "unseen" and sizes[0] <= source.vertices <= sizes[1]
    ]


def shuffled(sources: list[Source]) -> list[Source]:
    """In an order in which the first few, wherever a run is cut, are spread over all sizes: by bits, the last first."""
    return [sources[at] for at in sorted(range(len(sources)), key=lambda at: f"{at:012b}"[::-1])]


def measure_all(
    folder: Path,
    minutes: dict[str, float],
    *,
    quick: bool,
    docs: bool,
    named: Sequence[Path] = (),
    job: str | None = None,
) -> None:
    """Run the stages that are asked for, and write down what came of all that were run in this folder.

    `named` meshes replace all others, and `job` is the only one of the paper's that is run. A table that compares
    models takes those of the paper beside named ones.
    """
    alone = named and job != COMPARING
    own = Path(os.environ["BSM_MESHES"]) if os.environ.get("BSM_MESHES") and not alone else None
    own_enough = set(minutes) == {"paper"} and complete(own)
    sources = (
        sources_of(named, NAMED) if named or own_enough else fetch_meshes(folder / "meshes", note)
    )
    if own and not quick:
        sources = sorted(
            [*sources, *own_meshes(own)], key=lambda source: (source.vertices, source.name)
        )
    workers = max(1, len(os.sched_getaffinity(0)))
    if "rates" in minutes:
        package = meshopt_package(folder / "meshes", note)
        chosen = shuffled([s for s in sources if not quick or s.vertices <= QUICK_SIZE])
        run_stage(
            measure_mesh, chosen, folder / "rates", minutes["rates"], note, package, workers=workers
        )
    if "outside" in minutes:
        chosen = shuffled(
            [s for s in unseen(sources, SEEN) if not quick or s.vertices <= QUICK_SIZE]
        )
        run_stage(
            measure_outside, chosen, folder / "outside", minutes["outside"], note, workers=workers
        )
    if "ablation" in minutes:
        chosen = [
            s
            for sizes, count in ABLATED.items()
            for s in shuffled(spread_over(unseen(sources, sizes), count))
        ]
        run_stage(
            ablate_mesh, chosen, folder / "ablation", minutes["ablation"], note, workers=workers
        )
    if "times" in minutes:
        run_stage(
            time_mesh,
            shuffled(spread_over(sources, TIMED)),
            folder / "times",
            minutes["times"],
            note,
            workers=1,
        )
    if "motion" in minutes:
        moving = sequences(sources, own, quick)
        run_stage(
            measure_motion, moving, folder / "motion", minutes["motion"], note, workers=workers
        )
    if "denoising" in minutes:
        shared = [] if quick or not own else pairs(own)
        chosen = [*shuffled(spread_over(unseen(sources, NOISY), NOISED)), *shared]
        run_stage(
            denoise_mesh, chosen, folder / "denoising", minutes["denoising"], note, workers=workers
        )
    if "paper" in minutes:
        jobs = [Job(name, own, sources, quick, folder) for name in TABLES if job in (None, name)]
        for path in [folder / "paper" / f"{name}.json" for name in TABLES] if named else ():
            path.unlink(missing_ok=True)  # of other meshes
        found = run_stage(
            make_tables, jobs, folder / "paper", minutes["paper"], note, workers=workers
        )
        if named and len(found) < len(jobs):
            raise SystemExit(f"{len(jobs) - len(found)} of {len(jobs)} tables could not be made")
    results = read(folder)
    (folder / "results.json").write_text(json.dumps(results, indent=1), encoding="utf-8")
    report.write(results, folder, note)
    if docs:
        report.require_commits(results)
        report.write_page(results)
        if "paper" in minutes:
            quotes.keep(read_stage(folder / "paper", TABLES))
            quotes.rewrite()


def judge_all(folder: Path, minutes: float, named: Sequence[Path], *, docs: bool) -> None:
    """Judge the claims of the paper on each named mesh, and write the table."""
    workers = max(1, len(os.sched_getaffinity(0)))
    jobs = mesh_jobs(sources_of(named, NAMED))
    found = run_stage(judge_mesh, jobs, folder / "verdicts", minutes, note, workers=workers)
    rows = [row for own in found for row in own]
    note(str(written_table(rows, folder)))
    if docs:
        quotes.keep({"verdicts": [{"run": rows[0]["run"], "numbers": quoted(rows)}]})
        quotes.rewrite()


def share_all(folder: Path, minutes: float, named: Sequence[Path], *, docs: bool) -> None:
    """Count what blocks carry in default streams of named meshes, and write the tables."""
    workers, sources = max(1, len(os.sched_getaffinity(0))), sources_of(named, NAMED)
    found = run_stage(shares.share_mesh, sources, folder / "shares", minutes, note, workers=workers)
    rows = [row for own in found for row in own]
    coded = {row["mesh"] for row in rows if row["base"]}
    few = [source for source in sources if source.name in coded][
        :: max(1, len(coded) // shares.COARSE_MESHES)
    ]
    found = run_stage(shares.widths_of_mesh, few, folder / "widths", minutes, note, workers=workers)
    widths = [row for own in found for row in own]
    note(str(shares.written_tables(rows, widths, folder)))
    if docs:
        numbers = shares.quoted(rows, widths)
        quotes.keep({"shares": [{"run": rows[0]["run"], "numbers": numbers}]})
        quotes.rewrite()


def read(folder: Path) -> dict[str, list[Row]]:
    """Every row of every stage."""
    names = {"paper": TABLES}
    found = {stage: read_stage(folder / stage, names.get(stage)) for stage in STAGES}
    return {stage: [row for rows in jobs.values() for row in rows] for stage, jobs in found.items()}


def read_stage(folder: Path, names: Iterable[str] | None = None) -> dict[str, list[Row]]:
    """The rows of a stage by its jobs, all of them or those of these names, in that order."""
    paths = (
        sorted(folder.glob("*.json"))
        if names is None
        else [folder / f"{name}.json" for name in names]
    )
    return {
        path.stem: json.loads(path.read_text(encoding="utf-8")) for path in paths if path.exists()
    }
