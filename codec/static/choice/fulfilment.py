"""The cheapest way to keep a contract: blocks, blocks and refinement, or a grid; each checked on what is decoded.

Rules say which ways can win, and whole files decide among these. What the rules are made of was measured on scans,
models and assets; they decide about bytes and time, never about whether a contract is kept.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from operator import attrgetter

import numpy as np

from bsm.bitstream.errors import LimitError, TargetError
from bsm.codec.static.choice.block_search import BlockSearch
from bsm.codec.static.choice.grid_search import GridSearch
from bsm.codec.static.choice.judge import Judge, Sight
from bsm.codec.static.choice.lattices import rounded
from bsm.codec.static.choice.reaches import reaches
from bsm.codec.static.contract import Contract
from bsm.codec.static.draft import Draft
from bsm.codec.static.options import EncodeOptions
from bsm.codec.static.preamble_encoding import Prepared
from bsm.codec.static.ways.block_coder import Progress

FINE_REACH = 0.001
"""Where normals do not matter, grids are smaller than blocks from this distance on, in BSM units."""
MODEL_ANGLE = 4.0
"""Up to this angle, models with flat faces are smaller on grids."""
VISUAL_TRIES = 4
"""Grids that are rounded to for the angle that comes with a visual error."""
FLAT = 0.15
"""Share of frequencies worth coding at a coarse step from which on a grid is smaller than blocks."""
COARSE = 0.016
"""A step, in BSM units, at which blocks carry nothing but what they are for."""
FINEST_BITS = 20
"""Of the grid that is tried where nothing else will do."""
FEW_LOOKS = 4000
"""Meshes of more vertices are looked at in one way to code alone, the one that is likely to be smaller."""
DEARER = 1.1
"""Of fewer, grids are looked at, too, unless what they should take is so much more than what blocks took."""
DENSE, TINY, PREVIEW = 0.0062, 0.0012, 2.0
"""Below this look, models with flat faces are smaller on grids, unless the mean edge is shorter than the first; and so
are all meshes where it is shorter than the second: pictures do not show their faces."""
MARGIN = 1e-9
"""Of a bound on distances, for what rounding may add."""


class Fulfilment:
    """Looks for the smallest stream of a mesh that keeps a contract."""

    def __init__(
        self,
        prepared: Prepared,
        options: EncodeOptions,
        contract: Contract,
        sight: Sight,
        progress: Progress | None = None,
        *,
        thorough: bool = False,
    ) -> None:
        self._thorough = thorough
        self._prepared = prepared
        self._options = options
        self._contract = contract
        self._progress = progress
        self._sight = sight
        self._shaper = sight.shaper
        self._reaches = reaches(prepared, contract) * (1.0 - MARGIN)
        self._edge = self._shaper.mean_edge or 1.0
        self._judge = Judge(prepared, sight, contract, self._reaches)
        self._angle = self._about_angle()
        self._blocks = BlockSearch(
            prepared,
            options,
            contract,
            sight,
            self._reaches,
            self._judge,
            self._told,
            progress,
            angle=self._angle,
            thorough=thorough,
        )
        self._grids = GridSearch(
            prepared,
            self._shaper,
            contract,
            float(self._reaches.min()),
            self._judge,
            self._told,
            angle=self._angle,
            thorough=thorough,
        )

    def draft(self, size: Callable[[Draft], int] = attrgetter("size")) -> Draft:
        """The smallest draft that was found."""
        if not self._prepared.mesh.diagonal > 0.0:
            return rounded(self._prepared, 1)  # a point
        for every in (False, True):
            found = self._drafts(every=every)
            for draft in sorted(found, key=size) if len(found) > 1 else found:
                if self.keeps(draft):
                    return draft
        finest = rounded(self._prepared, FINEST_BITS)
        if self.keeps(finest):
            return finest
        raise TargetError(self._refusal())

    def keeps(self, draft: Draft) -> bool:
        """Whether what its decoder makes of a draft keeps the contract."""
        return self._judge.keeps(self._prepared.units.into(draft.decoded))

    @property
    def had(self) -> str:
        """The bounds that the best draft broke that was seen."""
        return self._judge.had

    def _about_angle(self) -> float:
        """Mean angle of normals that comes with all that is asked for, about, degrees."""
        contract, step = self._contract, COARSE
        if contract.visual == math.inf:
            return contract.about_angle
        for _ in range(VISUAL_TRIES):
            found = self._sight.reference.nmsve(np.rint(self._prepared.positions / step) * step)
            step *= min(max(contract.visual / max(found, 1e-300), 1.0 / 64.0), 64.0)
        return min(contract.about_angle, max(self._shaper.character.rounded_angle(step), 1e-4))

    def _drafts(self, *, every: bool) -> list[Draft]:
        """Drafts that may be smallest; with `every`, grids even where they should be larger."""
        found: list[Draft] = []
        try:
            if not every and self._blocks_may_win():
                found.extend(self._blocks.drafts())
        except LimitError:
            pass  # blocks that decoders would refuse: a grid asks for little
        smallest = min((draft.size for draft in found), default=None)
        if smallest is None or self._grids_may_win(smallest):
            found.extend(self._grids.drafts())
        return found

    def _grids_may_win(self, smallest: int) -> bool:
        """Whether grids may take fewer bytes than blocks did."""
        if self._thorough:
            return True
        if self._contract.look < math.inf:
            return self._few_looks and self.bytes_on_grids < DEARER * smallest
        return self.bytes_on_grids < smallest

    @property
    def _few_looks(self) -> bool:
        return self._contract.look < math.inf and self._prepared.graph.size < FEW_LOOKS

    @property
    def bytes_on_grids(self) -> float:
        """Bytes of a stream on a grid, rather too few, by measures alone."""
        return len(self._prepared.connectivity.data) + self._grids.bytes

    def _refusal(self) -> str:
        return f"{self._contract} cannot be kept on this mesh; the best that can be had is {self._judge.had}"

    @contextmanager
    def _told(self) -> Iterator[None]:
        """Tell of a trial as of all blocks once more."""
        blocks = self._prepared.block_count
        if self._progress:
            self._progress(0, blocks)
        yield
        if self._progress:
            self._progress(blocks, blocks)

    def _blocks_may_win(self) -> bool:
        """Whether most of what is worth coding is at low frequencies."""
        if self._options.quick:
            return False
        if self._thorough:
            return self._prepared.has_low_frequencies
        if not self._contract.shades and self._reaches.max() < FINE_REACH:
            return False
        if self._grids.fits_model or (self._angle <= MODEL_ANGLE and self._shaper.character.is_model):
            return False
        plain = self._shaper.character.is_model and self._edge >= DENSE
        if self._contract.look < PREVIEW and (plain or self._edge < TINY):
            return False
        if not self._prepared.has_low_frequencies:
            return False
        return self._few_looks or not self._blocks.is_flat(COARSE, FLAT)
