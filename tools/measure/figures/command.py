"""The tables of figures that the README shows, measured again: `python -m tools.measure figures MESHES`."""

from __future__ import annotations

import argparse
from dataclasses import asdict
from pathlib import Path

from bsm.console import Console, print_json
from tools.command import run_command
from tools.measure.figures.tables import FIGURES, Source, make_figures


def work(args: argparse.Namespace, console: Console) -> None:
    """Print each figure as it is ready."""
    names = args.only.split(",") if args.only else list(FIGURES)
    source = Source(Path(args.meshes), Path(args.output) if args.output else None, console.note)
    if args.json:
        figures = make_figures(source, names)
        print_json({"figures": [{"name": name, **asdict(figure)} for name, figure in zip(names, figures)]})
        return
    for name in names:
        (figure,) = make_figures(source, [name])
        command = f"python -m tools.measure figures FOLDER --only {name}"
        print(f"### {figure.title}\n\n`{command}`; expected: {figure.expectation}.\n")
        print(f"{figure.text}\n", flush=True)


def main() -> None:
    """Run the command."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("meshes", metavar="FOLDER", help="folder of bunny_34834.ply, fandisk_6475.ply, ...")
    parser.add_argument("--only", metavar="LIST", help=f"{','.join(FIGURES)} (default: all)")
    parser.add_argument("-o", "--output", metavar="FOLDER", help="keep the JSON of the rates there")
    parser.add_argument("--json", action="store_true", help="print it as JSON")
    run_command(parser, work)
