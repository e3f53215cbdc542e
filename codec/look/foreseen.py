"""Looks that are foreseen without pictures, for searches that can draw few of many versions.

A picture changes where vertices are shaded otherwise, and where outlines move. Both follow from positions, but for what
hides behind something else, so that a foreseen look follows the drawn one with a standard deviation of 3 %, from frame
to frame of a motion, around a ratio that changes slowly.
"""

import math

import numpy as np

from bsm._core import codec as _kernels
from bsm.codec.arrays import Faces, Indices, Matrix, Positions
from bsm.codec.geometry.graph import edges_of
from bsm.codec.look.measure import POWER
from bsm.codec.look.pictures import TOWARDS, axes, light_of, sides_of

DIFFUSE = 0.78  # how much brighter a face is that the light shines on, as pictures have it
OUTLINES = 0.02
"""Squared differences that an outline makes, of its squared jump and the area that it sweeps: samples are on or off,
and eyes see less there. Chosen on three captured motions."""
FORESEEN = 0.0095  # the foreseen difference of pictures at distance 1 of a frame


class Foresight:
    """Foresees how versions of the vertices of some faces look."""

    def __init__(self, faces: Faces) -> None:
        self._faces = np.ascontiguousarray(faces, np.int32)
        self._edges = _edges_between_two(self._faces)
        # Two opposite sides see the same outlines, so that a view has both, with the light of each.
        pairs = zip(TOWARDS[::2], TOWARDS[1::2], strict=True)
        self._views = np.array(
            [[axes(one)[2], light_of(one), light_of(other)] for one, other in pairs]
        ).reshape(-1, 9)

    def look(self, original: Positions, decoded: Positions, sides: Matrix | None = None) -> float:
        """Return about the distance of a frame from the original one, both of shape (n, 3).

        `sides`, if known, are those of the pictures of the original.
        """
        if sides is None:
            sides = sides_of(original)
        original, decoded = (
            np.ascontiguousarray(positions, np.float64) for positions in (original, decoded)
        )
        around, facing = np.empty((len(original), 6)), np.empty(len(self._faces), np.uint8)
        sums = np.empty((len(self._views), 4))
        _kernels.foresee(
            original, decoded, self._faces, self._edges, self._views, around, facing, sums
        )
        shades, outlines = sums[:, :2].ravel(), sums[:, 2:].ravel()
        squares = DIFFUSE**2 / 6.0 * shades + OUTLINES * outlines
        unlike = np.sqrt(squares) / sides
        return math.pow(float(unlike.mean()) / FORESEEN, POWER)


def _edges_between_two(faces: Faces) -> Indices:
    """Return the ends and the faces of edges between two faces, shape (k, 4)."""
    ends, numbers, uses = edges_of(faces)
    paired = np.flatnonzero(uses == 2)
    # Sorted by their edge, corners of the same edge are next to each other.
    first, second = paired[np.argsort(numbers[paired], kind="stable")].reshape(-1, 2).T
    return np.column_stack([ends[first], first // 3, second // 3]).astype(np.int32)
