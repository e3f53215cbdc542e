"""The error inside blocks and at their boundaries, for three ways of joining them.

python -m tools.measure boundary MESH
"""

from __future__ import annotations

import argparse
from pathlib import Path

from bsm.commands.encode_options import add_coding_flags, settings_of
from bsm.console import Console, print_json
from bsm.evaluation.codecs import paper_options
from bsm.evaluation.per_block import boundary_rows, boundary_table, quartiles
from bsm.evaluation.plots import draw_boxes
from bsm.files.mesh import read_mesh
from tools.command import run_command


def work(args: argparse.Namespace, console: Console) -> None:
    """Print the quartiles over the blocks, as the paper's box plot shows them."""
    mesh = read_mesh(args.input).mesh
    deviations_of = boundary_table(mesh, paper_options(**{"power": 2, **settings_of(args)}))
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
        for path in draw_boxes(deviations_of, Path(args.output)):
            console.note(str(path))


def main() -> None:
    """Run the command."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("input", metavar="MESH", help="mesh file")
    parser.add_argument("-o", "--output", metavar="STEM", help="draw the box plot as STEM.png and STEM.svg")
    parser.add_argument("--json", action="store_true", help="print it as JSON")
    add_coding_flags(parser)
    run_command(parser, work)
