"""Files that VTK reads, its own and those of solvers: surfaces, and the skin of volumes (the extra `simulation`).

Readers of VTK crash on some damaged files, so `files/apart.py` runs `read_vtk` in a process of its own. A header that
announces an image, or a grid of more points than the file has bytes, is refused before its points are allocated. The
surfaces of a file become parts of one mesh. Errors that VTK reports refuse the file; its warnings are named as losses.
"""

import csv
import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import (
    vtkLogger,
    vtkOutputWindow,
    vtkSMPTools,
    vtkStringArray,
    vtkStringOutputWindow,
)
from vtkmodules.vtkCommonDataModel import vtkGenericCell
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline
from vtkmodules.vtkFiltersCore import vtkCellCenters, vtkTriangleFilter
from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter

from bsm.bitstream.errors import FormatError, imported
from bsm.bitstream.limits import Limits
from bsm.codec.geometry.attributes import Domain, Semantic
from bsm.codec.geometry.welding import row_numbers
from bsm.files.formats.cells import INSIDE, columns_of
from bsm.files.formats.metadata import plain_fields
from bsm.files.formats.polygons import (
    GHOSTS,
    Column,
    Part,
    Polygons,
    joined_parts,
    polygon_normals,
    turned_corners,
)
from bsm.files.parsing import Doubles, Ints, as_library_error, require_counts
from bsm.files.table import FORMATS

_READERS = {
    "vtkIOLegacy": "vtkGenericDataObjectReader", "vtkIOXML": "vtkXMLGenericDataObjectReader",
    "vtkIOHDF": "vtkHDFReader", "vtkIOEnSight": "vtkGenericEnSightReader", "vtkIOExodus": "vtkExodusIIReader",
    "vtkIOCGNSReader": "vtkCGNSReader", "vtkIOGeometry": "vtkOpenFOAMReader",
    "vtpc": "vtkXMLPartitionedDataSetCollectionReader",
}  # fmt: skip
"""The reader in each module of VTK, or of a suffix."""
_ALL_OF = ("PointArrays", "CellArrays", "Bases", "Families", "PatchArrays")
_BELOW = {
    "vtkPartitionedDataSetCollection": "PartitionedDataSet", "vtkMultiBlockDataSet": "Block",
    "vtkPartitionedDataSet": "Partition",
}  # fmt: skip
"""The members of sets of data that have others below."""
_CELL = "vtkCell"
_HIDDEN_CELL = 32  # a bit of the marks of ghosts
# Of polygons that are compared, in a table: one of thousands would make it gigabytes.
MOST_CORNERS = 9
_SETTINGS = [*csv.DictReader((Path(__file__).parents[1] / "settings.csv").read_text().splitlines())]
_NODE, _FINE = "vtkNode", 8
"""Numbers of points, by which faces are known in several blocks; the middle of a curved side has eighths of them."""
_UNNAMED = re.compile(r"Unnamed set ID: (\d+).*")
_MOST_SETS = 64  # that become attributes
_OWN = re.compile(f"{GHOSTS}|vtkValidPointMask|PedigreeNodeId|GlobalNodeId|{_CELL}")
_SAID = re.compile(r"(ERROR|Warning): In [^\n]*\n\w+ \(0x\w+\): ")


def read_vtk(
    path: str, kind: str, limits: Limits, step: int | None = None, *, with_sets: bool = True
) -> tuple[Polygons, tuple[float, ...]]:
    """The surfaces of a file as the frame of a step, or at rest at the first time; and its times."""
    output = vtkStringOutputWindow()
    vtkOutputWindow.SetInstance(output)
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    # A process that reads files from strangers may start no thread.
    vtkSMPTools.SetBackend("Sequential")
    size = Path(path).stat().st_size
    with as_library_error("VTK"):
        module = FORMATS[kind].modules[1]
        name = _READERS.get(kind) or _READERS[module.partition(".")[2]]
        reader = getattr(imported(module, "", "simulation"), name)()
        if module.endswith("EnSight"):
            reader.SetCaseFileName(path)
        else:
            reader.SetFileName(path)
        times = _opened(reader, kind, size, limits)
        is_exodus = name == "vtkExodusIIReader"
        if is_exodus and step is not None:
            reader.SetApplyDisplacements(1)  # frames move as the displacements say
        losses: dict[str, None] = {}
        if is_exodus:
            losses = _show_sets(reader, with_sets=with_sets)
        if times:
            reader.UpdateTimeStep(times[step or 0])
        reader.Update()
        if with_sets and is_exodus and "ERROR" in output.GetOutput():
            return read_vtk(path, kind, limits, step, with_sets=False)  # VTK fails at some sets
        data = reader.GetOutputDataObject(0)
        words = _SAID.split(output.GetOutput())
        if "ERROR" in words or data is None:
            reason = "there is nothing in it"
            if "ERROR" in words:
                reason = words[words.index("ERROR") + 1]
            raise FormatError(
                f"VTK cannot read this file, or one that it names: {' '.join(reason.split())}"
            )
        losses |= dict.fromkeys(" ".join(text.split()) for text in words[2::2])
        sets: _Sets | None = None
        if is_exodus:
            sets = _Sets(data, losses)
        leaves = [*_leaves(data, "")]
        surfaces = [_part(leaf, leaf_name, losses) for leaf, leaf_name in leaves]
        parts = [part for part in surfaces if part is not None]
        if sets is not None:
            parts = sets.mark(parts, losses)
    joined = joined_parts(parts, None, limits, size)
    plain, others = plain_fields(_fields([*(leaf for leaf, _ in leaves), data], len(times), losses))
    return replace(joined, dropped=(*losses, *others), metadata={**joined.metadata, **plain}), times


def _show_sets(reader: Any, *, with_sets: bool) -> dict[str, None]:
    """Let a reader of Exodus read the sets, or name them; return the names of its contents that have no place here."""
    losses = dict[str, None]()
    for kind in ("node", "side", "elem", "edge", "face"):
        number = getattr(reader, f"{kind.upper()}_SET")
        for place in range(reader.GetNumberOfObjects(number)):
            reader.SetObjectStatus(number, place, int(with_sets))
            name = _UNNAMED.sub(rf"{kind} set \1", _text(reader.GetObjectName(number, place)))
            if not with_sets:
                losses[f"the {kind} set {name}"] = None
        for place in range(reader.GetNumberOfObjectArrays(number)):
            losses[f"{_text(reader.GetObjectArrayName(number, place))} of {kind} sets"] = None
    for kind in ("edge", "face"):
        number = getattr(reader, f"{kind.upper()}_BLOCK")
        for place in range(reader.GetNumberOfObjects(number)):
            losses[f"the {kind} block {_text(reader.GetObjectName(number, place))}"] = None
    return losses


def _fields(every: Sequence[Any], steps: int, losses: dict[str, None]) -> dict[str, Any]:
    """The field data of sets of data: the numbers of all steps as a text, and a line for each number that differs."""
    fields = dict[str, Any]()
    lines = dict[str, dict[str, None]]()
    for data in every:
        for name, values in _arrays(data.GetFieldData(), losses):
            fields[name] = values
            if 1 < steps == values.size and values.dtype.kind in "iuf":
                numbers = map(repr, values.ravel().tolist())
                fields[name] = np.array(" ".join(numbers))
            elif values.size == 1:
                lines.setdefault(name, {})[str(values.item())] = None
    for name, texts in lines.items():
        if len(texts) > 1:
            fields[name] = np.array("\n".join(texts))
    return fields


class _Sets:
    """The sets of a file of Exodus, which become marks of faces or points; its data keep the blocks."""

    def __init__(self, data: Any, losses: dict[str, None]) -> None:
        self._faces, self._points = dict[str, Any](), dict[str, Any]()
        for place in range(data.GetNumberOfBlocks()):
            kind = data.GetMetaData(place).Get(data.NAME())
            if not kind.endswith(" Sets"):
                continue
            for leaf, name in _leaves(data.GetBlock(place), ""):
                self._add(kind[:-1].lower(), leaf, name, losses)
            data.SetBlock(place, None)

    def _add(self, kind: str, leaf: Any, name: str, losses: dict[str, None]) -> None:
        set_name = _UNNAMED.sub(rf"{kind} \1", name)
        part: Part | None = None
        if kind == "side set":
            part = _part(leaf, name, {})
        if len(self._faces) + len(self._points) >= _MOST_SETS:
            losses[f"the {kind} {set_name}"] = None
        elif kind == "node set":
            self._points[set_name] = _FINE * vtk_to_numpy(
                leaf.GetPointData().GetArray("GlobalNodeId")
            )
        elif part is not None:
            self._faces[set_name] = _nodes_of_faces(part)
        else:
            losses[f"the {kind} {set_name}"] = None

    def mark(self, parts: Sequence[Part], losses: dict[str, None]) -> list[Part]:
        """Return the parts with a column for each set, one where a face or point is in it."""
        tables = [*map(_nodes_of_faces, parts), *self._faces.values()]
        numbers = row_numbers(np.concatenate([np.zeros((0, MOST_CORNERS), np.int64), *tables]))
        ends = np.cumsum([len(rows) for rows in tables])
        pieces = np.split(numbers, ends[:-1])
        pieces_of_parts, pieces_of_sets = pieces[: len(parts)], pieces[len(parts) :]
        columns = [[column for column in part.columns if column.name != _NODE] for part in parts]
        for name, of_set in zip(self._faces, pieces_of_sets, strict=True):
            is_in = np.zeros(len(numbers), np.uint8)
            is_in[of_set] = 1
            inside = len(of_set)
            for columns_of_part, of_part in zip(columns, pieces_of_parts, strict=True):
                marks = is_in[of_part][:, None]
                inside -= int(marks.sum())
                columns_of_part.append(Column(name, marks, "face"))
            if inside > 0:
                losses[f"faces of the side set {name} inside of volumes ({inside})"] = None
        marked: list[Part] = []
        for part, columns_of_part in zip(parts, columns, strict=True):
            points = _nodes_of_points(part)
            for name, nodes in self._points.items():
                marks = np.isin(points, nodes).astype(np.uint8)
                columns_of_part.append(Column(name, marks[:, None]))
            marked.append(replace(part, columns=columns_of_part))
        return marked


def _nodes_of_points(part: Part) -> Ints:
    """The numbers of the points of a part in their file."""
    numbers = next(column.values for column in part.columns if column.name == _NODE)
    return np.rint(numbers[:, 0]).astype(np.int64)


def _nodes_of_faces(part: Part) -> Ints:
    """A row for each polygon of a part: the numbers of its corners in their file, sorted."""
    return _table_of_corners(part.sizes, _nodes_of_points(part)[part.corners])


def _table_of_corners(sizes: Ints, corners: Ints) -> Ints:
    """A row for each polygon: its corners, sorted after as many -1 as are missing; none of polygons of too many."""
    rows = np.full((len(sizes), MOST_CORNERS), -1)
    is_short = sizes <= MOST_CORNERS
    places = np.arange(MOST_CORNERS) < np.where(is_short, sizes, 0)[:, None]
    rows[places] = corners[np.repeat(is_short, sizes)]
    return np.sort(rows, axis=1)


def _opened(reader: Any, kind: str, size: int, limits: Limits) -> tuple[float, ...]:
    """Let a reader read all that is in a file, and return its times; refuse images and grids by their header."""
    for row in _SETTINGS:
        if row["value"] and reader.IsA(row["reader"]):
            for setting in row["settings"].split():
                getattr(reader, f"Set{setting}")(int(row["value"]))
    reader.UpdateInformation()
    for what in _ALL_OF:
        getattr(reader, f"EnableAll{what}", int)()
    if kind == "foam":  # the patches are the skin of what is inside
        names = [
            reader.GetPatchArrayName(place) for place in range(reader.GetNumberOfPatchArrays())
        ]
        for name in names:
            reader.SetPatchArrayStatus(name, int(name != "internalMesh" or len(names) == 1))
    if hasattr(reader, "SetAllArrayStatus"):  # of Exodus
        for what in ("NODAL", "ELEM_BLOCK", "GLOBAL"):
            reader.SetAllArrayStatus(getattr(reader, what), 1)
    about, data = reader.GetOutputInformation(0), reader.GetOutputDataObject(0)
    counts: list[int] = []
    if about.Has(Pipeline.WHOLE_EXTENT()):
        extent = about.Get(Pipeline.WHOLE_EXTENT())
        counts = [high - low + 1 for low, high in zip(extent[::2], extent[1::2])]
    points = math.prod(counts)
    what = " x ".join(map(str, counts))
    if data is not None and data.IsA("vtkImageData") and min(counts, default=0) > 1:
        raise FormatError(f"this is an image of {what} points; extract a contour, e.g. in ParaView")
    if points > max(size, 1):
        raise FormatError(
            f"this is a grid of {what} points in {size} bytes; extract a surface, e.g. in ParaView"
        )
    if min(counts, default=0) == 1:
        require_counts(limits, vertices=points)
    if not about.Has(Pipeline.TIME_STEPS()):
        return ()
    return tuple(about.Get(Pipeline.TIME_STEPS()))


def _leaves(data: Any, name: str) -> Iterator[tuple[Any, str]]:
    """The sets of data below one, with their names, or those above them."""
    what = next((what for kind, what in _BELOW.items() if data.IsA(kind)), "")
    if not what:
        yield data, name
        return
    for place in range(getattr(data, f"GetNumberOf{what}s")()):
        block_name = name
        if data.HasMetaData(place) and data.GetMetaData(place).Has(data.NAME()):
            block_name = _text(data.GetMetaData(place).Get(data.NAME()))
        block = getattr(data, f"Get{what}")(place)
        if block is not None:
            yield from _leaves(block, block_name)


def _part(data: Any, name: str, losses: dict[str, None]) -> Part | None:
    """The surface of a set of data; None if it has none."""
    if not data.IsA("vtkDataSet"):
        losses[f"a {data.GetClassName().removeprefix('vtk')}"] = None
        return None
    if data.IsA("vtkImageData") and min(data.GetDimensions()) > 1:
        losses["images in three dimensions"] = None
        return None
    surface, points = data, data.GetPointData()
    nodes = points.GetArray("GlobalNodeId")
    if nodes is not None:
        # As plain numbers: VTK drops those that it calls global where it cuts curved sides.
        plain = numpy_to_vtk(_FINE * vtk_to_numpy(nodes).astype(np.float64), deep=True)
        plain.SetName(_NODE)
        points.AddArray(plain)
    if not data.IsA("vtkPolyData"):
        numbers = numpy_to_vtk(np.arange(data.GetNumberOfCells(), dtype=np.int64), deep=True)
        # Where cells are curved, those that the filter passes count something else.
        numbers.SetName(_CELL)
        data.GetCellData().AddArray(numbers)
        surface = _through(vtkDataSetSurfaceFilter(), data)
    hidden = _count_hidden(data)
    if hidden:
        losses[f"hidden cells ({hidden})"] = None
    surface.RemoveGhostCells()  # those of other pieces, which close the skin of this one
    cells_before = surface.GetNumberOfVerts() + surface.GetNumberOfLines()
    if cells_before:
        losses["points and lines"] = None
    if surface.GetNumberOfStrips():
        surface = _through(vtkTriangleFilter(), surface)
        cells_before = 0
    if not surface.GetNumberOfPolys():
        return None
    return _surface_part(data, surface, cells_before, losses, name)


def _surface_part(
    data: Any, surface: Any, cells_before: int, losses: dict[str, None], name: str
) -> Part:
    """The polygons of a surface, whose cells follow so many points and lines, with their columns.

    A surface that is meshed along with its volume is the skin there: the sides of the volume go.
    """
    positions = np.array(vtk_to_numpy(surface.GetPoints().GetData()), np.float64)
    corners = vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).astype(np.int64)
    sizes = np.diff(vtk_to_numpy(surface.GetPolys().GetOffsetsArray()).astype(np.int64))
    rows_kept: Any = slice(None)
    if not data.IsA("vtkPolyData"):
        cells = vtk_to_numpy(surface.GetCellData().GetArray(_CELL))[cells_before:]
        is_solid = _of_volumes(data, cells)
        is_short = sizes <= MOST_CORNERS
        numbers = row_numbers(_table_of_corners(sizes, corners))
        is_doubled = is_solid & np.isin(numbers, numbers[is_short & ~is_solid])
        rows_kept = ~(is_short & is_doubled)
        corners = corners[np.repeat(rows_kept, sizes)]
        sizes, cells, is_solid = sizes[rows_kept], cells[rows_kept], is_solid[rows_kept]
        if is_solid.any():
            losses[INSIDE] = None
        is_turned = is_solid & _inward(data, cells, positions, sizes, corners)
        corners = corners[turned_corners(sizes, is_turned)]
    of_points, of_cells = surface.GetPointData(), surface.GetCellData()
    values = dict(_arrays(of_points, losses))
    columns = [*_columns(of_points, values, "vertex", losses)]
    values = {
        array_name: array[cells_before:][rows_kept]
        for array_name, array in _arrays(of_cells, losses)
    }
    columns += _columns(of_cells, values, "face", losses)
    return Part(positions, sizes, corners, columns, np.zeros(len(sizes), np.int64), name)


def _columns(
    attributes: Any, values: dict[str, Any], domain: Domain, losses: dict[str, None]
) -> Iterator[Column]:
    active: dict[str, Semantic] = {}
    if attributes.GetTCoords() is not None:
        active[attributes.GetTCoords().GetName()] = "texcoord"
    if attributes.GetNormals() is not None:
        active[attributes.GetNormals().GetName()] = "normal"
    return columns_of(values, domain, losses, active, _components(attributes))


def _through(step: Any, data: Any) -> Any:
    """Return the output of a filter for a set of data."""
    step.SetInputData(data)
    for what in ("PassVerts", "PassLines"):
        getattr(step, f"Set{what}", int)(0)
    step.Update()
    return step.GetOutput()


def _of_volumes(data: Any, cells: Ints) -> Any:
    """Return which polygons are sides of volumes."""
    used, inverse = np.unique(cells, return_inverse=True)
    kinds = np.array([data.GetCellType(cell) for cell in used.tolist()], np.int64)
    is_solid = np.zeros(len(kinds), np.bool_)
    for kind in np.unique(kinds).tolist():
        dimension = vtkGenericCell.InstantiateCell(kind).GetCellDimension()
        is_solid[kinds == kind] = dimension == 3
    return is_solid[inverse]


def _inward(data: Any, cells: Ints, positions: Doubles, sizes: Ints, corners: Ints) -> Any:
    """Return which polygons look into their cells: writers order the corners of wedges in either way."""
    for attributes in (data.GetPointData(), data.GetCellData()):
        attributes.RemoveArray("vtkGhostType")  # cells that are hidden have middles, too
    middles = vtk_to_numpy(_through(vtkCellCenters(), data).GetPoints().GetData())[cells]
    sums = np.add.reduceat(positions[corners], np.cumsum(sizes) - sizes)
    outward = sums / sizes[:, None] - middles
    return (polygon_normals(positions, sizes, corners) * outward).sum(axis=1) < 0


def _text(name: str | bytes) -> str:
    """A name, which VTK hands over as bytes where it is not UTF-8."""
    if isinstance(name, str):
        return name
    text, *_ = name.decode(errors="replace").split("\0")
    return text


def _count_hidden(data: Any) -> int:
    """Count the cells of a set of data whose marks of ghosts hide them."""
    marks = data.GetCellData().GetArray(GHOSTS)
    if marks is None:
        return 0
    return int(np.count_nonzero(vtk_to_numpy(marks) & _HIDDEN_CELL))


def _components(attributes: Any) -> dict[str, list[str]]:
    """The names of the components of arrays, of those that name all."""
    components: dict[str, list[str]] = {}
    for place in range(attributes.GetNumberOfArrays()):
        array = attributes.GetAbstractArray(place)
        count = array.GetNumberOfComponents()
        if array.GetName() and array.HasAComponentName() and count > 1:
            words = [_text(array.GetComponentName(number) or "") for number in range(count)]
            if all(words):
                components[_text(array.GetName())] = words
    return components


def _arrays(attributes: Any, losses: dict[str, None]) -> Iterator[tuple[str, Any]]:
    """The arrays of data that VTK holds, by their names."""
    for place in range(attributes.GetNumberOfArrays()):
        array = attributes.GetAbstractArray(place)
        name = _text(array.GetName() or f"array {place}")
        if isinstance(array, vtkStringArray):
            yield name, np.array([array.GetValue(row) for row in range(array.GetNumberOfValues())])
        elif not array.IsA("vtkDataArray"):
            losses[name] = None
        elif not _OWN.fullmatch(name):
            yield name, vtk_to_numpy(array)
