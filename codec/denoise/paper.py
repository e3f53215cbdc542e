"""The coarse step as the paper has it (sections 4 and 7.2): the bases of all blocks follow by orthogonal iterations.

L has no weights. METIS cuts the mesh, parts grow by 15 %, and they follow each other in one chain. The first block has
its exact basis; each other block takes iterations of R^z from the block before it.
"""

from bsm.codec.denoise.coarse import RULES
from bsm.codec.signal.chain import ChainRules

POWER = 3  # z; the paper's Table 7 has 1 to 9
ROUNDS = 1  # the t_max of Algorithm 1
SOLUTIONS = 3  # single precision takes no more of them in a row without an Onorm


def oi_rules(power: int = POWER, rounds: int = ROUNDS) -> ChainRules:
    """Return the rules of one chain by orthogonal iterations of R^z, with one Onorm after every R^z."""
    solutions = min(power, SOLUTIONS) if power > 1 else 0
    return ChainRules(
        exact=True,
        key_interval=0,
        power=power,
        iterations=rounds,
        key_iterations=RULES.key_iterations,
        shift=RULES.shift,
        springs=False,
        apart=solutions,
    )
