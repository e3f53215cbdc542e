"""Denoising: a coarse spectral step, a hand-over, a fine step on face normals, and a mode that chooses by itself."""

from bitstream.errors import DependencyError

try:
    import scipy.sparse  # noqa: F401  # the one library that nothing else in `codec` needs
except ImportError:
    raise DependencyError("denoising needs scipy: pip install 'bsm-codec[denoise]'") from None

from codec.denoise.automatic import AutomaticChoice, denoise_automatically
from codec.denoise.coarse import CoarseFilter
from codec.denoise.filters.fine import FINE_STEPS
from codec.denoise.frames import FrameDenoiser, coarse_frames
from codec.denoise.handover import HAND_OVERS
from codec.denoise.options import DenoiseOptions
from codec.denoise.pipeline import denoise, denoise_frames
from codec.denoise.recipe import Recipe, Step
from codec.denoise.rehearsal import GOALS

__all__ = [
    "FINE_STEPS",
    "GOALS",
    "HAND_OVERS",
    "AutomaticChoice",
    "CoarseFilter",
    "DenoiseOptions",
    "FrameDenoiser",
    "Recipe",
    "Step",
    "coarse_frames",
    "denoise",
    "denoise_automatically",
    "denoise_frames",
]
