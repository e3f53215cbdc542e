"""Whether decoders will take what was encoded: an encoder does the sums that they do."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace

from bsm.bitstream.container.reader import reading_cost
from bsm.bitstream.errors import LimitError, OptionError
from bsm.bitstream.limits import NAMED_LIMITS
from bsm.codec.basis.cost import Spend
from bsm.codec.static.preamble_encoding import Prepared
from bsm.codec.static.ways.block_coder import FRAME, CodedBlock
from bsm.codec.static.work import Allowance, mesh_cost, mesh_memory, partition_cost

PATIENCE = 8.0
"""How many times longer an encoder may take over dictionaries than decoders may over the whole stream: what it tries is
wider than what it sends."""


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
