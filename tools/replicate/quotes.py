"""What the documents quote of the paper's experiments: passages made of paper.json, which is kept beside this."""

import json
from pathlib import Path
from textwrap import fill

from tools.replicate.rates import Row

KEPT = Path(__file__).with_name("paper.json")
TEXTS = Path(__file__).with_name("passages")
ROOT = Path(__file__).parents[2]
WIDTH = 120
PASSAGES = {
    "shares": "codec/PAPER.md",
    "claims": "codec/PAPER.md",
    "verdicts": "codec/PAPER.md",
    "speed": "codec/PAPER.md",
    "warm": "docs/how-it-works.md",
    "results": "docs/guides/research.md",
    "parts": "docs/guides/research.md",
}
"""The document of each; its text, with the numbers of jobs, is a file in passages/. Marks in the document name it."""


def keep(tables: dict[str, list[Row]], file: Path = KEPT) -> None:
    """Write the numbers that are quoted, and the run of each experiment; those of others stay."""
    kept = json.loads(file.read_text(encoding="utf-8"))
    for name, rows in tables.items():
        kept["runs"][name] = rows[0]["run"]
        if numbers := {k: v for row in rows for k, v in row["numbers"].items()}:
            kept["numbers"][name] = numbers
    file.write_text(json.dumps(kept, indent=1) + "\n", encoding="utf-8")


def passage(name: str) -> str:
    """The text of a passage, as it stands in the document."""
    numbers = json.loads(KEPT.read_text(encoding="utf-8"))["numbers"]
    text = (TEXTS / f"{name}.txt").read_text(encoding="utf-8").strip()
    parts = text.format_map(numbers).split("\n\n")
    return "\n\n".join(
        part if part.startswith("|") else fill(part.replace("\n", " "), WIDTH) for part in parts
    )


def with_passages(document: str, text: str) -> str:
    """The text of a document with its passages as they should be."""
    for name, place in PASSAGES.items():
        if place == document:
            begin, end = f"<!-- measured: {name} -->\n", f"<!-- end: {name} -->"
            before, _, rest = text.partition(begin)
            text = f"{before}{begin}{passage(name)}\n{end}{rest.partition(end)[2]}"
    return text


def rewrite() -> None:
    """Put all passages into their documents."""
    for document in set(PASSAGES.values()):
        path = ROOT / document
        path.write_text(with_passages(document, path.read_text(encoding="utf-8")), encoding="utf-8")
