"""What a caller may choose instead of the automatic mode."""

from __future__ import annotations

from dataclasses import dataclass

from bsm.bitstream.errors import OptionError
from bsm.bitstream.public import public
from bsm.codec.denoise.coarse import BLOCK_SIZE, KEEP
from bsm.codec.denoise.normals import fine_step
from bsm.codec.denoise.recipe import hand_over


@public
@dataclass(frozen=True, kw_only=True)
class DenoiseOptions:
    """How to denoise; the defaults are the paper's coarse-to-fine scheme."""

    hand_over: str = "positions"
    fine: str = "guided"
    iterations: int | None = None
    keep: float = KEEP
    block_size: int = BLOCK_SIZE

    def __post_init__(self) -> None:
        hand_over(self.hand_over)
        fine_step(self.fine)
        if self.iterations is not None and self.iterations < 0:
            raise OptionError(f"iterations must not be negative, not {self.iterations}")
        if not 0.0 < self.keep <= 1.0 or self.block_size < 1:
            raise OptionError(
                f"keep must be above 0 and at most 1, block_size positive; not {self.keep}, {self.block_size}"
            )
