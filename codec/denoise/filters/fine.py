"""Fine steps by name: each takes noisy or coarsely denoised positions and returns denoised ones."""

from __future__ import annotations

from typing import Protocol

from bsm.codec.arrays import Faces, Positions
from bsm.codec.choices import named
from bsm.codec.denoise.filters.bilateral_normal import bilateral_normal_filtering
from bsm.codec.denoise.filters.guided import guided_normal_filtering


class FineStep(Protocol):
    """Positions (n, 3), faces (m, 3) and a number of iterations, whose default is the method's own, to positions."""

    def __call__(self, positions: Positions, faces: Faces, iterations: int = ...) -> Positions: ...


FINE_STEPS: dict[str, FineStep] = {
    "guided": guided_normal_filtering,
    "bilateral-normal": bilateral_normal_filtering,
}


def fine_step(name: str) -> FineStep:
    """The fine step called `name`; `OptionError` if there is none."""
    return named("fine step", FINE_STEPS, name)
