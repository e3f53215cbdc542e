"""The graph, blocks and chain of a mesh, for tests of what works on them."""

from dataclasses import replace
from typing import Any

from bsm import TriangleMesh
from bsm.bitstream.container.header import LAW
from bsm.codec.blocks.overlap import Blocks, derive_partition, grow_blocks
from bsm.codec.geometry.graph import Graph, graph_of_faces
from bsm.codec.signal.chain import Chain
from bsm.codec.static.coding import rules_of


def graph_of(mesh: TriangleMesh) -> Graph:
    return graph_of_faces(mesh.faces, len(mesh.positions))


def blocks_of(mesh: TriangleMesh, parts: int = 1, size: int | None = None) -> Blocks:
    """Cut a mesh by BSM's own rule; a block has all vertices if its size is not named."""
    graph = graph_of(mesh)
    return grow_blocks(graph, derive_partition(graph, parts), size or graph.size)


def chain_of(blocks: Blocks, width: int = 0, **rules: Any) -> Chain:
    """Begin a chain by the rules of version 1.0, but for those named here."""
    return Chain(replace(rules_of(LAW), **rules), blocks, width)
