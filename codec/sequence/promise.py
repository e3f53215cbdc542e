"""What every frame of a sequence keeps to."""

from __future__ import annotations

import math
from dataclasses import dataclass

from bsm.bitstream.errors import OptionError


@dataclass(frozen=True)
class Promise:
    """What holds in every frame, checked on what is decoded."""

    farthest: float
    look: float = math.inf
    absolute: bool = False

    def __post_init__(self) -> None:
        if not (0.0 < self.farthest < math.inf and self.look > 0.0):
            raise OptionError(f"bounds must be above 0, not {self.farthest:g} and a look of {self.look:g}")

    def reach(self, scale: float) -> float:
        """How far a vertex may be off in BSM units, `scale` of the mesh's own each."""
        return float(self.farthest / scale if self.absolute else self.farthest)

    @property
    def first_step(self) -> float:
        """A step to try first."""
        farthest = 0.01 if self.absolute else self.farthest
        return min(0.25 * farthest, 3.3e-3 * min(self.look, 1e3))

    def __str__(self) -> str:
        bound = f"no vertex farther off than {self.farthest:.4g}{'' if self.absolute else ' diagonals'}"
        return bound if math.isinf(self.look) else f"{bound} and a look of {self.look:g}"


PROMISES = {
    "small": Promise(0.02, 3.0),
    "balanced": Promise(0.01, 1.0),
    "fine": Promise(0.005, 0.5),
    "near-lossless": Promise(0.0005),
}
"""The presets of sequences, with the bounds of those of meshes."""
