"""Who is near whom on a surface, and vertices that follow given normals."""

from dataclasses import dataclass

import numpy as np
from scipy import sparse

from bsm._core import codec as _kernels
from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Faces, Floats, Indices, Mask, Order, Positions
from bsm.codec.geometry.graph import Lists, edges_of, vertex_faces, vertex_neighbors
from bsm.codec.geometry.metrics import face_geometry, face_normals

CROWD = 64  # faces around a vertex from which on they are not near each other because of it
CROWDED = 16.0  # faces within a distance, over its square: about twice as many as there are of even triangles


@dataclass(frozen=True, eq=False)
class Topology:
    """Neighborhoods of faces; what not every filter needs is found when it is first asked for."""

    faces: Faces
    n: int

    def __post_init__(self) -> None:
        object.__setattr__(self, "faces", np.ascontiguousarray(self.faces, dtype=np.int32))

    @cached_property
    def around(self) -> Lists:
        return vertex_faces(self.faces, self.n)

    @cached_property
    def incidence(self) -> sparse.csr_matrix:
        """Ones where a face, the column, is around a vertex, the row."""
        starts, members = self.around
        return sparse.csr_matrix((np.ones(len(members)), members, starts), (self.n, len(self.faces)))

    def vertex_normals(self, positions: Positions) -> Floats:
        """Sums of the normals of the faces around each vertex, shape (n, 3)."""
        return np.asarray(self.incidence @ face_normals(positions, self.faces))

    @cached_property
    def neighbors(self) -> Lists:
        return vertex_neighbors(self.faces, self.n)

    @cached_property
    def patches(self) -> Lists:
        """Faces that share a vertex that is not crowded with each face, and itself."""
        calm = self.incidence[np.diff(self.around.starts) <= CROWD]
        patches = (calm.T @ calm + sparse.identity(len(self.faces))).tocsr()
        return Lists(patches.indptr.astype(np.int64), patches.indices.astype(np.int32))

    @cached_property
    def pairs(self) -> Indices:
        """Two faces that share an edge, shape (p, 2); where more than two meet, each with the next in order."""
        ends, edge, _ = self._edges
        order = np.argsort(edge, kind="stable")
        order = order[ends[order, 0] != ends[order, 1]]
        key, owner = edge[order], (order // 3).astype(np.int32)
        same = (key[1:] == key[:-1]) & (owner[1:] != owner[:-1])
        return np.stack([owner[:-1][same], owner[1:][same]], axis=1)

    @cached_property
    def inner(self) -> Lists:
        """For each patch, the rows of `pairs` of which both faces lie in it."""
        m, pairs, (starts, members) = len(self.faces), self.pairs, self.patches
        sides = sparse.csc_matrix(
            (np.ones(pairs.size, np.int8), pairs.ravel(), 2 * np.arange(len(pairs) + 1)), (m, len(pairs))
        )
        held = sparse.csr_matrix((np.ones(len(members), np.int8), members, starts), (m, m)) @ sides.tocsr()
        inner = (held == 2).tocsr()
        return Lists(inner.indptr.astype(np.int64), inner.indices)

    @cached_property
    def boundary(self) -> Mask:
        ends, _, uses = self._edges
        boundary = np.zeros(self.n, dtype=np.bool_)
        boundary[ends[(uses == 1) & (ends[:, 0] != ends[:, 1])]] = True
        return boundary

    @cached_property
    def _edges(self) -> tuple[Order, Order, Order]:
        return edges_of(self.faces)


def surroundings(positions: Positions, topology: Topology, radius: float) -> Lists:
    """Faces within a radius, in mean distances of adjacent centroids, of each face; of crowds only every n-th face."""
    most = int(CROWDED * radius**2)
    points = face_geometry(positions, topology.faces).centroids
    radius, count = radius * mean_centroid_distance(points, topology.pairs), len(points)
    starts, seen, reached = np.zeros(count + 1, np.int64), np.full(count, -1, np.int32), np.empty(33 * count, np.int32)
    done = 0
    while (done := _kernels.reach(points, topology.patches, radius, most, done, seen, starts, reached)) < count:
        # A row has at most as many members as there are faces; with room for one, the kernel goes on.
        reached = np.concatenate([reached, np.empty(len(reached) + count, np.int32)])
    return Lists(starts, reached[: starts[count]].copy())


def unit(vectors: Floats) -> Floats:
    """Rows of length one in the directions of those of `vectors`; zero where they are."""
    lengths = np.sqrt(np.einsum("ij,ij->i", vectors, vectors))
    return np.asarray(vectors / np.where(lengths > 0.0, lengths, 1.0)[:, None])


def surface_normals(positions: Positions, topology: Topology) -> Floats:
    """Unit vertex normals, shape (n, 3): the plain mean of those of the faces around."""
    return unit(topology.vertex_normals(positions))


def pair_distances(values: Floats, pairs: Indices) -> Floats:
    """How far the rows of `values`, shape (m, 3), that each of `pairs`, shape (e, 2), names are from each other."""
    apart = np.take(values, pairs[:, 0], axis=0) - np.take(values, pairs[:, 1], axis=0)
    return np.asarray(np.sqrt(np.einsum("ij,ij->i", apart, apart)))


def mean_centroid_distance(centroids: Floats, pairs: Indices) -> float:
    """Mean distance between the centroids, shape (m, 3), of faces that share an edge, `pairs`, shape (e, 2)."""
    if len(pairs) == 0:
        return 1.0
    return float(pair_distances(centroids, pairs).mean()) or 1.0


def follow_normals(
    positions: Positions, topology: Topology, normals: Floats, iterations: int, free: Mask | None = None
) -> Positions:
    """Move the vertices until the faces agree with given normals (Sun et al. 2007; equations 12 and 13 of the paper)"""
    moved = np.array(positions, dtype=np.float64)
    movable = np.ones(len(positions), np.uint8) if free is None else free.astype(np.uint8)
    heights = np.empty(len(topology.faces))
    _kernels.follow_normals(moved, topology.faces, topology.around, normals, iterations, movable, heights)
    return moved
