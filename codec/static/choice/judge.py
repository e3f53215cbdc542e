"""Whether a decoded mesh keeps a contract: cheap questions while steps are searched, all of them in the end."""

from __future__ import annotations

import math
from functools import cached_property
from hashlib import sha256

import numpy as np

from bsm.bitstream.errors import MeshError
from bsm.codec.arrays import Mask, Matrix
from bsm.codec.geometry.attributes import Attribute
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.metrics import Original, Reference
from bsm.codec.look.measure import Looker
from bsm.codec.look.pictures import Normals
from bsm.codec.static.choice.search import Found, Trial
from bsm.codec.static.choice.shaping import Shaper
from bsm.codec.static.contract import ANY_ANGLE, Contract
from bsm.codec.static.preamble_encoding import Prepared

NEARLY = (0.85, 1.08)
"""Over the look that is asked for: what comes to less or more from a few sides is not seen from all of them while steps
are searched."""
MOST_SKEW = 1.25
"""How much more, or less, may be seen from all sides than from a few: about as much from one trial to the next."""
LEAST_EXCESS = math.log(1e-6)
"""Of what is as good as it can be."""
ALL = (0.0, math.inf)
"""Nothing is: every distance is seen from all sides."""


class Sight:
    """What is measured of an original once, whatever is promised."""

    def __init__(
        self, prepared: Prepared, threads: int | None, normals: Normals | None = None, *, alike: bool = False
    ) -> None:
        self._prepared = prepared
        self._threads = threads
        self._normals = normals
        self.original = Original(prepared.positions, prepared.mesh.faces, by_area=not alike)
        self.shaper = Shaper(self.original, prepared.graph)

    @cached_property
    def reference(self) -> Reference:
        """The original, prepared for comparing."""
        return Reference(self._prepared.positions, self._prepared.mesh.faces)

    @cached_property
    def looker(self) -> Looker | None:
        """None: nothing of the mesh can be seen."""
        own = () if self._normals is None else (Attribute("normal", self._normals.reshape(-1, 3), "corner", "normal"),)
        try:
            return Looker(TriangleMesh(self._prepared.positions, self._prepared.mesh.faces, own), threads=self._threads)
        except MeshError:
            return None


class Judge:
    """Says how well decoded positions keep a contract."""

    def __init__(self, prepared: Prepared, sight: Sight, contract: Contract, reach: Matrix) -> None:
        self._prepared = prepared
        self._sight = sight
        self._contract = contract
        self._reach = reach
        self._best: tuple[float, float, float, float] | None = None
        self._seen: dict[bytes, float] = {}
        self._skew = 1.0

    def out(self, positions: Matrix) -> Mask:
        """Vertices, shape (n,), that are out of reach at `positions`, shape (n, 3)."""
        return np.asarray(np.square(positions - self._prepared.positions).sum(axis=1) > self._reach**2)

    def trial(self, step: float, positions: Matrix, found: Found, sure: bool = True) -> Trial[Found]:
        """A trial of a step that came to `positions`, shape (n, 3); unless it has to be `sure`, a glance may do."""
        near = bool((np.square(positions - self._prepared.positions).sum(axis=1) <= self._reach**2).all())
        contract = self._contract
        angle = self._angle(positions)
        excess = math.log(max(angle, 1e-6) / contract.angle) if contract.angle < ANY_ANGLE else LEAST_EXCESS
        distance, whole = self._distance(positions, NEARLY if not sure else ALL)
        if distance > 0.0:
            excess = max(excess, math.log(distance / contract.look))
        visual = self._visual(positions)
        if visual > 0.0:
            excess = max(excess, math.log(visual / contract.visual))
        return Trial(step, excess, near, found, whole)

    def keeps(self, positions: Matrix) -> bool:
        """Whether what is decoded, shape (n, 3), keeps the contract, by all that it says."""
        moved = np.sqrt(np.square(positions - self._prepared.positions).sum(axis=1))
        farther = float(np.divide(moved, self._reach, out=np.zeros_like(moved), where=moved > 0.0).max())
        angle, visual = self._angle(positions), self._visual(positions)
        kept = farther <= 1.0 and angle <= self._contract.angle and visual <= self._contract.visual
        look = self._distance(positions, ALL)[0] if kept else math.inf
        if self._best is None or (farther, look, angle, visual) < self._best:
            self._best = farther, look, angle, visual
        return kept and look <= self._contract.look

    @property
    def had(self) -> str:
        """The bounds that the best one broke that was seen."""
        if self._best is None:
            return "nothing"
        farther, look, angle, visual = self._best
        return self._contract.worded(farther, angle, look, visual)

    def _angle(self, positions: Matrix) -> float:
        return self._sight.original.angle(positions) if self._contract.angle < ANY_ANGLE else 0.0

    def _visual(self, positions: Matrix) -> float:
        return self._sight.reference.nmsve(positions) if self._contract.visual < math.inf else 0.0

    def _distance(self, positions: Matrix, nearly: tuple[float, float]) -> tuple[float, bool]:
        """In pictures, and whether it is sure; 0 where nothing is asked of these, or to be seen."""
        looker, asked = None if self._contract.look == math.inf else self._sight.looker, self._contract.look
        if looker is None:
            return 0.0, True
        # As a decoder has them; the same positions may be asked for again as a draft's.
        seen = np.ascontiguousarray(self._prepared.units.into(self._prepared.units.back(positions)))
        name = sha256(seen.tobytes()).digest()
        if name not in self._seen:
            few, whole = looker.glance(seen, nearly[0] * asked / self._skew, nearly[1] * asked / self._skew)
            if whole is None:
                return self._skew * few.distance, False
            self._skew = min(max(whole.distance / max(few.distance, 1e-300), 1.0 / MOST_SKEW), MOST_SKEW)
            self._seen[name] = whole.distance
        return self._seen[name], True
