"""bsm figures: the tables of figures that the README shows, measured again."""

from __future__ import annotations

import argparse
from pathlib import Path

from bsm.console import Console, print_json


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what the command takes."""
    parser.add_argument("meshes", metavar="FOLDER", help="folder of bunny_34834.ply, fandisk_6475.ply, ...")
    parser.add_argument(
        "--only",
        metavar="LIST",
        help="basis,order,boundary,dynamic,connectivity,rates,coefficients,scale (default: all)",
    )
    parser.add_argument("-o", "--output", metavar="FOLDER", help="keep the JSON of the rates there")
    parser.add_argument("--json", action="store_true", help="print it as JSON")


def run(args: argparse.Namespace, console: Console) -> None:
    """Print each figure as it is ready."""
    from dataclasses import asdict

    from bsm.evaluation.figures import FIGURES, Source, make_figures

    names = args.only.split(",") if args.only else list(FIGURES)
    source = Source(Path(args.meshes), Path(args.output) if args.output else None, console.note)
    if args.json:
        figures = make_figures(source, names)
        print_json({"figures": [{"name": name, **asdict(figure)} for name, figure in zip(names, figures)]})
        return
    for name in names:
        (figure,) = make_figures(source, [name])
        print(f"### {figure.title}\n\n`bsm figures FOLDER --only {name}`; expected: {figure.expectation}.\n")
        print(f"{figure.text}\n", flush=True)
