"""Evaluation as data: codecs are run and written down as JSON, and everything shown is drawn from the JSON alone."""

from bsm.bitstream.errors import DependencyError

try:
    import scipy  # noqa: F401
except ImportError:
    raise DependencyError("evaluation needs scipy: pip install 'bsm-codec[eval]'") from None
