"""Angles to the truth after `bsm denoise` and after Taubin's filter, on noise of known cause.

    python -m tools.measure denoising MESHES [ROWS ...]
    python -m tools.measure denoising --draws 5 MESHES [ROWS ...]
    python -m tools.measure denoising --goals MESH...

MESHES is a folder of meshes, as for `tools.replicate`; rows are chosen by parts of their names. With `--draws`, the
table shows the error that is left in that many draws of white noise on flat shapes, meshes and made shapes, and the
largest over the least of them. For shapes of few planes, the next column shows the same ratio for least squares with
the faces of each plane known, which leaves a tenth to a third of a degree by chance. With `--goals`, the table
shows what each goal and strength leaves of white noise, on clean meshes of yours and on made shapes.
"""

import argparse
import time
from collections.abc import Callable, Iterable, Iterator
from functools import partial
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from bsm.codec.arrays import Faces, Floats, Positions
from bsm.codec.denoise.automatic import MOST_FLAT
from bsm.codec.denoise.noise.probe import Probe
from bsm.codec.denoise.planes import PlaneSearch
from bsm.codec.denoise.surface import Topology
from bsm.codec.geometry.metrics import Reference, face_normals, mean_edge_length
from bsm.codec.geometry.welding import weld
from bsm.files.mesh import read_mesh
from tools.made_shapes import Field, made_shape, mesh_of
from tools.noise import (
    correlated_along_normals,
    denoise_automatically,
    gaussian_along_axis,
    gaussian_along_normals,
)
from tools.sampled import THICK, ball, box, torus, voxelized, voxelized_mesh
from tools.scans import CAMERAS, Scan, fused, view

TAUBIN = (10, 30, 100, 300)
PLATE = (30.0, 20.0, 2.5)  # half sides, in cells
SCANS = ("c3d_spot", "armadillo_12502", "fr_casting", "gargoyle_10002")
PARTS = ("block", "fandisk_6475", "twelve_dodecahedron", "trim_star", "sharpsphere")
SLICES, SLICED, ORGANS = (3.0, 4.0, 6.0, 8.0), 72, (4, 10, 11, 16)
"""Of slices, cells across and a side; and seeds of `made_shape`."""
UNEVEN = (2.3, 4.94, 6.7)  # cells across slices that are stored as whole cells

HALVES = np.array([0.72, 0.5, 0.4])
FLAT: dict[str, Field] = {
    "block": lambda places: np.maximum.reduce(
        [
            (np.abs(places) - HALVES).max(axis=-1),
            0.2 - np.maximum(np.abs(places[..., 0] - 0.1), np.abs(places[..., 2] - 0.3)),
            0.22 - np.hypot(places[..., 0] + 0.4, places[..., 1]),
        ]
    ),
    "stairs": lambda places: np.maximum(
        (np.abs(places) - 0.6).max(axis=-1),
        np.minimum.reduce(
            [np.maximum(at - places[..., 0], places[..., 2] + at) for at in (-0.3, 0.0, 0.3)]
        )
        - 0.15,
    ),
    "roof": lambda places: np.maximum(
        (np.abs(places) - HALVES).max(axis=-1), 0.35 * np.abs(places[..., 1]) + places[..., 2] - 0.2
    ),
}
FLAT_CELLS, DRAWN = 68, 8
ONE_PLANE = 0.9999  # cosine of the angle between neighbors on one plane
STEADY = 1.1  # the largest of draws over the least

GOALS = {
    "default": ("shading", 1.0),
    "--for shape": ("shape", 1.0),
    "--strength 0.8": ("shading", 0.8),
}
WHITE, SEED, MADE, MADE_CELLS = 0.2, 3, 20, 28


def taubin(positions: Positions, faces: Faces, steps: int) -> Positions:
    """The filter of MeshLab: each step shrinks by 0.5 and swells by 0.53."""
    average = Probe(Topology(faces, len(positions))).average
    for _ in range(steps):
        positions = positions + 0.5 * (average @ positions - positions)
        positions = positions - 0.53 * (average @ positions - positions)
    return positions


def inputs(folder: Path) -> Iterator[tuple[str, Callable[[], Scan]]]:
    """Names of rows, and functions that make them."""

    def mesh(name: str) -> tuple[Positions, Faces]:
        found = read_mesh(folder / "static" / f"{name}.ply").mesh
        return found.positions.astype(np.float64), found.faces

    for cells in (40, 64, 100, 160):
        yield f"binary ball, {cells} cells", partial(voxelized, ball, cells)
    yield "binary torus, 100 cells", partial(voxelized, torus, 100)
    yield "binary box, 80 cells", partial(voxelized, box(0.6, 0.5, 0.4), 80)
    yield "binary plate, 5 cells", partial(voxelized, box(*PLATE), 80, reach=37.0)
    yield "thick slices, ball, 100 cells", partial(voxelized, ball, 100, THICK)
    solids = {"ball": ball, "torus": torus, "box": box(0.6, 0.5, 0.4)}
    for thick, (shape, field) in product(SLICES, solids.items()):
        yield f"slices of {thick:g} cells, {shape}", partial(voxelized, field, SLICED, thick)
        yield (
            f"slices of {thick:g} cells, stored singly, {shape}",
            partial(voxelized, field, 50, thick, 1.0, thick),
        )
    for thick, (shape, field) in product(UNEVEN, solids.items()):
        yield (
            f"uneven slices of {thick:g} cells, {shape}",
            partial(voxelized, field, SLICED, thick, 1.0, thick),
        )
    shaped = partial(made_shape, cells=40)
    for thick, seed in product(SLICES, ORGANS):
        yield (
            f"slices of {thick:g} cells, made {seed}",
            partial(_made, shaped, seed, voxelized_mesh, SLICED, thick),
        )
    for thick, name in product(SLICES, SCANS):
        yield (
            f"slices of {thick:g} cells, {name}",
            partial(_made, mesh, name, voxelized_mesh, SLICED, thick),
        )
    for name in SCANS:
        yield f"binary {name}, 110 cells", partial(_made, mesh, name, voxelized_mesh, 110)
        yield (
            f"thick slices, {name}, 110 cells",
            partial(_made, mesh, name, voxelized_mesh, 110, THICK),
        )
    for name in (*SCANS, "horse_48485"):
        yield f"one axis, {name}", partial(_made, mesh, name, _moved, 0.3, gaussian_along_axis)
    for (camera, model), name in product(CAMERAS.items(), SCANS):
        yield f"{camera}, {name}", partial(_made, mesh, name, view, model, SEED)
    for (camera, model), seed in product(CAMERAS.items(), ORGANS):
        yield f"{camera}, made {seed}", partial(_made, shaped, seed, view, model, SEED)
    for name in (*SCANS, *PARTS):
        yield (
            f"fused views, {name}",
            partial(_made, mesh, name, fused, CAMERAS["structured light"], SEED),
        )
    for name in SCANS:
        yield (
            f"correlated, {name}",
            partial(_made, mesh, name, _moved, 0.2, partial(correlated_along_normals, rounds=4)),
        )


def _made(
    mesh: Callable[[Any], tuple[Positions, Faces]], name: Any, make: Callable[..., Scan], *how: Any
) -> Scan:
    return make(*mesh(name), *how)


def _moved(clean: Positions, faces: Faces, sigma: float, noise: Callable[..., Positions]) -> Scan:
    noisy = noise(clean, faces, sigma, 3)
    normals = face_normals(clean, faces)
    return Scan(noisy, faces, normals, lambda moved: np.linalg.norm(moved - clean, axis=1))


Meshed = tuple[Positions, Faces]


def whites(folder: Path) -> Iterator[tuple[str, Callable[[], Meshed], float]]:
    """Names of rows, functions that make clean meshes, and the noise for them, in mean edges."""
    yield from (
        (f"flat {name}", partial(mesh_of, field, FLAT_CELLS), 0.3) for name, field in FLAT.items()
    )
    yield from (
        (f"flat block, noise {sigma}", partial(mesh_of, FLAT["block"], FLAT_CELLS), sigma)
        for sigma in (0.2, 0.4)
    )
    for name in ("twelve_dodecahedron", "c3d_spot", "fandisk_6475", "sharpsphere"):
        yield name, partial(_clean, str(folder / "static" / f"{name}.ply")), 0.3
    for seed in range(DRAWN):
        yield f"made {seed}", partial(made_shape, seed, MADE_CELLS), WHITE


def draws(folder: Path, rows: list[str], count: int) -> None:
    """Print the angles that are left in each of the draws, and the largest over the least."""
    ratios, bounds = [], []
    for name, shape, sigma in whites(folder):
        if rows and not any(part in name for part in rows):
            continue
        clean, faces = shape()
        reference, left, least, kinds = Reference(clean, faces), [], [], []
        for seed in range(count):
            noisy = gaussian_along_normals(clean, faces, sigma, seed)
            result, choice = denoise_automatically(noisy, faces)
            left.append(reference.theta(result))
            least.append(possible(clean, noisy, faces))
            kinds.append(choice.finish if choice.steps else choice.kind)
        ratios.append(max(left) / min(left))
        bounds.append(max(least) / min(least))  # NaN if there is none
        angles = "".join(f"{angle:7.2f}" for angle in (reference.theta(noisy), *left))
        print(
            f"{name:28}{len(clean):8}{angles}{ratios[-1]:8.2f}{bounds[-1]:8.2f}  {' '.join(kinds)}",
            flush=True,
        )
    pairs = list(zip(ratios, bounds, strict=True))
    print(f"{sum(ratio <= STEADY for ratio in ratios)} of {len(ratios)} at most {STEADY:.2f}")
    print(
        f"{sum(ratio <= STEADY or ratio <= bound for ratio, bound in pairs)} of them at most that, or what is possible"
    )


def possible(clean: Positions, noisy: Positions, faces: Faces) -> float:
    """The angle that least squares leave on planes if the faces of each are known; NaN if few lie on planes."""
    topology, normals = Topology(faces, len(clean)), face_normals(clean, faces)
    ends = normals[topology.pairs]
    together = topology.pairs[(ends[:, 0] * ends[:, 1]).sum(axis=1) > ONE_PLANE]
    graph = sparse.csr_matrix((np.ones(len(together)), together.T), (len(faces), len(faces)))
    planes = PlaneSearch(noisy, clean, topology).planes(
        connected_components(graph, directed=False)[1]
    )
    flat = planes.labels >= 0
    apart = np.linalg.norm(planes.normals[planes.labels[flat]] - normals[flat], axis=1)
    return (
        float(np.degrees(2.0 * np.arcsin(0.5 * apart)).mean())
        if planes.share > MOST_FLAT
        else np.nan
    )


def goals(files: Iterable[str]) -> None:
    """Print the angles and distances to the clean mesh that each of `GOALS` leaves, over those of the noise."""
    print(f"{'':44}" + "".join(f"{name:>20}" for name in GOALS))
    print(f"{'mesh':28}{'vertices':>8}{'noisy':>8}" + f"{'angle':>11}{'distance':>9}" * len(GOALS))
    shapes = [(Path(file).stem, partial(_clean, file)) for file in files]
    made = [(f"made {seed}", partial(made_shape, seed, MADE_CELLS)) for seed in range(MADE)]
    left = {}
    for name, shape in (*shapes, *made):
        clean, faces = shape()
        noisy = gaussian_along_normals(clean, faces, WHITE, SEED)
        reference = Reference(clean, faces)
        whole = {
            goal: denoise_automatically(noisy, faces, goal)[0] for goal in ("shading", "shape")
        }
        results = [noisy + strength * (whole[goal] - noisy) for goal, strength in GOALS.values()]
        measured = np.array(
            [[reference.theta(moved), np.linalg.norm(moved - clean)] for moved in (noisy, *results)]
        )
        left[name] = measured[1:] / measured[0]
        print(f"{name:28}{len(clean):8}{measured[0, 0]:8.2f}" + _columns(left[name]), flush=True)
    for what, share in (("median", 0.5), ("ninth of ten", 0.9), ("worst", 1.0)):
        print(f"{what:44}" + _columns(np.quantile(list(left.values()), share, axis=0)))


def _clean(file: str) -> Meshed:
    mesh = read_mesh(file).mesh
    return weld(mesh.positions.astype(np.float64), mesh.faces)[:2]


def _columns(shares: Floats) -> str:
    return "".join(f"{angle:11.2f}{distance:9.2f}" for angle, distance in shares)


def main() -> int:
    """Print the table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("meshes", type=Path)
    parser.add_argument("rows", nargs="*")
    parser.add_argument("--for", dest="goal", default="shading")
    parser.add_argument("--goals", action="store_true")
    parser.add_argument("--draws", type=int)
    args = parser.parse_args()
    if args.draws:
        draws(args.meshes, args.rows, args.draws)
        return 0
    if args.goals:
        goals([str(args.meshes), *args.rows])
        return 0
    ratios = []
    heads = (
        "row",
        "vertices",
        "noisy",
        *(f"T{steps}" for steps in TAUBIN),
        "ours",
        "says",
        "off",
        "seconds",
        "found",
    )
    print("{:40}{:>9}{:>8}{:>7}{:>7}{:>7}{:>7}{:>7}  {:>10}{:>14}{:>9}  {}".format(*heads))
    for name, make in inputs(args.meshes):
        if args.rows and not any(part in name for part in args.rows):
            continue
        scan = make()
        begin = time.perf_counter()
        result, choice = denoise_automatically(scan.positions, scan.faces, args.goal)
        seconds = time.perf_counter() - begin
        rivals = [scan.angle(taubin(scan.positions, scan.faces, steps)) for steps in TAUBIN]
        says = (
            f"{choice.expected:.1f}-{choice.at_most:.1f}"
            if choice.steps and choice.reliable
            else "-"
        )
        ratios.append(scan.angle(result) / min(rivals))
        edge = mean_edge_length(scan.positions, scan.faces)
        before, after = (scan.rms(positions) / edge for positions in (scan.positions, result))
        angles = (scan.angle(scan.positions), *rivals, scan.angle(result))
        print(
            f"{name:40}{len(result):9}{angles[0]:8.2f}"
            + "".join(f"{angle:7.2f}" for angle in angles[1:])
            + "  "
            f"{says:>10}{f'{before:.3f}->{after:.3f}':>14}{seconds:9.1f}  {choice.kind}: {choice.reason}",
            flush=True,
        )
    if ratios:
        print(
            f"ours over the best of Taubin's: median {np.median(ratios):.2f}, worst {max(ratios):.2f}"
        )
    return 0
