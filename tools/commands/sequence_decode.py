"""bsm decode, where the stream is a sequence."""

from __future__ import annotations

import argparse
import time
from collections.abc import Iterator

from bitstream.errors import OptionError
from tools.console import Console, print_json
from tools.naming import default_output, refuse_terminal
from tools.output import refuse_to_overwrite
from tools.permutation import read_permutation, reorder
from tools.sequence_streams import SequenceStream, numbered, numbers_of
from tools.sequences import sequence_kind, sequence_writer


def decode_sequence(args: argparse.Namespace, console: Console, chunks: Iterator[bytes]) -> None:
    """Decode one sequence; every frame is written as soon as it is known."""
    if args.blocks is not None:
        raise OptionError("--blocks is for meshes, and this is a sequence")
    output = args.output or default_output(args.input, ".npz")
    kind = sequence_kind(output, args.format)
    if output == "-" and args.json:
        raise OptionError("--json and -o - would both write to standard output")
    refuse_terminal(output)
    refuse_to_overwrite(output, args.force)
    begin = time.perf_counter()
    stream = SequenceStream(chunks)
    header, faces = stream.header, stream.faces
    mesh = numbered(faces, header.vertices)
    if args.permutation:
        mesh = reorder(mesh, read_permutation(args.permutation))
    order, faces = numbers_of(mesh.positions), mesh.faces
    count = 0
    with (
        sequence_writer(output, kind, faces, header.frames, overwrite=args.force) as write,
        console.progress("decoding") as progress,
    ):
        for _, frame in stream.frames():
            write(frame[order])
            count += 1
            if header.frames:
                progress(count, header.frames)
    seconds = time.perf_counter() - begin
    facts = {"frames": count, "vertices": header.vertices, "faces": header.faces, "frame_rate": header.frame_rate}
    if args.json:
        print_json({"input": args.input, "output": output, **facts, "seconds": seconds})
    else:
        console.note(
            f"{args.input} -> {output}: {count} frames of {header.vertices} vertices, {header.faces} faces, "
            f"{seconds:.2f} s"
        )
