"""Blocks, coded at a step as the options say, and a layer of levels on them."""

from dataclasses import dataclass, field, replace
from functools import lru_cache

import numpy as np

from bsm.bitstream.container.header import Header, Layer
from bsm.bitstream.errors import LimitError, OptionError
from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Levels, Matrix, end_phase
from bsm.codec.geometry.mesh import squares_of
from bsm.codec.geometry.metrics import mean_edge_length
from bsm.codec.progress import Progress
from bsm.codec.signal.chain import AS_SPECIFIED, Chain, ChainRules, Overrides, even_interval
from bsm.codec.signal.smooth import in_frames, local_frames, raised, slide, smooth, tangent_steps
from bsm.codec.signal.transform import packed_range, smallest_step
from bsm.codec.static.coding import Adaptive, Packed, Scheme
from bsm.codec.static.options import EncodeOptions
from bsm.codec.static.preamble_encoding import Draft, Prepared
from bsm.codec.static.units import single
from bsm.codec.static.ways.block_coder import Sizing, admit, blended, encode_blocks, offer, patience
from bsm.codec.static.ways.grid import encode_layer
from bsm.codec.threads import ordered_map

# Coefficients of a block, as a fraction of its vertices, with a fixed number of bits.
PAPER_FRACTION = 0.10
# Each solution damps high frequencies further, until the last columns are rounding errors of the first.
MOST_APART = 3
"""Solutions before an Onorm in the paper's mode: more leave little of late columns in single precision."""
SMOOTHING_STEPS = tuple(2.0**k if k > -4 else 0.0 for k in range(-4, 7))
"""Amounts to try, from the middle up and down while they help; a factor of sqrt 2 between them is worth 0.1 %."""


@dataclass(frozen=True, eq=False)
class RefinementBase:
    """Blocks, coded."""

    prepared: Prepared
    draft: Draft
    positions: Matrix
    coded: int  # bytes of the blocks, and of levels of cells
    _last: list[tuple[Layer, Levels, Matrix]] = field(default_factory=list, init=False, repr=False)
    """The last known steps, and the layer and heights that they follow from."""

    @cached_property
    def frames(self) -> Matrix:
        """The frames that levels are in, shape (n, 9)."""
        return local_frames(self.positions, self.prepared.mesh.faces)

    @cached_property
    def offsets(self) -> Matrix:
        """The remaining error in these frames: along normals and tangents, shape (n, 3)."""
        # Not the frames that are kept: a search drops most bases after a look at these.
        frames = local_frames(self.positions, self.prepared.mesh.faces)
        return in_frames(self.prepared.positions - self.positions, frames)

    def expected_steps(self, layer: Layer) -> Matrix:
        """About what levels of a layer move each vertex, shape (n, 3), before any is chosen."""
        # Steps along tangents depend on decoded heights, which are not chosen yet. The original's are near enough to
        # begin with.
        return self._steps(self.prepared.positions, layer)

    def _steps(self, upright: Matrix, layer: Layer) -> Matrix:
        aside = tangent_steps(upright, self.prepared.mesh.faces, layer.step, layer.ratio)
        heights = np.full(len(aside), layer.step)
        return np.column_stack([heights, aside, aside])

    def about(self, layer: Layer) -> float:
        """About the bytes of blocks, cells and levels of a layer, by the sizes of levels."""
        doubled_levels = 2.0 * self.offsets / self.expected_steps(layer)
        bits = float(np.log2(1.0 + doubled_levels**2).sum())
        return self.coded + bits / 16.0

    def known_steps(self, layer: Layer, levels: Levels) -> Matrix:
        """What levels of a layer move each vertex, shape (n, 3), if its heights are those of `levels`, shape (n, 3)."""
        heights = levels[:, :1]
        # A search asks for the same heights several times in a row.
        if self._last:
            last_layer, last_heights, last_steps = self._last[0]
            if layer == last_layer and np.array_equal(heights, last_heights):
                return last_steps
        upright = raised(self.positions, self.frames, heights, layer.step)
        steps = self._steps(upright, layer)
        self._last[:] = [(layer, heights.copy(), steps)]
        return steps

    def directions(self, steps: Matrix) -> Matrix:
        """What one level along each axis moves, for steps of shape (n, 3); shape (n, 3, 3)."""
        return self.frames.reshape(-1, 3, 3) * steps[:, :, None]

    def best_levels(self, steps: Matrix) -> tuple[Levels, Matrix]:
        """The nearest levels to steps, both of shape (n, 3), and what one of each moves, shape (n, 3, 3)."""
        return np.rint(self.offsets / steps).astype(np.int32), self.directions(steps)

    def within(self, reaches: Matrix, layer: Layer, levels: Levels) -> tuple[Levels, Matrix]:
        """These levels, but the nearest ones where a vertex is farther off than it may be; and their known steps."""
        steps = self.known_steps(layer, levels)
        levels = levels.copy()
        # It settles after two or three rounds. If ever it did not, the caller would measure what is left.
        for _ in range(9):  # heights that are mended change steps of others
            error = levels * steps - self.offsets
            far = squares_of(error) > reaches**2
            if not far.any():
                break
            levels[far] = np.rint(self.offsets[far] / steps[far])
            steps = self.known_steps(layer, levels)
        return levels, steps

    def moved(self, layer: Layer, levels: Levels, steps: Matrix) -> Matrix:
        """Where levels bring the base by their known steps, all of shape (n, 3), in BSM units."""
        moved = raised(self.positions, self.frames, levels, layer.step)
        slide(moved, self.frames, levels, steps[:, 1])
        return moved


def refine_blocks(
    prepared: Prepared, blocks: Draft, layer: Layer, levels: Levels, moved: Matrix
) -> Draft:
    """Return the stream of blocks with a layer of levels, shape (n, 3), which bring vertices to where they `moved`."""
    end_phase(len(moved))  # the choice of levels has taken many arrays
    header = replace(blocks.header, refinement=(layer.step, layer.ratio))
    after = 0
    if blocks.header.base:
        after, *_ = blocks.header.base
    # After all blocks: a decoder may stop there, and show the base.
    body = (*blocks.body, *encode_layer(prepared.mesh.faces, levels, after))
    return Draft(header, body, prepared.units.back(moved))


class InBlocks:
    """Codes a mesh in blocks, at one step after another; what depends only on the mesh is measured once."""

    def __init__(
        self,
        prepared: Prepared,
        options: EncodeOptions,
        widest: float = 1.0,
        overrides: Overrides = AS_SPECIFIED,
    ) -> None:
        self._prepared = prepared
        self._options = options
        # Searches try fewer columns where most would be zero: wide dictionaries take most of the time.
        self._widest = max(1, int(widest * prepared.size))
        self.missed = 0  # blocks over eps_h
        self._overrides = overrides

    def base(self, step: float, progress: Progress | None = None) -> RefinementBase:
        """The blocks at a step, or with a fixed number of bits at an eps_h in BSM units; c is as decoders grant it."""
        while True:
            try:
                return self._base(step, progress)
            except LimitError:
                # Only where the error decides is the number of columns free. A number that the user fixed is not
                # changed in silence.
                if self._options.paper.doi is None or self._widest == 1:
                    raise
                self._widest = 2 * self._widest // 3

    def _base(self, step: float, progress: Progress | None) -> RefinementBase:
        prepared = self._prepared
        options = self._options
        scheme = self._scheme(step)
        blocks = encode_blocks(
            scheme,
            prepared.positions,
            threads=options.threads,
            sizing=self._sizing(scheme.coding.width, step),
            progress=progress,
            charge=patience(options.limits, prepared.graph.size),
        )
        admit(options.limits, prepared, blocks)
        self.missed = sum(not block.met for block in blocks)
        positions = blended(prepared.graph.size, (block.decoded for block in blocks))
        smoothing = options.fixed_smoothing
        # The filter is chosen after coding, on what was decoded, since it is to undo what coding did.
        if smoothing is None:
            smoothing = self._smoothing(positions)
        else:
            smoothing = single(smoothing)
        header = Header(
            block_size=prepared.size,
            coefficients=max(block.packet.coefficients for block in blocks),
            center=prepared.units.center,
            scale=prepared.units.scale,
            smoothing=smoothing,
            **prepared.fields,
            **scheme.fields(),
        )
        decoded = smooth(prepared.graph, positions, header.smoothing)
        body = (*prepared.before_blocks, *(block.packet for block in blocks))
        draft = Draft(header, body, prepared.units.back(decoded))
        coded = sum(len(block.packet.data) for block in blocks)
        return RefinementBase(prepared, draft, np.ascontiguousarray(decoded), coded)

    def _scheme(self, step: float) -> Scheme:
        """How blocks are coded at a step."""
        rules = self._rules()
        bits = self._options.paper.bits
        size = self._prepared.size
        if bits is not None:
            return Scheme(self._prepared.blocks, rules, self._packed(bits, rules, step))
        # Finer levels would not fit into the integers of the law.
        if step < smallest_step(size):
            raise OptionError(
                f"step = {step:g} is too fine for blocks of {size}, try {smallest_step(size):.1e}"
            )
        return Scheme(self._prepared.blocks, rules, Adaptive(self._width(step), single(step)))

    def _smoothing(self, blended: Matrix) -> float:
        """The amount of smoothing that lowers the error of the options most."""
        graph = self._prepared.graph

        # Uphill and downhill from the middle, the same amounts may be met twice.
        @lru_cache(None)
        def badness(place: int) -> float:
            return self._badness(smooth(graph, blended, SMOOTHING_STEPS[place]))

        places = range(len(SMOOTHING_STEPS))
        place = len(SMOOTHING_STEPS) // 2
        for aside in (1, -1):
            while place + aside in places and badness(place + aside) < badness(place):
                place += aside
        return SMOOTHING_STEPS[place]

    def _rules(self) -> ChainRules:
        paper = self._options.paper
        apart = 0
        if paper.bits is not None and paper.power > 1:
            apart = min(paper.power, MOST_APART)
        return ChainRules(
            exact=paper.exact_keys,
            key_interval=even_interval(self._options.key_interval, self._prepared.blocks.count),
            power=paper.power,
            iterations=paper.iterations,
            key_iterations=paper.key_iterations,
            shift=single(paper.shift),
            # The paper's mode codes positions and not differences, so nothing is predicted there.
            springs=paper.predict and paper.bits is None,
            apart=apart,
            overrides=self._overrides,
        )

    def _width(self, step: float) -> int:
        """c: the option's value, or as many coefficients as are worth coding at this step."""
        options = self._options
        size = self._prepared.size
        most = size
        if options.paper.doi is not None:
            most = self._widest
        if options.coefficients is not None:
            return min(options.coefficients, most)
        if options.keep is not None:
            return min(max(1, round(options.keep * size)), most)
        if options.paper.doi is not None:
            return most
        # A fixed number of bits wastes them on small coefficients, so more columns do not pay as they do with entropy
        # coding.
        if options.paper.bits is not None:
            return max(1, round(PAPER_FRACTION * size))
        return self._prepared.spectrum(options.paper.shift).worthwhile_size(step, self._widest)

    @cached_property
    def _eps(self) -> tuple[float, float] | None:
        """eps_l and eps_h in BSM units."""
        doi = self._options.paper.doi
        if not doi:
            return None
        edge = mean_edge_length(self._prepared.positions, self._prepared.mesh.faces)
        return edge * doi[0], edge * doi[1]

    @property
    def first_step(self) -> float:
        """The step, or eps_h, that a search begins with."""
        if self._eps and self._options.paper.bits:
            _, high = self._eps
            return high
        return self._options.first_step

    def _sizing(self, width: int, step: float) -> Sizing:
        eps = self._eps
        if eps and self._options.paper.bits:
            low, high = eps
            eps = step * low / high, step
        first = max(1, round(PAPER_FRACTION * self._prepared.size))
        return Sizing(width, min(width, first), eps)

    def _packed(self, bits: int, rules: ChainRules, step: float) -> Packed:
        """With the step that makes the most of a fixed number of bits: it takes a pass over all blocks."""
        blocks = self._prepared.blocks
        positions = self._prepared.positions
        width = self._width(0.0)
        charge = patience(self._options.limits, len(positions))
        sizing = self._sizing(width, step)

        def largest(indices: range) -> Matrix:
            """Largest coefficient in the first row of any block of a chain, and in all others."""
            chain = Chain(rules, blocks)
            sizes = sizing.begin()
            largest_yet = np.zeros(2)
            for index in indices:
                vertices, _, _ = chain.begin(index)
                block_positions = positions[vertices]
                dictionary, coefficients = offer(chain, block_positions, width, sizes, charge)
                chain.commit(dictionary.shape[1], block_positions)
                magnitudes = np.abs(coefficients)
                first = magnitudes[:1].max()
                others = magnitudes[1:].max(initial=0.0)
                largest_yet = np.maximum(largest_yet, [first, others])
            return largest_yet

        chains = rules.chains(blocks.count)
        # The largest coefficients of all blocks decide the step, so all blocks are transformed twice.
        all_largest = list(ordered_map(largest, chains, self._options.threads))
        first, others = np.max(all_largest, axis=0)
        return Packed(width, bits, *packed_range(first, others, bits))

    def _badness(self, decoded: Matrix) -> float:
        """What smoothing shall lower: the target's own measure, or else theta and NMSVE together."""
        target = self._options.target
        reference = self._prepared.reference
        if target is not None and target.kind == "theta_deg":
            return reference.theta(decoded)
        if target is not None and target.kind == "nmsve_db":
            return reference.nmsve(decoded)
        # Of both at once: theta alone would smooth away shape, and NMSVE alone would leave grain.
        return reference.theta(decoded) * reference.nmsve(decoded)
