"""All vectors, and how each is made."""

from tools.vectors.bad import BAD, Bad
from tools.vectors.bad_attributes import BAD_ATTRIBUTES
from tools.vectors.bad_fields import BAD_FIELDS
from tools.vectors.bad_light import BAD_LIGHT
from tools.vectors.bad_sequences import BAD_SEQUENCES
from tools.vectors.bounds import BOUNDS, BOUNDS_BAD
from tools.vectors.edges import EDGES, EDGES_BAD
from tools.vectors.exact import BAD_EXACT, EXACT
from tools.vectors.good import STATIC, Good
from tools.vectors.good_attributes import ATTRIBUTES
from tools.vectors.good_fields import FIELDS
from tools.vectors.good_light import LIGHT
from tools.vectors.good_sequences import SEQUENCES
from tools.vectors.large import LARGE

GOODS: dict[str, Good] = {**STATIC, **FIELDS, **SEQUENCES, **ATTRIBUTES, **LIGHT, **EXACT, **EDGES, **BOUNDS, **LARGE}
BADS: dict[str, Bad] = {**BAD, **BAD_FIELDS, **BAD_SEQUENCES, **BAD_ATTRIBUTES, **BAD_LIGHT, **BAD_EXACT}
BADS |= EDGES_BAD | BOUNDS_BAD
