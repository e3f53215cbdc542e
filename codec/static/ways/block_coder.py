"""One block after the other: around, dictionary, prediction, code, commit."""

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace

import numpy as np

from bsm.bitstream.container import packets
from bsm.bitstream.errors import LimitError, OptionError
from bsm.bitstream.limits import NAMED_LIMITS
from bsm.codec.arrays import Basis, Indices, Matrix
from bsm.codec.basis.laplacian import Price, Spend, free, settle
from bsm.codec.basis.orthogonal_iteration import DynamicSize
from bsm.codec.blocks.overlap import Blend, degree_weights
from bsm.codec.signal.chain import Chain, Surroundings
from bsm.codec.static.coding import Ground, Scheme
from bsm.codec.static.preamble_encoding import Prepared
from bsm.codec.static.work import (
    Allowance,
    block_cost,
    block_memory,
    chain_cost,
    ground_cost,
    mesh_cost,
    mesh_memory,
    partition_cost,
    reading_cost,
)
from bsm.codec.threads import ordered_map

FRAME = 5  # bytes of a block's frame besides its levels, at least
Progress = Callable[[int, int], None]


@dataclass(frozen=True, eq=False)
class DecodedBlock:
    """A block's own reconstruction, before it is blended with others; positions in BSM units."""

    index: int
    vertices: Indices
    positions: Matrix
    weights: Matrix


def blended(size: int, blocks: Iterable[DecodedBlock]) -> Matrix:
    """Positions of all `size` vertices, shape (size, 3), in BSM units, from all blocks."""
    blend = Blend(size)
    for block in blocks:
        blend.add(block.vertices, block.positions, block.weights)
    return blend.all_positions()


@dataclass(frozen=True, eq=False)
class CodedBlock:
    """A block as the stream will hold it, and as the decoder will see it."""

    packet: packets.Block
    decoded: DecodedBlock
    work: float
    memory: float


class ChainEncoder:
    """Encodes the blocks of one chain, in their order."""

    def __init__(self, scheme: Scheme, doi: tuple[float, float] | None = None, spend: Spend = free) -> None:
        self._scheme = scheme
        self._spend = spend
        self._sizes = None if doi is None else DynamicSize(*doi, scheme.coding.width)
        self._chain = Chain(scheme.rules, scheme.blocks.graph)
        self._coding = scheme.coding.begin()

    def encode(self, index: int, positions: Matrix) -> CodedBlock:
        """Encode the block of an index; `positions`, shape (n, 3), are those of all vertices, in BSM units."""
        scheme, chain, coding = self._scheme, self._chain, self._coding
        block = scheme.blocks.block(index)
        around = chain.around(block)
        dictionary, prices = self._priced_dictionary(around)
        ground = Ground(block, chain.continuation(around), dictionary)
        levels = coding.choose(ground, positions[block.vertices], self._sizes)
        decoded = coding.positions(ground, levels)
        work = sum(price(len(levels)) for price in prices) + self._work_of(index, around, len(levels))
        chain.commit(block, np.ascontiguousarray(dictionary[:, : len(levels)]), decoded)
        packet = packets.Block(index, len(levels), coding.write(levels))
        result = DecodedBlock(index, block.vertices, decoded, degree_weights(block.degrees))
        return CodedBlock(packet, result, work, block_memory(around.laplacian, len(levels)))

    def _priced_dictionary(self, around: Surroundings) -> tuple[Basis, list[Price]]:
        """U as wide as may pay, and the prices of its steps, which a decoder pays for the columns that are coded."""
        prices: list[Price] = []
        width = min(self._coding.width, around.laplacian.block.size)

        def pay(price: Price) -> None:
            self._spend(price(width))
            prices.append(price)

        return settle(self._chain.steps(around, width), pay), prices

    def _work_of(self, index: int, around: Surroundings, coded: int) -> float:
        """What all of a block costs a decoder but its dictionary."""
        blocks, rules = self._scheme.blocks, self._scheme.rules
        work = block_cost(around.laplacian.block.size, blocks.edges_of(index), 3 * coded)
        if index % rules.chain_length(blocks.count) == 0:
            work += chain_cost(blocks.graph.size)
        return work + ground_cost(around.laplacian, coded)


def encode_blocks(
    scheme: Scheme,
    positions: Matrix,
    *,
    threads: int | None,
    doi: tuple[float, float] | None = None,
    progress: Progress | None = None,
    spend: Spend = free,
) -> list[CodedBlock]:
    """All blocks of a mesh at `positions`, shape (n, 3), in BSM units; chains are encoded side by side."""

    def encode_chain(indices: range) -> list[CodedBlock]:
        chain = ChainEncoder(scheme, doi, spend)
        return [chain.encode(index, positions) for index in indices]

    coded: list[CodedBlock] = []
    for chain in ordered_map(encode_chain, scheme.chains, threads):
        coded.extend(chain)
        if progress:
            progress(len(coded), scheme.blocks.count)
    return coded


PATIENCE = 8.0
"""How many times longer an encoder may take over dictionaries, of wider tries, than decoders over the whole stream."""


AROUND, AROUND_BYTES = 4, 256
"""Frames around connectivity and blocks (header, labels, order, END), and about their bytes."""


def patience(limits: str, vertices: int) -> Spend:
    """Is told of the work of an encoder, and raises `LimitError` where it would come to nothing that is decoded."""
    granted = NAMED_LIMITS[limits]()
    work, per_vertex = PATIENCE * granted.work, PATIENCE * granted.work_per_vertex
    allowance = Allowance(replace(granted, work=work, work_per_vertex=per_vertex, most_work=math.inf))
    allowance.grant(vertices)
    return allowance.spend


def admit(allowance: Allowance, prepared: Prepared, blocks: Sequence[CodedBlock]) -> None:
    """Spend what a decoder of these blocks will, but for what their bytes grant."""
    vertices, faces, received = prepared.graph.size, len(prepared.mesh.faces), len(prepared.connectivity.data)
    count = prepared.blocks.count
    allowance.spend(AROUND * reading_cost(AROUND_BYTES))
    allowance.grant(vertices)
    allowance.keep(mesh_memory(vertices, faces), received)
    allowance.spend(reading_cost(received + FRAME))
    allowance.spend(mesh_cost(vertices, faces, received))
    allowance.spend(partition_cost(prepared.graph, count, count * min(prepared.size, vertices)))
    allowance.afford(max(block.memory for block in blocks))
    allowance.spend(sum(block.work + reading_cost(len(block.packet.data) + FRAME) for block in blocks))


@contextmanager
def as_of_decoders(limits: str) -> Iterator[None]:
    """Say of a limit that it is the decoder's, and what to do about it."""
    try:
        yield
    except LimitError as error:
        raise OptionError(
            f"decoders with {limits} limits would refuse this stream: {error.message.partition(';')[0]}; take smaller "
            "blocks, fewer coefficients, iterations or attributes, or a grid, or limits = "
            '"wide" if all who decode take these, too'
        ) from error
