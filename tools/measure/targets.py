"""What a target beside the look takes, over the larger of both alone: `python -m tools.measure targets MESH...`

The look is that of the default; each target by itself is reached with the preset "none".
"""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path
from statistics import fmean

from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.static.encoder import encode
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


def main() -> None:
    """Run the command."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("meshes", metavar="MESH", nargs="+", type=Path)
    ratios: list[float] = []
    for path in parser.parse_args().meshes:
        ratios += measured(path.stem, read_mesh(str(path)).mesh.bare.without_isolated_vertices()[0])
    print(f"mean {fmean(ratios):.3f}, worst {max(ratios):.3f}")
