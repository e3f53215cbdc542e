"""What a target beside the look takes, over the larger of both alone: `python -m tools.measure targets MESH...`

The look is that of the default; each target by itself is reached with the preset "none". With `--stricter`, the bytes
of series of promises, and how often a stricter promise takes fewer bytes; and how many looks of the default are low, by
the bound that binds ("step": none does, wider steps that were tried break one).
"""

from __future__ import annotations

import argparse
from collections import Counter
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from statistics import fmean

from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.static.encoder import Encoder, encode
from bsm.codec.static.options import BALANCED, PRESETS, EncodeOptions
from bsm.codec.static.targets import Contract, Target
from bsm.files.mesh import read_mesh

FARTHEST = 0.002
TARGETS = {
    "--nmsve-db=-48": Target("nmsve_db", -48.0),
    "--nmsve-db=-52": Target("nmsve_db", -52.0),
    "--nmsve-db=-55": Target("nmsve_db", -55.0),
    "--theta 4": Target("theta_deg", 4.0),
    f"--max-error {FARTHEST:.1%}": None,
}
STRICTER = {
    "presets": [PRESETS[name] for name in ("small", "balanced", "fine", "near-lossless")],
    "look": [EncodeOptions(contract=Contract(0.02, look=look)) for look in (3.0, 1.5, 1.0, 0.5)],
    "max error": [EncodeOptions(contract=Contract(far)) for far in (0.01, 0.004, 0.002, 0.001)],
    "theta": [replace(PRESETS["none"], target=Target("theta_deg", angle)) for angle in (8.0, 4.0, 3.0, 2.0)],
    "nmsve": [replace(PRESETS["none"], target=Target("nmsve_db", error)) for error in (-45.0, -48.0, -52.0, -55.0)],
}
LOW = 0.9, 0.85  # looks
BACK = 1.01  # bytes of a promise over those of a stricter one, above which it counts


def options(preset: str, target: Target | None) -> EncodeOptions:
    """With a target or, without one, with a bound on the farthest vertex."""
    if target is not None:
        return replace(PRESETS[preset], target=target)
    contract = Contract(FARTHEST) if preset == "none" else replace(BALANCED, farthest=FARTHEST)
    return replace(PRESETS[preset], contract=contract)


def measured(name: str, mesh: TriangleMesh) -> list[float]:
    """Print a row for each target; return the ratios."""
    look, ratios = len(encode(mesh)), []
    for text, target in TARGETS.items():
        alone, both = (len(encode(mesh, options(preset, target))) for preset in ("none", "balanced"))
        ratios.append(both / max(alone, look))
        print(f"{name:24} {text:18} alone {alone:8,} the look {look:8,} both {both:8,}  {ratios[-1]:.3f}", flush=True)
    return ratios


def stricter(name: str, mesh: TriangleMesh, looks: list[tuple[float, str]]) -> list[float]:
    """Print a row for each series; return the bytes of each promise over those of the next. `looks` gets the default's
    and what binds it."""
    encoder = Encoder(mesh)
    encoder.encode()
    looks += [] if encoder.look is None else [(encoder.look, encoder.binding)]
    ratios = []
    for text, series in STRICTER.items():
        sizes = [len(encode(mesh, options)) for options in series]
        ratios += [size / next_size for size, next_size in pairwise(sizes)]
        print(f"{name:24} {text:12}", *(f"{size:9,}" for size in sizes), flush=True)
    return ratios


def main() -> None:
    """Run the command."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("meshes", metavar="MESH", nargs="+", type=Path)
    parser.add_argument("--stricter", action="store_true", help="series of promises, instead of two at once")
    args = parser.parse_args()
    ratios, looks = list[float](), list[tuple[float, str]]()
    for path in args.meshes:
        mesh = read_mesh(str(path)).mesh.bare.without_isolated_vertices()[0]
        ratios += stricter(path.stem, mesh, looks) if args.stricter else measured(path.stem, mesh)
    if args.stricter:
        for most in LOW:
            print(
                f"looks under {most:g} of {len(looks)}:", dict(Counter(bound for look, bound in looks if look < most))
            )
        back = sum(ratio > BACK for ratio in ratios)
        print(f"{len(ratios)} steps, {back} back by more than {BACK - 1.0:.0%}, worst {max(ratios):.3f}")
    else:
        print(f"mean {fmean(ratios):.3f}, worst {max(ratios):.3f}")
