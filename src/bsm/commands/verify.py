"""bsm verify: check that streams are complete and can be decoded."""

import argparse
from dataclasses import dataclass

from bsm.bitstream.errors import counted
from bsm.commands.flags import add_inputs, add_limits_flag, asked, limits_of
from bsm.console import Console
from bsm.exits import worded
from bsm.files.inspection import inspect_stream
from bsm.files.pipes import read_chunks
from bsm.files.stream import decode_through, decode_whole
from bsm.jobs.plan import input_names
from bsm.jobs.run import Run, run_jobs
from bsm.jobs.task import Facts, Job, Task
from bsm.tiles.shards import is_tiles, open_tiles


@dataclass(frozen=True, kw_only=True)
class VerifyJob(Task):
    """The task of `bsm verify`: the limits, and whether only structure is checked."""

    limits: str = "default"
    quick: bool = False


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_inputs(parser, "stream, folder of tiles, or - for standard input")
    add_limits_flag(parser)
    parser.add_argument("--quick", action="store_true", help="check structure and checksums only; do not decode")


def run(args: argparse.Namespace, console: Console) -> int:
    jobs = [Job(name) for name in input_names(args.inputs)]
    return run_jobs(asked(Run, args), asked(VerifyJob, args), console, verify_one, jobs)


def verify_one(args: VerifyJob, console: Console) -> Facts:
    limits = limits_of(args.limits)
    if is_tiles(args.input):
        return _verify_tiles(args, console)
    chunks = list(read_chunks(args.input))
    with console.progress("decoding"):
        info = inspect_stream(iter(chunks), limits)
        if not args.quick:
            decode_through(iter(chunks), limits) if info.header.gop_frames else decode_whole(iter(chunks), limits)
    checked = not args.quick and info.checksum is not None
    checksum, size = ", positions match the encoder's" if checked else "", info.sizes["total"]
    console.note(f"{args.input}: whole, {counted(blocks=info.header.blocks)}, {size} bytes{checksum}")
    return {"input": args.input, "ok": True, "decoded": not args.quick, "checked": checked, "bytes": size}


def _verify_tiles(args: VerifyJob, console: Console) -> Facts:
    """Check every tile of every shard; report all faults, and raise the first."""
    tiles = open_tiles(args.input, limits_of(args.limits))
    with console.progress("decoding"):
        faults = list(tiles.faults(not args.quick))
    for fault in faults[1:]:
        console.note(worded(fault))
    if faults:
        raise faults[0]
    count, size = (sum(shard[name] for shard in tiles.manifest["shards"]) for name in ("tiles", "size"))
    console.note(f"{args.input}: whole, {counted(tiles=count)}, {size} bytes")
    return {"input": args.input, "ok": True, "decoded": not args.quick, "bytes": size}
