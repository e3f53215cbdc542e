"""Mesh files to streams: the work of `bsm encode` and of `bsm.encode_many`."""

from __future__ import annotations

import time

from bsm import options
from bsm.batch import Facts, came_to, size_of
from bsm.bitstream.errors import OptionError
from bsm.console import Console, finite
from bsm.encoding.job import EncodeJob
from bsm.encoding.sequence import encode_sequence, sequence_of
from bsm.files.mesh import read_mesh
from bsm.files.output import open_output, refuse_to_overwrite
from bsm.files.permutation import write_permutation
from bsm.lengths import LENGTHS, refuse_other_units
from bsm.meshes import told_of


def encode_one(job: EncodeJob, console: Console) -> Facts:
    """Encode one input and say what came out."""
    for path in filter(None, (job.output, job.permutation)):
        refuse_to_overwrite(path, job.may_replace(path))

    from bsm.codec.static.encoder import Encoder

    if sequence := sequence_of(job):
        return encode_sequence(job, console, sequence)
    for name, given in (("animation", job.animation), ("mesh", job.cache_mesh)):
        if given is not None:
            raise OptionError(f"--{name} is for sequences, and this is one mesh")
    chosen = options.encode_options(**job.wishes, threads=job.threads)
    with console.progress("reading"):
        source = read_mesh(job.input, job.format, reader=job.reader)
    mesh = told_of(source.mesh, chosen, job.metadata)
    refuse_other_units({name: job.wishes.get(name) for name in LENGTHS}, mesh.metadata)
    begin = time.perf_counter()
    encoder = Encoder(mesh, chosen)
    overwrite = job.may_replace(job.output)
    with open_output(job.output, overwrite=overwrite) as file, console.progress("encoding") as progress:
        attempt = encoder.result(progress)
        for chunk in attempt.frames:
            file.write(chunk)
    seconds = time.perf_counter() - begin
    unsent = source.mesh.metadata.keys() - mesh.metadata.keys()
    images = sum(len(value) for value in mesh.metadata.values() if isinstance(value, bytes))
    notes = (
        *source.notes,
        *encoder.notes,
        *(["left out: materials, images"] if unsent else []),
        *([f"{images} of the bytes are images, as they are"] if images else []),
    )
    for note in notes:
        console.note(f"{job.input}: {note}")
    if job.permutation:
        write_permutation(job.permutation, encoder.vertex_order, overwrite=job.force)
    vertices, faces, size, error = attempt.header.vertices, len(encoder.mesh.faces), attempt.size, attempt.comparison
    taken = size_of(job.input)
    console.note(
        f"{job.input} -> {job.output}: {vertices} vertices, {faces} faces, {came_to(taken, size)}, "
        f"{8 * size / vertices:.2f} bits per vertex; farthest vertex {100 * error.max_error_relative:.3g} % of the "
        f"diagonal, normals {error.angle_deg:.2f} degrees by area and {error.theta_deg:.2f} by face, "
        f"{error.nmsve_db:.2f} dB; {seconds:.2f} s"
    )
    return {
        "input": job.input,
        "output": job.output,
        "vertices": vertices,
        "faces": faces,
        "input_bytes": taken,
        "output_bytes": size,
        "bytes": size,
        "bpv_total": 8 * size / vertices,
        "theta_deg": error.theta_deg,
        "angle_deg": error.angle_deg,
        "nmsve_db": finite(error.nmsve_db),
        "max_error_relative": error.max_error_relative,
        "seconds": seconds,
        "notes": list(notes),
    }
