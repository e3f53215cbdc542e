"""bsm verify: check that streams are complete and can be decoded."""

import argparse
from dataclasses import dataclass
from pathlib import Path

from bsm.bitstream.errors import FormatError, OptionError, counted
from bsm.commands.flags import add_flags, add_inputs, asked, limits_of
from bsm.files.inspection import StreamInfo, inspect_stream
from bsm.files.pipes import read_chunks
from bsm.files.stream import decode_through, decode_whole, is_scene, is_tiles, refuse_mesh
from bsm.files.table import by_name
from bsm.ground.console import Console
from bsm.ground.exits import worded
from bsm.jobs.plan import STREAM_SUFFIXES, files_in, input_names
from bsm.jobs.run import Batch, run_jobs
from bsm.jobs.task import Facts, Job, Task


@dataclass(frozen=True, kw_only=True)
class VerifyJob(Task):
    limits: str = "default"
    quick: bool = False


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_inputs(parser, "stream, folder of tiles, or - for standard input")
    add_flags(parser, "verify", "limits")


def run(args: argparse.Namespace, console: Console) -> int:
    found = (str(path) for _, path in files_in(args.inputs, STREAM_SUFFIXES)) if args.recursive else None
    jobs = [Job(name) for name in found or input_names(args.inputs)]
    return run_jobs(asked(Batch, args), asked(VerifyJob, args), console, verify_one, jobs)


def verify_one(args: VerifyJob, console: Console) -> Facts:
    with console.progress("decoding"):
        if is_tiles(args.input):
            what, size, more = _verify_tiles(args, console)
        elif Path(args.input).is_dir():
            raise OptionError(f"{args.input} is a folder, and not one of tiles; bsm verify -r checks the streams in it")
        elif is_scene(args.input):
            what, size, more = _verify_scene(args)
        else:
            refuse_mesh(args.input)
            # Held in memory, since a pipe gives the bytes once and they are read twice: the structure first, because
            # its errors name the place.
            info = _checked(list(read_chunks(args.input)), args)
            what, size = counted(blocks=info.header.blocks), info.sizes["total"]
            more = {"checked": not args.quick and info.checksum is not None}
    # Only streams with a checksum of decoded positions prove that. Short ones have none.
    matches = ", positions match the encoder's" if more.get("checked") else ""
    console.note(f"{args.input}: whole, {what}, {size} bytes{matches}")
    return {"input": args.input, "ok": True, "decoded": not args.quick, **more, "bytes": size}


def _checked(chunks: list[bytes], args: VerifyJob) -> StreamInfo:
    limits = limits_of(args.limits)
    info = inspect_stream(iter(chunks), limits)
    if not args.quick:
        decode_through(iter(chunks), limits) if info.header.gop_frames else decode_whole(iter(chunks), limits)
    return info


def _verify_scene(args: VerifyJob) -> tuple[str, int, Facts]:
    """Check every stream of a glTF scene."""
    document = by_name("bsm.gltf.document", "read_document")(args.input, limits_of(args.limits))
    sizes = [_checked([document.view(number)], args).sizes["total"] for number in document.streams]
    if not sizes:
        raise FormatError(f"{args.input}: this scene has no streams; bsm glb makes one that has")
    return counted(streams=len(sizes)), sum(sizes), {}


def _verify_tiles(args: VerifyJob, console: Console) -> tuple[str, int, Facts]:
    """Check every tile of every shard; report all faults, and raise the first."""
    tiles = by_name("bsm.tiles.shards", "open_tiles")(args.input, limits_of(args.limits))
    faults = list(tiles.faults(not args.quick))
    # The first becomes the error of the command. All others are notes, so that nothing is told twice.
    for fault in faults[1:]:
        console.note(worded(fault))
    if faults:
        raise faults[0]
    count, size = (sum(shard[name] for shard in tiles.manifest["shards"]) for name in ("tiles", "size"))
    return counted(tiles=count), size, {}
