"""What the order of a block's rows is worth to the warm start: the same iterations over rows in two orders."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt
from scipy.sparse import csr_matrix

from bsm.codec.basis.laplacian import Laplacian, laplacian_of
from bsm.codec.blocks.blend import Blend, degree_weights
from bsm.codec.blocks.overlap import Block, Blocks, block_size, grow_blocks
from bsm.codec.blocks.partition import derive_partition
from bsm.codec.geometry.graph import graph_of_faces
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.metrics import Reference
from bsm.codec.signal.chain import Chain, ChainRules
from bsm.codec.signal.predict import unheld
from bsm.codec.static.options import EncodeOptions

RowOrder = Callable[[Blocks, int], Laplacian]


def in_bisection_order(blocks: Blocks, index: int) -> Laplacian:
    """Laplacian of a block as the codec has it."""
    return laplacian_of(blocks.block(index))


def in_breadth_first_order(blocks: Blocks, index: int) -> Laplacian:
    """Laplacian of a block with its rows as growing found them: its part in mesh order, then ring after ring."""
    block = blocks.block(index)
    found = blocks.members_of(index)
    by_vertex = np.argsort(block.vertices)
    return permuted(laplacian_of(block), by_vertex[np.searchsorted(block.vertices, found, sorter=by_vertex)])


def permuted(laplacian: Laplacian, rows: npt.NDArray[np.integer]) -> Laplacian:
    """A Laplacian with its row `rows[r]` as row r."""
    block, fronts = laplacian.block, laplacian.fronts
    entries = np.ones(len(block.neighbours), np.int8)
    graph = csr_matrix((entries, block.neighbours, block.offsets), shape=(block.size, block.size))
    graph = graph[rows][:, rows]
    graph.sort_indices()
    other = Block(block.vertices[rows], graph.indptr.astype(np.int32), graph.indices.astype(np.int32))
    # The order of elimination is the same: fronts found from rows in another order than bisection's would be huge.
    places = np.argsort(rows).astype(np.uint32)
    return Laplacian(
        other,
        fronts._replace(rows=places[fronts.rows], steps=fronts.steps[rows].astype(np.uint32)),
        np.ones(len(other.neighbours)),
        laplacian.diagonal[rows],
    )


def nmsve_db_of(mesh: TriangleMesh, options: EncodeOptions, keep: float, row_order: RowOrder) -> float:
    """NMSVE in dB of projecting a mesh on its blocks' subspaces and blending, without quantization."""
    graph = graph_of_faces(mesh.faces, len(mesh.positions))
    partition = derive_partition(graph, max(1, round(graph.size / options.block_size)))
    blocks = grow_blocks(graph, partition, block_size(partition, options.overlap))
    rules = ChainRules(
        exact=options.exact_keys,
        key_interval=options.key_interval,
        power=options.power,
        iterations=options.iterations,
        key_iterations=options.key_iterations,
        shift=options.shift,
        stiffness=0.0,
    )
    chain, blend = Chain(rules, graph), Blend(graph.size)
    for index in range(blocks.count):
        laplacian = row_order(blocks, index)
        block = laplacian.block
        subspace = chain.dictionary(unheld(laplacian, options.shift), max(1, round(keep * block.size)))
        positions = subspace @ (subspace.T @ mesh.positions[block.vertices])
        chain.commit(block, subspace, positions)
        blend.add(block.vertices, positions, degree_weights(block.degrees))
    reference = Reference(mesh.positions, mesh.faces)
    return reference.compare(blend.positions(np.arange(graph.size, dtype=np.int32))).nmsve_db
