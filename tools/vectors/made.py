"""The vectors that can be made again: those of the next version. Released ones are bytes and never made again."""

from tools.vectors.good import Bad, Good
from tools.vectors.good_base import BASES, BASES_BAD

GOODS: dict[str, Good] = BASES
BADS: dict[str, Bad] = BASES_BAD
