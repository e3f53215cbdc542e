"""bsm info: list the contents of a stream without decoding it."""

import argparse
import shlex
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from bsm.bitstream.errors import OptionError, counted
from bsm.bitstream.limits import as_limits
from bsm.commands.flags import add_flags, add_inputs, asked
from bsm.files.images import linked_images
from bsm.files.inspection import inspect_stream, summarize_stream
from bsm.files.motion.frames import MOST_LISTED, describe_runs
from bsm.files.pipes import read_chunks
from bsm.files.stream import is_scene, is_tiles, refuse_mesh
from bsm.files.table import by_name
from bsm.ground.console import Console, printable
from bsm.jobs.plan import input_names
from bsm.jobs.run import Batch, run_jobs
from bsm.jobs.task import Facts, Job, Task


@dataclass(frozen=True, kw_only=True)
class InfoJob(Task):
    limits: str = "default"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_inputs(
        parser, "stream, scene of glTF with streams, folder of tiles, or - for standard input"
    )
    add_flags(parser, "limits")


def run(args: argparse.Namespace, console: Console) -> int:
    jobs = [Job(name) for name in input_names(args.inputs)]
    return run_jobs(asked(Batch, args), asked(InfoJob, args), console, info_of_one, jobs, _worded)


def info_of_one(args: InfoJob, console: Console) -> Facts:
    limits = as_limits(args.limits)
    if is_tiles(args.input):
        return {
            "input": args.input,
            **by_name("bsm.tiles.shards", "open_tiles")(args.input).manifest,
        }
    # A scene may hold many streams, and each is described on its own.
    if is_scene(args.input):
        document = by_name("bsm.gltf.document", "read_document")(args.input, limits)
        streams = {}
        for number in document.streams:
            info = inspect_stream(iter([document.view(number)]), limits)
            streams[number] = summarize_stream(info)
        return {
            "input": args.input,
            "primitives": len(list(document.primitives())),
            "streams": streams,
        }
    if Path(args.input).is_dir():
        raise OptionError(_worded_folder(args.input))
    refuse_mesh(args.input)
    info = inspect_stream(read_chunks(args.input), limits)
    images = {
        image.name: image.fault or "is there" for image in linked_images(info.metadata, args.input)
    }
    return {"input": args.input, **summarize_stream(info), "linked_images": images}


def _worded_folder(folder: str) -> str:
    """Say that a folder is not a stream, and where its streams are."""
    stream = next(iter(sorted(Path(folder).rglob("*.bsm"))), None)
    if stream is None:
        return f"{folder} is a folder without streams"
    files = f"{shlex.quote(str(stream.parent))}/*.bsm"
    return f"{folder} is a folder; for the streams in it, run: bsm info {files}; bsm verify -r checks them"


def _worded(summary: Facts) -> str:
    if "shards" in summary:
        return "\n".join(_tile_lines(summary))
    if "streams" in summary:
        return "\n\n".join(_scene_parts(summary))
    lines = [
        f"version {summary['version']}, {', '.join(summary['extensions']) or 'core only'}: "
        f"{counted(vertices=summary['vertices'], faces=summary['faces'])}",
        _positions_line(summary),
        *_paper_lines(summary),
        *_sequence_lines(summary),
    ]
    if summary["checksum"]:
        lines.append(f"checksum of decoded positions: {summary['checksum']}")
    lines += ["bytes:", *_share_lines(summary), *_rate_lines(summary)]
    lines += map(_attribute_line, summary["attributes"])
    lines += _metadata_lines(summary)
    for name, state in summary.get("linked_images", {}).items():
        lines += [printable(f"the image {name} {state}")]
    return "\n".join(lines)


def _scene_parts(summary: Facts) -> Iterator[str]:
    """Describe a scene, and then each of its streams."""
    streams = summary["streams"]
    if not streams:
        head = f"scene of {counted(primitives=summary['primitives'])}, not compressed: "
        yield f"{head}bsm glb {shlex.quote(summary['input'])} -o OUT.glb compresses it"
        return
    yield f"scene of {counted(primitives=summary['primitives'], streams=len(streams))}"
    for number, stream in streams.items():
        yield f"bufferView {number}: {_worded(stream)}"


def _share_lines(summary: Facts) -> list[str]:
    total = summary["bytes"]["total"]
    shares = list[str]()
    # Bytes of all parts add up to the file, framing included, so that nothing stays unexplained.
    for name, size in summary["bytes"].items():
        if name != "coefficients":
            shares.append(_share_line(f"  {name}", size, total))
            continue
        shares.append(_share_line("  positions", size, total))
        for kind, count in summary["positions"].items():
            if count:
                shares += [_share_line(f"    {kind.replace('_', ' ')}", count, total)]
    return shares


def _rate_lines(summary: Facts) -> list[str]:
    """The bits per vertex of a mesh; nothing of a sequence, which tells its own."""
    if summary["frames"]:
        return []
    line = f"bits per vertex: {summary['bpv_total']:.3f} in total, {summary['bpv_geometry']:.3f} for positions"
    packed, *_ = summary["header"]["paper"] or (0,)
    if packed:
        line += f", bpv_paper {summary['bpv_paper']:.3f} by the paper's formula"
    return [line]


def _metadata_lines(summary: Facts) -> list[str]:
    texts = dict(summary["metadata"])
    for name, count in summary["metadata_bytes"].items():
        texts[name] = f"{count} bytes"
    if not texts:
        return []
    entries = [printable(f"  {name}: {value}") for name, value in texts.items()]
    return ["metadata:", *entries]


def _positions_line(summary: Facts) -> str:
    header, coefficients = summary["header"], summary["coefficients"] or [0]
    if header["grid"]:
        sizes = " x ".join(str(largest + 1) for largest in header["grid"])
        return f"positions on a grid of {sizes}"
    rows = "vertices"
    if header["base"]:
        rows = "cells"
    line = f"{summary['blocks']} blocks of {summary['block_size']} {rows}, "
    line += f"{min(coefficients)} to {max(coefficients)} coefficients"
    if header["refinement"]:
        line += ", and a layer of refinement"
    return line


def _share_line(name: str, size: int, total: int) -> str:
    return f"{name:<22}{size:>12}  {100 * size / total:5.1f} %"


def _paper_lines(summary: Facts) -> list[str]:
    """The settings of a stream of packed coefficients, with the preset "paper" if it has all of that."""
    bits, _, _, power, iterations, *_ = map(int, summary["header"]["paper"] or [0] * 8)
    if not bits:
        return []
    parts = "parts by BSM's own rule, not METIS"
    if summary["bytes"]["partition"]:
        parts = "METIS parts"
    elif summary["blocks"] == 1:
        parts = "one part"
    name = "some settings of preset paper"
    if summary["preset"]:
        name = "preset paper"
    return [f"{name}: R^{power}, iterations {iterations}, {bits} bits a coefficient, {parts}"]


def _tile_lines(summary: Facts) -> Iterator[str]:
    yield (
        f"tiles of {printable(str(summary['source']))}: {summary['vertices']} vertices, {summary['faces']} faces, on a "
        f"grid of {summary['cell']:g}"
    )
    for level in summary["levels"]:
        counts = f"{level['tiles']:>6} tiles {level['faces']:>12} faces {level['bytes']:>12} bytes"
        # The diagonal of half a cell: as far as rounding moves a vertex.
        off = level["error"] + 0.5 * 3.0**0.5 * summary["cell"]  # and by rounding to the grid
        yield f"  level {level['level']}: {counts}, off by up to {off:.3g}"
    yield f"{len(summary['shards'])} shards, {sum(shard['size'] for shard in summary['shards'])} bytes"


def _attribute_line(attribute: dict[str, Any]) -> str:
    what = f"{attribute['components']} x {attribute['kind']} per {attribute['domain']}, {attribute['semantic']}"
    seams = ""
    if attribute["seams"]:
        seams = f", {attribute['seams']} of them for seams"
    return (
        f"attribute {printable(attribute['name'])}: {what}, {attribute['values']} values, {attribute['coding']}, "
        f"{attribute['bytes']} bytes{seams}"
    )


def _sequence_lines(summary: dict[str, Any]) -> list[str]:
    """What there is to say of a sequence; nothing of a mesh."""
    gops, header = summary["gops"], summary["header"]
    if not header["sequence"]:
        return []
    rate = ""
    if "frame_rate" in summary["metadata"]:
        rate = f", {summary['metadata']['frame_rate']:g} per second"
    number_of_gops = f"{len(gops)} GOPs"
    if len(gops) == 1:
        number_of_gops = "1 GOP"
    sizes = [gop["bytes"] for gop in gops] or [0]
    smallest, largest = min(sizes), max(sizes)
    range_of_sizes = f"{smallest}"
    if smallest < largest:
        range_of_sizes = f"{smallest} to {largest}"
    return [
        f"{summary['frames']} frames{rate}, in {number_of_gops} of {range_of_sizes} bytes, "
        f"{summary['bpvf_total'] or 0.0:.3f} bits per vertex and frame",
        *_run_lines(summary["runs"]),
    ]


def _run_lines(runs: list[dict[str, Any]]) -> list[str]:
    if len(runs) <= 1:
        return []
    lines = [describe_runs([run["first"] for run in runs[1:]])]
    for number, run in enumerate(runs[:MOST_LISTED]):
        counts = counted(vertices=run["vertices"], faces=run["faces"])
        again = ""
        if run["mesh"] != number:
            again = f", the mesh of run {run['mesh']} again"
        lines.append(
            f"run {number}: {run['frames']} frames from {run['first']} on, {counts}{again}"
        )
    return lines
