"""Evaluation as data: codecs are run and written down as JSON, and everything shown is drawn from the JSON alone."""

from bsm.bitstream.errors import DependencyError
from bsm.bitstream.extras import how_to_install

try:
    import scipy  # noqa: F401
except ImportError:
    raise DependencyError(f"evaluation needs scipy: {how_to_install('eval')}") from None
