"""Surfaces of few bends near a measured one: flat regions that long, sharp edges join.

``min sum t |v - v0|^2 + sum w |bend v|`` by reweighted least squares: the total variation of the gradient (Rudin,
Osher, Fatemi 1992).
"""

import numpy as np
from scipy import sparse
from scipy.sparse import linalg

from bsm.codec.arrays import Floats, Positions
from bsm.codec.denoise.surface import Topology, shared_edges
from bsm.codec.geometry.metrics import mean_edge_length

BEND = 0.02  # change of slope up to which bends are rounded, not sharp
# Each round solves a linear system by conjugate gradients, from the solution before: it need not be exact.
ROUNDS, STEPS, STAND_OUT = 6, 120, 2.0


def flattened(
    measured: Positions, places: Positions, topology: Topology, weight: float
) -> Positions:
    """Positions, shape (n, 3), of fewer bends over the places, shape (n, 3), near the measured ones."""
    middle = measured.mean(axis=0)
    edge = mean_edge_length(measured, topology.faces) or 1.0
    # In mean edges, since the constants are; and about the middle, so that no digits are lost far from the origin.
    values = (measured - middle) / edge
    flat = fewer_bends(values, (places - middle) / edge, topology, weight)
    return np.asarray(middle + edge * flat)


def fewer_bends(measured: Floats, places: Floats, topology: Topology, weight: float) -> Floats:
    """Values, shape (n, d), of fewer bends over the places, both in mean edges; what stands out counts less."""
    bends, lengths = bending(places, topology)
    values = measured
    trust = np.ones(len(measured))
    for turn in range(ROUNDS):
        bent = np.linalg.norm(bends @ values, axis=1)
        rounding = BEND
        if turn == 0:
            # The first round is smoother: noise bends everything, and would pass for edges.
            rounding = max(BEND, float(np.median(bent)))
        # The weights of an L1 norm grow without bound where nothing bends.
        stiffness = weight * lengths / np.maximum(bent, rounding)
        system = (sparse.diags(trust) + bends.T @ sparse.diags(stiffness) @ bends).tocsr()
        # Weights differ by orders of magnitude between flat places and edges. Scaling by the diagonal evens that out.
        scaling = sparse.diags(1.0 / system.diagonal())
        target = trust[:, None] * measured
        columns = []
        for pull, start in zip(target.T, values.T, strict=True):
            columns.append(linalg.cg(system, pull, start, maxiter=STEPS, M=scaling)[0])
        values = np.stack(columns, axis=1)
        distance = np.linalg.norm(values - measured, axis=1)
        # The median of a normal distribution is 0.6745 deviations. Least squares would follow outliers far beyond.
        usual = STAND_OUT * float(np.median(distance)) / 0.6745
        if usual > 0.0:
            trust = np.minimum(1.0, usual / np.maximum(distance, 1e-9))
    return values


def bending(places: Floats, topology: Topology) -> tuple[sparse.csr_matrix, Floats]:
    """How the gradient of values at the places, shape (n, d), changes over each edge between two faces; its length."""
    hinges = shared_edges(places, topology)
    weights = np.zeros((len(hinges.ends), 4))
    for column, tip in enumerate(hinges.tips.T, start=2):
        apart = places[tip] - hinges.begin
        distance = np.einsum("ij,ij->i", apart, hinges.along)
        height = np.linalg.norm(apart - distance[:, None] * hinges.along, axis=1)
        share = distance / hinges.lengths
        # The slope of a thin triangle is its rounding, times any number.
        weights[:, column] = 1.0 / np.maximum(height, 0.1)
        weights[:, 0] -= (1.0 - share) * weights[:, column]
        weights[:, 1] -= share * weights[:, column]
    where = (
        np.repeat(np.arange(len(weights)), 4),
        np.concatenate([hinges.ends, hinges.tips], axis=1).ravel(),
    )
    return sparse.csr_matrix(
        (weights.ravel(), where), shape=(len(weights), topology.n)
    ), hinges.lengths
