"""A mesh to a stream: the encoder's own choices, and the steps it shares with the decoder."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from bitstream.coefficients.adaptive import MAX_LEVEL, CoefficientModel, encode_coefficients, encode_layers
from bitstream.coefficients.packed import pack_coefficients
from bitstream.coefficients.priors import detail_experience
from bitstream.coefficients.rate_distortion import TARGET_UNIT, choose_levels
from bitstream.connectivity.faces import encode_connectivity
from bitstream.connectivity.order import encode_arrangement
from bitstream.connectivity.partition import encode_labels
from bitstream.container import packets
from bitstream.container.header import Header
from bitstream.container.writer import Writer
from bitstream.errors import OptionError
from codec.basis.dynamic_size import dynamic_size
from codec.blocks.blend import Blend
from codec.blocks.overlap import Blocks, block_size, grow_blocks
from codec.blocks.partition import Partition, derive_partition, metis_partition
from codec.geometry.graph import graph_of_faces
from codec.geometry.mesh import TriangleMesh
from codec.geometry.metrics import Comparison, Reference
from codec.signal.bandwidth import MeasuredSpectrum
from codec.signal.chain import Chain, ChainRules, even_interval
from codec.signal.detail import Normals, Surface, displace, fold_details, make_surface, unfold_details
from codec.signal.predict import extend
from codec.signal.quantize import dequantize, levels_to_unsigned, packed_range, quantize_packed, smallest_step
from codec.signal.rate import BIT_WORTH, targets
from codec.signal.smooth import smooth, smoothing_spectrum
from codec.signal.transform import project, reconstruct
from codec.static.decoder import CONNECTIVITY_METHOD, ORDER_METHOD, chain_rules, copy_weights, detail_rows, half_steps
from codec.static.options import EncodeOptions
from codec.static.targets import search_step
from codec.threads import ordered_map

Matrix = npt.NDArray[np.float64]
Progress = Callable[[int, int], None]

STIFFNESS = 8.0
PAPER_FRACTION = 0.10
BASE_REACH = 4.0
"""With a detail layer, x, y and z go as far as they would pay at a step so many times that of the details."""
DETAIL_REACH = 0.9
"""Details go as far as would pay at a step so many times their own."""
SMOOTHING_FACES = 1 << 17
SMOOTHING_STEPS = tuple(2.0**k for k in range(-3, 7))


@dataclass(frozen=True, eq=False)
class CodedBlock:
    """A block as the stream will hold it, and as the decoder will see it."""

    packet: packets.Block
    vertices: npt.NDArray[np.int32]
    positions: Matrix
    weights: Matrix


@dataclass(frozen=True, eq=False)
class Attempt:
    """A whole stream, and what its decoder will make of it.

    Parameters
    ----------
    frames : tuple of bytes
        The stream, frame by frame.
    header : Header
    coefficients : tuple of int
        c_i of each block.
    comparison : Comparison
        The decoded mesh against the original.
    """

    frames: tuple[bytes, ...]
    header: Header
    coefficients: tuple[int, ...]
    comparison: Comparison

    @property
    def size(self) -> int:
        """Bytes of the whole stream."""
        return sum(map(len, self.frames))

    @property
    def vertices(self) -> int:
        """Number of vertices."""
        return self.header.vertices


class ChainEncoder:
    """Encodes the blocks of one chain, in their order; the twin of `ChainDecoder`."""

    def __init__(
        self, header: Header, rules: ChainRules, blocks: Blocks, options: EncodeOptions, surface: Surface | None = None
    ) -> None:
        self._header = header
        self._blocks = blocks
        self._options = options
        self._chain = Chain(rules, blocks.graph)
        self._model = CoefficientModel(header.coefficients)
        self._details = CoefficientModel(detail_rows(header), detail_experience()) if header.details else None
        self._normals = Normals(surface) if surface is not None else None
        self._width = header.coefficients

    def encode(self, index: int, positions: Matrix) -> CodedBlock:
        """Encode the chain's next block; `positions`, shape (n, 3), are the whole mesh's, in BSM units."""
        header, blocks, chain = self._header, self._blocks, self._chain
        block = blocks.block(index)
        around = chain.around(block)
        dictionary = chain.dictionary(block, around, max(header.coefficients, header.details))
        prediction = extend(block, around)
        residual = positions[block.vertices] - prediction
        levels = self._levels(residual, project(dictionary, residual, min(header.coefficients, block.size)))
        width = len(levels)
        decoded = prediction + reconstruct(dictionary, dequantize(half_steps(header, levels), header.step / 2))
        if header.coding == 0:
            payload = pack_coefficients(levels_to_unsigned(levels, header.bits, header.coarser), header.bits)
        elif self._details is None or self._normals is None:
            payload = encode_coefficients(self._model, levels)
        else:
            normals = self._normals.of(block, decoded)
            heights = (normals * (positions[block.vertices] - decoded)).sum(axis=1)
            rows = self._detail_rows(self._details, project(dictionary, heights, min(header.details, block.size)))
            payload = encode_layers(self._model, levels, self._details, rows)
            details = unfold_details(half_steps(header, rows), min(header.details, block.size))
            decoded = displace(decoded, normals, dictionary, dequantize(details, header.detail_step / 2))
            width = max(width, len(details))
        chain.commit(block, np.ascontiguousarray(dictionary[:, :width]), decoded)
        weights = copy_weights(header, blocks, index, block)
        return CodedBlock(packets.Block(index, len(levels), payload), block.vertices, decoded, weights)

    def magnitudes(self, index: int, positions: Matrix) -> Matrix:
        """Largest coefficient in the first row of the chain's next block, and in all others, shape (2,)."""
        block, chain = self._blocks.block(index), self._chain
        dictionary = chain.dictionary(block, chain.around(block), self._header.coefficients)
        coefficients = np.abs(project(dictionary, positions[block.vertices], dictionary.shape[1]))
        chain.commit(block, dictionary, positions[block.vertices])
        return np.array([coefficients[:1].max(), coefficients[1:].max(initial=0.0)])

    def _levels(self, residual: Matrix, coefficients: Matrix) -> npt.NDArray[np.int32]:
        """Levels of x, y and z, shape (c_i, 3): c_i as dynamic orthogonal iterations have it, or as far as they pay."""
        step = self._header.step
        if self._options.doi is not None:
            self._width = dynamic_size(residual, coefficients, self._width, *self._options.doi)
            coefficients = coefficients[: self._width]
        if self._header.coding == 0:
            return quantize_packed(coefficients, step, self._header.coarser)
        choice = choose_levels(self._model, targets(coefficients, step, TARGET_UNIT, MAX_LEVEL), BIT_WORTH)
        return choice.levels if self._options.doi is not None else choice.levels[: choice.width]

    def _detail_rows(self, model: CoefficientModel, coefficients: Matrix) -> npt.NDArray[np.int32]:
        """Levels of the detail layer, in rows of three, as far as they pay."""
        wanted = targets(coefficients, self._header.detail_step, TARGET_UNIT, MAX_LEVEL)
        choice = choose_levels(model, fold_details(wanted), BIT_WORTH)
        return choice.levels[: choice.width if choice.levels.any() else 0]


class Encoder:
    """Encodes one mesh.

    Parameters
    ----------
    mesh : TriangleMesh
        Vertices that no face uses are left out, with a note.
    options : EncodeOptions

    Attributes
    ----------
    notes : tuple of str
        What was changed on the way in.
    vertex_order : int64 array, shape (n,)
        The decoder's vertex j is vertex `vertex_order[j]` of `mesh`.
    face_order : int64 array, shape (m,)
        The decoder's face i is face `face_order[i]` of `mesh`.
    """

    def __init__(self, mesh: TriangleMesh, options: EncodeOptions | None = None) -> None:
        self.options = options or EncodeOptions()
        used, kept = mesh.without_isolated_vertices()
        dropped = len(mesh.positions) - len(kept)
        self.notes: tuple[str, ...] = (f"{dropped} vertices that no face uses were left out",) if dropped else ()
        connectivity = encode_connectivity(used.faces, len(kept))
        self._connectivity = packets.Connectivity(CONNECTIVITY_METHOD, connectivity.payload)
        self._order: packets.Order | None = None
        if self.options.keep_order:
            self._order = packets.Order(ORDER_METHOD, encode_arrangement(used.faces, connectivity))
        order = kept[connectivity.vertex_order]
        self.mesh = TriangleMesh(mesh.positions[order], connectivity.faces)
        if self._order is None:
            self.vertex_order: npt.NDArray[np.int64] = order
            self.face_order: npt.NDArray[np.int64] = connectivity.face_order.astype(np.int64)
        else:
            self.vertex_order, self.face_order = kept, np.arange(len(used.faces))
        self._center, self._scale = _frame_of_reference(self.mesh)
        self._positions = (self.mesh.positions - self._center) / self._scale
        self._graph = graph_of_faces(self.mesh.faces, len(kept))
        self._partition = self._cut(max(1, round(len(kept) / self.options.block_size)))
        self._blocks = grow_blocks(self._graph, self._partition, block_size(self._partition, self.options.overlap))
        self._reference: Reference | None = None
        self._spectrum: MeasuredSpectrum | None = None
        self._sample: tuple[npt.NDArray[np.int32], Reference] | None = None

    def encode(self) -> bytes:
        """The whole stream."""
        return b"".join(self.chunks())

    def chunks(self, progress: Progress | None = None) -> Iterator[bytes]:
        """The stream, frame by frame.

        Parameters
        ----------
        progress : callable, optional
            Called with the number of blocks done and of all blocks, once for every attempt at a target.
        """
        if self.options.target is None:
            yield from self._frames(*self._coded(self.options.step, progress))
        else:
            yield from self.search(progress).frames

    def search(self, progress: Progress | None = None) -> Attempt:
        """Look for the step that meets the options' target; `TargetError` says what can be had where none does."""
        target = self.options.target
        if target is None:
            raise OptionError("there is no target to search for")
        finest = smallest_step(self._size)
        return search_step(lambda step: self.attempt(step, progress), target, self.options.step, finest)

    def attempt(self, step: float, progress: Progress | None = None) -> Attempt:
        """Encode with a given quantization step, and see what the decoder will."""
        header, coded = self._coded(step, progress)
        decoded = smooth(self._graph, self._blended(coded), header.smoothing)
        frames = tuple(self._frames(header, coded))
        return Attempt(frames, header, tuple(b.packet.coefficients for b in coded), self._compared().compare(decoded))

    @property
    def _size(self) -> int:
        return block_size(self._partition, self.options.overlap)

    def _cut(self, parts: int) -> Partition:
        if self.options.partition == "metis":
            return metis_partition(self._graph, parts)
        return derive_partition(self._graph, parts)

    def _frames(self, header: Header, coded: list[CodedBlock]) -> Iterator[bytes]:
        writer = Writer()
        yield writer.start()
        yield writer.write(header)
        yield writer.write(self._connectivity)
        if self.options.partition == "metis":
            graph, partition = self._graph, self._partition
            labels = encode_labels(graph.offsets, graph.neighbours, partition.labels, partition.parts)
            yield writer.write(packets.Partition(0, labels))
        if self._order is not None:
            yield writer.write(self._order)
        for block in coded:
            yield writer.write(block.packet)
        yield writer.end()

    def _header(self, step: float) -> Header:
        options, size = self.options, self._size
        packed = options.bits is not None
        if not packed and step < smallest_step(size):
            raise OptionError(f"step = {step:g} is too fine for blocks of {size}, try {smallest_step(size):.1e}")
        predicted = options.predict and options.seed == "previous" and not packed
        ratio = options.detail_ratio
        return Header(
            vertices=len(self.mesh.positions),
            faces=len(self.mesh.faces),
            blocks=self._partition.parts,
            block_size=size,
            coefficients=self._subspace_size(size, BASE_REACH * step if ratio else step),
            basis=("oi", "svd").index(options.basis),
            seeding=("previous", "independent").index(options.seed),
            key_interval=even_interval(options.key_interval, self._partition.parts),
            power=options.power,
            iterations=options.iterations,
            key_iterations=options.key_iterations,
            shift=_single(options.shift),
            blend=("degree", "uniform", "own").index(options.blend),
            coding=0 if packed else 1,
            bits=options.bits or 12,
            step=_single(step * (ratio or 1.0)),
            center=tuple(self._center),
            scale=self._scale,
            prediction=(STIFFNESS,) if predicted else (),
            detail_step=_single(step) if ratio else 0.0,
            details=min(self._measured().worthwhile_size(DETAIL_REACH * step), size) if ratio else 0,
        )

    def _subspace_size(self, size: int, step: float) -> int:
        """c: what the options say, or as many coefficients as are worth coding at this step."""
        options = self.options
        if options.coefficients is not None:
            return min(options.coefficients, size)
        if options.keep is not None or options.bits is not None:
            return min(max(1, round((options.keep or PAPER_FRACTION) * size)), size)
        return min(self._measured().worthwhile_size(step), size)

    def _measured(self) -> MeasuredSpectrum:
        """The mesh's spectrum, measured when it is first needed."""
        if self._spectrum is None:
            self._spectrum = MeasuredSpectrum(self._blocks, self._positions, shift=self.options.shift)
        return self._spectrum

    def _coded(self, step: float, progress: Progress | None) -> tuple[Header, list[CodedBlock]]:
        header, blocks = self._header(step), self._blocks
        if self.options.bits is not None:
            header = self._packed(header)
        rules = chain_rules(header)
        length = rules.chain_length(blocks.count)
        surface = make_surface(self.mesh.faces, len(self._positions)) if header.details else None

        def encode_chain(first: int) -> list[CodedBlock]:
            chain = ChainEncoder(header, rules, blocks, self.options, surface)
            indices = range(first, min(first + length, blocks.count))
            return [chain.encode(index, self._positions) for index in indices]

        coded: list[CodedBlock] = []
        for chain in ordered_map(encode_chain, rules.chain_starts(blocks.count), self.options.threads):
            coded.extend(chain)
            if progress:
                progress(len(coded), blocks.count)
        header = replace(header, coefficients=max(block.packet.coefficients for block in coded))
        return replace(header, smoothing=self._smoothing(header, coded)), coded

    def _packed(self, header: Header) -> Header:
        """The header with the step that makes the most of a fixed number of bits: it takes a pass over all blocks."""
        rules, blocks = chain_rules(header), self._blocks
        length = rules.chain_length(blocks.count)

        def largest(start: int) -> Matrix:
            chain = ChainEncoder(header, rules, blocks, self.options)
            indices = range(start, min(start + length, blocks.count))
            return np.max([chain.magnitudes(index, self._positions) for index in indices], axis=0)

        starts = rules.chain_starts(blocks.count)
        first, others = np.max(list(ordered_map(largest, starts, self.options.threads)), axis=0)
        step, coarser = packed_range(first, others, header.bits)
        return replace(header, step=step, coarser=coarser)

    def _blended(self, coded: list[CodedBlock]) -> Matrix:
        blend = Blend(len(self._positions))
        for block in coded:
            blend.add(block.vertices, block.positions, block.weights)
        return blend.positions(np.arange(len(self._positions), dtype=np.int32))

    def _compared(self) -> Reference:
        """The original, in BSM units, prepared for comparing."""
        if self._reference is None:
            self._reference = Reference(self._positions, self.mesh.faces)
        return self._reference

    def _sampled(self) -> tuple[npt.NDArray[np.int32], Reference]:
        """Vertices on which smoothing is tried, and the original there: all of them, unless they are very many."""
        if self._sample is None:
            faces = _spread(self.mesh.faces, SMOOTHING_FACES)
            used = np.zeros(len(self._positions), np.bool_)
            used[faces] = True
            vertices = np.flatnonzero(used).astype(np.int32)
            number = np.cumsum(used) - 1
            self._sample = vertices, Reference(self._positions[vertices], number[faces])
        return self._sample

    def _smoothing(self, header: Header, coded: list[CodedBlock]) -> float:
        """The amount of smoothing that the options ask for, or the best by what they are after."""
        if header.coding == 0 or self.options.smoothing is not None:
            return _single(self.options.smoothing or 0.0)
        vertices, reference = self._sampled()
        spectrum = smoothing_spectrum(self._graph, self._blended(coded)).only(vertices)
        best, least = 0.0, self._badness(reference, spectrum.smoothed(0.0))
        for amount in SMOOTHING_STEPS:
            badness = self._badness(reference, spectrum.smoothed(amount))
            if badness >= least:
                break
            best, least = amount, badness
        return best

    def _badness(self, reference: Reference, decoded: Matrix) -> float:
        """What smoothing shall lower: the target's own measure, or else theta and NMSVE together."""
        target = self.options.target
        if target is not None and target.kind == "theta_deg":
            return reference.theta(decoded)
        if target is not None and target.kind == "nmsve_db":
            return reference.nmsve(decoded)
        return reference.theta(decoded) * reference.nmsve(decoded)


def _spread(faces: npt.NDArray[np.int32], most: int) -> npt.NDArray[np.int32]:
    """All faces if they are at most `most`; otherwise so many, in sixteen runs of successive ones."""
    if len(faces) <= most:
        return faces
    starts = np.linspace(0, len(faces) - most // 16, 16).astype(np.int64)
    return np.concatenate([faces[start : start + most // 16] for start in starts])


def encode(mesh: TriangleMesh, options: EncodeOptions | None = None) -> bytes:
    """Encode a mesh to a complete stream."""
    return Encoder(mesh, options).encode()


def encode_chunks(
    mesh: TriangleMesh, options: EncodeOptions | None = None, progress: Progress | None = None
) -> Iterator[bytes]:
    """Encode a mesh frame by frame."""
    return Encoder(mesh, options).chunks(progress)


def _single(value: float) -> float:
    return float(np.float32(value))


def _frame_of_reference(mesh: TriangleMesh) -> tuple[Matrix, float]:
    """Centre and diagonal of the bounding box, in single precision where that is exact enough."""
    low, high = mesh.positions.min(axis=0), mesh.positions.max(axis=0)
    center, diagonal = low / 2 + high / 2, mesh.diagonal
    if not diagonal > 0.0:
        return center, 1.0
    with np.errstate(over="ignore"):
        coarse = center.astype(np.float32).astype(np.float64)
        # Rounded up, so that positions stay within half a unit of the centre.
        scale = float(np.nextafter(np.float32(diagonal * (1 + 4e-6)), np.float32(np.inf)))
    if np.abs(coarse - center).max() < 1e-6 * diagonal:
        center = coarse
    return center, scale if 1e-30 < scale < np.inf else diagonal
