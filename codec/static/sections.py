"""Where a mesh is cut into sections, so that its first blocks can be drawn before all of its faces have come.

What blocks cost more for it is that of one more chain, about 80 bytes, where a mesh has so many blocks that they are
several chains anyway, nothing: so two sections are made of large meshes. Small ones are there at once.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from bsm.bitstream.connectivity.faces import Cut
from bsm.bitstream.errors import OptionError

PLACES, BEFORE, BEHIND = 24, 0.15, 0.03
"""A mesh may be cut at so many places around each share of its faces, from so much of the share before it on: vertices
come before their faces. Each costs an encoder a look at the whole surface."""
MANY_VERTICES, MUCH, SECTIONS = 24_000, 1 << 11, 2
"""A mesh of so many vertices, and bytes for its faces, comes in so many sections unless something else is asked for."""


def possible_cuts(faces: int, vertices: int, sections: int | None) -> tuple[int, ...]:
    """Numbers of faces behind which a mesh may be cut that is to come in so many sections, see `choose_cuts`."""
    if sections == 1 or (sections is None and vertices < MANY_VERTICES):
        return ()
    count = sections or SECTIONS
    shares = [faces * number / count for number in range(1, count)]
    steps = [1.0 - BEFORE + (BEFORE + BEHIND) * place / (PLACES - 1) for place in range(PLACES)]
    places = {round(share * step) for share in shares for step in steps}
    return tuple(sorted(place for place in places if 0 < place < faces))


def choose_cuts(places: Sequence[Cut], vertices: int, blocks: int, size: int, sections: int | None) -> tuple[Cut, ...]:
    """Where to cut a mesh: so that sections have as many blocks each."""
    if sections is None:
        sections = SECTIONS if places and blocks >= SECTIONS and vertices >= MANY_VERTICES and size >= MUCH else 1
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
