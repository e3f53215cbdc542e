"""bsm noise: add noise to a mesh, to try denoising on."""

from __future__ import annotations

import argparse
from collections.abc import Callable

from bsm.bitstream.errors import OptionError
from bsm.codec.arrays import Positions
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.commands.reader import add_reader_flag
from bsm.console import Console, print_json
from bsm.files.about import about
from bsm.files.mesh import MESH_FORMATS, format_of_name, read_mesh, save_written, written_mesh
from bsm.files.naming import refuse_terminal
from bsm.files.output import refuse_to_overwrite
from bsm.jobs.run import refuse_collisions

KINDS = ("gaussian", "isotropic", "uniform", "impulsive", "axis", "correlated", "ripples", "range", "rounded", "part")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what the command takes."""
    parser.add_argument("input", metavar="IN", help="mesh file (OBJ, OFF, PLY, STL, VTP, npz), or - for standard input")
    parser.add_argument("-o", "--output", metavar="OUT", required=True, help="mesh file, in the format of its name")
    parser.add_argument("--format", choices=MESH_FORMATS, help="format of the input, and of a piped output")
    parser.add_argument(
        "--sigma", type=float, required=True, metavar="S", help="standard deviation, in mean edge lengths"
    )
    parser.add_argument(
        "--kind",
        choices=KINDS,
        default="gaussian",
        help="Gaussian along the normals (default); in all directions; from an interval; on some vertices only; along "
        "one axis (a depth camera); shared by neighbours (a scanner); waves; along one axis and growing with the "
        "distance; coordinates rounded to a grid; in one part of the mesh only",
    )
    parser.add_argument(
        "--fraction", type=float, metavar="P", help="share of the vertices, impulsive and part only (0.5)"
    )
    parser.add_argument(
        "--axis", type=float, nargs=3, metavar=("X", "Y", "Z"), help="direction, axis and range only (0 0 1)"
    )
    parser.add_argument("--seed", type=int, default=0, metavar="N", help="the same seed gives the same noise (0)")
    add_reader_flag(parser)
    parser.add_argument("--json", action="store_true", help="print what was done as JSON")


def run(args: argparse.Namespace, console: Console) -> None:
    """Make one mesh noisy."""
    if args.output == "-" and args.json:
        raise OptionError("--json and -o - would both write to standard output")
    if args.seed < 0:
        raise OptionError(f"the seed must not be negative, not {args.seed}")
    refuse_terminal(args.output)
    kind = args.format if args.output == "-" else format_of_name(args.output)
    if kind not in MESH_FORMATS:
        raise OptionError(f"{args.output}: the name tells no mesh format; use one of .{', .'.join(MESH_FORMATS)}")
    refuse_to_overwrite(args.output, args.force)
    move = _generator(args)

    from bsm.codec.geometry.metrics import rms_over_edge

    refuse_collisions([args.input], [args.output])
    with console.progress("reading") as progress:
        with about(args.input):
            mesh = read_mesh(args.input, args.format, reader=args.reader).mesh
        progress.stage("moving vertices")
        noisy = move(mesh)
        moved, stale = mesh.moved(noisy)
        left_out = save_written(args.output, written_mesh(moved, kind, args.output), overwrite=args.force)
    if left_out or stale:
        console.note(f"{args.input}: left out: {', '.join((*stale, *left_out))}")
    rms = rms_over_edge(mesh.positions, noisy, mesh.faces)
    console.note(f"{args.input}: {len(noisy)} vertices moved by {rms:.3f} mean edges (rms) -> {args.output}")
    if args.json:
        print_json({"input": args.input, "output": args.output, "vertices": len(noisy), "rms_over_edge": rms})


def _generator(args: argparse.Namespace) -> Callable[[TriangleMesh], Positions]:
    from bsm.codec.denoise.noise import gaussian as noise

    sigma, seed = args.sigma, args.seed
    if args.fraction is not None and args.kind not in ("impulsive", "part"):
        raise OptionError("--fraction goes with --kind impulsive and --kind part only")
    if args.axis is not None and args.kind not in ("axis", "range"):
        raise OptionError("--axis goes with --kind axis and --kind range only")
    if args.kind in ("impulsive", "part"):
        some = noise.impulsive if args.kind == "impulsive" else noise.gaussian_in_part
        fraction = 0.5 if args.fraction is None else args.fraction
        return lambda mesh: some(mesh.positions, mesh.faces, sigma, fraction, seed)
    if args.kind in ("axis", "range"):
        along = noise.gaussian_along_axis if args.kind == "axis" else noise.gaussian_with_range
        axis = (0.0, 0.0, 1.0) if args.axis is None else tuple(args.axis)
        return lambda mesh: along(mesh.positions, mesh.faces, sigma, seed, axis)
    generate = {
        "gaussian": noise.gaussian_along_normals,
        "isotropic": noise.gaussian_isotropic,
        "uniform": noise.uniform_along_normals,
        "correlated": noise.correlated_along_normals,
        "ripples": noise.ripples_along_normals,
        "rounded": noise.rounded,
    }[args.kind]
    return lambda mesh: generate(mesh.positions, mesh.faces, sigma, seed)
