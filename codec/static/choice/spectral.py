"""Drafts of blocks: a base, and a layer of refinement on it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from bsm.bitstream.container.header import Header, Layer
from bsm.bitstream.limits import NAMED_LIMITS
from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Levels, Matrix
from bsm.codec.signal.chain import AS_SPECIFIED, Trial
from bsm.codec.signal.frames import in_frames, local_frames, raised, slide, tangent_steps
from bsm.codec.signal.smooth import smooth
from bsm.codec.static.admission import admit, patience
from bsm.codec.static.assembly import blended
from bsm.codec.static.choice.plan import Planner
from bsm.codec.static.draft import Draft
from bsm.codec.static.options import EncodeOptions
from bsm.codec.static.preamble_encoding import Prepared
from bsm.codec.static.units import single
from bsm.codec.static.ways.block_coder import Progress, encode_blocks
from bsm.codec.static.ways.refinement import encode_layer
from bsm.codec.static.work import Allowance


@dataclass(frozen=True, eq=False)
class Base:
    """Blocks, coded."""

    prepared: Prepared
    draft: Draft
    positions: Matrix

    @cached_property
    def frames(self) -> Matrix:
        """The frames that levels are in, shape (n, 9)."""
        return local_frames(self.positions, self.prepared.mesh.faces)

    @cached_property
    def offsets(self) -> Matrix:
        """What is missing, in these frames: along normals and tangents, shape (n, 3)."""
        return in_frames(self.prepared.positions - self.positions, self.frames)

    def expected_steps(self, layer: Layer) -> Matrix:
        """About what levels of a layer move each vertex, shape (n, 3), before any is chosen."""
        original, faces = self.prepared.positions, self.prepared.mesh.faces
        aside = tangent_steps(original, faces, layer.step, layer.ratio)
        return np.column_stack([np.full(len(aside), layer.step), aside, aside])

    def known_steps(self, layer: Layer, levels: Levels) -> Matrix:
        """What levels of a layer move each vertex, shape (n, 3), if its heights are those of `levels`, shape (n, 3)."""
        upright = raised(self.positions, self.frames, levels, layer.step)
        aside = tangent_steps(upright, self.prepared.mesh.faces, layer.step, layer.ratio)
        return np.column_stack([np.full(len(aside), layer.step), aside, aside])

    def wanted(self, steps: Matrix) -> tuple[Levels, Matrix]:
        """The nearest levels to steps, both of shape (n, 3), and what one of each moves, shape (n, 3, 3)."""
        directions = self.frames.reshape(-1, 3, 3) * steps[:, :, None]
        return np.rint(self.offsets / steps).astype(np.int32), directions

    def layer(self, step: float, ratio: float) -> Layer:
        """A layer whose numbers a header can hold."""
        return Layer(single(step), single(ratio))

    def moved(self, layer: Layer, levels: Levels) -> Matrix:
        """Where levels, shape (n, 3), bring the base, in BSM units, shape (n, 3)."""
        moved = raised(self.positions, self.frames, levels, layer.step)
        slide(moved, self.frames, levels, self.known_steps(layer, levels)[:, 1])
        return moved

    def refined(self, layer: Layer, levels: Levels) -> Draft:
        """The stream with a layer of levels, shape (n, 3)."""
        body = self.draft.body + tuple(encode_layer(self.prepared.mesh.faces, levels))
        header = replace(self.draft.header, refinement=(layer.step, layer.ratio))
        return Draft(header, body, self.prepared.units.back(self.moved(layer, levels)))


def base_step(angle: float) -> float:
    """The step of blocks that refinement to a mean angle of normals, degrees, is cheapest on."""
    return 0.016 if angle >= 6.0 else 0.012 if angle >= 4.0 else 0.008 if angle >= 2.5 else 0.004


class Spectral:
    """Codes a mesh in blocks."""

    def __init__(
        self, prepared: Prepared, options: EncodeOptions, widest: float = 1.0, trial: Trial = AS_SPECIFIED
    ) -> None:
        self._prepared = prepared
        self._options = options
        self._planner = Planner(prepared, options, widest, trial)

    def is_flat(self, step: float, share: float) -> bool:
        """Whether as large a share of all frequencies is worth coding at a step."""
        return self._planner.is_flat(step, share)

    def base(self, step: float, progress: Progress | None = None) -> Base:
        """The blocks at a step."""
        prepared, options = self._prepared, self._options
        scheme = self._planner.scheme(step)
        blocks = encode_blocks(
            scheme,
            prepared.positions,
            threads=options.threads,
            doi=options.doi,
            progress=progress,
            spend=patience(options.limits, prepared.graph.size),
        )
        admit(Allowance(NAMED_LIMITS[options.limits]()), prepared, blocks)
        positions = blended(prepared.graph.size, (block.decoded for block in blocks))
        smoothing = options.fixed_smoothing
        header = Header(
            vertices=prepared.graph.size,
            faces=len(prepared.mesh.faces),
            block_size=prepared.size,
            coefficients=max(block.packet.coefficients for block in blocks),
            center=prepared.units.center,
            scale=prepared.units.scale,
            smoothing=self._planner.smoothing(positions) if smoothing is None else single(smoothing),
            **scheme.fields(),
        )
        decoded = smooth(prepared.graph, positions, header.smoothing)
        body = (*prepared.before_blocks, *(block.packet for block in blocks))
        return Base(prepared, Draft(header, body, prepared.units.back(decoded)), np.ascontiguousarray(decoded))
