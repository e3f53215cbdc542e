"""Names for the kinds of arrays; functions that take them document the shapes."""

from typing import Any

import numpy as np
import numpy.typing as npt

from bsm._core import codec as _kernels
from bsm.bitstream.errors import MeshError

Matrix = npt.NDArray[np.float64]  # real numbers, of any shape
Floats = Matrix  # the same, of a few axes at most: lengths, normals, weights
# Columns of a dictionary, and what its solver works on: single precision, shape (n, c).
Basis = npt.NDArray[np.float32]
# Coordinates of vertices, shape (n, 3), or of frames, shape (T, n, 3).
Positions = npt.NDArray[np.float64]
Faces = npt.NDArray[np.int32]  # vertices of triangles, shape (m, 3)
Indices = npt.NDArray[np.int32]  # numbers of vertices, rows, parts, or faces
Order = npt.NDArray[np.int64]  # the same in the width that numpy's own index arrays have
Levels = npt.NDArray[np.int32]  # quantized coefficients, in steps
Integers = npt.NDArray[np.signedinteger]  # whole numbers of any width
Mask = npt.NDArray[np.bool_]  # what holds for which vertex


class _Seal:
    """Own an array that is complete, so that numpy refuses to write to it."""

    def __init__(self, array: npt.NDArray[Any]) -> None:
        self._array = array
        address, _ = array.__array_interface__["data"]
        self.__array_interface__ = {**array.__array_interface__, "data": (address, True)}


def sealed(array: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Return an array that the caller hands over, read-only for good; `as_array` takes it without a copy."""
    if _is_sealed(array):
        return array
    return np.asarray(_Seal(np.ascontiguousarray(array)))


def _is_sealed(values: Any) -> bool:
    return type(values) is np.ndarray and isinstance(values.base, _Seal)


LARGE = 100_000  # vertices; the arrays of smaller meshes are not worth a call to the system


def end_phase(vertices: int) -> None:
    """Return the memory of dropped arrays to the system, after a phase in which a large mesh needed many."""
    if vertices >= LARGE:
        _kernels.return_free_memory()


def distinct(values: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Return the values that occur, in ascending order."""
    # Not np.unique: it loads numpy.ma, which takes as long as decoding a small mesh.
    ordered = np.sort(values, axis=None)
    is_first = np.append(True, ordered[1:] != ordered[:-1])[: len(ordered)]
    return np.asarray(ordered[is_first])


def as_array(values: Any, name: str, kind: type[np.float64] | None = None) -> npt.NDArray[Any]:
    """Return a user's values as an array, copied unless they are sealed; raise `MeshError` if they are not one."""
    if _is_sealed(values) and kind in (None, values.dtype.type):
        return np.asarray(values)
    try:
        return np.array(values, dtype=kind, order="C")
    except (TypeError, ValueError, OverflowError) as error:
        raise MeshError(f"{name} is not an array of numbers: {error}") from error
