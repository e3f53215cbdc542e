"""Attributes that move: values of vertices that change from frame to frame, each as near as is asked."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from bsm.bitstream.container.gop import GopBody, GopField, GopMethod, still
from bsm.bitstream.errors import NumericError, OptionError, TargetError
from bsm.codec.arrays import Matrix
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.progress import silent
from bsm.codec.sequence.frames import distinct_frames
from bsm.codec.sequence.gop import GopEncoder
from bsm.codec.sequence.temporal import Decomposition
from bsm.codec.static.attributes.encoding import PreparedAttribute, Values
from bsm.codec.static.attributes.quality import Quality
from bsm.codec.static.targets import secant
from bsm.codec.static.units import single

# A finer step costs bytes in proportion to its logarithm, and another attempt costs time.
SLACK = 0.2  # part of a bound that may be left, in logarithms
LEAST = 1e-6  # of a bound, an error that counts as none; and of the first step, the finest one
# That of the first attempt, in bounds of every value and on average.
FIRST_STEP, FIRST_STEP_RMS = 0.7, 2.0
OUTLIER = 10.0  # how many times as far as all are on average a single value may be off
# A value at a half may be rounded up here and down there. Kept away from it, integers are equal everywhere.
MARGIN = 1e-6  # by which integers keep away from halves, which processors may round either way
# All other frames are differences from the first, whose error they keep.
FIRST_FRAME = 0.5  # bound of the first frame, as a fraction of the bound of the others
LARGEST = 1e100


def changed(first: Values, change: Matrix) -> Values:
    """Values, shape (n, d), that differ from the first frame's by so much; integers are the nearest of their kind."""
    with np.errstate(over="ignore", invalid="ignore"):
        # From the decoded first frame, as decoders do, and not from the original one.
        values = first.astype(np.float64) + change
        if not np.isfinite(values).all():
            raise NumericError("values of an attribute that moves are not finite")
        if first.dtype.kind == "f":
            values = values.astype(first.dtype)
            if not np.isfinite(values).all():
                raise NumericError(
                    "values of an attribute that moves are beyond the range of their kind"
                )
            return values
    kind = np.iinfo(first.dtype)
    # Clipped, since a difference may lead out of the range of bytes.
    return np.rint(values).clip(kind.min, kind.max).astype(first.dtype)


@dataclass(frozen=True, eq=False)
class Bound:
    """How far values may be off."""

    quality: Quality
    attribute: Attribute
    amount: float | None = None

    def over(self, values: Values) -> Bound:
        """The bound of values, shape (..., d), that are all that is known where frames differ first."""
        name = self.attribute.name
        rows = values.reshape(-1, values.shape[-1])
        low, high = rows.min(axis=0).astype(np.float64), rows.max(axis=0).astype(np.float64)
        # The largest range of any component: a color has one bound, and not three.
        extent = float((high - low).max())
        if not max(-low.min(), high.max()) < LARGEST:
            raise OptionError(f"{name!r} moves, and values beyond {LARGEST:g} cannot")
        is_integer = values.dtype.kind != "f"
        way, amount = self.quality.way, self.quality.amount
        # Differences of floats are coded in steps, which no step makes exact.
        if way in ("angle", "recompute") or (way == "exact" and not is_integer):
            raise OptionError(
                f"{name!r} moves, and cannot be kept {self.quality}: ask for a bound, 0.01, 1% or 1%rms, or for bits"
            )
        if way == "exact":
            bound = 0.0
        elif way == "bits":
            unit = (
                not is_integer
                and self.attribute.semantic == "color"
                and low.min() >= 0.0
                and high.max() <= 1.0
            )
            step = (1.0 if unit else extent) / (2 ** int(amount) - 1)
            bound = float(-(-step // 1) // 2) if is_integer else step / 2.0
        else:
            bound = amount if way == "bound" else amount / 100.0 * extent
        return replace(self, amount=float(int(bound)) if is_integer and way != "rms" else bound)

    @property
    def of_first(self) -> Quality:
        """The quality of the first frame, from which all others are coded as differences."""
        assert self.amount is not None
        amount = self.amount if self._is_rms else FIRST_FRAME * self.amount
        return Quality("bound", amount) if amount > 0.0 else Quality("exact")

    @property
    def reach(self) -> float:
        """The bound of what `off` tells."""
        assert self.amount is not None
        is_integer = self.attribute.values.dtype.kind != "f" and not self._is_rms
        # Before rounding, an integer may be off by almost a half more.
        return self.amount + 0.5 - MARGIN if is_integer else self.amount

    @property
    def first_step(self) -> float:
        return self.reach * (FIRST_STEP_RMS if self._is_rms else FIRST_STEP)

    def off(self, values: Values, first: Values, change: Matrix) -> float:
        """How far values, shape (k, c), are off: floats when they are rounded, integers before, but for their mean."""
        wide = values.astype(np.float64)
        if self._is_rms:
            apart = changed(first, change) - wide
            # A mean forgives one value that is completely wrong, and eyes do not.
            return max(
                math.sqrt(float(np.square(apart).mean())), float(np.abs(apart).max()) / OUTLIER
            )
        now = first.astype(np.float64) + change
        if values.dtype.kind == "f":
            now = now.astype(values.dtype).astype(np.float64)
        off = float(np.abs(wide - now).max(initial=0.0))
        return off if math.isfinite(off) else math.inf

    def between(self, decoded: Matrix, original: Matrix) -> float:
        """Return the error of decoded values, shape (k, c), as a share of the bound."""
        apart = np.abs(decoded - original)
        most = float(apart.max(initial=0.0))
        if self._is_rms:
            most = max(float(np.sqrt(np.square(apart).mean())), most / OUTLIER)
        # Decoded floats are rounded once more.
        # The check has only decoded values, which were rounded to their kind.
        rounding = float(np.finfo(np.float32).eps) * float(np.abs(original).max(initial=0.0))
        allowed = (self.amount or 0.0) * (1.0 + MARGIN) + rounding
        return float(most / allowed) if most > 0.0 else 0.0

    @property
    def _is_rms(self) -> bool:
        return self.quality.way == "rms"

    def __str__(self) -> str:
        if not self.amount:
            return "exact"
        return f"within {self.amount:.3g}{' on average' if self._is_rms else ''}"


@dataclass(frozen=True, eq=False)
class Expected:
    """Values of an attribute in one frame, shape (n, d) in the order of coding, and how far decoded ones may be off."""

    number: int
    values: Values
    bound: Bound


class MovingAttributeEncoder:
    """Encodes one attribute in the GOPs of a run."""

    def __init__(
        self, number: int, carried: PreparedAttribute, first_values: Values, bound: Bound
    ) -> None:
        self.number = number
        self.name, self.bound = carried.declaration.name, bound
        self.first: Values = carried.values
        self._carried = carried
        self._given = first_values
        self._encoder: GopEncoder | None = None
        self._step: float | None = None
        self._latest: Values = self.first

    @property
    def start(self) -> Matrix:
        """Differences of the first frame's values from those of vertex 0, which may be large, shape (k, c)."""
        wide = self.first.astype(np.float64)
        return np.asarray(wide - wide[:1])

    @property
    def note(self) -> str:
        """The outcome."""
        if self.bound.amount is None:
            return self._carried.note
        return f"{self.name}: per vertex, moves, {self.bound} in every frame"

    def expected(self, values: Values) -> Expected:
        """Return the values that a decoder must have for a frame of these values, shape (n, d)."""
        return Expected(
            self.number, self.first if self.bound.amount is None else values, self.bound
        )

    def begin(self, positions: GopEncoder, number: int) -> None:
        """Begin a run, in which this attribute has the track of this number; `positions` has its dictionaries."""
        self._encoder = positions.beside(number)

    def fields(self, bodies: Sequence[GopBody], values: Values) -> list[GopField]:
        """Fields of each GOP, which together have all these values, shape (T, n, d)."""
        # An attribute that stood still until now begins to move. Its bound follows from what is known of it here, as a
        # live stream cannot wait for its end.
        if self.bound.amount is None and (values != self._given).any():
            all_values = np.concatenate([self._given[None], values])
            self.bound = self.bound.over(all_values)
        ends = np.cumsum([body.frames for body in bodies])
        return [
            self._field(body, values[end - body.frames : end])
            for body, end in zip(bodies, ends, strict=True)
        ]

    def _field(self, body: GopBody, values: Values) -> GopField:
        assert self._encoder is not None
        before = self._latest if body.method is GopMethod.NEXT_FRAME else self.first
        nothing = np.zeros(before.shape)
        if (
            self.bound.amount is None
            or max(self.bound.off(row, before, nothing) for row in values) <= self.bound.amount
        ):
            self._encoder.stay(body.frames, body.method)
            self._latest = before
            return still(values.shape[2])
        reach, encoder = self.bound.reach, self._encoder
        best: tuple[GopEncoder, GopField, Values] | None = None

        # Each attempt codes on a copy of the state: the models learn from what they code.
        def excess(step: float) -> float:
            nonlocal best
            twin = encoder.copy()
            twin.step = single(step)
            field, changes = self._attempt(twin, body, values)
            off = max(
                self.bound.off(frame, self.first, change)
                for frame, change in zip(values, changes, strict=True)
            )
            # The widest step that holds is kept, whatever order they are tried in.
            if off <= reach and (best is None or twin.step > best[0].step):
                best = twin, field, changed(self.first, changes[-1])
            return math.log(max(off / reach, LEAST))

        first = self._step or self.bound.first_step
        secant(excess, first, LEAST * first, first / LEAST, slack=SLACK)
        if best is None:
            raise self._refusal("ask for less")
        self._encoder, field, self._latest = best
        self._step = self._encoder.step
        return field

    def _refusal(self, why: str) -> TargetError:
        return TargetError(f"{self.name!r} moves, and cannot be kept {self.bound}: {why}")

    def _attempt(
        self, encoder: GopEncoder, body: GopBody, values: Values
    ) -> tuple[GopField, list[Matrix]]:
        """A field, and its decoded form: the changes of each frame, shape (n, d)."""
        changes = values.astype(np.float64) - self.first
        try:
            if not body.method.has_basis:
                key = body.method is GopMethod.KEY_FRAME
                field = encoder.encode_next(changes, silent, key=key)
                assert encoder.latest is not None
                return field, list(encoder.latest)
            # Positions decide how frames are grouped and repeated. An attribute follows, so that one table tells both.
            distinct, places = distinct_frames(body.places)
            frames, weights = changes[distinct], np.sqrt(np.bincount(places))
            motion = Decomposition(frames).motion(encoder.step)
            learnt = encoder.encode_learnt(
                motion.fields, motion.shapes, weights, body.method, silent
            )
        except OptionError as error:
            raise self._refusal(f"{error}") from error
        return learnt.field, list(learnt.frames(body.places))


def with_fields(
    bodies: Sequence[GopBody],
    coders: Sequence[MovingAttributeEncoder],
    values: Mapping[str, Values],
) -> tuple[GopBody, ...]:
    """GOPs of positions, and now of attributes, too: `values` are of all frames, shape (T, k, c)."""
    each = [coder.fields(bodies, values[coder.name]) for coder in coders]
    return tuple(
        replace(body, fields=(*body.fields, *(fields[number] for fields in each)))
        for number, body in enumerate(bodies)
    )
