"""A run: its first frame and its GOPs, in the way that costs least."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from bsm.bitstream.container.gop import GopBody, GopMethod
from bsm.bitstream.container.header import LAW_OF_SEQUENCES, Header
from bsm.bitstream.errors import OptionError
from bsm.bitstream.limits import NAMED_LIMITS, Limits
from bsm.codec.arrays import Matrix, Order, Positions
from bsm.codec.geometry.mesh import squares_of
from bsm.codec.progress import Nearing, Progress, silent
from bsm.codec.sequence.frames import Group, distinct_frames, same_frames
from bsm.codec.sequence.gop import GopEncoder, LearntGop
from bsm.codec.sequence.options import SequenceOptions
from bsm.codec.sequence.step_search import StepSearch
from bsm.codec.sequence.temporal import Motion, lengths_of
from bsm.codec.sequence.tracks import Setting, make_setting
from bsm.codec.signal.transform import LARGEST_LEVEL, smallest_step
from bsm.codec.static.coding import Adaptive, Scheme, rules_of
from bsm.codec.static.preamble_encoding import Prepared
from bsm.codec.static.units import single
from bsm.codec.static.ways.block_coder import (
    FRAME,
    CodedBlock,
    Sizing,
    blended,
    encode_blocks,
    mesh_memory,
)
from bsm.codec.threads import one_blas_thread

FIRST_STEP = 0.3
"""Of the first frame, in steps of the others, which follow from it; 0.4 costs 0.5 % more, with low delay 1 to 3 %."""

FIRST_FRAME = rules_of(LAW_OF_SEQUENCES)
"""The first frame is one chain; the dictionaries of its key block and those of all parts start from cosines alike."""

TOGETHER = 4
"""GOPs with a basis in a chain, where each refers to the one before. A viewer that joins late waits for its end."""

FINEST_STEP = 2e-5  # below, a search does not look

BYTE = 0.4  # squared errors of one step that a byte is worth, about as in the choice of levels

# Share of the remaining time that an attempt takes, before frames are drawn; measured.
ATTEMPT = 0.15

# Coding the first frame takes as long as several GOPs. Within these factors another one would save less than a percent.
NEAR = 0.75, 1.4  # a first frame is reused for steps within these factors of its own


@dataclass
class Kept:
    """What decoders have of a stream: vertices, the memory that their meshes take, and the bytes that have arrived."""

    vertices: int = 0
    memory: float = 0.0
    received: int = 0


@dataclass(eq=False)
class FirstFrame:
    """Everything before the GOPs but the connectivity: the first frame, coded as a static mesh is."""

    header: Header
    blocks: list[CodedBlock]
    setting: Setting
    memory: float
    costs: Kept
    limits: Limits

    def has_room(self, body: GopBody) -> bool:
        """Whether decoders have the memory for a GOP, with attributes that move about as positions do."""
        (positions,) = body.fields
        others = (
            replace(positions, width=width, components=-(-positions.components * width // 3))
            for width in self.setting.widths[1:]
        )
        needed = self.costs.memory + self.setting.memory_for(
            replace(body, fields=(positions, *others))
        )
        return needed <= self.limits.memory_for(
            self.costs.vertices, self.costs.received + body.size
        )


def encode_first_frame(
    prepared: Prepared,
    options: SequenceOptions,
    frames: int,
    progress: Progress,
    before: Kept,
    moving: Sequence[Matrix] = (),
) -> FirstFrame:
    """Code the first frame, which all others of a run build upon; `frames` as for `SequenceEncoder`."""
    # The levels of the first frame must fit into the law's integers.
    finest = smallest_step(prepared.size)
    # Every frame is predicted from the first, so its error shows in all of them; it gets a finer step.
    step = options.first_step or max(FIRST_STEP * options.step, finest)
    if step < finest:
        raise OptionError(
            f"first_step = {step:g} is too fine for blocks of {prepared.size}, try {finest:.1e}"
        )
    width = max(1, round(options.keep * prepared.size))
    scheme = Scheme(
        prepared.blocks, replace(FIRST_FRAME, whole=width), Adaptive(width, single(step))
    )
    blocks = encode_blocks(
        scheme,
        prepared.positions,
        threads=options.threads,
        sizing=Sizing(scheme.coding.width),
        progress=progress,
    )
    header = Header(
        block_size=prepared.size,
        coefficients=width,
        center=prepared.units.center,
        scale=prepared.units.scale,
        sequence=(frames, options.together(prepared.graph.size)),
        **prepared.fields,
        **scheme.fields(),
    )
    positions = blended(prepared.graph.size, (block.decoded for block in blocks))
    setting = make_setting(scheme, prepared.mesh.faces, positions, moving)
    memory = mesh_memory(header.vertices, header.faces) + setting.memory
    received = len(prepared.connectivity.data) + sum(
        len(block.packet.data) + FRAME for block in blocks
    )
    costs = Kept(
        before.vertices + header.vertices, before.memory + memory, before.received + received
    )
    return FirstFrame(header, blocks, setting, memory, costs, NAMED_LIMITS[options.limits]())


@dataclass(frozen=True, eq=False)
class EncodedGops:
    """GOPs of some frames, and the encoder after them; `learnt` are those with a basis."""

    first_frame: FirstFrame
    encoder: GopEncoder
    bodies: tuple[GopBody, ...]
    learnt: tuple[LearntGop, ...] = ()
    worst_look: float = 0.0  # of the frames that the search drew

    @property
    def size(self) -> int:
        return sum(len(block.packet.data) for block in self.first_frame.blocks) + sum(
            body.size for body in self.bodies
        )

    def decoded_frames(self) -> Iterator[Matrix]:
        """Yield each decoded frame, shape (n, 3), in BSM units; they are not kept, because they are large."""
        if self.encoder.latest is not None:
            yield from self.encoder.latest
        for body, gop in zip(self.bodies, self.learnt):
            yield from gop.frames(body.places)


class RunEncoder:
    """Encodes the GOPs of a run, each with the step that keeps the options' promise in it, if there is one."""

    def __init__(
        self, prepared: Prepared, options: SequenceOptions, count: int, progress: Progress
    ) -> None:
        self._prepared, self._options = prepared, options
        self._count, self._progress = count, progress

    def first(self, group: Group, before: Kept, moving: Sequence[Matrix]) -> EncodedGops:
        """The first frame, with values that move, shapes (n, d), as of `make_setting`, and the first GOP."""
        first_frame: FirstFrame | None = None
        coded_for = 0.0

        def begun(step: float, progress: Progress) -> EncodedGops:
            nonlocal first_frame, coded_for
            # Attempts at the step of the GOP share a first frame as long as it is good enough for them.
            if first_frame is None or not NEAR[0] <= step / coded_for <= NEAR[1]:
                coded_for = step
                fitting = replace(self._options, step=step)
                heard = silent if self._options.promise else progress
                first_frame = encode_first_frame(
                    self._prepared, fitting, self._count, heard, before, moving
                )
            return EncodedGops(first_frame, GopEncoder(first_frame.setting, self._options), ())

        return self._kept(begun, group, 0, None)

    def next(self, group: Group, number: int, before: EncodedGops) -> EncodedGops:
        """The GOP after another; its first frame has this number."""
        return self._kept(
            lambda *_: EncodedGops(before.first_frame, before.encoder.copy(), ()),
            group,
            number,
            before.encoder.step,
        )

    def again(self, group: Group, before: EncodedGops) -> EncodedGops:
        """The first GOP of a run whose mesh an earlier run has brought."""
        fresh = GopEncoder(
            before.first_frame.setting, replace(self._options, step=before.encoder.step)
        )
        return self.next(group, 0, EncodedGops(before.first_frame, fresh, ()))

    def _kept(
        self,
        begun: Callable[[float, Progress], EncodedGops],
        group: Group,
        number: int,
        step: float | None,
    ) -> EncodedGops:
        """Encode frames so that they keep the promise, near the `step` of the GOP before, if there is one."""
        options, promise, units = self._options, self._options.promise, self._prepared.units
        if promise is None:
            step = options.step if step is None else step
            every = np.ones(len(group))
            with one_blas_thread():
                return _encoded(
                    begun(step, self._progress), step, every, (), group, number, self._progress
                )
        lengths: tuple[int, ...] = ()
        nearing = Nearing(self._progress)

        def attempt(step: float, weights: Matrix) -> EncodedGops:
            nonlocal lengths
            heard = nearing.within(ATTEMPT)
            gops = _encoded(begun(step, heard), step, weights, lengths, group, number, heard)
            # Where to cut depends little on the step, and finding it takes time.
            # As the first attempt was cut, so are the others.
            lengths = tuple(body.frames for body in gops.bodies)
            return gops

        search = StepSearch(
            group.positions, self._prepared.mesh.faces, promise, units, options.threads, nearing
        )
        bound = 0.01 if promise.absolute else promise.farthest
        # About what the bound leads to, for most motions. From the second GOP on, the one before is the better guess.
        first = step or min(0.45 * bound, 4.5e-3 * min(promise.look, 1e3))
        finest = finest_step(group.positions, options)
        with one_blas_thread():
            best = search.run(attempt, first, finest, weighed=not options.low_delay)
        nearing.to(1.0)
        return replace(best, worst_look=search.worst_look)


def finest_step(frames: Sequence[Matrix] | Positions, options: SequenceOptions) -> float:
    """The finest step to try for frames, each of shape (n, 3): levels can be coded if all motion is one component."""
    scale = float(np.linalg.norm(np.ptp(frames[0], axis=0))) or 1.0
    middle, longest = frames[0].mean(axis=0), options.longest(len(frames[0]))
    most = 0.0
    for first in range(0, len(frames), longest):
        energies = np.zeros(len(frames[0]))
        for frame in frames[first : first + longest]:
            energies += np.square(frame - middle).sum(axis=1)
        # A component has one coefficient for each row of a block, whose squares sum to the energy of its vertices.
        most = max(most, float(np.sort(energies)[-2 * options.block_size :].sum()))
    return max(FINEST_STEP, 2.0 * float(np.sqrt(most)) / scale / LARGEST_LEVEL)


def _encoded(
    before: EncodedGops,
    step: float,
    weights: Matrix,
    lengths: Sequence[int],
    group: Group,
    number: int,
    progress: Progress,
) -> EncodedGops:
    """Encode frames, of which the first has this number, as GOPs of these lengths, or of those that cost least."""
    encoder, frames = before.encoder, group.positions
    encoder.step = single(step)
    if encoder.low_delay:
        key = encoder.is_key(number, frames.shape[1])
        method = GopMethod.KEY_FRAME if key else GopMethod.NEXT_FRAME
        field = encoder.encode_next(frames, progress, key=key)
        return replace(before, bodies=(GopBody(method, len(frames), (field,)),))
    same = same_frames(frames, list(group.moving.values()), encoder.step)
    motion = group.motion(encoder.step)

    def in_parts(lengths: Sequence[int], progress: Progress) -> EncodedGops:
        gops = before
        for begin, length in zip(np.cumsum([0, *lengths]), lengths):
            gops = _with_basis(gops, motion, slice(begin, begin + length), weights, same, progress)
        return gops

    def cost(gops: EncodedGops) -> float:
        wrong = sum(
            float(squares_of(frame - decoded).sum())
            for frame, decoded in zip(frames, gops.decoded_frames())
        )
        return wrong / encoder.step**2 + BYTE * sum(body.size for body in gops.bodies)

    if lengths:
        return in_parts(lengths, progress)
    unbroken, lengths = in_parts([len(frames)], progress), lengths_of(motion, encoder.step)
    # The lengths are an estimate, so both ways are coded once and weighed by what they really cost.
    return unbroken if len(lengths) == 1 else min(unbroken, in_parts(lengths, silent), key=cost)


def _with_basis(
    before: EncodedGops,
    motion: Motion,
    part: slice,
    weights: Matrix,
    same: Order,
    progress: Progress,
) -> EncodedGops:
    """Append some of the frames as a GOP with a basis, or as two where decoders lack the memory; repeated ones once."""
    distinct, places = distinct_frames(same[part])
    shapes = motion.shapes[..., part]
    encoder = before.encoder.copy()
    method = encoder.method_with_basis(TOGETHER)
    repeats, once = len(distinct) < len(places), np.sqrt(np.bincount(places, weights[part] ** 2))
    learnt = encoder.encode_learnt(motion.fields, shapes[..., distinct], once, method, progress)
    body = GopBody(method, len(places), (learnt.field,), places if repeats else None)
    # A decoder needs memory for the components of a GOP. Halves need half.
    if len(places) > 1 and not before.first_frame.has_room(body):
        middle = part.start + len(places) // 2
        for half in slice(part.start, middle), slice(middle, part.stop):
            before = _with_basis(before, motion, half, weights, same, silent)
        return before
    return EncodedGops(
        before.first_frame, encoder, (*before.bodies, body), (*before.learnt, learnt)
    )
