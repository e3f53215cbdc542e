"""Local frames: orthonormal whatever the surface, smooth, and inverse to what they add."""

import numpy as np

from codec.signal.frames import displaced, in_frames, local_frames
from tests.shapes import bumpy_sphere

