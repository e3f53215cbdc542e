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
NEEDED = ("bsm._core", "matplotlib", "DracoPy", "zstandard", "pymetis", "flip_evaluator", "ssimulacra2", "pymeshlab")
MINUTES = {
    "rates": 16.0,
    "outside": 8.0,
    "ablation": 12.0,
    "times": 4.0,
    "motion": 6.0,
    "denoising": 7.0,
    "paper": 25.0,
}
QUICK = {"rates": 2.0, "outside": 1.0, "ablation": 1.5, "times": 0.5, "motion": 0.8, "denoising": 0.5, "paper": 4.0}
STAGES = tuple(MINUTES)
PRINTED = {
    **{"1": "number-of-segments", "2": "overlap", "3": "overlap", "4": "overlap", "5": "coherence", "6": "times"},
    **{"7": "powers", "figure-4": "edge-effect", "figure-5": "edge-effect", "figure-8": "coherence"},
    **{"figure-11": "rate-and-error", "figure-12": "dynamic", "figure-13": "coarse-to-fine", "figure-14": "rivals"},
    **{"figure-16": "large", "better": "better", "cost": "complexity", "delta": "shifts"},
}
"""The job that makes each table and figure of the paper."""


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
    subprocess.run([str(python), "-m", "pip", "install", "-q", "-e", f"{ROOT}[eval,replicate]"], check=True)
    os.execv(python, [str(python), "-m", "tools.replicate", *sys.argv[1:]])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("meshes", nargs="*", metavar="MESH", type=Path, help="your own meshes in place of all others")
    parser.add_argument("-o", "--output", metavar="FOLDER", type=Path, default=Path("replicate"))
    parser.add_argument("--quick", action="store_true", help="ten minutes: as many meshes as fit, of all sizes")
    parser.add_argument("--figure", choices=STAGES, help="only this table and figure")
    parser.add_argument("--table", choices=PRINTED, help="of --figure paper, only this table or figure of the paper")
    parser.add_argument("--docs", action="store_true", help="put the tables into docs/measured.md, too")
    args = parser.parse_args()
    if args.table and args.figure != "paper":
        parser.error("--table is of the paper: add --figure paper")
    if args.meshes and args.figure not in (None, "rates", "paper"):
        parser.error(f"--figure {args.figure} takes no meshes; rates and paper do")
    if args.meshes and (short := 5 - len(args.meshes)) > 0 and PRINTED.get(args.table) == "coherence":
        parser.error(f"it compares five models: name {short} more")
    if missing := [str(path) for path in args.meshes if not path.exists()]:
        parser.error(f"no such file: {', '.join(missing)}")
    args.output.mkdir(parents=True, exist_ok=True)
    environment(args.output, FOR_PAPER if args.figure == "paper" else NEEDED)
    from tools.replicate.run import measure_all

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
