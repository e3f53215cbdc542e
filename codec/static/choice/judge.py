"""Whether a decoded mesh keeps a contract: cheap questions while steps are searched, all of them in the end."""

from __future__ import annotations

import math
from functools import cached_property

import numpy as np

from bsm.bitstream.errors import MeshError
from bsm.codec.arrays import Mask, Matrix
from bsm.codec.geometry.closeness import Original
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.look.measure import Looker
from bsm.codec.look.sides import TOWARDS
from bsm.codec.static.choice.borders import Borders
from bsm.codec.static.choice.search import Found, Trial
from bsm.codec.static.choice.shaping import Shaper
from bsm.codec.static.contract import Contract
from bsm.codec.static.preamble import Prepared

FEW_SIDES, MANY_PIXELS = 5, 1024
"""While steps are searched, the mesh is looked at from one of so many sides; from one alone where pictures have more
pixels than this on a side."""


class Sight:
    """What is measured of an original once, whatever is promised.

    Parameters
    ----------
    prepared : Prepared
    threads : int, optional
    """

    def __init__(self, prepared: Prepared, threads: int | None) -> None:
        self._prepared = prepared
        self._threads = threads
        self.original = Original(prepared.positions, prepared.mesh.faces)
        self.shaper = Shaper(self.original, prepared.graph)

    @cached_property
    def looker(self) -> Looker | None:
        """None: nothing of the mesh can be seen."""
        try:
            return Looker(TriangleMesh(self._prepared.positions, self._prepared.mesh.faces), threads=self._threads)
        except MeshError:
            return None


class Judge:
    """Says how well decoded positions keep a contract.

    Parameters
    ----------
    prepared : Prepared
    sight : Sight
    contract : Contract
    reach : float64 array, shape (n,)
        How far each vertex may come to lie from its place, in BSM units.
    borders : Borders
    """

    def __init__(self, prepared: Prepared, sight: Sight, contract: Contract, reach: Matrix, borders: Borders) -> None:
        self._prepared = prepared
        self._sight = sight
        self._contract = contract
        self._reach = reach
        self._borders = borders
        self._best: tuple[float, float, float] | None = None
        self._seen: tuple[Matrix, float] | None = None

    def out(self, positions: Matrix) -> Mask:
        """Vertices that are out of reach, borders aside."""
        out = np.square(positions - self._prepared.positions).sum(axis=1) > self._reach**2
        return np.asarray(out & ~self._borders.vertices)

    def trial(self, step: float, positions: Matrix, found: Found, *, whole: bool = False) -> Trial[Found]:
        """A trial of a step that came to these positions; with `whole`, seen from all sides."""
        near = bool((np.square(positions - self._prepared.positions).sum(axis=1) <= self._reach**2).all())
        return Trial(step, self._excess(positions, whole), near, found)

    def keeps(self, positions: Matrix) -> bool:
        """Whether what is decoded keeps the contract, by all that it says."""
        moved = np.sqrt(np.square(positions - self._prepared.positions).sum(axis=1))
        farther = float(np.divide(moved, self._reach, out=np.zeros_like(moved), where=moved > 0.0).max())
        angle = self._sight.original.angle(positions)
        kept = farther <= 1.0 and angle <= self._contract.angle
        look = self._distance(positions, whole=True) if kept else math.inf
        if self._best is None or (farther, look, angle) < self._best:
            self._best = farther, look, angle
        return kept and look <= self._contract.look and self._borders.kept(self._prepared.positions, positions)

    @property
    def had(self) -> str:
        """The bounds that the best one broke that was seen; empty: none but those of borders."""
        if self._best is None:
            return "nothing"
        farther, look, angle = self._best
        return self._contract.worded(farther, angle, look)

    def _excess(self, positions: Matrix, whole: bool) -> float:
        """Logarithm of how bad normals and pictures are over what they may be."""
        contract = self._contract
        if not contract.shades:
            return -math.inf
        angle = math.log(max(self._sight.original.angle(positions), 1e-6) / contract.angle)
        distance = self._distance(positions, whole)
        return max(angle, math.log(distance / contract.look)) if distance > 0.0 else angle

    def _distance(self, positions: Matrix, whole: bool) -> float:
        """In pictures, from all sides or a few; 0 where nothing is asked of these, or to be seen."""
        looker = None if self._contract.look == math.inf else self._sight.looker
        if looker is None:
            return 0.0
        if not whole:
            return looker.look(positions, every=FEW_SIDES if looker.pixels <= MANY_PIXELS else len(TOWARDS)).distance
        # As a decoder has them; the same positions may be asked for again as a draft's.
        seen = np.ascontiguousarray(self._prepared.units.into(self._prepared.units.back(positions)))
        if self._seen is None or not np.array_equal(self._seen[0], seen):
            self._seen = seen, looker.look(seen).distance
        return self._seen[1]
