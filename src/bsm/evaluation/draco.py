"""Draco through DracoPy, and the order in which it leaves the vertices.

Draco renumbers vertices and says nothing about it. What each original vertex was decoded to is found by encoding a
second time with the vertex numbers as an attribute; that file is not the one whose size counts, and both are checked
to hold the same triangles.
"""

from __future__ import annotations

from types import ModuleType

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import DependencyError, MeshError
from bsm.bitstream.extras import how_to_install
from bsm.codec.arrays import Positions
from bsm.codec.geometry.mesh import TriangleMesh

Triangles = npt.NDArray[np.int64]


def encode_draco(mesh: TriangleMesh, position_bits: int, level: int) -> bytes:
    """Encode positions and faces with edgebreaker."""
    draco = _draco()
    try:
        data: bytes = draco.encode(
            mesh.positions.astype(np.float32), mesh.faces, quantization_bits=position_bits, compression_level=level
        )
    except draco.EncodingFailedException as error:
        raise MeshError(f"Draco does not take this mesh: {error}") from error
    return data


def decode_draco(data: bytes) -> TriangleMesh:
    """Decode a Draco mesh."""
    decoded = _draco().decode(data)
    return TriangleMesh(decoded.points, decoded.faces)


def positions_in_order(mesh: TriangleMesh, decoded: TriangleMesh, position_bits: int) -> Positions:
    """What Draco made of each vertex of `mesh`, given the mesh that it decoded."""
    numbers = np.arange(len(mesh.positions), dtype=np.uint32)[:, None]
    data = _draco().encode(
        mesh.positions.astype(np.float32),
        mesh.faces,
        quantization_bits=position_bits,
        compression_level=10,
        generic_attributes={0: numbers},
    )
    numbered = _draco().decode(data)
    original = numbered.get_attribute_by_unique_id(0)["data"].reshape(-1).astype(np.int64)
    points = np.asarray(numbered.points, dtype=np.float64)
    if len(np.unique(original)) != len(mesh.positions):
        raise MeshError("Draco dropped vertices; remove those that no face with area uses")
    if not np.array_equal(_canonical(original[numbered.faces]), _canonical(_with_three_corners(mesh.faces))):
        raise MeshError("Draco's numbered faces are not those of the original")
    _, identity = np.unique(np.concatenate([points, decoded.positions]), axis=0, return_inverse=True)
    first, second = identity[: len(points)], identity[len(points) :]
    if not np.array_equal(_canonical(first[numbered.faces]), _canonical(second[decoded.faces])):
        raise MeshError("Draco decodes to different triangles with and without numbered vertices")
    positions = np.empty_like(mesh.positions)
    positions[original] = points
    return positions


def _with_three_corners(faces: npt.NDArray[np.int32]) -> npt.NDArray[np.int32]:
    a, b, c = faces.T
    kept: npt.NDArray[np.int32] = faces[(a != b) & (b != c) & (c != a)]
    return kept


def _canonical(faces: npt.NDArray[np.integer]) -> Triangles:
    """Faces as rows that begin with their least rotation, sorted: equal for equal sets of oriented triangles."""
    corners = faces.astype(np.int64)
    rotations = np.stack([corners, np.roll(corners, 1, axis=1), np.roll(corners, 2, axis=1)])
    base = corners.max(initial=0) + 1
    if base > 2_000_000:
        raise MeshError(f"{base} vertices are too many for this comparison")
    keys = (rotations[..., 0] * base + rotations[..., 1]) * base + rotations[..., 2]
    return np.sort(keys.min(axis=0))


def _draco() -> ModuleType:
    try:
        import DracoPy
    except ImportError as error:
        raise DependencyError(f"Draco needs the package DracoPy: {how_to_install('eval')}") from error
    module: ModuleType = DracoPy
    return module
