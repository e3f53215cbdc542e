"""Names for the kinds of arrays; functions that take them document the shapes."""

from typing import Any

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import MeshError

Matrix = npt.NDArray[np.float64]  # real numbers, of any shape
Floats = Matrix  # the same, of a few axes at most: lengths, normals, weights
Basis = npt.NDArray[np.float32]  # columns of a dictionary, and what its solver works on: single precision, shape (n, c)
Positions = npt.NDArray[np.float64]  # coordinates of vertices, shape (n, 3), or of frames, shape (T, n, 3)
Faces = npt.NDArray[np.int32]  # vertices of triangles, shape (m, 3)
Indices = npt.NDArray[np.int32]  # numbers of vertices, rows, parts, or faces
Order = npt.NDArray[np.int64]  # the same in the width that numpy's own index arrays have
Levels = npt.NDArray[np.int32]  # quantized coefficients, in steps
Integers = npt.NDArray[np.signedinteger]  # whole numbers of any width
Mask = npt.NDArray[np.bool_]  # what holds for which vertex


def as_array(values: Any, name: str, kind: type[np.float64] | None = None) -> npt.NDArray[Any]:
    """Return a copy of a user's values as an array; raise `MeshError` if they are not one."""
    try:
        return np.array(values, dtype=kind, order="C")
    except (TypeError, ValueError, OverflowError) as error:
        raise MeshError(f"{name} is not an array of numbers: {error}") from error
