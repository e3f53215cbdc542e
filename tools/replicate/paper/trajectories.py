"""A temporal basis that is followed from GOP to GOP by orthogonal iterations, beside the codec's eigenvectors.

After A. Lalos, A. Vasilakis, A. Dimas, K. Moustakas, "Adaptive compression of animated meshes by exploiting orthogonal
iterations" (2017), and G. Arvanitis, A. Lalos, K. Moustakas, "Fast spatio-temporal compression of dynamic 3D meshes".
The codec makes and codes the rest of a GOP. It sends each basis, so its decoder needs nothing else.
"""

import time
from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

import bsm
from bsm.codec.arrays import Faces, Positions
from bsm.codec.basis.orthogonal_iteration import cosine_columns
from bsm.codec.sequence import run_encoding, temporal
from bsm.codec.sequence.encoder import SequenceEncoder
from bsm.codec.sequence.options import SequenceOptions
from bsm.codec.sequence.targets import compare_sequences
from tools.replicate.ablation import Tool
from tools.replicate.motion import Moving, sequences
from tools.replicate.paper.dictionaries import Floats
from tools.replicate.paper.iterations import householder, span
from tools.replicate.paper.models import NAMED, Study
from tools.replicate.paper.published import Line, printed
from tools.replicate.rates import Row

POWERS = {"eigh": 0, "OI, A": 1, "OI, A^2": 2}
LENGTHS, STEP, MOST = (8, 48), 0.002, 144
"""Frames of a GOP, the step of all frames, and the largest number of frames of a sequence that are taken."""
learn_basis = temporal.learn_basis


class Followed:
    """A basis from the covariance A of trajectories: one iteration of A^z from the basis before, of as many rows."""

    def __init__(self, power: int) -> None:
        self._power, self._basis, self._kept, self.seconds = power, np.empty((0, 0)), 0, 0.0

    def basis(
        self, motion: Floats, step: float, limit: int
    ) -> tuple[Floats, npt.NDArray[np.int32]]:
        """In place of `learn_basis`, of trajectories or of rows with the same covariance."""
        energies, columns = self._eigenvectors(motion.T @ motion)
        return learn_basis((columns * np.sqrt(energies.clip(0.0))).T, step, limit)

    def _eigenvectors(self, covariance: Floats) -> tuple[Floats, Floats]:
        """Energies, rising, and their columns; those that are left out are below what the codec keeps."""
        begin = time.thread_time()
        follows = self._power and len(self._basis) == len(covariance)
        energies, basis = self._iterated(covariance) if follows else np.linalg.eigh(covariance)
        order = np.argsort(energies)
        energies, basis = energies[order], basis[:, order]
        self._basis, self._kept = (
            basis[:, ::-1],
            int(np.count_nonzero(energies > temporal.least_energy(len(covariance), STEP))),
        )
        self.seconds += time.thread_time() - begin
        return energies, basis

    def _iterated(self, covariance: Floats) -> tuple[Floats, Floats]:
        rows, width = len(covariance), self._kept + self._kept // 4 + 8
        while True:
            width = min(width, rows)
            columns = np.hstack([self._basis, cosine_columns(rows, width)])[:, :width]
            for _ in range(self._power):
                columns = covariance @ columns
            columns = householder(columns)
            energies = (columns * (covariance @ columns)).sum(axis=0)
            if width == rows or energies[-1] < temporal.least_energy(rows, STEP):
                return energies, columns
            width *= 2


def moving_meshes(study: Study) -> list[Moving]:
    """Named meshes, which bend; otherwise some sequences that are made, and those of the folder."""
    named = [source for source in study.sources if source.group == NAMED]
    if named:
        return [Moving(f"{source.name}, bent", source) for source in named]
    return sequences([], study.folder, quick=False)[-1 if study.quick else -4 :]


def measured(frames: Positions, faces: Faces, length: int, power: int) -> tuple[float, ...]:
    """kB, KG error in percent, seconds of a thread for bases, and for the whole encoder."""
    encoder = SequenceEncoder(faces, SequenceOptions(threads=1, gop=length, step=STEP), len(frames))
    followed, begin = Followed(power), time.thread_time()
    uncut = run_encoding, "lengths_of", lambda motion, _: [motion.shapes.shape[2]]
    learnt = temporal, "learn_basis", followed.basis
    with Tool({}, [learnt, uncut]).left_out():
        data = b"".join(encoder.chunks(frames))
    seconds = time.thread_time() - begin
    decoded, coded = bsm.decode_sequence(data, threads=1)
    error = compare_sequences(frames[:, encoder.vertex_order], decoded, coded).kg
    return 1e-3 * len(data), error, followed.seconds, seconds


def temporal_basis(study: Study) -> Iterator[Row]:
    """Bytes, error and time of sequences with either basis."""
    rows, more, slower, share = list[Line](), list[float](), list[float](), 0.0
    for moving in moving_meshes(study):
        frames, faces = moving.frames(2 * LENGTHS[0] if study.quick else MOST)
        for length in LENGTHS:
            if 2 * length > len(frames):
                continue
            found = [measured(frames, faces, length, power) for power in POWERS.values()]
            name = f"{moving.name}, GOPs of {length}"
            rows += [(f"{name}, {way}", own, ()) for way, own in zip(POWERS, found, strict=True)]
            exact, *others = found
            more += [100 * (own[0] / exact[0] - 1.0) for own in others]
            slower += [own[2] / exact[2] for own in others]
            share = max(share, 100 * exact[2] / exact[3])
    yield printed(
        "The paper, 7.3: a temporal basis that follows from GOP to GOP",
        ("kB", "KG, %", "s for bases", "s to encode"),
        rows,
        "Trajectories' covariance A: eigh for each GOP, or one orthogonal iteration of A or A^2 from the basis of the "
        "GOP before (the first by eigh). The codec quantizes and sends either basis, and codes the rest; one step, no "
        "cuts; longer GOPs only where a sequence has two. Seconds of one thread. OI changes bytes by "
        f"{span(more)} % and takes {span(slower)} times the time of eigh, which is at most {share:.1f} % of encoding.",
        numbers={"more": span(more), "slower": span(slower), "share": f"{share:.1f}"},
    )
