"""The table of presets, from presets.csv. It imports nothing that takes time, since the command line prints it."""

import csv
from pathlib import Path
from typing import NamedTuple

DEFAULT = "balanced"


class PresetRow(NamedTuple):
    """A preset and its bounds; a bound of 0 is none."""

    name: str
    farthest: float
    look: float
    by_part: float
    frame_look: float
    frame_step: float
    use: str

    @property
    def bounds(self) -> tuple[str, str]:
        """The look distance and the vertex error, in words."""
        if not self.farthest:
            return "", ""
        return f"{self.look:g}", f"{100 * self.farthest:g} %"


def _rows() -> tuple[PresetRow, ...]:
    text = Path(__file__).with_name("presets.csv").read_text("utf-8")
    _, *lines = csv.reader(text.splitlines())
    rows = []
    for line in lines:
        farthest, look, by_part, frame_look, frame_step = (
            float(number or 0) for number in line[1:-1]
        )
        rows.append(PresetRow(line[0], farthest, look, by_part, frame_look, frame_step, line[-1]))
    return tuple(rows)


PRESET_ROWS = _rows()
SEQUENCE_ROWS = tuple(row for row in PRESET_ROWS if row.frame_step)
