"""bsm compare: how far one mesh is from another of the same faces."""

from __future__ import annotations

import argparse
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from bsm.bitstream.errors import MeshError
from bsm.codec.arrays import Positions
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.commands.denoise_report import length, unit_of
from bsm.commands.limits import add_limits_flag, limits_of
from bsm.commands.reader import add_reader_flag
from bsm.console import Console, finite, print_json, printable
from bsm.files.about import about
from bsm.files.mesh import read_mesh
from bsm.files.output import open_output, refuse_to_overwrite
from bsm.files.permutation import read_permutation
from bsm.files.pipes import read_chunks
from bsm.files.stream import decode_whole, is_stream

if TYPE_CHECKING:
    from bsm.codec.look.measure import Look


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
    parser.add_argument(
        "--look",
        action="store_true",
        help="also how much alike they look in pictures: nobody can tell them apart at a distance of 1; faces of "
        "meshes may differ; of a sequence every frame",
    )
    parser.add_argument(
        "--picture",
        metavar="FILE.png",
        help="write a picture of both and of their difference, from the side where that is largest (implies --look); "
        "of sequences, the errors of each frame as a curve",
    )
    parser.add_argument(
        "--map",
        metavar="FILE",
        help="write where A's vertices are how far off in colours, blue to red: a picture (.png), or A as a mesh with "
        "colours (.ply, .obj, .glb)",
    )
    add_reader_flag(parser)
    add_limits_flag(parser)
    parser.add_argument("--json", action="store_true", help="print it as JSON")


def run(args: argparse.Namespace, console: Console) -> None:
    """Compare two meshes."""
    from bsm.commands.sequence_compare import compare_if_sequences

    if compare_if_sequences(args, console):
        return
    with console.progress("reading") as progress:
        original, decoded = (_load(path, args, console) for path in (args.original, args.decoded))
        seen = None
        if args.look or args.picture:
            progress.stage("looking from all sides")
            seen = _look(original, decoded, args)
        progress.stage("comparing")
        try:
            compared = _compared(original, decoded, args, console)
        except MeshError:
            if seen is None:
                raise
            console.note("the meshes have different faces, so that only their look is compared")
            compared = {}
    attributes = compared.pop("attributes", {})
    if args.json:
        shown = {"look": asdict(seen)} if seen else {}
        print_json({**compared, **shown, **({"attributes": attributes} if attributes else {})})
        return
    lines = [f"{sentence(compared, unit_of(original.metadata))}\n"] if compared else []
    lines += [f"{name:<19}{'-inf' if value is None else f'{value:.6g}'}\n" for name, value in compared.items()]
    if seen:
        parts = f"1 - SSIM {seen.dissimilarity:.4g}, {100 * seen.visible:.3g} % of pixels differ visibly"
        lines.append(f"{'look':<19}{seen.distance:.4g} ({parts})\n")
    print("".join((*lines, *map(_worded, attributes.items()))), end="")


def _compared(
    original: TriangleMesh, decoded: TriangleMesh, args: argparse.Namespace, console: Console
) -> dict[str, Any]:
    """Numbers by name, and errors of attributes."""
    from bsm.comparison import compare_meshes, pair

    paired = pair(original, decoded, read_permutation(args.permutation) if args.permutation else None)
    if paired.joined:
        console.note("vertices at one position are compared as one")
    if args.map:
        from bsm.commands.distance_map import write_map

        write_map(args.map, paired.original, paired.positions, overwrite=args.force)
    result = asdict(compare_meshes(original, decoded, paired))
    attributes = {name: errors and _known(errors) for name, errors in result.pop("attributes").items()}
    if args.surface:
        result |= _surface(paired.original, paired.positions)
    return {**{name: finite(value) for name, value in result.items()}, "attributes": attributes}


def sentence(compared: dict[str, Any], unit: str) -> str:
    """What the numbers mean, with units."""
    share = 100.0 * compared["max_error_relative"]
    if share == 0.0:
        return "no vertex is off"
    rms = compared["rms_relative"] / compared["max_error_relative"] * compared["max_error"]
    return (
        f"the farthest vertex is {length(compared['max_error'], unit)} off, {share:.3g} % of the diagonal; root mean "
        f"square {length(rms, unit)}; faces are turned by {compared['angle_deg']:.3g} degrees, in the mean by area"
    )


def _look(original: TriangleMesh, decoded: TriangleMesh, args: argparse.Namespace) -> Look:
    from bsm.codec.look.measure import Looker

    if args.picture:
        refuse_to_overwrite(args.picture, args.force)
    looker = Looker(original)
    seen = looker.compare(decoded)
    if args.picture:
        from bsm.files.picture import png, side_by_side

        picture = png(side_by_side(*looker.pictures(decoded)))
        with open_output(args.picture, overwrite=args.force) as file:
            file.write(picture)
    return seen


def _known(errors: dict[str, float | None]) -> dict[str, float]:
    return {name: value for name, value in errors.items() if value is not None}


def _worded(attribute: tuple[str, dict[str, float] | None]) -> str:
    name, errors = printable(attribute[0]), attribute[1]
    if errors is None:
        return f"{name}: not there any more\n"
    return f"{name}: {', '.join(f'{what} {value:.4g}' for what, value in errors.items())}\n"


def _surface(original: TriangleMesh, positions: Positions) -> dict[str, float]:
    """What the literature on denoising measures."""
    from bsm.codec.geometry.metrics import mnd, rms_over_edge
    from bsm.codec.geometry.surface_distance import surface_distance

    faces = original.faces
    distance = surface_distance(original.positions, faces, positions, faces)
    return {
        "mnd": mnd(original.positions, positions, faces),
        "rms_over_edge": rms_over_edge(original.positions, positions, faces),
        "hausdorff": distance.hausdorff,
        "hausdorff_relative": distance.hausdorff / (original.diagonal or 1.0),
        "surface_distance": distance.mean,
    }


def _load(path: str, args: argparse.Namespace, console: Console) -> TriangleMesh:
    """A mesh file or a stream, without the vertices that no face uses."""
    with about(path):
        if is_stream(path):
            return decode_whole(read_chunks(path), limits_of(args.limits))
        source = read_mesh(path, reader=args.reader)
    for note in source.notes:
        console.note(f"{path}: {note}")
    return source.mesh.without_isolated_vertices()[0]
