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
from bsm.codec.denoise.noise.probe import Probe, grouped_quantiles
from bsm.codec.denoise.noise.search import FAINTEST, find_noise
from bsm.codec.geometry.metrics import face_normals, mean_edge_length

CLEAR, LESS_CLEAR = 0.7, 0.35
"""Share of the energy around it that an outlier explains by itself: no clean mesh tried has more than a few that are
clear; others are looked for after these."""
# How many are believed, as shares of the vertices as well.
FEWEST, FEWEST_SHARE, MOST_SHARE = 12, 0.004, 0.2
ONE_SIDED = 0.5
DISTINCT = 4.0  # smallest displacement looked for, over what calm surroundings show
STRAY, SPIKY = 1.2, 0.75
"""Distance of a stray from the middle of its neighbors, in theirs; and the length of the mean normal around it, below
which it stands out."""
STRAY_FAR, STRAY_LEFT = 1.5, 0.15
"""Of strays: median way back, in mean edges, and the share that may still stand out there. Slivers of CAD
models go 0.1 to 1.3 edges, or a fifth stays."""


def calm(positions: Positions, probe: Probe) -> tuple[int, Positions, Finding]:
    """How many outliers are put back; positions, shape (n, 3), without them; and the noise of these."""
    finding = find_noise(positions, probe)
    # Far strays first: one of them hides fainter ones around it.
    near = positions if finding.exact else put_strays_back(positions, probe)
    finding = finding if near is positions else find_noise(near, probe)
    # In a noisy mesh, vertices that stand out a little are the noise.
    back = near if finding.noisy or finding.exact else _peeled(near, probe)
    finding = finding if back is near else find_noise(back, probe)
    return int((back != positions).any(axis=1).sum()), back, finding


def put_strays_back(positions: Positions, probe: Probe) -> Positions:
    """Vertices far outside their neighbors, put in the middle of them, if there are many."""
    if not probe.counted.any():
        return positions
    stray = _spiky(positions, probe) & (_distances(positions, probe) > STRAY)
    if not _many(stray):
        return positions
    # Only from neighbors that are not strays themselves.
    trust = np.where(stray, 0.0, 1.0)
    weight = probe.average @ trust
    sums = probe.average @ (trust[:, None] * positions)
    middles = sums / np.maximum(weight, 1e-9)[:, None]
    movable = stray & (weight > 0.0)
    result = np.where(movable[:, None], middles, positions)
    way = np.linalg.norm(result - positions, axis=1)[stray]
    # Slivers of CAD models look like strays. Put "back", they still stand out, and are then left alone.
    far = np.median(way) > STRAY_FAR * mean_edge_length(result, probe.topology.faces)
    if not far or _spiky(result, probe)[stray].mean() >= STRAY_LEFT:
        return positions
    return result


def _many(chosen: Mask) -> bool:
    """Whether vertices, shape (n,), are too many for detail, and too few for noise."""
    return bool(max(FEWEST, FEWEST_SHARE * len(chosen)) <= chosen.sum() <= MOST_SHARE * len(chosen))


def _spiky(positions: Positions, probe: Probe) -> Mask:
    """Vertices, shape (n,), around which the normals point all ways."""
    together = probe.topology.incidence @ face_normals(positions, probe.topology.faces)
    sizes = np.diff(probe.topology.around.starts)
    return np.asarray(probe.counted & (np.linalg.norm(together, axis=1) < SPIKY * sizes))


def _distances(positions: Positions, probe: Probe) -> Floats:
    """Distance of each vertex from the median of its neighbors, over the median of theirs, shape (n,)."""
    starts, members = probe.topology.neighbors
    sizes = np.diff(starts)
    owners = np.repeat(np.arange(len(positions)), sizes)
    middle = np.stack(
        [grouped_quantiles(column, owners, sizes, 0.5) for column in positions[members].T], axis=1
    )
    spread = grouped_quantiles(
        np.linalg.norm(positions[members] - middle[owners], axis=1), owners, sizes, 0.5
    )
    off = np.linalg.norm(positions - middle, axis=1)
    # The median of the neighbors' distances: a mean would follow the stray among them.
    return np.asarray(
        off / np.where(probe.counted, np.maximum(spread, 1e-12 * off + 1e-300), np.inf)
    )


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
    for share in (CLEAR, LESS_CLEAR):
        calm = np.nan_to_num(probe.levels(rest / np.where(gain > 0.0, gain, np.inf)))[
            probe.windows.labels
        ]
        least = np.maximum(FAINTEST, DISTINCT * calm / np.sqrt(energy))
        while True:
            fit = (transposed @ rest) / energy
            explained = np.where(probe.counted, fit**2 * energy, 0.0)
            # Only the best in its surroundings is peeled: neighbors would explain the same pattern again.
            best = support.multiply(explained).max(axis=1).toarray().ravel()
            found = (
                (explained > 0.0) & (explained >= best) & (explained >= share * (support @ rest**2))
            )
            found &= (np.abs(fit) > least) & (np.abs(fit) < most)
            if not found.any():
                break
            step = np.where(found, fit, 0.0)
            amounts += step
            rest -= operator @ step
        # Detail makes a few clear ones on any mesh, and on one side. Real outliers are many, and lie on both.
        off = amounts != 0.0
        if not _many(off) or abs(np.sign(amounts[off]).mean()) >= ONE_SIDED:
            return positions
        most = float(np.abs(amounts).max())
    # The first ones were measured beside neighbors that were off as well: all of them again, together.
    amounts[off] += linalg.lsqr(operator[:, np.flatnonzero(off)], rest)[0]
    return np.where(off[:, None], positions - edge * amounts[:, None] * normals, positions)
