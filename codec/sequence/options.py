"""Options for encoding a sequence."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from bsm.bitstream.errors import OptionError, public
from bsm.bitstream.limits import NAMED_LIMITS
from bsm.codec.choices import check_options
from bsm.codec.static.attributes.quality import checked_qualities
from bsm.codec.static.presets import SEQUENCE_ROWS
from bsm.codec.static.targets import SEQUENCE_TARGETS, Contract, Target

CHOICES = {"limits": tuple(NAMED_LIMITS)}
# The longer a GOP, the less its basis costs for each frame. Memory sets the bound.
SIZES, SPANS = (5_000, 10_000), (512, 256)
"""Frames of a GOP by default, for small and for large meshes, and interpolated in between; that takes much the
same memory."""
RANGES: dict[str, tuple[float, float]] = {
    "step": (1e-7, 1.0),
    "first_step": (1e-7, 1.0),
    "gop": (1, 1 << 20),
    "low_delay": (0, 64),
    "block_size": (8, 8192),
    "overlap": (1.0, 8.0),
    "keep": (1e-6, 1.0),
    "frame_rate": (0.0, 1e6),
    "threads": (1, 256),
}


PROMISES = {row.name: Contract(row.farthest, look=row.frame_look) for row in SEQUENCE_ROWS}
"""The presets of sequences, with the bounds of those of meshes."""


@public
@dataclass(frozen=True, kw_only=True)
class SequenceOptions:
    """Options for encoding a sequence.

    Parameters
    ----------
    low_delay : int
        Send this many frames at a time, as soon as they arrive: 1 sends each frame separately, 8 take a fifth fewer
        bytes. 0: long groups of frames, each by a temporal transform.
    step : float
        Quantization step, relative to the bounding box's diagonal of the first frame.
    first_step : float, optional
        Step of the first frame, from which all others are predicted; None: 0.3 of `step`.
    gop : int, optional
        Largest number of frames of a GOP, or between key frames: it bounds the cost of a loss and the frames in memory.
        None: 256 between key frames; for a GOP 512 up to 5,000 vertices, 256 from 10,000 on, interpolated between.
    keep : float
        Columns of the dictionary as a fraction of the block size; below 1, fine detail is lost.
    block_size, overlap
        Approximate vertices of a part, and size of a block as a multiple of the largest part.
    frame_rate : float
        Frames per second, written to the metadata as `frame_rate`; 0: unknown.
    keep_order : bool
        Store the order of vertices and faces, the first corner of each face, and which vertices were merged.
    attributes : mapping of str to str, or pairs
        Quality of attributes that do not change, as for a mesh.
    limits : str
        Limits of the target decoder: "default", "service" or "wide". A stream that exceeds them is an error.
    threads : int, optional
        None: one per core. BLAS, by which numpy multiplies, has threads of its own (`OPENBLAS_NUM_THREADS`).
    runs : bool
        Let the faces change from frame to frame, as in volumetric capture; each change begins a run.
    target : Target, optional
        Search for one step for all frames that reaches this target. All frames must fit into memory.
    promise : Contract, optional
        Search for the step of each GOP, or with low delay of each frame, that keeps this promise in every frame:
        `farthest`, and `look`. It cannot be combined with a target.

    Raises
    ------
    OptionError
        If a value is outside its legal range.

    Examples
    --------
    >>> import bsm
    >>> options = bsm.SequenceOptions(low_delay=1, step=0.005, gop=32)
    >>> data = bsm.encode_sequence(*bsm.decode_sequence("dance.bsm"), options)
    """

    low_delay: int = 0
    step: float = 0.002
    first_step: float | None = None
    gop: int | None = None
    keep: float = 1.0
    block_size: int = 320
    overlap: float = 1.0
    frame_rate: float = 0.0
    keep_order: bool = False
    attributes: Mapping[str, str] | tuple[tuple[str, str], ...] = ()
    limits: str = "default"
    threads: int | None = None
    runs: bool = False
    target: Target | None = None
    promise: Contract | None = None

    def __post_init__(self) -> None:
        check_options(self, CHOICES, RANGES)
        if self.promise is not None and self.target is not None:
            raise OptionError("promise and target are mutually exclusive")
        if self.target is not None:
            self.target._require_kind(SEQUENCE_TARGETS, "a sequence")
        # Other bounds of a contract are for meshes at rest; one that is silently not kept would be a lie.
        if (bounds := self.promise) and bounds != Contract(
            bounds.farthest, absolute=bounds.absolute, look=bounds.look
        ):
            raise OptionError(f"a sequence promises vertex errors and looks only, not {bounds}")
        if self.gop is not None and self.low_delay > self.gop:
            raise OptionError(
                f"{self.low_delay} frames at a time are more than a GOP of {self.gop}"
            )
        object.__setattr__(self, "attributes", checked_qualities(self.attributes))

    def longest(self, vertices: int) -> int:
        """Return `gop` for a mesh with this many vertices."""
        if self.gop is not None:
            return self.gop
        return int(np.interp(vertices, SIZES, SPANS)) if not self.low_delay else SPANS[-1]

    def together(self, vertices: int) -> int:
        """Return the largest number of frames of such a mesh that are coded together."""
        return self.low_delay or self.longest(vertices)
