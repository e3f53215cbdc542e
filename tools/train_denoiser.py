"""Learn what `codec.denoise.learnt` knows (`codec/denoise/learnt.npz`) from synthetic noise.

    python -m tools.train_denoiser MESHES [--output codec/denoise/learnt.npz] [--examples 4800]

Shapes are those of `tools.made_shapes`, and crops of three meshes of the folder that evaluate nothing
(`TRAINING_MESHES`); half of them are simplified. Each gets noise of a kind and strength of its own. A stage learns to
tell the clean normals from the descriptions of noisy faces; the next one learns on what it has left. One example in
twenty is held out, and tells how well the stages do. All numbers are drawn from seeds, but processors and GPUs round
differently: networks of two machines differ a little. Needs PyTorch (`pip install bsm-codec[train]`), and uses a GPU
if there is one: 16 processors and an H100 took six minutes.
"""

import time
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from functools import cache, partial
from itertools import pairwise, product
from pathlib import Path

import numpy as np

from bsm.codec.arrays import Faces, Floats, Order, Positions
from bsm.codec.denoise.learnt import (
    BASE,
    FARTHEST,
    FILTERED,
    NUMBERS,
    OWN,
    RADIUS,
    REPEATED,
    RINGS,
    SECTORS,
    VERTEX_ITERATIONS,
    WEIGHTS,
    Network,
    Singles,
    descriptions,
    read_networks,
    regressed_normals,
)
from bsm.codec.denoise.surface import Topology, follow_normals, surroundings
from bsm.codec.geometry.metrics import face_normals
from bsm.encoding.simplification import collapsed, compact
from bsm.files.mesh import read_mesh
from tools.command import parser_of
from tools.made_shapes import made_shape
from tools.noise import (
    correlated_along_normals,
    gaussian_along_axis,
    gaussian_along_normals,
    gaussian_isotropic,
    impulsive,
    uniform_along_normals,
)
from tools.scans import CAMERAS, view

TRAINING_MESHES = ("dragon_437645", "horse_48485", "cgal_elephant_with_holes")
CROP = 6000  # faces
CELLS = (22, 40)
FINER = 2.5  # faces of a shape before it is simplified, at the most, over those after
FACES = 1000  # of each example that are learnt from; smaller ones are left out
STAGES, WIDTHS = 3, (160, 160, 96)
ROUNDS, BATCH, RATE = 50, 16384, 8e-3
FIRST_SHAPE, HELD_OUT = 1000, 20


@dataclass(frozen=True, eq=False)
class Example:
    """A noisy mesh, its positions on their way through the stages, and clean normals of the chosen faces."""

    faces: Faces
    noisy: Positions
    positions: Positions
    normals: Floats
    chosen: np.ndarray


def example(folder: Path, number: int) -> Example | None:
    """One of endlessly many noisy meshes; none if it is too small."""
    random = np.random.default_rng(number)
    finer = float(random.uniform(1.0, FINER)) if random.random() < 0.5 else 1.0
    if number % 6 == 5:
        positions, faces = _crop(
            folder, TRAINING_MESHES[number // 6 % 3], round(CROP * finer), random
        )
    else:
        positions, faces = made_shape(
            FIRST_SHAPE + number, round(float(random.integers(*CELLS)) * np.sqrt(finer))
        )
    if finer > 1.0:
        free = np.zeros(len(positions), np.bool_)
        positions, faces, *_ = collapsed(positions, faces, free, round(len(faces) / finer))
    if len(faces) < FACES:
        return None
    # Strength from 0.06 to 0.75 edges, evenly in its logarithm.
    sigma = float(0.06 * (0.75 / 0.06) ** random.random())
    normals = face_normals(positions, faces)
    kind = random.integers(25)
    if kind < 7:
        noisy = gaussian_along_normals(positions, faces, sigma, number)
    elif kind < 10:
        noisy = gaussian_isotropic(positions, faces, 0.7 * sigma, number)
    elif kind < 13:
        noisy = impulsive(
            positions, faces, 1.4 * sigma, float(random.choice([0.1, 0.3, 0.5])), number
        )
    elif kind < 15:
        noisy = uniform_along_normals(positions, faces, sigma, number)
    elif kind < 21:
        noisy = correlated_along_normals(
            positions, faces, sigma, number, int(random.integers(1, 6))
        )
    elif kind < 24:
        noisy = gaussian_along_axis(positions, faces, sigma, number, tuple(random.normal(size=3)))
    else:
        camera = CAMERAS[str(random.choice(list(CAMERAS)))]
        scan = view(
            positions,
            faces,
            camera._replace(pixels=camera.pixels // 2, focal=camera.focal / 2.0),
            number,
        )
        noisy, faces, normals = scan.positions, scan.faces, scan.normals
    chosen = random.permutation(np.flatnonzero(normals.any(axis=1)))[:FACES]
    return Example(faces, noisy, noisy, normals[chosen], chosen) if len(chosen) == FACES else None


def _crop(
    folder: Path, name: str, most: int, random: np.random.Generator
) -> tuple[Positions, Faces]:
    positions, faces, centroids = _scanned(folder / "static" / f"{name}.ply")
    center = centroids[random.integers(len(centroids))]
    near = np.argsort(np.square(centroids - center).sum(axis=1), kind="stable")[:most]
    return compact(positions, faces[near])[:2]


@cache
def _scanned(path: Path) -> tuple[Positions, Faces, Floats]:
    mesh = read_mesh(path).mesh
    positions = mesh.positions.astype(np.float64)
    return positions, mesh.faces, positions[mesh.faces].mean(axis=1)


def described(case: Example) -> tuple[Singles, Singles]:
    """Numbers of the chosen faces, and their clean normals in the faces' frames."""
    topology = Topology(case.faces, len(case.noisy))
    parts = list(descriptions(case.positions, topology, surroundings(case.noisy, topology, RADIUS)))
    frames = np.concatenate([frame for _, frame in parts])[case.chosen]
    wanted = np.einsum("kij,kj->ki", frames, case.normals).astype(np.float32)
    return np.concatenate([part for part, _ in parts])[case.chosen], wanted


def improved(network: Network, case: Example) -> Example:
    """The example as a stage leaves it."""
    topology = Topology(case.faces, len(case.noisy))
    near = surroundings(case.noisy, topology, RADIUS)
    normals = regressed_normals(descriptions(case.positions, topology, near), network)
    return replace(
        case, positions=follow_normals(case.positions, topology, normals, VERTEX_ITERATIONS)
    )


def mirrored(x: bool, y: bool) -> tuple[Order, Singles]:
    """The numbers of a face as seen in a frame with x, y or both the other way round: their order and signs."""
    order = np.arange(NUMBERS)
    signs = np.ones(NUMBERS, dtype=np.float32)
    vectors = [3 * k for k in range(1 + FILTERED)] + [OWN + 3 * k for k in range(REPEATED)]
    circles = 3 * (1 + FILTERED)
    for ring, sector in product(range(RINGS), range(SECTORS)):
        turned = SECTORS // 2 - sector if x else sector
        place = circles + 4 * (ring * SECTORS + sector)
        order[place : place + 4] = (
            circles + 4 * (ring * SECTORS + (-turned if y else turned) % SECTORS) + np.arange(4)
        )
        vectors.append(place)
    for place in vectors:
        signs[place : place + 3] = [-1.0 if x else 1.0, -1.0 if y else 1.0, 1.0]
    return order, signs


def train(parts: Sequence[tuple[Singles, Singles]], seed: int, rounds: int = ROUNDS) -> Network:
    """Descend the mean distance of unit normals, over that of the filtered ones of the same mesh."""
    import torch

    numbers, wanted = map(np.concatenate, zip(*parts))
    filtered = [np.linalg.norm(seen[:, BASE] - aim, axis=1).mean() for seen, aim in parts]
    weights = np.repeat(1.0 / np.array(filtered, np.float32), [len(seen) for seen, _ in parts])
    weights /= weights.mean()
    device = "cuda" if torch.cuda.is_available() else "cpu"
    torch.manual_seed(seed)
    mean = numbers.mean(axis=0)
    scale = (1.0 / np.maximum(numbers.std(axis=0), 1e-3)).astype(np.float32)
    linear = [torch.nn.Linear(*sizes) for sizes in pairwise((NUMBERS, *WIDTHS, 3))]
    with torch.no_grad():
        linear[-1].weight *= 0.01  # with the filtered normal as it is
    model = torch.nn.Sequential(
        *(part for layer in linear[:-1] for part in (layer, torch.nn.SiLU())), linear[-1]
    )
    model.to(device)
    arrays = (mean, scale, numbers, wanted, weights)
    middle, factor, given, truth, weight = (torch.from_numpy(array).to(device) for array in arrays)
    order, flip = (torch.from_numpy(array).to(device) for array in mirrored(False, True))
    steps = -(-len(given) // BATCH)
    descent = torch.optim.Adam(model.parameters(), RATE)
    rate = torch.optim.lr_scheduler.OneCycleLR(
        descent, RATE, total_steps=rounds * steps, pct_start=0.05
    )
    for turn in range(rounds):
        total = 0.0
        for chosen in torch.randperm(len(given), device=device).chunk(steps):
            seen, aim = given[chosen], truth[chosen]
            half = len(chosen) // 2  # as in a mirror
            seen[:half], aim[:half] = seen[:half, order] * flip, aim[:half] * flip[:3]
            added = model(((seen - middle) * factor).clamp(-float(FARTHEST), float(FARTHEST)))
            normals = torch.nn.functional.normalize(seen[:, BASE] + added, eps=1e-4)
            loss = (weight[chosen] * ((normals - aim).square().sum(dim=1) + 1e-4).sqrt()).mean()
            descent.zero_grad()
            loss.backward()
            descent.step()
            rate.step()
            total += loss.detach()
        print(f"  round {turn + 1:2d}: {np.degrees(float(total) / steps):.3f}", flush=True)
    layers = [
        (layer.weight.detach().cpu().numpy().T, layer.bias.detach().cpu().numpy())
        for layer in linear
    ]
    return Network(mean, scale, tuple(layers))


def main(arguments: list[str] | None = None) -> int:
    """Train and write."""
    parser = parser_of(__doc__)
    parser.add_argument("meshes", type=Path, help="folder with static/")
    parser.add_argument(
        "--output", type=Path, default=WEIGHTS, help=f"file ({WEIGHTS.name} of the package)"
    )
    parser.add_argument("--examples", type=int, default=4800, help="noisy meshes (4800)")
    chosen = parser.parse_args(arguments)
    begin = time.perf_counter()
    networks: list[Network] = []
    with ProcessPoolExecutor() as pool:
        made = pool.map(partial(example, chosen.meshes), range(chosen.examples), chunksize=4)
        cases = [case for case in made if case]
        for stage in range(STAGES):
            parts = list(pool.map(described, cases, chunksize=4))
            print(
                f"stage {stage + 1}: {len(parts)} meshes, {time.perf_counter() - begin:.0f} s",
                flush=True,
            )
            networks.append(train([part for k, part in enumerate(parts) if k % HELD_OUT], stage))
            # The next stage learns on results of the weights in the file, which are rounded to half precision.
            write_networks(chosen.output, networks)
            read_networks.cache_clear()
            network = read_networks(chosen.output)[stage]
            apart = [
                np.linalg.norm(network(numbers) - wanted, axis=1).mean()
                for numbers, wanted in parts[::HELD_OUT]
            ]
            left = np.degrees(np.exp(np.log(apart).mean()))
            print(f"held out: {left:.3f} degrees, {time.perf_counter() - begin:.0f} s", flush=True)
            if stage + 1 < STAGES:
                cases = list(pool.map(partial(improved, network), cases, chunksize=4))
    print(f"{chosen.output}: {chosen.output.stat().st_size} bytes")
    return 0


def write_networks(path: Path, networks: list[Network]) -> None:
    """Networks into a file, in half precision but for the scales."""
    arrays = {}
    for stage, network in enumerate(networks):
        arrays[f"mean{stage}"], arrays[f"scale{stage}"] = network.mean, network.scale
        for depth, (matrix, shift) in enumerate(network.layers):
            arrays[f"matrix{stage}.{depth}"] = matrix.astype(np.float16)
            arrays[f"shift{stage}.{depth}"] = shift.astype(np.float16)
    with path.open("wb") as file:
        np.savez_compressed(file, **arrays)  # type: ignore[arg-type]


if __name__ == "__main__":
    raise SystemExit(main())
