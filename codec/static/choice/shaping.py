"""Levels and places chosen for the normals instead of rounded: the coded error gets smooth, and cheap. Encoder only.

Rounding errors of neighbors have nothing to do with each other, and so they bend the faces between them. A sweep over
the vertices that takes, of the levels nearby, the one at which faces are bent least makes the error smooth: at the same
angle between normals the levels can be twice as coarse. The cost of a level is an estimate of its bits.
"""

import numpy as np
import numpy.typing as npt

from bsm._core import codec as _kernels
from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Indices, Levels, Matrix, Positions, end_phase
from bsm.codec.geometry.graph import Graph, vertex_faces
from bsm.codec.geometry.mesh import squares_of
from bsm.codec.geometry.metrics import Original
from bsm.codec.static.choice.settling import PULL

RATES = np.log1p(np.arange(4096.0))
"""Bits, but for a factor, of a place on a grid that is so far from where a parallelogram would have it."""


class Shaper:
    """Chooses levels for one mesh."""

    def __init__(self, original: Original, graph: Graph) -> None:
        positions, faces = original.positions, original.faces
        around = vertex_faces(faces, len(positions))
        self._original = original
        self._graph = graph
        self._wanted = (
            positions, faces, around.starts, around.members, graph.offsets, graph.neighbors,
            original.normals, original.weights,
        )  # fmt: skip
        self._open = np.empty(len(positions), np.uint8)

    @cached_property
    def mean_edge(self) -> float:
        """Mean length of an edge: of the first one of each face; 1 where that is zero."""
        a, b = (self._original.positions[corner] for corner in self._original.faces[:, :2].T)
        return float(np.sqrt(squares_of(a - b)).mean()) or 1.0

    def levels(self, base: Positions, wanted: Levels, directions: Matrix, worth: float, reach: float) -> Levels:
        """Levels along fixed directions."""
        chosen = np.array(wanted, np.int32, order="C")
        scales = np.maximum(np.abs(chosen).mean(axis=0), 0.4)
        moved = np.ascontiguousarray(base + np.einsum("na,naj->nj", chosen.astype(np.float64), directions))
        flat = np.ascontiguousarray(directions.reshape(len(base), -1))
        aim = worth / len(base), reach, 6
        _kernels.shape_levels(self._wanted, aim, (moved, chosen, self._open), flat, scales, PULL)
        return chosen

    def places(self, wanted: Levels, origin: Matrix, step: float, worth: float, reach: float) -> Levels:
        """Places on a grid."""
        chosen = np.array(wanted, np.int32, order="C")
        flaps = self._flaps[0]
        bends = chosen[flaps[:, 0]] + chosen[flaps[:, 1]] - chosen[flaps[:, 2]] - chosen[flaps[:, 3]]
        moved = np.ascontiguousarray(chosen * step + origin)
        aim = worth / (3 * len(chosen)), reach, 6
        _kernels.shape_grid(self._wanted, aim, (moved, chosen, self._open), step, self._flaps, bends, RATES)
        return chosen

    def unfold(self, positions: Positions, levels: Levels, directions: Matrix, reach: Matrix) -> Levels | None:
        """Levels, shape (n, 3), that fold fewer edges, along `directions`, shape (n or 1, 9); None: few are folded."""
        end_phase(len(levels))  # the choice of these levels has taken many arrays
        chosen, most = np.array(levels, np.int32, order="C"), -(-len(self._original.faces) // 10_000)
        given = (np.array(positions), chosen, self._open), np.ascontiguousarray(directions), self._flaps, most
        wrong = np.empty(len(self._flaps[0]), np.uint8)
        return chosen if _kernels.unfold_levels(self._wanted, reach, *given, wrong) else None

    def over(self, positions: Positions) -> Indices:
        """The vertices of edges that are folded over and were not; none if few edges are folded."""
        count, folded = self._over(positions)
        return np.unique(self._flaps[0][folded & ~self._were & (count > self.most_folded)])

    @cached_property
    def _were(self) -> npt.NDArray[np.bool_]:
        return self._far(self._original.positions) > 0

    def folded(self, positions: Positions) -> int:
        """How many edges are folded: by more than 90 degrees, or 100 where they were not, which spares right angles."""
        return self._over(positions)[0]

    def _over(self, positions: Positions) -> tuple[int, npt.NDArray[np.bool_]]:
        """How many edges between faces are folded, and which, shape (k,)."""
        folded = self._far(positions) > ~self._were
        return int(folded.sum()), folded

    def _far(self, positions: Positions) -> npt.NDArray[np.uint8]:
        """How far edges between faces are folded, shape (k,): 1, by more than 90 degrees; 2, by more than 100."""
        far = np.empty(len(self._flaps[0]), np.uint8)
        _kernels.count_folds(positions, self._flaps[0], far)
        return far

    @cached_property
    def most_folded(self) -> int:
        """How many may be: one in 10,000 faces more than were."""
        return self.folded(self._original.positions) - -len(self._original.faces) // 10_000

    @cached_property
    def _flaps(self) -> tuple[Indices, Indices, Indices]:
        faces, graph = self._original.faces, self._graph
        flaps = np.empty((len(graph.neighbors) // 2, 4), np.int32)
        pending = np.empty(len(graph.neighbors), np.int32)
        count = _kernels.collect_flaps(faces, graph.offsets, graph.neighbors, pending, flaps)
        del pending
        if count < len(flaps):
            flaps = flaps[:count].copy()
        starts, members = np.empty(graph.size + 1, np.int32), np.empty(flaps.size, np.int32)
        _kernels.list_flaps(flaps, starts, members)
        end_phase(graph.size)
        return flaps, starts, members
