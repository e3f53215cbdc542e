"""What a header says about blocks, as the mathematics takes it, and back."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from bsm.bitstream.container.header import Header
from bsm.codec.arrays import Faces
from bsm.codec.blocks.overlap import Blocks
from bsm.codec.signal.chain import AS_SPECIFIED, ChainRules, Trial
from bsm.codec.static.coding import Coding, coding_of

KEY_SEEDS = ("cosines", "svd")
"""Names of the methods that a header numbers."""

STIFFNESS = 8.0
"""Of the springs on which a block hangs, in streams of this encoder; half of it costs 1.0 %, twice 1.6 %
(tools.constants)."""


@dataclass(frozen=True, eq=False)
class Scheme:
    """All that both sides know before the first block of a mesh, or of a section of one."""

    blocks: Blocks
    rules: ChainRules
    coding: Coding
    first: int = 0

    @property
    def chains(self) -> list[range]:
        """Indices of the blocks of each chain."""
        return self.rules.chains(self.blocks.count)

    def chain_of(self, number: int) -> int:
        """The chain that the block with a number belongs to."""
        return (number - self.first) // self.rules.chain_length(self.blocks.count)

    def fields(self) -> dict[str, Any]:
        """Twin of `scheme_of`: what the header has to say."""
        rules = self.rules
        return self.coding.fields | {
            "blocks": self.blocks.count,
            "key_seed": int(rules.exact),
            "key_interval": rules.key_interval,
            "power": rules.power,
            "iterations": rules.iterations,
            "key_iterations": rules.key_iterations,
            "shift": rules.shift,
            "stiffness": rules.stiffness,
        }


def scheme_of(header: Header, faces: Faces, blocks: Blocks, trial: Trial = AS_SPECIFIED, first: int = 0) -> Scheme:
    """What the header says; `faces`, shape (m, 3), as the decoder numbers them; see `Scheme`."""
    rules = replace(chain_rules(header), trial=trial)
    return Scheme(blocks, rules, coding_of(header, faces, blocks.graph.size), first)


def chain_rules(header: Header) -> ChainRules:
    """What a header says about chains and dictionaries."""
    return ChainRules(
        exact=header.key_seed == 1,
        key_interval=header.key_interval,
        power=header.power,
        iterations=header.iterations,
        key_iterations=header.key_iterations,
        shift=header.shift,
        stiffness=header.stiffness,
        whole=header.coefficients if header.gop_frames else 0,
    )
