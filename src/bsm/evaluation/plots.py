"""Pictures of the evaluation, drawn from its JSON and nothing else."""

from __future__ import annotations

import io
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import DependencyError
from bsm.bitstream.extras import how_to_install
from bsm.evaluation.rates import MEASURES

Result = Mapping[str, Any]
FORMATS = ("png", "svg")
AXES = {"nmsve_db": "NMSVE, dB", "theta_deg": "θ, degrees"}


def draw_paper_figure(results: Sequence[Result], stem: Path) -> list[Path]:
    """Bits per vertex of the coefficients against NMSVE, time beside every line: the paper's figure for one mesh."""

    def draw(axes: Any) -> None:
        ends = []
        for style, result in zip(_styles(), results):
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
        axes.set_xlabel("bits per vertex, 3 q c k / n")
        axes.set_ylabel(AXES["nmsve_db"])
        axes.legend(fontsize=7, title="decoding time", title_fontsize=7)
        axes.set_title(_title(results[0]))

    return _draw(draw, stem)


def draw_rates(results: Sequence[Result], stem: Path, measure: str) -> list[Path]:
    """Bits per vertex of the whole file against one of `MEASURES`, one line per codec."""

    def draw(axes: Any) -> None:
        for style, result in zip(_styles(), results):
            points = sorted((p for p in result["points"] if p[measure] is not None), key=lambda p: p["bpv_total"])
            label = f"{result['label']}  ({time_range(result)})"
            axes.plot([p["bpv_total"] for p in points], [p[measure] for p in points], style, markersize=4, label=label)
        axes.set_xscale("log")
        ticks = [0.5, 1, 2, 3, 4, 6, 8, 12, 16, 24, 32]
        axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
        axes.minorticks_off()
        rates = [p["bpv_total"] for r in results for p in r["points"]]
        axes.set_xlim(min(rates) * 0.9, max(rates) * 1.1)
        if measure == "theta_deg":
            axes.set_yscale("log")
        axes.set_xlabel("bits per vertex, whole file")
        axes.set_ylabel(AXES[measure])
        axes.legend(fontsize=7, title="decoding time", title_fontsize=7)
        axes.set_title(_title(results[0]))

    return _draw(draw, stem)


def draw_per_block(blocks: Mapping[str, Sequence[Mapping[str, float]]], stem: Path) -> list[Path]:
    """Squared error and coefficients of each block along the chain, one line per label: the paper's second figure."""

    def draw(figure: Any) -> None:
        upper, lower = figure.subplots(2, 1, sharex=True)
        for label, rows in blocks.items():
            upper.plot([row["squared_error"] for row in rows], lw=1, label=label)
            lower.step(range(len(rows)), [row["coefficients"] for row in rows], where="mid", lw=1, label=label)
        upper.set_yscale("log")
        upper.set_ylabel("mean squared error")
        lower.set_ylabel("coefficients kept")
        lower.set_xlabel("block")
        upper.legend(fontsize=7)

    return _draw_figure(draw, stem)


def draw_boxes(groups: Mapping[str, Mapping[str, npt.NDArray[np.float64]]], stem: Path) -> list[Path]:
    """Box plots of deviations: for each case one box per group of values (inside blocks, at their boundaries)."""

    def draw(axes: Any) -> None:
        names = [f"{case}\n{group}" for case, values in groups.items() for group in values]
        axes.boxplot([1e3 * v for values in groups.values() for v in values.values()], tick_labels=names)
        axes.tick_params(axis="x", labelsize=7)
        axes.set_ylabel("standard deviation of the error, thousandths of the diagonal")

    return _draw(draw, stem)


def draw_sequence_rates(
    lines: Mapping[str, Sequence[Mapping[str, Any]]], measure: str, label: str, title: str, stem: Path
) -> list[Path]:
    """Bits per vertex and frame of the whole file against one measure of a sequence, one line per codec."""

    def draw(axes: Any) -> None:
        for style, (name, points) in zip(_styles(), lines.items()):
            ordered = sorted(points, key=lambda point: point["bpvf"])
            axes.plot([p["bpvf"] for p in ordered], [p[measure] for p in ordered], style, markersize=4, label=name)
        axes.set_xscale("log")
        axes.set_yscale("log")
        ticks = [0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20]
        axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
        axes.minorticks_off()
        axes.set_xlabel("bits per vertex and frame, whole file")
        axes.set_ylabel(label)
        axes.legend(fontsize=7)
        axes.set_title(title)

    return _draw(draw, stem)


def frame_errors(frames: Sequence[Mapping[str, float]], title: str) -> bytes:
    """A PNG of the errors of each frame of a sequence."""
    import_matplotlib()
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.0, 4.0), layout="constrained")
    axes = figure.subplots()
    axes.grid(alpha=0.3)
    for name, label in (("max_error_relative", "farthest vertex"), ("rms_relative", "root mean square")):
        axes.plot([100.0 * frame[name] for frame in frames], lw=1.2, label=label)
    axes.set_ylim(bottom=0.0)
    axes.set_xlabel("frame")
    axes.set_ylabel("% of the diagonal")
    axes.set_title(title)
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
            written += draw_paper_figure(sorted(paper, key=_slowest_first), folder / f"{mesh}.paper")
        # SVD in the paper's mode stands for the paper among whole files.
        best = [r for r in paper if r["codec"] in ("svd", "oi-r2")]
        if rest:
            for measure in MEASURES:
                written += draw_rates(rest + best, folder / f"{mesh}.{measure.split('_')[0]}", measure)
    return written


def time_range(result: Result) -> str:
    """Decoding times over a line's points, for its label."""
    seconds = [point["decode_seconds"] for point in result["points"]]
    low, high = min(seconds), max(seconds)
    return f"{low:.2g} s" if high < 1.1 * low else f"{low:.2g} to {high:.2g} s"


def import_matplotlib() -> ModuleType:
    """matplotlib, without a screen."""
    try:
        import matplotlib
    except ImportError as error:
        raise DependencyError(f"pictures need matplotlib: {how_to_install('eval')}") from error
    return matplotlib


def _draw(draw: Callable[[Any], None], stem: Path) -> list[Path]:
    def draw_alone(figure: Any) -> None:
        axes = figure.subplots()
        axes.grid(alpha=0.3)
        draw(axes)

    return _draw_figure(draw_alone, stem)


def _draw_figure(draw: Callable[[Any], None], stem: Path) -> list[Path]:
    import_matplotlib()
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.0, 5.0), layout="constrained")
    draw(figure)
    stem.parent.mkdir(parents=True, exist_ok=True)
    paths = [stem.parent / f"{stem.name}.{suffix}" for suffix in FORMATS]
    for path in paths:
        figure.savefig(path, dpi=150)
    return paths


def _slowest_first(result: Result) -> float:
    return -max(float(point["decode_seconds"]) for point in result["points"])


def _styles() -> list[str]:
    return ["o-", "s-", "^-", "v-", "D-", "P-", "X-", "<-", ">-", "*-", "h-", "p-"]


def _title(result: Result) -> str:
    mesh = result["mesh"]
    return f"{mesh['name']}: {mesh['vertices']} vertices, {mesh['faces']} faces"
