"""bsm verify: check that streams, linked images, tiles and the outputs of a report are there and whole."""

import argparse
import errno
import os
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeAlias

from bsm.bitstream.errors import BsmError, CorruptError, FormatError, OptionError, counted
from bsm.bitstream.limits import as_limits
from bsm.codec.geometry.mesh import Metadata
from bsm.commands.flags import add_flags, add_inputs, asked
from bsm.files.images import LinkedImage, is_link, linked_images
from bsm.files.inspection import StreamInfo, inspect_stream
from bsm.files.pipes import digest_of, is_url, read_chunks
from bsm.files.stream import (
    decode_through,
    decode_whole,
    is_scene,
    is_stream,
    is_tiles,
    refuse_mesh,
)
from bsm.files.table import by_name
from bsm.ground.console import Console
from bsm.ground.exits import exit_of, worded
from bsm.jobs.plan import STREAM_SUFFIXES, files_in, input_names
from bsm.jobs.report import find_output, is_report, read_results
from bsm.jobs.run import Batch, run_jobs
from bsm.jobs.task import Facts, Job, Task

Fault: TypeAlias = BsmError | OSError


@dataclass(frozen=True, kw_only=True)
class VerifyJob(Task):
    limits: str = "default"
    quick: bool = False


@dataclass(frozen=True)
class Verdict:
    """The result for an input."""

    contents: str
    """The checked contents, in words."""
    size: int
    """Its bytes."""
    faults: Sequence[Fault] = ()
    facts: Facts = field(default_factory=dict)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_inputs(parser, "stream, folder of tiles, report of a run (.json), or - for standard input")
    add_flags(parser, "verify", "limits")


def run(args: argparse.Namespace, console: Console) -> int:
    if args.recursive:
        paths = [str(path) for _, path in files_in(args.inputs, (*STREAM_SUFFIXES, ".json"))]
        names = [path for path in paths if is_report(path) or not path.lower().endswith(".json")]
        if not names:
            raise OptionError(f"no streams or reports in {', '.join(args.inputs)} or subfolders")
    else:
        names = input_names(args.inputs)
    jobs = list(map(Job, names))
    return run_jobs(asked(Batch, args), asked(VerifyJob, args), console, verify_one, jobs)


def verify_one(args: VerifyJob, console: Console) -> Facts:
    with console.progress("decoding"):
        verdict = _verify(args, console)
    # The first becomes the error of the command. All others are notes, so that nothing is told twice.
    for fault in verdict.faults[1:]:
        console.note(worded(fault))
    if verdict.faults:
        raise verdict.faults[0]
    # Only streams with a checksum of decoded positions prove that. Short ones have none.
    matches = ""
    if verdict.facts.get("checked"):
        matches = ", positions match the encoder's"
    console.note(f"{args.input}: whole, {verdict.contents}, {verdict.size} bytes{matches}")
    return {
        "input": args.input,
        "ok": True,
        "decoded": not args.quick,
        **verdict.facts,
        "bytes": verdict.size,
    }


def _verify(args: VerifyJob, console: Console) -> Verdict:
    if is_report(args.input):
        return _verify_report(args, console)
    if is_tiles(args.input):
        return _verify_tiles(args)
    if Path(args.input).is_dir():
        raise OptionError(
            f"{args.input} is a folder, and not one of tiles; bsm verify -r checks the streams in it"
        )
    if is_scene(args.input):
        return _verify_scene(args)
    refuse_mesh(args.input)
    # Held in memory, since a pipe gives the bytes once and they are read twice: the structure first, because its
    # errors name the place.
    info = _check_stream(list(read_chunks(args.input)), args)
    contents = counted(blocks=info.header.blocks)
    facts: Facts = {"checked": not args.quick and info.checksum is not None}
    links = sum(map(is_link, info.metadata))
    faults: list[Fault] = []
    if links and (args.input == "-" or is_url(args.input)):
        console.note(
            f"{args.input}: not checked: {counted(images=links)} in files beside the stream"
        )
    elif links:
        faults = _image_faults(args.input, info.metadata)
        contents += f", {counted(images=links)} beside it"
        facts["images"] = links
    return Verdict(contents, info.sizes["total"], faults, facts)


def _check_stream(chunks: list[bytes], args: VerifyJob) -> StreamInfo:
    limits = as_limits(args.limits)
    info = inspect_stream(iter(chunks), limits)
    if args.quick:
        return info
    if info.header.gop_frames:
        decode_through(iter(chunks), limits)
    else:
        decode_whole(iter(chunks), limits)
    return info


def _image_faults(stream: str, metadata: Metadata) -> list[Fault]:
    """Return an error for each image that a stream links to, and that is missing or damaged."""
    return [_image_fault(stream, image) for image in linked_images(metadata, stream) if image.fault]


def _image_fault(stream: str, image: LinkedImage) -> Fault:
    path = str(Path(stream).parent / image.name)
    if image.is_there:
        return CorruptError(f"the image {path} is damaged: it is not the one that was encoded")
    return _missing(path, f"the image of {stream} is missing")


def _missing(path: str, reason: str) -> OSError:
    return FileNotFoundError(errno.ENOENT, reason, path)


def _verify_report(args: VerifyJob, console: Console) -> Verdict:
    """Check that each output of a run is there, and is the one that was written."""
    results = read_results(args.input)
    faults: list[Fault] = []
    states = []
    files = []
    size = 0
    for result in results:
        output = find_output(args.input, result["output"])
        own_faults = _output_faults(args, result, output)
        faults += own_faults
        state = _state_of(own_faults)
        states.append(state)
        files.append({"output": result["output"], "state": state})
        if Path(output).is_file():
            size += os.path.getsize(output)
    count = Counter(states)
    if faults:
        listing = ", ".join(f"{number} {state}" for state, number in count.items())
        console.note(f"{args.input}: {counted(outputs=len(results))}: {listing}")

    return Verdict(counted(outputs=len(results)), size, faults, {"files": files})


def _output_faults(args: VerifyJob, result: Facts, output: str) -> list[Fault]:
    if "error" in result:
        return [_missing(output, f"it was not written: {result['error']}")]
    digest = digest_of(output)
    if digest is None:
        return [_missing(output, "the output is missing")]
    expected = result.get("output_sha256")
    if expected is not None and digest != expected:
        return [
            CorruptError(
                f"{output}: the output is damaged or was changed: its SHA-256 is not that of the report"
            )
        ]
    if not Path(output).is_file() or not is_stream(output):
        return []
    # Equal bytes were decoded when they were written; only files beside the stream are left.
    return _image_faults(
        output, inspect_stream(read_chunks(output), as_limits(args.limits)).metadata
    )


def _state_of(faults: Sequence[Fault]) -> str:
    if not faults:
        return "whole"
    missing = exit_of(FileNotFoundError()).code
    for fault in faults:
        if exit_of(fault).code != missing:
            return "damaged"
    return "missing"


def _verify_scene(args: VerifyJob) -> Verdict:
    """Check every stream of a glTF scene."""
    document = by_name("bsm.gltf.document", "read_document")(args.input, as_limits(args.limits))
    sizes = [
        _check_stream([document.view(number)], args).sizes["total"] for number in document.streams
    ]
    if not sizes:
        raise FormatError(f"{args.input}: this scene has no streams; bsm glb makes one that has")
    return Verdict(counted(streams=len(sizes)), sum(sizes))


def _verify_tiles(args: VerifyJob) -> Verdict:
    """Check every tile of every shard."""
    tiles = by_name("bsm.tiles.shards", "open_tiles")(args.input, as_limits(args.limits))
    faults = list(tiles.faults(not args.quick))
    shards = tiles.manifest["shards"]
    count = sum(shard["tiles"] for shard in shards)
    size = sum(shard["size"] for shard in shards)
    return Verdict(counted(tiles=count), size, faults)
