"""bsm encode: mesh files to streams."""

from __future__ import annotations

import argparse
import time
from collections.abc import Sequence
from pathlib import Path

from bsm.batch import Facts, Job, add_inputs, came_to, plan, refuse_collisions, run_jobs, size_of
from bsm.bitstream.errors import OptionError
from bsm.commands.encode_options import add_encode_flags, encode_options, given_options, given_targets
from bsm.commands.reader import add_reader_flag
from bsm.commands.sequence_options import add_sequence_flags, refuse_sequence_flags, wanted_of
from bsm.console import Console, finite
from bsm.farm.run import may_replace
from bsm.files.mesh import MESH_FORMATS, read_mesh
from bsm.files.motion.folder import common_name, look_like_frames
from bsm.files.motion.frames import Frames
from bsm.files.naming import refuse_terminal
from bsm.files.output import open_output, refuse_to_overwrite
from bsm.files.permutation import write_permutation
from bsm.files.sequence import SEQUENCES_READ, open_frames, open_sequence
from bsm.lengths import LENGTHS, refuse_other_units
from bsm.meshes import told_of


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what the command takes."""
    add_inputs(
        parser,
        "mesh file (OBJ, OFF, PLY, STL, npz), - for standard input, or a sequence: folder, quoted pattern, npz, PC2, "
        "MDD, USD, GLB with --animation",
        "file, or folder for any number of inputs (default: IN with .bsm; - for a pipe); many inputs to one .bsm are "
        "the frames of a sequence",
    )
    parser.add_argument(
        "--format",
        choices=tuple(dict.fromkeys((*MESH_FORMATS, *SEQUENCES_READ))),
        help="format of the input (default: by its name or content)",
    )
    parser.add_argument(
        "--permutation", metavar="FILE.npy", help="also write which input vertex each decoded vertex is"
    )
    parser.add_argument(
        "--meta",
        action="append",
        default=[],
        metavar="NAME=TEXT",
        help="also say this of the mesh, for instance name=Bunny or unit=mm; any number of times",
    )
    add_reader_flag(parser)
    add_encode_flags(parser)
    add_sequence_flags(parser)
    parser.set_defaults(members=[])


def run(args: argparse.Namespace, console: Console) -> int:
    """Encode all inputs."""
    args.members = []
    if is_one_sequence(args.inputs, args.output):
        args.members, args.inputs = args.inputs, [common_name(args.inputs)]
    elif args.output is None and len(args.inputs) > 1 and look_like_frames(args.inputs):
        console.note(
            f"{len(args.inputs)} inputs are numbered like the frames of one animation; to make one stream of them, "
            "-o NAME.bsm"
        )
    jobs = plan(args.inputs, args.output, lambda _: ".bsm")
    if args.permutation:
        if len(jobs) > 1:
            raise OptionError("--permutation is for one input")
        refuse_collisions(args.inputs, [jobs[0].output, args.permutation])
    if jobs[0].output == "-" and args.json:
        raise OptionError("--json and -o - would both write to standard output")
    refuse_terminal(jobs[0].output)
    one_thread_each(args, jobs)
    return run_jobs(args, console, encode_one, jobs)


def is_one_sequence(inputs: Sequence[str], output: str | None) -> bool:
    """Whether many inputs are the frames of one stream."""
    return len(inputs) > 1 and output is not None and output.lower().endswith(".bsm") and not Path(output).is_dir()


def form_of(args: argparse.Namespace) -> str | None:
    """The format of the input, as far as it was said."""
    if args.piped_frames and args.format not in (None, "npy"):
        raise OptionError(f"--frames takes npy arrays, and --format says {args.format}")
    return "npy" if args.piped_frames else args.format


def metadata_of(args: argparse.Namespace) -> dict[str, str]:
    """What `--meta` says."""
    pairs = [text.partition("=") for text in args.meta]
    for name, sign, _ in pairs:
        if not name or not sign:
            raise OptionError(f"--meta takes NAME=TEXT, not {name!r}")
    return {name: value for name, _, value in pairs}


def one_thread_each(args: argparse.Namespace, jobs: Sequence[Job]) -> None:
    """Let jobs that are done side by side have a thread each, unless something else was said."""
    if (args.jobs != 1 or args.dask) and len(jobs) > 1 and not hasattr(args, "threads"):
        args.threads = 1


def encode_one(args: argparse.Namespace, console: Console) -> Facts:
    """Encode one input and say what came out."""
    for path in filter(None, (args.output, args.permutation)):
        refuse_to_overwrite(path, may_replace(args, path))

    from bsm.codec.static.encoder import Encoder

    if args.members:
        sequence: Frames | None = open_frames(args.members, args.format, args.reader)
    else:
        sequence = open_sequence(args.input, form_of(args), args.reader, wanted_of(args))
    if sequence is not None:
        from bsm.commands.sequence_encode import encode_sequence

        return encode_sequence(args, console, sequence, metadata_of(args))
    refuse_sequence_flags(args)
    options = encode_options(args)
    source = read_mesh(args.input, args.format, reader=args.reader)
    mesh = told_of(source.mesh, options, metadata_of(args))
    given = {**given_options(args), **given_targets(args)}
    refuse_other_units({name: given.get(name) for name in LENGTHS}, mesh.metadata)
    begin = time.perf_counter()
    encoder = Encoder(mesh, options)
    overwrite = may_replace(args, args.output)
    with open_output(args.output, overwrite=overwrite) as file, console.progress("encoding") as progress:
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
        console.note(f"{args.input}: {note}")
    if args.permutation:
        write_permutation(args.permutation, encoder.vertex_order, overwrite=args.force)
    vertices, faces, size, error = attempt.header.vertices, len(encoder.mesh.faces), attempt.size, attempt.comparison
    taken = size_of(args.input)
    console.note(
        f"{args.input} -> {args.output}: {vertices} vertices, {faces} faces, {came_to(taken, size)}, "
        f"{8 * size / vertices:.2f} bits per vertex; farthest vertex {100 * error.max_error_relative:.3g} % of the "
        f"diagonal, normals {error.angle_deg:.2f} degrees by area and {error.theta_deg:.2f} by face, "
        f"{error.nmsve_db:.2f} dB; {seconds:.2f} s"
    )
    return {
        "input": args.input,
        "output": args.output,
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
