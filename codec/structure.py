"""Everything that both sides derive from the decoded faces and a few numbers of the header, before any coefficient."""

from __future__ import annotations

from bitstream.limits import Limits
from codec.blocks import Blocks, grow_blocks
from codec.graph import Graph
from codec.partition import Partition


def dictionary_work(blocks: int, block_size: int, coefficients: int, solves: int) -> float:
    """Floating point operations for all dictionaries, about: what `Limits.work` bounds.

    Parameters
    ----------
    blocks, block_size, coefficients
        k, n_d and c.
    solves : int
        Orthogonal iterations times power, of a key block.
    """
    per_iteration = 8.0 * block_size * coefficients**2
    return blocks * (block_size * 200.0 + solves * (40.0 * block_size * coefficients + per_iteration))


def check_work(limits: Limits, blocks: int, block_size: int, coefficients: int, solves: int, exact: bool) -> None:
    """Raise `LimitError` if a header asks for more blocks, larger ones or more work than `limits` grant."""
    limits.check("blocks", blocks)
    limits.check("block_size", block_size)
    limits.check("coefficients", coefficients)
    work = 30.0 * blocks * block_size**3 if exact else dictionary_work(blocks, block_size, coefficients, solves)
    limits.check("work", work)


def build_blocks(graph: Graph, partition: Partition, size: int) -> Blocks:
    """Blocks of a partition, grown to n_d = `size`."""
    return grow_blocks(graph, partition, size)
