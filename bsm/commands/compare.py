"""bsm compare: how far one mesh is from another of the same faces."""

from __future__ import annotations

import argparse
from dataclasses import asdict

from bsm.commands.reader import add_reader_flag
from bsm.console import Console, finite, print_json
from bsm.exits import about
from bsm.files.mesh import read_mesh
from bsm.files.permutation import in_order_of, read_permutation
from bsm.files.pipes import read_chunks
from bsm.files.stream import decode_whole, is_stream
from codec.arrays import Positions
from codec.geometry.mesh import TriangleMesh


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what the command takes."""
    parser.add_argument("original", metavar="A", help="original: mesh file or stream, or a sequence of meshes")
    parser.add_argument("decoded", metavar="B", help="what became of it, in any of these forms")
    parser.add_argument("--permutation", metavar="FILE.npy", help="what encode wrote: vertex p[j] of A is j of B")
    parser.add_argument(
        "--surface",
        action="store_true",
        help="of meshes also the mean normal difference, the rms error over the mean edge, and the Hausdorff distance",
    )
    add_reader_flag(parser)
    parser.add_argument("--json", action="store_true", help="print it as JSON")


def run(args: argparse.Namespace, console: Console) -> None:
    """Compare two meshes."""
    from bsm.commands.sequence_compare import compare_if_sequences
    from codec.geometry.metrics import compare
    from codec.static.joining import join

    if compare_if_sequences(args):
        return
    original, decoded = (_load(path, args.reader, console) for path in (args.original, args.decoded))
    order = read_permutation(args.permutation) if args.permutation else None
    if len(original.positions) != len(decoded.positions) and order is None:
        # An encoder makes vertices at one position one.
        original = join(original, keep=False).mesh
        if len(original.positions) != len(decoded.positions):
            decoded = join(decoded, keep=False).mesh
        console.note("vertices at one position are compared as one")
    positions = in_order_of(original, decoded, order)
    result = asdict(compare(original.positions, positions, original.faces))
    if args.surface:
        result |= _surface(original, positions)
    if args.json:
        print_json({name: finite(value) for name, value in result.items()})
    else:
        print("\n".join(f"{name:<19}{value:.6g}" for name, value in result.items()))


def _surface(original: TriangleMesh, positions: Positions) -> dict[str, float]:
    """What the literature on denoising measures."""
    from codec.geometry.metrics import mnd, rms_over_edge
    from codec.geometry.surface_distance import surface_distance

    faces = original.faces
    distance = surface_distance(original.positions, faces, positions, faces)
    return {
        "mnd": mnd(original.positions, positions, faces),
        "rms_over_edge": rms_over_edge(original.positions, positions, faces),
        "hausdorff": distance.hausdorff,
        "hausdorff_relative": distance.hausdorff / (original.diagonal or 1.0),
        "surface_distance": distance.mean,
    }


def _load(path: str, reader: str | None, console: Console) -> TriangleMesh:
    """A mesh file or a stream, without the vertices that no face uses."""
    with about(path):
        if is_stream(path):
            return decode_whole(read_chunks(path))
        source = read_mesh(path, reader=reader)
    for note in source.notes:
        console.note(f"{path}: {note}")
    return source.mesh.without_isolated_vertices()[0]
