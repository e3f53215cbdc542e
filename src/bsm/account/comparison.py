"""How far one mesh is from another of the same faces: positions, and attributes at the corners of faces."""

import io
import os
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, field, replace
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from bsm.bitstream.connectivity.faces import AS_CORNERS, ON_EDGES, encode_connectivity
from bsm.bitstream.errors import ArgumentError, FormatError, MeshError, public
from bsm.codec.arrays import Faces, Integers, Mask, Order, Positions
from bsm.codec.geometry.attributes import Attribute, AttributeComparison, at_corners, compare_values
from bsm.codec.geometry.graph import canonical, canonical_order
from bsm.codec.geometry.mesh import TriangleMesh, squares_of
from bsm.codec.geometry.metrics import Comparison, compare, face_geometry
from bsm.codec.geometry.welding import first_of, group_rows
from bsm.codec.static.preamble_encoding import join, joined
from bsm.files.conventions import shares_of
from bsm.files.formats.metadata import name_in_file
from bsm.files.formats.npz import write_npy
from bsm.files.images import largest_side
from bsm.files.output import open_output
from bsm.files.pipes import as_input


def write_permutation(
    path: str | os.PathLike[str], order: npt.NDArray[np.integer], *, overwrite: bool
) -> None:
    with open_output(path, overwrite=overwrite) as file:
        write_npy(file, order.astype(np.int64))


def read_permutation(path: str | os.PathLike[str]) -> Order:
    try:
        order = np.lib.format.read_array(io.BytesIO(as_input(path).read_all()), allow_pickle=False)
    except (ValueError, EOFError, MemoryError) as error:
        raise FormatError(f"{path} is not an npy file: {error}") from error
    if order.ndim != 1 or order.dtype.kind not in "iu" or len(np.unique(order)) != len(order):
        raise FormatError(
            f"{path} does not hold the order of vertices that bsm encode --permutation writes"
        )
    return order.astype(np.int64)


def reorder(mesh: TriangleMesh, order: Order) -> TriangleMesh:
    """Number the vertices as the input of the encoder did, without those that no face used."""
    if len(order) != len(mesh.positions):
        raise MeshError(
            f"the permutation has {len(order)} vertices, the mesh has {len(mesh.positions)}"
        )
    rows, every_face = np.argsort(order), np.arange(len(mesh.faces))
    attributes = tuple(attribute.taken(rows, every_face) for attribute in mesh.attributes)
    faces = np.argsort(rows)[mesh.faces].astype(np.int32)
    return replace(mesh, positions=mesh.positions[rows], faces=faces, attributes=attributes)


def order_of_used(given: npt.ArrayLike, original: TriangleMesh, decoded: TriangleMesh) -> Order:
    """The order of the vertices that faces use, made of one of all vertices."""
    kind = None
    if np.ndim(given) != 1:
        kind = object
    order = np.asarray(given, kind)
    if order.ndim != 1 or order.dtype.kind not in "iu":
        raise ArgumentError(f"order must be a list of whole numbers, not {given!r}")
    if len(order) != len(decoded.positions):
        raise MeshError(
            f"the permutation has {len(order)} vertices, the mesh has {len(decoded.positions)}"
        )
    before, after = (mesh.without_isolated_vertices()[1] for mesh in (original, decoded))
    rows = np.searchsorted(before, order[after]).clip(max=len(before) - 1)
    if len(np.unique(order)) < len(order) or not np.array_equal(before[rows], order[after]):
        raise MeshError(
            "the permutation does not name vertices of the original that faces use, each once"
        )
    return rows


def in_order_of(
    original: TriangleMesh, other: TriangleMesh, order: Order | None = None
) -> Positions:
    """The positions of `other`, numbered as in `original`; neither may have vertices that no face uses."""
    return placed(original, other, numbering(original, other, order))


def placed(original: TriangleMesh, other: TriangleMesh, rows: Order) -> Positions:
    """The positions of `other` at these rows, or that of the original at -1."""
    return np.where(rows[:, None] < 0, original.positions, other.positions[rows])


def numbering(original: TriangleMesh, other: TriangleMesh, order: Order | None = None) -> Order:
    """Return the vertex of `other` that each vertex of `original` is; -1: it lost its faces when vertices merged."""
    count = len(other.positions)
    if len(original.positions) > count:
        # Lossless streams keep the sign of zero, and vertices that differ only there.
        for exact in (False, True):
            joined = join(original, keep=False, exact=exact)
            if len(joined.mesh.positions) == count:
                by_joined = None
                if order is not None:
                    by_joined = joined.index[order].astype(np.int64)
                return np.append(numbering(joined.mesh, other, by_joined), -1)[joined.index]
    if len(original.positions) != count or len(original.faces) != len(other.faces):
        raise MeshError(
            f"the meshes have different faces: {len(original.positions)} and {count} vertices in faces, "
            f"{len(original.faces)} and {len(other.faces)} faces{_collapsed(original, other)}; "
            "bsm compare --look --surface compares such meshes"
        )
    if order is not None and len(order) != count:
        raise MeshError(f"the permutation has {len(order)} vertices, the mesh has {count}")
    rows = np.arange(count)
    if order is not None:
        rows = np.argsort(order)
    faces = np.argsort(rows)[other.faces].astype(np.int32)
    # A symmetric mesh has more than one numbering that fits, so the closest likeness is looked for first.
    if np.array_equal(original.faces, faces):
        return rows
    if order is None:
        by_decoder = encode_connectivity(original.faces, count)
        # Faces that repeat a corner come in another order where a stream has them on edges.
        if _same(by_decoder.faces, faces):
            return np.argsort(by_decoder.vertex_order)
    if np.array_equal(canonical(original.faces), canonical(faces)):
        return rows
    if order is None:
        encoded = encode_connectivity(faces, count)
        if _same(by_decoder.faces, encoded.faces):
            return encoded.vertex_order[np.argsort(by_decoder.vertex_order)].astype(np.int64)
    raise MeshError(
        "the meshes have different faces or another order of vertices; use --permutation or --surface"
    )


def _same(faces: Faces, others: Faces) -> bool:
    """Whether these are the same faces, in any order."""
    return np.array_equal(faces, others) or np.array_equal(canonical(faces), canonical(others))


def _collapsed(original: TriangleMesh, other: TriangleMesh) -> str:
    """Say so if `other` lacks only faces that lost their area when vertices merged."""
    from scipy.spatial import cKDTree

    faces = cKDTree(other.positions).query(original.positions)[1][original.faces].astype(np.int32)
    faces = faces[(faces != np.roll(faces, 1, axis=1)).all(axis=1)]
    same = faces.shape == other.faces.shape and np.array_equal(
        canonical(faces), canonical(other.faces)
    )
    if not same:
        return ""
    return ", which are the same but for those that collapsed where vertices merged"


@dataclass(frozen=True, eq=False)
class FramePair:
    """Vertices of frames before and after, shape (T, n, 3), that are the same, their faces, and equal corners."""

    before: Positions
    after: Positions
    faces: Faces
    corners: Order
    others: Order


def paired_frames(
    original: Positions, faces: Faces, decoded: Positions, others: Faces, order: Order | None = None
) -> FramePair:
    """Find the vertices that faces use in frames, shape (T, n, 3), and which decoded vertices and corners they are."""
    whole = TriangleMesh(original[0], faces), TriangleMesh(decoded[0], others)
    (mesh, kept), (other, other_kept) = (side.without_isolated_vertices() for side in whole)
    before = original[:, kept]
    index = group_rows(np.concatenate(before, axis=1))
    # Where vertices that part have two places.
    apart = TriangleMesh(np.column_stack([index] * 3), mesh.faces)
    used_order = None
    if order is not None:
        used_order = order_of_used(order, *whole)
    rows = numbering(apart, other, used_order)
    after = np.where(rows[:, None] < 0, before, decoded[:, other_kept[rows]])
    corners = others_corners = np.empty(0, np.int64)
    # Else faces have collapsed.
    if len(mesh.faces) == len(other.faces) and (rows >= 0).all():
        corners, others_corners = paired_corners(mesh, other, rows)
    return FramePair(before, after, mesh.faces, corners, others_corners)


def one_each(before: Positions, after: Positions, faces: Faces, kept: int) -> tuple[Order, Faces]:
    """One vertex for each place that copies share in all frames, shape (T, n, 3), before and after; their faces."""
    mesh, index = TriangleMesh(before[0], faces), group_rows(np.concatenate(before, axis=1))
    whole = joined(mesh, index, keep=len(faces) == kept)
    copies = whole.index >= 0
    alike = (after[:, whole.first][:, whole.index[copies]] == after[:, copies]).all()
    if alike:
        return whole.first, whole.mesh.faces
    return np.arange(len(index)), faces


def paired_corners(original: TriangleMesh, other: TriangleMesh, rows: Order) -> tuple[Order, Order]:
    """Corners of `original` and of `other` that are the same, as numbers 3 f + i of corner i of face f."""
    pairs = []
    for faces in (rows[original.faces].astype(np.int32), other.faces):
        numbers, corners = canonical_order(faces)
        pairs.append((3 * numbers[:, None] + corners[numbers]).reshape(-1))
    return pairs[0], pairs[1]


def unsplit(original: TriangleMesh, other: TriangleMesh) -> TriangleMesh | None:
    """The decoded mesh of which `other` is what became after vertices were split; faces and corners stay."""
    if len(original.faces) != len(other.faces):
        return None
    for repeats in (AS_CORNERS, ON_EDGES):
        faces = encode_connectivity(original.faces, len(original.positions), repeats).faces
        if (whole := _unsplit(original, other, faces)) is not None:
            return whole
    return None


def _unsplit(original: TriangleMesh, other: TriangleMesh, faces: Faces) -> TriangleMesh | None:
    """Return the other mesh unsplit, if these faces are the decoded ones."""
    some = np.zeros(len(original.positions), np.int64)
    some[faces] = other.faces
    whole = np.full(len(other.positions), -1, np.int64)
    whole[other.faces] = faces
    positions = other.positions[some]
    fits = np.array_equal(whole[other.faces], faces) and np.array_equal(
        positions[faces], other.positions[other.faces]
    )
    if not fits:
        return None
    return TriangleMesh(positions, faces)


@public
@dataclass(frozen=True)
class MeshComparison(Comparison):
    """Positions and attributes, before and after.

    Attributes
    ----------
    attributes : mapping of str to AttributeComparison or None
        Errors of the original's attributes by name, at the corners of faces; where the name is missing, an attribute
        of the same meaning counts, as three.js says uv for texcoord. None: the attribute is missing.
    flattened : int
        Faces that have an area in the original but not in the decoded mesh.
    merged : int
        Vertices that share the position of another vertex in the decoded mesh but not in the original.

    Examples
    --------
    >>> import bsm
    >>> errors = bsm.compare("spot.obj", "spot.bsm")
    >>> sorted(errors.attributes)[0], errors.rms > 0
    ('texcoord', True)
    """

    attributes: Mapping[str, AttributeComparison | None] = field(default_factory=dict)
    flattened: int = 0
    merged: int = 0


@dataclass(frozen=True, eq=False)
class Pair:
    original: TriangleMesh
    positions: Positions
    corners: Order
    others: Order
    joined: bool


def pair(original: TriangleMesh, decoded: TriangleMesh, order: Order | None = None) -> Pair:
    """Find which vertices of meshes, all of whose vertices are in faces, are the same; if need be by their places."""
    attributed = bool(original.attributes)
    kept: list[Integers] = [np.arange(len(mesh.faces)) for mesh in (original, decoded)]
    merged = order is None
    with suppress(MeshError):  # they may have the same vertices, in an order that is known
        if merged and len(original.positions) == len(decoded.positions):
            numbering(original, decoded)
            # Pieces of a mesh that is split at its seams may be alike: only places tell them apart.
            copies = len(first_of(group_rows(np.ascontiguousarray(original.positions, np.float64))))
            merged = copies < len(original.positions) and not np.array_equal(
                original.faces, decoded.faces
            )
    if merged:
        # An encoder makes vertices at one position one, and a file may need them split.
        given, whole = original, join(original, keep=False)
        original, kept[0] = whole.mesh, whole.coded_faces
        if len(original.positions) != len(decoded.positions):
            if before := unsplit(original, decoded):
                decoded = before
            else:
                whole = join(decoded, keep=False)
                decoded, kept[1] = whole.mesh, whole.coded_faces
            # It may have merged others in single precision.
            if len(original.positions) > len(decoded.positions):
                whole = join(
                    replace(given, positions=given.positions.astype(np.float32)), keep=False
                )
                original, kept[0] = (
                    replace(whole.mesh, positions=given.positions[whole.first]),
                    whole.coded_faces,
                )
    try:
        rows = numbering(original, decoded, order)
    except MeshError:
        from scipy.spatial import cKDTree

        nearest = cKDTree(original.positions).query(decoded.positions)[1]
        if order is not None or not len(nearest) == len(np.unique(nearest)) == len(
            original.positions
        ):
            raise
        rows = numbering(original, decoded, nearest)
    none = np.empty(0, np.int64)
    pairs = none, none
    if attributed:
        pairs = paired_corners(original, decoded, rows)
    corners, others = (
        3 * given[found // 3] + found % 3 for given, found in zip(kept, pairs, strict=True)
    )
    positions = placed(original, decoded, rows)
    first, corners_of = one_each(
        original.positions[None], positions[None], original.faces, len(decoded.faces)
    )
    if len(first) < len(positions):
        original, positions, merged = (
            TriangleMesh(original.positions[first], corners_of),
            positions[first],
            True,
        )
    return Pair(original, positions, corners, others, merged)


def compare_meshes(original: TriangleMesh, decoded: TriangleMesh, paired: Pair) -> MeshComparison:
    first, second, faces = paired.original.positions, paired.positions, paired.original.faces
    positions = compare(first, second, faces)  # refuses sizes that overflow below
    places = [
        len(first_of(group_rows(np.ascontiguousarray(points, np.float64))))
        for points in (first, second)
    ]
    counts = {"flattened": flattened(first, second, faces), "merged": max(0, places[0] - places[1])}
    return MeshComparison(
        **asdict(positions), attributes=compare_attributes(original, decoded, paired), **counts
    )


def flattened(before: Positions, after: Positions, faces: Faces) -> int:
    """How many faces lose their area."""
    return int((_flat_faces(after, faces) & ~_flat_faces(before, faces)).sum())


def compare_attributes(
    original: TriangleMesh, decoded: TriangleMesh, paired: Pair
) -> dict[str, AttributeComparison | None]:
    """Compare attributes at the corners of faces; None: an attribute is missing."""
    areas = np.repeat(face_geometry(original.positions, original.faces).areas, 3)[paired.corners]
    faces = original.faces, decoded.faces
    comparisons: dict[str, AttributeComparison | None] = {}
    for one, other in _same_attributes(original.attributes, decoded.attributes):
        comparisons[one.name] = None
        if other is not None:
            comparisons[one.name] = _compare_one(one, other, faces, paired, areas)
    return comparisons


def _same_attributes(
    original: Sequence[Attribute], decoded: Sequence[Attribute]
) -> Iterator[tuple[Attribute, Attribute | None]]:
    """Attributes and what became of them: one of the name, or one of the meaning, as three.js says uv for texcoord."""
    after, own = (
        {attribute.name: attribute for attribute in decoded},
        {attribute.name for attribute in original},
    )
    named = (
        other
        for other in reversed(decoded)
        if other.name not in own and other.semantic != "generic"
    )
    renamed = {other.semantic: other for other in named}
    for attribute in original:
        other = after.get(attribute.name)
        if other is None:
            other = renamed.pop(attribute.semantic, None)
        if other and other.components != attribute.components:
            other = None
        yield attribute, other


def names_apart(original: TriangleMesh, decoded: TriangleMesh) -> dict[str, list[str]]:
    """Return the names in files of attributes that one mesh has and the other has not."""
    pairs = [*_same_attributes(original.attributes, decoded.attributes)]
    partners = {id(other) for _, other in pairs if other is not None}
    first = [name_in_file(original.metadata, one) for one, other in pairs if other is None]
    second = [
        name_in_file(decoded.metadata, one) for one in decoded.attributes if id(one) not in partners
    ]
    for one, other in pairs:
        if other is not None and one.name == other.name and one.semantic == "generic":
            names = [name_in_file(mesh.metadata, one) for mesh in (original, decoded)]
            if names[0] != names[1]:
                first.append(names[0])
                second.append(names[1])
    return {
        key: names
        for key, names in (("only_in_original", first), ("only_in_decoded", second))
        if names
    }


def _compare_one(
    attribute: Attribute,
    other: Attribute,
    faces: tuple[Faces, Faces],
    paired: Pair | FramePair,
    areas: npt.NDArray[np.float64],
) -> AttributeComparison:
    """Compare an attribute at the corners that are the same; normals by angles, if areas of corners are given."""
    values = at_corners(attribute, faces[0]).reshape(-1, attribute.components)[paired.corners]
    others = at_corners(other, faces[1]).reshape(-1, attribute.components)[paired.others]
    if attribute.semantic == "color" and values.dtype != others.dtype:
        values, others = map(shares_of, (values, others))
    weights = None
    if attribute.semantic == "normal" and len(areas):
        weights = areas
    return compare_values(values, others, weights)


Errors: TypeAlias = dict[str, float]
"""Errors of an attribute by their names."""


def errors_of(
    found: Mapping[str, AttributeComparison | None], original: TriangleMesh
) -> dict[str, Errors | None]:
    """Return the errors of attributes by their names; those of texture coordinates in texels, too."""
    side, known = largest_side(original.metadata), dict[str, Errors | None]()
    for attribute in original.attributes:
        errors = found.get(attribute.name)
        numbers = errors and {
            what: value for what, value in asdict(errors).items() if value is not None
        }
        if numbers and side and attribute.semantic == "texcoord":
            numbers["max_error_texels"] = side * numbers["max_error"]
        known[attribute.name] = numbers or None
    return known


def lost_attributes(original: TriangleMesh, decoded: TriangleMesh) -> dict[str, Errors | None]:
    """Return the errors of attributes after decoding, as `bsm compare` finds them; none where it cannot compare."""
    found: dict[str, AttributeComparison | None] = {}
    if original.attributes:
        with suppress(MeshError):
            first, second = (mesh.without_isolated_vertices()[0] for mesh in (original, decoded))
            found = compare_attributes(first, second, pair(first, second))
    if not found:
        return {}
    return errors_of(found, original)


def errors_of_frames(
    before: Sequence[Sequence[Attribute]],
    after: Sequence[Sequence[Attribute]],
    faces: tuple[Faces, Faces],
    paired: FramePair,
    first: int = 0,
) -> dict[str, Errors | None]:
    """Return the largest errors of attributes over frames, the first of which has this number; None: missing."""
    found: dict[str, Errors | None] = {}
    seen: dict[str, tuple[Attribute, Attribute | None]] = {}
    if not len(paired.corners):
        return found
    for number, (now, then) in enumerate(zip(before, after, strict=True)):
        for one, other in _same_attributes(now, then):
            if (known := seen.get(one.name)) and known[0] is one and known[1] is other:
                continue
            seen[one.name] = one, other
            largest = None
            if other is not None:
                errors = _compare_one(one, other, faces, paired, np.empty(0))
                largest = _larger(found.get(one.name), errors, first + number)
            found[one.name] = largest
    return found


def _larger(known: Errors | None, errors: AttributeComparison, frame: int) -> Errors:
    """The larger errors, and the frame that has the largest."""
    if known and known["max_error"] >= errors.max_error:
        return known
    return {"max_error": errors.max_error, "range": errors.range, "worst_frame": frame}


def worded_errors(errors: Errors) -> str:
    """The largest error of an attribute in words; nothing if there is none."""
    if not errors["max_error"]:
        return "no error"
    if "max_angle_deg" in errors:
        return f"largest error {errors['max_angle_deg']:.3g} degrees"
    text = f"largest error {errors['max_error']:.3g}"
    if "max_error_texels" in errors:
        text += f", {errors['max_error_texels']:.3g} texels"
    return text


def _flat_faces(positions: Positions, faces: Faces) -> Mask:
    """Which faces, shape (m,), have no area, but for the rounding of coordinates."""
    a, b, c = (
        np.asarray(positions, np.float64)[corner] for corner in np.ascontiguousarray(faces.T)
    )
    longest = np.sqrt(np.max([squares_of(side) for side in (b - a, c - b, a - c)], axis=0))
    area = np.sqrt(squares_of(np.cross(b - a, c - a)))
    return np.asarray(
        area <= 8.0 * np.finfo(np.float64).eps * np.abs(positions).max(initial=0.0) * longest
    )
