"""The temporal transform: a basis over time for the frames of a GOP, as it is learnt and coded, and frames of it.

Columns of a basis are orthogonal, and coded by their degrees of freedom: the vectors of reflections.

References
----------
A. S. Householder, "Unitary triangularization of a nonsymmetric matrix", 1958.
"""

from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

from bsm._core import codec as _kernels
from bsm.codec.arrays import Matrix
from bsm.codec.basis.orthogonal_iteration import cosine_columns

OCTAVE = 4  # exponents of the steps of a basis are in units of 1 / OCTAVE octaves
WORTH = 0.4
"""A component is kept if its energy is above WORTH * dT * step^2: below, it costs more than it brings. 0.35 and 0.5
cost 0.3 % more, 0.8 costs 1 %."""
PRECISION = 1.0
"""Error of a column of the basis, times the root of the energy that it multiplies, in steps. A bit of the basis and one
of the components are worth the same from 1 to 1.4; the finer, the less the error changes from frame to frame."""
PLACES, SENT, CLEARLY = 8, 0.05, 0.95
"""Places where a cut is looked for at first; bytes of one more component, in a vertex, over those of a number of the
basis; and the share of the numbers with which a cut is worth it."""
LEAST = 1e-9  # of a column's length on the diagonal, at least: below 0 it would be another reflection
BATCH = _kernels.BATCH  # frames that are reconstructed at a time
FINEST_EXPONENT = OCTAVE * 23 - 1  # with a finer step the levels of a column of length one could not be coded


def shapes_of(frames: Matrix) -> Matrix:
    """Frames, shape (T, n, d), by at most dT rows whose products over time are the same, shape (k, d, T)."""
    motion = trajectories(frames)
    if len(motion) > motion.shape[1]:
        _, energies, turns = np.linalg.svd(motion.T @ motion, hermitian=True)
        motion = np.sqrt(energies)[:, None] * turns
    return motion.reshape(len(motion), frames.shape[2], len(frames))


def lengths_of(shapes: Matrix, vertices: int, step: float) -> list[int]:
    """Lengths of GOPs in which frames, shape (k, d, T), need fewest numbers: motion changes between them."""
    frames = shapes.shape[2]

    def numbers(part: Matrix) -> float:
        rows = part.reshape(len(part), -1)
        columns = rows.shape[1]
        products = rows.T @ rows if len(rows) > columns else rows @ rows.T
        worth = WORTH * columns * step**2
        return float(np.count_nonzero(np.linalg.eigvalsh(products) > worth) * (columns + SENT * vertices))

    def cost(place: int) -> tuple[float, int]:
        return numbers(shapes[..., :place]) + numbers(shapes[..., place:]), abs(2 * place - frames)

    stride = frames // PLACES
    best = min(range(stride, frames - stride + 1, stride), key=cost) if stride > 1 else 0
    if not best or cost(best)[0] >= CLEARLY * numbers(shapes):
        return [frames]
    while stride := stride // 2:
        best = min((best - stride, best, best + stride), key=cost)
    parts = shapes[..., :best], shapes[..., best:]
    return [length for part in parts for length in lengths_of(part, vertices, step)]


def learn_basis(motion: Matrix, step: float, limit: int) -> tuple[Matrix, npt.NDArray[np.int32]]:
    """Return eigenvectors of the covariance of trajectories, all coordinates coupled, and the exponents of steps."""
    few = len(motion) < motion.shape[1]  # then vertices have the smaller matrix, of the same energies
    energies, vectors = np.linalg.eigh(motion @ motion.T if few else motion.T @ motion)
    count = int(np.count_nonzero(energies > WORTH * motion.shape[1] * step**2))
    kept = energies[: -count - 1 : -1]
    exponents = np.round(OCTAVE * np.log2(np.sqrt(kept) / (PRECISION * step)))
    columns = np.ascontiguousarray(vectors[:, : -count - 1 : -1])
    if few:
        columns = motion.T @ columns / np.sqrt(kept)
    return columns, np.clip(exponents, 0, min(limit, FINEST_EXPONENT)).astype(np.int32)


def trajectories(frames: Matrix) -> Matrix:
    """Frames, shape (T, n, d), as a matrix of its own, shape (n, dT)."""
    frame_last = frames.transpose(1, 2, 0)
    matrix = np.empty(frame_last.shape)  # of a single frame, reshaping would give the frame itself
    matrix[...] = frame_last
    return matrix.reshape(len(matrix), -1)


def time_cosines(frames: int) -> Matrix:
    """The orthonormal cosine transform (DCT-II), shape (T, T): row t, column frequency."""
    columns = cosine_columns(frames, frames) * np.sqrt(2.0 / frames)
    columns[:, :1] = np.sqrt(1.0 / frames)
    return np.asarray(columns)


def basis_steps(exponents: npt.NDArray[np.int32]) -> Matrix:
    """Quantization step of each component of a learnt basis, shape (r,): 2^(-exponent / OCTAVE)."""
    return np.asarray(np.exp2(-exponents / OCTAVE))


def spectrum_of(basis: Matrix, exponents: npt.NDArray[np.int32], width: int) -> Matrix:
    """Free parameters of a basis, shape (dT, r), d being `width`, as cosines over time in steps, shape (dT, r)."""
    rows, components = basis.shape
    cosines = time_cosines(rows // width).T @ basis.reshape(width, rows // width, components)
    free = free_of(cosines.transpose(1, 0, 2).reshape(rows, components)) / basis_steps(exponents)
    by_number = free.reshape(rows // width, width, components).transpose(1, 0, 2)
    return np.ascontiguousarray(by_number).reshape(rows, components)


def free_of(columns: Matrix) -> Matrix:
    """Free parameters of columns, shape (n, r) with r <= n: zeros above the diagonal, none negative on it."""
    if not columns.size:
        return columns.copy()
    packed, factors = np.linalg.qr(columns, mode="raw")  # vectors are 1 on the diagonal, where lengths stand instead
    lengths = np.diagonal(packed)
    # Of a diagonal that rounding has made 0 the length tells the sign: where it is reflected, it is the other one.
    negative = np.where(factors > 0.0, lengths > 0.0, lengths < 0.0)
    free = np.tril(packed.T, -1) * (-lengths * factors) * np.where(negative, -1.0, 1.0)
    np.fill_diagonal(free, np.maximum(np.abs(lengths * (1.0 - factors)), LEAST * np.abs(lengths)))
    return np.asarray(free)


def frames_of(field: Matrix, first: int, basis: Matrix) -> Iterator[Matrix]:
    """The frames, each of shape (n, d), of some columns of a field over a temporal basis."""
    width, frames, components = basis.shape
    for start in range(0, frames, BATCH):
        part = basis[:, start : start + BATCH]
        count = part.shape[1]
        weights = np.zeros((components, width, BATCH))
        weights[:, :, :count] = part.transpose(2, 0, 1)
        frames_now = np.empty((count, len(field), width))
        _kernels.show_frames(
            field, first, weights.reshape(components, width * BATCH), frames_now.reshape(count * len(field), width)
        )
        yield from frames_now
