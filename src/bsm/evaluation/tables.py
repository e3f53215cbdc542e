"""Tables in Markdown, readable as they are and fit for the README."""

from __future__ import annotations

from collections.abc import Sequence


def table(columns: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A table whose columns are padded to the same width, the first to the left and the others to the right."""
    widths = [max(2, *(len(row[i]) for row in (columns, *rows))) for i in range(len(columns))]
    rule = ["-" * widths[0], *("-" * (width - 1) + ":" for width in widths[1:])]

    def line(cells: Sequence[str]) -> str:
        padded = [cells[0].ljust(widths[0]), *(cell.rjust(width) for cell, width in zip(cells[1:], widths[1:]))]
        return f"| {' | '.join(padded)} |"

    return "\n".join([line(columns), line(rule), *(line(row) for row in rows)])


def number(value: float | None, digits: int) -> str:
    """A number, or a dash where there is none."""
    return "-" if value is None else f"{value:.{digits}f}"


def percent(value: float | None) -> str:
    """A signed percentage, or a dash."""
    return "-" if value is None else f"{value:+.1f} %"
