"""What the search costs in bytes: `python -m tools.measure regret MESH ...`.

Regret is the bytes of an encoding over the least of all ways, each searched alone at a tenth of the price. It is 1 if
the search found the best, and below 1 if luck found more. For each mesh it is printed for presets, and with `--targets`
for errors without a look, too. The exit code is 1 if the mean is above 1.01 or one is above 1.05.
"""

import argparse
import math
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from bsm.bitstream.errors import TargetError
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.static.choice.bounds import Bounds
from bsm.codec.static.choice.search import PRICE, OneSearch
from bsm.codec.static.choice.table import ways_of
from bsm.codec.static.encoder import Encoder
from bsm.codec.static.options import PRESETS, PROMISES, EncodeOptions
from bsm.codec.static.targets import Contract, Target
from bsm.files.mesh import read_mesh
from bsm.ground.console import Console
from tools.command import run_command

MEAN, WORST = 1.01, 1.05
PATIENCE, CHEAPER = 10, 0.1  # times as many trials, at so much of the price


def options_of(targets: bool) -> Iterator[tuple[str, EncodeOptions]]:
    """Yield the options that are measured, with their names."""
    for name in PROMISES:
        yield name, replace(PRESETS[name], threads=1)
    if targets:
        for kind, value in (("theta_deg", 5.0), ("nmsve_db", -48.0)):
            yield (
                f"{kind} {value:g}",
                replace(PRESETS["none"], threads=1, target=Target(kind, value)),
            )
        yield "max_error 0.002", replace(PRESETS["none"], threads=1, contract=Contract(0.002))


def contract_of(encoder: Encoder) -> Contract:
    """Return the bounds that an encoder keeps."""
    target, promise = encoder.options.target, encoder.options.promise
    if target is not None:
        return encoder._within_error(target)
    assert promise is not None
    return promise


def least_alone(mesh: TriangleMesh, options: EncodeOptions) -> int | None:
    """Return the bytes of the smallest stream of all ways, each searched alone and for long; None: there is none."""
    encoder = Encoder(mesh, options)
    contract = contract_of(encoder)
    sent = encoder._input.measuring(None, alike=contract.alike)
    search = sent.search
    bounds = Bounds(sent.measures, contract)
    sizes = []
    for way in ways_of(sent.prepared, bounds, options):
        alone = OneSearch(search, bounds)
        if contract.look == math.inf:
            alone.widen([way])
        alone.begin([way])
        alone.run(CHEAPER * PRICE * sent.prepared.graph.size**0.25, PATIENCE)
        if alone.best is not None:
            sizes.append(search.size(alone.best.final))
    return min(sizes, default=None)


def regrets(mesh: TriangleMesh, targets: bool) -> Iterator[tuple[str, int, float]]:
    """Yield the name of options, the bytes of the encoder, and their regret."""
    for name, options in options_of(targets):
        try:
            size = len(Encoder(mesh, options).encode())
        except TargetError:
            continue
        least = least_alone(mesh, options)
        yield name, size, size / min(least or size, size * 10)


def _measure(args: argparse.Namespace, console: Console) -> None:
    found: list[float] = []
    for path in args.meshes:
        mesh = read_mesh(str(path)).mesh.bare
        for name, size, regret in regrets(mesh, args.targets):
            found.append(regret)
            print(f"{path.name[:40]:40} {name:16} {size:9} bytes, regret {regret:.3f}", flush=True)
    mean = math.exp(sum(map(math.log, found)) / len(found))
    print(f"mean {mean:.4f}, worst {max(found):.3f}, {len(found)} encodings")
    if mean > MEAN or max(found) > WORST:
        sys.exit(1)


def main() -> None:
    """Print the regret of encodings of meshes."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("meshes", nargs="+", type=Path)
    parser.add_argument("--targets", action="store_true", help="measure errors without a look, too")
    run_command(parser, _measure)


if __name__ == "__main__":
    main()
