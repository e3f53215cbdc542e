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
    """Arrays of numbers by name, some of which are known to mean something, or name their components."""
    for name, table in data.items():
        values = np.array(table)
        values = values[:, None] if values.ndim == 1 else values.reshape(len(values), -1)
        if values.dtype.kind not in "biuf":
            losses[f"{name} ({values.dtype.name} values)"] = None
            continue
        yield named_column(name, values, domain, (active or {}).get(name), (components or {}).get(name, ()))


_WINDOW = 1 << 12


def runs(flat: Ints, shape: Callable[[Ints], tuple[int, slice]]) -> Iterator[Ints]:
    """Tables of alike rows in a flat list; the first numbers of a row tell its length, and the columns to compare."""
    at = 0
    while at < len(flat):
        width, same = shape(flat[at : at + 4])
        # A window: comparing all that is left at every change of kind would take the square of the file.
        rows = flat[at : at + _WINDOW * width]
        table = rows[: len(rows) // width * width].reshape(-1, width)
        if not len(table):
            raise TruncatedError("the last cell is cut short")
        alike = (table[:, same] == table[0, same]).all(axis=1)
        count = len(table) if alike.all() else int(np.argmin(alike))
        yield table[:count]
        at += count * width


def _sides(kind: str, table: Ints, cells: Ints, points: Doubles) -> list[_Side]:
    """The sides of cells of one kind, outside ahead; none of kinds that are not known."""
    if kind == "polygon":
        return [(cells, np.full((len(cells), 4), -2), [table], False)]
    faces, edges, most = _SHAPES.get(kind.rstrip("0123456789"), ("", "", 0))
    ends, size, sides = [{*edge} for edge in edges.split()], len({*faces} - {" "}), list[_Side]()
    if not size or table.shape[1] not in (size, size + len(ends), most):
        return []
    step, is_solid = 1 + (table.shape[1] > size), " " in faces
    for face in faces.split():
        nodes = [(int(a), size + ends.index({a, b}))[:step] for a, b in zip(face, face[1:] + face[0], strict=True)]
        ring = table[:, np.ravel(nodes)]
        if is_solid:
            at = points[ring[:, ::step]].swapaxes(0, 1)
            ahead, middle = np.cross(at[2] - at[0], at[-1] - at[1]), points[table[:, :size]].mean(axis=1)
            # Solvers differ in the order of corners, wedges above all, so where outside is follows from the cell's
            # middle.
            inward = (ahead * (at.mean(axis=0) - middle)).sum(axis=1) < 0
            ring[inward] = np.roll(ring[inward, ::-1], 1, axis=1)
        # A side is known by its corners, sorted: two cells run around the side between them in opposite directions.
        key = np.pad(np.sort(ring[:, ::step]), ((0, 0), (0, 4 - len(face))), constant_values=-1)
        pieces = [ring]
        if step == 2:
            pieces = [*(ring[:, [at, at + 1, at - 1]] for at in range(0, ring.shape[1], 2)), ring[:, 1::2]]
        sides.append((cells, key, pieces, is_solid))
    return sides


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
    alike, count = defaultdict[tuple[str, int], list[tuple[Ints, Ints]]](list), 0
    for kind, rows in blocks:
        tables = (
            [np.asarray(row, np.int64)[None] for row in rows]
            if isinstance(rows, list)
            else [np.asarray(rows, np.int64)]
        )
        for table in tables:
            alike[kind, table.shape[1]].append((np.arange(count, count + len(table)), table))
            count += len(table)
    sides, lost = list[_Side](), dict[str, None]()
    for (kind, _), cells_of_kind in alike.items():
        cells, table = map(np.concatenate, zip(*cells_of_kind, strict=True))
        if table.size and not 0 <= table.min() <= table.max() < len(points):
            raise MeshError(f"a cell of the type {kind} refers to a vertex that is not there")
        of_kind = _sides(kind, table, cells, points)
        lost |= {} if of_kind else {f"cells of the type {kind} ({len(table)})": None}
        sides += of_kind
    numbers = row_numbers(np.concatenate([np.empty((0, 4), np.int64), *(key for _, key, _, _ in sides)]))
    # A side of two cells lies inside.
    once = np.split(np.bincount(numbers)[numbers] == 1, np.cumsum([len(side[0]) for side in sides])[:-1])
    outer_sides = [(side, alone | (not side[3])) for side, alone in zip(sides, once, strict=False)]
    pieces = [
        (cells[columns_of_points], table[columns_of_points])
        for (cells, _, tables, _), columns_of_points in outer_sides
        for table in tables
    ]
    every = [(cells, np.full(len(cells), table.shape[1]), table.ravel()) for cells, table in pieces]
    owner, sizes, flat = map(np.concatenate, zip(*[(np.empty(0, np.int64),) * 3, *every], strict=True))
    order = np.argsort(owner, kind="stable")
    corners = flat[ranges((np.cumsum(sizes) - sizes)[order], sizes[order])]
    has_skin = any(is_skin for _, _, _, is_skin in sides)
    used = np.unique(corners) if has_skin else np.arange(len(points))
    lost |= {INSIDE: None} if has_skin else {}
    columns_of_points = {name: np.asarray(values)[used] for name, values in of_points.items()}
    columns_of_cells = {name: np.asarray(values)[owner[order]] for name, values in of_cells.items()}
    columns = (*columns_of(columns_of_points, "vertex", lost), *columns_of(columns_of_cells, "face", lost))
    corners = np.searchsorted(used, corners)
    return Polygons(points[used], sizes[order], corners, (), (*lost, *losses), columns, metadata or {})


def of_meshio(mesh: Any) -> Polygons:
    """The surfaces of a meshio mesh and the skin of its volumes, in the order of its cells."""
    losses = list[str]()
    blocks = [(block.type, [*block.data] if block.type.startswith("poly") else block.data) for block in mesh.cells]
    for what in ("point_sets", "cell_sets", "field_data", "info"):
        names = ", ".join(map(str, getattr(mesh, what, None) or ()))
        losses += [f"{what.replace('_', ' ')} ({names})"] if names else []
    of_cells = {name: [*map(np.asarray, values)] for name, values in mesh.cell_data.items()}
    alike = {name: rows for name, rows in of_cells.items() if len({row.shape[1:] for row in rows}) == 1}
    joined_rows = {name: np.concatenate(rows) for name, rows in alike.items()}
    losses += [name for name in of_cells if name not in joined_rows]
    return skin(mesh.points, blocks, mesh.point_data, joined_rows, losses)
