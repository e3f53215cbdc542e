"""Attributes, coded as coarsely as the promised look allows."""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from bsm.bitstream.connectivity.faces import AS_CORNERS, ON_EDGES, WHERE_SMALLER
from bsm.bitstream.errors import TargetError
from bsm.bitstream.once import cached_property, with_results
from bsm.codec.arrays import Positions
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.welding import row_numbers
from bsm.codec.look.measure import AttributeLook, LookMetric, has_look, own_normals, shades
from bsm.codec.look.pictures import Normals
from bsm.codec.progress import Nearing
from bsm.codec.static.attributes.encoding import PreparedAttribute, carry, with_attributes
from bsm.codec.static.attributes.quality import (
    LEAST_NORMAL_BITS,
    MOST_BITS,
    MOST_NORMAL_BITS,
    Quality,
    qualities,
)
from bsm.codec.static.choice.bounds import Bounds, Measures, trial_of
from bsm.codec.static.choice.search import Search
from bsm.codec.static.choice.trace import Trace
from bsm.codec.static.options import EncodeOptions
from bsm.codec.static.preamble_encoding import Draft, JoinedMesh, Parts, Prepared, join, prepare
from bsm.codec.static.targets import SLACK, Contract

SWIFT = {"quick": 1, "normal": 2, "best": 0}
"""How values of attributes are coded, `swift` of the header, by the effort: decoders of more bytes are quicker."""
NEAR = 1.0  # degrees by which computed normals may differ from the given ones that they replace
LOSS_GROWS = 3  # how many times as many bytes finer values may lose
# Of the look that is promised, what rounding these may take.
ATTRIBUTE_SHARE = {"texcoord": 0.33, "color": 0.2}


@dataclass(frozen=True, eq=False)
class Sent:
    """A mesh on its way into a stream: joined, prepared, and its attributes as they are sent."""

    source: TriangleMesh
    options: EncodeOptions
    looks: tuple[tuple[int, AttributeLook], ...] = ()  # attributes whose quality the look decides
    drawn: LookMetric | None = None  # pictures of another mesh, for which this one stands
    trace: Trace = field(default_factory=Trace)

    def but(self, **results: Any) -> Sent:
        """Return an input with other values of some fields and results, and all else that was computed."""
        return with_results(self, **results)

    @property
    def joined(self) -> JoinedMesh:
        return self._begun[0]

    @property
    def prepared(self) -> Prepared:
        return self._begun[1]

    @cached_property
    def _begun(self) -> tuple[JoinedMesh, Prepared]:
        options = self.options
        joined = join(self.source, keep=options.keep_order, exact=options.exact)
        prepared = self._prepare(joined, WHERE_SMALLER)
        if prepared.repeats == ON_EDGES and self.source.attributes:
            prepared = self._with_attributes_smaller(joined, prepared)
        if not self.source.attributes:
            joined = replace(joined, coder=None)  # it is as large as ten meshes
        return joined, prepared

    def _prepare(self, joined: JoinedMesh, repeats: int) -> Prepared:
        options = self.options
        return prepare(
            joined,
            Parts.of(options.block_size, options.growth, options.paper.partition),
            keep_order=options.keep_order,
            light=options.effort == "quick",
            congruence=options.congruence,
            repeats=repeats,
        )

    def _with_attributes_smaller(self, joined: JoinedMesh, on_edges: Prepared) -> Prepared:
        """The mesh with faces that repeat a corner on edges, or by their corners if values of attributes need that."""
        # Values come in the order of faces, and each is predicted from the one before it as well.
        values_on_edges = self._values_size(joined, on_edges)
        as_corners = self._prepare(joined, AS_CORNERS)
        lost = max(values_on_edges - self._values_size(joined, as_corners), 0)
        gained = len(as_corners.connectivity.data) - len(on_edges.connectivity.data)
        # The qualities of now may become finer, and then such a loss grows.
        return self._prepare(joined, ON_EDGES) if gained > LOSS_GROWS * lost else as_corners

    def _values_size(self, joined: JoinedMesh, prepared: Prepared) -> int:
        """Bytes of all attributes, not predicted from positions, on the faces that were prepared last."""
        carried = carry(
            joined.coding, prepared.mesh.faces, self.qualities, SWIFT[self.options.effort]
        )
        return sum(attribute.size for attribute in carried)

    def rested(self) -> Sent:
        """Return the input without all that was measured for the search; it is measured again if it is needed."""
        joined, prepared = self._begun
        return replace(self).but(
            _begun=(joined, replace(prepared)), qualities=self.qualities, carried=self.carried
        )

    @cached_property
    def qualities(self) -> tuple[tuple[Attribute, Quality], ...]:
        options = self.options
        return tuple(
            qualities(
                self.source.attributes, dict(options.attributes), options.grade, options.normals
            )
        )

    @cached_property
    def carried(self) -> tuple[PreparedAttribute, ...]:
        return self.carry(self.qualities)

    def carry(self, pairs: Sequence[tuple[Attribute, Quality]]) -> tuple[PreparedAttribute, ...]:
        if not pairs:
            return ()
        return carry(
            self.joined.coding, self.prepared.mesh.faces, pairs, SWIFT[self.options.effort]
        )

    def qualities_with(self, index: int, quality: Quality) -> tuple[tuple[Attribute, Quality], ...]:
        """All attributes, one of them with another quality."""
        pairs = list(self.qualities)
        attribute, _ = pairs[index]
        pairs[index] = attribute, quality
        return tuple(pairs)

    def carry_with(self, index: int, quality: Quality) -> tuple[PreparedAttribute, ...]:
        return self.carry(self.qualities_with(index, quality))

    @cached_property
    def normals(self) -> Normals | None:
        """Normals that the mesh is sent with, of its corners in the order of coding, shape (m, 9)."""
        if self.shown_normals is None:
            return None
        return self._own_normals

    @cached_property
    def _own_normals(self) -> Normals | None:
        normals = own_normals(self.source)
        if normals is None:
            return None
        numbers = np.arange(3 * len(normals), dtype=np.int32).reshape(-1, 3)
        corners = self.prepared.of_coded(numbers[self.joined.coded_faces])
        return normals.reshape(-1, 3)[corners].reshape(-1, 9)

    def completed(self, draft: Draft) -> Draft:
        """The draft with attributes and metadata."""
        if not self.carried and not self.source.metadata:
            return draft
        return with_attributes(draft, self.carried, self.source.metadata)

    def measuring(self, progress: Nearing | None, *, alike: bool = False) -> Sent:
        """Return an input whose measurements report their progress; `alike`: angles count all faces alike."""
        return self.but(measures=self._measuring(self.normals, alike=alike, progress=progress))

    @cached_property
    def measures(self) -> Measures:
        return self._measuring(self.normals)

    def _measuring(self, normals: Normals | None, **results: Any) -> Measures:
        return Measures(self.prepared, self.options.threads, normals, drawn=self.drawn, **results)

    @property
    def search(self) -> Search:
        additions = sum(attribute.size for attribute in self.carried)
        return Search(
            self.measures,
            self.options,
            lambda draft: self.completed(draft).size,
            additions,
            self.trace,
        )

    def painted(self, decoded: Positions) -> float:
        """The largest distance of colors and texture coordinates whose quality the look decides."""
        return max(self._distances_of_looks(decoded))

    def _distances_of_looks(self, decoded: Positions) -> list[float]:
        return [look.distance(decoded, self.carried[at].at_corners) for at, look in self.looks]

    @cached_property
    def shown_normals(self) -> int | None:
        """The number of the sent normals that pictures show."""
        for number, (attribute, _) in enumerate(self.qualities):
            if shades(attribute):
                return number
        return None

    @cached_property
    def free_normals(self) -> int | None:
        """The number of the normals without a requested quality, which the look may choose."""
        requested = dict(self.options.attributes)
        first = self.shown_normals
        if self.options.normals != "look" or "*" in requested:
            return None
        if first is None or self.normals is None:
            return None
        attribute, quality = self.qualities[first]
        if attribute.name in requested or quality.way != "bits":
            return None
        if not np.isfinite(self.normals).all():
            return None
        return first

    def computes_near_normals(self, decoded: Positions, computed: PreparedAttribute) -> bool:
        """Whether each normal that a decoder computes is within `NEAR` of the given one."""
        if self.normals is None:
            return False
        original = self.normals.reshape(-1, 3).astype(np.float64)
        # A normal without a length has no angle to any other.
        if not original.any(axis=1).all():
            return False
        computed_normals = computed.normals(decoded).reshape(-1, 3)
        apart = np.linalg.norm(computed_normals - original, axis=1)
        farthest = 2.0 * math.sin(math.radians(NEAR) / 2.0)
        return bool(apart.max(initial=0.0) <= farthest)

    def measured(self, draft: Draft, contract: Contract) -> tuple[str, float | None, str]:
        """Return the bounds that a draft with its attributes breaks, its look distance, and the bound that binds."""
        bounds = Bounds(self.measures, contract)
        decoded = draft.decoded
        trial = trial_of(self.prepared, draft)
        metric = bounds.metric
        if metric is None:
            return bounds.broken_by(trial), None, bounds.binding(trial)
        distances = [metric.bare(decoded).distance, *self._distances_of_looks(decoded)]
        bound = others = max(*distances, metric.distance(decoded))
        number = self.shown_normals
        if number is not None:
            shaded = metric.shaded(decoded, self.carried[number].normals(decoded))
            _, quality = self.qualities[number]
            if quality.way != "recompute":  # which viewers may do, too
                if self.free_normals is not None:
                    bound = 0.0
                bound = max(bound, *distances, *shaded)
            distances.append(shaded[0])
        else:
            distances += self._distances_of_own_normals(decoded)
        if (
            self.free_normals is None
            and bounds.keeps(trial, others)
            and not bounds.keeps(trial, bound)
        ):
            raise TargetError(
                f"{contract} cannot be kept with this quality of normals; the look is {bound:.3g}"
            )
        binding = bounds.binding(trial, bound)
        return bounds.broken_by(trial, bound), max(distances), binding

    def _distances_of_own_normals(self, decoded: Positions) -> list[float]:
        """The look distance with normals that viewers compute, if the mesh comes with any."""
        if self._own_normals is None:
            return []
        metric = self._measuring(self._own_normals).look
        if not metric:
            return []
        moved = replace(self.prepared.mesh, positions=decoded)
        return [metric.compare(moved).distance]


def smallest(sender: Sent, contract: Contract, progress: Nearing | None) -> tuple[Sent, Draft]:
    """The smallest stream that keeps a contract, in colors and under a checker, too; and the input as it is sent."""
    sender = sender.measuring(progress, alike=contract.alike)
    if sender.measures.look is not None and contract.look < math.inf:
        sender = _roughened(sender, contract.look)
    return _shaded(sender, contract)


def _roughened(sender: Sent, look: float) -> Sent:
    """Make colors and texture coordinates without a requested quality as coarse as the look allows."""
    rough = sender
    requested = dict(sender.options.attributes)
    for at, (attribute, quality) in enumerate(sender.qualities):
        is_chosen = "*" in requested or attribute.name in requested
        if not is_chosen and quality.way in ("bits", "exact") and has_look(attribute):
            rough = _roughen(rough, at, attribute, ATTRIBUTE_SHARE[attribute.semantic] * look)
    if not rough.looks:
        return sender
    rough = rough.but(carried=rough.carry(rough.qualities))
    return rough.but(measures=sender.measures.painting(rough.painted))


def _roughen(sender: Sent, at: int, attribute: Attribute, most: float) -> Sent:
    """Make an attribute as coarse as takes at most some of the look."""
    # A checker shows nothing of a texture that repeats or is sharper than it: no place moves by more than 1/4096.
    extent = float(np.ptp(attribute.values, axis=0).max(initial=0.0))
    places = max(2048.0 * extent, 2.0)
    least = min(math.ceil(math.log2(places)), MOST_BITS)
    steps = [Quality("bits", bits) for bits in range(least, MOST_BITS + 1)]
    if attribute.semantic == "color":
        steps = _color_qualities(attribute)
    mesh = sender.prepared.mesh
    threads = sender.options.threads

    def carry_at(step: int) -> PreparedAttribute:
        return sender.carry_with(at, steps[step])[at]

    finest = carry_at(-1).at_corners
    look_of = AttributeLook(mesh, attribute.semantic, finest, threads=threads)

    def is_near(step: int) -> bool:
        distance = look_of.distance(mesh.positions, carry_at(step).at_corners)
        return distance <= most

    step = bisect_left(range(len(steps) - 1), True, key=is_near)
    if attribute.semantic == "texcoord" or carry_at(step).size < sender.carried[at].size:
        chosen_qualities = sender.qualities_with(at, steps[step])
        return sender.but(qualities=chosen_qualities, looks=(*sender.looks, (at, look_of)))
    return sender.but(looks=(*sender.looks, (at, look_of)))


def _color_qualities(colors: Attribute) -> list[Quality]:
    """The qualities that colors may have, coarsest first."""
    if kept_whole(colors):
        return [Quality("exact")]
    shares = [25.0 * 0.5 ** (k / 2) for k in range(15)]
    return [*(Quality("share", share) for share in shares), Quality("exact")]


def complete(sender: Sent, bare: Draft, most: float = math.inf) -> tuple[Sent, Draft]:
    """Return the input as it is sent, and the draft with attributes; `most`: the look that is promised.

    With the option "near", it leaves out normals that the decoder computes well enough, if that saves bytes.
    """
    draft = sender.completed(bare)
    number = sender.shown_normals
    if (
        sender.options.normals != "near"
        or number is None
        or sender.qualities[number][0].values.dtype.kind != "f"
    ):
        return sender, draft
    spared = sender.but(carried=sender.carry_with(number, Quality("recompute")))
    computed = spared.carried[number]
    if not sender.computes_near_normals(bare.decoded, computed):
        return sender, draft
    if most < math.inf and not _look_fits(sender.measures, bare.decoded, computed, most):
        return sender, draft
    smaller = spared.completed(bare)
    if smaller.size < draft.size:
        return spared, smaller
    return sender, draft


def _look_fits(
    measures: Measures, decoded: Positions, computed: PreparedAttribute, most: float
) -> bool:
    """Whether decoded positions with computed normals look at most so far off, if anything is seen."""
    metric = measures.look
    if metric is None:
        return True
    shaded = metric.shaded(decoded, computed.normals(decoded))
    return max(shaded) <= most


def _shaded(sender: Sent, contract: Contract) -> tuple[Sent, Draft]:
    """The smallest stream that keeps a contract; normals without a quality get as many bits as the look needs."""
    bare = sender.search.smallest(contract)
    metric = sender.measures.look
    free = sender.free_normals
    if free is None or metric is None or contract.look == math.inf:
        return complete(sender, bare, contract.look)
    decoded = bare.decoded
    most = contract.look

    def share_of_look(carried: tuple[PreparedAttribute, ...], positions: Positions) -> float:
        normals = carried[free].normals(positions)
        return max(metric.shaded(positions, normals)) / most

    bit_counts = range(LEAST_NORMAL_BITS, MOST_NORMAL_BITS + 1)
    finer = [*(Quality("bits", bits) for bits in bit_counts), Quality("exact")]

    def is_enough(at: int) -> bool:
        return share_of_look(sender.carry_with(free, finer[at]), decoded) <= 1.0

    coarsest = finer[bisect_left(range(len(finer) - 1), True, key=is_enough)]
    cheaper = sender.but(carried=sender.carry_with(free, coarsest))
    draft = cheaper.completed(bare)
    recomputed = sender.but(carried=sender.carry_with(free, Quality("recompute")))
    if metric.against_faces:
        return cheaper, draft
    if share_of_look(recomputed.carried, sender.prepared.mesh.positions) > 1.0 - SLACK:
        return cheaper, draft

    def worst_look(positions: Positions) -> float:
        shaded = most * share_of_look(recomputed.carried, positions)
        return max(sender.measures.painted(positions), shaded)

    recomputed = recomputed.but(measures=sender.measures.painting(worst_look))
    try:
        smaller = recomputed.completed(recomputed.search.smallest(contract))
    except TargetError:  # computed normals are too far off
        return cheaper, draft
    if smaller.size < draft.size:
        return recomputed, smaller
    return cheaper, draft


def kept_whole(colors: Attribute) -> bool:
    """Whether colors are few, and tell parts apart, or let shine through what no picture shows."""
    if colors.components in (2, 4):
        opacity = colors.values[:, -1]
        if np.ptp(opacity) > 0:
            return True
    numbers = row_numbers(colors.values)
    return bool(numbers.max(initial=0) < 1 << 8)
