"""Fit the rules that tell noise from shape (`RULES` of `codec.denoise.noise.search`).

    python -m tools.train_noise MESHES [PACKAGES ...]

Clean examples are meshes of a folder, pieces of large ones, shapes of `tools.made_shapes`, tori with bumps, views of
them, and models in the packages that `tools.attack.doors` and `tools.replicate.fetch` download. Noisy ones are the
same with noise of a random kind and strength. Each rule is a logistic regression on a few measures, moved until no
clean mesh that it was fitted to is taken for noisy, with a margin: first those of many windows, then those of few.
Meshes of `HELD_OUT` are only judged. The program prints the rules, the clean meshes taken for noisy, and how often
noise is found.
"""

from collections.abc import Callable, Iterator
from functools import partial
from itertools import chain, product
from pathlib import Path
from typing import NamedTuple

import numpy as np

from bsm.bitstream.errors import BsmError
from bsm.codec.arrays import Faces, Floats, Positions
from bsm.codec.denoise.noise.causes import weld_seams
from bsm.codec.denoise.noise.probe import Probe
from bsm.codec.denoise.noise.search import FEWEST_WINDOWS, MEASURES, RULES, surface, suspects
from bsm.codec.denoise.surface import Topology
from bsm.codec.geometry.metrics import mean_edge_length
from bsm.files.mesh import read_mesh
from tools import noise
from tools.command import parser_of
from tools.made_shapes import made_shape
from tools.scans import CAMERAS, view

HELD_OUT = (
    *(
        "fr_casting",
        "fr_chinese_lion",
        "sharpsphere",
        "block",
        "trim_star",
        "c3d_spot",
        "gargoyle_10002",
        "dance",
    ),
    *("made 13", "made 14", "bumpy 1", "bumpy 5", "tiago", "kinova", "baxter"),
)
"""Parts of names."""
MADE = range(100, 150)
ROWS, WAVES, BUMPS = (36, 48, 60, 90), (4, 6, 9, 13, 18), (0.01, 0.03, 0.08, 0.2)
MODELS, MODEL, NOISY_MODELS = (".stl", ".obj", ".ply", ".off"), (1000, 14_000), 4
"""Names of files, their vertices, and one in how many of them is made noisy as well."""
PIECES, PIECE, LARGE, LARGEST, LARGEST_FILE = 4, (3000, 9000), 20_000, 60_000, 4_000_000
SIGMAS = (0.07, 0.45)
NOISES: dict[str, Callable[..., Positions]] = {
    "white": noise.gaussian_along_normals,
    "isotropic": noise.gaussian_isotropic,
    "impulses": partial(noise.impulsive, fraction=0.5),
    "shared 2": partial(noise.correlated_along_normals, rounds=2),
    "shared 4": partial(noise.correlated_along_normals, rounds=4),
    "axis": noise.gaussian_along_axis,
    "range": noise.gaussian_with_range,
    "part": partial(noise.gaussian_in_part, fraction=0.5),
}
WHOLE = ("white", "isotropic", "impulses", "shared 2", "shared 4")
RIGHT = {
    "white": WHOLE,
    "correlated": WHOLE,
    "local": ("part",),
    "axis": ("axis", "range"),
    "view": ("camera",),
}
"""Noises that a rule has to accept."""
CLEAN_WEIGHT, RIDGE, MARGIN = 30.0, 0.3, 0.25
SIGNS = np.array([1.0, 0.0, -1.0, -1.0, -1.0, -1.0, -1.0])  # of the weights of `MEASURES`; 0: any


class Example(NamedTuple):
    name: str
    noise: str
    sigma: float
    rule: str
    measures: Floats


def bumpy(rows: int, waves: int, bumps: float) -> tuple[Positions, Faces]:
    """A smooth torus of `rows` by seven ninths of as many columns, with regular bumps."""
    columns = 7 * rows // 9
    row, column = np.mgrid[:rows, :columns]
    u, v = 2.0 * np.pi * row / rows, 2.0 * np.pi * column / columns
    radius = 0.35 * (1.0 + bumps * np.sin(waves * u) * np.sin((waves // 2 + 1) * v))
    across = 1.0 + radius * np.cos(v)
    positions = np.stack(
        [across * np.cos(u), across * np.sin(u), radius * np.sin(v)], axis=-1
    ).reshape(-1, 3)
    number = np.arange(rows * columns).reshape(rows, columns)
    right, below = np.roll(number, -1, axis=0), np.roll(number, -1, axis=1)
    opposite = np.roll(right, -1, axis=1)
    corners = np.concatenate(
        [np.stack([number, right, opposite], -1), np.stack([number, opposite, below], -1)]
    )
    return positions, np.ascontiguousarray(corners.reshape(-1, 3), np.int32)


def shapes(folder: Path) -> Iterator[tuple[str, Positions, Faces]]:
    """Names, positions and faces of clean meshes."""
    for path in sorted((folder / "static").glob("*.ply")):
        mesh = read_mesh(path).mesh
        positions, faces = mesh.positions.astype(np.float64), mesh.faces
        if len(positions) < LARGEST:
            yield path.stem, positions, faces
        centroids = positions[faces].mean(axis=1)
        for seed in range(PIECES if len(positions) > LARGE else 0):
            random = np.random.default_rng(seed)
            apart = np.square(centroids - centroids[random.integers(len(centroids))]).sum(axis=1)
            near = np.argsort(apart, kind="stable")[: int(random.integers(*PIECE))]
            used, corners = np.unique(faces[near], return_inverse=True)
            yield (
                f"{path.stem}, piece {seed}",
                positions[used],
                corners.reshape(-1, 3).astype(np.int32),
            )
    for path in sorted((folder / "dynamic").glob("*.npz")):
        with np.load(path) as arrays:
            yield path.stem, arrays["positions"][20].astype(np.float64), arrays["faces"]
    for number, (rows, waves, bumps) in enumerate(product(ROWS, WAVES, BUMPS)):
        if rows >= 5 * waves:
            yield f"bumpy {number}", *bumpy(rows, waves, bumps)
    for seed in MADE:
        yield f"made {seed}", *made_shape(seed, int(np.random.default_rng(seed).integers(16, 42)))


def models(folders: list[Path]) -> Iterator[tuple[str, Positions, Faces]]:
    """Names, positions and faces of the models in packages, each name once."""
    paths = {path.stem: path for folder in folders for path in sorted(folder.rglob("*"))}
    for path in paths.values():
        if path.suffix.lower() in MODELS and path.stat().st_size < LARGEST_FILE:
            try:
                mesh = read_mesh(path).mesh
            except BsmError:
                continue
            positions, faces, _ = weld_seams(mesh.positions.astype(np.float64), mesh.faces)
            if MODEL[0] < len(positions) < MODEL[1]:
                yield str(path), positions, faces


def examples(folder: Path, packages: list[Path]) -> Iterator[Example]:
    """Measures of whatever is suspected in clean and noisy meshes."""
    for number, (name, positions, faces) in enumerate(chain(shapes(folder), models(packages))):
        random = np.random.default_rng(number)
        cases = [("clean", 0.0, positions, faces)]
        model = "/" in name
        for kind, make in NOISES.items() if not model or number % NOISY_MODELS == 0 else ():
            sigma = float(np.exp(random.uniform(*np.log(SIGMAS))))
            cases.append((kind, sigma, make(positions, faces, sigma, seed=number), faces))
        camera = CAMERAS[list(CAMERAS)[number % 2]]._replace(pixels=int(random.integers(80, 160)))
        cameras = (("camera", camera), ("clean", camera._replace(noise=lambda depth, *_: depth)))
        for kind, made in cameras if not model and "piece" not in name else ():
            seen = view(positions, faces, made, number)
            if len(seen.faces) and np.isfinite(seen.positions).all():
                cases.append((kind, 0.2, seen.positions, seen.faces))
        probe = Probe(Topology(faces, len(positions)))
        for kind, sigma, noisy, triangles in cases:
            probe = probe if triangles is faces else Probe(Topology(triangles, len(noisy)))
            if probe.windows.valid.sum() >= FEWEST_WINDOWS:
                evidence = surface(noisy, probe, mean_edge_length(noisy, triangles))
                for suspect in suspects(noisy, evidence):
                    yield Example(name, kind, sigma, suspect.rule, suspect.measures)


def fit(values: Floats, noisy: Floats) -> Floats:
    """Weights of a ridged logistic regression by Newton's method, the constant last, with signs as `SIGNS` says."""
    middle, scale = values.mean(axis=0), values.std(axis=0) + 1e-9
    used = np.ones(len(scale) + 1)
    trust = np.where(noisy > 0.0, 1.0, CLEAN_WEIGHT)
    ridge = np.diag([*np.full(len(scale), RIDGE), 1e-6])
    while True:
        columns = np.column_stack([(values - middle) / scale, np.ones(len(values))]) * used
        weights = np.zeros(columns.shape[1])
        for _ in range(50):
            chance = 1.0 / (1.0 + np.exp(-np.clip(columns @ weights, -30.0, 30.0)))
            slope = columns.T @ (trust * (chance - noisy)) + ridge @ weights
            curvature = (columns * (trust * chance * (1.0 - chance))[:, None]).T @ columns + ridge
            weights -= np.linalg.solve(curvature, slope)
        wrong = np.append(weights[:-1] * SIGNS < 0.0, False)
        if not wrong.any():
            return np.append(weights[:-1] / scale, weights[-1] - weights[:-1] @ (middle / scale))
        used[wrong] = 0.0


def report(rule: str, cases: list[Example]) -> None:
    """Fit one rule to its cases, and print it and its results."""
    counted = [
        case for case in cases if case.rule == rule and case.noise in ("clean", *RIGHT[rule])
    ]
    values = np.stack([case.measures for case in counted])
    noisy = np.array([float(case.noise in RIGHT[rule]) for case in counted])
    held = np.array([any(part in case.name for part in HELD_OUT) for case in counted])
    weights = fit(values[~held], noisy[~held])
    clean, few = values[~held & (noisy == 0.0)], MEASURES.index("few")
    weights[-1] -= (clean @ weights[:-1] + weights[-1])[clean[:, few] == 0.0].max(
        initial=-2.0 * MARGIN
    ) + MARGIN
    excess = clean @ weights[:-1] + weights[-1] + MARGIN
    weights[few] -= (excess / np.maximum(clean[:, few], 1e-9)).max(initial=0.0)
    print(f'    "{rule}": ({", ".join(f"{weight:.2f}" for weight in weights)}),')
    found = values @ weights[:-1] + weights[-1] > 0.0
    wrong = [
        f"{case.name} {case.noise}"
        for case, yes, no in zip(counted, found, noisy, strict=True)
        if yes and not no
    ]
    print(f"        # of {(noisy == 0.0).sum()} wrongly:", ", ".join(wrong) or "none")
    for kind, which in product(RIGHT[rule], (~held, held)):
        among = which & np.array([case.noise == kind for case in counted])
        if among.any():
            print(
                f"        # {kind}{' of those held out' if which is held else ''}: found {found[among].mean():.2f}"
            )


def main() -> None:
    """Print the rules."""
    parser = parser_of(__doc__)
    parser.add_argument("meshes", type=Path)
    parser.add_argument("packages", type=Path, nargs="*")
    args = parser.parse_args()
    cases = list(examples(args.meshes, args.packages))
    print("   ", ", ".join(MEASURES))
    for rule in RULES:
        report(rule, cases)


if __name__ == "__main__":
    main()
