"""What a report is made of, tables and pictures with each number beside the paper's; how much came out; its HTML."""

from __future__ import annotations

import base64
import html
import json
from dataclasses import asdict, dataclass
from typing import Any


@dataclass(frozen=True)
class Column:
    """A quantity of a table."""

    name: str
    digits: int
    tolerance: float | None = None
    why: str = ""


@dataclass(frozen=True)
class Cell:
    """One number: ours, and the paper's where it prints one."""

    ours: float | None
    paper: float | None = None
    why: str = ""

    @property
    def deviation(self) -> float | None:
        """Ours over the paper's, less one; of numbers in decibels and the like as well."""
        if self.ours is None or not self.paper:
            return None
        return (self.ours - self.paper) / abs(self.paper)


@dataclass(frozen=True)
class Table:
    """Rows of numbers."""

    title: str
    stub: str
    columns: tuple[Column, ...]
    rows: tuple[tuple[str, tuple[Cell, ...]], ...]

    def differs(self, column: Column, cell: Cell) -> bool:
        """Whether a number disagrees with the paper's."""
        off = cell.deviation
        return off is not None and column.tolerance is not None and abs(off) > column.tolerance

    def compared(self) -> tuple[int, int]:
        """How many numbers stand beside one of the paper, and how many of these agree."""
        pairs = [
            self.differs(column, cell)
            for _, cells in self.rows
            for column, cell in zip(self.columns, cells, strict=True)
            if cell.deviation is not None and column.tolerance is not None
        ]
        return len(pairs), pairs.count(False)

    def as_json(self) -> dict[str, Any]:
        """Everything, ready for JSON."""
        return {
            "title": self.title,
            "columns": [column.name for column in self.columns],
            "rows": [
                {
                    "label": label,
                    "cells": [
                        {
                            "ours": cell.ours,
                            "paper": cell.paper,
                            "note": (cell.why or column.why) if self.differs(column, cell) else None,
                        }
                        for column, cell in zip(self.columns, cells, strict=True)
                    ],
                }
                for label, cells in self.rows
            ],
        }


@dataclass(frozen=True, eq=False)
class Picture:
    """A picture in a file format of the web."""

    caption: str
    media: str
    data: bytes


@dataclass(frozen=True)
class Claim:
    """Something that the paper says in words, and whether it came out here."""

    says: str
    holds: bool
    found: str


@dataclass(frozen=True, eq=False)
class Exhibit:
    """A table or figure of the paper, made again."""

    title: str
    place: str
    tables: tuple[Table, ...] = ()
    pictures: tuple[Picture, ...] = ()
    remarks: tuple[str, ...] = ()
    claims: tuple[Claim, ...] = ()

    def compared(self) -> tuple[int, int]:
        """How many numbers of all tables stand beside one of the paper, and how many of these agree."""
        counts = [table.compared() for table in self.tables]
        return sum(count[0] for count in counts), sum(count[1] for count in counts)

    def as_json(self) -> dict[str, Any]:
        """Everything but the pictures, ready for JSON."""
        return {
            "title": self.title,
            "place": self.place,
            "tables": [table.as_json() for table in self.tables],
            "pictures": [picture.caption for picture in self.pictures],
            "remarks": list(self.remarks),
            "claims": [asdict(claim) for claim in self.claims],
        }


@dataclass(frozen=True)
class Score:
    """A line of the scoreboard."""

    name: str
    numbers: int
    agreeing: int
    claims: int
    holding: int

    @property
    def words(self) -> str:
        """The line in words."""
        said = []
        if self.numbers:
            said.append(f"{self.agreeing} of {self.numbers} numbers agree with the paper's")
        if self.claims:
            said.append(f"{self.holding} of {self.claims} claims hold")
        return ", ".join(said) or "no numbers in the paper"


def scores(exhibits: dict[str, Exhibit]) -> tuple[Score, ...]:
    """A line for each exhibit, and the sum of all as the last one."""
    lines = [
        Score(key, *exhibit.compared(), len(exhibit.claims), sum(claim.holds for claim in exhibit.claims))
        for key, exhibit in exhibits.items()
    ]
    return (
        *lines,
        Score(
            "in all",
            sum(line.numbers for line in lines),
            sum(line.agreeing for line in lines),
            sum(line.claims for line in lines),
            sum(line.holding for line in lines),
        ),
    )


PAPER = "Block-Based Spectral Processing of Static and Dynamic 3D Meshes using Orthogonal Iterations"
_GENERATED = "A generated mesh stands in for the paper's, so the numbers need not agree."
_STYLE = """
body { font: 15px/1.5 system-ui, sans-serif; max-width: 72em; margin: 2em auto; padding: 0 1em; color: #222 }
h1 { font-size: 1.6em } h2 { margin: 2.5em 0 0 } h3 { font-size: 1em; margin: 1.2em 0 .3em }
.place { color: #777; margin: 0 }
table { border-collapse: collapse; font-variant-numeric: tabular-nums }
th, td { padding: .15em .8em; text-align: right; border-bottom: 1px solid #ddd; vertical-align: baseline }
th:first-child, td:first-child { text-align: left }
.paper { color: #777 } .differs { background: #fff3cd } sup a { text-decoration: none }
.notes { font-size: .87em; color: #555; margin: .4em 0 1em; padding-left: 1.6em }
figure { display: inline-block; margin: .5em; vertical-align: top; text-align: center }
figure img { max-width: 100%; display: block }
figcaption { font-size: .85em; color: #555; max-width: 20em; margin: auto }
figure.wide figcaption { max-width: none }
.warning { background: #fff3cd; padding: .6em 1em }
"""


def report(exhibits: dict[str, Exhibit], models: Table, *, generated: bool, quick: bool) -> str:
    """The whole HTML document."""
    words = []
    if generated:
        words.append(
            "There were no real meshes: generated ones stand in for all models. What is measured is measured on "
            "them, and the paper's numbers stand beside for orientation only. Name a folder of meshes with --meshes."
        )
    if quick:
        words.append("Quick run: few settings, small pictures, times of single runs.")
    contents = "".join(f'<li><a href="#{key}">{_text(e.title)}</a></li>' for key, e in exhibits.items())
    data = json.dumps({key: e.as_json() for key, e in exhibits.items()}, allow_nan=False).replace("<", "\\u003c")
    return "".join(
        [
            '<!doctype html><html lang="en"><head><meta charset="utf-8"><title>The paper, measured again</title>',
            f"<style>{_STYLE}</style></head><body><h1>The paper, measured again</h1>",
            f"<p>Every table and figure of <i>{_text(PAPER)}</i> (Arvanitis, Lalos, Moustakas), made by this program. "
            "Beside each number, in grey, the paper's; where the two differ by more than is to be expected, it says by "
            "how much, and a note says why. Angles are in degrees; theta is the mean angle between the normals of "
            "corresponding faces, MND the mean length of their difference.</p>",
            *(f'<p class="warning">{_text(word)}</p>' for word in words),
            _table(models, "models", generated=False),
            _scoreboard(exhibits),
            f"<ol>{contents}</ol>",
            *(_exhibit(key, exhibit, generated=generated) for key, exhibit in exhibits.items()),
            f'<script type="application/json" id="data">{data}</script></body></html>\n',
        ]
    )


def summary(exhibits: dict[str, Exhibit]) -> str:
    """The scoreboard as text: how many numbers were compared and agree, and how many claims hold; the sum at last."""
    lines = []
    for score, exhibit in zip(scores(exhibits), (*exhibits.values(), None), strict=True):
        made = f"{len(exhibit.tables)} tables, {len(exhibit.pictures):>2} pictures; " if exhibit else ""
        lines.append(f"{score.name:<16}{made}{score.words}")
    return "\n".join(lines)


def _scoreboard(exhibits: dict[str, Exhibit]) -> str:
    rows = []
    for score in scores(exhibits):
        name = f'<a href="#{score.name}">{_text(score.name)}</a>' if score.name in exhibits else _text(score.name)
        cells = (score.agreeing, score.numbers, score.holding, score.claims)
        rows.append(f"<tr><td>{name}</td>{''.join(f'<td>{cell}</td>' for cell in cells)}</tr>")
    heads = "".join(f"<th>{head}</th>" for head in ("numbers agree", "of", "claims hold", "of"))
    failed = [claim for exhibit in exhibits.values() for claim in exhibit.claims if not claim.holds]
    return (
        f'<div id="scoreboard"><h3>Scoreboard</h3><table><thead><tr><th>exhibit</th>{heads}</tr></thead>'
        f"<tbody>{''.join(rows)}</tbody></table>"
        + (f"<p>What does not hold:</p><ul>{''.join(map(_claim, failed))}</ul>" if failed else "")
        + "</div>"
    )


def _claim(claim: Claim) -> str:
    verdict = "holds" if claim.holds else "does not hold"
    return f"<li>{_text(claim.says)} <b>{verdict}</b>: {_text(claim.found)}</li>"


def _exhibit(key: str, exhibit: Exhibit, *, generated: bool) -> str:
    tables = (_table(table, f"{key}-{i}", generated=generated) for i, table in enumerate(exhibit.tables))
    return "".join(
        [
            f'<section id="{key}"><h2>{_text(exhibit.title)}</h2><p class="place">{_text(exhibit.place)}</p>',
            *tables,
            *map(_picture, exhibit.pictures),
            *(f"<p>{_text(remark)}</p>" for remark in exhibit.remarks),
            f"<ul>{''.join(map(_claim, exhibit.claims))}</ul>" if exhibit.claims else "",
            "</section>",
        ]
    )


def _table(table: Table, key: str, *, generated: bool) -> str:
    notes: list[str] = []
    rows = []
    for label, cells in table.rows:
        entries = [_cell(table, column, cell, key, notes, generated) for column, cell in zip(table.columns, cells)]
        rows.append(f"<tr><td>{_text(label)}</td>{''.join(entries)}</tr>")
    heads = "".join(f"<th>{_text(column.name)}</th>" for column in table.columns)
    listed = "".join(f'<li id="{key}-note{i}">{note}</li>' for i, note in enumerate(notes, start=1))
    return (
        f"<h3>{_text(table.title)}</h3><table><thead><tr><th>{_text(table.stub)}</th>{heads}</tr></thead>"
        f"<tbody>{''.join(rows)}</tbody></table>" + (f'<ol class="notes">{listed}</ol>' if notes else "")
    )


def _cell(table: Table, column: Column, cell: Cell, key: str, notes: list[str], generated: bool) -> str:
    ours = "-" if cell.ours is None else f"{cell.ours:.{column.digits}f}"
    if cell.paper is None:
        return f"<td>{ours}</td>"
    there = f'<span class="paper">{cell.paper:.{column.digits}f}</span>'
    off = cell.deviation
    if off is None or not table.differs(column, cell):
        return f"<td>{ours} {there}</td>"
    reason = _GENERATED if generated else cell.why or column.why
    # One note for all numbers that differ for one reason; by how much stands with the number.
    note = _text(reason)
    if note not in notes:
        notes.append(note)
    number = notes.index(note) + 1
    return (
        f'<td class="differs">{ours} {there} <small>{100 * off:+.0f}&thinsp;%</small>'
        f'<sup><a href="#{key}-note{number}">{number}</a></sup></td>'
    )


def _picture(picture: Picture) -> str:
    kind = ' class="wide"' if picture.media == "image/svg+xml" else ""
    source = f"data:{picture.media};base64,{base64.b64encode(picture.data).decode()}"
    caption = _text(picture.caption)
    return f'<figure{kind}><img alt="{caption}" src="{source}"><figcaption>{caption}</figcaption></figure>'


def _text(value: Any) -> str:
    return html.escape(str(value))
