"""How a mesh is going to be coded, by the encoder's options and by what is measured on the mesh."""

import numpy as np

from bsm.bitstream.errors import OptionError
from bsm.bitstream.once import cached_property
from bsm.codec.arrays import Faces, Indices, Matrix
from bsm.codec.basis.laplacian import settle
from bsm.codec.geometry.metrics import Reference
from bsm.codec.signal.chain import AS_SPECIFIED, Chain, ChainRules, Overrides, even_interval
from bsm.codec.signal.smooth import smoothing_spectrum
from bsm.codec.signal.transform import MeasuredSpectrum, packed_range, project, smallest_step
from bsm.codec.static.coding import Adaptive, Packed
from bsm.codec.static.options import EncodeOptions
from bsm.codec.static.preamble_encoding import Prepared
from bsm.codec.static.rules import STIFFNESS, Scheme
from bsm.codec.static.units import single
from bsm.codec.static.ways.block_coder import patience
from bsm.codec.threads import ordered_map

PAPER_FRACTION = 0.10  # coefficients of a block, as a fraction of its vertices, with a fixed number of bits
SMOOTHING_FACES = 1 << 12  # on more faces than these, smoothing is not tried
SMOOTHING_STEPS = tuple(2.0**k for k in range(-3, 7))
"""Amounts that are tried, in this order, while they help; a factor of sqrt 2 between them is worth 0.1 %."""


class Planner:
    """Makes the plan for one step after another; what is measured on the mesh alone is measured once."""

    def __init__(
        self, prepared: Prepared, options: EncodeOptions, widest: float = 1.0, overrides: Overrides = AS_SPECIFIED
    ) -> None:
        self._prepared = prepared
        self._options = options
        self._widest = max(1, int(widest * prepared.size))
        self._overrides = overrides

    def scheme(self, step: float) -> Scheme:
        """How blocks are coded at a step."""
        rules, bits, size = self._rules(), self._options.paper.bits, self._prepared.size
        if bits is not None:
            return Scheme(self._prepared.blocks, rules, self._packed(bits, rules))
        if step < smallest_step(size):
            raise OptionError(f"step = {step:g} is too fine for blocks of {size}, try {smallest_step(size):.1e}")
        return Scheme(self._prepared.blocks, rules, Adaptive(self._width(step), single(step)))

    def smoothing(self, blended: Matrix) -> float:
        """The amount of smoothing that lowers what the options are after most."""
        vertices, reference = self._sample
        spectrum = smoothing_spectrum(self._prepared.graph, blended).only(vertices)
        best, least = 0.0, self._badness(reference, spectrum.smoothed(0.0))
        for amount in SMOOTHING_STEPS:
            badness = self._badness(reference, spectrum.smoothed(amount))
            if badness >= least:
                break
            best, least = amount, badness
        return best

    def _rules(self) -> ChainRules:
        paper = self._options.paper
        return ChainRules(
            exact=paper.exact_keys,
            key_interval=even_interval(self._options.key_interval, self._prepared.blocks.count),
            power=paper.power,
            iterations=paper.iterations,
            key_iterations=paper.key_iterations,
            shift=single(paper.shift),
            stiffness=STIFFNESS if paper.predict and paper.bits is None else 0.0,
            overrides=self._overrides,
        )

    def _width(self, step: float) -> int:
        """c: what the options say, or as many coefficients as are worth coding at this step."""
        options, size = self._options, self._prepared.size
        if options.coefficients is not None:
            return min(options.coefficients, size)
        if options.keep is not None:
            return min(max(1, round(options.keep * size)), size)
        return self._spectrum.worthwhile_size(step, self._widest)

    def _packed(self, bits: int, rules: ChainRules) -> Packed:
        """With the step that makes the most of a fixed number of bits: it takes a pass over all blocks."""
        blocks, positions, size = self._prepared.blocks, self._prepared.positions, self._prepared.size
        spend = patience(self._options.limits, len(positions))
        width = min(self._options.coefficients or max(1, round((self._options.keep or PAPER_FRACTION) * size)), size)

        def largest(indices: range) -> Matrix:
            """Largest coefficient in the first row of any block of a chain, and in all others."""
            chain, found = Chain(rules, blocks.graph), np.zeros(2)
            for index in indices:
                block = blocks.block(index)
                steps = chain.steps(chain.around(block), width)
                dictionary = settle(steps, lambda price: spend(price(width)))
                coefficients = np.abs(project(dictionary, positions[block.vertices], dictionary.shape[1]))
                chain.commit(block, dictionary, positions[block.vertices])
                found = np.maximum(found, [coefficients[:1].max(), coefficients[1:].max(initial=0.0)])
            return found

        chains = rules.chains(blocks.count)
        first, others = np.max(list(ordered_map(largest, chains, self._options.threads)), axis=0)
        return Packed(width, bits, *packed_range(first, others, bits))

    @property
    def _spectrum(self) -> MeasuredSpectrum:
        return self._prepared.spectrum(self._options.paper.shift)

    @cached_property
    def _sample(self) -> tuple[Indices, Reference]:
        """Vertices on which smoothing is tried, and the original there: all of them, unless they are very many."""
        positions = self._prepared.positions
        faces = _spread(self._prepared.mesh.faces, SMOOTHING_FACES)
        used = np.zeros(len(positions), np.bool_)
        used[faces] = True
        vertices = np.flatnonzero(used).astype(np.int32)
        number = np.cumsum(used) - 1
        return vertices, Reference(positions[vertices], number[faces])

    def _badness(self, reference: Reference, decoded: Matrix) -> float:
        """What smoothing shall lower: the target's own measure, or else theta and NMSVE together."""
        target = self._options.target
        if target is not None and target.kind == "theta_deg":
            return reference.theta(decoded)
        if target is not None and target.kind == "nmsve_db":
            return reference.nmsve(decoded)
        return reference.theta(decoded) * reference.nmsve(decoded)


def _spread(faces: Faces, most: int) -> Faces:
    """All faces if they are at most `most`; otherwise so many, in sixteen runs of successive ones."""
    if len(faces) <= most:
        return faces
    starts = np.linspace(0, len(faces) - most // 16, 16).astype(np.int64)
    return np.concatenate([faces[start : start + most // 16] for start in starts])
