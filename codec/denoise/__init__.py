"""Denoising: a coarse spectral step, a hand-over, a fine step on face normals, and a mode that chooses by itself."""

from bsm.bitstream.errors import DependencyError, how_to_install

try:
    import scipy.sparse  # noqa: F401  # the one library that nothing else in `codec` needs
except ImportError:
    raise DependencyError(f"denoising needs scipy: {how_to_install('denoise')}") from None

from bsm.codec.denoise.automatic import AutomaticChoice
from bsm.codec.denoise.filters import DenoiseOptions
from bsm.codec.denoise.frames import FrameDenoiser, denoise

__all__ = ["AutomaticChoice", "DenoiseOptions", "FrameDenoiser", "denoise"]
