"""The numbers that the paper prints, and tables that put ours beside them, in brackets."""

from collections.abc import Iterable, Mapping
from itertools import zip_longest
from typing import Any, NamedTuple

from tools.replicate.paper.models import Model
from tools.replicate.rates import Row

Line = tuple[str, tuple[float, ...], tuple[float | None, ...]]
"""A label, our numbers, and those of the paper, as many as it prints."""


class Claim(NamedTuple):
    """Something that the paper says in words; `judged` is None on stand-ins, and `value` is what decides, in `unit`."""

    says: str
    judged: bool | None
    words: str
    value: float
    unit: str

    def row(self) -> dict[str, Any]:
        return {"says": self.says, "holds": self.judged, "value": self.value, "unit": self.unit}


def printed(
    title: str,
    columns: Iterable[str],
    lines: Iterable[Line],
    *remarks: str | Claim,
    numbers: Mapping[str, str] | None = None,
) -> Row:
    """A table: our numbers, in brackets those of the paper; `numbers` are quoted by the documents."""
    rows = [
        [
            label,
            *(
                f"{x:.5g}" + ("" if y is None else f" ({y:.5g})")
                for x, y in zip_longest(ours, theirs)
            ),
        ]
        for label, ours, theirs in lines
    ]
    names = ["", *columns]
    rows = [row + [""] * (len(names) - len(row)) for row in rows]
    claims = [remark for remark in remarks if isinstance(remark, Claim)]
    words = [remark.words if isinstance(remark, Claim) else remark for remark in remarks]
    table = {"title": title, "columns": names, "rows": rows, "note": " ".join(filter(None, words))}
    return {**table, "claims": [each.row() for each in claims], "numbers": dict(numbers or {})}


def claim(says: str, holds: bool, found: str, *models: Model, value: float, unit: str) -> Claim:
    """Judge something that the paper says in words on these meshes; not on stand-ins."""
    others = [model for model in models if not model.own]
    if others:
        names = ", ".join(
            dict.fromkeys(f"{model.name} stands in for {model.title}" for model in others)
        )
        return Claim(says, None, f'"{says}" is not judged: {names}.', value, unit)
    names = " and ".join(dict.fromkeys(model.name for model in models))
    verdict = "holds" if holds else "does not hold"
    words = f'"{says}" {verdict} on {names}. {found[:1].upper()}{found[1:]}'
    return Claim(says, bool(holds), words, value, unit)


OVERLAPS = (1.0, 1.05, 1.10, 1.15, 1.20, 1.25)
"""n_d over the largest segment."""

JULIO = {
    50: (
        (741, 778, 815, 852, 889, 926),
        (0.1229, 0.1207, 0.1188, 0.1172, 0.116, 0.1159),
        (0.1167, 0.1166, 0.1163, 0.116, 0.1159, 0.1158),
    ),
    70: (
        (532, 558, 585, 611, 638, 665),
        (0.1248, 0.1228, 0.1203, 0.1188, 0.1174, 0.1164),
        (0.1176, 0.1173, 0.1172, 0.1169, 0.1169, 0.1164),
    ),
    100: (
        (372, 390, 409, 427, 446, 465),
        (0.1276, 0.1248, 0.1228, 0.1208, 0.1184, 0.1175),
        (0.1189, 0.1187, 0.1185, 0.1183, 0.1174, 0.1168),
    ),
}
"""Section 6.3, by segments and, in the order of `OVERLAPS`, overlap: n_d, mean normal difference coarse, and fine."""

BUNNY = {
    25: (0.0921, 0.0915),
    40: (0.0931, 0.0925),
    50: (0.0941, 0.0934),
    70: (0.0960, 0.0952),
    100: (0.0988, 0.0980),
    200: (0.1039, 0.1028),
    500: (0.1163, 0.1150),
}
"""Section 6.2: mean normal difference by number of segments; simple, then weighted average."""

COHERENCE = {
    "armadillo": (0.0606, 13.9720, 10.0905, 1.2347, 37.4199),
    "fandisk": (15.6144, 1.4120, 11.1582, 8.4506, 29.8815),
    "sphere": (10.4615, 11.4700, 0.8857, 3.9065, 26.4125),
    "star": (1.3122, 8.5019, 3.919, 0.6095, 29.6996),
    "twelve": (37.8481, 30.2103, 26.6648, 30.0618, 4.5641),
}
"""Section 6.4: mean squared error between one matrix of a model (rows) and the mean of each (columns, same order)."""

TIMES = {
    "armadillo": {
        10: (-47.5668, -47.4145, 8.65, 0.40, 22),
        15: (-47.6641, -47.5263, 8.80, 0.53, 16),
        20: (-47.7428, -47.6195, 9.06, 0.65, 14),
        25: (-47.8301, -47.7097, 9.16, 0.80, 12),
    },
    "hand": {
        10: (-59.0354, -58.8521, 48.36, 0.54, 89),
        15: (-58.872, -58.7107, 48.85, 0.69, 70),
        20: (-58.6218, -58.489, 49.14, 1.05, 46),
        25: (-58.3314, -58.2215, 49.53, 1.31, 37),
    },
}
"""Section 8.2, by c in percent of n_d: NMSVE of SVD and OI in dB, seconds of both, speed-up.

The paper has a misprint, -475263, for OI at 15 % on the Armadillo.
"""


def _by_power(*columns: tuple[float, ...]) -> dict[str, tuple[float, ...]]:
    return dict(
        zip(
            (*(f"R^{power}" for power in range(1, 10)), "SVD"),
            zip(*columns, strict=True),
            strict=True,
        )
    )


POWERS = {
    "twelve": _by_power(
        (0.031, 0.049, 0.099, 0.114, 0.136, 0.142, 0.157, 0.184, 0.201, 0.901),
        (11.57, 10.26, 13.97, 13.84, 13.7, 13.59, 13.57, 13.55, 13.53, 9.83),
    ),
    "fandisk": _by_power(
        (0.077, 0.11, 0.17, 0.202, 0.242, 0.297, 0.313, 0.355, 0.407, 1.953),
        (16.36, 14.75, 14.54, 14.54, 14.44, 14.5, 14.52, 14.84, 15.6, 14.56),
    ),
}
"""Section 8.2: seconds and theta in degrees after the coarse step, by the power of R."""
