"""bsm encode, where the input is a sequence."""

from __future__ import annotations

import argparse
import time
from collections.abc import Iterator

from bsm.commands.sequence_options import sequence_options
from bsm.console import Console, print_json
from bsm.files.output import open_output
from bsm.files.permutation import write_permutation
from bsm.files.sequence import Frames
from codec.geometry.mesh import Positions


def encode_sequence(args: argparse.Namespace, console: Console, source: Frames, output: str) -> None:
    """Encode one sequence; every GOP is written as soon as its frames are there."""
    from codec import SequenceEncoder

    begin = time.perf_counter()
    encoder = SequenceEncoder(source.faces, sequence_options(args), source.count)
    taken = 0
    with open_output(output, overwrite=args.force) as file, console.progress("encoding") as progress:

        def counted() -> Iterator[Positions]:
            nonlocal taken
            for frame in source.frames:
                yield frame
                taken += 1
                if source.count:
                    progress(taken, source.count)

        size = 0
        for chunk in encoder.chunks(counted()):
            size += file.write(chunk)
            file.flush()
    seconds = time.perf_counter() - begin
    for note in encoder.notes:
        console.note(f"{args.input}: {note}")
    if args.permutation:
        write_permutation(args.permutation, encoder.vertex_order, overwrite=args.force)
    vertices, faces = len(encoder.vertex_order), len(encoder.face_order)
    bpvf = 8 * size / (vertices * taken)
    if args.json:
        print_json(
            {
                "input": args.input,
                "output": output,
                "frames": taken,
                "vertices": vertices,
                "faces": faces,
                "bytes": size,
                "bpvf_total": bpvf,
                "seconds": seconds,
                "notes": list(encoder.notes),
            }
        )
    else:
        console.note(
            f"{args.input}: {taken} frames of {vertices} vertices, {faces} faces -> {output}: {size} bytes, "
            f"{bpvf:.3f} bits per vertex and frame, {seconds:.2f} s"
        )
