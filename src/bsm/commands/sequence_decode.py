"""bsm decode, where the stream is a sequence."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Iterator
from itertools import chain, islice

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import OptionError
from bsm.commands.decode_job import DecodeJob
from bsm.commands.limits import limits_of
from bsm.console import Console
from bsm.files.motion.frames import Shared
from bsm.files.naming import default_output, output_inside
from bsm.files.output import refuse_to_overwrite
from bsm.files.permutation import read_permutation, reorder
from bsm.files.sequence import ONE_FILE, sequence_kind, sequence_writer
from bsm.files.sequence_stream import SequenceStream, numbered, numbers_of, said_of_runs
from bsm.files.state import size_of
from bsm.jobs.task import Facts


def add_flags(parser: argparse.ArgumentParser) -> None:
    """Add what only sequences have."""
    group = parser.add_argument_group("sequences")
    group.add_argument("--frames", metavar="A:B", help="frames A to B - 1 only; what they do not need is not decoded")


def refuse_flags(args: DecodeJob) -> None:
    """Raise `OptionError` if a flag of `add_flags` was given for a mesh."""
    if args.frames is not None:
        raise OptionError("--frames is for sequences, and this is one mesh")


def decode_sequence(args: DecodeJob, console: Console, chunks: Iterator[bytes]) -> Facts:
    """Decode one sequence; every frame is written as soon as it is known."""
    if args.blocks is not None:
        raise OptionError("--blocks is for meshes, and this is a sequence")
    output = _output(args)
    kind = sequence_kind(output, args.format)
    refuse_to_overwrite(output, args.may_replace(output))
    begin = time.perf_counter()
    first, last = _range(args.frames)
    stream = SequenceStream(chunks, console.note if args.tolerant else None, first, limits_of(args.limits))
    header, frames = stream.header, stream.changing_frames()
    ahead = list(islice(frames, 1))  # whose faces are those that are written first
    faces = stream.faces
    last = min(last, header.frames or last)
    expected = max(last - first, 0) if header.frames and not args.tolerant else 0
    order: npt.NDArray[np.int64] | slice = slice(None)
    if args.permutation:
        mesh = reorder(numbered(faces, int(faces.max()) + 1), read_permutation(args.permutation))
        order, faces = numbers_of(mesh.positions), mesh.faces
    shared = Shared(
        lambda: () if args.permutation else stream.attributes,
        lambda: {} if args.permutation else stream.metadata,
    )
    count = vertices = 0
    with (
        sequence_writer(
            output,
            kind,
            faces,
            expected,
            overwrite=args.may_replace(output),
            shared=shared,
        ) as write,
        console.progress("decoding", "frames") as progress,
    ):
        present = stream.faces
        for number, frame in chain(ahead, frames):
            if number >= last:
                break
            if stream.faces is present:
                write(frame[order])
            elif args.permutation:
                raise OptionError(f"--permutation is the order of one mesh, and the faces change at frame {number}")
            else:
                present = stream.faces
                write(frame, present)
            vertices = vertices or len(frame)
            count += 1
            if expected:
                progress(count, expected)
        if count == 0:
            raise OptionError("the stream has none of these frames")
    lost = [one.name for one in stream.attributes] if args.permutation else shared.left_out
    if lost:
        because = " with --permutation" if args.permutation else ""
        console.note(f"{args.input}: left out: {', '.join(lost)}, which {kind} does not hold{because}")
    seconds = time.perf_counter() - begin
    facts = {"frames": count, "vertices": vertices, "faces": header.faces}
    if stream.run_starts:
        console.note(f"{args.input}: {said_of_runs(stream.run_starts)}")
    console.note(
        f"{args.input} -> {output}: {count} frames of {vertices} vertices, {header.faces} faces, {seconds:.2f} s"
    )
    sizes = {"input_bytes": size_of(args.input), "output_bytes": size_of(output)}
    return {"input": args.input, "output": output, **facts, **sizes, "seconds": seconds}


def _output(args: DecodeJob) -> str:
    """Where a sequence goes: an npz, or a folder for frames of a format of meshes, if nothing else was said."""
    suffix = f".{args.format or 'npz'}" if args.format in (None, *ONE_FILE) else ""
    if args.given is None:
        return default_output(args.input, suffix)
    return output_inside(args.given, args.input, suffix) if args.many else str(args.output)


def _range(text: str | None) -> tuple[int, int]:
    """First frame, and the one behind the last."""
    first, colon, last = (text or ":").partition(":")
    try:
        chosen = int(first or 0), int(last or sys.maxsize)
    except ValueError:
        chosen = -1, -1
    if not colon or not 0 <= chosen[0] < chosen[1]:
        raise OptionError(f"--frames {text}: write A:B with 0 <= A < B, or leave one of them out")
    return chosen
