"""bsm untile: join a folder of tiles into one mesh."""

import argparse
from pathlib import Path
from typing import Any

from bsm.bitstream.errors import OptionError
from bsm.commands.flags import add_limits_flag, adder, limits_of, numbers
from bsm.console import Console
from bsm.files.mesh import by_name
from bsm.files.output import refuse_terminal, refuse_to_overwrite
from bsm.tiles.joining import CONTENT_HELP, CONTENTS, TILESET, write_joined, write_tileset
from bsm.tiles.shards import open_tiles


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add, of = adder(parser), adder(parser.add_mutually_exclusive_group())
    add("input", "FOLDER", "folder of tiles, or its URL")
    output = ".ply of any size, - for a pipe, or .../tileset.json (3D Tiles). Other formats must fit into memory"
    add("-o --output", "OUT", output, required=True)
    add("--box", "X,Y,Z,X,Y,Z", "only triangles that meet this box; they must fit into memory", type=numbers(6))
    of("--level", "N", "level of detail; 0 is the coarsest (default: the finest)", type=int)
    of("--error", "H", "the coarsest tiles with an error of at most H, in the unit of the mesh", type=float)
    add("--content", "", CONTENT_HELP, choices=CONTENTS, default=CONTENTS[0])
    add_limits_flag(parser)


def run(args: argparse.Namespace, console: Console) -> None:
    tiles = open_tiles(args.input, limits_of(args.limits))
    refuse_to_overwrite(args.output, args.force)
    levels = [level["level"] for level in tiles.manifest["levels"]]
    if args.level is not None and not levels[0] <= args.level <= levels[-1]:
        raise OptionError(f"--level {args.level}: these tiles have levels {levels[0]} to {levels[-1]}")
    if Path(args.output).name == TILESET:
        if args.box or args.level is not None or args.error is not None:
            raise OptionError(f"{TILESET} contains all tiles; leave out --box, --level and --error")
        folder = args.output[: -len(TILESET)].rstrip("/") or "."
        write_tileset(tiles, folder, console, content=args.content, overwrite=args.force)
        return
    if args.box is None and (args.output == "-" or Path(args.output).suffix.lower() == ".ply"):
        refuse_terminal(args.output)
        chosen = tiles.chosen(args.error or 0.0, level=args.level)
        summary = write_joined(tiles, chosen, args.output, console, overwrite=args.force)
    else:
        far = 1e300
        ends = args.box or (-far, -far, -far, far, far, far)
        with console.progress("decoding"):
            mesh = tiles.region(ends[:3], ends[3:], args.error or 0.0, level=args.level)
        summary = {"vertices": len(mesh.positions), "faces": len(mesh.faces)}
        grid: dict[str, Any] = {"grid_cell": tiles.lattice.cell, "grid_origin": tiles.lattice.origin}
        stream = Path(args.output).suffix.lower() == ".bsm"
        by_name("bsm.api", "save")(mesh, args.output, overwrite=args.force, **(grid if stream else {}))
    console.note(f"{args.input} -> {args.output}: {summary['vertices']} vertices, {summary['faces']} faces")
