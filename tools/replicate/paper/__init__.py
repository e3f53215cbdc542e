"""The paper's experiments, measured again: beside each number, in brackets, the one that the paper prints.

Arvanitis, Lalos, Moustakas, "Block-Based Spectral Processing of Static and Dynamic 3D Meshes using Orthogonal
Iterations". Its models are those of BSM_MESHES, where they are there; a fetched mesh may stand in, and is not judged.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from tools.replicate.fetch import Source
from tools.replicate.paper import (
    coherence,
    compression,
    denoising,
    dynamic,
    iterations,
    segments,
    trajectories,
)
from tools.replicate.paper.models import Study
from tools.replicate.paper.parts import parts
from tools.replicate.rates import Row

TABLES: dict[str, Callable[[Study], Iterator[Row]]] = {
    made.__name__.replace("_", "-"): made
    for made in (
        compression.basis,
        compression.rate_and_error,
        compression.speed,
        compression.better,
        dynamic.dynamic,
        iterations.warm_start,
        iterations.iterations_or_powers,
        iterations.first_block,
        iterations.convergence,
        iterations.orthonormalization,
        iterations.complexity,
        iterations.shifts,
        segments.edge_effect,
        segments.number_of_segments,
        segments.overlap,
        parts,
        coherence.coherence,
        denoising.times,
        denoising.large,
        denoising.powers,
        denoising.rivals,
        denoising.fewer_iterations,
        denoising.coarse_to_fine,
        trajectories.temporal_basis,
    )
}


@dataclass(frozen=True)
class Job:
    """One of `TABLES` that is to be made, with a folder for its pictures."""

    name: str
    folder: Path | None
    sources: Sequence[Source]
    quick: bool
    output: Path | None = None


def make_tables(job: Job) -> list[Row]:
    """The tables of one job."""
    return list(TABLES[job.name](Study(job.folder, job.sources, job.quick, job.output)))
