"""A mesh to a stream: join, prepare, and draft what the options ask for."""

import math
import sys
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial
from operator import itemgetter

import numpy as np

from bsm.bitstream.container.header import Header
from bsm.bitstream.errors import OptionError, TargetError, public
from bsm.bitstream.limits import NAMED_LIMITS
from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Order, Positions
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.metrics import Comparison, Reference
from bsm.codec.geometry.welding import row_numbers
from bsm.codec.look.measure import Worn, is_worn, own_normals
from bsm.codec.look.pictures import FEW, Normals
from bsm.codec.signal.transform import smallest_step
from bsm.codec.static.attributes.encoding import PreparedAttribute, carry, place_of, with_attributes
from bsm.codec.static.attributes.quality import LEAST_NORMAL_BITS, MOST_BITS, Quality, qualities
from bsm.codec.static.choice.blocks import Spectral
from bsm.codec.static.choice.bounds import Measures
from bsm.codec.static.choice.grids import exact, rounded, rounded_to_cells
from bsm.codec.static.choice.search import Search
from bsm.codec.static.options import LARGE_BLOCKS, EncodeOptions
from bsm.codec.static.preamble_encoding import Draft, JoinedMesh, Parts, Prepared, join, prepare
from bsm.codec.static.targets import SLACK, TRIES, WIDEST, Contract, Target, search_step
from bsm.codec.static.verification import Original, verify
from bsm.codec.static.ways.block_coder import Progress, as_of_decoders


@dataclass(frozen=True, eq=False)
class Attempt:
    """A whole stream, and what its decoder will make of it."""

    draft: Draft
    comparison: Comparison

    @property
    def frames(self) -> tuple[bytes, ...]:
        return self.draft.frames

    @property
    def header(self) -> Header:
        return self.draft.header

    @property
    def coefficients(self) -> tuple[int, ...]:
        return self.draft.coefficients

    @property
    def size(self) -> int:
        return sum(map(len, self.frames))

    @property
    def bpv(self) -> float:
        return 8.0 * self.size / self.header.vertices


OF_PAINT = {"texcoord": 0.33, "color": 0.2}  # of the look that is promised, what rounding these may take
SIZES, PROMISED_SIZES = (1e-290, 1e290), (1e-42, 1e30)
"""Of meshes, in their own unit: what numbers of the format hold; and where bounds are numbers of single precision."""


@public
class Encoder:
    """Encodes one mesh; the work begins with the first thing asked for.

    Parameters
    ----------
    mesh : TriangleMesh
        The encoder merges vertices at one position and leaves out those that no face uses, with notes. If the options
        keep the order, the stream returns them.
    options : EncodeOptions

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
        if not (self.options.target or self.options.promise or self.options.is_grid or self.options.says_how):
            raise OptionError("nothing is asked for: give a bound or a target, or another preset than none")
        mesh.require_sizes(*(SIZES if self.options.promise is None else PROMISED_SIZES))
        self._given, self._coded = mesh, self.options  # how it is coded, which the best effort chooses
        promise, unit = self.options.promise, mesh.metadata.get("unit")
        self._doubt = "" if promise is None else promise.doubt(mesh.diagonal, unit if isinstance(unit, str) else "")

    @property
    def notes(self) -> tuple[str, ...]:
        """What was changed on the way in, and what becomes of attributes."""
        sent = {one.name for one, _ in self._wanted}
        left = [one.name for one in self._given.attributes if one.name not in sent]
        said = (*(one.note for one in self._carried), *([f"left out: {', '.join(left)}"] if left else []))
        doubt = [f"the preset's bound holds, and no other: {self._doubt}"] if self._doubt else []
        return (*self._joined.notes, *said, *doubt)

    @property
    def mesh(self) -> TriangleMesh:
        """The mesh in the order of coding: vertices at one position are one, those that no face uses are left out."""
        return self._prepared.mesh

    @property
    def vertex_order(self) -> Order:
        """The decoder's vertex j is vertex `vertex_order[j]` of the given mesh, or at its place; int64, shape (k,)."""
        return Original(self._given, self._joined, self._prepared).vertex_order

    @property
    def vertex_index(self) -> Order:
        """The given mesh's vertex i is the decoder's vertex `vertex_index[i]`; -1: it is in no face, and not there.

        int64, shape (n,), with n the vertices of the given mesh.
        """
        if self._joined.splits is not None:
            return np.arange(len(self._given.positions))
        place = np.empty(len(self._joined.first) + 1, np.int64)
        place[self._prepared.vertex_order] = np.arange(len(self._joined.first))
        place[-1] = -1
        return place[self._joined.index]

    @property
    def face_order(self) -> Order:
        """The decoder's face i is face `face_order[i]` of the given mesh; int64, shape (m,)."""
        return self._joined.kept[self._prepared.face_order]

    def encode(self) -> bytes:
        return b"".join(self.chunks())

    def chunks(self, progress: Progress | None = None) -> Iterator[bytes]:
        """The stream, frame by frame.

        Parameters
        ----------
        progress : callable, optional
            Called with how much is done, and of how much in all; again from the beginning where blocks are coded again.

        Raises
        ------
        TargetError
            If a contract cannot be kept.
        """
        options = self.options
        if options.target is not None:
            yield from self.search(progress).frames
        else:
            yield from self.draft(progress).frames

    def draft(self, progress: Progress | None = None) -> Draft:
        """What the options ask for, without a target."""
        self._take_attributes()
        promise = self.options.promise
        kept = self._dressed(self._bare(progress)) if promise is None else self._smallest(promise, progress)
        return self._verified(kept)

    def _bare(self, progress: Progress | None) -> Draft:
        options = self.options
        if options.exact:
            return exact(self._prepared)
        if options.grid is not None:
            return rounded(self._prepared, options.grid)
        if options.grid_cell is not None:
            return rounded_to_cells(self._prepared, options.grid_cell, options.grid_origin or (0.0, 0.0, 0.0))
        with as_of_decoders(options.limits):
            return self._spectral.base(options.first_step, progress).draft

    def result(self, progress: Progress | None = None) -> Attempt:
        """What `encode` gives, with a comparison of what it decodes to."""
        return self.search(progress) if self.options.target is not None else self._judged(self.draft(progress))

    def search(self, progress: Progress | None = None) -> Attempt:
        """Look for the smallest stream that meets the options' target, or for the best one of a size.

        Raises
        ------
        TargetError
            If none does; says what can be had.
        """
        target = self.options.target
        if target is None:
            raise OptionError("there is no target to search for")
        self._take_attributes()
        if self.options.says_how:
            found = self._as_said(target, progress)
        else:
            found = self._sized(target, progress) if target.shrinks_with_step else self._bounded(target, progress)
        self._verified(found.draft)
        return found

    def _bounded(self, target: Target, progress: Progress | None) -> Attempt:
        """The smallest stream within a bound on its error, and whatever else is promised."""
        promise = self.options.promise or Contract(WIDEST)
        if target.kind == "theta_deg":
            contract = replace(promise, angle=target.value, alike=True)
        else:
            contract = replace(promise, visual=max(10.0 ** (target.value / 10.0), sys.float_info.min))
        return self._judged(self._smallest(contract, progress))

    def _smallest(self, contract: Contract, progress: Progress | None) -> Draft:
        """The smallest stream that keeps a contract, in colours and under a checker where it has them, too."""
        if self.options.effort == "best":
            self._choose_blocks(contract)
        search = self._search(contract, progress)
        worn = self._worn(contract.look) if search.metric is not None and contract.look < math.inf else []
        asked = contract
        for _ in range(TRIES):
            if worn:
                self._carried = carry(place_of(self._given, self._joined, self._prepared), self._wanted)
            kept = self._shaded(search, asked, progress)
            positions = self._prepared.units.into(kept.decoded)
            seen = max((one.distance(positions, self._carried[at].at_corners) for at, one in worn), default=0.0)
            if seen <= contract.look:
                break
            asked = replace(asked, look=asked.look * contract.look / seen * (1.0 - SLACK))
        return kept

    def _choose_blocks(self, contract: Contract) -> None:
        """Go on with the size of blocks with which the shape alone takes fewest bytes."""
        found: list[tuple[int, EncodeOptions, Prepared]] = []
        for coded in (self.options, replace(self.options, **LARGE_BLOCKS)):
            self._coded = coded
            self.__dict__.pop("_prepared", None)
            draft = self._search(contract, None).smallest(contract)
            found.append((draft.size, self._coded, self._prepared))
            if draft.places is not None:
                break  # a grid has no blocks
        _, self._coded, self._prepared = min(found, key=itemgetter(0))
        self._carried = carry(place_of(self._given, self._joined, self._prepared), self._wanted)

    def _worn(self, look: float) -> list[tuple[int, Worn]]:
        """Quantize colors and texture coordinates as coarsely as the look allows, unless a quality was requested."""
        found = []
        for at, (one, quality) in enumerate(self._wanted):
            told = {"*", one.name} & {*dict(self.options.attributes)} or quality.way not in ("bits", "exact")
            if told or not is_worn(one):
                continue
            steps = [Quality("bits", bits) for bits in range(1, MOST_BITS + 1)]
            if one.semantic == "color":
                rough = range(0 if kept_whole(one) else 15)
                steps = [*(Quality("share", 25.0 * 0.5 ** (k / 2)) for k in rough), Quality("exact")]
            mesh, made = TriangleMesh(self._prepared.positions, self.mesh.faces), partial(self._carry_with, at)
            worn = Worn(mesh, one.semantic, made(steps[-1])[at].at_corners, threads=self.options.threads)
            most = OF_PAINT[one.semantic] * look

            low, high = 0, len(steps) - 1
            while low < high:
                middle = (low + high) // 2
                near = worn.distance(mesh.positions, made(steps[middle])[at].at_corners, FEW) <= most
                low, high = (low, middle) if near else (middle + 1, high)
            if one.semantic == "texcoord" or made(steps[low])[at].size < self._carried[at].size:
                self._wanted[at] = one, steps[low]
            found.append((at, worn))
        return found

    def _shaded(self, search: Search, contract: Contract, progress: Progress | None) -> Draft:
        """The smallest stream that keeps a contract; normals without a requested quality get what the look needs."""
        bare, metric, free = search.smallest(contract), search.metric, self._free
        if free is None or metric is None or contract.look == math.inf:
            return self._dressed(bare)
        again, decoded = self._carry_with(free, Quality("recompute")), self._prepared.units.into(bare.decoded)

        def looks(carried: tuple[PreparedAttribute, ...], positions: Positions) -> bool:
            return metric.shaded(positions, carried[free].normals(positions)) <= contract.look

        may = not metric.against_faces
        if may and looks(again, decoded):
            self._carried = again
            return self._dressed(bare)
        least, most = LEAST_NORMAL_BITS, int(self._wanted[free][1].amount)
        while least < most:
            bits = (least + most) // 2
            carried = self._carry_with(free, Quality("bits", bits))
            if looks(carried, decoded):
                most, self._carried = bits, carried
            else:
                least = bits + 1
        kept = self._dressed(bare)
        if may and not metric.is_spent and looks(again, self._prepared.positions):  # finer ones are, too, perhaps
            with suppress(TargetError):
                finer = search.shaded_by(again[free].normals).smallest(contract)
                other = with_attributes(finer, again, self._given.metadata)
                if other.size < kept.size and looks(again, self._prepared.units.into(finer.decoded)):
                    self._carried, kept = again, other
        return kept

    def _sized(self, target: Target, progress: Progress | None) -> Attempt:
        """The best stream of a size, which keeps whatever is promised."""
        promise = self.options.promise
        anything = Contract(WIDEST)
        most = target.bytes_of(self._prepared.graph.size)
        found = self._search(promise or anything, progress).best(promise or anything, most)
        if found is not None:
            return self._judged(self._dressed(found))
        asked, none = f"{target.worded(target.value)} at most cannot be", self._search(anything, progress)
        if promise is None:
            least = self._judged(self._dressed(none.smallest(anything)))
            error = TargetError(f"{asked} reached; the least that can be had is {target.worded(target.reached(least))}")
        else:
            least = self._judged(self._dressed(self._search(promise, progress).smallest(promise)))
            other = none.best(anything, most)
            advice = "no preset has that" if other is None else f"--preset none gives {none.seen(other)} in it"
            error = TargetError(
                f"{asked} had with {promise}: that takes {target.worded(target.reached(least))}; {advice}"
            )
        error.best = target.reached(least)
        raise error

    def _as_said(self, target: Target, progress: Progress | None) -> Attempt:
        """Blocks, coded as the options say, at the step that meets a target."""

        def attempt(step: float) -> Attempt:
            draft = self._spectral.base(step, progress).draft
            return self._judged(self._dressed(draft) if target.shrinks_with_step else draft)

        with as_of_decoders(self.options.limits):
            best = search_step(attempt, target, self.options.first_step, smallest_step(self._prepared.size))
        return best if target.shrinks_with_step else replace(best, draft=self._dressed(best.draft))

    def attempt(self, step: float, progress: Progress | None = None) -> Attempt:
        """Encode blocks with a given quantization step, and see what the decoder will."""
        with as_of_decoders(self.options.limits):
            return self._judged(self._dressed(self._spectral.base(step, progress).draft))

    def seen(self, attempt: Attempt) -> str:
        """What is visible of an attempt, in words."""
        return self._search(Contract(WIDEST), None).seen(attempt.draft)

    def _judged(self, draft: Draft) -> Attempt:
        decoded = self._prepared.units.into(draft.decoded)
        return Attempt(draft, self._reference.compare(decoded))

    def _take_attributes(self) -> None:
        _ = self._carried

    def _dressed(self, draft: Draft) -> Draft:
        if not self._carried and not self._given.metadata:
            return draft
        return with_attributes(draft, self._carried, self._given.metadata)

    def _size(self, draft: Draft) -> int:
        return self._dressed(draft).size

    def _verified(self, draft: Draft) -> Draft:
        """The draft, once the decoder has given back what it promises."""
        original = Original(self._given, self._joined, self._prepared)
        with as_of_decoders(self.options.limits):
            limits, threads = NAMED_LIMITS[self.options.limits](), self.options.threads
            verify(draft, original, self._carried, self._given.metadata, limits, threads)
        return draft

    @cached_property
    def _wanted(self) -> list[tuple[Attribute, Quality]]:
        options = self.options
        return qualities(self._given.attributes, dict(options.attributes), options.grade, options.normals)

    @cached_property
    def _carried(self) -> tuple[PreparedAttribute, ...]:
        if not self._wanted:
            return ()
        return carry(place_of(self._given, self._joined, self._prepared), self._wanted)

    @cached_property
    def _joined(self) -> JoinedMesh:
        return join(self._given, keep=self.options.keep_order, exact=self.options.exact)

    @cached_property
    def _prepared(self) -> Prepared:
        options = self._coded
        parts = Parts(options.block_size, options.overlap, options.paper.partition == "metis")
        return prepare(
            self._joined.mesh, parts, keep_order=options.keep_order, splits=self._joined.splits, light=options.quick
        )

    def _carry_with(self, index: int, quality: Quality) -> tuple[PreparedAttribute, ...]:
        """All attributes, one of them with another quality."""
        wanted = [(one, quality if at == index else asked) for at, (one, asked) in enumerate(self._wanted)]
        return carry(place_of(self._given, self._joined, self._prepared), wanted)

    @cached_property
    def _free(self) -> int | None:
        """Return the attribute with normals whose quality was not requested, so that the look decides."""
        options = self.options
        if options.normals != "look" or "*" in dict(options.attributes) or self._normals is None:
            return None
        first = next(at for at, (one, _) in enumerate(self._wanted) if one.semantic == "normal")
        one, quality = self._wanted[first]
        said = one.name in dict(options.attributes) or not np.isfinite(self._normals).all()
        return None if said or one.domain == "face" or quality.way != "bits" else first

    def _search(self, contract: Contract, progress: Progress | None) -> Search:
        measures = Measures(self._prepared, self.options.threads, self._normals, alike=contract.alike)
        # About as long as blocks take, drawing and weighing take behind them.
        half = None if progress is None else lambda done, blocks: progress(done, 2 * blocks)
        return Search(measures, self._coded, half, self._size)

    @cached_property
    def _normals(self) -> Normals | None:
        """Normals that the mesh is sent with, of its corners in the order of coding, shape (m, 9)."""
        sent = any(one.semantic == "normal" for one, _ in self._wanted)
        own = own_normals(self._given) if sent else None
        if own is None:
            return None
        corners = place_of(self._given, self._joined, self._prepared).of_corners(
            np.arange(3 * len(own), dtype=np.int32).reshape(-1, 3)
        )
        return own.reshape(-1, 3)[corners].reshape(-1, 9)

    @cached_property
    def _spectral(self) -> Spectral:
        return Spectral(self._prepared, self._coded)

    @cached_property
    def _reference(self) -> Reference:
        return Reference(self._prepared.positions, self.mesh.faces)


def kept_whole(colours: Attribute) -> bool:
    """Whether colours are few, and tell parts apart, or let shine through what no picture shows."""
    see_through = colours.components in (2, 4) and np.ptp(colours.values[:, -1]) > 0
    return bool(see_through or row_numbers(colours.values).max(initial=0) < 1 << 8)


def encode(mesh: TriangleMesh, options: EncodeOptions | None = None) -> bytes:
    return Encoder(mesh, options).encode()
