"""Attributes of a mesh: colors, normals, texture coordinates, and numbers of any meaning."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any, Literal, get_args

import numpy as np
import numpy.typing as npt

from bsm.bitstream.errors import ArgumentError, MeshError, public
from bsm.codec.arrays import Faces, Indices, Matrix, Order, as_array, sealed

Domain = Literal["vertex", "corner", "face"]
Semantic = Literal["generic", "color", "normal", "texcoord"]
DOMAINS: tuple[Domain, ...] = get_args(Domain)  # in the order of their numbers in streams
SEMANTICS: tuple[Semantic, ...] = get_args(Semantic)

MOST_COMPONENTS = 4
MOST_NAME_BYTES = 255
KINDS = ("uint8", "int8", "uint16", "int16", "uint32", "int32", "float32", "float64")


@public
@dataclass(frozen=True, eq=False)
class Attribute:
    """One named attribute; its arrays are read-only copies.

    Parameters
    ----------
    name : str
        Not empty, and unique in a mesh. Usual names are "color", "normal" and "texcoord", with a number appended for a
        second one.
    values : array_like, shape (k, c) or (k,), 1 <= c <= 4
        Integers of at most 32 bits, or finite floats of 32 or 64 bits. Shape (k,) is stored as (k, 1), wider integers
        that fit as 32 bits, booleans as uint8. Colors are uint8 or uint16, or floats from 0 to 1.
    domain : {"vertex", "corner", "face"}
        The elements that have values: vertices (k = n), faces (k = m), or corners of faces.
    semantic : {"generic", "color", "normal", "texcoord"}
        Meaning of the values; it decides how they are coded.
    indices : array_like, shape (m, 3), optional
        For corners: the index of the value of each corner. None: corner i of face f has value 3 f + i.

    Raises
    ------
    MeshError
        If a shape or a type is wrong, a value is not finite, or an index is out of range.

    Examples
    --------
    >>> import bsm
    >>> mesh = bsm.load("bunny.ply")
    >>> heat = bsm.Attribute("heat", mesh.positions[:, 2])
    >>> warm = bsm.TriangleMesh(mesh.positions, mesh.faces, [heat])
    >>> bsm.decode(bsm.encode(warm)).attributes[0].name
    'heat'
    """

    name: str
    values: npt.NDArray[Any]
    domain: Domain = "vertex"
    semantic: Semantic = "generic"
    indices: Indices | None = None

    def __repr__(self) -> str:
        count, components = self.values.shape
        kind = f"{count} x {components} {self.values.dtype}"
        return f"Attribute({self.name!r}, {kind} per {self.domain}, {self.semantic})"

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.name, self.values, self.domain, self.semantic, self.indices)

    def __post_init__(self) -> None:
        what = f"the attribute {self.name!r}"
        if not all(isinstance(text, str) for text in (self.name, self.domain, self.semantic)):
            raise ArgumentError(f"{what}: name, domain and meaning must be texts")
        # Lone surrogates come from file names that are not text. They cannot be written as UTF-8.
        encoded = self.name.encode(errors="ignore")
        if encoded.decode() != self.name or b"\0" in encoded:
            raise MeshError(
                f"the name of an attribute must not contain NUL or lone surrogates: {self.name!r}"
            )
        if not 1 <= len(encoded) <= MOST_NAME_BYTES:
            raise MeshError(
                f"the name of an attribute must have 1 to {MOST_NAME_BYTES} bytes: {self.name!r}"
            )
        if self.domain not in DOMAINS or self.semantic not in SEMANTICS:
            raise MeshError(
                f"{what} has an unknown domain or semantic: {self.domain!r}, {self.semantic!r}"
            )
        values = _stored(as_array(self.values, what), what)
        if self.domain == "corner":
            if self.indices is None and len(values) % 3:
                raise MeshError(
                    f"{what} has {len(values)} values, and not three for each face; or give indices"
                )
            numbers = (
                np.arange(len(values)).reshape(-1, 3) if self.indices is None else self.indices
            )
            indices = as_array(numbers, f"the indices of {what}")
            if indices.ndim != 2 or indices.shape[1] != 3 or indices.dtype.kind not in "iu":
                raise MeshError(f"the indices of {what} must be integers of shape (m, 3)")
            # Kernels and viewers index with these.
            if indices.size and not (indices.min() >= 0 and indices.max() < len(values)):
                raise MeshError(f"an index of {what} is outside 0..{len(values) - 1}")
            object.__setattr__(self, "indices", sealed(indices.astype(np.int32, copy=False)))
        elif self.indices is not None:
            raise MeshError(f"{what} has indices, but is not of corners")
        object.__setattr__(self, "values", sealed(values))

    @property
    def components(self) -> int:
        """Number of components of a value."""
        return int(self.values.shape[1])

    def check(self, vertices: int, faces: int) -> None:
        """Raise `MeshError` if the length does not match the vertices or faces of the mesh."""
        rows = len(self.values) if self.indices is None else len(self.indices)
        expected = vertices if self.domain == "vertex" else faces
        if rows != expected:
            what = f"{expected} {'vertices' if self.domain == 'vertex' else 'faces'}"
            raise MeshError(
                f"the attribute {self.name!r} has {rows} rows, where the mesh has {what}"
            )

    def taken(self, vertices: Order, faces: Order) -> Attribute:
        """Return the attribute for a mesh whose vertex j was `vertices[j]` here, and whose face i was `faces[i]`.

        `vertices` has shape (n,), `faces` has shape (m,): as many as that mesh has.
        """
        if self.indices is None:
            return replace(self, values=self.values[vertices if self.domain == "vertex" else faces])
        # Values that no remaining corner uses would still be sent.
        used, where = np.unique(self.indices[faces], return_inverse=True)
        return replace(
            self, values=self.values[used], indices=where.reshape(-1, 3).astype(np.int32)
        )


def _stored(values: npt.NDArray[Any], what: str) -> npt.NDArray[Any]:
    # Arrays of files may have the other order of bytes, which kernels in C would read as other numbers.
    values = values.astype(values.dtype.newbyteorder("="), copy=False)
    if values.ndim == 1:
        values = values[:, None]
    if values.ndim != 2 or not 1 <= values.shape[1] <= MOST_COMPONENTS:
        raise MeshError(
            f"the values of {what} must have shape (k,) or (k, 1 to {MOST_COMPONENTS}), not {values.shape}"
        )
    if values.dtype == bool:
        values = values.astype(np.uint8)
    elif values.dtype == np.float16:
        values = values.astype(np.float32)
    elif values.dtype in (np.int64, np.uint64):
        # numpy makes 64 bits of every Python integer, and hardly any attribute needs them.
        narrow = np.int32 if values.size == 0 or values.max() < 1 << 31 else np.uint32
        if (
            values.size
            and not np.iinfo(narrow).min <= values.min() <= values.max() <= np.iinfo(narrow).max
        ):
            raise MeshError(f"the values of {what} do not fit into 32 bits")
        values = values.astype(narrow)
    if values.dtype.name not in KINDS:
        raise MeshError(
            f"the values of {what} must be integers or floats of at most 64 bits, not {values.dtype}"
        )
    if values.dtype.kind == "f" and not np.isfinite(values).all():
        raise MeshError(f"a value of {what} is not finite")
    return np.ascontiguousarray(values)


def has(attributes: Iterable[Attribute], attribute: Attribute) -> bool:
    """Whether an attribute is among others, with the same values."""
    return any(
        (attribute.name, attribute.domain, attribute.semantic, attribute.values.dtype)
        == (other.name, other.domain, other.semantic, other.values.dtype)
        and np.array_equal(attribute.values, other.values)
        and (attribute.indices is other.indices or np.array_equal(attribute.indices, other.indices))  # type: ignore[arg-type]
        for other in attributes
    )


@dataclass(frozen=True)
class AttributeComparison:
    """An attribute, before and after; the mean angle of normals counts each corner by the area of its face."""

    max_error: float
    mean_error: float
    range: float
    max_angle_deg: float | None = None
    mean_angle_deg: float | None = None


def at_corners(attribute: Attribute, faces: Faces) -> npt.NDArray[Any]:
    """The value of each corner of each face, shape (m, 3, c)."""
    if attribute.domain == "face":
        return np.repeat(attribute.values[:, None], 3, axis=1)
    return attribute.values[faces if attribute.indices is None else attribute.indices]


def compare_values(
    original: npt.NDArray[Any], decoded: npt.NDArray[Any], areas: npt.NDArray[np.float64] | None
) -> AttributeComparison:
    """Compare values of corresponding corners, shapes (..., c); normals (with `areas`) by their angles as well."""
    before, after = (
        values.reshape(-1, values.shape[-1]).astype(np.float64) for values in (original, decoded)
    )
    error = np.abs(after - before)
    spread = float(np.ptp(before))
    if areas is None:
        return AttributeComparison(float(error.max()), float(error.mean()), spread)
    # Between vectors, in degrees; by half angles, which keeps small ones exact.
    lengths = [np.linalg.norm(vectors, axis=1, keepdims=True) for vectors in (before, after)]
    known = ((lengths[0] > 0) & (lengths[1] > 0))[:, 0]
    a, b = before[known] / lengths[0][known], after[known] / lengths[1][known]
    angles: Matrix = np.degrees(
        2 * np.arctan2(np.linalg.norm(a - b, axis=1), np.linalg.norm(a + b, axis=1))
    )
    weights = areas.reshape(-1)[known]
    mean = float(np.average(angles, weights=weights)) if weights.sum() > 0.0 else 0.0
    turned = float(angles.max(initial=0.0)), mean
    return AttributeComparison(float(error.max()), float(error.mean()), spread, *turned)
