"""What the report is made of: exhibits of tables and pictures, each number beside the paper's."""

from __future__ import annotations

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
