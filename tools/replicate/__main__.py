"""Measures everything that docs/measured.md says, from nothing: `python -m tools.replicate`.

Makes an environment where packages are missing, fetches the meshes of meshes.json, measures and writes one folder:
tables in Markdown and LaTeX, figures in PDF and PNG, and results.json with every number, the commit, the processor and
the time. About an hour on two cores; a run that was cut goes on where it was. With files of your own, their rates, or
one table of the paper: `--figure paper --table 3 own.ply`.
"""

import argparse
import importlib.util
import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
FOR_PAPER = ("bsm._core", "matplotlib", "zstandard", "pymetis", "threadpoolctl", "DracoPy")
NEEDED = (
    "bsm._core",
    "matplotlib",
    "DracoPy",
    "zstandard",
    "pymetis",
    "flip_evaluator",
    "ssimulacra2",
    "pymeshlab",
)
MINUTES = {
    "rates": 16.0,
    "outside": 8.0,
    "ablation": 12.0,
    "times": 4.0,
    "motion": 6.0,
    "denoising": 7.0,
    "paper": 25.0,
}
QUICK = {
    "rates": 2.0,
    "outside": 1.0,
    "ablation": 1.5,
    "times": 0.5,
    "motion": 0.8,
    "denoising": 0.5,
    "paper": 4.0,
}
LONGEST = 60.0
"""Minutes that verdicts or shares may take."""
STAGES = tuple(MINUTES)
JOBS = {
    "basis": "8.1: orthogonal iterations and the exact basis, at 12 bits",
    "rate-and-error": "8.1, Figure 11: NMSVE over bits per vertex",
    "speed": "8.1: times of dictionaries, and of exact solvers",
    "better": "the paper's mode, the codec and Draco at equal NMSVE",
    "dynamic": "8.1, Figure 12: dynamic orthogonal iterations",
    "warm-start": "4 and 6.4: gain of a start from the block before",
    "iterations-or-powers": "8.1: one iteration of R^z, or z iterations of R",
    "first-block": "4: choice of the first block",
    "convergence": "4: rate of convergence",
    "orthonormalization": "4: three ways to orthonormalize",
    "complexity": "8.1: time by the size of blocks and by c",
    "shifts": "4: delta",
    "edge-effect": "6.1, Figures 4 and 5: errors at the boundaries of segments",
    "number-of-segments": "6.2, Table 1: number of segments",
    "overlap": "6.3, Tables 2 to 4: size of the overlapping segments",
    "parts": "6.3: parts that arrive one by one",
    "coherence": "6.4, Table 5, Figure 8: coherence of segments; of five models",
    "times": "8.2, Table 6: NMSVE and times",
    "large": "8.2: dictionaries of a large mesh",
    "powers": "8.2, Table 7, Figure 16: powers of R",
    "rivals": "8.2, Figure 14: other methods after the coarse step",
    "fewer-iterations": "8.2: iterations after the coarse step",
    "coarse-to-fine": "8.2, Figure 13: coarse to fine",
    "temporal-basis": "7.3: a temporal basis that follows from GOP to GOP; a named mesh bends",
}
"""What each job measures."""
PRINTED = {
    **{
        "1": "number-of-segments",
        "2": "overlap",
        "3": "overlap",
        "4": "overlap",
        "5": "coherence",
        "6": "times",
    },
    **{
        "7": "powers",
        "figure-4": "edge-effect",
        "figure-5": "edge-effect",
        "figure-8": "coherence",
    },
    **{
        "figure-11": "rate-and-error",
        "figure-12": "dynamic",
        "figure-13": "coarse-to-fine",
        "figure-14": "rivals",
    },
    **{"figure-16": "powers", "cost": "complexity", "delta": "shifts"},
    **{name: name for name in JOBS},
}
"""The job that makes each table and figure of the paper; jobs go by their own names, too."""


def environment(folder: Path, needed: tuple[str, ...]) -> None:
    """Go on in an environment of this folder, if packages are missing here."""
    try:
        missing = [name for name in needed if importlib.util.find_spec(name) is None]
    except ModuleNotFoundError:  # not even bsm
        missing = ["bsm"]
    if not missing:
        return
    python = folder / "environment" / "bin" / "python"
    if Path(sys.executable).absolute() == python.absolute():
        raise SystemExit(f"{', '.join(missing)} cannot be installed here")
    where = f"installs the extras eval and replicate with pip into {python.parents[1]}"
    print(f"missing here: {', '.join(missing)}; {where}", flush=True)
    if not python.exists():
        subprocess.run([sys.executable, "-m", "venv", str(python.parents[1])], check=True)
    subprocess.run(
        [str(python), "-m", "pip", "install", "-q", "-e", f"{ROOT}[eval,replicate]"], check=True
    )
    os.execv(python, [str(python), "-m", "tools.replicate", *sys.argv[1:]])


def listed_jobs() -> list[str]:
    """A line for each job: its names for --table, and what it measures."""
    lines = []
    for job, words in JOBS.items():
        names = [name for name, made in PRINTED.items() if made == job and name != job]
        others = f" ({', '.join(names)})" if names else ""
        lines.append(f"{job}{others}: {words}")
    return lines


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "meshes",
        nargs="*",
        metavar="MESH",
        type=Path,
        help="your own meshes in place of all others",
    )
    parser.add_argument("-o", "--output", metavar="FOLDER", type=Path, default=Path("replicate"))
    parser.add_argument(
        "--quick", action="store_true", help="ten minutes: as many meshes as fit, of all sizes"
    )
    parser.add_argument("--figure", choices=STAGES, help="only this table and figure")
    about = "of --figure paper, only this table or figure of the paper, or this job of --list"
    parser.add_argument("--table", choices=PRINTED, metavar="NAME", help=about)
    judged = "of --figure paper, judge the claims on each MESH, with few settings: how many hold, and the spread"
    parser.add_argument("--verdicts", action="store_true", help=judged)
    shared = "of --figure paper, count what blocks carry in default streams of each MESH, and do without them"
    parser.add_argument("--shares", action="store_true", help=shared)
    parser.add_argument("--list", action="store_true", help="list the jobs of --figure paper")
    parser.add_argument(
        "--docs", action="store_true", help="put the tables into docs/measured.md, too"
    )
    args = parser.parse_args()
    if args.list:
        print("\n".join(listed_jobs()))
        return
    if args.table and args.figure != "paper":
        parser.error("--table is of the paper: add --figure paper")
    alone = args.verdicts or args.shares
    if alone and (args.figure != "paper" or not args.meshes or args.table):
        parser.error(
            "--verdicts and --shares take named meshes: add --figure paper and the meshes, without --table"
        )
    if args.meshes and args.figure not in (None, "rates", "paper"):
        parser.error(f"--figure {args.figure} takes no meshes; rates and paper do")
    too_few = 0 < len(args.meshes) < 5 and PRINTED.get(args.table) == "coherence"
    if too_few and not os.environ.get("BSM_MESHES"):
        parser.error(
            "it compares five models: name five, or let BSM_MESHES name a folder with those of the paper"
        )
    if missing := [str(path) for path in args.meshes if not path.exists()]:
        parser.error(f"no such file: {', '.join(missing)}")
    args.output.mkdir(parents=True, exist_ok=True)
    environment(args.output, FOR_PAPER if args.figure == "paper" else NEEDED)
    from tools.replicate.run import judge_all, measure_all, share_all

    if args.verdicts:
        judge_all(args.output, LONGEST, args.meshes, docs=args.docs)
    if args.shares:
        share_all(args.output, LONGEST, args.meshes, docs=args.docs)
    if alone:
        return
    chosen = (args.figure,) if args.figure else ("rates",) if args.meshes else STAGES
    minutes = QUICK if args.quick else MINUTES
    wanted = {stage: minutes[stage] for stage in chosen}
    measure_all(
        args.output,
        wanted,
        quick=args.quick,
        docs=args.docs and not args.meshes,
        named=args.meshes,
        job=PRINTED.get(args.table),
    )


if __name__ == "__main__":
    main()
