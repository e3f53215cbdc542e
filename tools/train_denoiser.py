"""Learn what `codec.denoise.learnt` knows (`codec/denoise/learnt/weights.npz`) from synthetic noise.

    python -m tools.train_denoiser MESHES [--output codec/denoise/learnt/weights.npz] [--shapes 360] [--stages 3]

Shapes are those of `tools.made_shapes`, and crops of three meshes of the folder that evaluate nothing
(`TRAINING_MESHES`). Each gets noise of its own kind and strength. A stage learns to tell the clean normals from the
descriptions of noisy faces; the next one learns on what it has left. All numbers are drawn from seeds: the same command
writes the same file on the same machine.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np

from bsm.codec.arrays import Faces, Positions
from bsm.codec.denoise.learnt.cascade import (
    VERTEX_ITERATIONS,
    WEIGHTS,
    Network,
    read_networks,
    regressed_normals,
    sigmoid,
)
from bsm.codec.denoise.learnt.descriptors import BASE, NUMBERS, RADIUS, Singles, descriptions, mirrored
from bsm.codec.denoise.surface import Floats, Topology, face_geometry, follow_normals, surroundings
from bsm.files.mesh import read_mesh
from tools.made_shapes import made_shape
from tools.noise import (
    correlated_along_normals,
    gaussian_along_normals,
    gaussian_isotropic,
    impulsive,
    uniform_along_normals,
)

TRAINING_MESHES = ("dragon_437645", "horse_48485", "cgal_elephant_with_holes")
CROPS, CROP = 12, 6000
"""Of each mesh, and their faces."""
CELLS = (22, 40)
FACES = 2200
"""Of each shape that are learnt from."""
WIDTHS = (160, 160, 96)
ROUNDS, BATCH, RATE = 14, 2048, 2e-3
FIRST_SHAPE = 1000


@dataclass(eq=False)
class Example:
    """A noisy mesh on its way through the stages, and the normals of the clean one."""

    topology: Topology
    positions: Positions
    normals: Floats
    chosen: np.ndarray


def examples(folder: Path, shapes: int) -> Iterator[Example]:
    """Noisy meshes."""
    for number, (positions, faces) in enumerate(_clean(folder, shapes)):
        random = np.random.default_rng(number)
        # Strength from 0.06 to 0.75 edges, evenly in its logarithm.
        sigma = float(0.06 * (0.75 / 0.06) ** random.random())
        noisy = _noise(positions, faces, sigma, number)
        chosen = random.permutation(len(faces))[:FACES]
        yield Example(Topology(faces, len(positions)), noisy, face_geometry(positions, faces).normals, chosen)


def _clean(folder: Path, shapes: int) -> Iterator[tuple[Positions, Faces]]:
    for seed in range(FIRST_SHAPE, FIRST_SHAPE + shapes):
        positions, faces = made_shape(seed, int(np.random.default_rng(seed).integers(*CELLS)))
        if len(faces) > 500:
            yield positions, faces
    for name in TRAINING_MESHES:
        mesh = read_mesh(folder / "static" / f"{name}.ply").mesh
        centroids = mesh.positions[mesh.faces].mean(axis=1)
        random = np.random.default_rng(len(mesh.faces))
        for _ in range(CROPS if len(mesh.faces) > 2 * CROP else 1):
            center = centroids[random.integers(len(centroids))]
            near = np.argsort(np.square(centroids - center).sum(axis=1), kind="stable")[:CROP]
            used, corners = np.unique(mesh.faces[near], return_inverse=True)
            yield mesh.positions[used].astype(np.float64), corners.reshape(-1, 3).astype(np.int32)


def _noise(positions: Positions, faces: Faces, sigma: float, number: int) -> Positions:
    kind = number % 8
    if kind < 4:
        return gaussian_along_normals(positions, faces, sigma, number)
    if kind == 4:
        return gaussian_isotropic(positions, faces, 0.7 * sigma, number)
    if kind == 5:
        return impulsive(positions, faces, 1.4 * sigma, 0.5, number)
    if kind == 6:
        return uniform_along_normals(positions, faces, sigma, number)
    return correlated_along_normals(positions, faces, sigma, number)


def described(cases: list[Example]) -> tuple[Singles, Singles]:
    """Numbers of the chosen faces of all examples, and their clean normals in the faces' frames."""
    numbers, wanted = [], []
    for case in cases:
        parts = list(descriptions(case.positions, case.topology, surroundings(case.positions, case.topology, RADIUS)))
        frames = np.concatenate([frame for _, frame in parts])[case.chosen]
        numbers.append(np.concatenate([part for part, _ in parts])[case.chosen])
        wanted.append(np.einsum("kij,kj->ki", frames, case.normals[case.chosen]).astype(np.float32))
    return np.concatenate(numbers), np.concatenate(wanted)


def train(numbers: Singles, wanted: Singles, seed: int, rounds: int = ROUNDS) -> Network:
    """Descend the mean distance of unit normals (Adam, the rate falling along a cosine)."""
    random = np.random.default_rng(seed)
    mean = numbers.mean(axis=0)
    scale = (1.0 / np.maximum(numbers.std(axis=0), 1e-3)).astype(np.float32)
    sizes = (NUMBERS, *WIDTHS, 3)
    numbers_of_layers: list[Singles] = []
    for depth, (rows, columns) in enumerate(pairwise(sizes)):
        # The last layer begins near zero: with the filtered normal as it is.
        spread = np.sqrt((1.5 if depth < len(WIDTHS) else 0.01) / rows)
        numbers_of_layers += [
            random.normal(0.0, spread, (rows, columns)).astype(np.float32),
            np.zeros(columns, np.float32),
        ]
    network = Network(mean, scale, tuple(zip(numbers_of_layers[::2], numbers_of_layers[1::2], strict=True)))
    first = [np.zeros_like(array) for array in numbers_of_layers]
    second = [np.zeros_like(array) for array in numbers_of_layers]
    images = [mirrored(x, y) for x in (False, True) for y in (False, True)]
    steps = rounds * (len(numbers) // BATCH)
    done = 0
    for turn in range(rounds):
        order, total = random.permutation(len(numbers)), 0.0
        for begin in range(0, len(order) - BATCH + 1, BATCH):
            chosen = order[begin : begin + BATCH]
            places, signs = images[random.integers(4)]
            seen = numbers[chosen][:, places] * signs
            loss, slopes = _slopes(
                numbers_of_layers, network.standardised(seen), seen[:, BASE], wanted[chosen] * signs[:3]
            )
            total += loss
            done += 1
            rate = RATE * min(1.0, 20 * done / steps) * 0.5 * (1.0 + np.cos(np.pi * done / steps)) + 1e-6
            for array, slope, a, b in zip(numbers_of_layers, slopes, first, second, strict=True):
                a += 0.1 * (slope - a)
                b += 0.005 * (slope * slope - b)
                step = rate / (1.0 - 0.9**done) * a / (np.sqrt(b / (1.0 - 0.995**done)) + 1e-8)
                array -= step.astype(np.float32)
        print(f"  round {turn + 1:2d}: {np.degrees(total / (len(order) // BATCH)):.3f}", flush=True)
    return network


def _slopes(arrays: list[Singles], values: Singles, base: Singles, wanted: Singles) -> tuple[float, list[Singles]]:
    """Mean distance between unit normals, and its slopes."""
    inputs, gates = [values], []
    for matrix, shift in zip(arrays[:-2:2], arrays[1:-2:2], strict=True):
        linear = inputs[-1] @ matrix + shift
        gate = sigmoid(linear)
        gates.append((linear, gate))
        inputs.append(linear * gate)
    raw = base + inputs[-1] @ arrays[-2] + arrays[-1]
    length = np.maximum(np.linalg.norm(raw, axis=1, keepdims=True), 1e-4)
    normals = raw / length
    apart = normals - wanted
    distance = np.sqrt((apart**2).sum(axis=1, keepdims=True) + 1e-4)
    slope = apart / distance / len(values)
    slope = (slope - (slope * normals).sum(axis=1, keepdims=True) * normals) / length
    slopes: list[Singles] = []
    for depth in range(len(arrays) // 2 - 1, -1, -1):
        slopes = [inputs[depth].T @ slope, slope.sum(axis=0), *slopes]
        if depth:
            linear, gate = gates[depth - 1]
            slope = (slope @ arrays[2 * depth].T) * (gate * (1.0 + linear * (1.0 - gate)))
    return float(distance.mean()), slopes


def main(arguments: list[str] | None = None) -> int:
    """Train and write."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("meshes", type=Path, help="folder with static/")
    parser.add_argument("--output", type=Path, default=WEIGHTS, help=f"file ({WEIGHTS.name} of the package)")
    parser.add_argument("--shapes", type=int, default=360, help="made shapes (360)")
    parser.add_argument("--stages", type=int, default=3, help="networks, one after the other (3)")
    chosen = parser.parse_args(arguments)
    begin = time.process_time()
    cases = list(examples(chosen.meshes, chosen.shapes))
    total = sum(len(case.topology.faces) for case in cases)
    print(f"{len(cases)} meshes, {total} faces, {time.process_time() - begin:.0f} CPU s", flush=True)
    networks: list[Network] = []
    for stage in range(chosen.stages):
        numbers, wanted = described(cases)
        print(f"stage {stage + 1}: {len(numbers)} faces described, {time.process_time() - begin:.0f} CPU s", flush=True)
        networks.append(train(numbers, wanted, stage))
        # The next stage sees what the file holds, not what is in memory.
        write_networks(chosen.output, networks)
        read_networks.cache_clear()
        network = read_networks(chosen.output)[stage]
        if stage + 1 < chosen.stages:
            for case in cases:
                near = surroundings(case.positions, case.topology, RADIUS)
                normals = regressed_normals(case.positions, case.topology, near, network)
                case.positions = follow_normals(case.positions, case.topology, normals, VERTEX_ITERATIONS)
        print(f"stage {stage + 1}: {time.process_time() - begin:.0f} CPU s", flush=True)
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
