"""bsm encode: a mesh file to a stream."""

from __future__ import annotations

import argparse
import time
from typing import Any

from bitstream.errors import OptionError
from bsm.commands.encode_options import add_encode_flags, encode_options
from bsm.commands.sequence_options import add_sequence_flags, refuse_sequence_flags
from bsm.console import Console, print_json
from bsm.files.mesh import MESH_FORMATS, read_mesh
from bsm.files.naming import default_output, refuse_terminal
from bsm.files.output import open_output, refuse_to_overwrite
from bsm.files.permutation import write_permutation
from bsm.files.sequence import open_sequence


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what the command takes."""
    parser.add_argument(
        "input",
        metavar="IN",
        help="mesh file (OBJ, OFF, PLY, STL, npz), - for standard input, or a sequence: npz, folder, or pattern",
    )
    parser.add_argument("-o", "--output", metavar="OUT", help="where to write (default: IN with .bsm; - for a pipe)")
    parser.add_argument(
        "--format", choices=(*MESH_FORMATS, "npy"), help="format of the input (default: by its name or content)"
    )
    parser.add_argument(
        "--permutation", metavar="FILE.npy", help="also write which input vertex each decoded vertex is"
    )
    parser.add_argument("--json", action="store_true", help="print the result as JSON")
    add_encode_flags(parser)
    add_sequence_flags(parser)


def run(args: argparse.Namespace, console: Console) -> None:
    """Encode one mesh."""
    output = args.output or default_output(args.input, ".bsm")
    if output == "-" and args.json:
        raise OptionError("--json and -o - would both write to standard output")
    refuse_terminal(output)
    for path in filter(None, (output, args.permutation)):
        refuse_to_overwrite(path, args.force)

    from codec import Encoder

    if sequence := open_sequence(args.input, args.format):
        from bsm.commands.sequence_encode import encode_sequence

        encode_sequence(args, console, sequence, output)
        return
    refuse_sequence_flags(args)
    options = encode_options(args)
    source = read_mesh(args.input, args.format)
    begin = time.perf_counter()
    encoder = Encoder(source.mesh, options)
    with open_output(output, overwrite=args.force) as file, console.progress("encoding") as progress:
        size = sum(file.write(chunk) for chunk in encoder.chunks(progress))
    seconds = time.perf_counter() - begin
    notes = (*source.notes, *encoder.notes)
    for note in notes:
        console.note(f"{args.input}: {note}")
    if args.permutation:
        write_permutation(args.permutation, encoder.vertex_order, overwrite=args.force)
    vertices, faces = len(encoder.mesh.positions), len(encoder.mesh.faces)
    result: dict[str, Any] = {
        "input": args.input,
        "output": output,
        "vertices": vertices,
        "faces": faces,
        "bytes": size,
        "bpv_total": 8 * size / vertices,
        "seconds": seconds,
        "notes": list(notes),
    }
    if args.json:
        print_json(result)
    else:
        console.note(
            f"{args.input}: {vertices} vertices, {faces} faces -> {output}: {size} bytes, "
            f"{result['bpv_total']:.2f} bits per vertex, {seconds:.2f} s"
        )
