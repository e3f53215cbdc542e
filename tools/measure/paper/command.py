"""Every table and figure of the paper, measured again, in one HTML report: `python -m tools.measure paper -o FILE`."""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Sequence
from pathlib import Path

from bsm.bitstream.errors import OptionError
from bsm.console import Console, print_json
from bsm.files.output import open_output, refuse_to_overwrite
from tools.command import run_command
from tools.measure.paper.compression import boundary, dynamic, rates
from tools.measure.paper.denoising import coarse_to_fine, companions, hand, normals
from tools.measure.paper.iterations import powers, times
from tools.measure.paper.report import Cell, Column, Exhibit, Table, report, summary
from tools.measure.paper.segments import coherence, degrees, number_of_segments, overlap, segmentation, transition
from tools.measure.paper.sequences import sequences
from tools.measure.paper.study import FULL, QUICK, ROLES, Study

EXHIBITS: dict[str, Callable[[Study], Exhibit]] = {
    "segmentation": segmentation,
    "degrees": degrees,
    "boundary": boundary,
    "transition": transition,
    "segments": number_of_segments,
    "overlap": overlap,
    "coherence": coherence,
    "normals": normals,
    "sequences": sequences,
    "rates": rates,
    "dynamic": dynamic,
    "coarse-to-fine": coarse_to_fine,
    "companions": companions,
    "hand": hand,
    "times": times,
    "powers": powers,
}


def make_exhibits(study: Study, names: Sequence[str]) -> dict[str, Exhibit]:
    """Some of `EXHIBITS`."""
    unknown = [name for name in names if name not in EXHIBITS]
    if unknown:
        raise OptionError(f"no exhibit is called {', '.join(unknown)}; there are {', '.join(EXHIBITS)}")
    return {name: EXHIBITS[name](study) for name in names}


def models_table(study: Study) -> Table:
    """Which mesh plays which model of the paper."""
    columns = (Column("vertices", 0, 0.01, "The stand-in has another size."),)
    rows = []
    for role, about in ROLES.items():
        model = study.model(role)
        label = f"{about.name}: {model.name}" + (f" ({about.remark})" if about.remark and study.folder else "")
        rows.append((label, (Cell(float(model.size), float(about.vertices) or None),)))
    return Table("Models", "the paper's model: the mesh used here", columns, tuple(rows))


def work(args: argparse.Namespace, console: Console) -> None:
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


def main() -> None:
    """Run the command."""
    parser = argparse.ArgumentParser(description=__doc__)
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
    run_command(parser, work)
