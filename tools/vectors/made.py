"""The vectors that can be made again; of streams to be refused those that came since version 1.0."""

from tools.vectors.bounds import BOUNDS, BOUNDS_BAD, Bad
from tools.vectors.edges import EDGES
from tools.vectors.exact import EXACT
from tools.vectors.good import STATIC, Good
from tools.vectors.good_attributes import ATTRIBUTES
from tools.vectors.good_brief import BRIEFS, BRIEFS_BAD
from tools.vectors.good_congruence import CONGRUENCE, CONGRUENCE_BAD
from tools.vectors.good_fields import FIELDS
from tools.vectors.good_light import LIGHT
from tools.vectors.good_sequences import SEQUENCES
from tools.vectors.good_turn import TURNS, TURNS_BAD
from tools.vectors.large import LARGE

GOODS: dict[str, Good] = {
    **STATIC,
    **FIELDS,
    **SEQUENCES,
    **ATTRIBUTES,
    **LIGHT,
    **EXACT,
    **EDGES,
    **BOUNDS,
    **LARGE,
    **CONGRUENCE,
    **BRIEFS,
    **TURNS,
}
BADS: dict[str, Bad] = {**BOUNDS_BAD, **CONGRUENCE_BAD, **BRIEFS_BAD, **TURNS_BAD}
