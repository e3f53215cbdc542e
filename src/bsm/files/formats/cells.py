"""Surfaces and the skin of volumes, of cells as solvers have them; and meshes of meshio, which has such cells."""

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any, TypeAlias

import numpy as np

from bsm.bitstream.errors import MeshError, TruncatedError
from bsm.codec.arrays import as_array
from bsm.codec.geometry.attributes import Domain, Semantic
from bsm.codec.geometry.mesh import Metadata
from bsm.codec.geometry.welding import row_numbers
from bsm.files.formats.polygons import Column, Polygons, named_column
from bsm.files.parsing import Doubles, Ints, ranges

INSIDE = "the inside of volumes"
_SHAPES = {
    "triangle": ("012", "01 12 20", 7),
    "quad": ("0123", "01 12 23 30", 9),
    "tetra": ("021 013 123 203", "01 12 20 03 13 23", 10),
    "pyramid": ("0321 014 124 234 304", "01 12 23 30 04 14 24 34", 14),
    "wedge": ("021 345 0143 1254 2035", "01 12 20 34 45 53 03 14 25", 18),
    "hexahedron": ("0321 4567 0154 1265 2376 3047", "01 12 23 30 45 56 67 74 04 15 26 37", 27),
}
"""Sides of cells by their corners; edges, on each of which quadratic cells have a node, after those at corners; and how
many nodes there are with those amid sides and cells, which are left out."""
_Side: TypeAlias = tuple[Ints, Ints, list[Ints], bool]
"""A side of each of some cells: their numbers, its corners as a key, its polygons, and whether one inside goes."""


def columns_of(
    data: Mapping[str, Any],
    domain: Domain,
    losses: dict[str, None],
    active: Mapping[str, Semantic] | None = None,
    components: Mapping[str, Sequence[str]] | None = None,
) -> Iterator[Column]:
    """Yield arrays of numbers by name, some of which are known to mean something, or name their components."""
    meanings = active or {}
    component_names = components or {}
    for name, table in data.items():
        values = np.array(table)
        if values.dtype.kind not in "biuf":
            losses[f"{name} ({values.dtype.name} values)"] = None
            continue
        if values.ndim == 1:
            rows = values[:, None]
        else:
            rows = values.reshape(len(values), -1)
        yield named_column(name, rows, domain, meanings.get(name), component_names.get(name, ()))


_WINDOW = 1 << 12


def runs(flat: Ints, shape: Callable[[Ints], tuple[int, slice]]) -> Iterator[Ints]:
    """Tables of alike rows in a flat list; the first numbers of a row tell its length, and the columns to compare."""
    begin = 0
    while begin < len(flat):
        width, compared = shape(flat[begin : begin + 4])
        # A window: comparing all that is left at every change of kind would take the square of the file.
        window = flat[begin : begin + _WINDOW * width]
        count = len(window) // width
        if not count:
            raise TruncatedError("the last cell is cut short")
        table = window[: count * width].reshape(-1, width)
        alike = (table[:, compared] == table[0, compared]).all(axis=1)
        if not alike.all():
            count = int(np.argmin(alike))
        yield table[:count]
        begin += count * width


def _sides(kind: str, table: Ints, cells: Ints, points: Doubles) -> list[_Side]:
    """Return the sides of cells of one kind, outside ahead; none of kinds that are not known."""
    if kind == "polygon":
        return [(cells, np.full((len(cells), 4), -2), [table], False)]
    shape = kind.rstrip("0123456789")
    if shape not in _SHAPES:
        return []
    faces, edges, most_nodes = _SHAPES[shape]
    ends = [{*edge} for edge in edges.split()]
    is_solid = " " in faces
    corner_count = len({*faces} - {" "})
    if table.shape[1] not in (corner_count, corner_count + len(ends), most_nodes):
        return []
    step = 1
    if table.shape[1] > corner_count:  # quadratic cells have a node on each edge
        step = 2
    sides: list[_Side] = []
    for face in faces.split():
        nodes: list[int] = []
        for corner, following in zip(face, face[1:] + face[0], strict=True):
            nodes.append(int(corner))
            if step == 2:
                nodes.append(corner_count + ends.index({corner, following}))
        ring = table[:, nodes]
        if is_solid:
            _turn_outward(
                ring, points[ring[:, ::step]], points[table[:, :corner_count]].mean(axis=1)
            )
        # A side is known by its corners, sorted: two cells run around the side between them in opposite directions.
        key = np.pad(np.sort(ring[:, ::step]), ((0, 0), (0, 4 - len(face))), constant_values=-1)
        pieces = [ring]
        if step == 2:
            pieces = [ring[:, [at, at + 1, at - 1]] for at in range(0, ring.shape[1], 2)]
            pieces.append(ring[:, 1::2])
        sides.append((cells, key, pieces, is_solid))
    return sides


def _turn_outward(ring: Ints, corners: Doubles, middles: Doubles) -> None:
    """Turn the sides around, shape (n, k), whose normals point to the middles of their cells."""
    # Solvers differ in the order of corners, wedges above all, so where outside is follows from the cell's middle.
    places = corners.swapaxes(0, 1)
    normals = np.cross(places[2] - places[0], places[-1] - places[1])
    inward = (normals * (places.mean(axis=0) - middles)).sum(axis=1) < 0
    ring[inward] = np.roll(ring[inward, ::-1], 1, axis=1)


def skin(
    positions: Any,
    blocks: Sequence[tuple[str, Any]],
    of_points: Mapping[str, Any],
    of_cells: Mapping[str, Any],
    losses: Iterable[str] = (),
    metadata: Metadata | None = None,
) -> Polygons:
    """The surfaces among cells and the skin of volumes, in the order of cells: blocks have a shape and rows of points.

    Arrays of cells have a row for each cell of all blocks.
    """
    points = as_array(positions, "positions", np.float64)
    if points.ndim != 2 or points.shape[1] not in (2, 3):
        raise MeshError(f"positions must have shape (n, 3), not {points.shape}")
    points = np.pad(points, ((0, 0), (0, 3 - points.shape[1])))
    lost: dict[str, None] = {}
    sides: list[_Side] = []
    for kind, cells, table in _tables_of_kinds(blocks):
        if table.size and not 0 <= table.min() <= table.max() < len(points):
            raise MeshError(f"a cell of the type {kind} refers to a vertex that is not there")
        sides_of_kind = _sides(kind, table, cells, points)
        if not sides_of_kind:
            lost[f"cells of the type {kind} ({len(table)})"] = None
        sides += sides_of_kind
    owner, sizes, flat = _outer_polygons(sides)
    order = np.argsort(owner, kind="stable")
    corners = flat[ranges((np.cumsum(sizes) - sizes)[order], sizes[order])]
    used = np.arange(len(points))
    if any(is_skin for _, _, _, is_skin in sides):
        used = np.unique(corners)
        lost[INSIDE] = None
    columns_of_points = {name: np.asarray(values)[used] for name, values in of_points.items()}
    columns_of_cells = {name: np.asarray(values)[owner[order]] for name, values in of_cells.items()}
    columns = (
        *columns_of(columns_of_points, "vertex", lost),
        *columns_of(columns_of_cells, "face", lost),
    )
    corners = np.searchsorted(used, corners)
    return Polygons(
        points[used], sizes[order], corners, (), (*lost, *losses), columns, metadata or {}
    )


def _tables_of_kinds(blocks: Sequence[tuple[str, Any]]) -> Iterator[tuple[str, Ints, Ints]]:
    """Yield the cells of all blocks that are alike in shape and width: their numbers, and a row of points for each."""
    tables_alike = defaultdict[tuple[str, int], list[tuple[Ints, Ints]]](list)
    count = 0
    for kind, rows in blocks:
        # Polygons come as a list, each of a length of its own.
        if isinstance(rows, list):
            tables = [np.asarray(row, np.int64)[None] for row in rows]
        else:
            tables = [np.asarray(rows, np.int64)]
        for table in tables:
            numbers = np.arange(count, count + len(table))
            tables_alike[kind, table.shape[1]].append((numbers, table))
            count += len(table)
    for (kind, _), parts in tables_alike.items():
        cells, table = map(np.concatenate, zip(*parts, strict=True))
        yield kind, cells, table


def _outer_polygons(sides: list[_Side]) -> tuple[Ints, Ints, Ints]:
    """Return the cells, the sizes and the corners of all sides but those of solids that two cells have."""
    nothing = np.empty(0, np.int64)
    numbers = row_numbers(
        np.concatenate([np.empty((0, 4), np.int64), *(key for _, key, _, _ in sides)])
    )
    # A side of two cells lies inside.
    is_single = np.bincount(numbers)[numbers] == 1
    owners, sizes, corners = [nothing], [nothing], [nothing]
    begin = 0
    for cells, _, tables, is_solid in sides:
        rows: Any = slice(None)
        if is_solid:
            rows = is_single[begin : begin + len(cells)]
        begin += len(cells)
        for table in tables:
            outer = table[rows]
            owners.append(cells[rows])
            sizes.append(np.full(len(outer), table.shape[1]))
            corners.append(outer.ravel())
    return np.concatenate(owners), np.concatenate(sizes), np.concatenate(corners)


def of_meshio(mesh: Any) -> Polygons:
    """Return the surfaces of a meshio mesh and the skin of its volumes, in the order of its cells."""
    losses: list[str] = []
    blocks: list[tuple[str, Any]] = []
    for block in mesh.cells:
        table = block.data
        if block.type.startswith("poly"):
            table = [*table]
        blocks.append((block.type, table))
    for what in ("point_sets", "cell_sets", "field_data", "info"):
        names = ", ".join(map(str, getattr(mesh, what, None) or ()))
        if names:
            losses.append(f"{what.replace('_', ' ')} ({names})")
    of_cells: dict[str, Any] = {}
    for name, values in mesh.cell_data.items():
        tables = [*map(np.asarray, values)]
        if len({table.shape[1:] for table in tables}) == 1:
            of_cells[name] = np.concatenate(tables)
        else:
            losses.append(name)
    return skin(mesh.points, blocks, mesh.point_data, of_cells, losses)
