"""The documents' tables of denoising, made from figures that the benchmark wrote.

    F=tools/measure/figures/denoising.json
    python -m tools.measure denoise MESHES automatic clean kinds gaussian hard flicker --json $F
    python -m tools.measure tables

The first measures, the second writes what stands in docs/measured.md between the two marks.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
FIGURES = ROOT / "tools" / "measure" / "figures" / "denoising.json"
PAGE = ROOT / "docs" / "measured.md"
BEGIN, END = "<!-- denoising: made by tools.measure tables -->", "<!-- denoising: end -->"


def denoising_tables(figures: dict[str, Any]) -> str:
    """Markdown of the tables."""
    cases = figures["automatic"]
    rows = (("noisy", 0), ("automatic", 2), ("best fixed scheme", 1))
    lines = ["| | " + " | ".join(cases) + " |", "|---|" + "---:|" * len(cases)]
    lines += [f"| {name} | " + " | ".join(f"{values[at]:.2f}" for values in cases.values()) + " |" for name, at in rows]
    clean, kinds, gaussian = figures["clean"], figures["kinds"], figures["gaussian"]
    ratios = [f"{kind} {value:.2f}" for kind, value in kinds.items() if kind not in ("worse", "of")]
    sequences = [f"{measure} {value:.2f}" for measure, value in figures["flicker"].items()]
    hard = [f"{case} edges {value:.2f}" for case, value in figures["hard"].items()]
    lines += [
        "",
        f"- Clean meshes: {clean['untouched']} of {clean['of']} come back bit for bit; the normals of the others are "
        f"turned by {clean['largest']:.2f} degrees at most.",
        f"- {kinds['worse']} of {kinds['of']} noisy ones (eleven kinds of noise, two levels) are worse than their "
        f"input. Mean ratio to the best of the fixed recipes: {', '.join(ratios)}.",
        "- White noise, against guided filtering, bilateral normal filtering and the paper's scheme, each stopped by "
        f"an oracle: {gaussian['mean']:.2f} of the best of the three, {gaussian['worst']:.2f} at worst.",
        f"- Sequences against their frames one by one: {', '.join(sequences)}.",
        f"- {'; '.join(hard)} (degrees).",
    ]
    return "\n".join(lines)


def put_in(text: str, tables: str) -> str:
    """The text with the tables between its marks."""
    before, rest = text.split(BEGIN)
    _, after = rest.split(END)
    return f"{before}{BEGIN}\n\n{tables}\n\n{END}{after}"


def main() -> None:
    """Write the tables."""
    tables = denoising_tables(json.loads(FIGURES.read_text(encoding="utf-8")))
    PAGE.write_text(put_in(PAGE.read_text(encoding="utf-8"), tables), encoding="utf-8")
