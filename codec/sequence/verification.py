"""Checks of a sequence by the decoder in C while it is written, and how far its frames are off."""

import math
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from bsm.bitstream.errors import BsmError, LimitError, VerificationError
from bsm.bitstream.limits import NAMED_LIMITS
from bsm.codec.arrays import Faces, Matrix, Positions
from bsm.codec.decoding import SequenceDecoder
from bsm.codec.events import ConnectivityEvent, EndEvent, FrameEvent, Signal
from bsm.codec.geometry.mesh import Metadata
from bsm.codec.look.foreseen import Foresight
from bsm.codec.sequence.attributes import Expected
from bsm.codec.sequence.options import SequenceOptions
from bsm.codec.sequence.step_search import metric_of
from bsm.codec.static.attributes.encoding import PreparedAttribute
from bsm.codec.static.verification import AsGiven, require, require_attributes, require_positions

Measured: TypeAlias = tuple[Positions, Positions, Faces]

ROUNDING = 1e-6
"""By how much a distance or a look may exceed its bound, relatively: it was measured in other units."""


@dataclass(frozen=True, eq=False)
class ExpectedFrame:
    """A frame in the order of coding: positions of the closed loop, the original in BSM units, and what moves."""

    positions: Positions
    original: Matrix
    moving: tuple[Expected, ...] = ()


def diagonal_of(positions: Positions) -> float:
    return float(np.linalg.norm(np.ptp(positions, axis=0))) or 1.0


class SequenceVerifier:
    """Decodes a sequence chunk by chunk, measures the promise, and collects originals and results in `shown`."""

    def __init__(
        self, options: SequenceOptions, metadata: Metadata, pairs: list[Measured] | None = None
    ) -> None:
        self._decoder = SequenceDecoder(NAMED_LIMITS[options.limits](), options.threads)
        self._promise, self._metadata, self._shown = options.promise, metadata, pairs
        self._meshes: deque[tuple[AsGiven, tuple[PreparedAttribute, ...]]] = deque()
        # Frames wait only until their GOP is decoded, so memory stays that of a GOP.
        self._frames: deque[ExpectedFrame] = deque()
        self._ended = False
        self._wrong = self._extent = 0.0  # sums of squares over all frames
        self._worst: tuple[float, Positions, Positions, Faces] | None = None
        # The largest error of a vertex so far, and over the diagonal.
        self.farthest = self.farthest_relative = 0.0
        # The largest errors so far of attributes that move.
        self.attribute_errors: dict[str, float] = {}
        self.faces: Faces = np.zeros((0, 3), np.int32)

    @property
    def kg(self) -> float:
        """The error of Karni and Gotsman so far, in percent, see `SequenceComparison`."""
        return (
            100.0 * math.sqrt(self._wrong / self._extent)
            if self._extent
            else math.inf
            if self._wrong
            else 0.0
        )

    @property
    def worst_look(self) -> float | None:
        """The look of the frame that is foreseen to look worst; None if nothing of it can be seen."""
        metric = metric_of(self._worst[1], self._worst[3]) if self._worst else None
        return metric.look(self._worst[2]).moving if self._worst and metric else None

    def expect_mesh(self, original: AsGiven, carried: Sequence[PreparedAttribute]) -> None:
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
            # The decoder in C decodes while the encoder writes, as a receiver would, chunk by chunk.
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
            # Frames that never came back would be found by nothing else.
            require(
                self._ended and not self._frames and not self._meshes,
                "the decoder did not return all frames",
            )
            require(self._decoder.metadata == dict(self._metadata), "the decoded metadata differ")
            if self._promise is not None and self._promise.look < math.inf:
                # The search has drawn the others. This frame is drawn again, from what the decoder returned.
                look, most = self.worst_look or 0.0, self._promise.look
                require(
                    look <= most * (1.0 + ROUNDING),
                    f"a frame has look {look:.4g}; the bound is {most:g}",
                )
        return chunk

    def _begin(self, faces: Faces, vertices: int) -> None:
        require(bool(self._meshes), "the decoder returned a mesh that was not encoded")
        self._original, self._carried = self._meshes.popleft()
        self._matched = self._original.matched(faces, vertices)
        self._foresight = Foresight(self._original.prepared.mesh.faces)
        self._diagonal = 0.0
        self._checked, self.faces, self._once = (
            False,
            faces,
            np.unique(self._matched, return_index=True)[1],
        )

    def _compare(self, frame: FrameEvent) -> None:
        require(bool(self._frames), "the decoder returned a frame that was not encoded")
        expected = self._frames.popleft()
        require_positions(frame.positions, expected.positions, self._matched, self._original.loose)
        self._measure(frame, expected)
        # Attributes that rest are the same in every frame.
        if not self._checked:
            moving = {each.number for each in expected.moving}
            still = [
                attribute
                for number, attribute in enumerate(frame.attributes)
                if number not in moving
            ]
            require_attributes(still, self._carried, self.faces, self._original)
            self._checked = True
        for each in expected.moving:
            decoded = np.asarray(frame.attributes[each.number].values, np.float64)
            name, apart = (
                frame.attributes[each.number].name,
                np.abs(decoded[self._once] - each.values),
            )
            self.attribute_errors[name] = max(
                self.attribute_errors.get(name, 0.0), float(apart.max(initial=0.0))
            )
            # Averages count no copies.
            off = each.bound.between(decoded[self._once], each.values.astype(np.float64))
            require(
                off <= 1.0,
                f"a decoded attribute that moves is {off:.3g} times as far off as it may be",
            )
            require(
                np.array_equal(decoded, decoded[self._once][self._matched]),
                "decoded copies of a vertex differ",
            )

    def _measure(self, frame: FrameEvent, expected: ExpectedFrame) -> None:
        """Add up errors, and require that no vertex is farther off than was promised."""
        units, faces = self._original.prepared.units, self._original.prepared.mesh.faces
        # Which are the decoder's, each once.
        original, decoded = units.back(expected.original), expected.positions
        apart = np.square(decoded - original).sum(axis=1)
        if self._shown is not None:
            self._shown.append((original, decoded, faces))
        self._wrong += float(apart.sum())
        self._extent += float(np.square(original - original.mean(axis=0)).sum())
        far, self._diagonal = math.sqrt(float(apart.max())), self._diagonal or diagonal_of(original)
        self.farthest = max(self.farthest, far)
        self.farthest_relative = max(self.farthest_relative, far / self._diagonal)
        if self._promise is not None:
            most = self._promise.reach(units.scale, 1.0)
            # Positions far from the origin are rounded when they go back to the unit of the mesh.
            rounding = ROUNDING * most + 8.0 * float(
                np.finfo(np.float64).eps * np.abs(original).max()
            )
            require(far <= most + rounding, f"a vertex of frame {frame.index} is off by {far:.4g}")
        foreseen = self._foresight.look(original, decoded)
        if self._worst is None or foreseen > self._worst[0]:
            self._worst = foreseen, original, decoded, faces
