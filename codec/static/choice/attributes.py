"""Attributes, coded as coarsely as the promised look allows."""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

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
from bsm.codec.static.attributes.quality import LEAST_NORMAL_BITS, MOST_BITS, MOST_NORMAL_BITS, Quality, qualities
from bsm.codec.static.choice.bounds import Bounds, Measures, trial_of
from bsm.codec.static.choice.search import Search
from bsm.codec.static.choice.trace import Trace
from bsm.codec.static.options import EncodeOptions
from bsm.codec.static.preamble_encoding import Draft, JoinedMesh, Parts, Prepared, join, prepare
from bsm.codec.static.targets import SLACK, Contract

SWIFT = {"quick": 1, "normal": 2, "best": 0}
"""How values of attributes are coded, `swift` of the header, by the effort: decoders of more bytes are quicker."""
NEAR = 1.0  # degrees by which computed normals may differ from the given ones that they replace
ATTRIBUTE_SHARE = {"texcoord": 0.33, "color": 0.2}  # of the look that is promised, what rounding these may take


@dataclass(frozen=True, eq=False)
class Sent:
    """A mesh on its way into a stream: joined, prepared, and its attributes as they are sent."""

    given: TriangleMesh
    options: EncodeOptions
    looks: tuple[tuple[int, AttributeLook], ...] = ()  # attributes whose quality the look decides
    shown: LookMetric | None = None  # pictures of another mesh, for which this one stands
    trace: Trace = field(default_factory=Trace)

    def but(self, **known: Any) -> Sent:
        """Return an input with other values of some fields and results, and all else that was computed."""
        return with_results(self, **known)

    @property
    def joined(self) -> JoinedMesh:
        return self._begun[0]

    @property
    def prepared(self) -> Prepared:
        return self._begun[1]

    @cached_property
    def _begun(self) -> tuple[JoinedMesh, Prepared]:
        options = self.options
        joined = join(self.given, keep=options.keep_order, exact=options.exact)
        prepared = prepare(
            joined,
            Parts.of(options.block_size, options.growth, options.paper.partition),
            keep_order=options.keep_order,
            light=options.effort == "quick",
            congruence=options.congruence,
        )
        if not self.given.attributes:
            joined = replace(joined, coder=None)  # it is as large as ten meshes
        return joined, prepared

    def rested(self) -> Sent:
        """Return the input without all that was measured for the search; it is measured again if it is needed."""
        joined, prepared = self._begun
        return replace(self).but(_begun=(joined, replace(prepared)), wanted=self.wanted, carried=self.carried)

    @cached_property
    def wanted(self) -> tuple[tuple[Attribute, Quality], ...]:
        options = self.options
        return tuple(qualities(self.given.attributes, dict(options.attributes), options.grade, options.normals))

    @cached_property
    def carried(self) -> tuple[PreparedAttribute, ...]:
        return self.carry(self.wanted)

    def carry(self, wanted: Sequence[tuple[Attribute, Quality]]) -> tuple[PreparedAttribute, ...]:
        if not wanted:
            return ()
        return carry(self.joined.coding, self.prepared.mesh.faces, wanted, SWIFT[self.options.effort])

    def wanted_with(self, index: int, quality: Quality) -> tuple[tuple[Attribute, Quality], ...]:
        """All attributes, one of them with another quality."""
        return tuple((a, quality if at == index else asked) for at, (a, asked) in enumerate(self.wanted))

    def carry_with(self, index: int, quality: Quality) -> tuple[PreparedAttribute, ...]:
        return self.carry(self.wanted_with(index, quality))

    @cached_property
    def normals(self) -> Normals | None:
        """Normals that the mesh is sent with, of its corners in the order of coding, shape (m, 9)."""
        return None if self.shown_normals is None else self._own_normals

    @cached_property
    def _own_normals(self) -> Normals | None:
        own = own_normals(self.given)
        if own is None:
            return None
        given = np.arange(3 * len(own), dtype=np.int32).reshape(-1, 3)
        corners = self.prepared.of_coded(given[self.joined.kept])
        return own.reshape(-1, 3)[corners].reshape(-1, 9)

    def completed(self, draft: Draft) -> Draft:
        """The draft with attributes and metadata."""
        if not self.carried and not self.given.metadata:
            return draft
        return with_attributes(draft, self.carried, self.given.metadata)

    def measuring(self, near: Nearing | None, *, alike: bool = False) -> Sent:
        """Return an input whose measurements report their progress; `alike`: angles count all faces alike."""
        return self.but(measures=self._measuring(self.normals, alike=alike, near=near))

    @cached_property
    def measures(self) -> Measures:
        return self._measuring(self.normals)

    def _measuring(self, normals: Normals | None, **known: Any) -> Measures:
        return Measures(self.prepared, self.options.threads, normals, shown=self.shown, **known)

    @property
    def search(self) -> Search:
        additions = sum(attribute.size for attribute in self.carried)
        return Search(self.measures, self.options, lambda draft: self.completed(draft).size, additions, self.trace)

    def painted(self, decoded: Positions) -> float:
        """The largest distance of colors and texture coordinates whose quality the look decides."""
        return max(look.distance(decoded, self.carried[at].at_corners) for at, look in self.looks)

    @cached_property
    def shown_normals(self) -> int | None:
        """The number of the sent normals that pictures show."""
        return next((at for at, (attribute, _) in enumerate(self.wanted) if shades(attribute)), None)

    @cached_property
    def free_normals(self) -> int | None:
        """The number of the normals without a requested quality, which the look may choose."""
        options = self.options
        first = self.shown_normals
        if options.normals != "look" or "*" in dict(options.attributes) or first is None or self.normals is None:
            return None
        attribute, quality = self.wanted[first]
        asked = attribute.name in dict(options.attributes) or not np.isfinite(self.normals).all()
        return None if asked or quality.way != "bits" else first

    def computes_near_normals(self, decoded: Positions, computed: PreparedAttribute) -> bool:
        """Whether each normal that a decoder computes is within `NEAR` of the given one."""
        if self.normals is None:
            return False
        given = self.normals.reshape(-1, 3).astype(np.float64)
        # A normal without a length has no angle to any other.
        if not given.any(axis=1).all():
            return False
        apart = np.linalg.norm(computed.normals(decoded).reshape(-1, 3) - given, axis=1)
        farthest = 2.0 * math.sin(math.radians(NEAR) / 2.0)
        return bool(apart.max(initial=0.0) <= farthest)

    def measured(self, draft: Draft, contract: Contract) -> tuple[str, float | None, str]:
        """Return the bounds that a draft with its attributes breaks, its look distance, and the bound that binds."""
        bounds, decoded = Bounds(self.measures, contract), draft.decoded
        made = trial_of(self.prepared, draft)
        metric = bounds.metric
        if metric is None:
            return "" if bounds.keeps(made) else bounds.had, None, bounds.binding(made)
        shown = [metric.bare(decoded).distance]
        shown += [look.distance(decoded, self.carried[at].at_corners) for at, look in self.looks]
        bound = others = max(*shown, metric.distance(decoded))
        if (sent := self.shown_normals) is not None:
            shaded = metric.shaded(decoded, self.carried[sent].normals(decoded))
            if self.wanted[sent][1].way != "recompute":  # which viewers may do, too
                bound = max(bound if self.free_normals is None else 0.0, *shown, *shaded)
            shown.append(shaded[0])
        elif self._own_normals is not None:  # which viewers compute
            given = self._measuring(self._own_normals).look
            shown.append(given.compare(replace(self.prepared.mesh, positions=decoded)).distance if given else 0.0)
        if self.free_normals is None and bounds.keeps(made, others) and not bounds.keeps(made, bound):
            raise TargetError(f"{contract} cannot be kept with this quality of normals; the look is {bound:.3g}")
        binding = bounds.binding(made, bound)
        return "" if bounds.keeps(made, bound) else bounds.had, max(shown), binding


def smallest(given: Sent, contract: Contract, near: Nearing | None) -> tuple[Sent, Draft]:
    """The smallest stream that keeps a contract, in colors and under a checker, too; and the input as it is sent."""
    given = given.measuring(near, alike=contract.alike)
    if given.measures.look is not None and contract.look < math.inf:
        given = _roughened(given, contract.look)
    return _shaded(given, contract)


def _roughened(given: Sent, look: float) -> Sent:
    """Make colors and texture coordinates without a requested quality as coarse as the look allows."""
    rough = given
    for at, (attribute, quality) in enumerate(given.wanted):
        asked = {"*", attribute.name} & {*dict(given.options.attributes)}
        if not asked and quality.way in ("bits", "exact") and has_look(attribute):
            rough = _roughen(rough, at, attribute, ATTRIBUTE_SHARE[attribute.semantic] * look)
    if not rough.looks:
        return given
    rough = rough.but(carried=rough.carry(rough.wanted))
    return rough.but(measures=given.measures.painting(rough.painted))


def _roughen(given: Sent, at: int, attribute: Attribute, most: float) -> Sent:
    """Make an attribute as coarse as takes at most some of the look."""
    # A checker shows nothing of a texture that repeats or is sharper than it: no place moves by more than 1/4096.
    extent = float(np.ptp(attribute.values, axis=0).max(initial=0.0))
    least = min(math.ceil(math.log2(max(2048.0 * extent, 2.0))), MOST_BITS)
    steps = [Quality("bits", bits) for bits in range(least, MOST_BITS + 1)]
    if attribute.semantic == "color":
        rough = range(0 if kept_whole(attribute) else 15)
        steps = [*(Quality("share", 25.0 * 0.5 ** (k / 2)) for k in rough), Quality("exact")]
    mesh = given.prepared.mesh
    look_of = AttributeLook(
        mesh, attribute.semantic, given.carry_with(at, steps[-1])[at].at_corners, threads=given.options.threads
    )

    def near(step: int) -> bool:
        return look_of.distance(mesh.positions, given.carry_with(at, steps[step])[at].at_corners) <= most

    step = steps[bisect_left(range(len(steps) - 1), True, key=near)]
    if attribute.semantic == "texcoord" or given.carry_with(at, step)[at].size < given.carried[at].size:
        given = given.but(wanted=given.wanted_with(at, step))
    return given.but(looks=(*given.looks, (at, look_of)))


def complete(given: Sent, bare: Draft, most: float = math.inf) -> tuple[Sent, Draft]:
    """Return the input as it is sent, and the draft with attributes; `most`: the look that is promised.

    With the option "near", it leaves out normals that the decoder computes well enough, if that saves bytes.
    """
    kept = given.completed(bare)
    number = given.shown_normals
    if given.options.normals != "near" or number is None or given.wanted[number][0].values.dtype.kind != "f":
        return given, kept
    spared = given.but(carried=given.carry_with(number, Quality("recompute")))
    computed = spared.carried[number]
    if not given.computes_near_normals(bare.decoded, computed):
        return given, kept
    metric = given.measures.look if most < math.inf else None
    if metric is not None and max(metric.shaded(bare.decoded, computed.normals(bare.decoded))) > most:
        return given, kept
    smaller = spared.completed(bare)
    return (spared, smaller) if smaller.size < kept.size else (given, kept)


def _shaded(given: Sent, contract: Contract) -> tuple[Sent, Draft]:
    """The smallest stream that keeps a contract; normals without a quality get as many bits as the look needs."""
    bare, metric, free = given.search.smallest(contract), given.measures.look, given.free_normals
    if free is None or metric is None or contract.look == math.inf:
        return complete(given, bare, contract.look)
    decoded, asked = bare.decoded, contract.look

    def seen(carried: tuple[PreparedAttribute, ...], positions: Positions) -> float:
        return max(metric.shaded(positions, carried[free].normals(positions))) / asked

    finer = [*(Quality("bits", bits) for bits in range(LEAST_NORMAL_BITS, MOST_NORMAL_BITS + 1)), Quality("exact")]

    def enough(at: int) -> bool:
        return seen(given.carry_with(free, finer[at]), decoded) <= 1.0

    sent = given.but(carried=given.carry_with(free, finer[bisect_left(range(len(finer) - 1), True, key=enough)]))
    kept = sent, sent.completed(bare)
    recomputed = given.but(carried=given.carry_with(free, Quality("recompute")))
    if metric.against_faces or seen(recomputed.carried, given.prepared.mesh.positions) > 1.0 - SLACK:
        return kept

    def shown(positions: Positions) -> float:
        return max(given.measures.painted(positions), asked * seen(recomputed.carried, positions))

    recomputed = recomputed.but(measures=given.measures.painting(shown))
    with suppress(TargetError):
        other = recomputed.completed(recomputed.search.smallest(contract))
        return (recomputed, other) if other.size < kept[1].size else kept
    return kept


def kept_whole(colors: Attribute) -> bool:
    """Whether colors are few, and tell parts apart, or let shine through what no picture shows."""
    see_through = colors.components in (2, 4) and np.ptp(colors.values[:, -1]) > 0
    return bool(see_through or row_numbers(colors.values).max(initial=0) < 1 << 8)
