"""Pictures of the paper's figures."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import imported
from bsm.codec.arrays import Faces, Positions
from bsm.evaluation.curve import Picture
from bsm.ground.pictures import DEFAULT_VIEW, bounds_of, render

Floats = npt.NDArray[np.float64]
PIXELS = 420


def save(
    output: Path | None, name: str, draw: Callable[[Any], None], width: float, height: float
) -> None:
    """A picture as PNG and PDF, where there is a folder for it."""
    if output is not None:
        imported("matplotlib", "pictures need matplotlib", "eval")
        Picture(name, draw, width, height).save(output, ("png", "pdf"))


def save_surfaces(
    output: Path | None,
    name: str,
    faces: Faces,
    rows: Sequence[Mapping[str, Positions]],
    labels: Sequence[str] = (),
) -> None:
    """Surfaces under titles, all in the frame of the first."""
    if output is None:
        return
    first = next(iter(rows[0].values()))
    bounds = bounds_of(first, DEFAULT_VIEW)
    pictures = [
        {title: render(p, faces, PIXELS, bounds=bounds) for title, p in row.items()} for row in rows
    ]

    def draw(figure: Any) -> None:
        grid = figure.subplots(len(rows), max(map(len, rows)), squeeze=False)
        for axes in grid.flat:
            axes.set_axis_off()
        for line, row in zip(grid, pictures, strict=True):
            for axes, (title, picture) in zip(line, row.items()):
                axes.imshow(picture)
                axes.set_title(title)
        for line, label in zip(grid, labels):
            line[0].text(-0.04, 0.5, label, rotation=90, va="center", transform=line[0].transAxes)

    save(output, name, draw, 1.7 * max(map(len, rows)), 1.9 * len(rows))


def save_matrices(output: Path | None, models: Mapping[str, Sequence[Floats]]) -> None:
    """Figure 8: three matrices of each model with color bars, from the hundredth least to the hundredth largest value.

    With the extremes as ends, a few entries would leave all others in one color.
    """

    def draw(figure: Any) -> None:
        grid = figure.subplots(len(models), 3, squeeze=False)
        for line, (name, matrices) in zip(grid, models.items(), strict=True):
            for number, (axes, matrix) in enumerate(zip(line, matrices, strict=True), 1):
                low, high = np.quantile(matrix, (0.01, 0.99))
                shown = axes.imshow(matrix, cmap="viridis", vmin=low, vmax=high)
                axes.set(xticks=[], yticks=[], title=f"{name}, R[{number}]")
                figure.colorbar(shown, ax=axes, extend="both", shrink=0.8)

    save(output, "figure-8", draw, 8.4, 2.2 * len(models))


def save_boxes(
    output: Path | None, panels: Mapping[str, Mapping[str, tuple[Floats, Floats]]]
) -> None:
    """Figure 4: standard deviations of the errors of inner and boundary vertices, one for each segment."""

    def draw(figure: Any) -> None:
        for axes, (title, cases) in zip(
            figure.subplots(1, len(panels), squeeze=False)[0], panels.items()
        ):
            values = [own[own == own] for pair in cases.values() for own in pair]
            axes.boxplot(values, widths=0.6)
            names = [f"{name}\n{where}" for name in cases for where in ("inner", "boundary")]
            axes.set_xticks(range(1, len(values) + 1), names, rotation=60, ha="right")
            axes.set(title=title, ylabel="standard deviation of errors")
            axes.grid(axis="y", alpha=0.3)

    save(output, "figure-4", draw, 3.4 * len(panels), 3.4)


def save_lines(
    output: Path | None,
    name: str,
    lines: Mapping[str, Sequence[tuple[float, float]]],
    x: str,
    y: str,
    title: str,
) -> None:
    """Lines with markers, and labels beside their ends."""

    def draw(figure: Any) -> None:
        axes = figure.subplots()
        for marker, (label, points) in zip("os^vDP*X<>hp" * 3, lines.items()):
            axes.plot(*zip(*points), marker=marker, label=label)
        axes.set(xlabel=x, ylabel=y, title=title)
        axes.grid(alpha=0.3)
        axes.legend()

    save(output, name, draw, 5.0, 3.6)


def save_segments(output: Path | None, panels: Mapping[str, Mapping[str, Sequence[float]]]) -> None:
    """Figure 12: numbers of each segment, a panel above the other."""

    def draw(figure: Any) -> None:
        grid = figure.subplots(len(panels), 1, sharex=True, squeeze=False)[:, 0]
        for axes, (title, lines) in zip(grid, panels.items(), strict=True):
            for label, values in lines.items():
                axes.plot(range(1, len(values) + 1), values, label=label)
            axes.set_ylabel(title)
            axes.grid(alpha=0.3)
        grid[0].legend(ncols=2)
        grid[-1].set_xlabel("segment")

    save(output, "figure-12", draw, 6.6, 2.3 * len(panels))
