"""Pictures of the evaluation, drawn from its JSON and nothing else."""

import io
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from bsm.bitstream.extras import imported

Result = Mapping[str, Any]
FORMATS = ("png", "svg")
MEASURES = {"nmsve_db": "NMSVE, dB", "theta_deg": "θ, degrees"}
TICKS = (0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50)
STYLES = ("o-", "s-", "^-", "v-", "D-", "P-", "X-", "<-", ">-", "*-", "h-", "p-")


def draw_paper_figure(results: Sequence[Result], stem: Path) -> list[Path]:
    """Bits per vertex of the coefficients against NMSVE, time beside every line: the paper's figure for one mesh."""

    def draw(axes: Any) -> None:
        ends = []
        for style, result in zip(STYLES, results):
            points = sorted(result["points"], key=lambda point: point["bpv_paper"])
            x, y = [p["bpv_paper"] for p in points], [p["nmsve_db"] for p in points]
            line = axes.plot(x, y, style, markersize=4, label=f"{result['label']}  ({time_range(result)})")[0]
            ends.append((x[-1], y[-1], f"{points[-1]['decode_seconds']:.2g} s", line.get_color()))
        # Times stand in a column beside the lines, pushed apart where lines run together.
        gap, lowest = 0.028 * abs(np.diff(axes.get_ylim())[0]), -np.inf
        right = 1.015 * max(end[0] for end in ends)
        for _, y_end, text, color in sorted(ends, key=lambda end: end[1]):
            lowest = max(y_end, lowest + gap)
            axes.text(right, lowest, text, fontsize=7, color=color, va="center")
        axes.margins(x=0.08)
        axes.set(xlabel="bits per vertex, 3 q c k / n", ylabel=MEASURES["nmsve_db"], title=title_of(results[0]))
        axes.legend(fontsize=7, title="decoding time", title_fontsize=7)

    return draw_axes(draw, stem)


def draw_rates(
    lines: Mapping[str, Sequence[tuple[float, float]]], rate: str, measure: str, title: str, stem: Path
) -> list[Path]:
    """Points of a rate and an error, a line for each label; `rate` and `measure` say what they are."""

    def draw(axes: Any) -> None:
        for style, (label, points) in zip(STYLES, lines.items()):
            axes.plot(*zip(*sorted(points)), style, markersize=4, label=label)
        rates = [x for points in lines.values() for x, _ in points]
        axes.set(xscale="log", xlabel=rate, ylabel=measure, title=title)
        axes.set_xticks(TICKS, [f"{tick:g}" for tick in TICKS])
        axes.minorticks_off()
        if "dB" not in measure:
            axes.set_yscale("log")
        axes.set_xlim(min(rates) * 0.9, max(rates) * 1.1)
        axes.legend(fontsize=7)

    return draw_axes(draw, stem)


def frame_errors(frames: Sequence[Mapping[str, float]], title: str) -> bytes:
    figure = new_figure(7.0, 4.0)
    axes = figure.subplots()
    axes.grid(alpha=0.3)
    for name, label in (("max_error_relative", "farthest vertex"), ("rms_relative", "root mean square")):
        axes.plot([100.0 * frame[name] for frame in frames], lw=1.2, label=label)
    axes.set_ylim(bottom=0.0)
    axes.set(xlabel="frame", ylabel="% of the diagonal", title=title)
    axes.legend(fontsize=8)
    file = io.BytesIO()
    figure.savefig(file, format="png", dpi=150)
    return file.getvalue()


def draw_all(results: Iterable[Result], folder: Path) -> list[Path]:
    """Every picture that the results of a folder allow, mesh by mesh."""
    by_mesh: dict[str, list[Result]] = {}
    for result in results:
        by_mesh.setdefault(result["mesh"]["name"], []).append(result)
    written: list[Path] = []
    for mesh, group in by_mesh.items():
        paper = [r for r in group if r["points"] and "bits" in r["points"][0]["settings"]]
        rest = [r for r in group if r not in paper]
        if paper:
            slowest_first = sorted(paper, key=lambda r: -max(float(p["decode_seconds"]) for p in r["points"]))
            written += draw_paper_figure(slowest_first, folder / f"{mesh}.paper")
        # SVD in the paper's mode stands for the paper among whole files.
        shown = [*rest, *(r for r in paper if r["codec"] in ("svd", "oi-r2"))] if rest else []
        for measure, label in MEASURES.items() if shown else ():
            labels = [f"{r['label']}  (decoded in {time_range(r)})" for r in shown]
            points = [[(p["bpv_total"], p[measure]) for p in points_of(r["points"], measure)] for r in shown]
            lines, stem = dict(zip(labels, points)), folder / f"{mesh}.{measure.split('_')[0]}"
            written += draw_rates(lines, "bits per vertex, whole file", label, title_of(shown[0]), stem)
    return written


def points_of(points: Sequence[Result], measure: str) -> list[Result]:
    """The points of a line of one of `MEASURES`: not those that were chosen for another, nor lossless ones."""
    kinds = [point.get("settings", {}).get("target", {}).get("kind", measure) for point in points]
    return [p for p, kind in zip(points, kinds, strict=True) if kind == measure and p[measure] is not None]


def time_range(result: Result) -> str:
    seconds = [point["decode_seconds"] for point in result["points"]]
    low, high = min(seconds), max(seconds)
    return f"{low:.2g} s" if high < 1.1 * low else f"{low:.2g} to {high:.2g} s"


def title_of(result: Result) -> str:
    return "{name}: {vertices} vertices, {faces} faces".format_map(result["mesh"])


def import_matplotlib() -> None:
    imported("matplotlib", "pictures need matplotlib", "eval")


def new_figure(width: float = 7.0, height: float = 5.0) -> Any:
    import_matplotlib()
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout="constrained")


def draw_axes(draw: Callable[[Any], None], stem: Path) -> list[Path]:
    """What a function draws on one pair of axes, as PNG and SVG; `stem` is a path without suffix."""
    figure = new_figure()
    axes = figure.subplots()
    axes.grid(alpha=0.3)
    draw(axes)
    return save_figure(figure, stem)


def save_figure(figure: Any, stem: Path) -> list[Path]:
    stem.parent.mkdir(parents=True, exist_ok=True)
    paths = [stem.parent / f"{stem.name}.{suffix}" for suffix in FORMATS]
    for path in paths:
        figure.savefig(path, dpi=150)
    return paths
