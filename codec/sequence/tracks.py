"""The base of every GOP: the dictionaries of parts, and the known state of each field before its first frame."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from bsm._core import Chain, Track, gop_memory
from bsm._core import codec as _kernels
from bsm.bitstream.container.gop import GopBody
from bsm.codec.arrays import Faces, Matrix
from bsm.codec.signal.chain import Chain as Blocks
from bsm.codec.static.coding import Scheme


@dataclass(frozen=True, eq=False)
class Setting:
    """The base that all GOPs of a mesh share, in C, and its costs to decoders."""

    whole: Chain
    vertices: int
    widths: tuple[int, ...]
    """Numbers of a vertex: of positions, then of each attribute that moves."""
    kept: float
    around: float
    largest: float
    making: float

    def track(self, number: int) -> Track:
        """Positions, or an attribute that moves, before the first frame."""
        return Track(self.whole, number)

    def reach(self, number: int) -> int:
        """How many decoded frames low-delay frames of a track may refer to."""
        if number:
            return int(_kernels.LEAST_KEPT)
        return int(min(max(_kernels.POSITIONS_KEPT // self.vertices, _kernels.LEAST_KEPT), _kernels.MOST_KEPT))

    @property
    def memory(self) -> float:
        """Bytes that decoders keep, besides the dictionaries that they have room for."""
        moving = sum(self.widths[1:])
        known = 8 * (_kernels.BENDING + moving) * self.around
        return self.kept + _kernels.TRACK_MEMORY * self.vertices * moving + known

    def memory_for(self, body: GopBody) -> float:
        """Bytes for decoding a GOP: levels, components, a few frames, and one part after the other."""
        fields = np.array([(field.width, field.components) for field in body.fields], np.int64)
        columns = int(fields[:, 1].sum()) if body.method.has_basis else int(fields[:, 0].sum()) * body.frames
        making = self.making + _kernels.SPARE_MEMORY
        return (
            gop_memory(body.method, body.frames, fields, self.vertices, self.around)
            + 48 * self.largest * columns
            + making
        )


def make_setting(scheme: Scheme, faces: Faces, first_frame: Matrix, moving: Sequence[Matrix] = ()) -> Setting:
    """Make the dictionaries from the decoded first frame, shape (n, 3), and the first values of what moves, (n, d)."""
    whole = Blocks(scheme.rules, scheme.blocks)
    widths = [values.shape[1] for values in moving]
    starts = np.hstack([np.empty((len(first_frame), 0)), *moving])
    facts = whole.hang(
        faces, np.ascontiguousarray(first_frame), np.ascontiguousarray(starts), np.array(widths, np.int32)
    )
    return Setting(whole, len(first_frame), (3, *widths), *facts)
