"""BSM units, in which every mesh is about one long, and the way back to the unit of the mesh."""

import zlib
from dataclasses import dataclass

import numpy as np

from bsm.bitstream.errors import NumericError
from bsm.codec.arrays import Matrix, Positions
from bsm.codec.geometry.mesh import TriangleMesh, box_around


@dataclass(frozen=True)
class Units:
    """Where BSM units lie in the mesh's."""

    center: tuple[float, ...]
    scale: float

    def into(self, positions: Positions) -> Matrix:
        """Positions of the mesh, shape (n, 3), in BSM units."""
        return np.asarray((positions - np.array(self.center)) / self.scale)

    def back(self, positions: Matrix) -> Positions:
        """Positions in BSM units, shape (n, 3), as the mesh has them."""
        # Streams of strangers can hold any scale. Their infinities are an error with words, below.
        with np.errstate(over="ignore", invalid="ignore"):
            moved = np.multiply(positions, self.scale)
            moved += self.center
        if not np.isfinite(moved).all():
            raise NumericError("positions are not finite in the unit of the mesh")
        return moved


def checksum_of(positions: Positions, before: int = 0) -> int:
    """CRC-32 of decoded positions, shape (n, 3), in the mesh's unit, continued from the CRC-32 `before` (F 5.10)."""
    # Adding 0.0 turns -0.0 into 0.0: they are equal, and processors may differ in which one they get.
    return zlib.crc32(np.ascontiguousarray(positions + 0.0, "<f8").data, before)


def units_of(mesh: TriangleMesh) -> Units:
    """Center and diagonal of the bounding box, in single precision where that is exact enough."""
    low, high = box_around(mesh.positions)
    # Halved first, for the sum of two large coordinates may overflow.
    center = low / 2 + high / 2
    diagonal = mesh.diagonal
    # All vertices at one place. Any unit does, and none may be zero.
    if not diagonal > 0.0:
        return Units(tuple(center), 1.0)
    with np.errstate(over="ignore"):
        coarse = center.astype(np.float32).astype(np.float64)
        # Rounded up, so that positions stay within half a unit of the center.
        rough_scale = np.float32(diagonal * (1 + 4e-6))
        scale = float(np.nextafter(rough_scale, np.float32(np.inf)))
    # A center in single precision takes half the bytes, and moves the mesh by nothing.
    if np.abs(coarse - center).max() < 1e-6 * diagonal:
        center = coarse
    if not 1e-30 < scale < np.inf:
        scale = diagonal
    return Units(tuple(center), scale)


def single(value: float) -> float:
    """The nearest number of single precision, which a header stores in half the bytes."""
    return float(np.float32(value))
