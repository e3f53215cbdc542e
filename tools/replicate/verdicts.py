"""The claims of the paper, judged on each of several meshes: on how many they hold, and how far the numbers spread."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import isfinite
from pathlib import Path

from tools.replicate.fetch import Source
from tools.replicate.paper import Job, make_tables
from tools.replicate.rates import Row

JUDGED = (
    *(
        "times",
        "dynamic",
        "overlap",
        "edge-effect",
        "number-of-segments",
        "powers",
        "basis",
        "warm-start",
    ),
    *(
        "first-block",
        "convergence",
        "iterations-or-powers",
        "rate-and-error",
        "coarse-to-fine",
        "fewer-iterations",
    ),
    *("rivals", "complexity"),
)
"""Jobs that judge claims on one mesh, the most disputed first. `coherence` compares five models in one run."""


@dataclass(frozen=True)
class MeshJob:
    """One job of the paper on one mesh, with few settings."""

    job: str
    source: Source

    @property
    def name(self) -> str:
        return f"{self.job}.{self.source.name}"


def mesh_jobs(sources: Sequence[Source]) -> list[MeshJob]:
    return [MeshJob(job, source) for job in JUDGED for source in sources]


def judge_mesh(mesh_job: MeshJob) -> list[Row]:
    """Return a row for each claim of a job, with the verdict on this mesh."""
    tables = make_tables(Job(mesh_job.job, None, [mesh_job.source], quick=True))
    beside = {
        "job": mesh_job.job,
        "mesh": mesh_job.source.name,
        "vertices": mesh_job.source.vertices,
    }
    return [{**claim, **beside} for table in tables for claim in table["claims"]]


def verdict_lines(rows: Iterable[Row]) -> list[tuple[str, str, str]]:
    """A line for each claim: its words, on how many meshes it holds, and the least and the largest number."""
    by_claim: dict[str, list[Row]] = {}
    for row in rows:
        by_claim.setdefault(row["says"], []).append(row)
    lines = []
    for says, own in by_claim.items():
        # A claim that is judged several times on a mesh holds there only if it always does.
        judged = {row["mesh"] for row in own}
        failed = {row["mesh"] for row in own if not row["holds"]}
        values = [row["value"] for row in own if isfinite(row["value"])]
        spread = (
            f"{number(min(values))} to {number(max(values))} {own[0]['unit']}" if values else "-"
        )
        lines.append((says, f"{len(judged) - len(failed)} of {len(judged)}", spread))
    return lines


def number(value: float) -> str:
    """Three digits or so: what verdicts turn on."""
    return f"{value:.0f}" if abs(value) >= 10.0 else f"{value:.2f}"


def quoted(rows: Sequence[Row]) -> dict[str, str]:
    """What the documents quote: the lines of the table, and the meshes with their vertices."""
    meshes = {row["mesh"]: row["vertices"] for row in rows}
    lines = [f"| {' | '.join(line)} |" for line in verdict_lines(rows)]
    return {
        "lines": "\n".join(lines),
        "meshes": ", ".join(f"{name} ({count:,})" for name, count in meshes.items()),
    }


def written_table(rows: Sequence[Row], folder: Path) -> Path:
    """Write the table as Markdown."""
    words = quoted(rows)
    path = folder / "verdicts.md"
    head = f"Meshes and their vertices: {words['meshes']}.\n\n| the paper | holds on | measured |\n|---|---|---|\n"
    path.write_text(f"{head}{words['lines']}\n", encoding="utf-8")
    return path
