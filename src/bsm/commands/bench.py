"""bsm bench: measure speed against exact eigensolvers and Draco."""

import argparse

from bsm.commands.flags import adder, within
from bsm.console import Console, print_json


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = adder(parser)
    add("meshes", "MESH", "mesh files", nargs="+")
    add("--sample", "N", "number of blocks for exact solvers (default: 16)", type=within(1), default=16)
    add("--repeat", "N", "repeat every measurement; the fastest counts (default: 3)", type=within(1), default=3)
    add("--no-solvers", "", "leave out exact solvers, which take minutes")
    add("--json", "", "print the result as JSON")


def run(args: argparse.Namespace, console: Console) -> None:
    from bsm.evaluation.bench import bench_tables, run_bench

    with console.progress("reading") as progress:
        result = run_bench(
            args.meshes, sample=args.sample, repeats=args.repeat, solvers=not args.no_solvers, note=progress.stage
        )
    if args.json:
        print_json(result)
    else:
        print(bench_tables(result))
