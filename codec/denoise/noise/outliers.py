"""Single vertices that stand out: they are put back, and nothing else is touched.

Vertices outside the ring of their neighbors are found even in noisy meshes, fainter ones only on meshes that are clean
otherwise: a high-pass filter K turns a vertex that is off by a into ``K a``, a pattern that clean surfaces do not have.
The columns that explain most around them are peeled off by matching pursuit, the clearest first. Less clear ones are
believed only where many are clear, and as many on one side of the surface as on the other.
"""

import numpy as np
from scipy.sparse import linalg

from bsm.codec.arrays import Floats, Mask, Positions
from bsm.codec.denoise.noise.finding import Finding
from bsm.codec.denoise.noise.probe import BOUND, SHARE, Probe, grouped_quantiles
from bsm.codec.denoise.noise.search import find_noise
from bsm.codec.geometry.metrics import mean_edge_length

CLEAR = 0.7
"""Share of the energy around it that a clear outlier explains by itself: no clean mesh tried has more than a few."""
LESS_CLEAR = (0.5, 0.35)
FEWEST_SHARE = 0.004  # clear outliers, as a share of the vertices, from which on they are believed
FEWEST = 12
MOST_SHARE = 0.2
ONE_SIDED = 0.5
FAINT, WORTH = 0.03, 0.05
"""Smallest displacement looked for, in mean edges; and the median of those found from which on it is worth it."""
LARGEST = 1.2
"""Largest less clear outlier, over the displacement that nine in ten of the clear ones do not reach."""
DISTINCT = 4.0  # displacement over what calm surroundings show
CALM, CALM_BOUND = 0.5, 0.6745
STRAY, PLAINLY, SPIKY = 1.2, 2.0, 0.75
"""Distance from the middle of the neighbors, in theirs, of a vertex that may be far off, and of one that is; and the
length of the mean normal around it below which it stands out."""
STRAYS, STRAY_SHARE, STRAY_USUAL, FARTHER = 25, 0.0018, 1.0, 2.5
"""How many are plainly off, how far nine tenths may be, and how much farther those are: noise alone has fewer."""
STRAY_FAR, STRAY_LEFT, STRAY_OFF = 1.5, 0.15, 0.9
"""Of those plainly off: median way back, in mean edges, the share that may still stand out there, and how far they may
still be off. Slivers of CAD models go 0.1 to 1.3 edges, or a fifth stays, or they are 1.3 off (outliers up to 0.4)."""
STRAY_TURNS = 2
HIGH = 2.2  # height over the noise around, from which on vertices are strays where there are many; noise so high gains
ROUNDS = 40
REFINEMENTS = 30


def put_outliers_back(positions: Positions, probe: Probe, finding: Finding) -> Positions:
    """Put back vertices far outside their neighbors and, in a mesh without noise, those that stand out; no others."""
    # Far strays first: one of them hides fainter ones around it.
    back = put_strays_back(positions, probe)
    # In a noisy mesh, vertices that stand out a little are the noise.
    noisy = (finding if back is positions else find_noise(back, probe)).noisy
    return back if noisy else _peeled(back, probe)


def put_strays_back(positions: Positions, probe: Probe) -> Positions:
    """Vertices far outside their neighbors, put in the middle of them, if there are many."""
    if not probe.counted.any():
        return positions
    n = len(positions)
    place, stray = positions, np.zeros(n, dtype=np.bool_)
    for turn in range(STRAY_TURNS):
        distance, height = _distances(place, probe)
        # Nine tenths of the mesh tell how far vertices usually lie from their neighbors.
        usual = float(np.quantile(distance[probe.counted], 0.9))
        spiky = _spiky(place, probe)
        if turn == 0:
            plain = spiky & (distance > max(PLAINLY, FARTHER * usual))
            if plain.sum() < max(STRAYS, STRAY_SHARE * n) or usual > STRAY_USUAL:
                return positions
        noise = (probe.windows.quantiles(height, SHARE) / BOUND)[probe.windows.labels]
        stray |= spiky & (distance > max(STRAY, 2.0 * usual)) | (height > np.fmax(HIGH * noise, 1.0))
        # A fifth of all vertices cannot be exceptions.
        if stray.sum() > MOST_SHARE * n:
            return positions
        known = np.where(stray, 0.0, 1.0)
        # Only from neighbors that are not strays themselves.
        weight = probe.average @ known
        middle = (probe.average @ (known[:, None] * positions)) / np.maximum(weight, 1e-9)[:, None]
        place = np.where((stray & (weight > 0.0))[:, None], middle, positions)
    way = np.median(np.linalg.norm(place - positions, axis=1)[plain])
    far = way > STRAY_FAR * mean_edge_length(place, probe.topology.faces) and np.median(distance[plain]) < STRAY_OFF
    # Slivers of CAD models look like strays. Put "back", they still stand out, and are then left alone.
    return place if far and _spiky(place, probe)[plain].mean() < STRAY_LEFT else positions


def _spiky(positions: Positions, probe: Probe) -> Mask:
    """Vertices, shape (n,), around which the normals point all ways."""
    together = probe.topology.vertex_normals(positions)
    sizes = np.diff(probe.topology.around.starts)
    return np.asarray(probe.counted & (np.linalg.norm(together, axis=1) < SPIKY * sizes))


def _distances(positions: Positions, probe: Probe) -> tuple[Floats, Floats]:
    """Distance and height of each vertex from the median of its neighbors, over the median of theirs, shape (n,)."""
    starts, members = probe.topology.neighbors
    sizes = np.diff(starts)
    owners = np.repeat(np.arange(len(positions)), sizes)
    middle = np.stack([grouped_quantiles(column, owners, sizes, 0.5) for column in positions[members].T], axis=1)
    spread = grouped_quantiles(np.linalg.norm(positions[members] - middle[owners], axis=1), owners, sizes, 0.5)
    height = np.einsum("ij,ij->i", positions - middle, probe.smooth_normals(middle, passes=1))
    off = np.linalg.norm(positions - middle, axis=1)
    # The median of the neighbors' distances: a mean would follow the stray among them.
    scale = np.where(probe.counted, np.maximum(spread, 1e-12 * off + 1e-300), np.inf)
    return off / scale, np.abs(height) / scale


def _peeled(positions: Positions, probe: Probe) -> Positions:
    edge = mean_edge_length(positions, probe.topology.faces)
    normals = probe.smooth_normals(positions, passes=1)
    operator, gain = probe.fine_operator
    seen = np.einsum("ij,ij->i", operator @ (positions / edge), normals)
    # The energy of the pattern that a vertex off by one edge would make.
    energy = np.maximum(np.asarray(operator.multiply(operator).sum(axis=0)).ravel(), 1e-12)
    support = (operator != 0).astype(np.float64).T.tocsr()
    transposed = operator.T.tocsr()
    rest, amounts, most = seen.copy(), np.zeros(len(positions)), np.inf
    # The clearest first: once their patterns are taken away, fainter ones nearby can be seen.
    for share in (CLEAR, *LESS_CLEAR):
        calm = np.zeros(len(positions))
        if share < CLEAR:
            off = amounts[amounts != 0.0]
            # Detail makes a few clear ones on any mesh, and on one side. Real outliers are many, and lie on both.
            few = len(off) < max(FEWEST, FEWEST_SHARE * len(amounts))
            if few or abs(np.sign(off).mean()) >= ONE_SIDED or np.median(np.abs(off)) <= WORTH:
                return positions
            standard = np.abs(rest) / np.where(gain > 0.0, gain, np.inf)
            if share == LESS_CLEAR[0]:
                most = LARGEST * float(np.quantile(np.abs(off), 0.9))
            quiet = probe.windows.quantiles(standard, CALM) / CALM_BOUND
            calm = np.nan_to_num(quiet)[probe.windows.labels]
        least = np.maximum(FAINT, DISTINCT * calm / np.sqrt(energy))
        for _ in range(ROUNDS):
            fit = (transposed @ rest) / energy
            explained = np.where(probe.counted, fit**2 * energy, 0.0)
            # Only the best in its surroundings is peeled: neighbors would explain the same pattern again.
            best = support.multiply(explained).max(axis=1).toarray().ravel()
            found = (explained > 0.0) & (explained >= best) & (explained >= share * (support @ rest**2))
            found &= (np.abs(fit) > least) & (np.abs(fit) < most)
            if not found.any():
                break
            step = np.where(found, fit, 0.0)
            amounts += step
            rest -= operator @ step
    vertices = np.flatnonzero(amounts)
    if len(vertices) > MOST_SHARE * len(positions):
        # So many are not outliers: the filters remove noise that is everywhere.
        return positions
    # The first ones were measured beside neighbors that were off as well: all of them again, together.
    amounts[vertices] += linalg.lsqr(operator[:, vertices], rest, iter_lim=REFINEMENTS)[0]
    return np.where(amounts[:, None] != 0.0, positions - edge * amounts[:, None] * normals, positions)
