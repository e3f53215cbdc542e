"""A triangle mesh: validated once, immutable afterwards."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from bsm.bitstream.errors import ArgumentError, MeshError, public
from bsm.codec.arrays import Faces, Matrix, Order, Positions, as_array, sealed
from bsm.codec.geometry.attributes import Attribute

Metadata = Mapping[str, str | int | float | bytes]  # whatever an author wants to say of a mesh


_OTHER_NAMES = {
    "its vertices are mesh.positions": "vertices points verts vertex coordinates",
    "its triangles are mesh.faces": "triangles indices cells polygons",
    "they are in mesh.attributes": "normals vertex_normals colors vertex_colors uv uvs texcoords textures",
    "its entries are in mesh.metadata": "name unit up materials images info",
    "write it by bsm.save(mesh, path)": "save export write to_file",
    "compress it by bsm.encode(mesh)": "encode compress to_bytes",
    "show it by bsm.show(mesh)": "show plot view",
}
"""What other libraries call the parts of a mesh."""


class NoFacesError(MeshError):
    """A mesh or a file has no faces, which only a frame of a sequence may lack."""


@public
@dataclass(frozen=True, eq=False)
class TriangleMesh:
    """Positions and faces of a triangle mesh; both arrays are read-only copies.

    Parameters
    ----------
    positions : array_like, shape (n, 3)
        Finite coordinates; stored as float64.
    faces : array_like, shape (m, 3)
        Indices into `positions`, counter-clockwise seen from outside; stored as int32. Any set of triangles is
        allowed: also degenerate, repeated, non-manifold and inconsistently oriented ones.
    attributes : sequence of Attribute
        Attributes of vertices, corners and faces, with different names.
    metadata : mapping from str to str, int, float or bytes
        Entries for the whole mesh: a name, a unit, an author, ...

    Raises
    ------
    MeshError
        If a shape is wrong, a coordinate is not finite, an index is out of range, the mesh has no faces, or an
        attribute does not fit the mesh.

    Examples
    --------
    >>> import bsm
    >>> corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    >>> bsm.TriangleMesh(corners, [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)], metadata={"unit": "mm"})
    TriangleMesh(4 vertices, 4 faces)
    """

    positions: Positions
    faces: Faces
    attributes: tuple[Attribute, ...] = ()
    metadata: Metadata = field(default_factory=dict)

    def __post_init__(self) -> None:
        attributes: object = self.attributes
        if not isinstance(attributes, (tuple, list)) or not all(
            isinstance(a, Attribute) for a in attributes
        ):
            raise ArgumentError("the attributes of a mesh must be a list of Attribute")
        if not isinstance(self.metadata, Mapping):
            raise ArgumentError(
                f"metadata must be a mapping from names, not {type(self.metadata).__name__}"
            )
        # Copies that cannot be written to: a caller who changes an array later would change a mesh that was checked.
        positions = as_array(self.positions, "positions", np.float64)
        faces = as_array(self.faces, "faces")
        if positions.ndim != 2 or positions.shape[1] != 3:
            raise MeshError(f"positions must have shape (n, 3), not {positions.shape}")
        if not np.isfinite(positions).all():
            row = int(np.argmin(np.isfinite(positions).all(axis=1)))
            raise MeshError(
                f"vertex {row} has a coordinate that is not finite; remove or repair it"
            )
        # Before the shape: an empty list also has the wrong shape, but "no faces" is the helpful error.
        if faces.size == 0:
            raise NoFacesError("the mesh has no faces; point clouds are not supported")
        if faces.ndim != 2 or faces.shape[1] != 3:
            raise MeshError(
                f"faces must have shape (m, 3), not {faces.shape}; triangulate polygons first"
            )
        if faces.dtype.kind not in "iu":
            raise MeshError(f"faces must be integers, not {faces.dtype}")
        # The least and the largest first: masks of all corners are as large as a quarter of the faces.
        if faces.min() < 0 or faces.max() >= len(positions):
            bad = (faces < 0) | (faces >= len(positions))
            row = int(np.argmax(bad.any(axis=1)))
            raise MeshError(
                f"face {row} refers to vertex {faces[row].tolist()}, outside 0..{len(positions) - 1}"
            )
        faces = faces.astype(np.int32, copy=False)
        object.__setattr__(self, "positions", sealed(positions))
        object.__setattr__(self, "faces", sealed(faces))
        object.__setattr__(self, "attributes", tuple(self.attributes))
        # numpy's scalars are not JSON, and not msgpack.
        plain = {
            k: value.item() if isinstance(value, np.generic) else value
            for k, value in self.metadata.items()
        }
        object.__setattr__(self, "metadata", MappingProxyType(plain))
        names = [attribute.name for attribute in self.attributes]
        if len(set(names)) < len(names):
            raise MeshError(f"two attributes have the same name, of {', '.join(names)}")
        for attribute in self.attributes:
            attribute.check(len(positions), len(faces))

    def __repr__(self) -> str:
        names = "".join(f", {attribute.name}" for attribute in self.attributes)
        return f"TriangleMesh({len(self.positions)} vertices, {len(self.faces)} faces{names})"

    # Type checkers would take any name for an attribute.
    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            """Raise an `AttributeError` that has our name for that of another library."""
            known = next(
                (told for told, names in _OTHER_NAMES.items() if name in names.split()), ""
            )
            advice = f"; {known}" if known else ""
            raise AttributeError(f"a TriangleMesh has no {name}{advice}", name=name, obj=self)

    def __reduce__(self) -> tuple[Any, ...]:
        # A MappingProxyType cannot be pickled.
        return type(self), (self.positions, self.faces, self.attributes, dict(self.metadata))

    @property
    def diagonal(self) -> float:
        """Length of the bounding box's diagonal."""
        return math.hypot(*extent_of(self.positions))

    def require_sizes(self, smallest: float, largest: float) -> None:
        """Raise `MeshError` if the mesh is too small, or too far from the origin, for the caller."""
        require_sizes(self.positions, smallest, largest)

    def moved(self, positions: Positions) -> tuple[TriangleMesh, tuple[str, ...]]:
        """Return the mesh with new positions, shape (n, 3), and the names of its normals, which are dropped."""
        # Normals describe the old surface. Colors and textures do not depend on where a vertex is.
        normals = tuple(
            attribute.name for attribute in self.attributes if attribute.semantic == "normal"
        )
        kept = tuple(attribute for attribute in self.attributes if attribute.semantic != "normal")
        return replace(self, positions=positions, attributes=kept), normals

    @property
    def bare(self) -> TriangleMesh:
        """The mesh without attributes and metadata."""
        return replace(self, attributes=(), metadata={})

    def without_isolated_vertices(self) -> tuple[TriangleMesh, Order]:
        """Return the mesh without vertices in no face, and the indices of the kept vertices, shape (k,), ascending."""
        # Vertices in no face change the diagonal, by which all errors are measured, though no viewer draws them.
        kept = np.flatnonzero(np.bincount(self.faces.ravel()))
        if len(kept) == len(self.positions):
            return self, kept
        every_face = np.arange(len(self.faces))
        attributes = tuple(attribute.taken(kept, every_face) for attribute in self.attributes)
        faces = np.searchsorted(kept, self.faces).astype(np.int32)
        return replace(
            self, positions=self.positions[kept], faces=faces, attributes=attributes
        ), kept


LARGEST = 1e100
"""Largest coordinate where products of three lengths are finite."""


def require_sizes(
    positions: Positions, smallest: float = 0.0, largest: float = LARGEST, done: str = "encoded so"
) -> None:
    """Raise `MeshError` unless positions, shape (n, 3), are within these sizes; `done` says what for."""
    farthest = float(np.abs(positions).max(initial=0.0))
    # The extent of coordinates near the largest double is infinite, which is larger than allowed, as it should be.
    with np.errstate(over="ignore"):
        extent = float(extent_of(positions).max()) if len(positions) else 0.0
    if farthest > largest or 0.0 < extent < smallest:
        sizes = f"from {smallest:g} to {largest:g}" if smallest else f"up to {largest:g}"
        raise MeshError(
            f"the mesh is {extent:.3g} across, and {farthest:.3g} from the origin; what is {sizes} can be {done}: "
            "scale it, and say the unit in its metadata"
        )


def box_around(points: Positions) -> tuple[Matrix, Matrix]:
    """Lowest and highest corner of the box around at least one point, shape (n, d); each has shape (d,)."""
    axes = points.T  # three long loops are faster than n short ones
    return np.array([axis.min() for axis in axes]), np.array([axis.max() for axis in axes])


def squares_of(rows: Matrix) -> Matrix:
    """Squared lengths of rows, shape (n, 3)."""
    x, y, z = np.square(rows).T
    return np.asarray(x + y + z)


def extent_of(points: Positions) -> Matrix:
    """Lengths of the sides of the bounding box, shape (d,)."""
    low, high = box_around(points)
    return np.asarray(high - low)
