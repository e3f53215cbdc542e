"""Total generalized variation of face normals: smooth regions that sharp edges part.

Each face has a normal n and a gradient g, the change of the normal along two axes of the face's own. The energy is
``sum A |n - n0|^2 / 2 + a1 sum l w |jump of n - g d| + a0 sum l w |jump of g|`` over faces of area A and edges of
length l, across which centroids are d apart once the two faces are unfolded. The first sum of jumps keeps edges sharp;
the second lets normals turn evenly, as they do on cylinders and spheres. The weights w follow the edges. Alternating
directions of multipliers split the sums, and normals have length one after each step (Liu, Li, Wang, Liu, Chen 2021,
with gradients of faces in place of their differences over lines).
"""

from dataclasses import dataclass

import numpy as np
from scipy import sparse

from bsm.codec.arrays import Floats, Positions
from bsm.codec.denoise.surface import Topology, follow_normals, pair_distances, shared_edges, unit
from bsm.codec.geometry.metrics import face_geometry, face_normals, mean_edge_length

FIRST, SECOND = 1.3, 0.65
"""The weights a1 and a0 of the two sums, over the mean difference between normals of neighboring noisy faces."""
SHARP = 1.0  # difference between normals from which on an edge is not smoothed
ROUNDS, SOLVER_STEPS, VERTEX_STEPS = 30, 4, 20  # each linear system starts from the last solution
LOOSE = 1e-4  # pull of gradients to zero, so that the system has one solution


@dataclass(frozen=True, eq=False)
class Jumps:
    """Differences over edges, of normals beyond their gradients and of the gradients, and the lengths of the edges."""

    first: sparse.csr_matrix
    second: sparse.csr_matrix
    lengths: Floats


def varied_little(
    noisy: Positions, places: Positions, topology: Topology, weight: float = 1.0
) -> Positions:
    """Return the positions, shape (n, 3), whose normals vary least; `places` are smoother ones, to measure on."""
    edge = mean_edge_length(noisy, topology.faces) or 1.0
    normals = smooth_normals(face_normals(noisy, topology.faces), places / edge, topology, weight)
    return follow_normals(noisy, topology, normals, VERTEX_STEPS)


def smooth_normals(noisy: Floats, places: Positions, topology: Topology, weight: float) -> Floats:
    """Return normals, shape (m, 3), of least energy; places are in mean edges."""
    jumps, areas = measure_jumps(places, topology), face_geometry(places, topology.faces).areas
    areas = areas / (areas.mean() or 1.0)
    noise = float(pair_distances(noisy, topology.pairs).mean()) if len(topology.pairs) else 0.0
    faces, edges = len(noisy), len(jumps.lengths)
    lengths = jumps.lengths / (jumps.lengths.mean() if edges else 1.0)
    first_back = (jumps.first.T @ sparse.diags(lengths)).tocsr()
    second_back = (jumps.second.T @ sparse.diags(np.repeat(lengths, 2))).tocsr()
    trust = np.concatenate([areas, np.full(2 * faces, LOOSE)])
    system = (sparse.diags(trust) + first_back @ jumps.first + second_back @ jumps.second).tocsr()
    unknowns = np.concatenate([noisy, np.zeros((2 * faces, 3))])
    pull = trust[:, None] * unknowns
    first, second = np.zeros((edges, 3)), np.zeros((2 * edges, 3))
    first_price, second_price = np.zeros_like(first), np.zeros_like(second)
    for _ in range(ROUNDS):
        apart = np.linalg.norm(jumps.first[:, :faces] @ unknowns[:faces], axis=1)
        smoothed = weight * noise * np.exp(-((apart / SHARP) ** 4))
        target = pull + first_back @ (first - first_price) + second_back @ (second - second_price)
        unknowns = _solved(system, target, unknowns)
        unknowns[:faces] = unit(unknowns[:faces], noisy)
        first_seen, second_seen = (
            jumps.first @ unknowns + first_price,
            jumps.second @ unknowns + second_price,
        )
        first = _shrunk(first_seen, FIRST * smoothed)
        # The six numbers of a gradient's jump shrink together, whichever way the axes lie.
        second = _shrunk(second_seen.reshape(edges, 6), SECOND * smoothed).reshape(2 * edges, 3)
        first_price, second_price = first_seen - first, second_seen - second
    return np.asarray(unknowns[:faces])


def measure_jumps(places: Positions, topology: Topology) -> Jumps:
    """Return the differences over the edges of a mesh."""
    hinges = shared_edges(places, topology)
    geometry, faces, edges = (
        face_geometry(places, topology.faces),
        len(topology.faces),
        len(hinges.pairs),
    )
    side = unit(places[topology.faces[:, 1]] - places[topology.faces[:, 0]])
    axes = side, np.cross(geometry.normals, side)
    across = geometry.centroids[hinges.pairs] - hinges.begin[:, None]
    along = np.einsum("eki,ei->ek", across, hinges.along)
    heights = np.linalg.norm(across - along[:, :, None] * hinges.along[:, None], axis=2)
    way = along[:, 1] - along[:, 0], heights.sum(axis=1)
    rows, columns, predicted, turned = np.arange(edges), [], [], []
    for face, sign in zip(hinges.pairs.T, (-1.0, 1.0), strict=True):
        # The edge in the axes of the face; the way across it is at right angles, from the first face to the second.
        x, y = (np.einsum("ei,ei->e", hinges.along, axis[face]) for axis in axes)
        for axis, (parallel, crossing) in enumerate(((x, y), (y, -x))):
            columns.append(2 * face + axis)
            predicted.append(-0.5 * (way[0] * parallel + way[1] * crossing))
            turned.append(sign * np.stack([parallel, crossing], axis=1).ravel())
    differences = sparse.csr_matrix(
        (np.repeat([-1.0, 1.0], edges), (np.tile(rows, 2), hinges.pairs.T.ravel())), (edges, faces)
    )
    where = np.tile(rows, 4), np.concatenate(columns)
    gradients = sparse.csr_matrix((np.concatenate(predicted), where), (edges, 2 * faces))
    where = np.tile(np.arange(2 * edges), 4), np.repeat(np.concatenate(columns), 2)
    second = sparse.csr_matrix((np.concatenate(turned), where), (2 * edges, 2 * faces))
    none = sparse.csr_matrix((2 * edges, faces))
    return Jumps(
        sparse.hstack([differences, gradients]).tocsr(),
        sparse.hstack([none, second]).tocsr(),
        hinges.lengths,
    )


def _solved(system: sparse.csr_matrix, target: Floats, start: Floats) -> Floats:
    """Go a few steps of conjugate gradients from the start, shape (k, 3), in an order that no turn changes."""
    diagonal = system.diagonal()[:, None]
    scale = 1.0 / np.where(diagonal > 0.0, diagonal, 1.0)  # 0: a face without area
    values, rest = start, target - system @ start
    way = scale * rest
    size = np.vdot(rest, way)
    for _ in range(SOLVER_STEPS):
        pushed = system @ way
        step = size / max(np.vdot(way, pushed), 1e-300)
        values, rest = values + step * way, rest - step * pushed
        eased = scale * rest
        size, last = np.vdot(rest, eased), size
        way = eased + size / max(last, 1e-300) * way
    return np.asarray(values)


def _shrunk(vectors: Floats, amount: Floats) -> Floats:
    """Return the vectors, shape (k, d), shorter by the amounts, shape (k,); zero where they are shorter than that."""
    lengths = np.linalg.norm(vectors, axis=1)
    share = np.maximum(1.0 - amount / np.maximum(lengths, 1e-300), 0.0)
    return np.asarray(share[:, None] * vectors)
