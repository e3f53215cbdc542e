"""Meshes of simulations, which meshio reads: their surfaces, and the skin of their volumes (the extra `simulation`)."""

import io
import re
import warnings
from collections.abc import Callable, Iterator, Mapping
from contextlib import redirect_stderr
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any, TypeAlias
from xml.etree import ElementTree

import numpy as np

from bsm.bitstream.errors import FormatError, MeshError, imported
from bsm.bitstream.limits import Limits
from bsm.codec.arrays import as_array
from bsm.codec.geometry.attributes import Domain, Semantic
from bsm.codec.geometry.welding import row_numbers
from bsm.files.formats.polygons import Column, CutAlike, MeshFile, Polygons, named_column
from bsm.files.motion.folder import read_files
from bsm.files.motion.frames import Frames, Wanted
from bsm.files.parsing import Doubles, Ints, as_library_error, ranges
from bsm.files.pipes import about, file_beside

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
    data: Mapping[str, Any], domain: Domain, left: list[str], active: Mapping[str, Semantic] | None = None
) -> Iterator[Column]:
    """Arrays of numbers by name, some of which are known to mean something."""
    for name, given in data.items():
        values = np.array(given)
        values = values[:, None] if values.ndim == 1 else values.reshape(len(values), -1)
        if values.dtype.kind not in "biuf":
            left.append(f"{name} ({values.dtype.name} values)")
            continue
        yield named_column(name, values, domain, (active or {}).get(name))


def _sides(block: Any, cells: Ints, points: Doubles) -> list[_Side]:
    """The sides of cells of one kind, outside ahead; none of kinds that are not known."""
    if block.type == "polygon":
        rows = [np.asarray(row, np.int64)[None] for row in block.data]
        return [(cells[k : k + 1], np.full((1, 4), -2), [row], False) for k, row in enumerate(rows)]
    table = np.asarray(block.data, np.int64)
    faces, edges, most = _SHAPES.get(block.type.rstrip("0123456789"), ("", "", 0))
    ends, size, found = [{*edge} for edge in edges.split()], len({*faces} - {" "}), list[_Side]()
    if not size or table.shape[1] not in (size, size + len(ends), most):
        return []
    step, is_solid = 1 + (table.shape[1] > size), " " in faces
    for face in faces.split():
        nodes = [(int(a), size + ends.index({a, b}))[:step] for a, b in zip(face, face[1:] + face[0], strict=True)]
        ring = table[:, np.ravel(nodes)]
        if is_solid:
            at = points[ring[:, ::step]].swapaxes(0, 1)
            ahead, middle = np.cross(at[2] - at[0], at[-1] - at[1]), points[table[:, :size]].mean(axis=1)
            inward = (ahead * (at.mean(axis=0) - middle)).sum(axis=1) < 0
            ring[inward] = np.roll(ring[inward, ::-1], 1, axis=1)
        key = np.pad(np.sort(ring[:, ::step]), ((0, 0), (0, 4 - len(face))), constant_values=-1)
        pieces = [ring]
        if step == 2:
            pieces = [*(ring[:, [at, at + 1, at - 1]] for at in range(0, ring.shape[1], 2)), ring[:, 1::2]]
        found.append((cells, key, pieces, is_solid))
    return found


def of_meshio(mesh: Any) -> Polygons:
    """The surfaces of a meshio mesh and the skin of its volumes, in the order of its cells."""
    points = as_array(mesh.points, "positions", np.float64)
    if points.ndim != 2 or points.shape[1] not in (2, 3):
        raise MeshError(f"positions must have shape (n, 3), not {points.shape}")
    points = np.pad(points, ((0, 0), (0, 3 - points.shape[1])))
    ends, sides, lost = np.cumsum([len(block.data) for block in mesh.cells]), list[_Side](), dict[str, None]()
    for block, end in zip(mesh.cells, ends.tolist(), strict=True):
        tables = block.data if block.type == "polygon" else [block.data]
        if any(np.size(table) and not 0 <= np.min(table) <= np.max(table) < len(points) for table in tables):
            raise MeshError(f"a cell of the type {block.type} refers to a vertex that is not there")
        of_block = _sides(block, np.arange(end - len(block.data), end), points)
        lost |= {} if of_block else {f"cells of the type {block.type}": None}
        sides += of_block
    numbers = row_numbers(np.concatenate([np.empty((0, 4), np.int64), *(key for _, key, _, _ in sides)]))
    once = np.split(np.bincount(numbers)[numbers] == 1, np.cumsum([len(side[0]) for side in sides])[:-1])
    kept = [(side, alone | (not side[3])) for side, alone in zip(sides, once, strict=False)]
    pieces = [(cells[taken], table[taken]) for (cells, _, tables, _), taken in kept for table in tables]
    rows = [(cells, np.full(len(cells), table.shape[1]), table.ravel()) for cells, table in pieces]
    owner, sizes, flat = map(np.concatenate, zip(*[(np.empty(0, np.int64),) * 3, *rows], strict=True))
    order = np.argsort(owner, kind="stable")
    corners = flat[ranges((np.cumsum(sizes) - sizes)[order], sizes[order])]
    has_skin = any(is_skin for _, _, _, is_skin in sides)
    used = np.unique(corners) if has_skin else np.arange(len(points))
    left = [*lost, *(["the inside of volumes"] if has_skin else [])]
    for what in ("point_sets", "cell_sets", "field_data", "info"):
        named = ", ".join(map(str, getattr(mesh, what, None) or ()))
        left += [f"{what.replace('_', ' ')} ({named})"] if named else []
    of_points = {name: np.asarray(values)[used] for name, values in mesh.point_data.items()}
    of_cells = {name: [*map(np.asarray, values)] for name, values in mesh.cell_data.items()}
    alike = {name: rows for name, rows in of_cells.items() if len({row.shape[1:] for row in rows}) == 1}
    whole = {name: np.concatenate(rows)[owner[order]] for name, rows in alike.items()}
    columns = [*columns_of(of_points, "vertex", left), *columns_of(whole, "face", left)]
    left += [name for name in of_cells if name not in whole]
    return Polygons(points[used], sizes[order], np.searchsorted(used, corners), (), tuple(left), tuple(columns))


# --------------------------------------------------------------------------------------------------------------- files


def _read(kind: str, data: bytes, path: str | None, limits: Limits) -> Polygons:
    if re.search(rb"(?im)^\*include\b", data):
        raise FormatError("this file includes others, which are not read; join them to one")
    return _found(partial(getattr(_meshio(), kind).read, _named(path)))


read_vtk, read_vtu, read_abaqus, read_nastran, read_gmsh = (
    partial(_read, kind) for kind in ("vtk", "vtu", "abaqus", "nastran", "gmsh")
)


def read_xdmf_mesh(data: bytes, path: str | None, limits: Limits) -> Polygons:
    """The mesh of a file, or the first of its steps."""
    steps = _steps(data, name := _named(path))
    found = _found(partial(_of_step, name, steps[0][1]))
    return replace(found, dropped=(*found.dropped, *([f"later steps ({len(steps) - 1})"] if steps[1:] else [])))


def _found(read: Callable[[], Any]) -> Polygons:
    """What meshio reads, and its warnings as losses."""
    said = io.StringIO()
    with as_library_error("meshio"), redirect_stderr(said), warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        found = of_meshio(read())
    warned = (" ".join(words.split()) for words in re.split(r"\b(?:Warning|Info|Error): ", said.getvalue())[1:])
    return replace(found, dropped=(*found.dropped, *dict.fromkeys(warned)))


def _meshio() -> Any:
    return imported("meshio", "this format is read with meshio", "simulation")


def _named(path: str | None) -> str:
    if path is None:
        raise FormatError("this format is read from an uncompressed file with a name")
    return path


def _of_step(path: str, root: Any) -> Any:
    reader = _meshio().xdmf.main.XdmfReader(path)
    return (reader.read_xdmf2 if root.get("Version", "").startswith("2") else reader.read_xdmf3)(root)


def _steps(data: bytes, path: str) -> list[tuple[float, Any]]:
    """The times of steps, and documents of one grid each; where a step has no shape, it has that of the mesh."""
    with as_library_error("meshio"):
        root = ElementTree.fromstring(data)
        for item in root.iter("DataItem"):
            name = str(item.text).partition(":")[0].strip()
            if item.get("Format") == "Binary":
                raise FormatError("this XDMF has numbers in binary files; write them as HDF5 or XML")
            if item.get("Format") == "HDF":
                with about(name):
                    file_beside(Path(path).resolve().parent, name)
        grids = root.findall("Domain/Grid")
        series = next((grid for grid in grids if grid.get("CollectionType") == "Temporal"), None)
        if series is None:
            return [(0.0, root)]
        whole = next(grid for grid in (*grids, *series) if grid.find("Topology") is not None)
        found = []
        for place, grid in enumerate(series.findall("Grid")):
            made = ElementTree.Element("Xdmf", root.attrib)
            one = ElementTree.SubElement(ElementTree.SubElement(made, "Domain"), "Grid", GridType="Uniform")
            for tag in ("Topology", "Geometry"):
                one.append(next(found for found in (grid.find(tag), whole.find(tag)) if found is not None))
            one.extend(grid.findall("Attribute"))
            times = [float(time.get("Value", place)) for time in grid.findall("Time")]
            found.append((times[0] if times else float(place), made))
        return sorted(found, key=lambda step: step[0])


def read_xdmf(path: str, wanted: Wanted, limits: Limits) -> Frames | None:
    """The steps of an XDMF as frames; None if it has none."""
    data, cut = Path(path).read_bytes(), CutAlike()
    steps = _steps(data, path)

    def read(name: str) -> MeshFile:
        return _found(partial(_of_step, path, steps[int(name)][1])).checked(limits, len(data), cut)

    asked = replace(wanted, times=[time for time, _ in steps])
    return read_files([*map(str, range(len(steps)))], read, asked) if steps[1:] else None
