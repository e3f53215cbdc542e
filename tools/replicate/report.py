"""Tables in Markdown and LaTeX, and figures in PDF and PNG, of what was measured."""

from collections.abc import Callable, Iterator, Sequence
from operator import itemgetter
from pathlib import Path
from textwrap import fill
from typing import Any, NamedTuple

import numpy as np

from bsm.evaluation.curve import STYLES, Picture, table
from tools.replicate import ablation, motion
from tools.replicate.ablation import MOVING_TOOLS, TOOLS, ablation_note, ablation_table
from tools.replicate.denoising import denoising_note, denoising_table, pairs_table
from tools.replicate.measures import MEASURES
from tools.replicate.outside import PHOTOGRAPHED, SPREAD, outside_table, steadiness_table
from tools.replicate.paper import TABLES
from tools.replicate.rates import (
    COLUMNS,
    CURVE,
    MESHOPT_BITS,
    PRESETS,
    Row,
    ratios,
    spread,
    summary,
    time_summary,
)
from tools.replicate.stages import git

GROUPS = {
    "unseen": "fetched meshes",
    "tuned": "meshes that were in use here before",
    "named": "named meshes",
}
WHAT = ("BD-rate", *PRESETS, *(f"meshoptimizer {bits}" for bits in MESHOPT_BITS))
PAGE = Path(__file__).parents[2] / "docs" / "measured.md"
INTRODUCTION = """# Measured

`python -m tools.replicate --docs` writes this page, and nothing else does. It fetches meshes from the packages of
Debian, PyPI and npm, by the list in `tools/replicate/meshes.json`, and measures for about an hour. Beside the tables it
writes every number as JSON, each table in LaTeX and each figure as PDF. `--figure NAME` measures one part anew, and
`--quick` takes ten minutes. Rates are of whole files, with connectivity and headers. `BSM_MESHES` may name a folder of
your own; its meshes and sequences join those that were in use here before. BSM was not developed on the fetched meshes,
but some constants were chosen with some of them in view: of the look, of how many grids are tried, and of denoising.
The state that models of congruent grids start from was learnt on most of them.
Each table names the commit that it measured.

SSIMULACRA2 is Cloudinary's, in the Python package of that name; 90 is visually lossless, 70 high quality. Butteraugli
is of Debian's libjxl-devtools, FLIP NVIDIA's. MeshLab measures the distances of surfaces (Metro's definition). DAME is
written after Váša and Rus, *Dihedral Angle Mesh Error* (2012, doi 10.1111/j.1467-8659.2012.03176.x), without its term
of visibility. STED is written after Váša and Skala, *A Perception Correlated Comparison Method for Dynamic Meshes*
(2011). We could read the abstract of the first only. So the weight of DAME's masking is from memory, and so are STED's
neighborhood, its length of a frame and its weight of time. Compare both within this page, not with other papers."""


class Table(NamedTuple):
    """A table, and what it says."""

    title: str
    columns: Sequence[str]
    rows: Sequence[Sequence[str]]
    note: str = ""


def tables(results: dict[str, list[Row]]) -> dict[str, Table]:
    """Every table that the results allow, by the name of its file."""
    found = {}
    for group, words in GROUPS.items():
        rows = [row for row in results.get("rates", []) if row["group"] == group]
        if rows:
            found[f"rates-{group}"] = _medians(rows, words)
            worst = [line for line in summary(rows) if line[0] in ("BD-rate", "default", "fine")]
            found[f"rates-spread-{group}"] = Table(
                f"Mean, spread and worst mesh, {words}", COLUMNS, worst
            )
        if files := file_table(rows):
            note = "Draco: 11 bits, level 10. Distances by our look; the last column is bytes over "
            note += "Draco's at that look."
            found[f"rates-files-{group}"] = Table(
                f"Files of 20 meshes, {words}", FILES, files, note
            )
        timed = [row for row in results.get("times", []) if row["group"] == group]
        if timed:
            note = "One thread, processor seconds over Draco's (11 bits, level 10), the least of three by turns."
            found[f"times-{group}"] = Table(
                f"Times over Draco's, {words}", COLUMNS, time_summary(timed), note
            )
    if seen := results.get("outside", []):
        title = "Bytes over Draco's at equal scores of photographs"
        note = f"{PHOTOGRAPHED} Draco: level 10, 7 to 14 bits."
        found["outside"] = Table(title, COLUMNS, outside_table(seen), note)
        note = "Means of the three views; less is better. Draco: 11 bits, level 10."
        found["outside-spread"] = Table(
            "Spread of scores of photographs", SPREAD, steadiness_table(seen), note
        )
    if results.get("ablation"):
        rows = results["ablation"]
        found["ablation"] = Table(
            "Without each tool", ablation.COLUMNS, ablation_table(rows), ablation_note(rows)
        )
    if results.get("motion"):
        found["motion"] = Table(
            "Moving meshes", motion.COLUMNS, motion.motion_table(results["motion"])
        )
        moving = [
            spread(
                name, "bytes", [(row["tools"][name], row["sequence"]) for row in results["motion"]]
            )
            for name in MOVING_TOOLS
        ]
        found["motion-ablation"] = Table(
            "Without each tool, moving meshes", ("tool left out", *COLUMNS[1:]), moving
        )
    noisy = results.get("denoising", [])
    if any(row["group"] != "pairs" for row in noisy):
        lines = denoising_table(noisy)
        found["denoising"] = Table(
            "Denoising", ("noise", "rivals", *COLUMNS[2:]), lines, denoising_note(noisy)
        )
    if any(row["group"] == "pairs" for row in noisy):
        note = "Mean angles to the clean mesh in degrees; an oracle stops the best rival. Estimates: bsm denoise."
        found["denoising-pairs"] = Table(
            "Denoising, files that papers share", PAIRED, pairs_table(noisy), note
        )
    for at, row in enumerate(results.get("paper", [])):
        found[f"paper-{at}"] = Table(row["title"], row["columns"], row["rows"], row["note"])
    return found


PAIRED = ("file", "noisy", "best rival", "automatic", "estimate")
FILES = (
    "mesh",
    "vertices",
    "Draco",
    "default",
    "distance, Draco",
    "distance, default",
    "of Draco's bytes",
)


def file_table(rows: Sequence[Row]) -> list[tuple[str, ...]]:
    """Sizes of single meshes, those of most vertices."""
    found: list[tuple[str, ...]] = []
    for row in sorted(rows, key=lambda row: -row["vertices"])[:20]:
        if {"Draco 11", "default"} <= row["points"].keys():
            draco, ours = row["points"]["Draco 11"], row["points"]["default"]
            ratio = ratios(row, "look").get("default")
            cells = (
                f"{draco['look']:.2f}",
                f"{ours['look']:.2f}",
                "-" if ratio is None else f"{ratio:.2f}",
            )
            found.append(
                (
                    row["mesh"],
                    f"{row['vertices']:,}",
                    f"{draco['bytes']:,}",
                    f"{ours['bytes']:,}",
                    *cells,
                )
            )
    return found


def _medians(rows: Sequence[Row], words: str) -> Table:
    """Medians and quartiles of bytes over Draco's, a row for what is compared and a column for each measure."""
    each = {measure: [ratios(row, measure) for row in rows] for measure in MEASURES}
    lines = []
    for name in WHAT:
        cells = []
        for measure in MEASURES:
            values = [entry[name] for entry in each[measure] if name in entry]
            low, middle, high = np.quantile(values, (0.25, 0.5, 0.75)) if values else (np.nan,) * 3
            cells.append(f"{middle:.2f} ({low:.2f}-{high:.2f})" if values else "-")
        lines.append((name, *cells))
    faces = [row["vertices"] for row in rows]
    note = (
        f"{len(rows)} meshes of {min(faces):,} to {max(faces):,} vertices. Bytes over Draco's (level 10, 7 to 14 bits) "
        f"at equal quality by each measure: median, and the quartiles. BD-rate compares our line of {', '.join(CURVE)} "
        "with Draco's over the range of both. meshoptimizer: index and vertex buffers (level 3, version 1), then gzip. "
        "A mesh counts where its quality lies within Draco's; at a dash none does."
    )
    return Table(
        f"Bytes over Draco's at equal quality, {words}", ("", *MEASURES.values()), lines, note
    )


def figures(results: dict[str, list[Row]]) -> Iterator[Picture]:
    """Every figure that the results allow."""
    rows = [row for row in results.get("rates", []) if row["group"] == "unseen"]
    if rows:
        values = {
            label: [
                entry["BD-rate"] for row in rows if "BD-rate" in (entry := ratios(row, measure))
            ]
            for measure, label in MEASURES.items()
        }
        yield _boxes("rates", values, "bytes over Draco's at equal quality (BD-rate)")
    timed = [row["seconds"] for row in results.get("times", [])]
    if timed:
        names = [name for name in timed[0] if not name.startswith("Draco")]
        values = {n: [s[n] / s[f"Draco 11, {n.split(', ')[1]}"] for s in timed] for n in names}
        yield _boxes("times", values, "time over Draco's", logarithmic=True)
    if results.get("ablation"):
        every = [row["tools"] for row in results["ablation"]]
        values = {
            name: [entry[name]["bytes"] for entry in every if "bytes" in entry.get(name, {})]
            for name in TOOLS
        }
        yield _boxes("ablation", values, "bytes without the tool over those with it")
    if results.get("motion"):
        yield Picture("motion", lambda figure: _motion(figure, results["motion"]), 7.0, 2.6)


def _boxes(
    name: str, values: dict[str, list[float]], label: str, logarithmic: bool = False
) -> Picture:
    """A row for each name: median, a bar between quartiles, all meshes as dots, and a line at 1."""

    values = {label: numbers for label, numbers in values.items() if numbers}

    def draw(figure: Any) -> None:
        axes = figure.subplots()
        random = np.random.default_rng(1)
        color = STYLES["ours"][0]
        for at, numbers in enumerate(reversed(values.values())):
            shaken = at + random.uniform(-0.25, 0.25, len(numbers))
            axes.plot(numbers, shaken, ".", color="#888888", markersize=2, alpha=0.6)
            low, middle, high = np.quantile(numbers, (0.25, 0.5, 0.75))
            axes.plot(
                (low, high), (at, at), color=color, linewidth=6, alpha=0.4, solid_capstyle="butt"
            )
            axes.plot(middle, at, "|", color=color, markersize=11, markeredgewidth=1.5)
        axes.set_yticks(range(len(values)), list(reversed(values)))
        axes.axvline(1.0, color="black", linewidth=0.6)
        axes.set(xlabel=label, xscale="log" if logarithmic else "linear")
        axes.grid(axis="x", alpha=0.3)

    return Picture(name, draw, 5.0, 0.6 + 0.28 * len(values))


def _motion(figure: Any, rows: Sequence[Row]) -> None:
    grid = figure.subplots(1, min(3, len(rows)), squeeze=False)[0]
    for axes, row in zip(grid, rows):
        for codec, names in {
            "ours": list(motion.OURS)[:2],
            "draco": [f"Draco {b}" for b in motion.DRACO_BITS],
        }.items():
            points = [row["points"][name] for name in names]
            rates = [8 * p["bytes"] / row["frames"] / row["vertices"] for p in points]
            color, marker = STYLES[codec]
            label = "ours" if codec == "ours" else "Draco by frames"
            axes.plot(rates, [p["sted"] for p in points], color=color, marker=marker, label=label)
        axes.set(
            xscale="log", yscale="log", xlabel="bits per vertex and frame", title=row["sequence"]
        )
        axes.grid(alpha=0.3)
    grid[0].set_ylabel("STED")
    grid[0].legend()


def write(results: dict[str, list[Row]], folder: Path, note: Callable[[str], None]) -> None:
    """All tables and figures into a folder."""
    for name, entry in tables(results).items():
        words = f"{entry.note}\n\n" if entry.note else ""
        text = f"## {entry.title}\n\n{words}{table(entry.columns, entry.rows)}\n"
        (folder / f"{name}.md").write_text(text, encoding="utf-8")
        (folder / f"{name}.tex").write_text(
            table(entry.columns, entry.rows, "latex_booktabs") + "\n", encoding="utf-8"
        )
    for picture in figures(results):
        picture.save(folder, ("pdf", "png"))
    note(f"{folder}: tables, figures and results.json")


def require_commits(results: dict[str, list[Row]]) -> None:
    """Refuse what was measured on changed files, or on a commit that does not lead to the one that is checked out."""
    for commit in {row["run"]["commit"] for rows in results.values() for row in rows}:
        known = git("rev-parse", "--verify", "--quiet", f"{commit}^{{commit}}")
        if not known or git("merge-base", known, "HEAD") != known:
            raise SystemExit(
                f"--docs: {commit} is not an ancestor of HEAD: commit all changes, and measure again"
            )


def origin(rows: Sequence[Row]) -> str:
    """The commits, machines and dates of a table."""
    runs = {(row["run"]["commit"], row["run"]["processor"], row["run"]["date"]) for row in rows}
    return " ".join(f"Commit {', '.join(run)}." for run in sorted(runs, key=itemgetter(2, 0)))


def write_page(results: dict[str, list[Row]], file: Path = PAGE) -> None:
    """Put the tables into docs/measured.md, each with its origin; what no run in this folder made stays."""
    page = file.read_text(encoding="utf-8") if file.exists() else ""
    kept = {
        f"## {part.partition(chr(10))[0]}": part.partition("\n")[2].strip()
        for part in page.split("\n## ")[1:]
    }
    # All are made anew: tables of earlier experiments go.
    if len(results.get("paper", ())) >= len(TABLES):
        kept = {
            title: text for title, text in kept.items() if not title.startswith("## The paper, ")
        }
    for name, entry in tables(results).items():
        stage, _, number = name.partition("-")
        rows = results[stage] if stage != "paper" else [results[stage][int(number)]]
        words = fill(f"{entry.note} {origin(rows)}".strip(), 120)
        kept[f"## {entry.title}"] = f"{words}\n\n{table(entry.columns, entry.rows)}"
    parts = [f"{title}\n\n{text}" for title, text in kept.items()]
    file.write_text("\n\n".join([INTRODUCTION, *parts]) + "\n", encoding="utf-8")
