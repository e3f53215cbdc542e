"""XDMF: grids in XML, whose numbers are there or in HDF5 files beside it (the extra `simulation`).

All temporal collections of a file play together: their steps have the same times, and the arrays of each are those of
the mesh. Collections in space become parts. Elements, kinds of cells and of numbers that are not known are refused.
"""

import re
from collections.abc import Iterable, Sequence
from dataclasses import replace
from hashlib import blake2b
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np

from bsm.bitstream.errors import FormatError, MeshError, imported
from bsm.bitstream.limits import Limits
from bsm.files.formats.cells import runs, skin
from bsm.files.formats.outside import refuse_outside_hdf
from bsm.files.formats.polygons import Polygons, joined_parts, part_of
from bsm.files.motion.folder import read_steps
from bsm.files.motion.frames import Frames, Wanted
from bsm.files.parsing import TAG, Ints, as_library_error, require_inflated
from bsm.files.pipes import about, file_beside

_CELLS = {
    1: "polyvertex", 2: "polyline", 3: "polygon", 4: "triangle3", 5: "quad4 quadrilateral4", 6: "tetra4 tetrahedron4",
    7: "pyramid5", 8: "wedge6", 9: "hexahedron8", 34: "edge3", 35: "quad9 quadrilateral9",
    36: "tri6 triangle6", 37: "quad8 quadrilateral8", 38: "tet10 tetrahedron10", 39: "pyramid13", 40: "wedge15",
    41: "wedge18", 48: "hex20 hexahedron20", 50: "hex27 hexahedron27",
}  # fmt: skip
"""Kinds of cells by their numbers in mixed topologies: names, and how many points they have."""
_SHORT = {
    "tri": "triangle",
    "tet": "tetra",
    "tetrahedron": "tetra",
    "quadrilateral": "quad",
    "hex": "hexahedron",
}
_COUNTED = (1, 2, 3)  # kinds with a number of points before these
_KNOWN = ("Topology", "Geometry", "Attribute", "Time", "Information", "Grid", "DataItem")
_TIMES = ("List", "HyperSlab", "Single")
_TEST = r"""\[(?:@\w+ ?= ?(?:"[^"\]]*"|'[^'\]]*')|\d{1,9}|self::\w+(?: or self::\w+){0,8})\]"""
_STEP = rf"[\w:*]+(?:{_TEST}){{0,3}}"
_PATH = re.compile(rf"/{{0,2}}{_STEP}(?:/{_STEP})*")
_LONGEST_PATH = 512
_WAY = "save it as .vtu, e.g. with ParaView"


class _Grids:
    """The grids of a file, and the numbers that they name."""

    def __init__(self, data: bytes, path: str | None, limits: Limits) -> None:
        if path is None:
            raise FormatError("this format is read from an uncompressed file with a name")
        xml = imported("lxml.etree", "XDMF is read with lxml", "simulation")
        self._folder, self._limits = Path(path).resolve().parent, limits
        self._own = set[Path]()  # HDF5 files that lead to no other folder
        self._present, self._read, self._copied = len(data), 0, 0
        # A file must not make the parser open another one, nor the network.
        parser = xml.XMLParser(resolve_entities=False, no_network=True, remove_comments=True)
        with as_library_error("lxml"):
            self.root = xml.fromstring(data, parser)
            for tag in ("Grid", "Topology", "Geometry", "Attribute", "DataItem"):
                for element in [*self.root.iter(tag)]:
                    self._resolve(element)

    def _resolve(self, element: Any) -> None:
        """Put what an element refers to in its place."""
        for include in [child for child in element if str(child.tag).endswith("}include")]:
            if include.get("href"):
                raise FormatError(f"this XDMF includes {include.get('href')}; {_WAY}")
            pointer = str(include.get("xpointer", "")).removeprefix("xpointer(").removesuffix(")")
            # A copy, as an element of lxml has one parent only, and others may point to it, too.
            element.extend(self._copies(self._find(pointer)))
            element.remove(include)
        reference = element.get("Reference")
        if not reference:
            return
        path = reference
        if reference == "XML":
            path = (element.text or "").strip()
        targets = self._find(path)
        if len(targets) != 1 or targets[0].get("Reference"):
            raise FormatError(f"the reference {reference[:80]} does not lead to one element")
        target = targets[0]
        element[:], element.text = self._copies(target), target.text
        element.attrib.update({**target.attrib, **element.attrib})

    def _find(self, pointer: str) -> Any:
        """Return the elements that a path leads to; paths in paths may take longer than any file is worth."""
        if len(pointer) > _LONGEST_PATH or not _PATH.fullmatch(pointer):
            raise FormatError(
                f"this XDMF refers to {pointer[:80]}, which is more than a path; {_WAY}"
            )
        return self.root.xpath(pointer)

    def _copies(self, elements: Iterable[Any]) -> list[Any]:
        """Return copies of elements, which may not take much more memory than the file."""
        copies = []
        for element in elements:
            self._copied += sum(TAG + len(one.text or "") for one in element.iter())
            self._limits.check_memory(self._copied, 0, self._present)
            copies.append(element.__deepcopy__({}))
        return copies

    def numbers(self, parent: Any) -> Any:
        """The numbers of the data item in an element."""
        items = parent.findall("DataItem")
        if len(items) != 1:
            raise FormatError(
                f"{parent.tag} {parent.get('Name', '')} has {len(items)} data items; {_WAY}"
            )
        return self._item(items[0])

    def _item(self, item: Any) -> Any:
        kind, form = item.get("ItemType", "Uniform"), item.get("Format", "XML")
        if kind != "Uniform" or form not in ("XML", "HDF"):
            raise FormatError(f"this XDMF has data items of the kind {kind}, {form}; {_WAY}")
        words = (item.text or "").strip()
        shape = [int(word) for word in str(item.get("Dimensions", "")).split()]
        if form == "XML":
            values = np.array(words.split(), np.float64)
            self._take(values.nbytes)
        else:
            name, _, place = words.partition(":")
            with about(name):
                path = file_beside(self._folder, name.strip())
            values = self._in_hdf(path, place)
        if shape:
            values = values.reshape(shape)
        return values

    def _in_hdf(self, path: Path, place: str) -> Any:
        h5py = imported("h5py", "XDMF is read with h5py", "simulation")
        compressed = path.stat().st_size
        if path not in self._own:
            refuse_outside_hdf(path, self._folder)
            self._own.add(path)
            self._present += compressed
        with as_library_error("h5py"), h5py.File(path, "r") as file:
            table = file[place]
            # HDF5 knows the size of a table before it reads it; compressed tables may be huge.
            size = table.size * table.dtype.itemsize
            require_inflated(size, compressed, self._limits)
            self._take(size)
            return table[()]

    def _take(self, size: int) -> None:
        """Charge the bytes of a table of a step: a grid of few bytes may name a large one again."""
        self._read += size
        self._limits.check_memory(self._read, 0, self._present)

    # ------------------------------------------------------------------------------------------------------- grids

    def steps(self) -> list[tuple[float, list[Any]]]:
        """The times of steps, and the grids of each."""
        grids = self.root.findall("Domain/Grid")
        series = [grid for grid in grids if grid.get("CollectionType") == "Temporal"]
        if not series:
            return [(0.0, grids)]
        steps = [
            (time, [grid])
            for time, grid in zip(self._times(series[0]), series[0].findall("Grid"), strict=True)
        ]
        others = [
            grid for grid in grids if grid not in series and grid.find("Attribute") is not None
        ]
        for grid in series[1:]:
            if self._times(grid) == [time for time, _ in steps]:
                for (_, grids_of_step), step in zip(steps, grid.findall("Grid"), strict=True):
                    grids_of_step.append(step)
            else:
                others.append(grid)
        if others:
            name = others[0].get("Name", "")
            raise FormatError(
                f"the grid {name} does not have the times of the others; {_WAY}, or write one file for each"
            )
        self._complete([grid for _, grids_of_step in steps for grid in grids_of_step])
        return sorted(steps, key=lambda step: step[0])

    def _complete(self, grids: Sequence[Any]) -> None:
        """Give grids without a mesh that of the first grid which has one."""
        model = next(
            (grid for grid in self.root.iter("Grid") if grid.find("Topology") is not None), None
        )
        if model is None:
            return
        for grid in grids:
            for tag in ("Topology", "Geometry"):
                if grid.get("GridType", "Uniform") == "Uniform" and grid.find(tag) is None:
                    grid.append(model.find(tag).__deepcopy__({}))

    def _times(self, series: Any) -> list[float]:
        """When the steps of a series are."""
        steps, time = series.findall("Grid"), series.find("Time")
        if time is None:
            times: list[float] = []
            for place, step in enumerate(steps):
                own_time = step.find("Time")
                value = place if own_time is None else own_time.get("Value")
                times.append(float(value))
            return times
        kind = time.get("TimeType", "Single")
        if kind not in _TIMES:
            raise FormatError(f"this XDMF has times of the kind {kind}; {_WAY}")
        if time.find("DataItem") is None:
            values = np.array([float(time.get("Value"))])
        else:
            values = np.asarray(self.numbers(time).ravel(), np.float64)
        count = len(values)
        if kind == "HyperSlab":
            count = int(values[2])
        if count != len(steps):
            raise FormatError(f"there are {count} times for {len(steps)} steps")
        if kind == "HyperSlab":
            values = values[0] + values[1] * np.arange(count)
        times = values.tolist()
        return times

    def surface(self, grids: Sequence[Any], size: int) -> Polygons:
        """The surfaces of grids; those over the same mesh are one."""
        self._read = 0
        every = list(chain.from_iterable(map(self._leaves, grids)))
        shapes = [self._shape(leaf) for leaf in every]
        places_by_key: dict[Any, list[int]] = {}
        for place, shape in enumerate(shapes):
            key: Any = place
            if len(grids) > 1:
                key = _key_of(shape)
            places_by_key.setdefault(key, []).append(place)
        surfaces: list[Polygons] = []
        names: list[str] = []
        for first, *more in places_by_key.values():
            surfaces.append(self._part(shapes[first], [every[place] for place in (first, *more)]))
            names.append(str(every[first].get("Name", "")))
        if len(surfaces) == 1:
            return surfaces[0]
        parts = [*map(part_of, surfaces, names)]
        lost: dict[str, None] = {}
        for surface in surfaces:
            lost |= dict.fromkeys(surface.dropped)
        return replace(joined_parts(parts, None, self._limits, size), dropped=tuple(lost))

    def _leaves(self, grid: Any) -> list[Any]:
        for child in grid:
            if child.tag not in _KNOWN:
                raise FormatError(
                    f"this XDMF has the element {child.tag}, which is not known here; {_WAY}"
                )
        kind = grid.get("GridType", "Uniform")
        if grid.get("CollectionType") == "Temporal" or kind not in (
            "Uniform",
            "Collection",
            "Tree",
        ):
            raise FormatError(f"this XDMF has grids of the kind {kind} in others; {_WAY}")
        if kind == "Uniform":
            return [grid]
        return list(chain.from_iterable(map(self._leaves, grid.findall("Grid"))))

    def _shape(self, grid: Any) -> tuple[Any, list[tuple[str, Any]]]:
        """The points of a grid, and its cells."""
        topology, geometry = grid.find("Topology"), grid.find("Geometry")
        if topology is None or geometry is None:
            raise FormatError(f"the grid {grid.get('Name', '')} has no topology or geometry")
        points = self._points(geometry)
        name = topology.get("TopologyType", topology.get("Type", "")).lower().replace("_", "")
        flat = self.numbers(topology).astype(np.int64)
        base = int(topology.get("BaseOffset", 0))
        if name == "mixed":
            return points, [(kind, rows - base) for kind, rows in _mixed(flat.ravel())]
        if topology.get("Order"):
            raise FormatError(f"this XDMF has an order of nodes of its own; {_WAY}")
        if name not in _LAYOUTS:
            raise FormatError(f"this XDMF has cells of the kind {name}; {_WAY}")
        width = _width_of(_LAYOUTS[name]) or int(topology.get("NodesPerElement", flat.shape[-1]))
        return points, [(_shape_of(_LAYOUTS[name]), flat.reshape(-1, width) - base)]

    def _points(self, geometry: Any) -> Any:
        kind = geometry.get("GeometryType", geometry.get("Type", "XYZ")).upper()
        if kind not in ("XYZ", "XY", "X_Y_Z", "X_Y"):
            raise FormatError(f"this XDMF has a geometry {kind}; {_WAY}")
        tables = [self._item(item) for item in geometry.findall("DataItem")]
        if "_" in kind:
            return np.column_stack([axis.ravel() for axis in tables])
        return tables[0].reshape(-1, len(kind))

    def _part(self, shape: tuple[Any, list[tuple[str, Any]]], grids: Sequence[Any]) -> Polygons:
        points, blocks = shape
        counts = {"Node": len(points), "Cell": sum(len(rows) for _, rows in blocks)}
        columns: dict[str, dict[str, Any]] = {"Node": {}, "Cell": {}}
        losses = []
        for attribute in chain(*(grid.findall("Attribute") for grid in grids)):
            center, name = attribute.get("Center", "Node"), attribute.get("Name", "")
            if center not in columns:
                losses.append(f"{name} (Center={center})")
                continue
            values, count = self.numbers(attribute), counts[center]
            if not count or values.size % count:
                raise MeshError(f"{name} has {values.size} numbers for {count} rows")
            if name in columns[center]:
                raise FormatError(f"two grids have values called {name}; {_WAY}")
            table = values.reshape(count, -1)
            # Rows of XDMF are xx xy xz yy yz zz; those of VTK, by which components are named, xx yy zz xy yz xz.
            kind = attribute.get("AttributeType", attribute.get("Type", ""))
            if kind == "Tensor6" and table.shape[1] == 6:
                table = table[:, [0, 3, 5, 1, 4, 2]]
            columns[center][name] = table
        return skin(points, blocks, columns["Node"], columns["Cell"], losses)


def _layouts() -> dict[str, str]:
    """The kinds of cells by their names, which have a number of points but for lines and polygons of any size."""
    layouts: dict[str, str] = {}
    for number, words in _CELLS.items():
        for word in words.split():
            name = word
            if number < 10:
                name = word.rstrip("0123456789")
            layouts[name] = word
    return layouts


_LAYOUTS = _layouts()


def _width_of(layout: str) -> int:
    """The number of points of a layout, which ends with it; 0: it has none."""
    return int(re.sub(r"\D", "", layout) or 0)


def _shape_of(layout: str) -> str:
    name = layout.rstrip("0123456789")
    return _SHORT.get(name, name)


def _key_of(shape: tuple[Any, list[tuple[str, Any]]]) -> Any:
    """Return a key that is the same for the same points and cells."""
    points, blocks = shape
    key: list[Any] = []
    for kind, table in (("points", np.asarray(points) + 0), *blocks):  # + 0, since -0 is 0
        digest = blake2b(np.ascontiguousarray(table).tobytes()).digest()
        key.append((kind, table.shape, digest))
    return tuple(key)


def _mixed(flat: Ints) -> list[tuple[str, Ints]]:
    """The cells of a mixed topology, in runs of one kind."""

    def shape(row: Ints) -> tuple[int, slice]:
        kind = int(row[0])
        if kind not in _CELLS or row[-1] < 0:
            raise FormatError(f"this XDMF has cells of the kind {kind}; {_WAY}")
        if kind in _COUNTED:
            return 2 + int(row[1]), slice(0, 2)
        return 1 + _width_of(_CELLS[kind].split()[0]), slice(0, 1)

    blocks: list[tuple[str, Ints]] = []
    for table in runs(flat, shape):
        kind = int(table[0, 0])
        first = 1
        if kind in _COUNTED:
            first = 2
        blocks.append((_shape_of(_CELLS[kind].split()[0]), table[:, first:]))
    return blocks


def read_xdmf_mesh(data: bytes, path: str | None, limits: Limits) -> Polygons:
    """The mesh of a file, or the first of its steps."""
    with as_library_error("lxml"):
        document = _Grids(data, path, limits)
        steps = document.steps()
        polygons = document.surface(steps[0][1], len(data))
    if len(steps) == 1:
        return polygons
    return replace(polygons, dropped=(*polygons.dropped, f"later steps ({len(steps) - 1})"))


def read_xdmf(path: str, request: Wanted, limits: Limits) -> Frames | None:
    """The steps of an XDMF as frames; None if it has none."""
    data = Path(path).read_bytes()
    with as_library_error("lxml"):
        document = _Grids(data, path, limits)
        steps = document.steps()

    def surface(step: int) -> Polygons:
        with as_library_error("lxml"):
            return document.surface(steps[step][1], len(data))

    return read_steps(surface, [time for time, _ in steps], len(data), request, limits)
