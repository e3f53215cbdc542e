"""bsm verify: whether streams are whole and can be decoded."""

import argparse
from dataclasses import dataclass

from bsm.bitstream.errors import OptionError
from bsm.commands.flags import add_inputs, add_limits_flag, asked, limits_of, run_of
from bsm.console import Console
from bsm.files.pipes import read_chunks
from bsm.files.stream import decode_through, decode_whole, inspect_stream
from bsm.jobs.report import Facts, Job, Task
from bsm.jobs.run import input_names, run_jobs
from bsm.steadiness import check_steadiness


@dataclass(frozen=True, kw_only=True)
class VerifyJob(Task):
    """What `bsm verify` is asked for: the limits, whether only structure is checked, or steadiness as well."""

    limits: str = "default"
    quick: bool = False
    steady: bool = False


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_inputs(parser, "stream, or - for standard input")
    add_limits_flag(parser)
    parser.add_argument("--quick", action="store_true", help="check structure and checksums only, do not decode")
    parser.add_argument(
        "--steady",
        action="store_true",
        help="decode twice, once with noise in the last bits, and fail (code 7) where that moves "
        "positions so far that processors could differ; extreme options of encoding can do that",
    )


def run(args: argparse.Namespace, console: Console) -> int:
    if args.steady and args.quick:
        raise OptionError("--steady decodes, which --quick does not")
    jobs = [Job(name) for name in input_names(args.inputs)]
    return run_jobs(run_of(args), asked(VerifyJob, args), console, verify_one, jobs)


def verify_one(args: VerifyJob, console: Console) -> Facts:
    chunks = list(read_chunks(args.input))
    limits = limits_of(args.limits)
    with console.progress("decoding") as progress:
        info = inspect_stream(iter(chunks), limits)
        if not args.quick:
            decode_through(iter(chunks), limits) if info.header.gop_frames else decode_whole(iter(chunks), limits)
        if args.steady:
            progress.stage("decoding again")
            check_steadiness(b"".join(chunks))
    console.note(f"{args.input}: whole, {info.header.blocks} blocks, {info.sizes['total']} bytes")
    return {"input": args.input, "ok": True, "decoded": not args.quick, "bytes": info.sizes["total"]}
