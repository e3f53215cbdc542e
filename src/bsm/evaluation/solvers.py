"""Every way to the low-frequency subspace of a block that a user has, checked and timed against orthogonal iterations.

Times are CPU seconds of one thread, the least of several runs; answers are checked before anything is timed.
"""

from __future__ import annotations

import math
import time
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy.linalg
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import LinearOperator, eigsh, lobpcg, splu
from threadpoolctl import threadpool_limits

from bsm.bitstream.errors import NumericError
from bsm.codec.basis.laplacian import dense_laplacian, factorize, laplacian_of
from bsm.codec.basis.orthogonal_iteration import cosine_columns, hash_columns, orthogonal_iteration
from bsm.codec.blocks.blend import Blend, degree_weights
from bsm.codec.blocks.overlap import Block, Blocks, block_size, grow_blocks
from bsm.codec.blocks.partition import derive_partition
from bsm.codec.geometry.graph import graph_of_faces
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.metrics import Reference

Matrix = npt.NDArray[np.float64]

SHIFT = 0.125
_BLOCK_VERTICES, _OVERLAP = 500, 1.15


@dataclass(frozen=True)
class Solver:
    """An eigensolver for the `width` lowest eigenvectors of a dense Laplacian, shape (n, width)."""

    name: str
    solve: Callable[[Matrix, int], Matrix]
    tolerance: float = 1e-8
    whole: bool = False


def _svd(laplacian: Matrix, width: int) -> Matrix:
    return np.linalg.svd(laplacian)[0][:, ::-1][:, :width]


def _shifted(laplacian: Matrix) -> csc_matrix:
    return csc_matrix(laplacian + SHIFT * np.eye(len(laplacian)))


def _arpack(laplacian: Matrix, width: int) -> Matrix:
    start = hash_columns(len(laplacian), 1)[:, 0]
    vectors: Matrix = eigsh(csc_matrix(laplacian), width, sigma=-SHIFT, which="LM", v0=start)[1]
    return vectors


def _lobpcg(laplacian: Matrix, width: int) -> Matrix:
    inverse = splu(_shifted(laplacian))
    preconditioner = LinearOperator(laplacian.shape, inverse.solve, matmat=inverse.solve)
    start = cosine_columns(len(laplacian), 0, width)
    with warnings.catch_warnings():
        # It says so where it does not get below `tol`, and where it takes a dense solver (more than n / 5 columns).
        warnings.simplefilter("ignore", UserWarning)
        vectors: Matrix = lobpcg(csc_matrix(laplacian), start, M=preconditioner, tol=1e-4, maxiter=60, largest=False)[1]
        return vectors


EXACT = (
    Solver("numpy svd, full", _svd, whole=True),
    Solver("numpy eigh", lambda a, c: np.linalg.eigh(a)[1][:, :c], whole=True),
    Solver("scipy eigh, evd", lambda a, c: scipy.linalg.eigh(a, driver="evd")[1][:, :c], whole=True),
    Solver("scipy eigh, evr, subset", lambda a, c: scipy.linalg.eigh(a, subset_by_index=[0, c - 1])[1]),
    Solver("ARPACK, shift-invert", _arpack),
    Solver("LOBPCG, preconditioned", _lobpcg, tolerance=1e-4),
)
POWERS = (1, 2, 4)


@dataclass(frozen=True)
class Timing:
    """What the dictionaries of all blocks of a mesh cost."""

    solver: str
    keep: float
    columns: int
    seconds: float
    nmsve_db: float
    exact: bool


def time_solvers(mesh: TriangleMesh, keeps: Sequence[float], sample: int, repeats: int) -> list[Timing]:
    """Check, then time, all solvers on the blocks of a mesh."""
    graph = graph_of_faces(mesh.faces, len(mesh.positions))
    partition = derive_partition(graph, max(1, round(graph.size / _BLOCK_VERTICES)))
    size = block_size(partition, _OVERLAP)
    blocks = grow_blocks(graph, partition, size)
    setting = _Setting(mesh, blocks, [blocks.block(i) for i in range(blocks.count)], sample, repeats)
    with threadpool_limits(1):
        wholes = {s.name: setting.exact_seconds(s, max(1, round(max(keeps) * size))) for s in EXACT if s.whole}
        return [timing for keep in keeps for timing in setting.timings(keep, max(1, round(keep * size)), wholes)]


@dataclass(frozen=True, eq=False)
class _Setting:
    mesh: TriangleMesh
    blocks: Blocks
    ordered: list[Block]
    sample: int
    repeats: int

    def timings(self, keep: float, width: int, wholes: dict[str, float]) -> list[Timing]:
        eigenvectors = [np.linalg.eigh(dense_laplacian(block))[1][:, :width] for block in self.ordered]
        exact_db = self._nmsve_db(eigenvectors)
        found = []
        for solver in EXACT:
            seconds = wholes.get(solver.name) or self.exact_seconds(solver, width)
            found.append(Timing(solver.name, keep, width, seconds, exact_db, exact=True))
        for power in POWERS:
            seconds, bases = self._iterate(width, power)
            found.append(Timing(f"OI, R^{power}", keep, width, seconds, self._nmsve_db(bases), exact=False))
        return found

    def exact_seconds(self, solver: Solver, width: int) -> float:
        step = max(1, len(self.ordered) // self.sample)
        chosen = [dense_laplacian(block) for block in self.ordered[::step][: self.sample]]
        for laplacian in chosen:
            check_lowest(solver, laplacian, min(width, len(laplacian) - 1))

        def work() -> None:
            for laplacian in chosen:
                solver.solve(laplacian, min(width, len(laplacian) - 1))

        return least_time(work, self.repeats) * len(self.ordered) / len(chosen)

    def _iterate(self, width: int, power: int) -> tuple[float, list[Matrix]]:
        starts = {size: cosine_columns(size, 0, min(width, size)) for size in {b.size for b in self.ordered}}

        def dictionary(index: int) -> Matrix:
            block = self.blocks.block(index)
            factor = factorize(laplacian_of(block), SHIFT)
            return orthogonal_iteration(factor, starts[block.size], power=power, iterations=1)

        def work() -> None:
            for index in range(self.blocks.count):
                dictionary(index)

        check_iteration(self.ordered[0], starts[self.ordered[0].size], power)
        return least_time(work, self.repeats), [dictionary(index) for index in range(self.blocks.count)]

    def _nmsve_db(self, bases: list[Matrix]) -> float:
        positions = self.mesh.positions
        blend = Blend(len(positions))
        for block, basis in zip(self.ordered, bases):
            projected = basis @ (basis.T @ positions[block.vertices])
            blend.add(block.vertices, projected, degree_weights(block.degrees))
        reference = Reference(positions, self.mesh.faces)
        return reference.compare(blend.positions(np.arange(len(positions), dtype=np.int32))).nmsve_db


def check_lowest(solver: Solver, laplacian: Matrix, width: int) -> None:
    """Check that a solver's columns are orthonormal and span the lowest eigenspace (Ky Fan's minimum of the trace)."""
    basis = solver.solve(laplacian, width)
    if not np.allclose(basis.T @ basis, np.eye(width), atol=1e-6):
        raise NumericError(f"{solver.name}: the columns are not orthonormal")
    least = np.linalg.eigvalsh(laplacian)[:width].sum()
    excess = np.einsum("ij,ij->", basis, laplacian @ basis) - least
    if not abs(excess) <= solver.tolerance * max(1.0, least):
        raise NumericError(f"{solver.name}: the trace is {excess:g} above the sum of the lowest eigenvalues")


def check_iteration(block: Block, start: Matrix, power: int) -> None:
    """Check an orthogonal iteration against dense solves and Householder reflections."""
    found = orthogonal_iteration(factorize(laplacian_of(block), SHIFT), start, power=power, iterations=1)
    columns = start
    for _ in range(power):
        # Orthonormalised every time: the same subspaces in exact arithmetic, and no loss of precision.
        columns = np.linalg.qr(np.linalg.solve(dense_laplacian(block) + SHIFT * np.eye(block.size), columns))[0]
    aligned = columns * np.where(np.einsum("ij,ij->j", columns, found) < 0, -1.0, 1.0)
    difference = float(np.abs(aligned - found).max())
    if not difference < 1e-6:
        raise NumericError(f"R^{power}: the dictionary differs by {difference:g} from that of dense solvers")


def least_time(work: Callable[[], object], repeats: int) -> float:
    """CPU seconds of this thread, the least of `repeats` runs."""
    least = math.inf
    for _ in range(repeats):
        begin = time.thread_time()
        work()
        least = min(least, time.thread_time() - begin)
    return least
