"""The temporal transform: a basis over time for the frames of a GOP, as it is learnt and coded, and frames of it.

Frames come in as trajectories, a row for each vertex. A group of frames is decomposed once (`Motion`): the few rows
that it is a product of stand for all vertices in everything that follows, so that the choice of GOPs and every attempt
at a step cost little beside the coding of levels. Principal components are the basis that needs fewest numbers for an
error (Alexa and Mueller, 2000); no cosine transform comes near it, because limbs move together. The price is that the
basis has to be sent. GOPs are therefore as long as they can be, but for cuts that pay: `lengths_of` weighs the bits of
fields against those of bases by how energies fall (the coding length of Ma, Derksen, Hong and Wright, 2007) and how
smooth motion is in time, and finds the cheapest lengths by dynamic programming; single cuts may not pay where two do.
It is an estimate, so that the encoder codes both ways once. Columns of a basis are orthogonal, and coded by their
degrees of freedom: the vectors of reflections (Householder, 1958). All choices here are the encoder's; what decoders
compute from levels is in `temporal.simd.c`.

References
----------
M. Alexa and W. Mueller, "Representing animations by principal components", 2000.
A. S. Householder, "Unitary triangularization of a nonsymmetric matrix", 1958.
Y. Ma, H. Derksen, W. Hong, J. Wright, "Segmentation of multivariate mixed data via lossy data coding and compression",
2007.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from itertools import pairwise

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
# Places where cuts are looked for at first; the share of costs with which they are worth it.
PLACES, CLEARLY = 12, 0.95
DENSE, SENT, BEGUN = 0.1, 11.0, 2_000.0
"""The share of vertices that have the energy of a component; the price of a bit of the basis over one of a field:
most levels of fields are zeros that others foretell; and bits of a field that a GOP takes besides. They fit the bytes
of dance, samba and made clips."""
FAINT, FINER = 1 / 64, 0.5
"""Rows of a motion with less than this share of the energy that a component is kept for are left out; and the share of
the step at which more of them count."""
MOST_ROWS = 256  # of a motion, by which lengths are chosen
# Of a column's length on the diagonal, at least: below 0 it would be another reflection.
LEAST = 1e-9
BATCH = _kernels.BATCH  # frames that are reconstructed at a time
# With a finer step the levels of a column of length one could not be coded.
FINEST_EXPONENT = OCTAVE * 23 - 1


@dataclass(frozen=True, eq=False)
class Motion:
    """Frames as the product of fields, shape (n, k), and their shapes over time, (k, d, T), as far as a step shows."""

    fields: Matrix
    shapes: Matrix
    finest: float


class Decomposition:
    """All principal components of frames, shape (T, n, d); the work of which steps share the dear part."""

    def __init__(self, frames: Matrix) -> None:
        self._frames = frames
        rows = trajectories(frames)
        # Of the two products the smaller one is decomposed. Both have the same energies.
        self._few = len(rows) < rows.shape[1]
        product = rows @ rows.T if self._few else rows.T @ rows
        # An eigenvalue problem of a few hundred rows instead of an SVD of all vertices.
        self._vectors, self._energies, _ = np.linalg.svd(product, hermitian=True)

    def motion(self, step: float) -> Motion:
        """Return the components that show at a step."""
        rows = trajectories(self._frames)
        count = int(np.count_nonzero(self._energies > FAINT * least_energy(rows.shape[1], step)))
        vectors, roots = (
            np.ascontiguousarray(self._vectors[:, :count]),
            np.sqrt(self._energies[:count]),
        )
        if self._few:
            fields, shapes = vectors, vectors.T @ rows
        else:
            fields, shapes = rows @ (vectors / roots), (vectors * roots).T
        shapes = np.ascontiguousarray(shapes).reshape(
            count, self._frames.shape[2], len(self._frames)
        )
        return Motion(fields, shapes, FINER * step)


def least_energy(columns: int, step: float) -> float:
    """The energy of a component with which it pays, of trajectories with so many columns."""
    return WORTH * columns * step**2


def lengths_of(motion: Motion, step: float) -> list[int]:
    """Lengths of GOPs in which frames take fewest bits, about: motion changes between them."""
    vertices, shapes = len(motion.fields), motion.shapes[:MOST_ROWS]
    frames = shapes.shape[2]

    @cache
    def bits(begin: int, end: int) -> float:
        part = shapes[..., begin:end]
        rows = part.reshape(len(part), part.shape[1] * part.shape[2])
        energies = np.linalg.eigvalsh(rows.T @ rows if len(rows) > rows.shape[1] else rows @ rows.T)
        strong = energies[energies > least_energy(rows.shape[1], step)]
        # The spectrum of a cosine transform by an FFT, without a matrix of cosines.
        # Its sines vanish, and cosines remain.
        there_and_back = np.concatenate([part, part[..., ::-1]], axis=2)
        smooth = np.square(np.abs(np.fft.rfft(there_and_back)[..., : end - begin])).sum(axis=0) / (
            2 * (end - begin)
        )
        fields = vertices * np.log2(1.0 + strong / (DENSE * vertices * step**2)).sum()
        basis = len(strong) * np.log2(1.0 + smooth / (max(1, len(strong)) * step**2)).sum()
        return float(fields + SENT * basis + BEGUN)

    def cheapest(places: list[int]) -> list[int]:
        """Return those of the places, from 0 to `frames`, between which bits are fewest."""
        ways: list[tuple[float, list[int]]] = [(0.0, [0])]
        for end in places[1:]:
            # The cheapest way to each place goes on from the cheapest way to an earlier one, since costs of parts just
            # add up.
            ways.append(min((cost + bits(cuts[-1], end), [*cuts, end]) for cost, cuts in ways))
        return ways[-1][1]

    stride = max(1, frames // PLACES)
    cuts = cheapest([*range(0, frames - stride + 1, stride), frames])
    # First coarsely and then around what was found: to price every pair of places would take cubic time.
    while len(cuts) > 2 and (stride := stride // 2):
        for at in range(1, len(cuts) - 1):
            low, middle, high = cuts[at - 1 : at + 2]
            candidates = (
                place for place in (middle, middle - stride, middle + stride) if low < place < high
            )
            cuts[at] = min(candidates, key=lambda place: bits(low, place) + bits(place, high))
        # Of two cuts beside a change, one is enough.
        between = ((low + high) // 2 for low, high in pairwise(cuts))
        cuts = cheapest(sorted({*cuts, *between}))
    # An estimate that is nearly even is noise, and one GOP is simpler.
    if sum(bits(*part) for part in pairwise(cuts)) >= CLEARLY * bits(0, frames):
        return [frames]
    return [end - begin for begin, end in pairwise(cuts)]


def learn_basis(motion: Matrix, step: float, limit: int) -> tuple[Matrix, npt.NDArray[np.int32]]:
    """Return eigenvectors of the covariance of trajectories, all coordinates coupled, and the exponents of steps."""
    # Then vertices have the smaller matrix, of the same energies.
    few = len(motion) < motion.shape[1]
    energies, vectors = np.linalg.eigh(motion @ motion.T if few else motion.T @ motion)
    count = int(np.count_nonzero(energies > least_energy(motion.shape[1], step)))
    strongest = energies[: -count - 1 : -1]
    # A column that multiplies much energy must be finer, in proportion to the root of it.
    exponents = np.round(OCTAVE * np.log2(np.sqrt(strongest) / (PRECISION * step)))
    columns = np.ascontiguousarray(vectors[:, : -count - 1 : -1])
    if few:
        columns = motion.T @ columns / np.sqrt(strongest)
    return columns, np.clip(exponents, 0, min(limit, FINEST_EXPONENT)).astype(np.int32)


def trajectories(frames: Matrix) -> Matrix:
    """Frames, shape (T, n, d), as a matrix of its own, shape (n, dT)."""
    frame_last = frames.transpose(1, 2, 0)
    matrix = np.empty(frame_last.shape)  # of a single frame, reshaping would give the frame itself
    # BLAS multiplies a matrix in order several times as fast as a view with strides.
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
    # LAPACK's raw form is the vectors of the reflections themselves: these are the degrees of freedom of orthonormal
    # columns.
    # Vectors are 1 on the diagonal, where lengths stand instead.
    packed, factors = np.linalg.qr(columns, mode="raw")
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
            field,
            first,
            weights.reshape(components, width * BATCH),
            frames_now.reshape(count * len(field), width),
        )
        yield from frames_now
