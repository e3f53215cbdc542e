"""bsm boundary: the error inside blocks and at their boundaries, for three ways of joining them."""

from __future__ import annotations

import argparse
from pathlib import Path

from bsm.commands.encode_options import add_coding_flags, given_options
from bsm.console import Console, print_json
from bsm.files.mesh import read_mesh


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what the command takes."""
    parser.add_argument("input", metavar="MESH", help="mesh file")
    parser.add_argument("-o", "--output", metavar="STEM", help="draw the box plot as STEM.png and STEM.svg")
    parser.add_argument("--json", action="store_true", help="print it as JSON")
    add_coding_flags(parser)


def run(args: argparse.Namespace, console: Console) -> None:
    """Print the quartiles over the blocks, as the paper's box plot shows them."""
    from bsm.evaluation.codecs import paper_options
    from bsm.evaluation.per_block import boundary_rows, boundary_table, quartiles

    mesh = read_mesh(args.input).mesh
    deviations_of = boundary_table(mesh, paper_options(**{"power": 2, **given_options(args)}))
    rows = [
        {"case": case, "where": where, **quartiles(deviations)}
        for case, groups in deviations_of.items()
        for where, deviations in groups.items()
    ]
    if args.json:
        print_json({"mesh": Path(args.input).stem, "rows": rows})
    else:
        print("Standard deviation of the error over the blocks, in thousandths of the diagonal:\n")
        print(boundary_rows(rows))
    if args.output:
        from bsm.evaluation.plots import draw_boxes

        for path in draw_boxes(deviations_of, Path(args.output)):
            console.note(str(path))
