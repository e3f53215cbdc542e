"""A mesh to a stream: the encoder's own choices, and the steps it shares with the decoder."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from bitstream import packets
from bitstream.adaptive import CoefficientModel, encode_coefficients
from bitstream.coefficients import pack_coefficients
from bitstream.errors import OptionError
from bitstream.header import Header
from bitstream.labels import encode_labels
from bitstream.plain_faces import encode_plain_faces
from bitstream.writer import Writer
from codec.blend import Blend
from codec.blocks import Blocks, block_size, grow_blocks
from codec.chain import Chain, ChainRules
from codec.decoder import chain_rules, copy_weights
from codec.graph import Graph, graph_of_faces
from codec.mesh import TriangleMesh
from codec.metrics import Reference
from codec.options import EncodeOptions
from codec.parallel import ordered_map
from codec.partition import Partition, derive_partition, metis_partition
from codec.predict import PriorModel
from codec.quantize import dequantize, levels_to_unsigned, packed_step, quantize, smallest_step
from codec.smooth import smooth

Matrix = npt.NDArray[np.float64]
Progress = Callable[[int, int], None]

PRIOR = PriorModel(amplitude=1.0, decay=3.0, noise=1e-3)
SMOOTHING_STEPS = (0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0)


@dataclass(frozen=True, eq=False)
class CodedBlock:
    """A block as the stream will hold it, and as the decoder will see it."""

    packet: packets.Block
    vertices: npt.NDArray[np.int32]
    positions: Matrix
    weights: Matrix


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
        self.notes = (f"{dropped} vertices that no face uses were left out",) if dropped else ()
        self._connectivity = packets.Connectivity(0, encode_plain_faces(used.faces))
        self.vertex_order: npt.NDArray[np.int64] = kept
        self.face_order: npt.NDArray[np.int64] = np.arange(len(used.faces))
        self.mesh = used
        self._center, self._scale = _frame_of_reference(used)
        self._positions = (used.positions - self._center) / self._scale

    def encode(self) -> bytes:
        """The whole stream."""
        return b"".join(self.chunks())

    def chunks(self, progress: Progress | None = None) -> Iterator[bytes]:
        """The stream, frame by frame.

        Parameters
        ----------
        progress : callable, optional
            Called with the number of blocks done and of all blocks.
        """
        graph = graph_of_faces(self.mesh.faces, len(self.mesh.positions))
        partition = self._partition(graph)
        header = self._header(partition)
        blocks = grow_blocks(graph, partition, header.block_size)
        coded: list[CodedBlock] = []
        for chain in self._chains(blocks, header):
            coded.extend(chain)
            if progress:
                progress(len(coded), blocks.count)
        header = self._smoothed(header, graph, coded)
        writer = Writer()
        yield writer.start()
        yield writer.write(header)
        yield writer.write(self._connectivity)
        if self.options.partition == "metis":
            labels = encode_labels(graph.offsets, graph.neighbours, partition.labels, partition.parts)
            yield writer.write(packets.Partition(0, labels))
        for block in coded:
            yield writer.write(block.packet)
        yield writer.end()

    def _partition(self, graph: Graph) -> Partition:
        parts = max(1, round(graph.size / self.options.block_size))
        return metis_partition(graph, parts) if self.options.partition == "metis" else derive_partition(graph, parts)

    def _header(self, partition: Partition) -> Header:
        options = self.options
        size = block_size(partition, options.overlap)
        width = options.coefficients or max(1, round(options.keep * size))
        packed = options.bits is not None
        if not packed and options.step < smallest_step(size):
            raise OptionError(
                f"step = {options.step:g} is too fine for blocks of {size}, try {smallest_step(size):.1e}"
            )
        predicted = options.predict and options.seed == "previous" and not packed
        return Header(
            vertices=len(self.mesh.positions),
            faces=len(self.mesh.faces),
            blocks=partition.parts,
            block_size=size,
            coefficients=min(width, size),
            basis=("oi", "svd").index(options.basis),
            seeding=("previous", "independent").index(options.seed),
            key_interval=options.key_interval,
            power=options.power,
            iterations=options.iterations,
            key_iterations=options.key_iterations,
            shift=_single(options.shift),
            blend=("degree", "uniform", "own").index(options.blend),
            coding=0 if packed else 1,
            bits=options.bits or 12,
            step=_single(packed_step(size, options.bits) if options.bits else options.step),
            center=tuple(self._center),
            scale=self._scale,
            prediction=tuple(map(_single, PRIOR.as_floats())) if predicted else (),
        )

    def _chains(self, blocks: Blocks, header: Header) -> Iterator[list[CodedBlock]]:
        rules = chain_rules(header)
        length = rules.chain_length(blocks.count)

        def encode_chain(first: int) -> list[CodedBlock]:
            indices = range(first, min(first + length, blocks.count))
            return list(self._encode_chain(blocks, header, rules, indices))

        return ordered_map(encode_chain, rules.chain_starts(blocks.count), self.options.threads)

    def _encode_chain(self, blocks: Blocks, header: Header, rules: ChainRules, indices: range) -> Iterator[CodedBlock]:
        chain = Chain(rules, header.vertices)
        model = CoefficientModel(header.coefficients)
        for index in indices:
            block = blocks.block(index)
            subspace = chain.dictionary(block, header.coefficients)
            coefficients = subspace.T @ self._positions[block.vertices]
            prediction = chain.prediction(block, subspace)
            levels = quantize(coefficients - prediction, header.step, self._rounding(header))
            if header.coding == 0:
                payload = pack_coefficients(levels_to_unsigned(levels, header.bits), header.bits)
            else:
                width = _significant(levels)
                if width < len(levels):
                    subspace = np.ascontiguousarray(subspace[:, :width])
                    prediction = chain.prediction(block, subspace)
                    levels = quantize(coefficients[:width] - prediction, header.step, self._rounding(header))
                payload = encode_coefficients(model, levels)
            positions = chain.commit(block, subspace, prediction + dequantize(levels, header.step))
            weights = copy_weights(header, blocks, index, block)
            yield CodedBlock(packets.Block(index, len(levels), payload), block.vertices, positions, weights)

    def _rounding(self, header: Header) -> float:
        return 0.5 if header.coding == 0 else self.options.rounding

    def _smoothed(self, header: Header, graph: Graph, coded: list[CodedBlock]) -> Header:
        """The header with the amount of smoothing that the options ask for, or that brings theta lowest."""
        from dataclasses import replace

        if header.coding == 0 or self.options.smoothing == 0.0:
            return header
        if self.options.smoothing is not None:
            return replace(header, smoothing=_single(self.options.smoothing))
        blend = Blend(header.vertices)
        for block in coded:
            blend.add(block.vertices, block.positions, block.weights)
        decoded = blend.positions(np.arange(header.vertices, dtype=np.int32))
        reference = Reference(self._positions, self.mesh.faces)
        best, least = 0.0, reference.theta(decoded)
        visual = reference.nmsve(decoded)
        for amount in SMOOTHING_STEPS:
            candidate = smooth(graph, decoded, amount)
            angle = reference.theta(candidate)
            if angle >= least or reference.nmsve(candidate) > visual:
                break
            best, least = amount, angle
        return replace(header, smoothing=best)


def encode(mesh: TriangleMesh, options: EncodeOptions | None = None) -> bytes:
    """Encode a mesh to a complete stream."""
    return Encoder(mesh, options).encode()


def encode_chunks(
    mesh: TriangleMesh, options: EncodeOptions | None = None, progress: Progress | None = None
) -> Iterator[bytes]:
    """Encode a mesh frame by frame."""
    return Encoder(mesh, options).chunks(progress)


def _significant(levels: npt.NDArray[np.int32]) -> int:
    """c_i: rows up to the last one with a level that is not zero, at least one."""
    rows = np.flatnonzero(levels.any(axis=1))
    return int(rows[-1]) + 1 if len(rows) else 1


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
