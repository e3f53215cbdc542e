"""What the fine step starts from: how the coarse mesh is handed over to it."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from bsm.codec.arrays import Positions
from bsm.codec.choices import named
from bsm.codec.denoise.filters.guided import GuidedFilter
from bsm.codec.denoise.filters.topology import Topology
from bsm.codec.denoise.filters.vertex_update import face_geometry, vertex_normals

SIGMA_R = 0.3
"""Width of the range kernel; half or twice of it leaves 0.1 and 1.1 % more of the angle (tools.constants)."""


class HandOver(Protocol):
    """Noisy and coarse positions, both (n, 3), to those from which the fine step starts (a new array)."""

    def __call__(self, noisy: Positions, coarse: Positions, topology: Topology) -> Positions: ...


def coarse_positions(noisy: Positions, coarse: Positions, topology: Topology) -> Positions:
    """The paper's: the fine step sees the coarse mesh alone, shape (n, 3)."""
    return np.array(coarse)


def coarse_heights(noisy: Positions, coarse: Positions, topology: Topology) -> Positions:
    """Move the noisy vertices, shape (n, 3), along the normals of the coarse mesh, shape (n, 3), as far as that is."""
    normals = vertex_normals(face_geometry(np.ascontiguousarray(coarse), topology.faces).normals, topology.around)
    return np.asarray(noisy + np.einsum("ij,ij->i", coarse - noisy, normals)[:, None] * normals)


def coarse_normals(noisy: Positions, coarse: Positions, topology: Topology) -> Positions:
    """Keep the noisy positions, shape (n, 3), after one joint bilateral pass that the coarse mesh's normals guide."""
    guide = face_geometry(np.ascontiguousarray(coarse), topology.faces).normals
    return GuidedFilter(noisy, topology).step(noisy, lambda *_: guide, SIGMA_R)


def noisy_positions(noisy: Positions, coarse: Positions, topology: Topology) -> Positions:
    """No coarse step: the fine step sees the noisy mesh, shape (n, 3)."""
    return np.array(noisy)


HAND_OVERS: dict[str, HandOver] = {
    "positions": coarse_positions,
    "heights": coarse_heights,
    "normals": coarse_normals,
    "none": noisy_positions,
}


def hand_over(name: str) -> HandOver:
    """The hand-over called `name`; `OptionError` if there is none."""
    return named("hand-over", HAND_OVERS, name)
