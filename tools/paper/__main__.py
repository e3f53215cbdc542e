"""Every table and figure of the paper, measured again, in one HTML report: `python -m tools.paper -o REPORT.html`."""

from __future__ import annotations

import argparse
import time
from pathlib import Path

from bsm.bitstream.errors import OptionError
from bsm.console import Console, print_json
from bsm.files.output import open_output, refuse_to_overwrite
from tools.command import run_command
from tools.paper.exhibits import EXHIBITS, make_exhibits, models_table
from tools.paper.report import report, summary
from tools.paper.study import FULL, QUICK, Study


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m tools.paper", description=__doc__)
    parser.add_argument("-o", "--output", metavar="REPORT.html", required=True, help="where to write the report")
    parser.add_argument(
        "--meshes",
        metavar="FOLDER",
        help="folder of real meshes, with static/, noisy/ and dynamic/ (default: generated meshes)",
    )
    parser.add_argument("--only", metavar="LIST", help="names of exhibits, separated by commas (default: all)")
    parser.add_argument("--quick", action="store_true", help="few settings and small meshes: seconds, not minutes")
    parser.add_argument("--json", action="store_true", help="print the data of all tables as JSON")
    parser.add_argument("-f", "--force", action="store_true", help="overwrite the report")
    return parser


def main(args: argparse.Namespace, console: Console) -> None:
    """Measure, write the report, and say how many numbers agree with the paper's."""
    refuse_to_overwrite(args.output, args.force)
    folder = Path(args.meshes) if args.meshes else None
    if folder is not None and not (folder / "static").is_dir():
        raise OptionError(f"{folder} has no folder static/")

    begin = time.perf_counter()
    study = Study(folder, QUICK if args.quick else FULL, console.note)
    if folder is None:
        console.note("no folder of real meshes was named: generated ones stand in for the paper's models")
    exhibits = make_exhibits(study, args.only.split(",") if args.only else list(EXHIBITS))
    text = report(exhibits, models_table(study), generated=folder is None, quick=args.quick)
    with open_output(args.output, overwrite=args.force) as file:
        file.write(text.encode())
    console.note(f"{args.output}: {len(text) / 1e6:.1f} MB, {time.perf_counter() - begin:.0f} s")
    if args.json:
        print_json({name: exhibit.as_json() for name, exhibit in exhibits.items()})
    elif folder is None:
        print("not comparable with the paper: generated meshes stand in for its models")
    else:
        print(summary(exhibits))


if __name__ == "__main__":
    run_command(_parser(), main)
