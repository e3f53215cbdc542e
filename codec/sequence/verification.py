"""Checks that a sequence decodes to what its encoder expects, by the decoder in C, while it is written."""

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import BsmError, LimitError, VerificationError
from bsm.bitstream.limits import Limits
from bsm.codec.arrays import Faces, Order, Positions
from bsm.codec.decoding import SequenceDecoder
from bsm.codec.events import ConnectivityEvent, EndEvent, FrameEvent, Signal
from bsm.codec.geometry.mesh import Metadata
from bsm.codec.sequence.attributes import Expected
from bsm.codec.static.attributes.encoding import PreparedAttribute
from bsm.codec.static.verification import Original, require, require_attributes, require_positions


@dataclass(frozen=True, eq=False)
class ExpectedFrame:
    """Positions of the closed loop, in the order of coding and the unit of the mesh, and what moves with them."""

    positions: Positions
    moving: tuple[Expected, ...] = ()


class SequenceVerifier:
    """Decodes a sequence chunk by chunk and compares each frame; `shown` collects the decoded positions."""

    def __init__(
        self, limits: Limits, metadata: Metadata, threads: int | None, shown: list[Positions] | None = None
    ) -> None:
        self._decoder = SequenceDecoder(limits, threads)
        self._metadata, self._shown = metadata, shown
        self._meshes: deque[tuple[Original, tuple[PreparedAttribute, ...]]] = deque()
        self._frames: deque[ExpectedFrame] = deque()
        self._ended = False
        self.faces: Faces = np.zeros((0, 3), np.int32)

    def expect_mesh(self, original: Original, carried: Sequence[PreparedAttribute]) -> None:
        """Announce a run, with the attributes that do not move."""
        self._meshes.append((original, tuple(carried)))

    def expect_frame(self, frame: ExpectedFrame) -> None:
        self._frames.append(frame)

    def take(self, chunk: bytes, *, last: bool = False) -> bytes:
        """Decode a chunk of the stream and return it; `VerificationError` if a decoder makes something else of it."""
        try:
            self._decoder.receive_data(chunk)
            if last:
                self._decoder.receive_eof()
            while not isinstance(event := self._decoder.next_event(), Signal):
                match event:
                    case ConnectivityEvent(faces, vertices):
                        self._begin(faces, vertices)
                    case FrameEvent():
                        self._compare(event)
                    case EndEvent():
                        self._ended = True
        except (LimitError, VerificationError):
            raise
        except BsmError as error:
            raise VerificationError(f"the decoder refuses the encoded stream: {error}") from error
        if last:
            require(self._ended and not self._frames and not self._meshes, "the decoder did not return all frames")
            require(self._decoder.metadata == dict(self._metadata), "the decoded metadata differ")
        return chunk

    def _begin(self, faces: Faces, vertices: int) -> None:
        require(bool(self._meshes), "the decoder returned a mesh that was not encoded")
        self._original, self._carried = self._meshes.popleft()
        self._matched = self._original.matched(faces, vertices)
        self._checked, self.faces = False, faces

    def _compare(self, frame: FrameEvent) -> None:
        require(bool(self._frames), "the decoder returned a frame that was not encoded")
        expected = self._frames.popleft()
        require_positions(frame.positions, expected.positions, self._matched, self._original.loose)
        if not self._checked:
            moving = {each.number for each in expected.moving}
            still = [attribute for number, attribute in enumerate(frame.attributes) if number not in moving]
            require_attributes(still, self._carried, self.faces, self._original)
            self._checked = True
        for each in expected.moving:
            _require_near(frame.attributes[each.number].values, each, self._matched)
        if self._shown is not None:
            self._shown.append(frame.positions)


def _require_near(decoded: npt.NDArray[np.generic], moving: Expected, matched: Order) -> None:
    """Require that values in a frame, shape (k, c), are as near as was asked."""
    off = moving.bound.between(np.asarray(decoded, np.float64), moving.values[matched].astype(np.float64))
    require(off <= 1.0, f"a decoded attribute that moves is {off:.3g} times as far off as it may be")
