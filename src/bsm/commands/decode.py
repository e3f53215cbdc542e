"""bsm decode: streams to mesh files."""

from __future__ import annotations

import argparse
import time
from pathlib import Path

from bsm.bitstream.errors import OptionError
from bsm.commands import sequence_decode
from bsm.commands.decode_job import DecodeJob
from bsm.commands.inputs import add_inputs, asked, run_of
from bsm.commands.limits import add_limits_flag, limits_of
from bsm.console import Console
from bsm.files.mesh import WRITTEN_FORMATS, format_of_name, save_written, written_mesh
from bsm.files.naming import output_inside, refuse_terminal
from bsm.files.output import refuse_to_overwrite
from bsm.files.permutation import read_permutation, reorder
from bsm.files.pipes import read_chunks
from bsm.files.sequence import SEQUENCE_FORMATS
from bsm.files.sequence_stream import peek_header
from bsm.files.state import size_of
from bsm.files.stream import decode_blocks, decode_what_is_left, decode_whole
from bsm.jobs.run import anywhere, came_to, plan, run_jobs
from bsm.jobs.task import Facts


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what the command takes."""
    add_inputs(
        parser,
        "stream, or - for standard input",
        "mesh file, or folder for any number of inputs (default: IN with .ply; - for a pipe); for a sequence npz "
        "(default), PC2, MDD, GLB, USD, a folder for its frames, or their names: walk/%%04d.obj",
    )
    parser.add_argument("--format", choices=SEQUENCE_FORMATS, help="format of the output (default: by its name; ply)")
    parser.add_argument("--blocks", type=int, metavar="N", help="stop after N blocks, and write the part that is there")
    parser.add_argument(
        "--layers", type=int, metavar="N", help="stop after N layers: 1 is the base, each refinement one more"
    )
    parser.add_argument(
        "--permutation", metavar="FILE.npy", help="what encode wrote with the same option: restore the input's order"
    )
    parser.add_argument(
        "--tolerant",
        action="store_true",
        help="go on behind damage; what is lost, blocks or frames, is named and left out",
    )
    add_limits_flag(parser)
    sequence_decode.add_flags(parser)


def run(args: argparse.Namespace, console: Console) -> int:
    """Decode all inputs."""
    jobs = plan(args.inputs, args.output, lambda _: f".{args.format or 'ply'}", sole_folder=True)
    if jobs[0].output == "-" and args.json:
        raise OptionError("--json and -o - would both write to standard output")
    if args.permutation and len(jobs) > 1:
        raise OptionError("--permutation is for one input")
    if args.permutation and (args.blocks is not None or args.tolerant):
        raise OptionError("--permutation orders whole meshes; leave out --blocks and --tolerant")
    if args.layers is not None and (args.blocks is not None or args.tolerant):
        raise OptionError("--layers is for whole layers; leave out --blocks and --tolerant")
    if args.blocks is not None and args.tolerant:
        raise OptionError("--blocks stops early and --tolerant goes on: choose one")
    refuse_terminal(jobs[0].output)
    given = args.output and (anywhere(args.output) if args.dask else args.output)
    job = asked(DecodeJob, args, output="", given=given, many=len(jobs) > 1)
    return run_jobs(run_of(args), job, console, decode_one, jobs)


def decode_one(args: DecodeJob, console: Console) -> Facts:
    """Decode one stream and say what came out."""
    header, chunks = peek_header(read_chunks(args.input))
    if header is not None and header.gop_frames:
        return sequence_decode.decode_sequence(args, console, chunks)
    sequence_decode.refuse_flags(args)
    output = args.output
    if Path(output).is_dir():
        output = output_inside(output, args.input, f".{args.format or 'ply'}")
    kind = args.format or ("ply" if output == "-" else format_of_name(output))
    if kind not in WRITTEN_FORMATS:
        raise OptionError(f"{output}: the name tells no mesh format; use --format, one of {', '.join(WRITTEN_FORMATS)}")
    refuse_to_overwrite(output, args.may_replace(output))
    begin = time.perf_counter()
    limits = limits_of(args.limits)
    with console.progress("decoding") as progress:
        if args.tolerant:
            mesh = decode_what_is_left(chunks, lambda text: console.note(f"{args.input}: {text}"), limits)
        elif args.blocks is None:
            mesh = decode_whole(chunks, limits, layers=args.layers)
        else:
            mesh = decode_blocks(chunks, args.blocks, progress, limits)
    seconds = time.perf_counter() - begin
    if args.permutation:
        mesh = reorder(mesh, read_permutation(args.permutation))
    if header is not None and header.attributes > len(mesh.attributes):
        missing = header.attributes - len(mesh.attributes)
        console.note(
            f"{args.input}: left out: {missing} of {header.attributes} attributes, of which values have not come"
        )
    with console.progress("writing"):
        file = written_mesh(mesh, kind, "mesh" if output == "-" else output)
        left_out = save_written(output, file, overwrite=args.may_replace(output), overwrite_beside=args.force)
    if left_out:
        console.note(f"{args.input}: {kind} cannot hold {', '.join(left_out)}")
    written = len(file.data)
    vertices, faces = len(mesh.positions), len(mesh.faces)
    taken = size_of(args.input)
    console.note(
        f"{args.input} -> {output}: {vertices} vertices, {faces} faces, {came_to(taken, written)}, {seconds:.2f} s"
    )
    return {
        "input": args.input,
        "output": output,
        "vertices": vertices,
        "faces": faces,
        "input_bytes": taken,
        "output_bytes": written,
        "seconds": seconds,
        "left_out": list(left_out),
    }
