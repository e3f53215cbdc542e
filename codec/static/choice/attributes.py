"""Attributes, coded as coarsely as the promised look allows."""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Sequence
from contextlib import suppress
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
        return tuple(
            (a, quality if at == index else usual) for at, (a, usual) in enumerate(self.qualities)
        )

    def carry_with(self, index: int, quality: Quality) -> tuple[PreparedAttribute, ...]:
        return self.carry(self.qualities_with(index, quality))

    @cached_property
    def normals(self) -> Normals | None:
        """Normals that the mesh is sent with, of its corners in the order of coding, shape (m, 9)."""
        return None if self.shown_normals is None else self._own_normals

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
        return max(look.distance(decoded, self.carried[at].at_corners) for at, look in self.looks)

    @cached_property
    def shown_normals(self) -> int | None:
        """The number of the sent normals that pictures show."""
        return next(
            (at for at, (attribute, _) in enumerate(self.qualities) if shades(attribute)), None
        )

    @cached_property
    def free_normals(self) -> int | None:
        """The number of the normals without a requested quality, which the look may choose."""
        options = self.options
        first = self.shown_normals
        if (
            options.normals != "look"
            or "*" in dict(options.attributes)
            or first is None
            or self.normals is None
        ):
            return None
        attribute, quality = self.qualities[first]
        is_chosen = (
            attribute.name in dict(options.attributes) or not np.isfinite(self.normals).all()
        )
        return None if is_chosen or quality.way != "bits" else first

    def computes_near_normals(self, decoded: Positions, computed: PreparedAttribute) -> bool:
        """Whether each normal that a decoder computes is within `NEAR` of the given one."""
        if self.normals is None:
            return False
        original = self.normals.reshape(-1, 3).astype(np.float64)
        # A normal without a length has no angle to any other.
        if not original.any(axis=1).all():
            return False
        apart = np.linalg.norm(computed.normals(decoded).reshape(-1, 3) - original, axis=1)
        farthest = 2.0 * math.sin(math.radians(NEAR) / 2.0)
        return bool(apart.max(initial=0.0) <= farthest)

    def measured(self, draft: Draft, contract: Contract) -> tuple[str, float | None, str]:
        """Return the bounds that a draft with its attributes breaks, its look distance, and the bound that binds."""
        bounds, decoded = Bounds(self.measures, contract), draft.decoded
        trial = trial_of(self.prepared, draft)
        metric = bounds.metric
        if metric is None:
            return "" if bounds.keeps(trial) else bounds.had, None, bounds.binding(trial)
        distances = [metric.bare(decoded).distance]
        distances += [
            look.distance(decoded, self.carried[at].at_corners) for at, look in self.looks
        ]
        bound = others = max(*distances, metric.distance(decoded))
        if (number := self.shown_normals) is not None:
            shaded = metric.shaded(decoded, self.carried[number].normals(decoded))
            if self.qualities[number][1].way != "recompute":  # which viewers may do, too
                bound = max(bound if self.free_normals is None else 0.0, *distances, *shaded)
            distances.append(shaded[0])
        elif self._own_normals is not None:  # which viewers compute
            metric_of_own = self._measuring(self._own_normals).look
            if metric_of_own:
                moved = replace(self.prepared.mesh, positions=decoded)
                distances.append(metric_of_own.compare(moved).distance)
        if (
            self.free_normals is None
            and bounds.keeps(trial, others)
            and not bounds.keeps(trial, bound)
        ):
            raise TargetError(
                f"{contract} cannot be kept with this quality of normals; the look is {bound:.3g}"
            )
        binding = bounds.binding(trial, bound)
        return "" if bounds.keeps(trial, bound) else bounds.had, max(distances), binding


def smallest(sender: Sent, contract: Contract, progress: Nearing | None) -> tuple[Sent, Draft]:
    """The smallest stream that keeps a contract, in colors and under a checker, too; and the input as it is sent."""
    sender = sender.measuring(progress, alike=contract.alike)
    if sender.measures.look is not None and contract.look < math.inf:
        sender = _roughened(sender, contract.look)
    return _shaded(sender, contract)


def _roughened(sender: Sent, look: float) -> Sent:
    """Make colors and texture coordinates without a requested quality as coarse as the look allows."""
    rough = sender
    for at, (attribute, quality) in enumerate(sender.qualities):
        chosen = {"*", attribute.name} & {*dict(sender.options.attributes)}
        if not chosen and quality.way in ("bits", "exact") and has_look(attribute):
            rough = _roughen(rough, at, attribute, ATTRIBUTE_SHARE[attribute.semantic] * look)
    if not rough.looks:
        return sender
    rough = rough.but(carried=rough.carry(rough.qualities))
    return rough.but(measures=sender.measures.painting(rough.painted))


def _roughen(sender: Sent, at: int, attribute: Attribute, most: float) -> Sent:
    """Make an attribute as coarse as takes at most some of the look."""
    # A checker shows nothing of a texture that repeats or is sharper than it: no place moves by more than 1/4096.
    extent = float(np.ptp(attribute.values, axis=0).max(initial=0.0))
    least = min(math.ceil(math.log2(max(2048.0 * extent, 2.0))), MOST_BITS)
    steps = [Quality("bits", bits) for bits in range(least, MOST_BITS + 1)]
    if attribute.semantic == "color":
        rough = range(0 if kept_whole(attribute) else 15)
        steps = [*(Quality("share", 25.0 * 0.5 ** (k / 2)) for k in rough), Quality("exact")]
    mesh = sender.prepared.mesh
    look_of = AttributeLook(
        mesh,
        attribute.semantic,
        sender.carry_with(at, steps[-1])[at].at_corners,
        threads=sender.options.threads,
    )

    def is_near(step: int) -> bool:
        return (
            look_of.distance(mesh.positions, sender.carry_with(at, steps[step])[at].at_corners)
            <= most
        )

    step = steps[bisect_left(range(len(steps) - 1), True, key=is_near)]
    if (
        attribute.semantic == "texcoord"
        or sender.carry_with(at, step)[at].size < sender.carried[at].size
    ):
        sender = sender.but(qualities=sender.qualities_with(at, step))
    return sender.but(looks=(*sender.looks, (at, look_of)))


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
    metric = sender.measures.look if most < math.inf else None
    if (
        metric is not None
        and max(metric.shaded(bare.decoded, computed.normals(bare.decoded))) > most
    ):
        return sender, draft
    smaller = spared.completed(bare)
    return (spared, smaller) if smaller.size < draft.size else (sender, draft)


def _shaded(sender: Sent, contract: Contract) -> tuple[Sent, Draft]:
    """The smallest stream that keeps a contract; normals without a quality get as many bits as the look needs."""
    bare, metric, free = sender.search.smallest(contract), sender.measures.look, sender.free_normals
    if free is None or metric is None or contract.look == math.inf:
        return complete(sender, bare, contract.look)
    decoded, most = bare.decoded, contract.look

    def share_of_look(carried: tuple[PreparedAttribute, ...], positions: Positions) -> float:
        return max(metric.shaded(positions, carried[free].normals(positions))) / most

    finer = [
        *(Quality("bits", bits) for bits in range(LEAST_NORMAL_BITS, MOST_NORMAL_BITS + 1)),
        Quality("exact"),
    ]

    def enough(at: int) -> bool:
        return share_of_look(sender.carry_with(free, finer[at]), decoded) <= 1.0

    cheaper = sender.but(
        carried=sender.carry_with(free, finer[bisect_left(range(len(finer) - 1), True, key=enough)])
    )
    pair = cheaper, cheaper.completed(bare)
    recomputed = sender.but(carried=sender.carry_with(free, Quality("recompute")))
    if (
        metric.against_faces
        or share_of_look(recomputed.carried, sender.prepared.mesh.positions) > 1.0 - SLACK
    ):
        return pair

    def worst_look(positions: Positions) -> float:
        return max(
            sender.measures.painted(positions), most * share_of_look(recomputed.carried, positions)
        )

    recomputed = recomputed.but(measures=sender.measures.painting(worst_look))
    with suppress(TargetError):
        smaller = recomputed.completed(recomputed.search.smallest(contract))
        return (recomputed, smaller) if smaller.size < pair[1].size else pair
    return pair


def kept_whole(colors: Attribute) -> bool:
    """Whether colors are few, and tell parts apart, or let shine through what no picture shows."""
    see_through = colors.components in (2, 4) and np.ptp(colors.values[:, -1]) > 0
    return bool(see_through or row_numbers(colors.values).max(initial=0) < 1 << 8)
