"""The vectors that can be made again, which came since version 1.0: the streams of that stay as they are."""

from tools.vectors.bounds import BOUNDS, BOUNDS_BAD, Bad
from tools.vectors.good import STATIC, Good
from tools.vectors.good_base import BASES, BASES_BAD
from tools.vectors.good_brief import BRIEFS, BRIEFS_BAD
from tools.vectors.good_congruence import CONGRUENCE, CONGRUENCE_BAD
from tools.vectors.good_sequences import SEQUENCES
from tools.vectors.good_turn import TURNS, TURNS_BAD
from tools.vectors.large import LARGE

GOODS: dict[str, Good] = {**STATIC, **SEQUENCES, **BOUNDS, **LARGE, **CONGRUENCE, **BRIEFS, **TURNS, **BASES}
BADS: dict[str, Bad] = {**BOUNDS_BAD, **CONGRUENCE_BAD, **BRIEFS_BAD, **TURNS_BAD, **BASES_BAD}
