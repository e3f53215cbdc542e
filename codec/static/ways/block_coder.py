"""One block after the other: around, dictionary, prediction, code, commit."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from copy import copy
from dataclasses import dataclass
from threading import Lock
from typing import TypeAlias

import numpy as np

from bsm.bitstream.container import packets
from bsm.bitstream.errors import LimitError, OptionError
from bsm.bitstream.limits import NAMED_LIMITS, Limits
from bsm.codec.arrays import Basis, Indices, Matrix
from bsm.codec.basis.orthogonal_iteration import DynamicSize
from bsm.codec.blocks.overlap import Blend
from bsm.codec.progress import Progress
from bsm.codec.signal.chain import Chain
from bsm.codec.signal.transform import project, reconstruct
from bsm.codec.static.coding import Scheme
from bsm.codec.static.preamble_encoding import Prepared
from bsm.codec.threads import ordered_map

# Needed where a search adds up what blocks would cost, without making their frames.
FRAME = 5  # bytes of a block's frame besides its levels, at least
Charge = Callable[[float], None]
"""Takes the work in nanoseconds before it is done, and may refuse it by raising `LimitError`."""


DecodedBlock: TypeAlias = tuple[Indices, Matrix, Matrix]
"""A block's own reconstruction: vertices, their positions in BSM units, and their weights in a blend."""


def blended(size: int, blocks: Iterable[DecodedBlock]) -> Matrix:
    """Positions of all `size` vertices, shape (size, 3), in BSM units, from all blocks."""
    blend = Blend(size)
    for block in blocks:
        blend.add(*block)
    return blend.all_positions()


@dataclass(frozen=True, eq=False)
class CodedBlock:
    """A block as the stream will hold it, and as the decoder will see it."""

    packet: packets.Coefficients
    decoded: DecodedBlock
    work: float
    memory: float
    met: bool  # eps_h, if there is one


@dataclass(frozen=True)
class Sizing:
    """c of each block: `most`, or as dynamic orthogonal iterations find it from `first` on, up to `most`."""

    most: int
    first: int = 0
    doi: tuple[float, float] | None = None

    def begin(self) -> DynamicSize | None:
        return None if self.doi is None else DynamicSize(*self.doi, self.first)


def offer(
    chain: Chain, residual: Matrix, most: int, sizes: DynamicSize | None, charge: Charge | None
) -> tuple[Basis, Matrix]:
    """U of a block with c_i columns, and its coefficients of a residual; no column depends on how many are tried."""
    most = min(most, len(residual))

    def made(width: int) -> Basis:
        if charge is not None:
            # Before the work is done: a chain of wide blocks could take hours that end with a refusal.
            charge(chain.costs(width)[0])
        return chain.dictionary(width)

    if sizes is None:
        dictionary = made(most)
        return dictionary, project(dictionary, residual, most)
    first = sizes.reach
    if chain.is_exact:  # it is dear, so that a rough one tells how many columns to try
        first = (
            chain.held
            or len(_fitting(chain.rough, residual, most, copy(sizes), first)[1]) * 9 // 8 + 8
        )
    return _fitting(made, residual, most, sizes, first)


def _fitting(
    made: Callable[[int], Basis], residual: Matrix, most: int, sizes: DynamicSize, tried: int
) -> tuple[Basis, Matrix]:
    """As many columns of U, and coefficients, as the error asks for; `tried` at first."""
    while True:
        tried = min(tried, most)
        dictionary = made(tried)
        coefficients = project(dictionary, residual, tried)
        # What the tried columns leave is known exactly; the coefficients then tell it for every smaller number of them.
        left = float(np.square(residual - reconstruct(dictionary, coefficients)).mean())
        size = sizes.follow(3.0 * left, coefficients / len(residual) ** 0.5)
        if sizes.met or tried == most:
            # The next block begins from these columns only, as it will in a decoder.
            return np.ascontiguousarray(dictionary[:, :size]), coefficients[:size]
        # Doubling: at most twice the work of the right number, wherever that is.
        tried *= 2


class ChainEncoder:
    """Encodes the blocks of one chain, in their order."""

    def __init__(self, scheme: Scheme, sizing: Sizing, charge: Charge | None = None) -> None:
        self._charge = charge
        self._most = sizing.most
        self._sizes = sizing.begin()
        self._chain = Chain(scheme.rules, scheme.blocks, scheme.coding.width)
        self._coding = scheme.coding

    def encode(self, index: int, positions: Matrix) -> CodedBlock:
        """Encode the block of an index; `positions`, shape (n, 3), are those of all vertices, in BSM units."""
        chain = self._chain
        vertices, prediction, weights = chain.begin(index)
        residual = positions[vertices] - prediction
        dictionary, coefficients = offer(chain, residual, self._most, self._sizes, self._charge)
        sized = self._sizes is not None
        coded, payload, decoded = self._coding.write(
            chain, prediction, dictionary, coefficients, sized
        )
        *work, memory = chain.costs(coded)
        # With decoded positions, never with the original ones: the next block is predicted from what decoders have.
        chain.commit(coded, decoded)
        packet = packets.Coefficients(index, coded, payload)
        # A block may miss its error even with all columns. The stream is still good, and the caller may want to know.
        met = self._sizes is None or self._sizes.met
        return CodedBlock(packet, (vertices, decoded, weights), sum(work), memory, met)


def encode_blocks(
    scheme: Scheme,
    positions: Matrix,
    *,
    threads: int | None,
    sizing: Sizing,
    progress: Progress | None = None,
    charge: Charge | None = None,
) -> list[CodedBlock]:
    """All blocks of a mesh at `positions`, shape (n, 3), in BSM units; chains are encoded side by side."""

    def encode_chain(indices: range) -> list[CodedBlock]:
        chain = ChainEncoder(scheme, sizing, charge)
        return [chain.encode(index, positions) for index in indices]

    coded: list[CodedBlock] = []
    # In order, so that the stream does not depend on which thread was faster.
    for chain in ordered_map(encode_chain, scheme.chains, threads):
        coded.extend(chain)
        if progress:
            progress(len(coded), scheme.blocks.count)
    return coded


# Encoders try wider dictionaries than they keep. Beyond this factor something is wrong with the options.
PATIENCE = 8.0
"""How many times longer an encoder may take over dictionaries, of wider tries, than decoders over the whole stream."""


def patience(limits: str, vertices: int) -> Charge:
    """Adds up the work of an encoder, and raises `LimitError` where it would come to nothing that is decoded."""
    granted = NAMED_LIMITS[limits]()
    spent = 0.0
    lock = Lock()
    most = Limits(work=PATIENCE * granted.work, work_per_vertex=PATIENCE * granted.work_per_vertex)

    def charge(work: float) -> None:
        nonlocal spent
        # Chains are encoded side by side and share one account.
        with lock:
            spent += work
            most.check_work(spent, vertices)

    return charge


def mesh_memory(vertices: int, faces: int) -> float:
    """Bytes that decoders take for a mesh, by their estimate."""
    return 200.0 * vertices + 60.0 * faces


def admit(limits: str, prepared: Prepared, blocks: Sequence[CodedBlock]) -> None:
    """Raise `LimitError` for blocks that decoders would refuse, as far as that is known without decoding them."""
    granted = NAMED_LIMITS[limits]()
    vertices = prepared.graph.size
    faces = len(prepared.mesh.faces)
    # Blocks are decoded one after the other in a chain, so the largest counts, and not the sum.
    memory = mesh_memory(vertices, faces) + max(block.memory for block in blocks)
    granted.check_memory(memory, vertices, len(prepared.connectivity.data))
    work = sum(block.work for block in blocks)
    granted.check("most_work", work)
    granted.check_work(work, vertices)


@contextmanager
def as_of_decoders(limits: str) -> Iterator[None]:
    """Say of a limit that it is the decoder's, and what to do about it."""
    try:
        yield
    except LimitError as error:
        # An error of options: the user chose them, and can choose others. A plain LimitError would read as if the input
        # were too large.
        raise OptionError(
            f"decoders with {limits} limits would refuse this stream: {error.message.partition(';')[0]}; take smaller "
            "blocks, fewer coefficients, iterations or attributes, or a grid, or, if all who decode take these, too, "
            'limits = "wide" (in a shell --set limits=wide, then decode --limits wide)'
        ) from error
