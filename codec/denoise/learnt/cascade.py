"""Denoising by learnt networks, one after the other: each sees the mesh that the one before it left."""

from dataclasses import dataclass

import numpy as np

from bsm.codec.arrays import Positions
from bsm.codec.denoise.learnt.descriptors import descriptions, mirrored
from bsm.codec.denoise.learnt.network import Network, read_networks
from bsm.codec.denoise.surface import Floats, Topology, face_geometry, follow_normals

VERTEX_ITERATIONS = 15
IMAGES = ((False, False), (True, True))  # frames that are averaged over: nothing tells the two ends of an axis apart


def regressed_normals(positions: Positions, topology: Topology, network: Network) -> Floats:
    found = []
    for numbers, frames in descriptions(positions, topology):
        local = np.zeros((len(numbers), 3))
        for image in IMAGES:
            order, signs = mirrored(*image)
            local += network(numbers[:, order] * signs) * signs[:3]
        found.append(np.einsum("kij,ki->kj", frames, local))
    normals = np.concatenate(found) if found else np.zeros((0, 3))
    return np.asarray(normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12))


@dataclass(frozen=True, eq=False)
class Learnt:
    positions: Positions
    normals: Floats


def learnt(positions: Positions, topology: Topology) -> Learnt:
    """Denoise `positions`, shape (n, 3), by all networks in turn."""
    normals = np.zeros((len(topology.faces), 3))
    for network in read_networks():
        normals = regressed_normals(positions, topology, network)
        positions = follow_normals(positions, topology, normals, VERTEX_ITERATIONS)
    return Learnt(positions, normals)


def joined(positions: Positions, other: Learnt, share: float, topology: Topology) -> Positions:
    """Positions, shape (n, 3), that follow the mean of their own normals and the learnt ones, whose part is `share`."""
    if share == 0.0:
        return positions
    normals = (1.0 - share) * face_geometry(positions, topology.faces).normals + share * other.normals
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    start = (1.0 - share) * positions + share * other.positions
    return follow_normals(start, topology, normals, VERTEX_ITERATIONS)
