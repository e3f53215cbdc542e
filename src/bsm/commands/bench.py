"""bsm bench: how fast it is, against exact eigensolvers and against Draco."""

from __future__ import annotations

import argparse

from bsm.console import Console, print_json


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what the command takes."""
    parser.add_argument("meshes", metavar="MESH", nargs="+", help="mesh files")
    parser.add_argument(
        "--sample", type=int, default=16, metavar="N", help="blocks that exact solvers solve (default: %(default)s)"
    )
    parser.add_argument(
        "--repeat", type=int, default=3, metavar="N", help="runs of everything, the fastest counts (default: 3)"
    )
    parser.add_argument("--no-solvers", action="store_true", help="leave out exact eigensolvers, which take minutes")
    parser.add_argument("--json", action="store_true", help="print it as JSON")


def run(args: argparse.Namespace, console: Console) -> None:
    """Measure and print."""
    from bsm.evaluation.bench import bench_tables, run_bench

    with console.progress("reading") as progress:
        result = run_bench(
            args.meshes, sample=args.sample, repeats=args.repeat, solvers=not args.no_solvers, note=progress.stage
        )
    if args.json:
        print_json(result)
    else:
        print(bench_tables(result))
