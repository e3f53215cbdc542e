"""The table of presets in documents: `python -m tools.manuals` writes it."""

import re
from pathlib import Path

from bsm.codec.static.presets import PRESET_ROWS, PresetRow

ROOT = Path(__file__).parents[1]
DOCUMENTS = ("README.md", "docs/guides/presets.md")
_ROWS = re.compile(r"(?<=^\|---\|---\|---:\|---:\|\n)(?:\| `.*\n)+", re.MULTILINE)


def _row(row: PresetRow) -> str:
    cells = (f"`{row.name}`", row.use, *row.bounds)
    return "| " + " | ".join(cell for cell in cells if cell) + " |" * (1 + cells.count("")) + "\n"


def with_table(document: str) -> str:
    """Return a document with the rows of today's presets."""
    rows = "".join(_row(row) for row in PRESET_ROWS)
    text, count = _ROWS.subn(rows, document, count=1)
    assert count == 1, "the document has no table of presets"
    return text


def write_tables() -> None:
    """Write the table into all documents that have it."""
    for name in DOCUMENTS:
        path = ROOT / name
        path.write_text(with_table(path.read_text("utf-8")), "utf-8")
