"""Run a decoder on the test vectors: python run.py "my-decoder {in} {out}" [--needs core order ...] [--only TEXT]

Needs numpy and this folder, nothing else. README.md says what the command must write, and which code it must end with.
"""

import argparse
import json
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

HERE = Path(__file__).parent
EXIT_CODES = {
    "format": 3,
    "corrupt": 4,
    "unsupported": 5,
    "limit": 6,
    "numeric": 7,
    "truncated": 12,
}
SECONDS = 120  # before a decoder is stopped


def complaint(stream, error, command):
    """Return what the command does wrong with one stream, or None."""
    with tempfile.TemporaryDirectory() as folder:
        output = Path(folder, "out.npz")
        words = [
            word.replace("{in}", str(stream)).replace("{out}", str(output))
            for word in shlex.split(command)
        ]
        done = subprocess.run(
            words, capture_output=True, text=True, errors="replace", timeout=SECONDS
        )
        expected = EXIT_CODES[error] if error else 0
        if done.returncode != expected:
            return f"ended with code {done.returncode} instead of {expected}: {done.stderr.strip()[-200:]}"
        if error:
            return "it was refused, but a file was written" if output.exists() else None
        with np.load(output) as found, np.load(stream.with_suffix(".npz")) as right:
            return difference(dict(found), dict(right))


def difference(found, right):
    """Return how decoded arrays differ from the right ones, or None; floats of attributes may be 1e-6 off.

    A decoder may write metadata beside them."""
    if found.keys() - {"metadata"} != right.keys() - {"metadata"}:
        return f"the arrays are {sorted(found)} instead of {sorted(right)}"
    for name, values in ((name, values) for name, values in right.items() if name in found):
        other = found[name]
        if other.shape != values.shape:
            return f"{name} has shape {other.shape} instead of {values.shape}"
        exact = name in ("positions", "faces", "runs") or values.dtype.kind != "f"
        if not (
            np.array_equal(other, values)
            if exact
            else np.allclose(other, values, rtol=1e-6, atol=1e-6)
        ):
            return f"{name} is off by up to {np.abs(other.astype(float) - values).max():.1e}"
    return None


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("command")
    parser.add_argument(
        "--needs", nargs="*", help="only vectors that need none but these documents"
    )
    parser.add_argument("--only", default="", help="only vectors whose names contain this")
    args = parser.parse_args()
    needs, count, wrong = json.loads((HERE / "needs.json").read_text()), 0, 0
    for manifest in sorted(HERE.glob("*/manifest.json")):
        for vector in json.loads(manifest.read_text())["vectors"]:
            name = vector["name"]
            if args.only not in name or (
                args.needs is not None and not {*needs[name]} <= {"core", *args.needs}
            ):
                continue
            problem = complaint(manifest.parent / f"{name}.bsm", vector.get("error"), args.command)
            count, wrong = count + 1, wrong + (problem is not None)
            if problem:
                print(f"{name}: {problem} ({vector['probes']})")
    print(f"{count - wrong} of {count} vectors are treated as they should be")
    return 1 if wrong or not count else 0


if __name__ == "__main__":
    sys.exit(main())
