"""What a header says about blocks, as the mathematics takes it, and back."""

from dataclasses import dataclass, replace
from typing import Any

from bsm.bitstream.container.header import LAW, LAW_OF_SEQUENCES, Header, Paper
from bsm.codec.blocks.overlap import Blocks
from bsm.codec.signal.chain import AS_SPECIFIED, ChainRules, Overrides
from bsm.codec.static.coding import Coding, coding_of

KEY_SEEDS = ("cosines", "svd")  # where a block without predecessor begins

STIFFNESS = 8.0  # of the springs on which a block hangs, a constant of the law; half of it costs 1.0 %, twice 1.6 %


@dataclass(frozen=True, eq=False)
class Scheme:
    """All that both sides know before the first block of a mesh."""

    blocks: Blocks
    rules: ChainRules
    coding: Coding

    @property
    def chains(self) -> list[range]:
        """Indices of the blocks of each chain."""
        return self.rules.chains(self.blocks.count)

    def chain_of(self, index: int) -> int:
        """The number of the chain that a block belongs to."""
        return index // self.rules.chain_length(self.blocks.count)

    def fields(self) -> dict[str, Any]:
        """Twin of `scheme_of`: what the header has to say."""
        rules, coding = self.rules, self.coding
        paper = Paper(
            bits=coding.bits,
            coarser=coding.coarser,
            exact=int(rules.exact),
            power=rules.power,
            iterations=rules.iterations,
            key_iterations=rules.key_iterations,
            shift=rules.shift,
            springs=int(rules.stiffness > 0.0),
        )
        return {
            "blocks": self.blocks.count,
            "step": coding.step,
            "key_interval": rules.key_interval,
            "paper": paper.entry(LAW_OF_SEQUENCES if rules.whole else LAW),
        }


def scheme_of(header: Header, blocks: Blocks, overrides: Overrides = AS_SPECIFIED) -> Scheme:
    """What the header says."""
    return Scheme(blocks, replace(chain_rules(header), overrides=overrides), coding_of(header))


def chain_rules(header: Header) -> ChainRules:
    """What a header says about chains and dictionaries."""
    whole = header.coefficients if header.gop_frames else 0
    return rules_of(header.constants, header.key_interval, whole)


def rules_of(paper: Paper, key_interval: int = 0, whole: int = 0) -> ChainRules:
    """Chains and dictionaries by some constants."""
    return ChainRules(
        exact=bool(paper.exact),
        key_interval=key_interval,
        power=paper.power,
        iterations=paper.iterations,
        key_iterations=paper.key_iterations,
        shift=paper.shift,
        stiffness=STIFFNESS if paper.springs else 0.0,
        whole=whole,
    )
