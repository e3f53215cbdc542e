"""Constants of encoder and denoiser halved and doubled: what each does to the figure that it serves, in percent.

    python -m tools.constants FILE [FILE ...] [--only NAME ...] [--factors 0.5 2]

Figures: bytes of blocks at the same mean angle between normals (interpolated), bytes of the preset `fine`, bytes of a
sequence (npz) at the same KG error, and the angle that automatic denoising leaves of noise that is added here. Less is
better everywhere. Meshes on which nothing was chosen tell most: the figures beside the constants are means over an
elephant with holes, a sphere with creases, a casting, a cortex and a duck (of bytes), two sequences (samba, a horse),
and a scanned angel, the elephant, the duck and a cow (of denoising).
"""

from __future__ import annotations

import argparse
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from math import exp, log
from multiprocessing import get_context
from pathlib import Path
from statistics import fmean

from tools.constants.changed import change, measure

Point = tuple[float, float]


@dataclass(frozen=True)
class Constant:
    """A constant of a module, and the figure that it serves."""

    figure: str
    module: str
    name: str


CONSTANTS = (
    Constant("blocks", "bsm.codec.static.rules", "STIFFNESS"),
    Constant("blocks", "bsm.codec.static.choice.plan", "BASE_REACH"),
    Constant("blocks", "bsm.codec.static.choice.plan", "DETAIL_REACH"),
    Constant("blocks", "bsm.codec.static.choice.plan", "SMOOTHING_STEPS"),
    Constant("blocks", "bsm.codec.static.options", "DETAIL_RATIO"),
    Constant("blocks", "bsm.codec.signal.bandwidth", "SAMPLES"),
    Constant("blocks", "bsm.codec.signal.bandwidth", "WORTHWHILE"),
    Constant("blocks", "bsm.codec.signal.quantize", "BIT_WORTH"),
    Constant("blocks", "bsm.codec.basis.orthogonal_iteration", "START_NOISE"),
    Constant("blocks", "bsm.codec.basis.orthogonal_iteration", "FOLLOWING_NOISE"),
    Constant("promise", "bsm.codec.static.choice.shaping", "PULL"),
    Constant("sequence", "bsm.codec.sequence.temporal", "WORTH"),
    Constant("sequence", "bsm.codec.sequence.temporal", "PRECISION"),
    Constant("sequence", "bsm.codec.sequence.row_prediction", "RIDGE"),
    Constant("sequence", "bsm.codec.sequence.row_prediction", "NOISE"),
    Constant("sequence", "bsm.codec.sequence.dictionaries", "TETHER"),
    Constant("denoising", "bsm.codec.denoise.recipe", "SIGMA_R"),
    Constant("denoising", "bsm.codec.denoise.recipe", "BLOCK_SIZE"),
    Constant("denoising", "bsm.codec.denoise.rehearsal", "MOST_MEMBERS"),
    Constant("denoising", "bsm.codec.denoise.normals", "VERTEX_ITERATIONS"),
    Constant("denoising", "bsm.codec.denoise.normals", "PATIENT_VERTICES"),
    Constant("denoising", "bsm.codec.denoise.noise.probe", "WINDOW"),
    Constant("denoising", "bsm.codec.denoise.noise.probe", "GAIN_PROBES"),
    Constant("denoising", "bsm.codec.denoise.noise.probe", "NORMAL_PASSES"),
)


def measured(constant: Constant, factor: float, paths: list[Path]) -> list[list[Point]]:
    """Figures of files with a constant changed."""
    given = (constant.module, constant.name, factor)
    with ProcessPoolExecutor(1, get_context("spawn"), change, given) as pool:
        return list(pool.map(measure, [constant.figure] * len(paths), paths))


def ratio(changed: list[Point], usual: list[Point]) -> float:
    """Cost over the usual one, at the usual error of the middle point."""
    error, cost = usual[len(usual) // 2]
    if len(changed) == 1:
        return changed[0][1] / cost
    below = max((point for point in sorted(changed) if point[0] <= error), default=min(changed))
    above = (
        min(point for point in changed if point[0] > below[0]) if below[0] < max(changed)[0] else sorted(changed)[-2]
    )
    slope = log(above[1] / below[1]) / log(above[0] / below[0])
    return exp(log(below[1]) + slope * log(error / below[0])) / cost


def main() -> None:
    parser = argparse.ArgumentParser(
        prog="python -m tools.constants", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("files", type=Path, nargs="+", metavar="FILE", help="meshes; npz: sequences")
    parser.add_argument("--only", nargs="+", metavar="NAME", choices=sorted({one.name for one in CONSTANTS}))
    parser.add_argument("--factors", type=float, nargs="+", default=[0.5, 2.0], metavar="X")
    args = parser.parse_args()
    print(
        f"{'constant':26}{'times':>7}{'mean':>8}   " + " ".join(f"{path.stem[:11]:>11}" for path in args.files),
        flush=True,
    )
    usual: dict[str, list[list[Point]]] = {}
    for one in CONSTANTS:
        paths = [path for path in args.files if (path.suffix == ".npz") == (one.figure == "sequence")]
        if not paths or (args.only and one.name not in args.only):
            continue
        if one.figure not in usual:
            usual[one.figure] = measured(one, 1.0, paths)
        for factor in args.factors:
            changes = [
                100.0 * (ratio(*pair) - 1.0)
                for pair in zip(measured(one, factor, paths), usual[one.figure], strict=True)
            ]
            cells = " ".join(f"{value:+11.2f}" for value in changes)
            print(f"{one.figure + ' ' + one.name:26}{factor:7g}{fmean(changes):+8.2f}   {cells}", flush=True)


if __name__ == "__main__":
    main()
