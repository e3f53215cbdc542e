"""What the fine step starts from: how the coarse mesh is handed over to it."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from bitstream.errors import OptionError
from codec.denoise.guided import GuidedFilter
from codec.denoise.surface import face_geometry
from codec.mesh import Faces, Positions

SIGMA_R = 0.2


class HandOver(Protocol):
    """Noisy and coarse positions (n, 3) and faces (m, 3) to the positions from which the fine step starts."""

    def __call__(self, noisy: Positions, coarse: Positions, faces: Faces) -> Positions: ...


def coarse_positions(noisy: Positions, coarse: Positions, faces: Faces) -> Positions:
    """The paper's: the fine step sees the coarse mesh alone. Good under heavy noise; elsewhere detail is lost."""
    return coarse.copy()


def coarse_normals(noisy: Positions, coarse: Positions, faces: Faces) -> Positions:
    """Keep the noisy positions, after one joint bilateral pass that the normals of the coarse mesh guide."""
    return guided_by_coarse(GuidedFilter(noisy, faces), noisy, coarse, SIGMA_R)


def noisy_positions(noisy: Positions, coarse: Positions, faces: Faces) -> Positions:
    """No coarse step: the fine step sees the noisy mesh."""
    return noisy.copy()


def guided_by_coarse(filter_: GuidedFilter, noisy: Positions, coarse: Positions, sigma_r: float) -> Positions:
    """The joint bilateral pass of `coarse_normals` with the neighbourhoods of a filter that is there already."""
    guide = face_geometry(np.ascontiguousarray(coarse), filter_.topology.faces).normals
    return filter_.follow(noisy, filter_.guided_normals(noisy, guide, sigma_r))


HAND_OVERS: dict[str, HandOver] = {
    "positions": coarse_positions,
    "normals": coarse_normals,
    "none": noisy_positions,
}


def hand_over(name: str) -> HandOver:
    """The hand-over called `name`.

    Raises
    ------
    OptionError
        If there is none of that name.
    """
    try:
        return HAND_OVERS[name]
    except KeyError:
        raise OptionError(f"there is no hand-over {name!r}; choose one of {', '.join(HAND_OVERS)}") from None
