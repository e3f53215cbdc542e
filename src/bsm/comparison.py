"""How far one mesh is from another of the same faces: positions, and attributes at the corners of faces."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field

import numpy as np

from bsm.bitstream.errors import MeshError
from bsm.bitstream.public import public
from bsm.codec.arrays import Positions
from bsm.codec.geometry.attributes import AttributeComparison, at_corners, compare_values
from bsm.codec.geometry.mesh import TriangleMesh
from bsm.codec.geometry.metrics import Comparison, compare
from bsm.codec.static.joining import join
from bsm.files.permutation import Order, in_order_of, paired_corners, unsplit


@public
@dataclass(frozen=True)
class MeshComparison(Comparison):
    """Positions and attributes, before and after.

    Attributes
    ----------
    attributes : mapping of str to AttributeComparison or None
        The errors of the original's attributes by their names, at the corners of faces; None: it is not there any more.

    Examples
    --------
    >>> import bsm
    >>> errors = bsm.compare("spot.obj", "spot.bsm")
    >>> sorted(errors.attributes)[0], errors.rms > 0
    ('texcoord', True)
    """

    attributes: Mapping[str, AttributeComparison | None] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class Pair:
    """Two meshes whose vertices correspond."""

    original: TriangleMesh
    positions: Positions
    corners: Order
    others: Order
    joined: bool


def pair(original: TriangleMesh, decoded: TriangleMesh, order: Order | None = None) -> Pair:
    """Find which vertices of meshes, all of whose vertices are in faces, are the same."""
    attributed = bool(original.attributes)
    kept = [np.arange(len(mesh.faces)) for mesh in (original, decoded)]
    joined = order is None and not _comparable(original, decoded)
    if joined:
        # An encoder makes vertices at one position one, and a file may need them split.
        whole = join(original, keep=False)
        original, kept[0] = whole.mesh, whole.kept
        if len(original.positions) != len(decoded.positions):
            if before := unsplit(original, decoded):
                decoded = before
            else:
                whole = join(decoded, keep=False)
                decoded, kept[1] = whole.mesh, whole.kept
    positions = in_order_of(original, decoded, order)
    none = np.empty(0, np.int64)
    pairs = paired_corners(original, decoded, order) if attributed else (none, none)
    corners, others = (3 * given[found // 3] + found % 3 for given, found in zip(kept, pairs, strict=True))
    return Pair(original, positions, corners, others, joined)


def compare_meshes(original: TriangleMesh, decoded: TriangleMesh, paired: Pair) -> MeshComparison:
    """Compare two meshes, given which of their vertices are the same."""
    positions = compare(paired.original.positions, paired.positions, paired.original.faces)
    return MeshComparison(**asdict(positions), attributes=_compare_attributes(original, decoded, paired))


def _comparable(original: TriangleMesh, decoded: TriangleMesh) -> bool:
    """Whether they have the same vertices, in an order that is known."""
    if len(original.positions) != len(decoded.positions):
        return False
    try:
        in_order_of(original, decoded)
    except MeshError:
        return False
    return True


def _compare_attributes(
    original: TriangleMesh, decoded: TriangleMesh, paired: Pair
) -> dict[str, AttributeComparison | None]:
    found: dict[str, AttributeComparison | None] = {}
    after = {attribute.name: attribute for attribute in decoded.attributes}
    for attribute in original.attributes:
        other = after.get(attribute.name)
        if other is None or other.components != attribute.components:
            found[attribute.name] = None
            continue
        values = at_corners(attribute, original.faces).reshape(-1, attribute.components)[paired.corners]
        others = at_corners(other, decoded.faces).reshape(-1, attribute.components)[paired.others]
        found[attribute.name] = compare_values(values, others, normals=attribute.semantic == "normal")
    return found
