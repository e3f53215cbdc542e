"""Grey pictures as PNG files."""

from __future__ import annotations

import io

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import DependencyError
from bsm.bitstream.extras import how_to_install

Picture = npt.NDArray[np.float32]
_LOUDER = 4.0
"""How much larger a difference is drawn than it is."""


def side_by_side(first: Picture, second: Picture) -> Picture:
    """Two pictures and, from white to black, four times their difference."""
    return np.hstack([first, second, 1.0 - np.minimum(_LOUDER * np.abs(first - second), 1.0)])


def png(picture: Picture) -> bytes:
    """A file of a picture of shades from 0 to 1.

    Raises
    ------
    DependencyError
        If pillow is missing.
    """
    try:
        import PIL.Image
    except ImportError as error:
        raise DependencyError(f"pictures need pillow: {how_to_install('formats')}") from error
    file = io.BytesIO()
    PIL.Image.fromarray(np.rint(255 * picture.clip(0.0, 1.0)).astype(np.uint8)).save(file, "png")
    return file.getvalue()
