"""Encode meshes and sequences for `bsm encode` and `bsm.encode_many`."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from itertools import count
from typing import TYPE_CHECKING, Any

from bsm.bitstream.errors import OptionError, counted
from bsm.codec.arrays import Order, Positions
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.comparison import write_permutation
from bsm.console import Console, Progress, finite
from bsm.files.mesh import read_mesh
from bsm.files.motion.frames import Frames, Wanted, describe_runs
from bsm.files.output import open_output, refuse_to_overwrite
from bsm.files.pipes import size_of
from bsm.files.sequence import open_frames, open_sequence
from bsm.jobs.provenance import with_provenance
from bsm.jobs.task import Facts, Task, came_to
from bsm.lengths import in_own_unit
from bsm.libraries import PROVENANCE, with_metadata
from bsm.options import encode_options, sequence_options

if TYPE_CHECKING:
    from bsm.codec.sequence.options import SequenceOptions

READ = 0.08  # of the time of a mesh
_OF_SEQUENCES = ("kg", "bpvf", "gop", "low_delay", "frame_rate", "runs")
"""Options that only sequences have; with them a GLB is read as a sequence."""


@dataclass(frozen=True, kw_only=True)
class EncodeJob(Task):
    """The task of `bsm encode`; `options` are keywords of `bsm.options`."""

    format: str | None = None
    permutation: str | None = None
    metadata: Mapping[str, str] = field(default_factory=dict)
    options: Mapping[str, Any] = field(default_factory=dict)
    threads: int | None = None
    members: tuple[str, ...] = ()
    animation: str | None = None
    cache_mesh: str | None = None
    provenance: bool | None = None


def encode_one(job: EncodeJob, console: Console) -> Facts:
    for path in filter(None, (job.output, job.permutation)):
        refuse_to_overwrite(path, job.may_replace(path))
    runs = bool(job.options.get("runs"))
    if job.members:
        return _encode_sequence(job, console, open_frames(job.members, job.format, runs=runs))
    asked = (job.animation, job.cache_mesh, *(job.options.get(name) for name in _OF_SEQUENCES))
    wanted = Wanted(job.options.get("frame_rate") or 0.0, job.animation or "", job.cache_mesh, runs)
    plain = all(choice is None for choice in asked)
    sequence = open_sequence(job.input, job.format, None if plain else wanted)
    return _encode_sequence(job, console, sequence) if sequence else _encode_mesh(job, console)


def _encode_mesh(job: EncodeJob, console: Console) -> Facts:
    from bsm.codec.static.encoder import Encoder

    for name, given in (("animation", job.animation), ("mesh", job.cache_mesh)):
        if given is not None:
            raise OptionError(f"--{name} is for sequences; this is a single mesh")
    chosen = encode_options(**job.options, threads=job.threads)
    with console.progress("reading", until=READ):
        source = read_mesh(job.input, job.format)
    mesh = with_metadata(source.mesh, chosen, job.metadata)
    if lengths := in_own_unit(job.options, mesh.metadata):
        chosen = encode_options(**{**job.options, **lengths}, threads=job.threads)
    begin = time.perf_counter()
    known, generations = with_provenance(mesh.metadata, job.provenance, job.input, job.options, chosen)
    mesh = replace(mesh, metadata=known)
    encoder = Encoder(mesh, chosen)
    overwrite = job.may_replace(job.output)
    with open_output(job.output, overwrite=overwrite) as file, console.progress("encoding") as progress:
        result = encoder.result(progress)
        for chunk in result.frames:
            file.write(chunk)
    seconds = time.perf_counter() - begin
    images = sum(len(value) for value in mesh.metadata.values() if isinstance(value, bytes))
    left_out = source.mesh.metadata.keys() - mesh.metadata.keys() - {PROVENANCE}
    notes = [
        *source.notes,
        *generations,
        *encoder.notes,
        *(["left out: materials, images"] if left_out else []),
        *([f"{images} bytes are unchanged images"] if images else []),
        *([f"no look is promised; measured: {encoder.seen(result)}"] if chosen.looks_as_it_comes else []),
    ]
    vertices, faces, size, error = result.header.vertices, len(encoder.mesh.faces), result.size, result.comparison
    taken, bpv = size_of(job.input), 8 * (size - images) / vertices
    promise = chosen.promise
    look = "" if promise is None or encoder.look is None else f"look {encoder.look:.2f} of {promise.look:g}, "
    _finish(
        job,
        console,
        notes,
        encoder.vertex_order,
        f"{counted(vertices=vertices, faces=faces)}, {came_to(taken, size)}, "
        f"{bpv:.2f} bits per vertex{' without images' if images else ''}; {look}largest vertex error "
        f"{100 * error.max_error_relative:.3g} % of the diagonal, mean normal error {error.angle_deg:.2f} degrees; "
        f"{seconds:.2f} s",
    )
    counts = {"vertices": vertices, "faces": faces}
    sizes = {"input_bytes": taken, "output_bytes": size, "bytes": size, "bpv_total": bpv}
    angles = {"theta_deg": error.theta_deg, "angle_deg": error.angle_deg, "nmsve_db": finite(error.nmsve_db)}
    ends = {"max_error_relative": error.max_error_relative, "look": encoder.look, "seconds": seconds, "notes": notes}
    return {"input": job.input, "output": job.output, **counts, **sizes, **angles, **ends}


def _encode_sequence(job: EncodeJob, console: Console, source: Frames) -> Facts:
    """Encode one sequence; write each GOP as soon as its frames have arrived."""
    from bsm.codec.sequence.encoder import SequenceEncoder

    begin = time.perf_counter()
    chosen = sequence_options(**{"keep_order": source.rigged > 0, **job.options}, threads=job.threads)
    source = source.on_sorted_faces() if source.rigged and chosen.keep_order else source
    if job.permutation and chosen.runs:
        raise OptionError("--permutation is the order of one mesh; with --runs the faces change")
    rate = {"frame_rate": source.frame_rate} if source.frame_rate else {}
    entries = {**source.metadata, **rate, **job.metadata}
    metadata, generations = with_provenance(entries, job.provenance, job.input, job.options, chosen)
    encoder = SequenceEncoder(source.faces, chosen, source.count, metadata, source.attributes)
    numbers, size = count(), 0
    overwrite = job.may_replace(job.output)
    with open_output(job.output, overwrite=overwrite) as file, console.progress("encoding") as progress:
        frames = source.frames if source.meshes is None else source.meshes
        given = _staged(zip(frames, numbers), source.count, chosen, progress)
        for chunk in encoder.chunks(given, progress):
            size += file.write(chunk)
            file.flush()
    seconds = time.perf_counter() - begin
    runs = encoder.run_starts[1:]
    notes = [*source.notes, *generations, *encoder.notes, *([describe_runs(runs)] if runs else [])]
    look, seen = math.inf if chosen.promise is None else chosen.promise.look, encoder.worst_look
    if look == math.inf and seen is not None:
        notes.append(f"no look is promised; measured: look {seen:.2g} in the worst frame (the default keeps 1)")
    kept = "" if seen is None or look == math.inf else f"look {seen:.2f} of {look:g} in the worst frame, "
    done, vertices, faces = next(numbers), len(encoder.vertex_order), len(encoder.face_order)
    bpvf = 8 * size / encoder.samples
    taken = sum(size_of(name) or 0 for name in job.members) if job.members else size_of(job.input)
    _finish(
        job,
        console,
        notes,
        encoder.vertex_order,
        f"{counted(frames=done)} of {counted(vertices=vertices, faces=faces)}{' at the end' if runs else ''}, "
        f"{came_to(taken, size)}, {bpvf:.3f} bits per vertex and frame; {kept}"
        f"KG error {encoder.kg:.3g} %; {seconds:.2f} s",
    )
    counts = {"input": job.input, "output": job.output, "frames": done, "vertices": vertices, "faces": faces}
    sizes = {"input_bytes": taken, "output_bytes": size, "bytes": size, "bpvf_total": bpvf}
    return {**counts, **sizes, "kg": finite(encoder.kg), "seconds": seconds, "notes": notes}


def _finish(job: EncodeJob, console: Console, notes: list[str], order: Order, summary: str) -> None:
    for note in notes:
        console.note(f"{job.input}: {note}")
    if job.permutation:
        write_permutation(job.permutation, order, overwrite=job.force)
    console.note(f"{job.input} -> {job.output}: {summary}")


def _staged(
    frames: Iterator[tuple[Positions | TriangleMesh, int]], all_frames: int, chosen: SequenceOptions, progress: Progress
) -> Iterator[Positions | TriangleMesh]:
    """Yield the frames; begin a stage of the progress with each GOP."""
    for frame, number in frames:
        longest = chosen.longest(len(frame.positions if isinstance(frame, TriangleMesh) else frame))
        if not chosen.low_delay and number and number % longest == 0:
            gops = f" of {-(-all_frames // longest)}" if all_frames else ""
            progress.stage(f"encoding GOP {1 + number // longest}{gops}")
        yield frame
