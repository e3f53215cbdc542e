"""The vectors that can be made again: those of the next version. Released ones are bytes and never made again."""

from tools.vectors.good import Bad, Good
from tools.vectors.good_repeats import REPEATS, REPEATS_BAD
from tools.vectors.good_swift import SWIFTS, SWIFTS_BAD

GOODS: dict[str, Good] = SWIFTS | REPEATS
BADS: dict[str, Bad] = SWIFTS_BAD | REPEATS_BAD
