"""Drafts of blocks: a base, and layers of refinement on it."""

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
        return self.offsets_of(self.positions)

    def offsets_of(self, positions: Matrix) -> Matrix:
        """What is missing where the base was moved to `positions`, shape (n, 3), in the same frames."""
        return in_frames(self.prepared.positions - positions, self.frames)

    @property
    def upright(self) -> Matrix:
        """Positions of which nothing is missing along the normals, shape (n, 3)."""
        return self.positions + self.frames[:, :3] * self.offsets[:, :1]

    def expected_steps(self, layer: Layer) -> Matrix:
        """About what levels of a layer move each vertex, shape (n, axes), before any is chosen."""
        steps = np.full((len(self.positions), layer.axes), layer.step)
        if layer.axes > 1:
            original, faces = self.prepared.positions, self.prepared.mesh.faces
            steps[:, 1:] = tangent_steps(original, faces, layer.step, layer.ratio)[:, None]
        return steps

    def known_steps(self, layer: Layer, levels: Levels) -> Matrix:
        """What levels of a layer move each vertex, shape (n, 3), if its heights are those of `levels`, shape (n, 3)."""
        upright = raised(self.positions, self.frames, levels, layer.step)
        aside = tangent_steps(upright, self.prepared.mesh.faces, layer.step, layer.ratio)
        return np.column_stack([np.full(len(aside), layer.step), aside, aside])

    def wanted(self, steps: Matrix) -> tuple[Levels, Matrix]:
        """The nearest levels to steps, both of shape (n, axes), and what one of each moves, shape (n, axes, 3)."""
        axes = steps.shape[1]
        directions = self.frames.reshape(-1, 3, 3)[:, :axes] * steps[:, :, None]
        return np.rint(self.offsets[:, :axes] / steps).astype(np.int32), directions

    def layer(self, step: float, ratio: float) -> Layer:
        """A layer whose numbers a header can hold."""
        return Layer(single(step), single(ratio))

    def moved(self, layer: Layer, levels: Levels, positions: Matrix | None = None) -> Matrix:
        """Where levels, shape (n, axes), bring the base, or other positions, in BSM units, shape (n, 3)."""
        moved = raised(self.positions if positions is None else positions, self.frames, levels, layer.step)
        if layer.axes > 1:
            slide(moved, self.frames, levels, self.known_steps(layer, levels)[:, 1])
        return moved

    def refined(self, *added: tuple[Layer, Levels], borders: bool = False) -> Stack:
        """With layers of levels, shapes (n, axes); with `borders`, the last has some at vertices of these alone."""
        return Stack(self, added, borders)


@dataclass(frozen=True, eq=False)
class Stack:
    """Layers of levels, shapes (n, axes), on a base; with `borders`, the last has some at vertices of these alone."""

    base: Base
    added: tuple[tuple[Layer, Levels], ...]
    borders: bool

    @cached_property
    def positions(self) -> Matrix:
        """As decoded, in BSM units, shape (n, 3)."""
        positions = self.base.positions
        for layer, levels in self.added:
            positions = self.base.moved(layer, levels, positions)
        return positions

    def draft(self) -> Draft:
        """The stream of blocks and layers."""
        base = self.base
        if not self.added:
            return base.draft
        body, last = base.draft.body, len(self.added) - 1
        for number, (_, levels) in enumerate(self.added):
            body += tuple(
                encode_layer(base.prepared.mesh.faces, number, levels, borders=self.borders and number == last)
            )
        numbers = tuple(number for layer, _ in self.added for number in (layer.step, layer.ratio))
        header = replace(base.draft.header, refinements=numbers, borders=int(self.borders))
        return Draft(header, body, base.prepared.units.back(self.positions))


def base_step(angle: float) -> float:
    """The step of blocks without a detail layer that refinement to a mean angle of normals, degrees, is cheapest on."""
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
        schemes = self._planner.schemes(step)
        blocks = encode_blocks(
            schemes,
            prepared.positions,
            threads=options.threads,
            doi=options.doi,
            progress=progress,
            spend=patience(options.limits, prepared.graph.size),
        )
        admit(Allowance(NAMED_LIMITS[options.limits]()), prepared, blocks)
        positions = blended(prepared.graph.size, (block.decoded for block in blocks))
        smoothing = options.fixed_smoothing
        fields = schemes[0].fields() | {"blocks": len(blocks), "sections": prepared.sections}
        header = Header(
            vertices=prepared.graph.size,
            faces=len(prepared.mesh.faces),
            block_size=prepared.size,
            coefficients=max(block.packet.coefficients for block in blocks),
            center=prepared.units.center,
            scale=prepared.units.scale,
            smoothing=self._planner.smoothing(positions) if smoothing is None else single(smoothing),
            **fields,
        )
        decoded = smooth(prepared.graph, positions, header.smoothing)
        body = prepared.with_blocks([block.packet for block in blocks])
        return Base(prepared, Draft(header, body, prepared.units.back(decoded)), np.ascontiguousarray(decoded))
