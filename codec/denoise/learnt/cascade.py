"""Denoising by learnt networks, one after the other: each sees the mesh that the one before it left."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.special import expit

from bsm.codec.arrays import Floats, Mask, Positions
from bsm.codec.denoise.learnt.descriptors import BASE, NUMBERS, RADIUS, Singles, descriptions
from bsm.codec.denoise.surface import Topology, follow_normals, surroundings, unit
from bsm.codec.geometry.metrics import face_normals

# A mesh unlike those that were learnt from must not lead a network into numbers that it has never seen.
FARTHEST = np.float32(6.0)  # bound of standardised numbers
TOGETHER = 16  # faces of a product of matrices: larger ones wake threads that wait longer than they work
WEIGHTS = Path(__file__).with_name("weights.npz")


@dataclass(frozen=True, eq=False)
class Network:
    mean: Singles
    scale: Singles
    layers: tuple[tuple[Singles, ...], ...]

    def __call__(self, numbers: Singles) -> Singles:
        # Always the same shape of product: BLAS sums in an order that depends on it, and results shall not.
        values = np.zeros((-(-len(numbers) // TOGETHER), TOGETHER, NUMBERS), np.float32)
        values.reshape(-1, NUMBERS)[: len(numbers)] = np.clip((numbers - self.mean) * self.scale, -FARTHEST, FARTHEST)
        for matrix, shift in self.layers[:-1]:
            values = values @ matrix + shift
            values *= expit(values)  # x / (1 + exp(-x)), which has no kink
        matrix, shift = self.layers[-1]
        # A correction of the filtered normal: a network that knows nothing changes nothing.
        normals = numbers[:, BASE] + (values @ matrix + shift).reshape(-1, 3)[: len(numbers)]
        return np.asarray(normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), np.float32(1e-6)))


@cache
def read_networks(path: Path = WEIGHTS) -> tuple[Network, ...]:
    """The networks of a file, the one for the first pass first."""
    networks: list[Network] = []
    with np.load(path) as arrays:
        while f"mean{(stage := len(networks))}" in arrays:
            keys = [f"{stage}.{layer}" for layer in range(sum(key.startswith(f"matrix{stage}.") for key in arrays))]
            layers = (tuple(arrays[part + key].astype(np.float32) for part in ("matrix", "shift")) for key in keys)
            networks.append(Network(arrays[f"mean{stage}"], arrays[f"scale{stage}"], tuple(layers)))
    if not networks or any(len(network.mean) != NUMBERS for network in networks):
        # Weights for other inputs would run, and give garbage.
        raise ValueError(f"{path}: made for other numbers of faces; train it again: python -m tools.train_denoiser")
    return tuple(networks)


VERTEX_ITERATIONS = 15  # as the networks were trained


def regressed_normals(described: Iterable[tuple[Singles, Floats]], network: Network) -> Floats:
    """Normals by one network, shape (m, 3), whichever way the mesh is turned."""
    found = [np.einsum("kij,ki->kj", frames, network(numbers)) for numbers, frames in described]
    return unit(np.concatenate(found) if found else np.zeros((0, 3)))


class Learnt(NamedTuple):
    positions: Positions
    normals: Floats


def learnt(positions: Positions, topology: Topology, noisy: Mask | None = None) -> Learnt:
    """Denoise `positions`, shape (n, 3), by all networks in turn; `noisy`, shape (n,), marks those with noise."""
    normals, near = np.zeros((len(topology.faces), 3)), surroundings(positions, topology, RADIUS)
    for network in read_networks():
        normals = regressed_normals(descriptions(positions, topology, near, noisy), network)
        # Each stage sees the mesh that the one before it left, as it did in training.
        positions = follow_normals(positions, topology, normals, VERTEX_ITERATIONS)
    return Learnt(positions, normals)


def joined(positions: Positions, other: Learnt, share: float, topology: Topology) -> Positions:
    """Positions, shape (n, 3), that follow the mean of their own normals and the learnt ones, whose part is `share`."""
    normals = unit((1.0 - share) * face_normals(positions, topology.faces) + share * other.normals)
    # Only along the normals: the networks leave vertices where noise has put them along the surface.
    up = unit(topology.incidence @ normals)
    start = positions + share * np.einsum("ij,ij->i", other.positions - positions, up)[:, None] * up
    return follow_normals(start, topology, normals, VERTEX_ITERATIONS)
