"""bsm encode: mesh files to streams."""

from __future__ import annotations

import argparse

from bsm.batch import plan, refuse_collisions, run_jobs
from bsm.bitstream.errors import OptionError
from bsm.commands.encode_options import add_encode_flags, wishes_of
from bsm.commands.inputs import add_inputs, asked, run_of
from bsm.commands.reader import add_reader_flag
from bsm.commands.sequence_options import add_sequence_flags, sequence_wishes
from bsm.console import Console
from bsm.encoding.job import EncodeJob
from bsm.encoding.mesh import encode_one
from bsm.files.mesh import MESH_FORMATS
from bsm.files.naming import refuse_terminal


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what the command takes."""
    add_inputs(
        parser,
        "mesh file (OBJ, OFF, PLY, STL, npz), - for standard input, or a sequence: npz, folder, or quoted pattern",
        "file, or folder for any number of inputs (default: IN with .bsm; - for a pipe)",
    )
    parser.add_argument(
        "--format", choices=(*MESH_FORMATS, "npy"), help="format of the input (default: by its name or content)"
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


def run(args: argparse.Namespace, console: Console) -> int:
    """Encode all inputs."""
    jobs = plan(args.inputs, args.output, lambda _: ".bsm")
    if args.permutation:
        if len(jobs) > 1:
            raise OptionError("--permutation is for one input")
        refuse_collisions(args.inputs, [jobs[0].output, args.permutation])
    if jobs[0].output == "-" and args.json:
        raise OptionError("--json and -o - would both write to standard output")
    refuse_terminal(jobs[0].output)
    many, wishes = run_of(args), {**wishes_of(args), **sequence_wishes(args)}
    threads = wishes.pop("threads", 1 if many.side_by_side and len(jobs) > 1 else None)
    more = {"output": "", "metadata": _metadata(args), "wishes": wishes, "threads": threads}
    job = asked(EncodeJob, args, **more, compared=not args.quiet or args.json)
    return run_jobs(many, job, console, encode_one, jobs)


def _metadata(args: argparse.Namespace) -> dict[str, str]:
    """What `--meta` says."""
    pairs = [text.partition("=") for text in args.meta]
    for name, sign, _ in pairs:
        if not name or not sign:
            raise OptionError(f"--meta takes NAME=TEXT, not {name!r}")
    return {name: value for name, _, value in pairs}
