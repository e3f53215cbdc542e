"""A corpus behind URLs, encoded on a Dask cluster.

    python examples/corpus.py 's3://bucket/raw/*.ply' s3://bucket/bsm/ --scheduler tcp://10.0.0.1:8786
    python examples/corpus.py 'memory://raw/*.ply' memory://bsm/

Needs the extras `remote` and `dask`, and for s3:// the package s3fs. Without a scheduler, a cluster of threads is
started here. Run it again with the same report and only what is missing is done.
"""

from __future__ import annotations

import argparse
from contextlib import nullcontext

from distributed import LocalCluster

import bsm


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("source", help="URL with * for any name")
    parser.add_argument("target", help="URL of a folder, with a slash at its end")
    parser.add_argument(
        "--scheduler", help="address of a Dask scheduler (default: threads of this process)"
    )
    parser.add_argument("--preset", default="balanced")
    parser.add_argument("--report", help="JSON file of what came of each; --resume goes on from it")
    parser.add_argument("--resume", action="store_true")
    args = parser.parse_args()
    # Threads share what memory:// holds; processes would not.
    here = (
        None
        if args.scheduler
        else LocalCluster(n_workers=2, processes=False, dashboard_address=":0")
    )
    with here or nullcontext():
        address = args.scheduler or here.scheduler_address
        done = bsm.encode_many(
            [args.source],
            args.target,
            dask=address,
            report=args.report,
            resume=args.resume,
            preset=args.preset,
        )
    good = [facts for facts in done if "error" not in facts]
    for facts in done:
        print(facts.get("output", facts["input"]), facts.get("error", facts.get("output_bytes")))
    print(
        f"{len(good)} of {len(done)} meshes, {sum(facts['output_bytes'] for facts in good)} bytes"
    )
    raise SystemExit(0 if len(good) == len(done) else 1)


if __name__ == "__main__":
    main()
