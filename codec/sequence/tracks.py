"""The base of every GOP: the dictionaries of parts, and the known state of each field before its first frame."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from bsm._core import Track
from bsm._core import codec as _kernels
from bsm.bitstream.container.gop import GopBody
from bsm.codec.arrays import Faces, Matrix
from bsm.codec.signal.chain import Chain
from bsm.codec.static.coding import Scheme


@dataclass(frozen=True, eq=False)
class Setting:
    """The base that all GOPs of a mesh share, in C."""

    chain: Chain
    vertices: int
    widths: tuple[int, ...]
    """Numbers of a vertex: of positions, then of each attribute that moves."""
    memory: float
    """Bytes that decoders keep, besides the dictionaries that they have room for."""

    def track(self, number: int) -> Track:
        """Positions, or an attribute that moves, before the first frame."""
        return Track(self.chain, number)

    def reach(self, number: int) -> int:
        """How many decoded frames low-delay frames of a track may refer to."""
        return int(_kernels.LEAST_KEPT) if number else _kernels.frames_kept(self.vertices)

    def memory_for(self, body: GopBody) -> float:
        """Bytes for decoding a GOP: levels, components, a few frames, and one part after the other."""
        fields = np.array([(field.width, field.components) for field in body.fields], np.int64)
        return self.chain.gop_memory(body.method, body.frames, fields)


def make_setting(
    scheme: Scheme, faces: Faces, first_frame: Matrix, moving: Sequence[Matrix] = ()
) -> Setting:
    """Make the dictionaries from the decoded first frame, shape (n, 3), and the first values of what moves, (n, d)."""
    # The dictionaries of a sequence are made once and kept, for every GOP uses all of them.
    chain = Chain(scheme.rules, scheme.blocks)
    widths = [values.shape[1] for values in moving]
    starts = np.ascontiguousarray(np.hstack([np.empty((len(first_frame), 0)), *moving]))
    memory = chain.hang(
        faces, np.ascontiguousarray(first_frame), starts, np.array(widths, np.int32)
    )
    return Setting(chain, len(first_frame), (3, *widths), memory)
