"""Where a mesh is cut into sections, so that its first blocks can be drawn before all of its faces have come."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from bitstream.connectivity.faces import Cut
from bitstream.errors import OptionError

PLACES = 256
"""Where a mesh may be cut: at as many places, evenly spread over its faces."""


def possible_cuts(faces: int) -> tuple[int, ...]:
    """Numbers of faces behind which a mesh of so many may be cut, ascending."""
    return tuple(sorted({faces * place // PLACES for place in range(1, PLACES)} - {0}))


def choose_cuts(places: Sequence[Cut], vertices: int, blocks: int, sections: int) -> tuple[Cut, ...]:
    """Where to cut a mesh of so many vertices and blocks: so that sections have as many blocks each.

    Parameters
    ----------
    places : sequence of Cut
    vertices, blocks : int
    sections : int

    Raises
    ------
    OptionError
        If the mesh cannot be cut into so many.
    """
    if sections == 1:
        return ()
    if blocks < sections:
        raise OptionError(f"{sections} sections of {blocks} blocks; take fewer sections, or smaller blocks")
    wanted = [vertices * (blocks * number // sections) / blocks for number in range(1, sections)]
    cuts = tuple(min(places, key=lambda cut: abs(cut.vertices - most)) for most in wanted) if places else ()
    ends = [0, *(cut.vertices for cut in cuts), vertices]
    if not places or any(last <= first for first, last in pairwise(ends)):
        raise OptionError(
            f"this mesh cannot come in {sections} sections: it has too few faces, or vertices where several surfaces "
            "meet; take sections = 1"
        )
    return cuts
