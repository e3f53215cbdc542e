"""bsm untile: join a folder of tiles into one mesh."""

import argparse
from pathlib import Path
from typing import Any

from bsm.bitstream.errors import OptionError
from bsm.bitstream.limits import as_limits
from bsm.commands.flags import add_flags, adder
from bsm.files.output import refuse_terminal, refuse_to_overwrite
from bsm.files.table import by_name
from bsm.ground.console import Console
from bsm.tiles.joining import CONTENT_HELP, CONTENTS, TILESET, write_joined, write_tileset
from bsm.tiles.shards import open_tiles


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_flags(parser, "untile", "limits")
    add_flags(parser.add_mutually_exclusive_group(), "untile one of")
    adder(parser)("--content", "", CONTENT_HELP, choices=CONTENTS, default=CONTENTS[0])


def run(args: argparse.Namespace, console: Console) -> None:
    tiles = open_tiles(args.input, as_limits(args.limits))
    refuse_to_overwrite(args.output, args.force)
    levels = [level["level"] for level in tiles.manifest["levels"]]
    if args.level is not None and not levels[0] <= args.level <= levels[-1]:
        raise OptionError(
            f"--level {args.level}: these tiles have levels {levels[0]} to {levels[-1]}"
        )
    if Path(args.output).name == TILESET:
        if args.box or args.level is not None or args.error is not None:
            raise OptionError(f"{TILESET} contains all tiles; leave out --box, --level and --error")
        folder = args.output[: -len(TILESET)].rstrip("/") or "."
        write_tileset(tiles, folder, console, content=args.content, overwrite=args.force)
        return
    # PLY can be written with the memory of a tile. Other formats need the whole mesh at once.
    if args.box is None and (args.output == "-" or Path(args.output).suffix.lower() == ".ply"):
        refuse_terminal(args.output)
        chosen = tiles.chosen(args.error or 0.0, level=args.level)
        summary = write_joined(tiles, chosen, args.output, console, overwrite=args.force)
    else:
        # Numbers rather than infinities, since the box is divided by the cell.
        ends = args.box or (*(-1e300,) * 3, *(1e300,) * 3)
        with console.progress("decoding"):
            mesh = tiles.region(ends[:3], ends[3:], args.error or 0.0, level=args.level)
        summary = {"vertices": len(mesh.positions), "faces": len(mesh.faces)}
        # On the grid that the tiles are on, a stream keeps their positions to the bit.
        grid: dict[str, Any] = {}
        if Path(args.output).suffix.lower() == ".bsm":
            grid = {"grid_cell": tiles.lattice.cell, "grid_origin": tiles.lattice.origin}
        by_name("bsm.api", "save")(mesh, args.output, overwrite=args.force, **grid)
    console.note(
        f"{args.input} -> {args.output}: {summary['vertices']} vertices, {summary['faces']} faces"
    )
