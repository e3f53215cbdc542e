"""The encoder of meshes: join, prepare, and draft a stream by the options."""

import math
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from bsm.bitstream.container import packets
from bsm.bitstream.container.header import EXACT, Header
from bsm.bitstream.errors import OptionError, TargetError, public
from bsm.bitstream.limits import NAMED_LIMITS
from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Order, end_phase
from bsm.codec.blocks import overlap
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.metrics import Comparison, Reference, decibel
from bsm.codec.progress import Nearing, Progress
from bsm.codec.signal.transform import smallest_step
from bsm.codec.static.attributes.encoding import with_turns
from bsm.codec.static.choice.attributes import Sent, complete, smallest
from bsm.codec.static.choice.bounds import LEAST
from bsm.codec.static.choice.grids import exact, rounded, rounded_to_cells
from bsm.codec.static.choice.trace import Event
from bsm.codec.static.options import PROMISES, RANGES, EncodeOptions
from bsm.codec.static.preamble_encoding import Draft
from bsm.codec.static.targets import WIDEST, Contract, Target, search_step
from bsm.codec.static.verification import AsGiven, require, verify
from bsm.codec.static.ways.block_coder import as_of_decoders
from bsm.codec.static.ways.in_blocks import InBlocks


@dataclass(frozen=True, eq=False)
class Attempt:
    """A whole stream, and what its decoder will make of it."""

    draft: Draft
    compare: Callable[[], Comparison]

    @cached_property
    def comparison(self) -> Comparison:
        return self.compare()

    @property
    def frames(self) -> tuple[bytes, ...]:
        return self.draft.frames

    @property
    def header(self) -> Header:
        return self.draft.header

    @property
    def size(self) -> int:
        return sum(map(len, self.frames))

    @property
    def bpv(self) -> float:
        return 8.0 * self.size / self.header.vertices


SIZES, PROMISED_SIZES = RANGES["grid_cell"], (1e-42, 1e30)
"""Of meshes, in their own unit: what numbers of the format hold; and where bounds are numbers of single precision."""

LOOKS = [
    Contract(WIDEST, look=look) for look in sorted(promise.look for promise in PROMISES.values())
]
"""The coarseness of attributes if a size is promised: that of the first look with which the shape fits."""
PREPARING = 0.05  # share of the progress before the search begins; measured
OVER = "eps_h is exceeded in {} of {} blocks: these have as many coefficients as they may have"
OWN_RULE = "METIS (pymetis) is not installed: BSM's own rule cuts the mesh into parts"
KEPT_EXACTLY = "positions are exact: no coarser ones keep the promise"
ONE_BLOCK = "the mesh fits in one block: its basis is exact, and no orthogonal iterations follow"


@public
class Encoder:
    """Encodes one mesh. The work begins with the first call or attribute that needs it.

    Parameters
    ----------
    mesh : TriangleMesh
        The encoder merges vertices at one position and leaves out those that no face uses, with notes. If the options
        keep the order, the stream returns them.
    options : EncodeOptions

    Attributes
    ----------
    look : float or None
        The look distance of the decoded mesh, once it has been checked; None if the options promise no look.
    decoded : TriangleMesh or None
        The decoded mesh, once it has been checked.
    binding : str
        The bound that keeps the stream from being smaller, once it has been checked: "look", "vertex error", "normal
        error" or "visual error"; "step" if wider steps that were tried break a bound. Empty without a promise.

    Examples
    --------
    >>> import bsm
    >>> encoder = bsm.Encoder(bsm.load("bunny.ply"), bsm.EncodeOptions(step=0.002))
    >>> data = encoder.encode()
    >>> mesh = bsm.decode(data)
    >>> errors = bsm.compare("bunny.ply", mesh, order=encoder.vertex_order)
    """

    def __init__(self, mesh: TriangleMesh, options: EncodeOptions | None = None) -> None:
        self.options = options or EncodeOptions()
        if not (
            self.options.target
            or self.options.promise
            or self.options.is_grid
            or self.options.sets_coding
        ):
            raise OptionError("preset none needs a target or a bound, such as size or max_error")
        packets.Metadata(mesh.metadata).require_readable()
        sizes = SIZES
        if self.options.promise is not None:
            sizes = PROMISED_SIZES
        mesh.require_sizes(*sizes)
        self._input = Sent(mesh, self.options)
        self.look: float | None = None
        self.decoded: TriangleMesh | None = None
        self.binding = ""
        self.unseen = ""
        self._kept_exactly = False
        self._attribute_notes: tuple[str, ...] = ()
        self._doubt = ""
        if self.options.promise is not None:
            self._doubt = _doubt(self.options.promise, mesh)

    @property
    def trials(self) -> tuple[Event, ...]:
        """The estimates and trials of the search for the stream, in order, with reasons."""
        return tuple(self._input.trace)

    @property
    def notes(self) -> tuple[str, ...]:
        """Changes of the input, and the coding of attributes."""
        notes = [*self._input.joined.notes]
        notes += self._attribute_notes or [attribute.note for attribute in self._input.carried]
        names = {attribute.name for attribute, _ in self._input.qualities}
        missing = [
            attribute.name
            for attribute in self._input.source.attributes
            if attribute.name not in names
        ]
        if missing:
            notes.append(f"left out: {', '.join(missing)}")
        if self.options.paper.bits is not None and self._input.prepared.blocks.count == 1:
            notes.append(ONE_BLOCK)
        if self._kept_exactly:
            notes.append(KEPT_EXACTLY)
        return (*notes, *self.losses[len(self._input.joined.losses) :])

    @property
    def losses(self) -> tuple[str, ...]:
        """The notes about losses that the options do not ask for."""
        losses = [*self._input.joined.losses]
        if self._doubt:
            losses.append(f"the preset's bound holds, and no other: {self._doubt}")
        if self.unseen:
            losses.append(f"no look is promised: {self.unseen}")
        if self.options.paper.doi and not self.options.target:
            missed = self._spectral.missed
            if missed:
                losses.append(OVER.format(missed, self._input.prepared.blocks.count))
        if self.options.paper.partition == "metis" and not overlap.HAS_METIS:
            losses.append(OWN_RULE)
        return tuple(losses)

    @property
    def mesh(self) -> TriangleMesh:
        """The mesh in the order of coding, with vertices at one position merged and without vertices in no face."""
        return self._input.prepared.mesh

    @property
    def vertex_order(self) -> Order:
        """The decoder's vertex j is vertex `vertex_order[j]` of the given mesh, or merged with it; shape (k,)."""
        return AsGiven(self._input.source, self._input.joined, self._input.prepared).vertex_order

    @property
    def vertex_index(self) -> Order:
        """The given mesh's vertex i is the decoder's vertex `vertex_index[i]`; -1: it is in no face and not stored.

        int64, shape (n,), with n the vertices of the given mesh.
        """
        if self._input.joined.splits is not None:
            return np.arange(len(self._input.source.positions))
        joined = self._input.joined
        count = len(joined.first)
        place = np.empty(count + 1, np.int64)
        place[self._input.prepared.vertex_order] = np.arange(count)
        place[-1] = -1
        return place[joined.index]

    @property
    def face_order(self) -> Order:
        """The decoder's face i is face `face_order[i]` of the given mesh; int64, shape (m,)."""
        return self._input.joined.coded_faces[self._input.prepared.face_order].astype(np.int64)

    def encode(self) -> bytes:
        return b"".join(self.chunks())

    def chunks(self, progress: Progress | None = None) -> Iterator[bytes]:
        """The stream, frame by frame.

        Parameters
        ----------
        progress : callable, optional
            Called with an estimate of the finished work, and the total. If it raises an exception, the work ends.

        Raises
        ------
        TargetError
            If the contract cannot be kept.
        """
        options = self.options
        if options.target is not None:
            yield from self.search(progress).frames
        else:
            yield from self.draft(progress).frames

    def draft(self, progress: Progress | None = None) -> Draft:
        """Return the stream of the options, without a target."""
        _ = self._input.carried  # raises errors of attributes first
        promise = self.options.promise
        nearing = self._begun(progress)
        if promise is None:
            self._input, draft = complete(self._input, self._bare(nearing))
            return self._verified(draft, nearing)
        self._input, draft = smallest(self._input, promise, nearing)
        return self._verified(draft, nearing, promise)

    def _begun(self, progress: Progress | None) -> Nearing:
        """Prepare, and return what reports the rest."""
        nearing = Nearing(progress)
        end_phase(self._input.prepared.graph.size)
        nearing.by(PREPARING)
        return nearing

    def _bare(self, nearing: Nearing) -> Draft:
        options = self.options
        if options.exact:
            return exact(self._input.prepared)
        if options.grid is not None:
            return rounded(self._input.prepared, options.grid)
        if options.grid_cell is not None:
            origin = options.grid_origin or (0.0, 0.0, 0.0)
            return rounded_to_cells(self._input.prepared, options.grid_cell, origin)
        with as_of_decoders(options.limits):
            return self._spectral.base(self._spectral.first_step, nearing.within(0.8)).draft

    def result(self, progress: Progress | None = None) -> Attempt:
        """Return the stream, with a comparison of the decoded mesh."""
        if self.options.target is not None:
            return self.search(progress)
        return self._judged(self.draft(progress))

    def search(self, progress: Progress | None = None) -> Attempt:
        """Search for the smallest stream that reaches the options' target, or the best one of a size.

        Raises
        ------
        TargetError
            If there is none; the message names the best possible value.
        """
        target = self.options.target
        if target is None:
            raise OptionError("no target to search for")
        _ = self._input.carried  # raises errors of attributes first
        nearing = self._begun(progress)
        contract = self.options.promise
        if self.options.sets_coding:
            attempt = self._at_step(target, nearing)
        elif target.shrinks_with_step:
            attempt = self._within_size(target, nearing)
        else:
            contract = self._within_error(target)
            self._input, draft = smallest(self._input, contract, nearing)
            attempt = self._judged(draft)
        self._verified(attempt.draft, nearing, contract)
        require(
            target.excess(attempt) <= LEAST,
            f"the target is {target.value:g}, not {target.reached(attempt):g}",
        )
        return attempt

    def _within_error(self, target: Target) -> Contract:
        """Return a bound on the error that is the target, and the promised bounds."""
        promise = self.options.promise or Contract(WIDEST)
        if target.kind == "theta_deg":
            return replace(promise, angle=target.value, alike=True)
        return replace(promise, visual=max(10.0 ** (target.value / 10.0), sys.float_info.min))

    def _within_size(self, target: Target, nearing: Nearing) -> Attempt:
        """The best stream of a size, which keeps whatever is promised."""
        most = target.value
        if target.kind != "size":
            most *= self._input.prepared.graph.size / 8.0  # bits per vertex
        sender = self._input = self._input.measuring(nearing)
        if not sender.carried:
            draft = self._best_of_size(most)
            if draft is not None:
                return self._judged(draft)
        smaller, met = self._finest_attributes(sender, most, nearing)
        if met is not None:
            fitting = [draft for draft in (self._best_of_size(most), smaller) if draft is not None]

            def look_of(draft: Draft) -> float:
                _, look, _ = self._input.measured(draft, met)
                return look or 0.0

            return self._judged(min(fitting, key=look_of))
        if self.options.promise is None:
            draft = self._best_of_size(most)
            if draft is not None:
                return self._judged(draft)
            smaller = self._input.completed(self._input.search.smallest(Contract(WIDEST)))
            if smaller.size <= most:  # luck decides about bytes: no other step fits
                return self._judged(smaller)
        assert smaller is not None  # a promise has a smallest stream, or an error
        raise self._refusal_of_size(target, sender, smaller, most, nearing)

    def _best_of_size(self, most: float) -> Draft | None:
        """The best stream of a size that keeps the promise, with its attributes; None if there is none."""
        promise = self.options.promise
        bare = self._input.search.best(promise, most)
        if bare is None:
            return None
        draft = self._input.completed(bare)
        if promise and self._input.measured(draft, promise)[0]:
            return None
        return draft

    def _finest_attributes(
        self, sender: Sent, most: float, nearing: Nearing
    ) -> tuple[Draft | None, Contract | None]:
        """Take attributes as fine as leave room for the shape; return the smallest stream, and the contract if that
        fits."""
        promise = self.options.promise
        met = None
        loosest = Contract(WIDEST)
        contracts = list[Contract]()
        if promise is not None:
            loosest, contracts = promise, [promise]
        if sender.carried:
            contracts += [
                replace(loosest, look=finer.look)
                for finer in reversed(LOOKS)
                if finer.look < loosest.look
            ]
        smaller: Draft | None = None
        for contract in contracts:
            try:
                sender_of_draft, draft = smallest(sender, contract, nearing)
            except TargetError:
                if met is None:
                    raise
                continue
            if met is None or draft.size <= most:
                self._input, smaller = sender_of_draft, draft
            if draft.size > most:
                break
            met = contract
        return smaller, met

    def _refusal_of_size(
        self, target: Target, sender: Sent, smaller: Draft, most: float, nearing: Nearing
    ) -> TargetError:
        """The error of a size that is too small, with the least one, and what may help."""
        promise = self.options.promise
        least = self._judged(smaller)
        text = f"{target.worded(target.value)} at most cannot be reached"
        had = target.worded(target.reached(least))
        if promise is None:
            error = TargetError(f"{text}; the least possible is {had}")
        else:
            if sender.carried:
                sender, smaller = smallest(sender, LOOKS[-1], nearing)
            draft: Draft | None = smaller
            if smaller.size > most:
                draft = sender.search.best(None, most)
            advice = "does not reach it either"
            if draft is not None:
                advice = f"reaches it with {sender.search.seen(draft)}"
            error = TargetError(f"{text} with {promise}: that takes {had}; preset none {advice}")
        error.best = target.reached(least)
        return error

    def _at_step(self, target: Target, nearing: Nearing) -> Attempt:
        """Blocks, coded as the options say, at the step that meets a target."""
        first = self._spectral.first_step
        finest = smallest_step(self._input.prepared.size)
        return search_step(lambda step: self.attempt(step, nearing.within()), target, first, finest)

    def attempt(self, step: float, progress: Progress | None = None) -> Attempt:
        """Encode blocks with a given quantization step, and compare the decoded mesh."""
        with as_of_decoders(self.options.limits):
            base = self._spectral.base(step, progress)
            return self._judged(self._input.completed(base.draft))

    def seen(self, attempt: Attempt) -> str:
        """Return the look of an attempt, in words."""
        return self._input.search.seen(attempt.draft)

    def _judged(self, draft: Draft) -> Attempt:
        return Attempt(draft, partial(self._compared, draft))

    def _compared(self, draft: Draft) -> Comparison:
        reference, unit = self._reference
        comparison = reference.compare(draft.decoded / unit)
        return replace(
            comparison,
            rms=comparison.rms * unit,
            max_error=comparison.max_error * unit,
            nmsve_paper_db=decibel(comparison.nmsve * reference.scale * unit),
        )

    def _verified(self, draft: Draft, nearing: Nearing, contract: Contract | None = None) -> Draft:
        """Return the draft, after the decoder has returned the same mesh and it keeps the contract."""
        nearing.by()
        broken = ""
        if contract is not None:
            broken, self.look, self.binding = self._input.measured(draft, contract)
            if contract.look < math.inf:
                self.unseen = self._input.measures.unseen
                self._input = self._input.rested()  # pictures would lie beside the decoder
        original = AsGiven(self._input.source, self._input.joined, self._input.prepared)
        end_phase(draft.header.vertices)
        with as_of_decoders(self.options.limits):
            limits = NAMED_LIMITS[self.options.limits]()
            threads = self.options.threads
            carried = with_turns(self._input.carried, draft.places)
            self._attribute_notes = tuple(attribute.note for attribute in carried)
            self.decoded = verify(
                draft, original, carried, self._input.source.metadata, limits, threads
            )
        require(not broken, f"{contract} was promised, and the decoded mesh has {broken}")
        self._kept_exactly = contract is not None and draft.header.light == EXACT
        nearing.to(1.0)
        return draft

    @cached_property
    def _spectral(self) -> InBlocks:
        return InBlocks(self._input.prepared, self.options)

    @cached_property
    def _reference(self) -> tuple[Reference, float]:
        """The mesh over a power of two, by which no face gets or loses an area; and the power."""
        prepared = self._input.prepared
        place = self._input.joined.first[prepared.coding_order]
        _, exponent = math.frexp(prepared.units.scale)
        unit = math.ldexp(0.5, exponent)
        positions = self._input.source.positions[place]
        return Reference(positions / unit, self.mesh.faces), unit


def _doubt(promise: Contract, mesh: TriangleMesh) -> str:
    """A question about the unit of a mesh; empty without a doubt."""
    used, *_ = mesh.without_isolated_vertices()
    unit = mesh.metadata.get("unit")
    if not isinstance(unit, str):
        unit = ""
    return promise.doubt(used.diagonal, unit)


def encode(mesh: TriangleMesh, options: EncodeOptions | None = None) -> bytes:
    return Encoder(mesh, options).encode()
