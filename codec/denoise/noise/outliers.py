"""Single vertices that stand out, on a mesh that else is clean: they are put back, and nothing else is touched.

A vertex off its place by a leaves ``K a`` behind the high-pass filter K: the vertex's own column of K, a pattern that
nothing on a clean surface has (creases are lines, detail is everywhere). So the columns that explain most of what is
around them are peeled off one by one, by matching pursuit, the clearest first. Only where many are perfectly clear,
and as many to one side of the surface as to the other, are less clear ones believed.
"""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import linalg

from bsm.codec.arrays import Positions
from bsm.codec.denoise.noise.probe import Probe
from bsm.codec.denoise.surface import Floats
from bsm.codec.geometry.graph import Rows
from bsm.codec.geometry.metrics import mean_edge_length

CLEAR = 0.7
"""Share of the energy around it that a clear outlier explains by itself: no clean mesh tried has more than a few."""
LESS_CLEAR = (0.5, 0.35, 0.25)
FEWEST_SHARE = 0.004  # clear outliers, as a share of the vertices, from which on they are believed
FEWEST = 12
MOST_SHARE = 0.2
ONE_SIDED = 0.5
FAINT, WORTH, STRONG = 0.03, 0.05, 0.15
"""Smallest displacement looked for, in mean edges; the median of those found from which on it is worth it; and the
median from which on the least clear ones are believed as well: among faint ones they are detail."""
LARGEST = 1.2
"""Less clear ones are no larger than the clear ones, of which nine in ten are smaller than this ratio says."""
DISTINCT = 4.0  # displacement over what calm surroundings show
CALM, CALM_BOUND = 0.5, 0.6745
ROUNDS = 40
REFINEMENTS = 30


@dataclass(frozen=True, eq=False)
class Outliers:
    vertices: np.ndarray
    displacements: Floats

    def put_back(self, positions: Positions) -> Positions:
        """The positions, shape (n, 3), with the vertices back in their places, and all others bit for bit."""
        result = positions.copy()
        result[self.vertices] -= self.displacements
        return result


def find_outliers(positions: Positions, probe: Probe) -> Outliers:
    edge = mean_edge_length(positions, probe.topology.faces)
    normals = probe.smooth_normals(positions, passes=1)
    operator, gain = probe.fine_operator
    seen = np.einsum("ij,ij->i", operator @ (positions / edge), normals)
    energy = np.maximum(np.asarray(operator.multiply(operator).sum(axis=0)).ravel(), 1e-12)
    support = (operator != 0).astype(np.float64).T.tocsr()
    transposed = operator.T.tocsr()
    neighbours = probe.topology.neighbours

    rest, amounts = seen.copy(), np.zeros(len(positions))
    most = np.inf
    for share in (CLEAR, *LESS_CLEAR):
        calm = np.zeros(len(positions))
        if share < CLEAR:
            off = amounts[amounts != 0.0]
            one_sided = len(off) and abs(float(np.sign(off).mean())) >= ONE_SIDED
            if len(off) < max(FEWEST, FEWEST_SHARE * len(amounts)) or one_sided or _usual(amounts) <= WORTH:
                return Outliers(np.zeros(0, dtype=np.int64), np.zeros((0, 3)))
            if share == LESS_CLEAR[-1] and _usual(amounts) < STRONG:
                break
            standard = np.abs(rest) / np.where(gain > 0.0, gain, np.inf)
            if share == LESS_CLEAR[0]:
                most = LARGEST * float(np.quantile(np.abs(amounts[amounts != 0.0]), 0.9))
            quiet = probe.windows.quantiles(standard, CALM) / CALM_BOUND
            calm = np.nan_to_num(quiet)[probe.windows.labels]
        least = np.maximum(FAINT, DISTINCT * calm / np.sqrt(energy))
        for _ in range(ROUNDS):
            fit = (transposed @ rest) / energy
            explained = np.where(probe.counted, fit**2 * energy, 0.0)
            best = _largest_nearby(_largest_nearby(explained, neighbours), neighbours)
            found = (explained > 0.0) & (explained >= best) & (explained >= share * (support @ rest**2))
            found &= (np.abs(fit) > least) & (np.abs(fit) < most)
            if not found.any():
                break
            step = np.where(found, fit, 0.0)
            amounts += step
            rest -= operator @ step
    vertices = np.flatnonzero(amounts)
    if len(vertices) > MOST_SHARE * len(positions):
        # So many are no exceptions: what is all over the mesh is for the filters.
        return Outliers(np.zeros(0, dtype=np.int64), np.zeros((0, 3)))
    # The first ones were measured beside neighbours that were off as well: all of them again, together.
    change = linalg.lsqr(operator[:, vertices], rest, iter_lim=REFINEMENTS)[0]
    amounts[vertices] += change
    return Outliers(vertices, edge * amounts[vertices, None] * normals[vertices])


def _usual(amounts: Floats) -> float:
    return float(np.median(np.abs(amounts[amounts != 0.0])))


def _largest_nearby(values: Floats, neighbours: Rows) -> Floats:
    """The largest of each vertex's value and those of its neighbours."""
    filled = np.diff(neighbours.starts) > 0
    largest = values.copy()
    if filled.any():
        around = np.maximum.reduceat(values[neighbours.members], neighbours.starts[:-1][filled])
        largest[filled] = np.maximum(values[filled], around)
    return largest
