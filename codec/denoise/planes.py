"""Flat is flat: planes that explain a noisy surface, and vertices put on them.

Faces of a filtered mesh are joined to regions, the most alike first, as long as their normals are alike, or one plane
explains the noisy vertices of both as well as two planes do. A region is a plane if its noisy vertices deny that it is
bent: the best quadratic through them turns normals by little, even if chance has hidden some of it. Vertices are put on
the planes of the faces around them: on one, on the edge between two, or on the corner where more meet. All lengths are
in levels of the noise.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy import sparse

from bsm.codec.arrays import Floats, Indices, Order, Positions
from bsm.codec.denoise.surface import Topology, unit
from bsm.codec.geometry.metrics import face_geometry

ALIKE = 0.15  # distance of the mean normals of regions up to which they are joined
SAME_PLANE = 20.0  # what one plane may explain less well than two
FEWEST = 30.0  # vertices of a plane
BENT = 0.05  # how far a plane may turn normals
# Of a vertex's own place against planes, so that nearly equal planes have no edge far away.
FIRM = 1e-3


@dataclass(frozen=True, eq=False)
class Planes:
    """Planes ``normals @ x = heights``, and the plane of each face, shape (m,), or -1."""

    labels: Order
    normals: Floats
    heights: Floats

    @property
    def share(self) -> float:
        """The share of the faces that lie on planes."""
        return float((self.labels >= 0).mean())

    def put(self, positions: Positions, topology: Topology) -> Positions:
        """Positions, shape (n, 3), on the planes of the faces around them."""
        owners = np.repeat(np.arange(topology.n), np.diff(topology.around.starts))
        labels = self.labels[topology.around.members]
        count = max(len(self.heights), 1)
        # Each plane counts once for a vertex, however many of its faces are around.
        owner, label = np.divmod(np.unique((owners * count + labels)[labels >= 0]), count)
        normals = self.normals[label]
        off = np.einsum("ij,ij->i", normals, positions[owner]) - self.heights[label]
        square = _sums(
            (normals[:, :, None] * normals[:, None, :]).reshape(-1, 9), owner, topology.n
        )
        way = _sums(off[:, None] * normals, owner, topology.n)
        moves = np.linalg.solve(square.reshape(-1, 3, 3) + FIRM * np.eye(3), way[:, :, None])
        return np.asarray(positions - moves[:, :, 0])


def find_planes(noisy: Positions, filtered: Positions, level: float, topology: Topology) -> Planes:
    """Planes of a noisy mesh, shape (n, 3), whose noise has this level; `filtered`, shape (n, 3), shows where."""
    middle = noisy.mean(axis=0)
    search = PlaneSearch((noisy - middle) / level, filtered, topology)
    planes = search.flat(search.planes(search.regions()))
    return replace(planes, heights=planes.heights * level + planes.normals @ middle)


class PlaneSearch:
    """Noisy positions, shape (n, 3), and filtered ones, which show where planes are."""

    def __init__(self, noisy: Positions, filtered: Positions, topology: Topology) -> None:
        self._noisy, self._topology = noisy, topology
        _, self._areas, self._normals = face_geometry(filtered, topology.faces)
        # Of a vertex in each face around it.
        self._shares = 1.0 / np.maximum(np.diff(topology.around.starts), 1)
        ones = np.concatenate([np.ones((len(noisy), 1)), noisy], axis=1)
        moments = self._shares[:, None] * (ones[:, :, None] * ones[:, None, :]).reshape(-1, 16)
        self._moments = moments[topology.faces].sum(axis=1)

    def regions(self) -> Order:
        """Label each face, shape (m,): the same for those that one plane explains."""

        def turned(sums: Floats, pairs: Order) -> Floats:
            apart, areas = (
                np.linalg.norm(np.subtract(*unit(sums[:, :3])[pairs.T]), axis=1),
                sums[pairs, 3],
            )
            return np.where(
                apart < ALIKE, areas.prod(axis=1) / (areas.sum(axis=1) + 1e-300) * apart**2, np.inf
            )

        def explained(moments: Floats, pairs: Order) -> Floats:
            more = _fitted(moments[pairs].sum(axis=1))[2] - _fitted(moments)[2][pairs].sum(axis=1)
            return np.where(more < SAME_PLANE, more, np.inf)

        sums = np.concatenate([self._normals * self._areas[:, None], self._areas[:, None]], axis=1)
        labels = _joined(np.arange(len(sums)), sums, self._topology.pairs, turned)
        return _joined(labels, self._moments, self._topology.pairs, explained)

    def planes(self, labels: Order) -> Planes:
        """The planes of labelled faces, shape (m,); regions of few vertices have none."""
        count = int(labels.max(initial=-1)) + 1
        moments = _sums(self._moments, labels, count)
        large = moments[:, 0] >= FEWEST
        labels = np.append(np.where(large, np.cumsum(large) - 1, -1), -1)[labels]
        normals, heights, _ = _fitted(moments[large])
        back = np.einsum("ij,ij->i", _sums(self._normals, labels, len(normals)), normals) < 0.0
        normals[back], heights[back] = -normals[back], -heights[back]
        return Planes(labels, normals, heights)

    def flat(self, planes: Planes) -> Planes:
        """Return those planes that are not bent."""
        labels = planes.labels.copy()
        for label, normal in enumerate(planes.normals):
            chosen = planes.labels == label
            if self._bent(self._topology.faces[chosen].ravel(), normal) >= BENT:
                labels[chosen] = -1
        return replace(planes, labels=labels)

    def _bent(self, corners: Order, normal: Floats) -> float:
        """How far the best quadratic through noisy vertices, shape (k,), turns normals, and by chance might, too."""
        share = self._shares[corners]
        apart = self._noisy[corners] - np.average(self._noisy[corners], axis=0, weights=share)
        height, *sides = np.linalg.svd(normal[None])[2] @ apart.T
        wide = np.sqrt(np.average(np.square(sides).sum(axis=0), weights=share))
        (u, v), zero = sides / wide, np.zeros(len(corners))
        terms = np.stack([np.ones(len(corners)), u, v, u * u, u * v, v * v], axis=1)
        inverse = np.linalg.pinv(terms.T @ (share[:, None] * terms), hermitian=True)
        fit = (inverse @ (terms.T @ (share * height)))[3:]
        slopes = np.stack([[2.0 * u, v, zero], [zero, u, 2.0 * v]]) / wide
        turns = (slopes * share) @ slopes.transpose(0, 2, 1) / share.sum()
        chance = (
            np.average(height * height, weights=share) * (turns.sum(axis=0) * inverse[3:, 3:]).sum()
        )
        return float(np.sqrt(max(fit @ turns.sum(axis=0) @ fit - chance, 0.0)) + np.sqrt(chance))


def _fitted(moments: Floats) -> tuple[Floats, Floats, Floats]:
    """Normals and heights of the planes through groups with these moments, shape (k, 16), and squared distances."""
    moments = moments.reshape(-1, 4, 4)
    counts = np.maximum(moments[:, :1, 0], 1e-9)
    means = moments[:, 0, 1:] / counts
    values, vectors = np.linalg.eigh(
        moments[:, 1:, 1:] - moments[:, 0, 1:, None] * means[:, None, :]
    )
    normals = vectors[:, :, 0]
    return normals, np.einsum("ij,ij->i", normals, means), values[:, 0]


def _sums(values: Floats, labels: Order, count: int) -> Floats:
    """Sums of the rows, shape (k, d), of each label from 0 on, shape (count, d)."""
    chosen = np.flatnonzero(labels >= 0)
    return np.asarray(
        sparse.csr_matrix((np.ones(len(chosen)), (labels[chosen], chosen)), (count, len(labels)))
        @ values
    )


def _joined(
    labels: Order, values: Floats, pairs: Indices, costs: Callable[[Floats, Order], Floats]
) -> Order:
    """Join regions that are each other's cheapest neighbor, round by round, until all costs are infinite."""
    sums, beside = _sums(values, labels, int(labels.max(initial=-1)) + 1), labels[pairs]
    while True:
        beside = np.sort(beside, axis=1)
        beside = np.unique(beside[beside[:, 0] != beside[:, 1]], axis=0)
        cost = costs(sums, beside)
        beside, cost = beside[np.isfinite(cost)], cost[np.isfinite(cost)]
        if not len(beside):
            return labels
        rank = np.argsort(np.argsort(cost, kind="stable"))  # no two are equal
        best = np.full(len(sums), len(rank))
        for side in beside.T:
            np.minimum.at(best, side, rank)
        joined = beside[(rank == best[beside[:, 0]]) & (rank == best[beside[:, 1]])]
        number = np.arange(len(sums))
        number[joined[:, 1]] = joined[:, 0]
        number = np.unique(number, return_inverse=True)[1].ravel()
        sums, labels, beside = (
            _sums(sums, number, int(number.max()) + 1),
            number[labels],
            number[beside],
        )
