"""Levels and places chosen for the normals instead of rounded: the coded error gets smooth, and cheap. Encoder only.

Rounding errors of neighbors have nothing to do with each other, and so they bend the faces between them. A sweep over
the vertices that takes, of the levels nearby, the one at which faces are bent least makes the error smooth: at the same
angle between normals the levels can be twice as coarse. The cost of a level is an estimate of its bits.
"""

import numpy as np
import numpy.typing as npt

from bsm._core import codec as _kernels
from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Indices, Levels, Matrix, Positions, distinct, end_phase
from bsm.codec.geometry.graph import Graph, vertex_faces
from bsm.codec.geometry.mesh import squares_of
from bsm.codec.geometry.metrics import Original
from bsm.codec.static.choice.settling import PULL

RATES = np.log1p(np.arange(4096.0))
"""Bits, but for a factor, of a place on a grid that is so far from where a parallelogram would have it."""
FOLDS = 2e-5  # of the edges: so many more may be folded than were


class Shaper:
    """Chooses levels for one mesh."""

    def __init__(self, original: Original, graph: Graph) -> None:
        positions = original.positions
        faces = original.faces
        self.around = around = vertex_faces(faces, len(positions))
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
        positions, faces = self._original.positions, self._original.faces
        sides = positions[faces[:, 0]] - positions[faces[:, 1]]
        lengths = np.sqrt(squares_of(sides))
        return float(lengths.mean()) or 1.0

    def levels(
        self, base: Positions, goals: Levels, directions: Matrix, worth: float, reach: float
    ) -> Levels:
        """Levels along fixed directions."""
        chosen = np.array(goals, np.int32, order="C")
        scales = np.maximum(np.abs(chosen).mean(axis=0), 0.4)
        shifts = np.einsum("na,naj->nj", chosen.astype(np.float64), directions)
        moved = np.ascontiguousarray(base + shifts)
        flat = np.ascontiguousarray(directions.reshape(len(base), -1))
        aim = worth / len(base), reach, 6
        shaped = moved, chosen, self._open
        _kernels.shape_levels(self._wanted, aim, shaped, flat, scales, PULL)
        return chosen

    def places(
        self, goals: Levels, origin: Matrix, step: float, worth: float, reach: float
    ) -> Levels:
        """Places on a grid."""
        chosen = np.array(goals, np.int32, order="C")
        a, b, c, d = self._flaps.T
        bends = chosen[a] + chosen[b] - chosen[c] - chosen[d]
        moved = np.ascontiguousarray(chosen * step + origin)
        aim = worth / (3 * len(chosen)), reach, 6
        shaped = moved, chosen, self._open
        flaps = self._listed_flaps()
        _kernels.shape_grid(self._wanted, aim, shaped, step, flaps, bends, RATES)
        return chosen

    def unfold(
        self, positions: Positions, levels: Levels, directions: Matrix, reach: Matrix
    ) -> Levels | None:
        """Levels, shape (n, 3), that fold fewer edges, along `directions`, shape (n or 1, 9); None: none is folded."""
        end_phase(len(levels))  # the choice of these levels has taken many arrays
        chosen = np.array(levels, np.int32, order="C")
        most = -(-len(self._original.faces) // 10_000)
        shaped = np.array(positions), chosen, self._open
        axes = np.ascontiguousarray(directions)
        flaps = self._listed_flaps()
        moves = _kernels.unfold_levels(self._wanted, reach, shaped, axes, flaps, most, self._limits)
        if not moves:
            return None
        return chosen

    def over(self, positions: Positions) -> Indices:
        """The vertices of edges that are folded farther than they were."""
        return distinct(self._flaps[self._fold_levels(positions) > self._limits])

    def more_folds(self, positions: Positions) -> int:
        """Return how many more edges are folded than were: by 100, 120 or 150 degrees, whichever has most."""
        return int((self._count_folds(positions) - self._folds_before).max())

    @cached_property
    def most_folds(self) -> int:
        """How many more may be, of any of these angles."""
        return int(FOLDS * len(self._flaps))

    @cached_property
    def _folds_before(self) -> npt.NDArray[np.int64]:
        return self._count_folds(self._original.positions)

    @cached_property
    def _limits(self) -> npt.NDArray[np.uint8]:
        """How far each edge may be folded: as it was, or 100 degrees, which spares right angles."""
        return np.maximum(self._fold_levels(self._original.positions), 1)

    def _count_folds(self, positions: Positions) -> npt.NDArray[np.int64]:
        """How many edges are folded by more than 100, 120 and 150 degrees."""
        counts = np.bincount(self._fold_levels(positions), minlength=5)
        return np.cumsum(counts[:1:-1])[::-1]

    def _fold_levels(self, positions: Positions) -> npt.NDArray[np.uint8]:
        """How far edges between faces are folded, shape (k,): 1 to 4, by more than 90, 100, 120, 150 degrees."""
        far = np.empty(len(self._flaps), np.uint8)
        _kernels.count_folds(positions, self._flaps, far)
        return far

    @cached_property
    def _flaps(self) -> Indices:
        """The vertices of each edge and those across from it, shape (k, 4)."""
        faces = self._original.faces
        graph = self._graph
        edges = len(graph.neighbors) // 2
        flaps = np.empty((edges, 4), np.int32)
        pending = np.empty(len(graph.neighbors), np.int32)
        count = _kernels.collect_flaps(faces, graph.offsets, graph.neighbors, pending, flaps)
        del pending
        if count < len(flaps):
            flaps = flaps[:count].copy()
        end_phase(graph.size)
        return flaps

    def _listed_flaps(self) -> tuple[Indices, Indices, Indices]:
        """Return the flaps, and which of them each vertex is in."""
        # Listed for each use: kept lists take as much memory as the faces twice, and listing is quick.
        starts = np.empty(self._graph.size + 1, np.int32)
        members = np.empty(self._flaps.size, np.int32)
        _kernels.list_flaps(self._flaps, starts, members)
        return self._flaps, starts, members
