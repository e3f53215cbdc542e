"""Evaluation as data: codecs are run and written down as JSON, and everything shown is drawn from the JSON alone."""

from bsm.bitstream.errors import imported

imported("scipy", "evaluation needs scipy", "eval")
